//! What one graph gives.

use nalgebra::Point3;

use super::search::Answer;
use crate::campaign::curve::Curve;
use crate::campaign::{Case, Environment, Evidence, SeenLeg};
use crate::math::random::case_seed;
use crate::search::Found;
use crate::trajectory::Drive;
use crate::trajectory::Profile;
use crate::trajectory::program::Program;

/// A trajectory that a graph gave.
#[derive(Debug, Clone)]
pub(in crate::campaign) struct Plan {
    pub(in crate::campaign) waypoints: Vec<Point3<f64>>,
    pub(in crate::campaign) leg_times: Vec<f64>,
    pub(in crate::campaign) seen: Vec<SeenLeg>,
    pub(in crate::campaign) score: f64,
    pub(in crate::campaign) bound: Option<f64>,
    pub(in crate::campaign) evidence: Evidence,
    pub(in crate::campaign) certified: Option<&'static str>,
    pub(in crate::campaign) profile: Option<Profile>,
    pub(in crate::campaign) drive: Option<Drive>,
    pub(in crate::campaign) program: Option<Program>,
    /// What was found beside the waypoints.
    pub(in crate::campaign) environment: Option<Environment>,
}

impl Plan {
    /// What was found among `points`, on `evidence`.
    pub(in crate::campaign) fn new<N>(found: &Found<N>, points: &[Point3<f64>], evidence: Evidence) -> Self {
        Self {
            waypoints: found.waypoints.iter().map(|&index| points[index as usize]).collect(),
            leg_times: found.leg_times.clone(),
            seen: Vec::new(),
            score: found.score,
            bound: None,
            evidence,
            certified: None,
            profile: None,
            drive: None,
            program: None,
            environment: None,
        }
    }
}

impl Plan {
    /// Case `number` of a campaign under the root seed, found in graph number `graph`.
    pub(in crate::campaign) fn case(self, root: u64, graph: u64, number: usize) -> Case {
        Case {
            number,
            seed: case_seed(root, number as u64),
            graph,
            waypoints: self.waypoints,
            leg_times: self.leg_times,
            seen: self.seen,
            score: self.score,
            bound: self.bound,
            evidence: self.evidence,
            certified: self.certified,
            profile: self.profile,
            drive: self.drive,
            program: self.program,
            environment: self.environment,
        }
    }
}

/// What one unit of work gave.
#[derive(Debug, Clone, Default)]
pub(in crate::campaign) struct Outcome {
    /// Number of the graph, plan.
    pub(in crate::campaign) plans: Vec<(u64, Plan)>,
    pub(in crate::campaign) graphs: u64,
    pub(in crate::campaign) proven_empty: u64,
    pub(in crate::campaign) expansions: u64,
    pub(in crate::campaign) dropped: u64,
    pub(in crate::campaign) duplicates: u64,
    /// Of a round of an adaptive campaign: how many of the plans, from the first, models chose.
    pub(in crate::campaign) chosen: usize,
    /// How many of them, after those, are optima of scores by hand.
    pub(in crate::campaign) by_hand: usize,
    /// Of searches in the loop: the largest stress after each execution, of every graph that was executed in.
    pub(in crate::campaign) curves: Vec<Curve>,
    /// Why there is no plan.
    pub(in crate::campaign) reason: Option<String>,
}

impl Outcome {
    /// The outcome of graph number `graph`.
    pub(in crate::campaign) fn of(graph: u64, answer: Answer) -> Self {
        let too_long = answer.plans.is_empty() && answer.refused > 0;
        let too_long = too_long.then(|| "`max_flight_time_s` is exceeded".to_string());
        Self {
            plans: answer.plans.into_iter().map(|plan| (graph, plan)).collect(),
            graphs: 1,
            proven_empty: answer.proven_empty.into(),
            expansions: answer.expansions,
            dropped: answer.dropped,
            duplicates: answer.duplicates,
            chosen: answer.chosen,
            by_hand: answer.by_hand,
            curves: (!answer.best_so_far.is_empty())
                .then(|| Curve::of(graph, &answer.best_so_far))
                .into_iter()
                .collect(),
            reason: answer.reason.or(too_long),
        }
    }

    pub(in crate::campaign) fn add(&mut self, other: Outcome) {
        self.plans.extend(other.plans);
        self.graphs += other.graphs;
        self.proven_empty += other.proven_empty;
        self.expansions += other.expansions;
        self.dropped += other.dropped;
        self.duplicates += other.duplicates;
        self.curves.extend(other.curves);
        self.reason = other.reason;
    }
}

/// 128 bits of BLAKE3 over the coordinates: equal waypoint lists are one trajectory.
pub(in crate::campaign) fn fingerprint(waypoints: impl IntoIterator<Item = Point3<f64>>) -> [u8; 16] {
    let mut hasher = blake3::Hasher::new();
    for waypoint in waypoints {
        for coordinate in waypoint.iter() {
            hasher.update(&coordinate.to_le_bytes());
        }
    }
    let mut short = [0; 16];
    short.copy_from_slice(&hasher.finalize().as_bytes()[..16]);
    short
}
