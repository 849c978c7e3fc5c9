//! Where candidates for legs of flights are lost.

use std::collections::{HashSet, VecDeque};

use super::FlightSetup;
use super::blocking::obstacle;
use super::graph;
use super::stepwise::Stepwise;
use super::witness::Witness;
use crate::campaign::graph::{Counter, GRAPHS, Losses, Stage};
use crate::campaign::scenario::ReachName;
use crate::feasibility::reach::Roadmap;
use crate::feasibility::{Infeasible, Limit};
use crate::world::World;

/// Nodes of a roadmap whose candidates are judged: each has all states of all waypoints.
const NODES: usize = 8;

/// Counts the candidates of the first `graphs` graphs, a few at most.
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

/// Breadth first from the start, over the first 8 nodes and all of their candidates: a sample, not the whole graph.
fn count(setup: &FlightSetup, roadmap: &Roadmap, end: usize, counter: &mut Counter) {
    let length = setup.scenario.task.length as usize;
    let mut open = VecDeque::from([(roadmap.start(), 1)]);
    let mut seen = HashSet::from([roadmap.start()]);
    for _ in 0..NODES {
        let Some((node, passed)) = open.pop_front() else { break };
        if passed >= length {
            break;
        }
        let left = length - passed - 1;
        for fate in roadmap.candidates(&node) {
            match fate {
                Err(None) => counter.lose(Stage::Limits, "max_speed_m_s times the longest leg time"),
                Err(Some(why)) => {
                    let (stage, limit) = stage_of(&why, &setup.world);
                    counter.lose(stage, &limit);
                }
                Ok(next) => {
                    let arrives =
                        if left == 0 { next.waypoint as usize == end } else { roadmap.may_arrive(&next, left) };
                    if !arrives {
                        counter.lose(Stage::EndPoint, "task.end_m");
                        continue;
                    }
                    counter.keep();
                    if seen.insert(next) {
                        open.push_back((next, passed + 1));
                    }
                }
            }
        }
    }
}

/// The stage, and the scenario's key or the obstacle's name; of thrust and rotor speeds the limit's own.
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
