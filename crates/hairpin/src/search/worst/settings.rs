//! What is asked of the search.
//!
//! Counts only, no time: the same settings give the same answer on any machine.

/// What is asked for.
///
/// All executions are shared by all cases: what one case taught another begins with. Ten or more executions a case
/// are needed for more than draws.
#[derive(Debug, Clone, PartialEq)]
pub struct WorstSettings {
    /// Trajectories that differ.
    ///
    /// At most as many are found; 0 finds none, but executes all the same.
    pub cases: usize,
    /// Stresses that each execution is measured by, 1 or more.
    ///
    /// As many as [`Ran::trials`](super::Ran::trials) has entries. 0 is taken as 1.
    pub targets: usize,
    /// Executions of all together at most, failed ones included.
    /// A trial of several executions counts each. It is not begun unless `per_trial` are left.
    pub executions: u64,
    /// Executions that rounds and the first draws are sized for: as many, unless something else ends the search.
    ///
    /// Apart from `executions` for searches that are gone on with or ended by a clock: rounds of (this / 40, between
    /// 8 and 64) places, so that the answer does not depend on which limit ends it.
    pub sized_for: u64,
    /// Executions of one trial at most.
    /// 0 is taken as 1. It is a promise of [`Field::run`](super::Field::run), by which the last trials stay within
    /// `executions`.
    pub per_trial: u64,
    /// Seed of all that is drawn.
    /// Named seeds are made of it; plans drawn by [`Field::draw`](super::Field::draw) have the field's own.
    pub seed: u64,
}
