//! What one graph gives, and what every way of searching it is asked with.

use nalgebra::Point3;

use super::search::Answer;
use crate::campaign::{Evidence, Setup};
use crate::feasibility::Limits;
use crate::feasibility::steering::{LegJudge, ProofSettings};
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

/// The judge of legs under the scenario's limits.
///
/// # Errors
/// A rotor layout without a flatness map, in a sentence's part.
pub(super) fn judge(setup: &Setup) -> Result<LegJudge, String> {
    let given = &setup.scenario.generate.limits;
    let limits = Limits {
        max_speed: given.max_speed_m_s.unwrap_or(f64::INFINITY),
        max_tilt: given.max_tilt_deg.map_or(Limits::default().max_tilt, f64::to_radians),
    };
    LegJudge::new(&setup.robot, &setup.world, limits, ProofSettings::default()).map_err(|error| error.to_string())
}

/// The scenario's score for graph number `graph`; `top_speed` (m/s) scores 1.
pub(super) fn score(setup: &Setup, graph: u64, top_speed: f64) -> Score {
    let seed = named_seed(setup.scenario.seed, "score", graph);
    // The name was checked with the scenario, and top speeds are > 0 with the robot.
    Score::named(&setup.scenario.generate.score, seed, top_speed).unwrap_or(Score::Random { seed })
}
