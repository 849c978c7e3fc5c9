//! What is asked of the search.

/// What is asked for.
#[derive(Debug, Clone, PartialEq)]
pub struct WorstSettings {
    /// Trajectories that differ.
    pub cases: usize,
    /// Stresses that each execution is measured by, 1 or more.
    pub targets: usize,
    /// Executions of all together at most, failed ones included.
    pub executions: u64,
    /// Executions that rounds and the first draws are sized for: as many, unless something else ends the search.
    pub sized_for: u64,
    /// Executions of one trial at most.
    pub per_trial: u64,
    /// Seed of all that is drawn.
    pub seed: u64,
}
