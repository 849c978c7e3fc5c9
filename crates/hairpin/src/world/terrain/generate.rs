//! Terrain from a seed: fractal ground, craters, rocks.
//!
//! Fractal: octaves of gradient noise whose amplitude falls with the wavelength as λ^H (Turcotte 1987; Mars' H is about
//! 0.7 at rover scale). Craters: cumulative number per area ∝ D⁻² of fresh bowls 0.2 D deep with a rim 0.04 D high
//! (Pike 1977). Rocks: see [`super::rocks`].
//!
//! Order matters and is fixed: fractal ground, then craters, then rocks, each from its own stream, so that one recipe
//! with other rocks keeps its craters. Turcotte, "A fractal interpretation of topography and geoid spectra on the
//! Earth, Moon, Venus, and Mars", J. Geophys. Res. 92 (1987); Pike, "Size-dependence in the shape of fresh impact
//! craters on the moon", in Impact and Explosion Cratering (1977).
//!
//! What is made is statistically like such ground, not a model of how it came about: craters do not erase what was
//! there before, ejecta end at two radii, and nothing is eroded.

use std::f64::consts::TAU;

use super::map::{ElevationMap, Grid, HoleRule, MapError};
use super::rocks::Rocks;
use crate::math::random::{hashed_unit, named_seed, stream, unit};

/// What to make.
///
/// Octaves have wavelengths of 20 m (or the map's size), halved down to two cells, and amplitudes ∝ λ^H whose variances
/// sum to `relief_m`² about. Craters are as fresh as 0.3 to 1, evenly, which scales depth and rim; the largest are a
/// third of the map.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Recipe {
    /// Edge length of the square map, m.
    pub size_m: f64,
    /// Edge length of a cell, m.
    pub cell_m: f64,
    /// Standard deviation of the fractal ground's height, m, about.
    pub relief_m: f64,
    /// H: 1 smooth, 0 rough.
    pub hurst: f64,
    /// Craters of at least this diameter, m, one in an area of `crater_area_m2`; infinite for none.
    pub least_crater_m: f64,
    /// m².
    pub crater_area_m2: f64,
    /// k: share of the ground covered by rocks, 0 to 0.4.
    pub rock_cover: f64,
    /// Root seed.
    pub seed: u64,
}

impl Default for Recipe {
    /// A cratered yard of 60 m.
    fn default() -> Self {
        Self {
            size_m: 60.0,
            cell_m: 0.1,
            relief_m: 0.3,
            hurst: 0.7,
            least_crater_m: 2.0,
            crater_area_m2: 150.0,
            rock_cover: 0.03,
            seed: 0,
        }
    }
}

/// The longest wavelength of the fractal ground, m.
const LONGEST_WAVE: f64 = 20.0;
/// Cells of a map at most.
const MOST_CELLS: f64 = 1e8;
/// Depth and height of the rim of a crater, by its diameter.
const DEPTH: f64 = 0.2;
const RIM: f64 = 0.04;

/// The map of `recipe`, its south-west corner at the origin; the same bytes from the same recipe on any machine.
///
/// Cost: octaves times cells, then each bump's own cells. Heights are rounded to f32 at the end.
///
/// ```
/// use hairpin::world::terrain::{Terrain, generate::{Recipe, generate}};
///
/// let recipe = Recipe { size_m: 6.0, cell_m: 0.1, least_crater_m: f64::INFINITY, seed: 3, ..Recipe::default() };
/// let (map, again) = (generate(&recipe)?, generate(&recipe)?);
/// assert_eq!(map.height(3.0, 3.0)?, again.height(3.0, 3.0)?);
/// assert!(map.height(3.0, 3.0)?.abs() < 2.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// Numbers out of bounds, by name.
pub fn generate(recipe: &Recipe) -> Result<ElevationMap, MapError> {
    check(recipe)?;
    let cells = ((recipe.size_m / recipe.cell_m).round() as usize).max(2);
    let cell = recipe.cell_m;
    let mut ground = Ground { heights: vec![0.0; cells * cells], cells, cell };
    ground.fractal(recipe);
    ground.craters(recipe);
    ground.rocks(recipe)?;
    let mut north_first = Vec::with_capacity(cells * cells);
    for row in ground.heights.chunks_exact(cells).rev() {
        north_first.extend(row.iter().map(|h| *h as f32));
    }
    let grid = Grid { columns: cells, rows: cells, first_center: [0.5 * cell, 0.5 * cell], cell: [cell, cell] };
    ElevationMap::new(grid, &north_first, HoleRule::Error)
}

