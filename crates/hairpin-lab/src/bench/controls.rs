//! Flat drives that end bent, change their speed or travel at an angle, each with an answer by construction.

use hairpin::campaign::drive::replay_flat;
use hairpin::campaign::goals::flat_goal;
use hairpin::feasibility::steering::shooting::families::Problem;
use hairpin::feasibility::steering::shooting::query::{Goal, Query};
use hairpin::feasibility::steering::shooting::solve::{Choices, Outcome};
use hairpin::feasibility::steering::shooting::{Control, Generated, SPEED_PRECISION, flat, generate};
use hairpin::math::random::{stream, unit};
use hairpin::trajectory::{SpeedProfile, Timing};

use super::row::Row;
use super::steer::{FEW, good};
use crate::clock::median_time;
use crate::drives::BOUNDS;

/// Least curvature at the end that is one, 1/m.
const BENT: f64 = 0.05;
/// Speeds at the ends, m/s, and the least difference between them.
const SPEEDS: [f64; 2] = [0.2, 2.0];
const APART: f64 = 0.2;
/// Directions of travel, rad, and the least that is one.
const ASIDE: [f64; 2] = [0.05, 1.5];

pub(super) fn rows() -> Vec<Row> {
    vec![
        Row::unbound("steer-controls-bent", "µs", |_| Ok(micros(&bent(), Control::Quintic))),
        Row::at_least("steer-controls-bent-success", "%", 100.0, |_| Ok(success(&bent(), Control::Quintic))),
        Row::unbound("steer-controls-ramp", "µs", |_| Ok(micros(&ramps(), Control::Quintic))),
        Row::at_least("steer-controls-ramp-success", "%", 100.0, |_| Ok(success(&ramps(), Control::Quintic))),
        Row::unbound("steer-controls-ramp-in-time", "µs", |_| Ok(micros(&timed(), Control::TimePolynomial))),
        Row::at_least("steer-controls-ramp-in-time-success", "%", 100.0, |_| {
            Ok(success(&timed(), Control::TimePolynomial))
        }),
        Row::unbound("steer-controls-crab", "µs", |_| Ok(micros(&crabs(), Control::Quintic))),
        Row::at_least("steer-controls-crab-success", "%", 100.0, |_| Ok(success(&crabs(), Control::Quintic))),
    ]
}

/// A question, in the body's frame, and the direction of travel.
struct Case {
    query: Query,
    speed: SpeedProfile,
    direction: f64,
}

/// Ends of curves whose last curvature is not 0.
fn curves(seed: u64) -> impl Iterator<Item = Query> {
    let mut random = stream(seed);
    std::iter::repeat_with(move || flat_goal(&mut random, &BOUNDS)).filter(|query| query.goal.curvature.abs() > BENT)
}

fn bent() -> Vec<Case> {
    curves(11).take(FEW).map(|query| Case { query, speed: 1.0.into(), direction: 0.0 }).collect()
}

/// With another speed at the end than at the start.
fn ramps() -> Vec<Case> {
    let mut random = stream(12);
    let [low, high] = SPEEDS;
    let mut ramp = || {
        loop {
            let [start, end] = [0, 1].map(|_| low + (high - low) * unit(&mut random));
            if (start - end).abs() > APART {
                return SpeedProfile::Ramp { start, end };
            }
        }
    };
    curves(13).take(FEW).map(|query| Case { query, speed: ramp(), direction: 0.0 }).collect()
}

/// Pieces of a curve that is a polynomial of time.
const PIECES: usize = 2000;
/// Share of the bounds that it keeps.
const KEPT: f64 = 0.99;

/// Ends of curvatures that are polynomials of fifth order in time, under the same ramps.
fn timed() -> Vec<Case> {
    let mut random = stream(14);
    let mut goal = |speed: &SpeedProfile| timed_goal(&mut || unit(&mut random), speed);
    ramps().into_iter().map(|case| Case { query: goal(&case.speed), ..case }).collect()
}

fn timed_goal(draw: &mut dyn FnMut() -> f64, speed: &SpeedProfile) -> Query {
    let length = 1.0 + 11.0 * draw();
    let shape: [f64; 6] = std::array::from_fn(|_| 2.0 * draw() - 1.0);
    let speeds = speed.over(length);
    let h = length / PIECES as f64;
    let curvature = |i: usize| {
        let share = speeds.time_at(h * i as f64) / speeds.duration();
        shape.iter().rev().fold(0.0, |sum, a| sum * share + a)
    };
    let bends: Vec<f64> = (0..=PIECES).map(curvature).collect();
    let rate = bends.windows(2).map(|pair| (pair[1] - pair[0]).abs() / (h * BOUNDS.most_rate)).fold(0.0, f64::max);
    let most = bends.iter().map(|bend| bend.abs() / BOUNDS.most).fold(rate, f64::max);
    let scale = KEPT / most.max(1.0);
    let (mut x, mut y, mut yaw) = (0.0, 0.0, 0.0);
    for pair in bends.windows(2) {
        // The chord of a short arc.
        let turn = 0.5 * scale * (pair[0] + pair[1]) * h;
        let (sin, cos) = libm::sincos(yaw + 0.5 * turn);
        let chord = h * (1.0 - turn * turn / 24.0);
        (x, y, yaw) = (x + chord * cos, y + chord * sin, yaw + turn);
    }
    Query { start_curvature: scale * bends[0], goal: Goal { x, y, yaw, curvature: scale * bends[PIECES] } }
}

/// The bent ones, driven at an angle to the body to either side.
fn crabs() -> Vec<Case> {
    let mut random = stream(15);
    let turned = |query: Query| {
        let size = ASIDE[0] + (ASIDE[1] - ASIDE[0]) * unit(&mut random);
        let direction = if unit(&mut random) < 0.5 { -size } else { size };
        // The way begins along the direction of travel: its goal, seen from the body.
        let (sin, cos) = libm::sincos(direction);
        let Goal { x, y, .. } = query.goal;
        let goal = Goal { x: cos * x - sin * y, y: sin * x + cos * y, ..query.goal };
        Case { query: Query { goal, ..query }, speed: 1.0.into(), direction }
    };
    curves(16).take(FEW).map(turned).collect()
}

fn solve(case: &Case, control: Control) -> Generated {
    let query = flat::crab(&case.query, case.direction);
    let problem = Problem { query, speed: case.speed, swing: 0.0, free_end: false };
    generate(&problem, control, &BOUNDS, &Choices::default(), || false, |_| {})
}

fn micros(cases: &[Case], control: Control) -> f64 {
    let all = || cases.iter().map(|case| solve(case, control).solution.segments.len()).sum::<usize>();
    median_time(5, all) / cases.len() as f64 * 1e6
}

/// Share (%) that is replayed to its goal within the bounds, with the speed that was asked for at both ends.
fn success(cases: &[Case], control: Control) -> f64 {
    let met = |case: &&Case| {
        let Generated { solution, .. } = solve(case, control);
        let timing = Timing::new(&case.speed, &solution.segments);
        let off = (timing.speed_at(0.0) - case.speed.start()).abs().max((timing.end_speed() - case.speed.end()).abs());
        let replay = replay_flat(&case.query, case.direction, &solution.segments);
        solution.outcome == Outcome::Solved && off <= SPEED_PRECISION && good(&replay)
    };
    cases.iter().filter(met).count() as f64 / cases.len() as f64 * 100.0
}
