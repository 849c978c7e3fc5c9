//! `generate.search`: how a graph is searched, whatever moves through it.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::findings::Findings;
use crate::judgement::Stress;

pub use crate::search::Aggregate;
pub use crate::world::Sampling;

/// `generate.search`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct SearchSection {
    /// beam | exact | uniform | in-loop.
    pub method: SearchMethod,
    /// Waypoints sampled per graph.
    pub waypoints: u64,
    /// How they are sampled.
    pub sampling: Sampling,
    /// Partial trajectories expanded per iteration.
    pub width: u64,
    /// Cases asked for: one best per sampled graph, unless `per_graph` asks for more.
    pub cases: u64,
    /// Trajectories taken from one graph at most.
    pub per_graph: u64,
    /// Whether a waypoint may be used twice.
    pub revisits: bool,
    /// How scores of legs become the score of a trajectory.
    pub aggregate: Aggregate,
    /// Iterations per graph at most.
    pub iterations: u64,
    /// Partial trajectories kept on the frontier at most; the worst are dropped.
    pub frontier: u64,
    /// Graphs sampled at most; 20 per case asked for if not given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub graphs: Option<u64>,
    /// `in-loop`: executions per graph at most.
    pub executions: u64,
    /// `in-loop`: whether waypoints are moved off their graph, as far as the reach set lets them.
    pub move_waypoints: bool,
    /// `in-loop`: what is searched for: max-deviation | mean-deviation | max-acceleration | time | overshoot | saturation | tilt.
    pub stress: Stress,
}

impl Default for SearchSection {
    fn default() -> Self {
        Self {
            method: SearchMethod::Beam,
            waypoints: 250,
            sampling: Sampling::Uniform,
            width: 5,
            cases: 100,
            per_graph: 1,
            revisits: false,
            aggregate: Aggregate::Sum,
            iterations: 10_000,
            frontier: 100_000,
            graphs: None,
            executions: 200,
            move_waypoints: false,
            stress: Stress::MaxDeviation,
        }
    }
}

/// The searches.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum SearchMethod {
    /// Algorithms 1 and 2 of the paper.
    Beam,
    /// Dynamic programming: the optimum, or the proof that there is none.
    Exact,
    /// Uniform over all feasible trajectories: the random baseline.
    Uniform,
    /// Simulation in the loop: trajectories are scored by executing them.
    InLoop,
}

impl SearchSection {
    /// Bounds of all that does not depend on what moves: but for `waypoints`.
    pub(super) fn check(&self, found: &mut Findings) {
        found.count("generate.search.width", self.width, 1, 100_000);
        found.count("generate.search.cases", self.cases, 1, 1_000_000);
        found.count("generate.search.per_graph", self.per_graph, 1, 1_000_000);
        found.count("generate.search.iterations", self.iterations, 1, 1_000_000_000);
        // A partial trajectory on the frontier is some hundred bytes: ten million are a few GB.
        found.count("generate.search.frontier", self.frontier, 1, 10_000_000);
        found.count("generate.search.executions", self.executions, 1, 1_000_000);
        if let Some(graphs) = self.graphs {
            found.count("generate.search.graphs", graphs, 1, 1_000_000_000);
        }
    }
}
