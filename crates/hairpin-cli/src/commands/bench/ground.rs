//! Boundary-value drives of `rocky8` on generated ground: solving alone, success by replay.

use std::f64::consts::PI;
use std::hint::black_box;
use std::time::Instant;

use hairpin::campaign::ground::Site;
use hairpin::feasibility::steering::shooting::flat;
use hairpin::feasibility::steering::shooting::query::{Curvatures, Precision, Query};
use hairpin::feasibility::steering::shooting::rough::{Answer, Settings, Status, Steps};
use hairpin::math::random::stream;
use hairpin::robot::rover::Rover;
use hairpin::trajectory::drive::{Gear, Motion, Planar, Segment, SegmentList};
use hairpin::world::terrain::ElevationMap;
use hairpin::world::terrain::generate::{Recipe, generate};
use hairpin_formats::scenario::rover_for;
use rand::RngExt;

use super::clock::median_time;
use super::{Row, Target};
use crate::args::Bench;
use crate::problem::Problem;

const GOALS: usize = 1000;
/// Drives of more tilt are not asked for, rad.
const STEEP: f64 = PI / 6.0;
/// Goals keep this far from the map's edge, m.
const MARGIN: f64 = 2.0;
/// Steps of the drives whose ends are the goals.
const FINE: Steps = Steps { length: 0.005, angle: 0.005, least: 100 };

pub(super) fn rows() -> Vec<Row> {
    let row = |name, unit, target, measure| Row { name, unit, target, measure };
    let most = |bound| Some(Target::AtMost(bound));
    vec![
        row("steer-ground", "µs", most(350.0), |_: &Bench| Ok(Yard::new()?.mean())),
        row("steer-ground-p99", "µs", most(2000.0), |_| Ok(Yard::new()?.slowest(0.99))),
        row("steer-ground-success", "%", Some(Target::AtLeast(99.9)), |_| Ok(Yard::new()?.success())),
    ]
}

/// Goals on rough ground that were driven to before.
struct Yard {
    rover: Rover,
    map: ElevationMap,
    goals: Vec<(Planar, Planar)>,
}

impl Yard {
    /// Cratered ground of 40 m, and the ends of random curvatures on it, 1 to 6 m away.
    fn new() -> Result<Self, Problem> {
        let rover = rover_for("rocky8")?;
        let recipe =
            Recipe { size_m: 40.0, relief_m: 1.0, crater_area_m2: 40.0, rock_cover: 0.0, seed: 1, ..Recipe::default() };
        let map = generate(&recipe).map_err(Problem::input)?;
        let mut yard = Self { rover, map, goals: Vec::with_capacity(GOALS) };
        let mut random = stream(3);
        while yard.goals.len() < GOALS {
            let length_m: f64 = random.random_range(1.0..6.0);
            let mut curvature = [0.0; 6];
            for (power, a) in curvature.iter_mut().enumerate().take(4) {
                *a = random.random_range(-1.0..1.0) / length_m.powi(power as i32);
            }
            let drive = Segment { motion: Motion::Arc { length_m, curvature }, gear: Gear::Forward };
            let (low, high) = yard.map.extent();
            let mut inside = |i: usize| random.random_range(low[i] + MARGIN..high[i] - MARGIN);
            let start = Planar { x: inside(0), y: inside(1), yaw: 0.0, curvature: curvature[0] };
            let start = Planar { yaw: random.random_range(-PI..PI), ..start };
            if let Some(end) = yard.driven(&start, &drive) {
                yard.goals.push((start, end));
            }
        }
        Ok(yard)
    }

    fn site(&self) -> Site<'_> {
        Site { rover: &self.rover, map: &self.map, speed: self.rover.default_speed, direction: 0.0 }
    }

    /// Where `drive` ends, if it keeps the bounds, the map's margin and the tilt.
    fn driven(&self, start: &Planar, drive: &Segment) -> Option<Planar> {
        let limits = &self.rover.limits;
        let h = drive.length_m() / 500.0;
        let at = |i: i32| drive.curvature_at(h * f64::from(i));
        let kept = (0..=500).all(|i| at(i).abs() <= limits.curvature)
            && (0..500).all(|i| (at(i + 1) - at(i)).abs() <= h * limits.curvature_rate);
        let (low, high) = self.map.extent();
        let driven = self.site().predict(start, &[*drive], FINE).ok().filter(|_| kept)?;
        let clear = |i: usize, at: f64| (low[i] + MARGIN..=high[i] - MARGIN).contains(&at);
        (driven.tilt.0 <= STEEP && clear(0, driven.end.x) && clear(1, driven.end.y)).then_some(driven.end)
    }

    fn solve(&self, (start, goal): &(Planar, Planar)) -> Answer {
        let bounds = Curvatures { most: self.rover.limits.curvature, most_rate: self.rover.limits.curvature_rate };
        let precision = Precision { position: 1e-5, yaw: 1e-5, curvature: 1e-5 };
        let settings = flat::Settings { precision, ..flat::Settings::default() };
        let mut steer = |query: &Query| -> Option<SegmentList> {
            let query = Query::new(query.start_curvature, query.goal, &bounds).ok()?;
            let answer = flat::forward(&query, &bounds, &settings);
            (answer.status == flat::Status::Ok).then_some(answer.segments)
        };
        self.site().solve(start, goal, &bounds, &Settings::default(), &mut steer)
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
