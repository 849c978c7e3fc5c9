//! The graphs that trajectories are searched in, one after the other.

use crate::campaign::graph::{Executions, Outcome, Partials, Plan, Wanted};
use crate::campaign::kind::Solver;
use crate::campaign::scenario::EXECUTED;
use crate::campaign::{Setup, Stop, trial};
use crate::simulation::Airborne;

/// Graphs sampled per case asked for, where the scenario sets no limit.
pub(super) const GRAPHS_PER_CASE: u64 = 20;

/// The graphs of a setup, and what searches them.
pub(super) struct Graphs<'a> {
    pub(super) setup: &'a Setup,
    pub(super) solver: Box<dyn Solver + 'a>,
}

impl<'a> Graphs<'a> {
    /// # Errors
    /// Why nothing can be searched, in a sentence's part.
    pub(super) fn of(setup: &'a Setup) -> Result<Self, String> {
        Ok(Self { setup, solver: setup.kind().solver()? })
    }

    /// Searches graph number `graph` for what is `wanted`; `stop` ends what has no bound in counts.
    pub(super) fn solve(&self, graph: u64, wanted: Wanted, stop: &Stop) -> Outcome {
        let setup = self.setup;
        let goes_on = || (!(stop.cancelled)()).then_some(());
        let execute = |plan: &Plan, least| goes_on().and_then(|()| trial::execute(setup, graph, plan, least));
        let duration = |plan: &Plan| goes_on().and_then(|()| trial::duration(setup, graph, plan));
        let furnish = |plan: &Plan| goes_on().and_then(|()| trial::furnish(setup, graph, plan));
        let part = |plan: &Plan, before: Option<&Airborne>, whole| {
            goes_on().ok_or(0u64).and_then(|()| trial::execute_partial(setup, graph, plan, before, whole))
        };
        let executed = setup.scenario.score() == EXECUTED;
        let partial = executed.then(|| Partials { execute: &part, resumes: trial::resumes(setup) });
        let executions = Executions { execute: &execute, duration: &duration, furnish: &furnish, partial };
        self.solver.solve(graph, executions, wanted, stop)
    }
}
