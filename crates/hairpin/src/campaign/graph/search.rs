//! The search that the scenario asks for, over any reach set.

use std::hash::Hash;

use nalgebra::Point3;

use super::in_loop::by_trials;
use super::optima::by_optima;
use super::outcome::Plan;
use super::partial::{Partials, by_partials};
use super::rounds::{Round, by_round};
use crate::campaign::SeenLeg;
use crate::campaign::learn::ScoreModel;
use crate::campaign::scenario::{SearchMethod, SearchSection};
use crate::feasibility::reach::Reach;
use crate::search::beam::Ended;
use crate::search::in_loop::Trial;
use crate::search::{
    Additive, BeamOutcome, BeamSettings, ExactSettings, Found, LegGraph, Task, UniformSettings, beam, exact, uniform,
};

/// One graph and what is asked of it.
pub(in crate::campaign) struct Question<'a, N, R, O> {
    pub(in crate::campaign) search: &'a SearchSection,
    /// Waypoints of a trajectory, both ends included.
    pub(in crate::campaign) length: usize,
    pub(in crate::campaign) points: &'a [Point3<f64>],
    pub(in crate::campaign) reach: &'a R,
    pub(in crate::campaign) start: N,
    pub(in crate::campaign) score: O,
    /// Seed of what the search itself draws.
    pub(in crate::campaign) seed: u64,
    /// Steps from the end within which the beam asks the reach set itself whether the end can be reached.
    pub(in crate::campaign) lookahead: usize,
    /// The plan of what was found; `None` for what breaks a limit of whole trajectories.
    pub(in crate::campaign) plan: &'a dyn Fn(Found<N>) -> Option<Plan>,
    /// Whether the last leg is one to the sink of a task without an end.
    pub(in crate::campaign) free_end: bool,
    /// Scores beside this one whose optima a search in the loop starts from, or a round of an adaptive campaign is to have.
    pub(in crate::campaign) also: Vec<O>,
    pub(in crate::campaign) looped: Looped<'a>,
}

/// Executions, each of which counts; `None` where one fails.
#[derive(Clone, Copy)]
pub(in crate::campaign) struct Executions<'a> {
    /// Of a plan: once, and as often again as the search asks for if it came to the stress that is given.
    pub(in crate::campaign) execute: &'a dyn Fn(&Plan, f64) -> Option<Trial>,
    /// How long a plan's takes, s.
    pub(in crate::campaign) duration: &'a dyn Fn(&Plan) -> Option<f64>,
    /// A plan with the obstacles that are asked for, executed twice: without them, to see where they belong, and among them.
    pub(in crate::campaign) furnish: &'a dyn Fn(&Plan) -> Option<(Plan, Trial)>,
    /// Of parts of trajectories, where these are to be scored by them.
    pub(in crate::campaign) partial: Option<Partials<'a>>,
}

/// What surrounds a plan and is searched with it.
#[derive(Clone, Copy)]
pub(in crate::campaign) struct Surroundings<'a> {
    /// Numbers between −1 and 1 that say what disturbs the robot all along: the air, a force.
    pub(in crate::campaign) coordinates: usize,
    /// Puts numbers that are not allowed to the nearest that are.
    pub(in crate::campaign) bound: &'a dyn Fn(&mut [f64]),
    /// A plan disturbed as numbers say, carried out for so many seconds.
    pub(in crate::campaign) put: &'a dyn Fn(&Plan, &[f64], f64) -> Plan,
    /// Whether obstacles are to be placed.
    pub(in crate::campaign) obstacles: bool,
}

/// What only searches that execute ask.
#[derive(Clone, Copy)]
pub(in crate::campaign) struct Looped<'a> {
    pub(in crate::campaign) executions: Executions<'a>,
    /// What is searched beside the waypoints.
    pub(in crate::campaign) surroundings: Option<Surroundings<'a>>,
    /// A plan with other waypoints, as many; `None` where they are not feasible.
    pub(in crate::campaign) moved: Move<'a>,
    pub(in crate::campaign) wanted: Wanted<'a>,
}

/// What is wanted of a graph.
#[derive(Debug, Clone, Copy)]
pub(in crate::campaign) enum Wanted<'a> {
    /// What the scenario's method finds.
    Cases,
    /// What the round of an adaptive campaign is to execute.
    Round(&'a Round<'a>),
    /// The optimum of each score with one of these names, or of the scenario's own if there are none, under both aggregates.
    Optima(&'a [&'a str]),
}

