//! The graph of an arm's cloud as data; it is made in `graph.rs`.

use crate::feasibility::reachability::joint::ArcGraph;
use crate::feasibility::reachability::{ReachabilityGraph, Refusal};
use crate::robot::arm::Joints;

/// The graph of a scenario, ready to be searched.
///
/// Rows are those of the station's cloud.
#[derive(Debug, Clone)]
pub struct ArmGraph {
    /// Which moves are possible, and why the others are not.
    pub reachability: ReachabilityGraph,
    /// Joint angles at every point, rad, or why it has none; in Cartesian mode nobody asked.
    pub postures: Option<Vec<Result<Joints, Refusal>>>,
    /// Costs in whole units, row = from.
    /// `None` where the move is not possible; n × n, its diagonal `None`.
    pub costs: Vec<Option<i64>>,
    /// Whether the move from home to each point is possible.
    pub from_home: Vec<bool>,
    /// Whether the move from each point to home is.
    pub to_home: Vec<bool>,
    /// Arcs from point to point through a third, with costs in whole units, where the scenario takes them.
    pub arcs: Option<ArcGraph>,
    /// What one unit is, in `unit_name`.
    /// A cost of c is c · `unit` in it.
    pub unit: f64,
    /// The unit that users are told: `m`, `s`, `steps`, `rad²/s³`, that of their table.
    pub unit_name: String,
}

impl ArmGraph {
    /// Points of the cloud.
    pub fn points(&self) -> usize {
        self.reachability.points()
    }
}
