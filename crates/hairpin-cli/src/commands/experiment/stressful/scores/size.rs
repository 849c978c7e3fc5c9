//! How large the experiment is, and what the paper prints.

use serde::Deserialize;

use super::kinds::Kind;

/// Size of the experiment.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Size {
    /// Trajectories per cell, each from a graph of its own.
    pub(super) graphs: u64,
    /// Executions of other graphs' trajectories that scores are learned from.
    pub(super) training: u64,
    /// Runs with noise of every trajectory.
    pub(super) runs: u64,
    /// Executions per graph of the search in the loop.
    pub(super) executions: u64,
    /// The same where waypoints are moved as well.
    pub(super) executions_moved: u64,
    /// Executions under noise that those confirm a stress with: within a graph they cost more than they find.
    pub(super) confirm_moved: u64,
    /// Uniform trajectories whose worst is the ceiling; 0: left out.
    pub(super) ceiling: u64,
    pub(super) length: u64,
    /// Waypoints sampled for each graph.
    pub(super) waypoints: u64,
    /// How those are spread that are searched and learned from; the baselines' are uniform.
    pub(super) sampling: String,
    pub(super) seed: u64,
    pub(super) reach: Vec<String>,
    pub(super) controllers: Vec<String>,
    /// What is measured beside the baselines.
    pub(super) kinds: Vec<Kind>,
    /// What deviations are measured from: leg | nearest-leg.
    pub(super) from: String,
}

/// The paper's numbers.
#[derive(Debug, Deserialize)]
pub(super) struct Printed {
    pub(super) controllers: Vec<PrintedRow>,
    pub(super) learned_mean_percent: f64,
}

/// Of one controller.
#[derive(Debug, Deserialize)]
pub(super) struct PrintedRow {
    pub(super) controller: String,
    pub(super) best_percent: f64,
}