fn check(recipe: &Recipe) -> Result<(), MapError> {
    let wrong = |field, value: f64, bound| Err(MapError::Grid { field, value: value.to_string(), bound });
    let bounded = [
        ("size_m", recipe.size_m, 1e-2, 1e5, "from 0.01 to 100000"),
        ("cell_m", recipe.cell_m, 1e-3, 1e3, "from 0.001 to 1000"),
        ("relief_m", recipe.relief_m, 0.0, 1e3, "from 0 to 1000"),
        ("hurst", recipe.hurst, 0.0, 1.0, "from 0 to 1"),
        ("crater_area_m2", recipe.crater_area_m2, 1e-2, 1e12, "from 0.01 to 1e12"),
        ("rock_cover", recipe.rock_cover, 0.0, 0.4, "from 0 to 0.4"),
    ];
    for (field, value, low, high, bound) in bounded {
        if !(low..=high).contains(&value) {
            return wrong(field, value, bound);
        }
    }
    if recipe.least_crater_m.is_nan() || recipe.least_crater_m < recipe.cell_m {
        return wrong("least_crater_m", recipe.least_crater_m, "a cell or more");
    }
    let side = recipe.size_m / recipe.cell_m;
    if side * side > MOST_CELLS {
        return wrong("cell_m", recipe.cell_m, "coarser: 100 million cells at most");
    }
    Ok(())
}

/// Heights under way, rows from the south.
struct Ground {
    heights: Vec<f64>,
    cells: usize,
    cell: f64,
}

impl Ground {
    /// Gradient noise in octaves, wavelengths λ halving from the longest down to two cells, each of an amplitude ∝ λ^H;
    /// together their standard deviation is the relief asked for, as far as that of gradient noise is ¼.
    ///
    /// An octave has the variance amplitude²/16, and the next one 4^(−H) of it, so that all together sum to the
    /// relief's square; the series is cut off at two cells, where the relief comes out a little low.
    fn fractal(&mut self, recipe: &Recipe) {
        let mut wave = LONGEST_WAVE.min(recipe.size_m);
        // Gradient noise has a standard deviation of about a quarter; octaves of variance λ^(2H) add up to the
        // relief's.
        let share = 1.0 - libm::pow(0.25, recipe.hurst.max(0.05));
        let mut amplitude = 4.0 * recipe.relief_m * share.sqrt();
        for octave in 0.. {
            if wave < 2.0 * self.cell || amplitude == 0.0 {
                break;
            }
            let seed = named_seed(recipe.seed, "terrain fractal", octave);
            let gradient = |i: i64, j: i64| {
                let (sin, cos) = libm::sincos(TAU * hashed_unit(seed, &[i as u64, j as u64]));
                [cos, sin]
            };
            for row in 0..self.cells {
                for column in 0..self.cells {
                    let at = [(column as f64 + 0.5) * self.cell / wave, (row as f64 + 0.5) * self.cell / wave];
                    self.heights[row * self.cells + column] += amplitude * gradient_noise(at, gradient);
                }
            }
            wave *= 0.5;
            amplitude *= libm::pow(0.5, recipe.hurst);
        }
    }

