//! Where candidates for legs of boats are lost.

use super::BoatSetup;
use super::solve::BoatSolver;
use crate::campaign::graph::{Counted, Counter, GRAPHS, Losses, Stage};
use crate::feasibility::boat::{BoatInfeasible, BoatLimit, BoatRoadmap};
use crate::feasibility::reach::WitnessNode;

/// Counts the candidates of the first `graphs` graphs, a few at most.
///
/// At most [`GRAPHS`] of them; a graph without enough free water counts nothing.
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

/// States of a roadmap are counted: with V velocities there are V² pairs between two waypoints. The end may be no
/// waypoint on the way.
fn count(roadmap: &BoatRoadmap, length: usize, end: usize, counter: &mut Counter) {
    let arrives = |next: &WitnessNode, left: usize| {
        let last = next.waypoint as usize == end;
        if left == 0 { last } else { !last && roadmap.may_arrive(next, left) }
    };
    let (start, candidates) = (roadmap.start(), |node: &WitnessNode| roadmap.candidates(node));
    Counted { start, length, candidates: &candidates, arrives: &arrives, told: &told }.count(counter);
}

/// Forces of thrusters are what the boat can reach; speeds and times are limits that were asked for.
///
/// `None` is a pair whose distance no leg time covers; nothing was judged of it.
fn told(why: Option<BoatInfeasible>) -> (Stage, String) {
    let Some(why) = why else { return (Stage::Limits, "top speed times the longest leg time".into()) };
    let (stage, limit) = match why.limit() {
        BoatLimit::Speed => (Stage::Limits, "generate.limits.max_speed_m_s"),
        BoatLimit::Duration => (Stage::Limits, "generate.leg_time_s"),
        BoatLimit::Waters => (Stage::World, "world.keep_in_margin_m"),
        BoatLimit::KeepOut => (Stage::Obstacle, "world.keep_out"),
        force => (Stage::Reach, force.name_and_unit().0),
    };
    (stage, limit.into())
}
