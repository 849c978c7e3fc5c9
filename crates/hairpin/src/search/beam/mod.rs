//! Algorithms 1 and 2 of the paper on one graph: a frontier of scored partial trajectories, widened from its best.
//!
//! Per iteration the best `width` partial trajectories leave the frontier; those of full length are complete, the
//! others are expanded by every waypoint in reach, scored and put back. What was not selected stays. The first
//! iteration after which `per_graph` distinct trajectories are complete ends the graph.
//!
//! Source: Hildebrandt et al., *Feasible and stressful trajectory generation for mobile robots*, ISSTA 2020.
//!
//! ```text
//! F ← {start}
//! repeat   S ← the `width` best of F;   F ← F \ S
//!          for each p of S:   complete p if it has L waypoints, else
//!              F ← F ∪ { p·w : w in reach of p, the end in reach of w within L − |p| − 1 legs }
//!          F ← the `frontier` best of F
//! until `per_graph` complete, F empty, or `iterations` are used up
//! ```
//!
//! The best is what scores most above what its legs are worth at least (0 where no leg is worth less, as in the paper):
//! trajectories of unequal length are compared, and in sums of negative scores the shortest would always be the best.
//!
//! It is a beam that never forgets below its bound of memory: what was not the best comes up again once the better ones
//! have died, so that a graph with a trajectory gives one, given iterations enough. Beam scores are those of beginnings
//! and say nothing of what follows; the optimum is `exact`'s.

mod atlas;
mod outcome;
mod reduction;
mod run;
mod settings;
#[cfg(feature = "unit-tests")]
mod tests;

use super::growth::{ByLegs, Growth};
use super::objective::Objective;
use super::task::Task;
use crate::feasibility::reach::Reach;
pub use outcome::{BeamOutcome, Ended};
pub use run::Snapshot;
pub use settings::BeamSettings;

/// Searches one graph. `may_arrive(node, steps)` is a necessary test: false only if no `steps` legs lead from `node` to
/// the end.
///
/// No bound on how far from the best an answer is: [`super::exact()`] has one.
///
/// Deterministic: ties by waypoint index, no draws. At most [`BeamSettings::iterations`] · [`BeamSettings::width`]
/// expansions, of which each asks for the legs of one node (remembered) and scores them.
///
/// `may_arrive` prunes what cannot arrive; `|_, _| true` is always correct and only costs time.
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
    beam_grown(task, &mut ByLegs::new(objective, settings.aggregate), may_arrive, settings)
}

/// [`beam`] with scores that are not those of legs; `settings.aggregate` is not used.
///
/// For scores of executions ([`super::in_loop::Executed`]): a growth may refuse to score, and says when to end.
///
/// `growth` is left as the search left it: executed scores keep what they measured there.
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
///
/// `observe` is called after each iteration, on the caller's thread; copying and sorting the frontier for it is
/// O(frontier · length) each time.
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
    let mut growth = ByLegs::new(objective, settings.aggregate);
    run::Run::new(task, &mut growth, may_arrive, settings).finish(Some(&mut observe))
}
