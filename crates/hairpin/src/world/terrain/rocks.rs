//! Rocks on the ground by their size-frequency distribution, as bumps of a map and as places to keep out of.
//!
//! The share of the area covered by rocks larger than D is F(D) = k e^(−q D), q = 1.79 + 0.152/k: M. Golombek and D.
//! Rapp, Size-frequency distributions of rocks on Mars and Earth analog sites, J. Geophys. Res. 102 (1997), fitted to
//! the sites of the Viking landers; k is 0.03 on smooth ground, 0.07 and 0.18 there. Half of each rock is above the
//! ground.
//!
//! Drawn by number: the density of diameters is −F′(D)/(πD²/4) ∝ e^(−qD)/D², by rejection from the exponential of F;
//! rocks are added until their areas sum to F(D_least) of the ground, so that cover, not count, is what a scenario
//! fixes.

use std::f64::consts::PI;

use super::keep_out::{KeepOut, KeepOutShape};
use super::map::{ElevationMap, Grid, MapError};
use crate::math::random::{named_seed, stream, unit};

/// A rock: half a ball on the ground.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rock {
    /// x, y of its middle, m.
    pub center: [f64; 2],
    /// m.
    pub diameter: f64,
}

/// Which rocks to scatter.
///
/// Lengths in m. Expected number: ∫ k q e^(−qD)/(πD²/4) dD over the area, from the least diameter on; at most a
/// million.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rocks {
    /// k: share of the ground that rocks of all sizes cover, 0 to 0.4.
    pub cover: f64,
    /// Smaller ones are left out, m.
    pub least_m: f64,
    /// Larger ones are cut to this, m.
    pub most_m: f64,
    /// Root seed.
    pub seed: u64,
}

impl Rocks {
    /// The rocks on the rectangle from `low` to `high` (x, y in m), their middles evenly spread; the same ones from the
    /// same seed.
    ///
    /// The last rock may cover more than was left. Rocks may overlap and may reach over the rectangle's rim.
    ///
    /// # Errors
    /// Numbers out of bounds, by name.
    pub fn scatter(&self, low: [f64; 2], high: [f64; 2]) -> Result<Vec<Rock>, MapError> {
        let size = [high[0] - low[0], high[1] - low[1]];
        let bounded = [
            ("cover", self.cover, 0.0, 0.4, "from 0 to 0.4"),
            ("least_m", self.least_m, 1e-3, 1e3, "from 0.001 to 1000"),
            ("most_m", self.most_m, self.least_m, f64::INFINITY, "least_m or more"),
            ("width", size[0], 0.0, 1e5, "from 0 to 100000 m"),
            ("height", size[1], 0.0, 1e5, "from 0 to 100000 m"),
        ];
        for (field, value, least, most, bound) in bounded {
            if !(least..=most).contains(&value) {
                return Err(MapError::Grid { field, value: value.to_string(), bound });
            }
        }
        let mut rocks = Vec::new();
        if self.cover == 0.0 {
            return Ok(rocks);
        }
        let mut random = stream(named_seed(self.seed, "terrain rocks", 0));
        let q = 1.79 + 0.152 / self.cover;
        let mut to_cover = self.cover * libm::exp(-q * self.least_m) * (size[0] * size[1]);
        while to_cover > 0.0 {
            if rocks.len() == MOST {
                return Err(MapError::Grid {
                    field: "least_m",
                    value: self.least_m.to_string(),
                    bound: "larger: a million rocks at most",
                });
            }
            // By area covered the diameters are exponential; by number the large ones are rarer as their areas.
            let diameter = self.least_m - libm::log(1.0 - unit(&mut random)) / q;
            let share = self.least_m / diameter;
            if unit(&mut random) > share * share {
                continue;
            }
            let diameter = diameter.min(self.most_m);
            let center = [low[0] + size[0] * unit(&mut random), low[1] + size[1] * unit(&mut random)];
            rocks.push(Rock { center, diameter });
            to_cover -= 0.25 * PI * diameter * diameter;
        }
        Ok(rocks)
    }
}

/// Rocks at most.
const MOST: usize = 1_000_000;

impl Rock {
    /// Height over the ground it lies on at a `distance` from its middle, m.
    ///
    /// A half ball, but rounded at the foot, so that wheels meet slopes there, not walls.
    ///
    /// h(s) = R w √(2 − w), w = 1 − (s/R)², R half the diameter: R on top, 0 at the rim with a finite slope, where the
    /// half ball R√w is a wall.
    ///
    /// m, in 0 … R.
    pub fn height(&self, distance: f64) -> f64 {
        let radius = 0.5 * self.diameter;
        let share = distance / radius;
        let inside = (1.0 - share * share).max(0.0);
        radius * inside * (2.0 - inside).sqrt()
    }

    /// The rock as a place to keep out of.
    pub fn keep_out(&self, name: String) -> KeepOut {
        KeepOut { name, shape: KeepOutShape::Circle { center_m: self.center, radius_m: 0.5 * self.diameter } }
    }
}

/// `map` with `rocks` on it; where two overlap, one lies on the other.
///
/// Heights are sampled at cell centres: rocks below two cells in diameter are seen by chance.
pub fn add_rocks(map: &ElevationMap, rocks: &[Rock]) -> ElevationMap {
    map.raised(|heights| {
        for rock in rocks {
            add(map.grid(), heights, rock);
        }
    })
}

