//! Arcs through points of the cloud: which ordered triples of points the arm can go through in one circular move, and
//! what that costs.

use rayon::prelude::*;

use super::bodies::Bodies;
use super::circle::Circle;
use super::costs::Cost;
use super::motion::Motion;
use super::stations::{JointSettings, Station, moved};
use crate::feasibility::reachability::Refusal;
use crate::math::rotation::rotation_vector;
use crate::robot::arm::{Arm, Joints, Tool};
use crate::world::cell::Cell;

/// Every ordered triple of different points, \[start, point on the way, end\].
///
/// n(n − 1)(n − 2) triples together, in the order of start, via, end.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ArcGraph {
    /// Possible arcs with their costs in the cost's unit, in the order of their triples.
    pub free: Vec<([usize; 3], i64)>,
    /// The others, with what refuses them.
    pub refused: Vec<([usize; 3], Refusal)>,
}

/// Points of an arc have one orientation, within this, rad.
const SAME_TURN: f64 = 1e-9;

/// Every arc from a station through another to a third: followed like any move, every link clear of the cell between
/// samples, from the angles `joints` of its start to those of its end. The tool keeps its orientation, so that all
/// three points must have the same.
///
/// In parallel over starts, the answer in one order. O(n³) arcs, each followed like a move. The angles at the point on
/// the way must exist, though the arc need not pass it in that posture.
pub fn arcs(
    arm: &Arm,
    tool: &Tool,
    cell: &Cell,
    stations: &[Station],
    joints: &[Result<Joints, Refusal>],
    settings: &JointSettings,
    cost: &Cost,
) -> ArcGraph {
    let graph = arcs_until((arm, tool, cell), stations, joints, (settings, cost), &|| false);
    graph.unwrap_or_else(|_| unreachable!("nothing stops it"))
}

/// The same until `over` says so, which is asked before every arc from any thread.
///
/// # Errors
/// How many of the n(n − 1)(n − 2) arcs were looked at by then.
pub fn arcs_until(
    (arm, tool, cell): (&Arm, &Tool, &Cell),
    stations: &[Station],
    joints: &[Result<Joints, Refusal>],
    (settings, cost): (&JointSettings, &Cost),
    over: &(dyn Fn() -> bool + Sync),
) -> Result<ArcGraph, usize> {
    let bodies = Bodies::new(arm, tool, cell, settings.clearance);
    let n = stations.len();
    let one = |[start, via, end]: [usize; 3]| -> Result<i64, Refusal> {
        let met = |point: usize, share: f64| joints[point].as_ref().map_err(|refusal| refusal.shifted(share));
        let (from, _, to) = (met(start, 0.0)?, met(via, 0.5)?, met(end, 1.0)?);
        let [start, via, end] = [start, via, end].map(|point| &stations[point].pose);
        let turned =
            |pose: &nalgebra::Isometry3<f64>| rotation_vector(&(start.rotation.inverse() * pose.rotation)).norm();
        let turn = turned(via).max(turned(end));
        if turn > SAME_TURN {
            return Err(Refusal::Turned { turn });
        }
        let [a, b, c] = [start, via, end].map(|pose| pose.translation.vector);
        let circle = Circle::through(&a, &b, &c).map_err(Refusal::NoArc)?;
        let motion = Motion::circular(start, circle, &end.rotation);
        moved(arm, tool, &bodies, &motion, [from, to], &settings.follow, &mut 0)?;
        Ok(cost.of_move(arm, tool, &motion, from, 0))
    };
    let from = |start: usize| -> ArcGraph {
        let mut graph = ArcGraph::default();
        for via in (0..n).filter(|via| *via != start) {
            for end in (0..n).filter(|end| *end != start && *end != via) {
                if over() {
                    return graph;
                }
                let triple = [start, via, end];
                match one(triple) {
                    Ok(cost) => graph.free.push((triple, cost)),
                    Err(refusal) => graph.refused.push((triple, refusal)),
                }
            }
        }
        graph
    };
    let parts: Vec<ArcGraph> = (0..n).into_par_iter().map(from).collect();
    let all = parts.into_iter().fold(ArcGraph::default(), |mut all, mut part| {
        all.free.append(&mut part.free);
        all.refused.append(&mut part.refused);
        all
    });
    match all.free.len() + all.refused.len() {
        looked_at if looked_at < n * n.saturating_sub(1) * n.saturating_sub(2) => Err(looked_at),
        _ => Ok(all),
    }
}