    /// D = D_least u^(−½) with u even in (0, 1). Places are even over the map, rims may lie beyond it; one adds to the
    /// other.
    fn craters(&mut self, recipe: &Recipe) {
        if recipe.least_crater_m >= recipe.size_m {
            return;
        }
        let mut random = stream(named_seed(recipe.seed, "terrain craters", 0));
        let count = (recipe.size_m * recipe.size_m / recipe.crater_area_m2).round() as usize;
        for _ in 0..count {
            // N(>D) ∝ D⁻², cut at a third of the map.
            let diameter = (recipe.least_crater_m / unit(&mut random).max(1e-9).sqrt()).min(recipe.size_m / 3.0);
            let center = [recipe.size_m * unit(&mut random), recipe.size_m * unit(&mut random)];
            let freshness = 0.3 + 0.7 * unit(&mut random);
            self.bump(center, diameter, |r| freshness * diameter * crater(2.0 * r / diameter));
        }
    }

    fn rocks(&mut self, recipe: &Recipe) -> Result<(), MapError> {
        // Rocks below two cells are the ground's own roughness.
        let least_m = 2.0 * self.cell;
        let most_m = (recipe.size_m / 4.0).max(least_m);
        let rocks = Rocks { cover: recipe.rock_cover, least_m, most_m, seed: recipe.seed };
        for rock in rocks.scatter([0.0; 2], [recipe.size_m; 2])? {
            self.bump(rock.center, 0.5 * rock.diameter, |r| rock.height(r));
        }
        Ok(())
    }

    /// Adds `height` of the distance from `center`, m, to the cells within `reach`.
    ///
    /// Cells by their centres; the map's border cuts.
    fn bump(&mut self, center: [f64; 2], reach: f64, height: impl Fn(f64) -> f64) {
        let last = self.cells as f64 - 1.0;
        let span = |at: f64| {
            let from = ((at - reach) / self.cell - 0.5).ceil().clamp(0.0, last) as usize;
            let to = ((at + reach) / self.cell - 0.5).floor().clamp(0.0, last) as usize;
            from..=to
        };
        for row in span(center[1]) {
            for column in span(center[0]) {
                let dx = (column as f64 + 0.5) * self.cell - center[0];
                let dy = (row as f64 + 0.5) * self.cell - center[1];
                let distance = (dx * dx + dy * dy).sqrt();
                if distance < reach {
                    self.heights[row * self.cells + column] += height(distance);
                }
            }
        }
    }
}

/// Profile of a crater by its diameter, at `r` radii from its centre: a bowl, a rim, and ejecta that end at two radii.
///
/// Over D: −0.2 at the centre, 0.04 at the rim, where the slope jumps, 0 with its slope and bend at two radii.
fn crater(r: f64) -> f64 {
    if r < 1.0 {
        (DEPTH + RIM) * r * r - DEPTH
    } else {
        let left = 2.0 - r;
        RIM * left * left * left
    }
}

