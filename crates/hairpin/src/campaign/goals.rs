//! Goals that are known to be feasible, because they were driven to: what benches, requirements and tests ask for.
//!
//! A random goal may have no drive; one that a drawn curve leads to has. Curves and goals follow from the random
//! stream alone.

use std::f64::consts::PI;
use std::ops::Range;

use crate::feasibility::steering::shooting::rough::Steps;
use crate::feasibility::steering::shooting::{Curvatures, Goal, Query};
use crate::math::circular::sin_cos;
use crate::math::power::power;
use crate::math::quadrature::Gauss;
use crate::math::random::{Stream, unit};
use crate::trajectory::drive::{Gear, Motion, Planar, Segment};

use super::drive::Site;

/// Share of the bounds that drawn curves keep, for what lies between the samples they are held to.
const KEPT: f64 = 0.998;
/// Samples of a curve.
const SAMPLES: usize = 128;
/// What a curve that breaks a bound is bent less by.
const GENTLER: f64 = 0.8;
/// Panels and nodes of the integral along a curve: twelve radians of turning are exact to 1e-10 m.
const PANELS: usize = 8;
const NODES: usize = 8;

/// Lengths of flat curves, in units of the least radius.
pub const FLAT_LENGTHS: Range<f64> = 1.0..12.0;
/// How far from the start goals are that lie anywhere, in units of the least radius.
pub const ANYWHERE: f64 = 6.0;

/// On the ground: lengths (m), the tilt from which a drive is not asked for (rad), the distance kept from the map's
/// edge (m).
pub const GROUND_LENGTHS: Range<f64> = 1.0..6.0;
const STEEP: f64 = PI / 6.0;
const MARGIN: f64 = 2.0;
/// Steps of the drives whose ends are goals on the ground.
const FINE: Steps = Steps { length: 0.005, angle: 0.005, least: 100 };
/// Steps in which those are driven again where the body's roll or pitch differs by more than this (rad) from what was
/// foreseen: of 10 000 drives on a Mars yard 23 do, and one of them leads nowhere.
const FINEST: Steps = Steps { length: 0.001, angle: 0.001, least: 500 };
const FALL: f64 = 0.05;
/// Drives that are tried for a goal on the ground, at most: maps may be too steep or too small.
const TRIES: usize = 100;

/// A uniform number of `range`.
fn between(random: &mut Stream, range: &Range<f64>) -> f64 {
    range.start + (range.end - range.start) * unit(random)
}

/// An arc driven forward whose curvature, κ(s) = Σ aᵢ sⁱ with `coefficients` of them drawn, keeps `bounds`.
///
/// `lengths` are in units of the least radius, 1 / `bounds.most`; the result in m. Curvature and its rate keep 0.998
/// of the bounds at 128 samples; what breaks them is bent less, by a factor of 0.8 until it does not.
pub fn smooth_arc(random: &mut Stream, bounds: &Curvatures, lengths: &Range<f64>, coefficients: usize) -> Segment {
    let length_m = between(random, lengths);
    let mut shape = [0.0; 6];
    for (order, a) in shape.iter_mut().enumerate().take(coefficients) {
        *a = bounds.most * (2.0 * unit(random) - 1.0) / power(length_m, order);
    }
    let mut scale = 1.0;
    loop {
        let curvature = shape.map(|a| scale * a);
        let arc = Segment { motion: Motion::Arc { length_m, curvature }, gear: Gear::Forward };
        if keeps(&arc, bounds) {
            return arc;
        }
        scale *= GENTLER;
    }
}

fn keeps(arc: &Segment, bounds: &Curvatures) -> bool {
    let h = arc.length_m() / SAMPLES as f64;
    let mut before = arc.curvature_at(0.0);
    (0..=SAMPLES).all(|i| {
        let here = arc.curvature_at(h * i as f64);
        let change = (here - before).abs();
        before = here;
        here.abs() <= KEPT * bounds.most && change <= KEPT * bounds.most_rate * h
    })
}

