//! `[generate]`: how drives are searched for.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{DirectionDeg, DriveEnvironmentSection};
use crate::campaign::UserScore;
use crate::campaign::learn::KeptModel;
use crate::campaign::scenario::{Aggregate, EXECUTED, Sampling, SearchMethod, SearchSection};
use crate::feasibility::steering::shooting::Control;
use crate::judgement::Stress;
use crate::robot::rover::Kinematics;

/// `[generate]`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct DriveGenerate {
    /// none | sphere | hull | witness.
    pub reach: GroundReach,
    /// Time step of the reach sets that have one: sphere, hull.
    pub step_s: f64,
    /// arc | turn-drive-turn | cubic | quintic | time-polynomial | knots | velocity-polynomial.
    pub control: ControlName,
    /// What the vehicle may do on a leg.
    pub manoeuvres: Vec<Manoeuvre>,
    /// How speed changes along the way.
    pub speed: SpeedSection,
    /// Direction of travel in the body, left positive: for vehicles that steer all wheels. `[least, greatest]`: each
    /// waypoint has one of its own, drawn evenly, and along a leg it turns evenly from one to the other.
    pub direction_deg: DirectionDeg,
    /// source | exact: without or with what the suspension adds to the body's velocity (vz, ωx, ωy); of plans, runs and
    /// proofs.
    pub kinematics: Kinematics,
    /// Headings per waypoint in the `witness` roadmap.
    pub headings: u64,
    /// Limits beside the robot's own.
    pub limits: DriveLimits,
    /// The boundary-value solver.
    pub solver: SolverSection,
    /// The search.
    pub search: DriveSearch,
    /// What of the environment is searched for stress, too.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub environment: Option<DriveEnvironmentSection>,
}

impl Default for DriveGenerate {
    fn default() -> Self {
        Self {
            reach: GroundReach::Witness,
            step_s: 5.0,
            control: ControlName::Quintic,
            manoeuvres: vec![Manoeuvre::Forward],
            speed: SpeedSection::default(),
            direction_deg: DirectionDeg::All(0.0),
            kinematics: Kinematics::Source,
            headings: 4,
            limits: DriveLimits::default(),
            solver: SolverSection::default(),
            search: DriveSearch::default(),
            environment: None,
        }
    }
}

/// The reach sets of ground vehicles.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum GroundReach {
    /// Every waypoint.
    None,
    /// A disc of radius top speed times step.
    Sphere,
    /// Convex hull of the end points of constant-input runs.
    Hull,
    /// Legs that the boundary-value solver solves within all limits.
    Witness,
}

impl GroundReach {
    /// The word in scenarios.
    pub fn word(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Sphere => "sphere",
            Self::Hull => "hull",
            Self::Witness => "witness",
        }
    }
}

/// Families of controls: how curvature may depend on the way, and what there is beside it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ControlName {
    /// Constant curvature, after a turn in place: the heading of an arc's end is as it comes.
    Arc,
    /// Straight, between turns in place.
    TurnDriveTurn,
    /// A polynomial of third order in arc length.
    Cubic,
    /// A polynomial of fifth order in arc length; where none keeps the bounds, clothoids, in both gears if they are
    /// allowed.
    #[default]
    Quintic,
    /// A polynomial of fifth order in time.
    TimePolynomial,
    /// A spline through knots.
    Knots,
    /// Linear and angular velocity as polynomials of time.
    VelocityPolynomial,
}

impl ControlName {
    /// The generator's own name for it.
    pub fn control(self) -> Control {
        match self {
            Self::Arc => Control::Arc,
            Self::TurnDriveTurn => Control::TurnDriveTurn,
            Self::Cubic => Control::Cubic,
            Self::Quintic => Control::Quintic,
            Self::TimePolynomial => Control::TimePolynomial,
            Self::Knots => Control::Knots,
            Self::VelocityPolynomial => Control::VelocityPolynomial,
        }
    }

    /// The word in scenarios.
    pub fn word(self) -> &'static str {
        self.control().name()
    }
}

/// `generate.speed`: how the commanded speed changes along the way. Without `constant`, drives begin and end at rest
/// and stop where the gear changes and for turns in place.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct SpeedSection {
    /// constant | ramp | trapezoid; if not given a trapezoid where the robot's acceleration is bounded, else constant.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub profile: Option<ProfileName>,
    /// Least and greatest speed at which waypoints are passed, each at its own; the commanded speed if not given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub waypoint_m_s: Option<[f64; 2]>,
    /// Acceleration and deceleration; the robot's own if not given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub acceleration_m_s2: Option<f64>,
}

/// How speed changes from waypoint to waypoint.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ProfileName {
    /// One speed all along, without time for stops.
    Constant,
    /// From one waypoint's speed to the next one's, evenly in time.
    Ramp,
    /// Up to the commanded speed between waypoints.
    Trapezoid,
}

/// What a vehicle may do on a leg.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Manoeuvre {
    /// Drive forward.
    Forward,
    /// Drive in reverse, and change gear on the way.
    Reverse,
    /// Turn in place.
    TurnInPlace,
}

