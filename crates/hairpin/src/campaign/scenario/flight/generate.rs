//! `[task]` and `[generate]`: what is to be flown, and how trajectories are searched for.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::EnvironmentSection;
use crate::campaign::scenario::{EXECUTED, SearchSection};

/// `[task]`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TaskSection {
    /// First waypoint.
    pub start_m: [f64; 3],
    /// Last waypoint.
    pub end_m: [f64; 3],
    /// Waypoints, start and end included.
    pub length: u64,
}

/// `[generate]`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct GenerateSection {
    /// none | sphere | hull | published | witness.
    pub reach: ReachName,
    /// Shortest feasible time per leg, or one fixed step.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub timing: Option<Timing>,
    /// Samples per rotor for `hull` and `published` (Res).
    pub resolution: u64,
    /// State estimate at a waypoint.
    pub estimate: Estimate,
    /// Velocities per waypoint in the `witness` roadmap (M).
    pub velocities: u64,
    /// Whether a witness is searched for afterwards for every trajectory of another reach set.
    pub certify: bool,
    /// The search.
    pub search: SearchSection,
    /// Name of a score, executed, learned:MODEL, or python:FILE.
    pub score: String,
    /// Limits beside the robot's own.
    pub limits: LimitsSection,
    /// What of the environment is searched for stress, too.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub environment: Option<EnvironmentSection>,
}

impl Default for GenerateSection {
    fn default() -> Self {
        Self {
            reach: ReachName::Witness,
            timing: None,
            resolution: 5,
            estimate: Estimate::default(),
            velocities: 8,
            certify: false,
            search: SearchSection::default(),
            score: Self::BY_HAND.into(),
            limits: LimitsSection::default(),
            environment: None,
        }
    }
}

impl GenerateSection {
    /// The score of a scenario that gives none, and of what is executed only in part.
    pub const BY_HAND: &str = "high-velocity-90";

    /// The name of the score that single legs have.
    pub fn score_of_legs(&self) -> &str {
        if self.score == EXECUTED { Self::BY_HAND } else { &self.score }
    }

    /// The timing in force: as given, else the paper's step of 1 s, or for `witness`, which finds next to nothing in
    /// 1 s, the shortest feasible of 0.8 … 4 s.
    pub fn timing_in_force(&self) -> Timing {
        self.timing.unwrap_or(match self.reach {
            ReachName::Witness => Timing { leg_time_s: Some([0.8, 4.0]), step_s: None },
            _ => Timing { leg_time_s: None, step_s: Some(1.0) },
        })
    }
}

/// The reach sets.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ReachName {
    /// Every waypoint.
    None,
    /// A ball of radius top speed times step.
    Sphere,
    /// Convex hull of the end points of constant rotor-speed runs.
    Hull,
    /// The hull exactly as the paper's program has it: one Euler step of 1 s.
    Published,
    /// Legs with an explicit control witness.
    Witness,
}

impl ReachName {
    /// The word in scenarios.
    pub fn word(self) -> &'static str {
        match self {
            ReachName::None => "none",
            ReachName::Sphere => "sphere",
            ReachName::Hull => "hull",
            ReachName::Published => "published",
            ReachName::Witness => "witness",
        }
    }
}

/// Exactly one of the two.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Timing {
    /// Smallest and largest leg time of the ladder; the shortest feasible is taken.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub leg_time_s: Option<[f64; 2]>,
    /// One fixed step.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub step_s: Option<f64>,
}

/// What is assumed of the state at a waypoint (`hull`); `witness` carries what it really has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Estimate {
    /// average: leg over step; zero: at rest.
    pub velocity: EstimatedVelocity,
    /// level, or kept from the sample that came nearest.
    pub attitude: EstimatedAttitude,
    /// zero, or kept from the sample that came nearest.
    pub rates: EstimatedRates,
}

impl Default for Estimate {
    fn default() -> Self {
        Self { velocity: EstimatedVelocity::Average, attitude: EstimatedAttitude::Level, rates: EstimatedRates::Zero }
    }
}

/// Velocity at a waypoint.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum EstimatedVelocity {
    /// Leg over step.
    Average,
    /// At rest.
    Zero,
}

/// Attitude at a waypoint.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum EstimatedAttitude {
    /// Level, yaw 0.
    Level,
    /// That of the sampled run which ended nearest.
    Keep,
}

/// Angular rates at a waypoint.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum EstimatedRates {
    /// None.
    Zero,
    /// Those of the sampled run which ended nearest.
    Keep,
}

/// `generate.limits`: none is in force that is not given.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct LimitsSection {
    /// Largest speed; without it there is no cap.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub max_speed_m_s: Option<f64>,
    /// Largest tilt of body z against world z.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub max_tilt_deg: Option<f64>,
    /// Largest planned duration of a trajectory.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub max_flight_time_s: Option<f64>,
}
