//! What a generation did, in numbers.

use serde::{Deserialize, Serialize};

/// What a generation did, in numbers; the report's and the verdict's.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Tally {
    /// Units of work done and taken over: graphs or, where `[vary]` shapes the plan, cases. Generation goes on here.
    pub units: u64,
    /// Graphs sampled and searched.
    pub graphs: u64,
    /// Of these, graphs that gave at least one trajectory.
    pub solved: u64,
    /// Of these, graphs proven to have none.
    pub proven_empty: u64,
    /// Nodes expanded.
    pub expansions: u64,
    /// Partial trajectories dropped because the frontier was full.
    pub dropped: u64,
    /// Trajectories found again and not counted twice.
    pub duplicates: u64,
    /// Whether every case asked for was found.
    pub complete: bool,
    /// Whether it was stopped, by a time limit or by Ctrl-C, before its graphs were used up.
    pub stopped: bool,
    /// Where nothing was found: why, in a sentence's part.
    pub nothing: Option<String>,
    /// Names of the files that the cases were read from, in their order, where these are missions made elsewhere.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub missions: Vec<String>,
}

impl Tally {
    /// Cases asked for: as many as `wanted`, or as there were missions.
    pub fn asked(&self, wanted: u64) -> usize {
        if self.missions.is_empty() { wanted as usize } else { self.missions.len() }
    }
}
