//! The beam over one graph with partial trajectories that are executed leg by leg.

use std::hash::Hash;

use super::answer::Answer;
use super::executions::Partials;
use super::question::Question;
use crate::math::random::named_seed;
use crate::search::in_loop::{Execute, Executed, PartialSettings, Ran, Rank};
use crate::search::{Additive, Found, Task, beam_grown};
use crate::simulation::Airborne;

/// Partial trajectories on the frontier at most: each keeps a robot in mid-air, and its log.
const FRONTIER: usize = 1000;

/// Makes plans of what the beam grows, and has them executed.
///
/// An error tells how many executions were used up; 0 where no plan could be made.
struct Carried<'q, 'a, N, O> {
    question: &'q Question<'a, N, O>,
    partials: &'q Partials<'a>,
}

impl<N: Copy, O> Execute<N> for Carried<'_, '_, N, O> {
    type State = Airborne;

    fn execute(
        &mut self,
        partial: &Found<N>,
        from: Option<(&Airborne, usize)>,
        whole: bool,
    ) -> Result<Ran<Airborne>, u64> {
        let plan = (self.question.plan)(partial.clone()).ok_or(0u64)?;
        (self.partials.execute)(&plan, from.map(|(state, _)| state), whole)
    }
}

/// The frontier is at most 1000 partial trajectories.
///
/// Scores are stresses of what was flown so far; the plan's own score only settles which legs are flown first.
///
/// The budget is `generate.search.executions` a graph, iterations `generate.search.iterations`: whichever ends first.
pub(super) fn by_partials<N: Copy + Eq + Ord + Hash, O: Additive>(
    question: &Question<N, O>,
    partials: &Partials,
    may_arrive: &dyn Fn(&N, usize) -> bool,
) -> Answer {
    let search = question.search;
    let settings = PartialSettings {
        length: question.length,
        free_end: question.free_end,
        executions: search.executions,
        wanted: search.per_graph as usize,
        width: search.width as usize,
        resumes: partials.resumes,
        seed: named_seed(question.seed, "partial", 0),
    };
    let mut executed = Executed::new(settings, &question.score, Carried { question, partials });
    let task = Task { start: question.start, candidates: question.points, reach: question.reach };
    let mut settings = question.beam_settings();
    settings.frontier = settings.frontier.min(FRONTIER);
    let mut outcome = beam_grown(&task, &mut executed, may_arrive, &settings);
    // What leads by its failure is told by its stress.
    outcome.found.iter_mut().for_each(|found| found.score = Rank::of_score(found.score).told());
    let capped = || {
        format!(
            "neither {} iterations nor {} executions per graph led to a whole trajectory with a measure",
            search.iterations, search.executions
        )
    };
    let answer = question.answer_of(outcome, capped);
    Answer { best_so_far: executed.into_best_so_far(), ..answer }
}