/// Perlin's gradient noise with the quintic fade (Perlin 2002), within ± 0.71.
///
/// `at` in cells of the lattice; `gradient` gives unit vectors. C² across cells.
fn gradient_noise(at: [f64; 2], gradient: impl Fn(i64, i64) -> [f64; 2]) -> f64 {
    let (i, j) = (at[0].floor(), at[1].floor());
    let (u, v) = (at[0] - i, at[1] - j);
    let (i, j) = (i as i64, j as i64);
    let corner = |di: i64, dj: i64| {
        let g = gradient(i + di, j + dj);
        g[0] * (u - di as f64) + g[1] * (v - dj as f64)
    };
    let fade = |t: f64| t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
    let mix = |a: f64, b: f64, t: f64| a + t * (b - a);
    let south = mix(corner(0, 0), corner(1, 0), fade(u));
    let north = mix(corner(0, 1), corner(1, 1), fade(u));
    mix(south, north, fade(v))
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;
    use crate::world::terrain::Terrain;

    fn heights(map: &ElevationMap) -> Vec<f32> {
        let n = map.grid().rows;
        (0..n * n).map(|i| map.cell_height(i / n, i % n)).collect()
    }

    #[test]
    fn the_same_seed_gives_the_same_ground_and_another_another() {
        let recipe = Recipe { size_m: 12.0, ..Recipe::default() };
        let (a, b) = (generate(&recipe).expect("ground"), generate(&recipe).expect("ground"));
        assert_eq!(heights(&a), heights(&b));
        let other = generate(&Recipe { seed: 1, ..recipe }).expect("ground");
        assert_ne!(heights(&a), heights(&other));
        let (low, high) = a.extent();
        assert!(low == [0.05, 0.05] && (high[0] - 11.95).abs() < 1e-12 && a.patch(6.0, 6.0).is_ok());
    }

    #[test]
    fn relief_is_about_what_was_asked_and_grows_rougher_with_less_hurst() {
        let bare = Recipe { least_crater_m: f64::INFINITY, rock_cover: 0.0, cell_m: 0.2, ..Recipe::default() };
        let spread = |recipe: &Recipe| {
            let h = heights(&generate(recipe).expect("ground"));
            let mean = h.iter().map(|h| f64::from(*h)).sum::<f64>() / h.len() as f64;
            (h.iter().map(|h| (f64::from(*h) - mean).powi(2)).sum::<f64>() / h.len() as f64).sqrt()
        };
        let relief = spread(&bare);
        assert!((0.15..0.6).contains(&relief), "{relief} m instead of about 0.3 m");
        let slope = |hurst: f64| {
            let map = generate(&Recipe { hurst, ..bare }).expect("ground");
            let at = |i: u32| map.patch(1.0 + 0.0577 * f64::from(i), 30.0).expect("ground").slope;
            (0..1000).map(|i| at(i)[0].powi(2)).sum::<f64>()
        };
        assert!(slope(0.4) > slope(0.9), "{} {}", slope(0.4), slope(0.9));
        let flat = generate(&Recipe { relief_m: 0.0, ..bare }).expect("ground");
        assert!(heights(&flat).iter().all(|h| *h == 0.0));
    }

    #[test]
    fn rocks_cover_the_share_and_craters_dig_to_their_depth() {
        let bare =
            Recipe { relief_m: 0.0, least_crater_m: f64::INFINITY, rock_cover: 0.1, size_m: 40.0, ..Recipe::default() };
        let h = heights(&generate(&bare).expect("ground"));
        let covered = h.iter().filter(|h| **h > 0.0).count() as f64 / h.len() as f64;
        let q = 1.79 + 1.52;
        let expected = 0.1 * libm::exp(-q * 0.2);
        assert!((covered / expected - 1.0).abs() < 0.25, "{covered} instead of {expected}");
        let pits = Recipe { least_crater_m: 4.0, rock_cover: 0.0, crater_area_m2: 1600.0, ..bare };
        let h = heights(&generate(&pits).expect("ground"));
        let deepest = h.iter().fold(0.0_f32, |least, h| least.min(*h));
        let highest = h.iter().fold(0.0_f32, |most, h| most.max(*h));
        assert!(deepest < -0.2 && highest > 0.03 && highest < -deepest, "{deepest} {highest}");
    }

    #[test]
    fn numbers_out_of_bounds_are_named() {
        for (recipe, field) in [
            (Recipe { size_m: 0.0, ..Recipe::default() }, "size_m = 0"),
            (Recipe { cell_m: f64::NAN, ..Recipe::default() }, "cell_m = NaN"),
            (Recipe { size_m: 1e5, cell_m: 0.01, ..Recipe::default() }, "100 million cells"),
            (Recipe { rock_cover: 0.5, ..Recipe::default() }, "rock_cover = 0.5"),
            (Recipe { hurst: -1.0, ..Recipe::default() }, "hurst = -1"),
            (Recipe { least_crater_m: f64::NAN, ..Recipe::default() }, "least_crater_m = NaN"),
        ] {
            let error = generate(&recipe).expect_err(field).to_string();
            assert!(error.contains(field), "{error}");
        }
    }
}
