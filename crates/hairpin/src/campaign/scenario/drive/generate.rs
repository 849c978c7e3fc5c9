//! `[generate]`: how drives are searched for.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::campaign::scenario::{Aggregate, Sampling, SearchMethod, SearchSection};

/// `[generate]`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct DriveGenerate {
    /// none | sphere | hull | witness.
    pub reach: GroundReach,
    /// Time step of the reach sets that have one: sphere, hull.
    pub step_s: f64,
    /// arc | cubic | quintic | knots | velocity-polynomial.
    pub control: ControlName,
    /// What the vehicle may do on a leg.
    pub manoeuvres: Vec<Manoeuvre>,
    /// Headings per waypoint in the `witness` roadmap.
    pub headings: u64,
    /// Limits beside the robot's own.
    pub limits: DriveLimits,
    /// The boundary-value solver.
    pub solver: SolverSection,
    /// The search.
    pub search: DriveSearch,
}

impl Default for DriveGenerate {
    fn default() -> Self {
        Self {
            reach: GroundReach::Witness,
            step_s: 5.0,
            control: ControlName::Quintic,
            manoeuvres: vec![Manoeuvre::Forward],
            headings: 4,
            limits: DriveLimits::default(),
            solver: SolverSection::default(),
            search: DriveSearch::default(),
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

/// Families of controls: how curvature may depend on the way.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ControlName {
    /// Constant.
    Arc,
    /// A polynomial of third order in arc length.
    Cubic,
    /// A polynomial of fifth order in arc length.
    #[default]
    Quintic,
    /// A spline through knots.
    Knots,
    /// Linear and angular velocity as polynomials of time.
    VelocityPolynomial,
}

impl ControlName {
    /// The word in scenarios.
    pub fn word(self) -> &'static str {
        match self {
            Self::Arc => "arc",
            Self::Cubic => "cubic",
            Self::Quintic => "quintic",
            Self::Knots => "knots",
            Self::VelocityPolynomial => "velocity-polynomial",
        }
    }
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
    /// beam | exact | uniform.
    pub method: SearchMethod,
    /// Terms joined by +: slope, roll, curvature-change, slip, speed, reversals; or random.
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
}

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
        } = SearchSection::default();
        Self {
            method,
            score: "slope+slip".into(),
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
        }
    }
}

impl DriveSearch {
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
        }
    }
}
