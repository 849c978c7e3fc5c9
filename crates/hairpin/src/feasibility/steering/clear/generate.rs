//! Controls of any family among places to keep out of.
//!
//! A family's curve is bent along a guide by starting its shooting there, not by constraints: places enter the search
//! only by the depth at which finished drives are compared. So a family may fail among places where a longer search
//! would not.

use super::hazards::{Hazards, Intrusion};
use super::solve::solve;
use crate::feasibility::steering::shooting::families::{Among, Iteration, Problem};
use crate::feasibility::steering::shooting::query::{Curvatures, Goal, Query};
use crate::feasibility::steering::shooting::solve::{Choices, Outcome};
use crate::feasibility::steering::shooting::{Control, Generated, generate as shoot, generate_among};
use crate::trajectory::drive::{Gear, Motion, Segment, SegmentList};

/// What is added to what guides keep from places, in turn, m: a family comes near its guide, not onto it.
///
/// Each is one way around for the plain solver, so that four guides cost four of its questions.
const ASIDE: [f64; 4] = [0.05, 0.2, 0.5, 1.0];

/// [`shoot`](crate::feasibility::steering::shooting::generate) and where its drive comes too near to one of `hazards`.
///
/// The default control with a constant direction of travel goes around them, as [`solve`] does. Other families that
/// have parameters to spare ([`Problem::spare`]) are bent along the ways that it finds, kept at several distances, and
/// along the words of Dubins, until one stays clear. Those without any answer with their one drive, which is checked.
///
/// Beside the drive the deepest intrusion of its path; `None` of it: clear all along. Intrusions are of the plane.
///
/// The answer is judged by the same [`Hazards::intrusion`] whatever family it is of. `stop` ends it with what was
/// found.
///
/// Bent drives are tried in the gear of `choices` first, in the other one where reversals are allowed and the first was
/// not clear; `iterations` sums all of them. Where several solve the goal, the one that comes least deep is kept, and
/// the first of equals.
pub fn generate(
    problem: &Problem,
    control: Control,
    bounds: &Curvatures,
    choices: &Choices,
    hazards: &Hazards<'_>,
    mut stop: impl FnMut() -> bool,
    mut observe: impl FnMut(&Iteration),
) -> (Generated, Option<Intrusion>) {
    if control == Control::Quintic && problem.swing == 0.0 && !hazards.keep_outs.is_empty() {
        let found = solve(&problem.query, bounds, choices, hazards, stop);
        return (Generated { solution: found.solution, parameters: None, fit_error: 0.0 }, found.intrusion);
    }
    let mut found = shoot(problem, control, bounds, choices, &mut stop, &mut observe);
    let mut near = hazards.intrusion(&travelled(&found.solution.segments, problem.swing));
    if near.is_none() || found.solution.outcome != Outcome::Solved || problem.spare(control) == 0 {
        return (found, near);
    }
    let other = choices.gear.opposite();
    let gears: &[Gear] = if choices.reversals { &[choices.gear, other] } else { &[choices.gear] };
    let mut iterations = found.solution.iterations;
    for &gear in gears {
        if near.is_none() || stop() {
            break;
        }
        let choices = &Choices { gear, ..*choices };
        let guides = guides(problem, bounds, choices, hazards, &mut stop);
        let depth = |segments: &SegmentList| {
            let mut driven = *segments;
            driven.iter_mut().for_each(|segment| segment.gear = gear);
            hazards.intrusion(&travelled(&driven, problem.swing)).map_or(0.0, |intrusion| intrusion.depth)
        };
        let among = Among { guides: &guides, depth: &depth };
        let tried = generate_among(problem, control, bounds, choices, &among, &mut stop, &mut observe);
        iterations += tried.solution.iterations;
        let intrusion = hazards.intrusion(&travelled(&tried.solution.segments, problem.swing));
        let deep = |intrusion: &Option<Intrusion>| intrusion.map_or(0.0, |intrusion| intrusion.depth);
        if tried.solution.outcome == Outcome::Solved && deep(&intrusion) < deep(&near) {
            (found, near) = (tried, intrusion);
        }
    }
    found.solution.iterations = iterations;
    (found, near)
}

/// Ways around in the gear of `choices`, as if they were driven forward.
///
/// Paths only: their clothoids need not be of the family that is bent along them.
///
/// Each is clear of its places by its distance more than is asked for; distances at which nothing is clear give none.
fn guides(
    problem: &Problem,
    bounds: &Curvatures,
    choices: &Choices,
    hazards: &Hazards<'_>,
    stop: &mut dyn FnMut() -> bool,
) -> Vec<SegmentList> {
    let gear = choices.gear;
    let one_gear = Choices { reversals: false, turns: false, ..*choices };
    // In reverse the direction bends the path the other way, and turns it by as much.
    let path = Problem { swing: gear.sign() * problem.swing, ..*problem }.path(bounds);
    let path = Query { goal: Goal { yaw: problem.query.goal.yaw + problem.swing, ..path.goal }, ..path };
    let mut guides = Vec::new();
    for aside in ASIDE {
        if stop() {
            break;
        }
        let wider = Hazards { radius: hazards.radius + aside, ..*hazards };
        let found = solve(&path, bounds, &one_gear, &wider, &mut *stop);
        // What wider places make impossible is made with what is possible.
        if found.solution.outcome == Outcome::Solved && found.intrusion.is_none() {
            let mut guide = found.solution.segments;
            guide.iter_mut().for_each(|segment| segment.gear = Gear::Forward);
            guides.push(guide);
        }
    }
    guides
}

/// The path that a body on `segments` takes whose direction of travel turns by `swing` along them: it bends as much
/// more.
///
/// κ_path(s) = κ(s) ± swing/L, L the whole length: exact, as the direction turns evenly with arc length. Turns in place
/// and a length of 0 are left as they are. What is answered is only looked along, never driven.
fn travelled(segments: &SegmentList, swing: f64) -> SegmentList {
    let length: f64 = segments.iter().map(Segment::length_m).sum();
    let mut path = *segments;
    if swing != 0.0 && length > 0.0 {
        for segment in path.iter_mut() {
            let sign = segment.gear.sign();
            if let Motion::Arc { curvature, .. } = &mut segment.motion {
                curvature[0] += sign * swing / length;
            }
        }
    }
    path
}
