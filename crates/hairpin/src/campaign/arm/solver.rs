//! The search for an arm's programs: the heaviest, and for searches that execute what can be drawn and changed.
//!
//! The graph, the ways and the heaviest program are made when they are first asked for and kept, so that the rounds
//! of a search do not pay for them again.

use std::sync::OnceLock;

use nalgebra::Point3;

use super::ArmSetup;
use super::graph::{graph_of, graph_until, once};
use super::program::Met;
use super::ways::Ways;
use crate::campaign::graph::{Executions, Outcome, Plan, Wanted};
use crate::campaign::kind::Solver;
use crate::campaign::{Stop, Witness};
use crate::math::random::{Stream, named_seed, stream};
use crate::search::heaviest::Method;

/// Walks that are tried for one program.
///
/// A walk fails where the graph leads no further, or where the virtual controller stops on the way.
const DRAWS: usize = 8;

/// The search for an arm's programs.
pub(super) struct ArmSolver<'a> {
    setup: &'a ArmSetup,
    /// What programs are made of that are drawn or changed.
    ways: OnceLock<Result<Ways<'a>, String>>,
    /// The heaviest program that was found to begin with, if there is one.
    heaviest: OnceLock<Option<Plan>>,
}

impl<'a> ArmSolver<'a> {
    pub(super) fn new(setup: &'a ArmSetup) -> Self {
        Self { setup, ways: OnceLock::new(), heaviest: OnceLock::new() }
    }

    fn ways(&self, stop: &Stop) -> Result<&Ways<'a>, String> {
        let made = || graph_until(self.setup, stop).map(|graph| Ways::new(self.setup, graph));
        once(&self.ways, made).as_ref().map_err(Clone::clone)
    }

    /// The heaviest program that is found without branching, with the speeds and zones that the first of a campaign
    /// has: a good one to begin with, in a time that is bounded.
    fn heaviest(&self, stop: &Stop) -> Option<&Plan> {
        let make = || {
            let graph = graph_until(self.setup, stop).ok()?;
            let found = self.setup.heaviest_of(&graph, 1, Some(Method::Local), stop).ok()?;
            let (cost, rows) = found.paths.first()?;
            Some(Plan { bound: None, ..self.setup.plan(&graph, rows, *cost, &found, 0) })
        };
        once(&self.heaviest, make).as_ref()
    }

    /// Points of programs that are drawn.
    ///
    /// `generate.search.points`, or where that is not given as many as the heaviest path has.
    fn length(&self, stop: &Stop) -> Result<usize, String> {
        if let Some(points) = self.setup.scenario.generate.search.points {
            return Ok(points as usize);
        }
        let heaviest = self.heaviest(stop).ok_or("there is no heaviest path whose points to take as many of")?;
        let way = heaviest.witness.as_ref().and_then(Witness::program).and_then(|program| self.setup.way_of(program));
        way.map(|way| way.len()).ok_or_else(|| "the heaviest program is no way through the cloud".into())
    }

    /// `way` as a plan; `None` where the virtual controller cannot plan it to its end, so that nothing could be
    /// measured.
    fn planned(&self, way: &[Met]) -> Option<Plan> {
        let graph = graph_of(self.setup).ok()?;
        let plan = self.setup.planned(&graph, way, 0);
        (!plan.leg_times.is_empty()).then_some(plan)
    }

    /// The way of a plan's program.
    fn way_of(&self, plan: &Plan) -> Option<Vec<Met>> {
        self.setup.way_of(plan.witness.as_ref()?.program()?)
    }
}

/// Whether two programs have the same moves.
fn alike(a: &Plan, b: &Plan) -> bool {
    let moves = |plan: &Plan| plan.witness.as_ref().and_then(Witness::program).map(|program| program.moves.clone());
    moves(a) == moves(b)
}

impl Solver for ArmSolver<'_> {
    /// The programs of the one graph that there is.
    fn solve(&self, _: u64, _: Executions, _: Wanted, stop: &Stop) -> Outcome {
        let mut outcome = Outcome { graphs: 1, ..Outcome::default() };
        let graph = match graph_until(self.setup, stop) {
            Ok(graph) => graph,
            Err(reason) => return Outcome { reason: Some(reason), ..outcome },
        };
        match self.setup.heaviest(&graph, stop) {
            Ok(found) => {
                outcome.expansions = found.nodes;
                outcome.proven_empty = u64::from(found.paths.is_empty() && found.proven);
                outcome.reason = found.paths.is_empty().then(|| self.setup.why_none(&graph, &found));
                let plans = found
                    .paths
                    .iter()
                    .enumerate()
                    .map(|(number, (cost, rows))| (0, self.setup.plan(&graph, rows, *cost, &found, number)));
                outcome.plans = plans.collect();
            }
            Err(reason) => outcome.reason = Some(reason),
        }
        outcome
    }

    /// Program `number` of the stream `drawn program`: the same whoever asks, and in whatever order. Up to [`DRAWS`]
    /// walks.
    fn draw(&self, number: u64, stop: &Stop) -> Result<Plan, String> {
        let ways = self.ways(stop)?;
        let length = self.length(stop)?;
        let mut random = stream(named_seed(self.setup.scenario.seed, "drawn program", number));
        let mut reason = String::new();
        for _ in 0..DRAWS {
            match ways.drawn(length, &mut random) {
                Ok(way) => match self.planned(&way) {
                    Some(plan) => return Ok(plan),
                    None => reason = "the virtual controller comes to the end of none".into(),
                },
                Err(why) => reason = why,
            }
        }
        Err(format!("no program of {length} points in {DRAWS} draws: {reason}"))
    }

    fn drawn_how(&self) -> &'static str {
        "each move alike among those that lead on from a point, speeds and zones from the scenario's lists; where every move is possible \
         all orders of so many points come alike"
    }

    /// The heaviest program, where the virtual controller can plan it.
    fn seeds(&self, stop: &Stop) -> Vec<Plan> {
        self.heaviest(stop).filter(|plan| !plan.leg_times.is_empty()).cloned().into_iter().collect()
    }

    /// Programs go through the points of the cloud.
    fn moves(&self) -> bool {
        false
    }

    fn over(&self, _: u64, _: &Plan, _: &[Point3<f64>]) -> Option<Plan> {
        None
    }

    fn elsewhere(&self, _: u64, _: &mut Stream) -> Option<Point3<f64>> {
        None
    }

    /// One change of `plan` mostly near leg `leg` (`alter`), planned again; `None` where no change is possible or none
    /// alters a move as it is written: a point's zone, for one, may be cut away by what stands beside it.
    fn altered(&self, plan: &Plan, leg: usize, random: &mut Stream) -> Option<Plan> {
        let way = self.way_of(plan)?;
        let child = self.ways(&Stop::never()).ok()?.altered(&way, leg, random)?;
        self.planned(&child).filter(|child| !alike(plan, child))
    }

    /// As [`Self::altered`], of two plans; `None` where either is no way through the cloud, no cut is possible, or
    /// the child has its first parent's moves.
    fn crossed(&self, _: u64, plan: &Plan, other: &Plan, leg: usize, random: &mut Stream) -> Option<Plan> {
        let child = self.ways(&Stop::never()).ok()?.crossed(&self.way_of(plan)?, &self.way_of(other)?, leg, random)?;
        self.planned(&child).filter(|child| !alike(plan, child))
    }
}
