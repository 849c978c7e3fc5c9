//! What is examined: vehicles, the ground, and the problems they are asked.

use std::f64::consts::PI;
use std::path::PathBuf;

use hairpin::campaign::drive::Site;
use hairpin::campaign::goals::{anywhere, flat_goal, ground_goals};
use hairpin::feasibility::steering::shooting::{Curvatures, Query};
use hairpin::math::random::stream;
use hairpin::robot::rover::{Response, Rover, Slip};
use hairpin::trajectory::drive::Planar;
use hairpin::world::terrain::generate::{Recipe, generate};
use hairpin::world::terrain::{ElevationMap, Grid, HoleRule, Rocks, Terrain, add_rocks};
use hairpin_formats::scenario::rover_for;
use hairpin_formats::steering::{Asked, Frame};
use hairpin_formats::terrain::Georeference;
use hairpin_jobs::Problem;
use hairpin_jobs::steer::seen_from;
use hairpin_jobs::terrain::read_map;

use crate::drives;

/// What is examined, and how much of it.
#[derive(Debug, Clone, PartialEq)]
pub struct RequirementsSettings {
    /// Queries of each large family.
    pub queries: usize,
    /// The rough ground; cratered ground from a seed if not given.
    pub terrain: Option<TerrainSettings>,
}

/// A map to drive on.
#[derive(Debug, Clone, PartialEq)]
pub struct TerrainSettings {
    /// Its file.
    pub file: PathBuf,
    /// What the file does not say of itself.
    pub georeference: Georeference,
    /// The share of it that is covered with rocks first, those of two cells and more.
    pub rocks: Option<f64>,
}

/// The embedded ground.
pub(super) const CRATERS: Recipe = Recipe { size_m: 30.0, relief_m: 0.5, seed: 3, ..drives::CRATERS };

/// Diameter to which larger rocks are cut, m.
const LARGEST_ROCK: f64 = 1.5;

/// Vehicles, ground, and how many queries.
pub(super) struct Subject {
    /// Unity response, a point in the plane.
    pub(super) generic: Rover,
    /// Six wheels on a rocker-bogie, as it is shipped.
    pub(super) rocky8: Rover,
    /// The same with delay, lag and slip.
    pub(super) late: Rover,
    pub(super) ground: ElevationMap,
    ground_name: String,
    pub(super) queries: usize,
}

impl Subject {
    pub(super) fn new(settings: &RequirementsSettings) -> Result<Self, Problem> {
        let rocky8 = rover_for("rocky8")?;
        let (ground, ground_name) = match &settings.terrain {
            Some(TerrainSettings { file, georeference, rocks }) => {
                let (map, name) = (read_map(file, georeference)?.map, file.display().to_string());
                match *rocks {
                    Some(cover) => rocky(&map, &name, cover)?,
                    None => (map, name),
                }
            }
            None => {
                let name = format!("the generator's craters, seed {}, {} m", CRATERS.seed, CRATERS.size_m);
                (generate(&CRATERS).map_err(Problem::input)?, name)
            }
        };
        let late = late(&rocky8);
        Ok(Self { generic: rover_for("generic")?, rocky8, late, ground, ground_name, queries: settings.queries })
    }

    /// What the numbers are of.
    pub(super) fn notes(&self) -> Vec<String> {
        let late = &self.late;
        vec![
            format!(
                "flat ground: {}, |κ| ≤ 1 1/m, |κ'| ≤ 1 1/m²; rough ground: {}, slopes of {:.1}° in the mean and {:.0}° at most",
                self.generic.name,
                self.ground_name,
                self.slopes().0.to_degrees(),
                self.slopes().1.to_degrees()
            ),
            format!("{}: {}", self.rocky8.name, self.rocky8.caveat),
            format!(
                "with dynamics: latency {} s, steering lag {} s, at most {:.0}°/s, slip {:.0} % and drift {:.0} % at 20°",
                late.response.latency,
                late.response.steering_time_constant,
                late.response.steering_rate.to_degrees(),
                100.0 * late.slip.at_20_deg,
                100.0 * late.slip.side_at_20_deg
            ),
        ]
    }