impl<'a> Looped<'a> {
    /// The models that a round searches under.
    pub(in crate::campaign) fn models(&self) -> &'a [ScoreModel] {
        match self.wanted {
            Wanted::Round(round) => round.models,
            _ => &[],
        }
    }
}

/// Puts other waypoints into a plan.
type Move<'a> = &'a dyn Fn(&Plan, &[Point3<f64>]) -> Option<Plan>;

/// What the search gave.
#[derive(Default)]
pub(in crate::campaign) struct Answer {
    pub(in crate::campaign) plans: Vec<Plan>,
    /// Trajectories found that break a limit of whole trajectories.
    pub(in crate::campaign) refused: usize,
    pub(in crate::campaign) proven_empty: bool,
    pub(in crate::campaign) expansions: u64,
    pub(in crate::campaign) dropped: u64,
    pub(in crate::campaign) duplicates: u64,
    /// How many of the plans, from the first, a round's models chose.
    pub(in crate::campaign) chosen: usize,
    /// How many, after those, are optima of scores by hand.
    pub(in crate::campaign) by_hand: usize,
    /// The largest stress after each execution in the loop.
    pub(in crate::campaign) best_so_far: Vec<f64>,
    /// Why nothing was found.
    pub(in crate::campaign) reason: Option<String>,
}

/// Searches one graph. `may_arrive(node, steps)` is necessary for the end to be reached from `node` in `steps` legs.
pub(in crate::campaign) fn search<N: Copy + Eq + Ord + Hash, R: Reach<N>, O: Additive>(
    question: &Question<N, R, O>,
    may_arrive: impl Fn(&N, usize) -> bool,
) -> Answer {
    match question.looped.wanted {
        Wanted::Cases => by_method(question, may_arrive),
        Wanted::Round(round) => by_round(question, round),
        Wanted::Optima(_) => by_optima(question),
    }
}

fn by_method<N: Copy + Eq + Ord + Hash, R: Reach<N>, O: Additive>(
    question: &Question<N, R, O>,
    may_arrive: impl Fn(&N, usize) -> bool,
) -> Answer {
    match question.search.method {
        SearchMethod::Beam => match question.looped.executions.partial {
            Some(partials) => by_partials(question, &partials, may_arrive),
            None => by_beam(question, may_arrive),
        },
        SearchMethod::Exact => by_dynamic_program(question),
        SearchMethod::Uniform => by_uniform_draws(question),
        SearchMethod::InLoop => by_trials(question),
        // Its rounds are wanted one by one; here is whoever only asks what is feasible.
        SearchMethod::Adaptive => by_uniform_draws(question),
    }
}