/// Raises the cells whose centres lie under the rock by its height there: a rock stands on the ground that is, slopes
/// and other rocks included.
fn add(grid: &Grid, heights: &mut [f32], rock: &Rock) {
    let Grid { columns, rows, first_center, cell } = *grid;
    let reach = 0.5 * rock.diameter;
    // From the first cell to before the last; casts of what is outside end at 0 or beyond the map.
    let span = |axis: usize, count: usize| {
        let at = |side: f64| (rock.center[axis] + side * reach - first_center[axis]) / cell[axis];
        (at(-1.0).ceil() as usize).min(count)..((at(1.0).floor() + 1.0) as usize).min(count)
    };
    for row in span(1, rows) {
        for column in span(0, columns) {
            let dx = first_center[0] + column as f64 * cell[0] - rock.center[0];
            let dy = first_center[1] + row as f64 * cell[1] - rock.center[1];
            let distance = (dx * dx + dy * dy).sqrt();
            if distance < reach {
                heights[row * columns + column] += rock.height(distance) as f32;
            }
        }
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;
    use crate::world::terrain::{HoleRule, KeepOuts, Terrain};

    const YARD: ([f64; 2], [f64; 2]) = ([-20.0, -10.0], [20.0, 30.0]);

    fn rocks(cover: f64, seed: u64) -> Vec<Rock> {
        Rocks { cover, least_m: 0.2, most_m: 1.0, seed }.scatter(YARD.0, YARD.1).expect("rocks")
    }

    #[test]
    fn sizes_are_as_frequent_as_the_source_has_them() {
        let (k, q) = (0.1, 1.79 + 1.52);
        let mut all: Vec<Rock> = (0..20).flat_map(|seed| rocks(k, seed)).collect();
        all.sort_by(|a, b| b.diameter.total_cmp(&a.diameter));
        for diameter in [0.2, 0.35, 0.6] {
            let larger = all.iter().filter(|rock| rock.diameter >= diameter);
            let covered = larger.map(|rock| 0.25 * PI * rock.diameter * rock.diameter).sum::<f64>() / (20.0 * 1600.0);
            let expected = k * libm::exp(-q * diameter);
            assert!((covered / expected - 1.0).abs() < 0.1, "{covered} above {diameter} m, not {expected}");
        }
        assert!(all[0].diameter <= 1.0 && rocks(k, 3) == rocks(k, 3) && rocks(k, 3) != rocks(k, 4));
    }

    #[test]
    fn a_map_gets_half_balls_where_its_rocks_are_and_stays_as_it_is_elsewhere() {
        let grid = Grid { columns: 81, rows: 61, first_center: [-2.0, 1.0], cell: [0.05, 0.05] };
        let mut heights: Vec<f32> = (0..81 * 61).map(|i| 0.01 * (i % 81) as f32).collect();
        heights[3] = f32::NAN;
        let bare = ElevationMap::new(grid, &heights, HoleRule::KeepOut).expect("a map");
        let rock = Rock { center: [0.5, 2.5], diameter: 0.6 };
        let map = add_rocks(&bare, &[rock]);
        let risen = |x: f64, y: f64| map.patch(x, y).expect("ground").height - bare.patch(x, y).expect("ground").height;
        assert!((risen(0.5, 2.5) - 0.3).abs() < 1e-6, "{}", risen(0.5, 2.5));
        assert!((risen(0.6, 2.5) - rock.height(0.1)).abs() < 1e-6 && risen(0.5, 2.8) < 1e-3 && risen(0.0, 2.5) == 0.0);
        assert_eq!((map.holes(), map.grid()), (1, bare.grid()));
        // At the border as well.
        let map = add_rocks(
            &bare,
            &[Rock { center: [2.0, 4.0], diameter: 0.4 }, Rock { center: [90.0, 0.0], diameter: 2.0 }],
        );
        assert!((map.patch(2.0, 4.0).expect("ground").height - 1.0).abs() < 1e-6);
    }

    #[test]
    fn rocks_are_places_to_keep_out_of() {
        let list = rocks(0.05, 1).iter().enumerate().map(|(i, rock)| rock.keep_out(format!("rock {i}"))).collect();
        let places = KeepOuts::new(list).expect("places");
        let rock = rocks(0.05, 1)[7];
        let depth = places.distance(rock.center[0], rock.center[1]);
        assert!(depth <= -0.5 * rock.diameter, "{depth}");
    }

    #[test]
    fn numbers_out_of_bounds_are_named() {
        let good = Rocks { cover: 0.1, least_m: 0.2, most_m: 1.0, seed: 0 };
        for (wrong, field) in [
            (Rocks { cover: 0.5, ..good }, "cover = 0.5"),
            (Rocks { cover: f64::NAN, ..good }, "cover = NaN"),
            (Rocks { least_m: 0.0, ..good }, "least_m = 0"),
            (Rocks { most_m: 0.1, ..good }, "most_m = 0.1"),
        ] {
            let error = wrong.scatter(YARD.0, YARD.1).map(|rocks| rocks.len()).expect_err(field).to_string();
            assert!(error.contains(field), "{error}");
        }
        let error = good.scatter([0.0; 2], [1e4; 2]).map(|rocks| rocks.len()).expect_err("too many").to_string();
        assert!(error.contains("a million rocks"), "{error}");
        assert!(good.scatter([0.0; 2], [-1.0, 2.0]).is_err());
    }
}
