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
use hairpin::world::terrain::generate::generate;
use hairpin_formats::scenario::rover_for;
use hairpin_jobs::Problem;

use super::row::Row;
use crate::clock::median_time;
use crate::drives::{CRATERS, met};
use crate::memory::resident;

const GOALS: usize = 1000;

pub(super) fn rows() -> Vec<Row> {
    vec![
        Row::at_most("steer-ground", "µs", 350.0, |_| Ok(Yard::new(GOALS)?.mean())),
        Row::at_most("steer-ground-p99", "µs", 2000.0, |_| Ok(Yard::new(GOALS)?.slowest(0.99))),
        Row::at_least("steer-ground-success", "%", 99.9, |_| Ok(Yard::new(GOALS)?.success())),
        Row::at_most("steer-ground-start", "ms", 5.0, |_| start()),
        Row::at_most("steer-ground-workspace", "MB", 2.0, |_| memory()),
    ]
}

/// Goals on rough ground that were driven to before.
pub(super) struct Yard {
    rover: Rover,
    map: ElevationMap,
    pub(super) goals: Vec<(Planar, Planar)>,
}

impl Yard {
    /// [`CRATERS`], and the ends of random curves on it, 1 to 6 m away.
    pub(super) fn new(goals: usize) -> Result<Self, Problem> {
        let yard = Self::with(Vec::new())?;
        let goals = ground_goals(&yard.site(), goals, &mut stream(3));
        Ok(Self { goals, ..yard })
    }

    /// The same ground with these goals.
    pub(super) fn with(goals: Vec<(Planar, Planar)>) -> Result<Self, Problem> {
        Ok(Self { rover: rover_for("rocky8")?, map: craters()?, goals })
    }

    fn site(&self) -> Site<'_> {
        Site::straight(&self.rover, &self.map)
    }

    pub(super) fn solve(&self, (start, goal): &(Planar, Planar)) -> Answer {
        self.site().drive(start, goal, &Settings::default())
    }

    /// Mean time of a goal, µs.
    pub(super) fn mean(&self) -> f64 {
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

    /// Share (%) whose replay meets the goal.
    fn success(&self) -> f64 {
        let good = |case: &&(Planar, Planar)| {
            let answer = self.solve(case);
            let replay = self.site().replay(&case.0, &case.1, &answer.segments);
            answer.status == Status::Ok && replay.is_ok_and(|replay| met(replay.error, replay.error_curvature))
        };
        self.goals.iter().filter(good).count() as f64 / self.goals.len() as f64 * 100.0
    }
}

/// The ground of all of these benches.
pub(super) fn craters() -> Result<ElevationMap, Problem> {
    generate(&CRATERS).map_err(Problem::input)
}

/// From a robot's file to its first drive, ms.
fn start() -> Result<f64, Problem> {
    let yard = Yard::new(1)?;
    let Some((start, goal)) = yard.goals.first() else { return Err(Problem::input("the bench's ground has no goal")) };
    let first = || {
        let rover = rover_for("rocky8")?;
        Ok::<_, Problem>(Site { rover: &rover, ..yard.site() }.drive(start, goal, &Settings::default()).iterations)
    };
    Ok(1e3 * median_time(9, first))
}

/// By what the process grows from a map with goals to a solver with a vehicle of its own that has answered them, its
/// stack included, MB.
fn memory() -> Result<f64, Problem> {
    let yard = Yard::new(GOALS)?;
    let before = resident("RssAnon:");
    let rover = rover_for("rocky8")?;
    let site = Site { rover: &rover, ..yard.site() };
    let answers = yard.goals.iter().map(|(start, goal)| site.drive(start, goal, &Settings::default()).iterations);
    black_box(answers.sum::<u32>());
    Ok(resident("RssAnon:") - before)
}
