//! Algorithms 1 and 2 of the paper on one graph: a frontier of scored partial trajectories, widened from its best.
//!
//! Per iteration the best `width` partial trajectories leave the frontier; those of full length are complete, the
//! others are expanded by every waypoint in reach, scored and put back. What was not selected stays. The first
//! iteration after which `per_graph` distinct trajectories are complete ends the graph.
//!
//! Source: Hildebrandt et al., *Feasible and stressful trajectory generation for mobile robots*, ISSTA 2020.

mod atlas;
mod reduction;
mod run;
#[cfg(test)]
mod tests;

use super::growth::{ByLegs, Growth};
use super::objective::{Aggregate, Objective};
use super::task::{Found, Task};
use crate::feasibility::reach::Reach;
pub use run::Snapshot;

/// How a graph is searched. The defaults are the paper's, and ours where it has none.
///
/// Iterations · width expansions at most, each one reach set (remembered) and as many scores as it has legs; memory is
/// `frontier` partial trajectories, which share their beginnings.
#[derive(Debug, Clone, PartialEq)]
pub struct BeamSettings {
    /// Waypoints of a trajectory, both ends included; below 2 there is no trajectory.
    pub length: usize,
    /// Partial trajectories expanded per iteration; 0 is taken as 1.
    pub width: usize,
    /// Distinct trajectories after which the graph ends; 0 is taken as 1. The last iteration may give more.
    pub per_graph: usize,
    /// Whether a waypoint may be used twice. Without revisits the optimum is not back and forth between two points.
    pub revisits: bool,
    /// How legs add up.
    pub aggregate: Aggregate,
    /// Iterations after which the graph is given up: an infeasible graph may never end by itself.
    pub iterations: usize,
    /// Partial trajectories kept after an iteration; the worst are dropped and counted.
    pub frontier: usize,
    /// Of partial trajectories with equal length and node only the best so many are kept (*commutativity reduction*);
    /// `None` keeps all. Their futures are the same with revisits, if the objective has no memory, and then nothing
    /// is lost as long as this is at least `per_graph`. Without revisits futures differ by what was visited, and the
    /// reduction is a heuristic that may lose trajectories: it then withholds the proof that there is none. The
    /// default, 3, solved the same 200 graphs of 250 waypoints as `None` at lengths 8, 10 and 50, and makes hard graphs
    /// end.
    pub keep: Option<usize>,
    /// Steps from the end within which it is known exactly whether the end can be reached (lazily computed backward
    /// pass over walks), at most 64; further away only `may_arrive` is asked.
    pub lookahead: usize,
}

impl Default for BeamSettings {
    fn default() -> Self {
        Self {
            length: 10,
            width: 5,
            per_graph: 1,
            revisits: false,
            aggregate: Aggregate::Sum,
            iterations: 10_000,
            frontier: 100_000,
            keep: Some(3),
            lookahead: 3,
        }
    }
}

/// Why a graph ended.
///
/// Only `Exhausted { proof: true }` says anything of trajectories that were not found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ended {
    /// `per_graph` trajectories were found.
    Complete,
    /// Nothing is left to expand.
    Exhausted {
        /// Whatever was dropped cannot reach the end, or has a kept twin with the same futures: if nothing was found,
        /// there is nothing.
        proof: bool,
    },
    /// The iterations were used up, or what scores does not go on.
    Capped,
}

/// What a graph gave.
#[derive(Debug, Clone, PartialEq)]
pub struct BeamOutcome<N> {
    /// Distinct trajectories, best score first, ties by waypoint index.
    pub found: Vec<Found<N>>,
    /// Why the graph ended.
    pub ended: Ended,
    /// Iterations made.
    pub iterations: usize,
    /// Partial trajectories expanded.
    pub expansions: u64,
    /// Reach sets evaluated; the others were remembered.
    pub evaluations: u64,
    /// Partial trajectories dropped because the frontier was full.
    pub dropped: u64,
    /// Partial trajectories not made because they could not be scored.
    pub unkept: u64,
    /// Partial trajectories not made because the end is out of their reach.
    pub pruned: u64,
    /// Partial trajectories not kept because as good a one has the same future.
    pub reduced: u64,
    /// Trajectories found again over other nodes.
    pub duplicates: u64,
}

/// Searches one graph. `may_arrive(node, steps)` is a necessary test: false only if no `steps` legs lead from `node` to
/// the end.
///
/// No bound on how far from the best an answer is: [`super::exact()`] has one.
pub fn beam<N, R, O>(
    task: &Task<'_, N, R>,
    objective: &O,
    may_arrive: impl Fn(&N, usize) -> bool,
    settings: &BeamSettings,
) -> BeamOutcome<N>
where
    N: Copy + Eq + Ord + std::hash::Hash,
    R: Reach<N> + ?Sized,
    O: Objective,
{
    beam_grown(task, &mut ByLegs { objective, aggregate: settings.aggregate }, may_arrive, settings)
}

/// [`beam`] with scores that are not those of legs; `settings.aggregate` is not used.
///
/// For scores of executions ([`super::in_loop::Executed`]): a growth may refuse to score, and says when to end.
pub fn beam_grown<N, R, G>(
    task: &Task<'_, N, R>,
    growth: &mut G,
    may_arrive: impl Fn(&N, usize) -> bool,
    settings: &BeamSettings,
) -> BeamOutcome<N>
where
    N: Copy + Eq + Ord + std::hash::Hash,
    R: Reach<N> + ?Sized,
    G: Growth<N>,
{
    run::Run::new(task, growth, may_arrive, settings).finish(None)
}

/// [`beam`], showing every iteration to `observe`.
///
/// For figures: the golden test redraws the paper's fig. 4 from these snapshots.
pub fn beam_observed<N, R, O>(
    task: &Task<'_, N, R>,
    objective: &O,
    may_arrive: impl Fn(&N, usize) -> bool,
    settings: &BeamSettings,
    mut observe: impl FnMut(&Snapshot),
) -> BeamOutcome<N>
where
    N: Copy + Eq + Ord + std::hash::Hash,
    R: Reach<N> + ?Sized,
    O: Objective,
{
    let mut growth = ByLegs { objective, aggregate: settings.aggregate };
    run::Run::new(task, &mut growth, may_arrive, settings).finish(Some(&mut observe))
}
