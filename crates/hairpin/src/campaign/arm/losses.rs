//! Where the moves of an arm's graph are lost.

use super::ArmSetup;
use super::graph::whole_graph;
use crate::campaign::Stop;
use crate::campaign::graph::{Counter, Losses, Stage};
use crate::feasibility::reachability::Refusal;

/// Counts the moves between all ordered pairs of points, and the arcs through a third, by what became of them.
///
/// n(n − 1) moves, the arcs where they are asked for, and 2n ways from and to home. Builds the graph again; where
/// that fails nothing is counted.
pub(super) fn losses(setup: &ArmSetup) -> Losses {
    let mut counter = Counter::default();
    if let Ok(graph) = whole_graph(setup, &Stop::never()) {
        let (n, names) = (graph.points(), setup.part_names());
        let pairs = (0..n).flat_map(|from| (0..n).map(move |to| (from, to))).filter(|(from, to)| from != to);
        for (from, to) in pairs {
            match graph.reachability.refusal(from, to) {
                Some(refusal) => {
                    let (stage, limit) = stage_of(refusal, &names);
                    counter.lose(stage, &limit);
                }
                None if graph.costs[from * n + to].is_none() => counter.lose(Stage::Limits, "the table of costs"),
                None => counter.keep(),
            }
        }
        if let Some(arcs) = &graph.arcs {
            counter.keep_many(arcs.free.len() as u64);
            for (_, refusal) in &arcs.refused {
                let (stage, limit) = stage_of(refusal, &names);
                counter.lose(stage, &limit);
            }
        }
        for (free, way) in [(&graph.from_home, "the way from home"), (&graph.to_home, "the way home")] {
            let refused = free.iter().filter(|free| !**free).count() as u64;
            counter.lose_many(Stage::EndPoint, way, refused);
            counter.keep_many(n as u64 - refused);
        }
    }
    counter.losses(if setup.scenario.generate.moves.arcs {
        "moves and arcs between points, from home and back"
    } else {
        "moves between points, from home and back"
    })
}

/// The limit is named as users name it: a part of the cell, an axis (from 1), a kind of singularity.
pub(super) fn stage_of(refusal: &Refusal, names: &[String]) -> (Stage, String) {
    let part = |index: usize| names.get(index).cloned().unwrap_or_else(|| "a part of the cell".into());
    match *refusal {
        Refusal::ToolMeets { part: index, .. } | Refusal::Collides { part: index, .. } => {
            (Stage::Obstacle, part(index))
        }
        Refusal::SelfCollides { .. } => (Stage::Obstacle, "the arm itself".into()),
        Refusal::BeyondReach { .. } => (Stage::Reach, "farther off than the arm with its tool is long".into()),
        Refusal::OutOfReach { .. } => (Stage::Reach, "no joint angles".into()),
        Refusal::NotFound { .. } => (Stage::Reach, "no posture found".into()),
        Refusal::JointLimit { axis, .. } => (Stage::Limits, format!("axis {}", axis + 1)),
        Refusal::Singular { margin, .. } => (Stage::Limits, format!("{} singularity", margin.of)),
        Refusal::Configuration { .. } | Refusal::ArrivesOtherwise { .. } => {
            (Stage::Limits, "configuration change".into())
        }
        Refusal::UnknownConfiguration { .. } => (Stage::Limits, "a configuration that is not known".into()),
        Refusal::NoSuchConfiguration { .. } => (Stage::Limits, "no posture in the demanded configuration".into()),
        Refusal::NoArc(_) | Refusal::Turned { .. } => (Stage::Limits, "no arc".into()),
        Refusal::TooQuick { axis, .. } => (Stage::Limits, format!("speed of axis {}", axis + 1)),
        Refusal::OtherBranch { .. } => (Stage::Limits, "another configuration than most points".into()),
    }
}
