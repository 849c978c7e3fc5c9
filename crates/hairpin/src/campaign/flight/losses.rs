//! Where candidates for legs of flights are lost.
//!
//! Counted near the start of a few graphs, in the order of the tests: what explain begins with, not a statistic of
//! the whole.

use super::FlightSetup;
use super::blocking::obstacle;
use super::graph;
use super::stepwise::Stepwise;
use super::witness::Witness;
use crate::campaign::graph::{Counted, Counter, GRAPHS, Losses, Stage};
use crate::campaign::scenario::ReachName;
use crate::feasibility::reach::{Roadmap, WitnessNode};
use crate::feasibility::{Infeasible, Limit};
use crate::world::World;

/// Counts the candidates of the first `graphs` graphs, a few at most.
///
/// Empty where the reach set cannot be made.
pub(super) fn losses(setup: &FlightSetup, graphs: u64) -> Losses {
    let mut counter = Counter::default();
    let sampled = (0..graphs.min(GRAPHS)).filter_map(|number| Some((number, graph::sample(setup, number).ok()?)));
    if setup.scenario.generate.reach == ReachName::Witness {
        if let Ok(set) = Witness::new(setup) {
            for (number, points) in sampled {
                count(setup, &set.roadmap(number, &points), points.len() - 1, &mut counter);
            }
        }
        return counter.losses("pairs of waypoint states near the start");
    }
    if let Ok(set) = Stepwise::new(setup) {
        for (_, points) in sampled {
            set.count(&points, &mut counter);
        }
    }
    counter.losses("pairs of waypoints near the start")
}

/// A leg that is refused counts once, by the first limit that refused it.
///
/// States of a roadmap are counted, not waypoints: with V velocities there are V² pairs between two of them.
fn count(setup: &FlightSetup, roadmap: &Roadmap, end: usize, counter: &mut Counter) {
    let arrives = |next: &WitnessNode, left: usize| {
        if left == 0 { next.waypoint as usize == end } else { roadmap.may_arrive(next, left) }
    };
    let told = |why: Option<Infeasible>| match why {
        None => (Stage::Limits, "max_speed_m_s times the longest leg time".into()),
        Some(why) => stage_of(&why, &setup.world),
    };
    let (start, length) = (roadmap.start(), setup.scenario.task.length as usize);
    let candidates = |node: &WitnessNode| roadmap.candidates(node);
    Counted { start, length, candidates: &candidates, arrives: &arrives, told: &told }.count(counter);
}

/// The stage, and the scenario's key or the obstacle's name; of thrust and rotor speeds the limit's own.
///
/// Thrust and rotor speeds count as reach: they are the robot's own, not limits of the scenario.
fn stage_of(why: &Infeasible, world: &World) -> (Stage, String) {
    let (Infeasible::Violates { limit, part, .. } | Infeasible::Unproven { limit, part, .. }) = *why;
    let (stage, name) = match limit {
        Limit::Speed => (Stage::Limits, "generate.limits.max_speed_m_s"),
        Limit::Tilt => (Stage::Limits, "generate.limits.max_tilt_deg"),
        Limit::Duration => (Stage::Limits, "generate.timing"),
        Limit::World => (Stage::World, "world.keep_in_margin_m"),
        Limit::Obstacle => return (Stage::Obstacle, obstacle(world, part as usize)),
        Limit::Thrust | Limit::RotorMin | Limit::RotorMax => (Stage::Reach, limit.name_and_unit().0),
    };
    (stage, name.into())
}
