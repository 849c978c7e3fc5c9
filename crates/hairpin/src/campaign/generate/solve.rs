//! One graph, from its number to its plans: the reach set asked for, the search asked for, and never another.

use nalgebra::Point3;

use super::certificates::Certifier;
use super::graph;
use super::search::Answer;
use super::stepwise::Stepwise;
use super::witness::Witness;
use crate::campaign::scenario::ReachName;
use crate::campaign::{Evidence, Setup};
use crate::math::random::named_seed;
use crate::search::{Found, Score};
use crate::trajectory::Profile;

/// A trajectory that a graph gave.
#[derive(Debug, Clone)]
pub(super) struct Plan {
    pub(super) waypoints: Vec<Point3<f64>>,
    pub(super) leg_times: Vec<f64>,
    pub(super) score: f64,
    pub(super) bound: Option<f64>,
    pub(super) evidence: Evidence,
    pub(super) certified: Option<&'static str>,
    pub(super) profile: Option<Profile>,
}

impl Plan {
    /// What was found among `points`, on `evidence`.
    pub(super) fn new<N>(found: &Found<N>, points: &[Point3<f64>], evidence: Evidence) -> Self {
        Self {
            waypoints: found.waypoints.iter().map(|&index| points[index as usize]).collect(),
            leg_times: found.leg_times.clone(),
            score: found.score,
            bound: None,
            evidence,
            certified: None,
            profile: None,
        }
    }
}

/// What one unit of work gave.
#[derive(Debug, Clone, Default)]
pub(super) struct Outcome {
    /// Number of the graph, plan.
    pub(super) plans: Vec<(u64, Plan)>,
    pub(super) graphs: u64,
    pub(super) proven_empty: u64,
    pub(super) expansions: u64,
    pub(super) dropped: u64,
    pub(super) duplicates: u64,
    /// Why there is no plan.
    pub(super) reason: Option<String>,
}

impl Outcome {
    /// The outcome of graph number `graph`; `plan` gives `None` for what breaks a limit of whole trajectories.
    pub(super) fn of<N>(graph: u64, answer: Answer<N>, plan: impl Fn(Found<N>) -> Option<Plan>) -> Self {
        let found = answer.found.len();
        let plans: Vec<(u64, Plan)> = answer
            .found
            .into_iter()
            .filter_map(plan)
            .map(|plan| (graph, Plan { bound: answer.bound, ..plan }))
            .collect();
        let too_long = (plans.is_empty() && found > 0).then(|| "`max_flight_time_s` is exceeded".to_string());
        Self {
            plans,
            graphs: 1,
            proven_empty: answer.proven_empty.into(),
            expansions: answer.expansions,
            dropped: answer.dropped,
            duplicates: answer.duplicates,
            reason: answer.reason.or(too_long),
        }
    }

    pub(super) fn add(&mut self, other: Outcome) {
        self.plans.extend(other.plans);
        self.graphs += other.graphs;
        self.proven_empty += other.proven_empty;
        self.expansions += other.expansions;
        self.dropped += other.dropped;
        self.duplicates += other.duplicates;
        self.reason = other.reason;
    }
}

/// The part of a search that is the same for every graph.
pub(super) struct Solver<'a> {
    setup: &'a Setup,
    set: Set<'a>,
    certifier: Option<Certifier>,
}

enum Set<'a> {
    Stepwise(Stepwise<'a>),
    Witness(Box<Witness<'a>>),
}

impl<'a> Solver<'a> {
    /// Builds the reach set that the scenario asks for.
    ///
    /// # Errors
    /// Why there is none, in a sentence's part; also where the planned duration alone is beyond its limit.
    pub(super) fn new(setup: &'a Setup) -> Result<Self, String> {
        let generate = &setup.scenario.generate;
        let set = match generate.reach {
            ReachName::Witness => Set::Witness(Box::new(Witness::new(setup)?)),
            _ => Set::Stepwise(Stepwise::new(setup)?),
        };
        let shortest = match &set {
            Set::Stepwise(set) => set.step(),
            Set::Witness(set) => set.shortest_leg(),
        };
        let legs = setup.scenario.task.length - 1;
        if let Some(limit) = generate.limits.max_flight_time_s.filter(|limit| legs as f64 * shortest > *limit) {
            return Err(format!("{legs} legs of at least {shortest} s take longer than max_flight_time_s = {limit}"));
        }
        let wanted = generate.certify && generate.reach != ReachName::Witness;
        let certifier = if wanted { Some(Certifier::new(setup)?) } else { None };
        Ok(Self { setup, set, certifier })
    }

    /// Searches graph number `graph`.
    pub(super) fn solve(&self, graph: u64) -> Outcome {
        let points = match graph::sample(self.setup, graph) {
            Ok(points) => points,
            Err(error) => return Outcome { graphs: 1, reason: Some(error.to_string()), ..Outcome::default() },
        };
        let mut outcome = match &self.set {
            Set::Stepwise(set) => set.solve(graph, &points),
            Set::Witness(set) => set.solve(graph, &points),
        };
        if let Some(certifier) = &self.certifier {
            outcome.plans.iter_mut().for_each(|(_, plan)| certifier.certify(plan));
        }
        outcome
    }
}

/// The scenario's score for graph number `graph`; `top_speed` (m/s) scores 1.
pub(super) fn score(setup: &Setup, graph: u64, top_speed: f64) -> Score {
    let seed = named_seed(setup.scenario.seed, "score", graph);
    // The name was checked with the scenario, and top speeds are > 0 with the robot.
    Score::named(&setup.scenario.generate.score, seed, top_speed).unwrap_or(Score::Random { seed })
}
