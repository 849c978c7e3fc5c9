//! Boundary-value drives of `rocky8` on generated ground: solving alone, success by replay.

use std::hint::black_box;
use std::time::Instant;

use hairpin::campaign::drive::Site;
use hairpin::campaign::goals::ground_goals;
use hairpin::feasibility::steering::shooting::rough::{Answer, Settings, Status};
use hairpin::math::random::stream;
use hairpin::robot::rover::Rover;
use hairpin::trajectory::drive::Planar;
use hairpin::world::terrain::ElevationMap;
use hairpin::world::terrain::generate::{Recipe, generate};
use hairpin_formats::scenario::rover_for;

use super::clock::median_time;
use super::memory::resident;
use super::{Row, Target};
use crate::args::Bench;
use crate::problem::Problem;

const GOALS: usize = 1000;

pub(super) fn rows() -> Vec<Row> {
    let row = |name, unit, target, measure| Row { name, unit, target, measure };
    let most = |bound| Some(Target::AtMost(bound));
    vec![
        row("steer-ground", "µs", most(350.0), |_: &Bench| Ok(Yard::new(GOALS)?.mean())),
        row("steer-ground-p99", "µs", most(2000.0), |_| Ok(Yard::new(GOALS)?.slowest(0.99))),
        row("steer-ground-success", "%", Some(Target::AtLeast(99.9)), |_| Ok(Yard::new(GOALS)?.success())),
        row("steer-ground-start", "ms", most(5.0), start),
        row("steer-ground-workspace", "MB", most(2.0), memory),
    ]
}

/// Cratered ground of 40 m.
pub(in crate::commands) const CRATERS: Recipe = Recipe {
    size_m: 40.0,
    cell_m: 0.1,
    relief_m: 1.0,
    hurst: 0.7,
    least_crater_m: 2.0,
    crater_area_m2: 40.0,
    rock_cover: 0.0,
    seed: 1,
};

/// Goals on rough ground that were driven to before.
pub(super) struct Yard {
    rover: Rover,
    map: ElevationMap,
    pub(super) goals: Vec<(Planar, Planar)>,
}

impl Yard {
    /// [`CRATERS`], and the ends of random curves on it, 1 to 6 m away.
    pub(super) fn new(goals: usize) -> Result<Self, Problem> {
        let (rover, map) = (rover_for("rocky8")?, generate(&CRATERS).map_err(Problem::input)?);
        let yard = Self { rover, map, goals: Vec::new() };
        let goals = ground_goals(&yard.site(), goals, &mut stream(3));
        Ok(Self { goals, ..yard })
    }

    fn site(&self) -> Site<'_> {
        Site::straight(&self.rover, &self.map)
    }

    pub(super) fn solve(&self, (start, goal): &(Planar, Planar)) -> Answer {
        self.site().drive(start, goal, &Settings::default())
    }

    /// Mean time of a goal, µs.
    fn mean(&self) -> f64 {
        let all = median_time(3, || self.goals.iter().map(|goal| self.solve(goal).iterations).sum::<u32>());
        all / self.goals.len() as f64 * 1e6
    }

    /// The time that this share of the goals keeps, each the shortest of five, µs.
    fn slowest(&self, share: f64) -> f64 {
        let shortest = |goal| {
            let once = || {
                let begun = Instant::now();
                black_box(self.solve(goal));
                begun.elapsed().as_secs_f64()
            };
            (0..5).map(|_| once()).fold(f64::INFINITY, f64::min)
        };
        let mut times: Vec<f64> = self.goals.iter().map(shortest).collect();
        times.sort_by(f64::total_cmp);
        times[(share * (times.len() - 1) as f64) as usize] * 1e6
    }

    /// Share (%) whose replay ends within 1 cm, 0.01 rad and 0.01 1/m.
    fn success(&self) -> f64 {
        let good = |case: &&(Planar, Planar)| {
            let answer = self.solve(case);
            let replay = self.site().replay(&case.0, &case.1, &answer.segments);
            answer.status == Status::Ok
                && replay.is_ok_and(|replay| {
                    let [x, y, yaw] = replay.error;
                    libm::hypot(x, y) <= 0.01 && yaw.abs() <= 0.01 && replay.error_curvature.abs() <= 0.01
                })
        };
        self.goals.iter().filter(good).count() as f64 / self.goals.len() as f64 * 100.0
    }
}

/// From a robot's file to its first drive, ms.
fn start(_: &Bench) -> Result<f64, Problem> {
    let yard = Yard::new(1)?;
    let Some((start, goal)) = yard.goals.first() else { return Err(Problem::input("the bench's ground has no goal")) };
    let first = || {
        let rover = rover_for("rocky8")?;
        Ok::<_, Problem>(Site { rover: &rover, ..yard.site() }.drive(start, goal, &Settings::default()).iterations)
    };
    Ok(1e3 * median_time(9, first))
}

/// By what the process grows from a map with goals to a solver with a vehicle of its own that has answered them, its stack included, MB.
fn memory(_: &Bench) -> Result<f64, Problem> {
    let yard = Yard::new(GOALS)?;
    let before = resident("RssAnon:");
    let rover = rover_for("rocky8")?;
    let site = Site { rover: &rover, ..yard.site() };
    let answers = yard.goals.iter().map(|(start, goal)| site.drive(start, goal, &Settings::default()).iterations);
    black_box(answers.sum::<u32>());
    Ok(resident("RssAnon:") - before)
}
