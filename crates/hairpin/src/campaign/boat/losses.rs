//! Where candidates for legs of boats are lost.

use std::collections::{HashSet, VecDeque};

use super::BoatSetup;
use super::solve::BoatSolver;
use crate::campaign::graph::{Counter, GRAPHS, Losses, Stage};
use crate::feasibility::boat::{BoatInfeasible, BoatLimit, BoatRoadmap};

/// Nodes of a roadmap whose candidates are judged: each has all states of all waypoints.
const NODES: usize = 8;

/// Counts the candidates of the first `graphs` graphs, a few at most.
pub(super) fn losses(setup: &BoatSetup, graphs: u64) -> Losses {
    let mut counter = Counter::default();
    if let Ok(solver) = BoatSolver::new(setup) {
        for number in 0..graphs.min(GRAPHS) {
            if let Ok(points) = solver.sample(number) {
                let length = setup.scenario.task.length as usize;
                count(&solver.roadmap(number, &points), length, points.len() - 1, &mut counter);
            }
        }
    }
    counter.losses("pairs of waypoint states near the start")
}

fn count(roadmap: &BoatRoadmap, length: usize, end: usize, counter: &mut Counter) {
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
                Err(None) => counter.lose(Stage::Limits, "top speed times the longest leg time"),
                Err(Some(why)) => {
                    let (stage, limit) = told(&why);
                    counter.lose(stage, limit);
                }
                Ok(next) => {
                    let last = next.waypoint as usize == end;
                    if if left == 0 { !last } else { last || !roadmap.may_arrive(&next, left) } {
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

fn told(why: &BoatInfeasible) -> (Stage, &'static str) {
    match why.limit() {
        BoatLimit::Speed => (Stage::Limits, "generate.limits.max_speed_m_s"),
        BoatLimit::Duration => (Stage::Limits, "generate.leg_time_s"),
        BoatLimit::Waters => (Stage::World, "world.keep_in_margin_m"),
        BoatLimit::KeepOut => (Stage::Obstacle, "world.keep_out"),
        force => (Stage::Reach, force.name_and_unit().0),
    }
}