    /// Mean and largest slope of the rough ground at its cells' centres, rad.
    fn slopes(&self) -> (f64, f64) {
        let (grid, (low, _)) = (self.ground.grid(), self.ground.extent());
        let (mut sum, mut count, mut most) = (0.0, 0.0, 0.0_f64);
        for cell in 0..grid.rows * grid.columns {
            let at = [cell % grid.columns, cell / grid.columns];
            let [x, y] = [0, 1].map(|i| low[i] + grid.cell[i] * at[i] as f64);
            let Ok(patch) = self.ground.patch(x, y) else { continue };
            let slope = libm::atan(libm::hypot(patch.slope[0], patch.slope[1]));
            (sum, count, most) = (sum + slope, count + 1.0, most.max(slope));
        }
        (sum / f64::max(count, 1.0), most)
    }

    pub(super) fn bounds(&self) -> Curvatures {
        bounds(&self.generic)
    }

    /// `count` goals of `rover` on the rough ground that were driven to before.
    pub(super) fn goals(&self, rover: &Rover, count: usize, seed: u64) -> Result<Vec<(Planar, Planar)>, Problem> {
        let goals = ground_goals(&Site::straight(rover, &self.ground), count, &mut stream(seed));
        if goals.len() < count {
            return Err(Problem::input(format!(
                "{}: it has room for {} of {count} drives of 1 to 6 m under 30° of tilt",
                self.ground_name,
                goals.len()
            )));
        }
        Ok(goals)
    }
}

/// `map` with rocks that cover the share `cover` of it, and what it is then called.
fn rocky(map: &ElevationMap, name: &str, cover: f64) -> Result<(ElevationMap, String), Problem> {
    let (low, high) = map.extent();
    let cell = map.grid().cell[0].max(map.grid().cell[1]);
    let rocks = Rocks { cover, least_m: 2.0 * cell, most_m: LARGEST_ROCK, seed: 2021 };
    let rocks = rocks.scatter(low, high).map_err(|error| Problem::input(format!("--rocks {cover}: {error}")))?;
    Ok((add_rocks(map, &rocks), format!("{name} with {} rocks", rocks.len())))
}

pub(super) fn bounds(rover: &Rover) -> Curvatures {
    Curvatures { most: rover.limits.curvature, most_rate: rover.limits.curvature_rate }
}

/// `rover` with commands that act late and ground that gives way.
pub(super) fn late(rover: &Rover) -> Rover {
    let response = Response { latency: 0.2, steering_time_constant: 0.2, steering_rate: PI / 6.0, ..rover.response };
    Rover { response, slip: Slip { at_20_deg: 0.3, side_at_20_deg: 0.15 }, ..rover.clone() }
}

/// Level ground of 100 m around the origin.
pub(super) fn level() -> Result<ElevationMap, Problem> {
    let grid = Grid { columns: 11, rows: 11, first_center: [-50.0, -50.0], cell: [10.0, 10.0] };
    ElevationMap::new(grid, &[0.0; 121], HoleRule::Error).map_err(Problem::input)
}

/// `count` flat queries with whether the gear may change: two of three are ends of smooth curves, the rest lie
/// anywhere.
pub(super) fn flat_queries(bounds: &Curvatures, count: usize, seed: u64) -> Vec<(Query, bool)> {
    let mut random = stream(seed);
    let mut query = |i: usize| match i % 3 {
        2 => (anywhere(&mut random, bounds, 0.0), true),
        _ => (flat_goal(&mut random, bounds), false),
    };
    (0..count).map(&mut query).collect()
}

/// Distance, and heading with one metre a radian: what is missing to a goal.
pub(super) fn missing(from: &Planar, to: &Planar) -> f64 {
    libm::hypot(to.x - from.x, to.y - from.y) + libm::remainder(to.yaw - from.yaw, 2.0 * PI).abs()
}

/// The question as files have it: the goal as it is seen from the start.
pub(super) fn asked(start: &Planar, goal: &Planar) -> Asked {
    let from = [start.x, start.y, start.yaw];
    let [x, y] = seen_from(from, [goal.x, goal.y]);
    Asked {
        start: Some(from),
        goal: [x, y, goal.yaw - start.yaw],
        k0: start.curvature,
        kf: goal.curvature,
        free_end: false,
        v0: None,
        vf: None,
        direction: 0.0,
        direction_end: None,
        frame: Frame::Enu,
        max_curvature: None,
        tolerance_m: None,
    }
}
