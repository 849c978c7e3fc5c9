//! Queries that are feasible by construction, and a replay that shares nothing with the solver.

mod answers;
mod closed_forms;
mod families;
mod start_table;

use std::f64::consts::TAU;

use super::{Answer, Curvatures, Query};
use crate::feasibility::steering::shooting::query::Goal;
use crate::math::random::hashed_unit;
use crate::trajectory::drive::{Motion, Segment};

pub(super) const BOUNDS: Curvatures = Curvatures { most: 1.0, most_rate: 1.0 };

/// A random query's own numbers: uniform in a range, by name.
pub(super) fn draw(seed: u64, name: u64, from: f64, to: f64) -> f64 {
    from + (to - from) * hashed_unit(seed, &[name])
}

/// x, y, heading at the end of a curve of `length` with curvature κ(s), driven at `direction` to the heading: Simpson's
/// rule.
pub(super) fn integrate(length: f64, direction: f64, curvature: impl Fn(f64) -> f64) -> [f64; 3] {
    let steps = 4000;
    let h = length / f64::from(steps);
    let [mut x, mut y, mut heading] = [0.0, 0.0, 0.0];
    for i in 0..steps {
        let s = f64::from(i) * h;
        let [from, mid, to] = [0.0, 0.5, 1.0].map(|part| curvature(s + part * h));
        let middle = heading + h / 24.0 * (5.0 * from + 8.0 * mid - to);
        let end = heading + h / 6.0 * (from + 4.0 * mid + to);
        let sum = |f: fn(f64) -> f64| f(heading + direction) + 4.0 * f(middle + direction) + f(end + direction);
        x += h / 6.0 * sum(f64::cos);
        y += h / 6.0 * sum(f64::sin);
        heading = end;
    }
    [x, y, heading]
}

/// The query whose answer is the curve.
pub(super) fn query_of(length: f64, curvature: impl Fn(f64) -> f64) -> Query {
    let [x, y, yaw] = integrate(length, 0.0, &curvature);
    let (start, end) = (curvature(0.0).clamp(-1.0, 1.0), curvature(length).clamp(-1.0, 1.0));
    Query::new(start, Goal { x, y, yaw: yaw.rem_euclid(TAU), curvature: end }, &BOUNDS).expect("a query")
}

/// What a replay of an answer shows.
#[derive(Debug, Default)]
pub(super) struct Replay {
    /// Distance (m) and differences of heading (rad) and of curvature (1/m) at the goal.
    pub(super) miss: [f64; 3],
    /// Largest |κ|, largest |κ′|, largest jump of κ.
    pub(super) bends: [f64; 3],
    pub(super) length: f64,
}

pub(super) fn replay(segments: &[Segment], query: &Query) -> Replay {
    let mut replay = Replay::default();
    let ([mut x, mut y, mut heading], mut curvature) = ([0.0_f64; 3], query.start_curvature);
    for segment in segments {
        let Motion::Arc { length_m, curvature: a } = segment.motion else { panic!("no turns in forward drives") };
        let [dx, dy, turn] = integrate(length_m, 0.0, |s| segment.curvature_at(s));
        let (sin, cos) = f64::sin_cos(heading);
        (x, y, heading) = (x + cos * dx - sin * dy, y + sin * dx + cos * dy, heading + turn);
        replay.bends[2] = replay.bends[2].max((a[0] - curvature).abs());
        for i in 0..=1000 {
            let s = length_m * f64::from(i) / 1000.0;
            let rate = (1..6).rev().fold(0.0, |sum, k| sum * s + k as f64 * a[k]);
            replay.bends[0] = replay.bends[0].max(segment.curvature_at(s).abs());
            replay.bends[1] = replay.bends[1].max(rate.abs());
        }
        curvature = segment.curvature_at(length_m);
        replay.length += length_m;
    }
    let turned = (heading - query.goal.yaw + TAU / 2.0).rem_euclid(TAU) - TAU / 2.0;
    replay.miss =
        [f64::hypot(x - query.goal.x, y - query.goal.y), turned.abs(), (curvature - query.goal.curvature).abs()];
    replay
}

/// Holds an answer that says `Ok` to what that means.
pub(super) fn hold_to_its_word(answer: &Answer, query: &Query, bounds: &Curvatures, what: &str) -> f64 {
    let replay = replay(&answer.segments, query);
    assert!(replay.miss.iter().all(|miss| *miss < 1e-3), "{what}: {query:?} {replay:?}");
    let [curvature, rate, jump] = replay.bends;
    assert!(curvature <= bounds.most * (1.0 + 1e-8), "{what}: {query:?} {replay:?}");
    assert!(rate <= bounds.most_rate * (1.0 + 1e-8), "{what}: {query:?} {replay:?}");
    assert!(jump < 1e-9, "{what}: {query:?} {replay:?}");
    replay.length
}