/// `generate.limits`: beside those of the robot, whichever is smaller holds.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct DriveLimits {
    /// Largest curvature of the commands.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub curvature_1_m: Option<f64>,
    /// Largest change of curvature along the way.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub curvature_rate_1_m2: Option<f64>,
    /// Commanded speed; the robot's default speed if not given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub speed_m_s: Option<f64>,
    /// Largest angle of the body's z axis from the vertical.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tilt_deg: Option<f64>,
    /// Smallest height of the body's underside over the ground.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub belly_clearance_m: Option<f64>,
}

/// `generate.solver`: counts, no clock.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct SolverSection {
    /// Distance within which a waypoint counts as met.
    pub position_m: f64,
    /// Heading within which it does.
    pub yaw_rad: f64,
    /// Curvature within which it does.
    pub curvature_1_m: f64,
    /// Predictions per leg.
    pub iterations: u64,
    /// Ways around to start from, at most.
    pub starts: u64,
}

impl Default for SolverSection {
    fn default() -> Self {
        Self { position_m: 0.01, yaw_rad: 0.01, curvature_1_m: 0.01, iterations: 20, starts: 8 }
    }
}

/// `generate.search` of drives.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct DriveSearch {
    /// beam | exact | uniform | in-loop | adaptive.
    pub method: SearchMethod,
    /// Terms joined by +: slope, roll, curvature-change, slip, speed, reversals; random; executed; learned:MODEL; or
    /// python:FILE.
    pub score: String,
    /// How scores of legs become the score of a trajectory.
    pub aggregate: Aggregate,
    /// Waypoints sampled per graph.
    pub waypoints: u64,
    /// How they are sampled.
    pub sampling: Sampling,
    /// Partial trajectories expanded per iteration.
    pub width: u64,
    /// Cases asked for: one best per sampled graph, unless `per_graph` asks for more.
    pub cases: u64,
    /// Trajectories taken from one graph at most.
    pub per_graph: u64,
    /// Whether a waypoint may be used twice.
    pub revisits: bool,
    /// Iterations per graph at most.
    pub iterations: u64,
    /// Partial trajectories kept on the frontier at most; the worst are dropped.
    pub frontier: u64,
    /// Graphs sampled at most; 20 per case asked for if not given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub graphs: Option<u64>,
    /// `in-loop`, and the score `executed`: executions per graph at most; `adaptive`: executions of all rounds
    /// together.
    pub executions: u64,
    /// `in-loop`: executions under noise that what would be kept is given in addition; its stress is the mean. 0: none.
    pub confirm: u64,
    /// `adaptive`: rounds of executing and learning; in the first nothing is known, and all is drawn uniformly. If not
    /// given, one for 45 executions, at least 4 where there are enough, at most 15.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rounds: Option<u64>,
    /// `adaptive`: share of every later round's executions that is drawn uniformly, whatever the model says.
    pub explore: f64,
    /// `adaptive`: time for executing and learning beside `executions`; what is found then depends on the clock.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub time_s: Option<f64>,
    /// `in-loop`: whether waypoints are moved off their graph, as far as legs can be solved.
    pub move_waypoints: bool,
    /// `in-loop`, `adaptive`, and the score `executed`: what is searched for: max-deviation | mean-deviation |
    /// max-acceleration | time | overshoot | saturation | clearance | tilt.
    pub stress: Stress,
    /// The model of a learned score.
    #[serde(skip)]
    #[schemars(skip)]
    pub model: Option<KeptModel>,
    /// The score of the user's own.
    #[serde(skip)]
    #[schemars(skip)]
    pub user_score: Option<UserScore>,
}

/// The score of a scenario that gives none, and of what is executed only in part.
const BY_HAND: &str = "slope+slip";

impl Default for DriveSearch {
    fn default() -> Self {
        let SearchSection {
            method,
            waypoints: _,
            sampling,
            width,
            cases,
            per_graph,
            revisits,
            aggregate,
            iterations,
            frontier,
            graphs,
            executions,
            confirm,
            rounds,
            explore,
            time_s,
            move_waypoints,
            stress,
        } = SearchSection::default();
        Self {
            method,
            score: BY_HAND.into(),
            aggregate,
            // Every leg is a boundary-value problem: a graph of 60 has some thousand of them within reach.
            waypoints: 60,
            sampling,
            width,
            cases,
            per_graph,
            revisits,
            iterations,
            frontier,
            graphs,
            executions,
            confirm,
            rounds,
            explore,
            time_s,
            move_waypoints,
            stress,
            model: None,
            user_score: None,
        }
    }
}

impl DriveSearch {
    /// The name of the score that single legs have.
    pub fn score_of_legs(&self) -> &str {
        if self.score == EXECUTED { BY_HAND } else { &self.score }
    }

    /// The part that flights have as well.
    pub fn section(&self) -> SearchSection {
        SearchSection {
            method: self.method,
            waypoints: self.waypoints,
            sampling: self.sampling,
            width: self.width,
            cases: self.cases,
            per_graph: self.per_graph,
            revisits: self.revisits,
            aggregate: self.aggregate,
            iterations: self.iterations,
            frontier: self.frontier,
            graphs: self.graphs,
            executions: self.executions,
            confirm: self.confirm,
            rounds: self.rounds,
            explore: self.explore,
            time_s: self.time_s,
            move_waypoints: self.move_waypoints,
            stress: self.stress,
        }
    }
}