/// The flat query whose answer is `arc`: ∫ (cos ψ, sin ψ) ds with ψ = ∫ κ ds in closed form.
fn end_of(arc: &Segment) -> Query {
    let Motion::Arc { length_m, curvature } = arc.motion else {
        return Query { start_curvature: 0.0, goal: Goal { x: 0.0, y: 0.0, yaw: 0.0, curvature: 0.0 } };
    };
    let heading = |s: f64| (0..6).rev().fold(0.0, |sum, i| (sum + curvature[i] / (i + 1) as f64) * s);
    let (rule, panel_m) = (Gauss::<NODES>::RULE, length_m / PANELS as f64);
    let (mut x, mut y) = (0.0, 0.0);
    for panel in 0..PANELS {
        for (node, weight) in rule.nodes.iter().zip(&rule.weights) {
            let (sin, cos) = sin_cos(heading((panel as f64 + node) * panel_m));
            x += weight * panel_m * cos;
            y += weight * panel_m * sin;
        }
    }
    let goal = Goal { x, y, yaw: heading(length_m), curvature: arc.curvature_at(length_m) };
    Query { start_curvature: curvature[0], goal }
}

/// A flat query that an arc of fifth order answers, [`FLAT_LENGTHS`] long.
///
/// m, rad, 1/m, start at the origin with heading 0.
pub fn flat_goal(random: &mut Stream, bounds: &Curvatures) -> Query {
    let lengths = FLAT_LENGTHS.start / bounds.most..FLAT_LENGTHS.end / bounds.most;
    end_of(&smooth_arc(random, bounds, &lengths, 6))
}

/// A flat query for any place within ± [`ANYWHERE`], any heading, curvatures within ± `bend` of the bound at both ends:
/// few are met by a forward arc, all with reversals.
///
/// `bend` in 0 … 1. Feasible with reversals as a rule; nothing is promised.
pub fn anywhere(random: &mut Stream, bounds: &Curvatures, bend: f64) -> Query {
    let mut within = |most: f64| most * (2.0 * unit(random) - 1.0);
    let reach = ANYWHERE / bounds.most;
    let goal = Goal { x: within(reach), y: within(reach), yaw: within(PI), curvature: within(bend * bounds.most) };
    Query { start_curvature: within(bend * bounds.most), goal }
}

/// Up to `count` pairs of a start and a goal on the ground of `site` that a cubic arc within the vehicle's bounds
/// joins, [`GROUND_LENGTHS`] long, away from the map's edge and from slopes that tilt the body by 30° and more.
///
/// Fewer where the map has no room for them.
///
/// Pairs of start and goal in the map's frame; the goal is where the settled vehicle comes to in steps of 5 mm.
pub fn ground_goals(site: &Site<'_>, count: usize, random: &mut Stream) -> Vec<(Planar, Planar)> {
    let bounds = site.bounds();
    let (low, high) = site.map.extent();
    let inside = |i: usize| low[i] + MARGIN..high[i] - MARGIN;
    let mut goals = Vec::with_capacity(count);
    if (0..2).any(|i| inside(i).is_empty()) {
        return goals;
    }
    for _ in 0..TRIES.saturating_mul(count) {
        if goals.len() == count {
            break;
        }
        let arc = smooth_arc(random, &bounds, &GROUND_LENGTHS, 4);
        let [x, y] = [0, 1].map(|i| between(random, &inside(i)));
        let start = Planar { x, y, yaw: between(random, &(-PI..PI)), curvature: arc.curvature_at(0.0) };
        let commands = site.after_waiting(&start, &[arc]);
        let Ok(driven) = site.predict(&start, &commands, FINE) else { continue };
        // Where a body falls, a step may lead over a gap in which it has no rest at all.
        if driven.surprise > FALL && site.predict(&start, &commands, FINEST).is_err() {
            continue;
        }
        if driven.tilt.0 <= STEEP && inside(0).contains(&driven.end.x) && inside(1).contains(&driven.end.y) {
            goals.push((start, driven.end));
        }
    }
    goals
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;
    use crate::campaign::drive::replay_flat;
    use crate::math::random::stream;

    #[test]
    fn flat_goals_are_where_their_arcs_end() {
        let bounds = Curvatures { most: 0.5, most_rate: 0.4 };
        let mut random = stream(11);
        for _ in 0..200 {
            let arc = smooth_arc(&mut random, &bounds, &(2.0..24.0), 6);
            let query = end_of(&arc);
            let replay = replay_flat(&query, 0.0, &[arc]);
            assert!(replay.error.iter().all(|error| error.abs() < 1e-8), "{arc:?} {replay:?}");
            assert!(replay.error_curvature == 0.0 && replay.start_error_curvature == 0.0);
            assert!(replay.max_curvature <= bounds.most && replay.max_curvature_rate <= bounds.most_rate, "{replay:?}");
        }
    }
}
