//! Flat boundary-value drives of `generic`: solving alone, success by replay, length over that of closed forms.

use hairpin::feasibility::steering::shooting::cc::{self, Gears};
use hairpin::feasibility::steering::shooting::query::{Curvatures, Goal, Query};
use hairpin::feasibility::steering::shooting::solve::{Choices, Solution, solve};
use hairpin::math::random::stream;
use hairpin::trajectory::drive::Segment;
use hairpin::verification::{DriveClaim, DrivePiece, DriveReplay, replay_drive};
use rand::RngExt;

use super::clock::median_time;
use super::{Row, Target};
use crate::args::Bench;
use crate::commands::steer::pieces;
use crate::problem::Problem;

const BOUNDS: Curvatures = Curvatures { most: 1.0, most_rate: 1.0 };
const QUERIES: usize = 10_000;
/// Share by which rounding may exceed a bound.
const ROUNDING: f64 = 1e-9;

pub(super) fn rows() -> Vec<Row> {
    let row = |name, unit, target, measure| Row { name, unit, target, measure };
    let most = |bound| Some(Target::AtMost(bound));
    let all = Some(Target::AtLeast(100.0));
    vec![
        row("steer-feasible", "µs", most(5.0), |_: &Bench| Ok(microseconds(&feasible(), false))),
        row("steer-feasible-success", "%", all, |_| Ok(success(&feasible(), false))),
        row("steer-hard", "µs", most(60.0), |_| Ok(microseconds(&hard(), true))),
        row("steer-hard-success", "%", all, |_| Ok(success(&hard(), true))),
        row("steer-hard-length-median", "× CC", most(1.3), |_| Ok(lengths(&hard()).0)),
        row("steer-hard-length-worst", "× CC", most(2.0), |_| Ok(lengths(&hard()).1)),
        row("steer-cc-reeds-shepp", "µs", None, reference),
    ]
}

fn choices(reversals: bool) -> Choices {
    Choices { reversals, ..Choices::default() }
}

/// Ends of random curvatures of fifth order within the bounds, over 1 … 12 m.
fn feasible() -> Vec<Query> {
    let mut random = stream(1);
    let mut queries = Vec::with_capacity(QUERIES);
    while queries.len() < QUERIES {
        let length: f64 = random.random_range(1.0..12.0);
        let mut curvature = [0.0; 6];
        for (power, a) in curvature.iter_mut().enumerate() {
            *a = random.random_range(-1.0..1.0) / length.powi(power as i32);
        }
        let claim = DriveClaim { start_curvature: curvature[0], crab: 0.0, end: [0.0; 3], end_curvature: 0.0 };
        let replay = replay_drive(&[DrivePiece::Arc { length_m: length, curvature, direction: 1.0 }], &claim);
        if replay.max_curvature <= BOUNDS.most && replay.max_curvature_rate <= BOUNDS.most_rate {
            let [x, y, yaw] = replay.error;
            let goal = Goal { x, y, yaw, curvature: replay.error_curvature };
            queries.push(Query { start_curvature: curvature[0], goal });
        }
    }
    queries
}

/// Anywhere around within 6 m, with any heading, wheels straight at both ends.
fn hard() -> Vec<Query> {
    let mut random = stream(2);
    let mut query = || {
        let mut within = |most: f64| random.random_range(-most..most);
        let goal = Goal { x: within(6.0), y: within(6.0), yaw: within(std::f64::consts::PI), curvature: 0.0 };
        Query { start_curvature: 0.0, goal }
    };
    (0..QUERIES).map(|_| query()).collect()
}

fn microseconds(queries: &[Query], reversals: bool) -> f64 {
    let choices = choices(reversals);
    let all = median_time(5, || {
        queries.iter().map(|query| solve(query, &BOUNDS, &choices, || false).segments.len()).sum::<usize>()
    });
    all / queries.len() as f64 * 1e6
}

fn replay(query: &Query, solution: &Solution) -> DriveReplay {
    let Goal { x, y, yaw, curvature } = query.goal;
    let claim =
        DriveClaim { start_curvature: query.start_curvature, crab: 0.0, end: [x, y, yaw], end_curvature: curvature };
    replay_drive(&pieces(solution), &claim)
}

/// Share (%) whose replay ends within 1 cm, 0.01 rad and 0.01 1/m and keeps both bounds.
fn success(queries: &[Query], reversals: bool) -> f64 {
    let good = |query: &&Query| {
        let found = replay(query, &solve(query, &BOUNDS, &choices(reversals), || false));
        let [x, y, yaw] = found.error;
        libm::hypot(x, y) <= 0.01
            && yaw.abs() <= 0.01
            && found.error_curvature.abs() <= 0.01
            && found.max_curvature <= BOUNDS.most * (1.0 + ROUNDING)
            && found.max_curvature_rate <= BOUNDS.most_rate * (1.0 + ROUNDING)
    };
    queries.iter().filter(good).count() as f64 / queries.len() as f64 * 100.0
}

/// Median and largest length over that of the closed form with cusps.
fn lengths(queries: &[Query]) -> (f64, f64) {
    let mut ratios: Vec<f64> = queries
        .iter()
        .filter_map(|query| {
            let metres = cc::steer(query, &BOUNDS, Gears::Both)?.length_m();
            let found: f64 =
                solve(query, &BOUNDS, &choices(true), || false).segments.iter().map(Segment::length_m).sum();
            Some(found / metres)
        })
        .collect();
    ratios.sort_by(f64::total_cmp);
    (ratios[ratios.len() / 2], ratios[ratios.len() - 1])
}

/// The closed form alone.
fn reference(_: &Bench) -> Result<f64, Problem> {
    let queries = hard();
    let length = |query| cc::steer(query, &BOUNDS, Gears::Both).map_or(0.0, |path| path.length_m());
    Ok(median_time(5, || queries.iter().map(length).sum::<f64>()) / queries.len() as f64 * 1e6)
}
