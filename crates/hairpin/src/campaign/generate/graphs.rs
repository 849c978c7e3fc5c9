//! The graphs that trajectories are searched in, one after the other.

use crate::campaign::counted::Counted;
use crate::campaign::graph::{Executions, Outcome, Partials, Plan, Wanted};
use crate::campaign::kind::Solver;
use crate::campaign::scenario::EXECUTED;
use crate::campaign::trial::Trials;
use crate::campaign::{Executor, Setup, Stop};
use crate::simulation::Airborne;

/// Graphs sampled per case asked for, where the scenario sets no limit.
pub(super) const GRAPHS_PER_CASE: u64 = 20;

/// The graphs of a setup, and what searches them.
///
/// Graph k has named seeds under the scenario's: it is the same whoever asks, and whatever was asked before.
pub(super) struct Graphs<'a> {
    pub(super) setup: &'a Setup,
    pub(super) solver: Box<dyn Solver + 'a>,
    /// Who carries out what is executed while it is searched for.
    pub(super) executor: &'a dyn Executor,
    /// The seed of the case that they are for, where it is known before its trajectory.
    seed: Option<u64>,
}

impl<'a> Graphs<'a> {
    /// # Errors
    /// Why nothing can be searched, in a sentence's part.
    ///
    /// Makes the solver, which may be dear (an arm's graph, a hull).
    pub(super) fn of(setup: &'a Setup, executor: &'a dyn Executor) -> Result<Self, String> {
        Ok(Self { setup, solver: setup.kind().solver()?, executor, seed: None })
    }

    /// The same for the one case that has the seed `seed`.
    pub(super) fn with_seed(self, seed: u64) -> Self {
        Self { seed: Some(seed), ..self }
    }

    /// Executions in graph number `graph`.
    pub(super) fn trials(&self, graph: u64) -> Trials<'a> {
        Trials { setup: self.setup, executor: self.executor, graph, seed: self.seed }
    }

    /// A plan of graph number `graph`, drawn at random.
    ///
    /// # Errors
    /// Why there is none, in a sentence's part; `None` where `stop` ended it: what a draw says that was stopped is no
    /// reason.
    pub(super) fn draw(&self, graph: u64, stop: &Stop) -> Result<Plan, Option<String>> {
        if (stop.cancelled)() {
            return Err(None);
        }
        self.solver.draw(graph, stop).map_err(|reason| (!(stop.cancelled)()).then_some(reason))
    }

    /// Searches graph number `graph` for what is `wanted`; `stop` ends what has no bound in counts.
    ///
    /// Executions and scores that `stop` cancelled are refused to the search, which ends with what it has.
    pub(super) fn solve(&self, graph: u64, wanted: Wanted, stop: &Stop) -> Outcome {
        let counted = Counted::new(self.executor, stop.cancelled);
        let trials = Trials { executor: &counted, ..self.trials(graph) };
        let goes_on = || (!(stop.cancelled)()).then_some(());
        let execute = |plan: &Plan, least| goes_on().and_then(|()| trials.execute(plan, least));
        let duration = |plan: &Plan| goes_on().and_then(|()| trials.duration(plan));
        let furnish = |plan: &Plan| goes_on().and_then(|()| trials.furnish(plan));
        let part = |plan: &Plan, before: Option<&Airborne>, whole| {
            goes_on().ok_or(0u64).and_then(|()| trials.execute_partial(plan, before, whole))
        };
        let executed = self.setup.scenario.score() == EXECUTED;
        let partial = executed.then(|| Partials { execute: &part, resumes: trials.resumes() });
        let executions = Executions { execute: &execute, duration: &duration, furnish: &furnish, partial };
        let outcome = self.solver.solve(graph, executions, wanted, stop);
        Outcome { failures: counted.take(), flown: counted.any_flown(), ..outcome }
    }
}
