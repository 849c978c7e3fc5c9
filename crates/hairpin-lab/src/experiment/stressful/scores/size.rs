//! How large the experiment is, and what the paper prints.

use serde::Deserialize;

use super::kinds::WayKind;

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
    /// Waypoints sampled for each graph, where `reach` does not say.
    waypoints: u64,
    /// How those are spread that are searched and learned from, where `reach` does not say; the baselines' are uniform.
    sampling: String,
    pub(super) seed: u64,
    reach: Vec<Asked>,
    pub(super) controllers: Vec<String>,
    /// What is measured beside the baselines.
    pub(super) kinds: Vec<WayKind>,
    /// What deviations are measured from: leg | nearest-leg.
    pub(super) from: String,
}

/// A feasible set: its name, or what is special to it as well.
#[derive(Debug, Deserialize)]
#[serde(
    untagged,
    expecting = "the name of a reach set, or { set, waypoints, sampling }, of which only the set is needed"
)]
enum Asked {
    Name(String),
    Own(OwnGraphs),
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct OwnGraphs {
    set: String,
    waypoints: Option<u64>,
    sampling: Option<String>,
}

/// The graphs of a feasible set.
#[derive(Debug, Clone)]
pub(super) struct Graphs {
    /// The feasible set.
    pub(super) reach: String,
    /// Waypoints sampled for each graph.
    pub(super) waypoints: u64,
    /// How those are spread that are searched and learned from; the baselines' are uniform.
    pub(super) sampling: String,
}

impl Size {
    /// The graphs of every feasible set.
    pub(super) fn graphs(&self) -> impl Iterator<Item = Graphs> {
        self.reach.iter().map(|asked| {
            let (set, waypoints, sampling) = match asked {
                Asked::Name(set) => (set, None, None),
                Asked::Own(own) => (&own.set, own.waypoints, own.sampling.clone()),
            };
            Graphs {
                reach: set.clone(),
                waypoints: waypoints.unwrap_or(self.waypoints),
                sampling: sampling.unwrap_or_else(|| self.sampling.clone()),
            }
        })
    }
}

impl Graphs {
    /// A name for files.
    pub(super) fn name(&self) -> String {
        format!("{}-{}-{}", self.reach, self.waypoints, self.sampling)
    }
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