impl<N: Copy + Eq + Ord + Hash, R: Reach<N>, O: Additive> Question<'_, N, R, O> {
    /// The plan of `found`, with what the search saw of its legs.
    pub(super) fn planned(&self, found: Found<N>) -> Option<Plan> {
        let seen = self.seen(&found);
        let mut plan = (self.plan)(found)?;
        plan.seen = seen;
        // The leg to the sink of a task without an end is none of the plan's.
        plan.seen.truncate(plan.leg_times.len());
        Some(plan)
    }

    fn seen(&self, found: &Found<N>) -> Vec<SeenLeg> {
        let mut legs = Vec::new();
        let pairs = found.nodes.windows(2);
        let see = |pair: &[N]| {
            legs.clear();
            self.reach.legs(&pair[0], self.points, &mut legs);
            let leg = legs.iter().find(|leg| leg.to == pair[1])?;
            Some(SeenLeg { features: leg.features, duration: leg.duration })
        };
        pairs.map_while(see).collect()
    }

    /// The answer with the plans of `found`, the best first, and a proven upper bound of the score.
    pub(super) fn answer(&self, found: Vec<Found<N>>, bound: Option<f64>) -> Answer {
        let count = found.len();
        let plans: Vec<Plan> = found.into_iter().filter_map(|found| self.planned(found)).collect();
        let refused = count - plans.len();
        Answer { plans: plans.into_iter().map(|plan| Plan { bound, ..plan }).collect(), refused, ..Answer::default() }
    }

    /// How the beam is to search.
    pub(super) fn beam_settings(&self) -> BeamSettings {
        let search = self.search;
        BeamSettings {
            length: self.length,
            width: search.width as usize,
            per_graph: search.per_graph as usize,
            revisits: search.revisits,
            aggregate: search.aggregate,
            iterations: search.iterations as usize,
            frontier: search.frontier as usize,
            keep: BeamSettings::default().keep.map(|keep| keep.max(search.per_graph as usize)),
            lookahead: self.lookahead,
        }
    }

    /// The answer of the beam; `capped` says why it found nothing before its end.
    pub(super) fn answer_of(&self, outcome: BeamOutcome<N>, capped: impl Fn() -> String) -> Answer {
        let mut found = outcome.found;
        found.truncate(self.search.per_graph as usize);
        let reason = match outcome.ended {
            _ if !found.is_empty() => None,
            Ended::Capped => Some(capped()),
            Ended::Exhausted { proof: true } => Some("every partial trajectory ends before the end is reached".into()),
            _ => Some("the frontier ran empty before the end was reached".into()),
        };
        Answer {
            proven_empty: found.is_empty() && outcome.ended == Ended::Exhausted { proof: true },
            expansions: outcome.expansions,
            dropped: outcome.dropped,
            duplicates: outcome.duplicates,
            reason,
            ..self.answer(found, None)
        }
    }

    /// All legs of the graph that are on some way of the right length; without revisits, if there are to be none, those that no such way has.
    pub(super) fn leg_graph(&self) -> LegGraph<'_, N> {
        let graph = LegGraph::explore(self.start, self.points, self.reach, self.length);
        if self.search.revisits { graph } else { graph.into_without_returns(self.length) }
    }
}

fn by_beam<N: Copy + Eq + Ord + Hash, R: Reach<N>, O: Additive>(
    question: &Question<N, R, O>,
    may_arrive: impl Fn(&N, usize) -> bool,
) -> Answer {
    let task = Task { start: question.start, candidates: question.points, reach: question.reach };
    let outcome = beam(&task, &question.score, may_arrive, &question.beam_settings());
    let capped = || format!("{} iterations per graph were not enough", question.search.iterations);
    question.answer_of(outcome, capped)
}

fn by_dynamic_program<N: Copy + Eq + Ord + Hash, R: Reach<N>, O: Additive>(question: &Question<N, R, O>) -> Answer {
    let search = question.search;
    let graph = question.leg_graph();
    let settings = ExactSettings {
        length: question.length,
        best: search.per_graph as usize,
        revisits: search.revisits,
        aggregate: search.aggregate,
        ..ExactSettings::default()
    };
    let outcome = exact(&graph, &question.score, &settings);
    let proven_empty = outcome.found.is_empty() && outcome.bound.is_none();
    let reason = match (outcome.found.is_empty(), proven_empty) {
        (false, _) => None,
        (true, true) => Some(format!("none among the {} feasible legs of the last graph", graph.legs())),
        (true, false) => Some("none without revisits was found within the search's budget".into()),
    };
    Answer { proven_empty, expansions: outcome.expansions, reason, ..question.answer(outcome.found, outcome.bound) }
}

fn by_uniform_draws<N: Copy + Eq + Ord + Hash, R: Reach<N>, O: Additive>(question: &Question<N, R, O>) -> Answer {
    let search = question.search;
    let graph = question.leg_graph();
    let settings = UniformSettings {
        length: question.length,
        wanted: search.per_graph as usize,
        draws: search.iterations.max(search.per_graph),
        revisits: search.revisits,
        aggregate: search.aggregate,
    };
    let outcome = uniform(&graph, &question.score, question.seed, &settings);
    let proven_empty = outcome.walks.is_zero();
    let reason = match (outcome.found.is_empty(), proven_empty) {
        (false, _) => None,
        (true, true) => Some(format!("none among the {} feasible legs of the last graph", graph.legs())),
        (true, false) => Some(format!("{} draws all used a waypoint twice", outcome.draws)),
    };
    // Repetitions are counted where they are not taken over.
    Answer { proven_empty, expansions: outcome.draws, reason, ..question.answer(outcome.found, None) }
}
