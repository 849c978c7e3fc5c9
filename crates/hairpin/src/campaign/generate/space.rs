//! The feasible trajectories of a setup, one at a time: what comparisons of searches are made of.
//!
//! What experiments compare searches by: draws, and moves within the feasible set, with the same solver as
//! `generate`.

use nalgebra::Point3;

use super::graphs::Graphs;
use crate::campaign::graph::Plan;
use crate::campaign::{Case, OwnSimulator, Setup, Stop};

/// The feasible trajectories of one setup.
///
/// Nothing is executed here. Holds the solver, so that legs solved once are kept.
pub struct Space<'a> {
    graphs: Graphs<'a>,
}

impl<'a> Space<'a> {
    /// # Errors
    /// Why nothing can be searched, in a sentence's part.
    pub fn of(setup: &'a Setup) -> Result<Self, String> {
        Ok(Self { graphs: Graphs::of(setup, &OwnSimulator)? })
    }

    /// Case number `number`, a feasible trajectory of graph number `graph` drawn at random; the same whenever it is
    /// asked for.
    ///
    /// # Errors
    /// Why there is none, in a sentence's part.
    ///
    /// Number and graph are independent: the same trajectory may be several cases, with seeds of their own.
    pub fn draw(&self, graph: u64, number: usize) -> Result<Case, String> {
        Ok(self.graphs.solver.draw(graph, &Stop::never())?.case(self.graphs.setup.scenario.seed(), graph, number))
    }

    /// How [`draw`](Self::draw) draws, in a sentence's part.
    pub fn drawn_how(&self) -> &'static str {
        self.graphs.solver.drawn_how()
    }

    /// `case` over other `points`, as many as its own, with the same evidence; `None` where that is not feasible.
    pub fn over(&self, case: &Case, points: &[Point3<f64>]) -> Option<Case> {
        let plan = self.graphs.solver.over(case.graph, &Plan::of(case), points)?;
        let over = plan.case(self.graphs.setup.scenario.seed(), case.graph, case.number.0);
        Some(Case { seed: case.seed, ..over })
    }
}
