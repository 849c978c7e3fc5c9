//! The scenario: every key of a scenario file, with its default. These types are the contract: the parser,
//! the JSON Schema and the commented files of `hairpin new` all come from them. Units are in the names.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::robot::quadrotor::QuadrotorDescription;

/// A value that a key must not have.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("{key} = {value}: must be {bound}")]
pub struct Mistake {
    /// Dotted key: `generate.search.width`, `world.obstacles[0].box.size_m`.
    pub key: String,
    /// The value as given.
    pub value: String,
    /// What it must be.
    pub bound: String,
}

/// A scenario file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Scenario {
    /// Format of the file: 1.
    pub hairpin: u32,
    /// A shipped robot's name, a robot file, or the robot's own table.
    pub robot: RobotSource,
    /// Root seed of the campaign.
    #[serde(default)]
    pub seed: u64,
    /// The space.
    pub world: WorldSection,
    /// What is to be flown.
    pub task: TaskSection,
    /// How trajectories are searched for.
    #[serde(default)]
    pub generate: GenerateSection,
    /// How they are executed.
    #[serde(default)]
    pub execute: ExecuteSection,
    /// Any scenario key may have a distribution.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub vary: BTreeMap<String, Distribution>,
    /// What is within spec.
    #[serde(default)]
    pub spec: SpecSection,
}

/// Where the robot's numbers come from. Resolved scenarios hold the table.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum RobotSource {
    /// A shipped name or a path.
    Name(String),
    /// The numbers themselves.
    Inline(Box<QuadrotorDescription>),
}

impl<'de> Deserialize<'de> for RobotSource {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Visitor;
        impl<'de> serde::de::Visitor<'de> for Visitor {
            type Value = RobotSource;
            fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
                f.write_str("a robot's name, a robot file, or a table with its numbers")
            }
            fn visit_str<E>(self, name: &str) -> Result<RobotSource, E> {
                Ok(RobotSource::Name(name.into()))
            }
            fn visit_map<A: serde::de::MapAccess<'de>>(self, map: A) -> Result<RobotSource, A::Error> {
                QuadrotorDescription::deserialize(serde::de::value::MapAccessDeserializer::new(map))
                    .map(|description| RobotSource::Inline(Box::new(description)))
            }
        }
        deserializer.deserialize_any(Visitor)
    }
}

/// `[world]`: m, z up, origin at a floor corner of the cage.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WorldSection {
    /// A shipped world (or world file) whose keys are taken where this table has none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub base: Option<String>,
    /// Edge lengths.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub size_m: Option<[f64; 3]>,
    /// Waypoints and predicted paths stay this far inside; 0 if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub keep_in_margin_m: Option<f64>,
    /// Where on Earth the cage stands: used by every geodetic export.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub origin: Option<Origin>,
    /// Solids.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub obstacles: Vec<ObstacleSection>,
    /// Constant wind, velocity of the air.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wind_m_s: Option<[f64; 3]>,
    /// Gusts on top of it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gusts: Option<Gusts>,
}

/// Geodetic place and heading of the world frame.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Origin {
    /// Latitude of the origin, WGS 84.
    pub lat_deg: f64,
    /// Longitude of the origin.
    pub lon_deg: f64,
    /// Altitude of the origin above mean sea level.
    pub alt_amsl_m: f64,
    /// Compass heading of the x axis: 90: x is east.
    pub x_axis_heading_deg: f64,
}

/// Gusts: a first-order (Ornstein-Uhlenbeck) process per axis.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Gusts {
    /// Standard deviation per axis.
    pub std_m_s: f64,
    /// Correlation time.
    pub correlation_s: f64,
}

/// One obstacle: exactly one of the shapes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ObstacleSection {
    /// Name in reports.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub name: String,
    /// An axis-aligned box.
    #[serde(default, rename = "box", skip_serializing_if = "Option::is_none")]
    pub cuboid: Option<BoxSection>,
    /// A ball.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sphere: Option<SphereSection>,
    /// All points within a radius of a segment.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub capsule: Option<CapsuleSection>,
    /// The convex hull of points.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub hull: Option<HullSection>,
    /// A closed triangle mesh.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mesh: Option<MeshSection>,
}

/// `box = { center_m, size_m }`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BoxSection {
    /// Centre.
    pub center_m: [f64; 3],
    /// Edge lengths.
    pub size_m: [f64; 3],
}

/// `sphere = { center_m, radius_m }`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SphereSection {
    /// Centre.
    pub center_m: [f64; 3],
    /// Radius.
    pub radius_m: f64,
}

/// `capsule = { a_m, b_m, radius_m }`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CapsuleSection {
    /// One end of the axis.
    pub a_m: [f64; 3],
    /// The other end.
    pub b_m: [f64; 3],
    /// Radius.
    pub radius_m: f64,
}

/// `hull = { points_m }`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HullSection {
    /// At least four points that are not in one plane.
    pub points_m: Vec<[f64; 3]>,
}

/// `mesh = { vertices_m, triangles }` or `mesh = { file }` (STL or OBJ, resolved into the former when read).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MeshSection {
    /// An STL or OBJ file, relative to the scenario file.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// Vertices.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub vertices_m: Vec<[f64; 3]>,
    /// Triangles as vertex indices from 0.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub triangles: Vec<[u32; 3]>,
}

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
    /// Name of a score.
    pub score: String,
    /// Limits beside the robot's own.
    pub limits: LimitsSection,
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
            score: "high-velocity-90".into(),
            limits: LimitsSection::default(),
        }
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

/// `generate.search`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct SearchSection {
    /// beam | exact | uniform.
    pub method: SearchMethod,
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
    /// How scores of legs become the score of a trajectory.
    pub aggregate: Aggregate,
    /// Iterations per graph at most.
    pub iterations: u64,
    /// Partial trajectories kept on the frontier at most; the worst are dropped.
    pub frontier: u64,
    /// Graphs sampled at most; 20 per case asked for if not given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub graphs: Option<u64>,
}

impl Default for SearchSection {
    fn default() -> Self {
        Self {
            method: SearchMethod::Beam,
            waypoints: 250,
            sampling: Sampling::Uniform,
            width: 5,
            cases: 100,
            per_graph: 1,
            revisits: false,
            aggregate: Aggregate::Sum,
            iterations: 10_000,
            frontier: 100_000,
            graphs: None,
        }
    }
}

/// The searches.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum SearchMethod {
    /// Algorithms 1 and 2 of the paper.
    Beam,
    /// Dynamic programming: the optimum, or the proof that there is none.
    Exact,
    /// Uniform over all feasible trajectories: the random baseline.
    Uniform,
}

/// How waypoints are sampled.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Sampling {
    /// Independent and uniform.
    Uniform,
    /// A scrambled Sobol sequence.
    Sobol,
}

/// How scores of legs become the score of a trajectory.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Aggregate {
    /// As in the paper.
    Sum,
    /// The worst leg: what the verdict asks for.
    Max,
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

/// `[execute]`: a controller of ours in our simulator, or a command that speaks the executor protocol.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ExecuteSection {
    /// unstable-waypoint | stable-waypoint | fixed-velocity | minimum-snap | geometric | anafi.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub controller: Option<ControllerName>,
    /// A program that speaks the executor protocol, as a shell would split it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub command: Option<String>,
    /// Logs flown elsewhere.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub logs: Option<String>,
    /// Runs per case; run 0 is nominal, `[vary]` is drawn for the others.
    pub repeat: u64,
    /// A waypoint counts as reached inside this radius.
    pub accept_m: f64,
    /// Time limit of a run; 9 s per waypoint if not given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub time_limit_s: Option<f64>,
    /// Step of the simulated physics.
    pub step_s: f64,
    /// Force and moment noise with the robot's own densities.
    pub noise: bool,
    /// Whether leaving the world is a crash.
    pub walls: bool,
    /// Speed of the fixed-velocity controller.
    pub fixed_velocity_m_s: f64,
    /// How minimum-snap sets its leg times.
    pub segment_times: SegmentTimes,
    /// Wall-clock limit per mission of `command`.
    pub timeout_s: f64,
    /// Workers of `command`; as many as threads if not given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub workers: Option<u64>,
}

impl Default for ExecuteSection {
    fn default() -> Self {
        Self {
            controller: None,
            command: None,
            logs: None,
            repeat: 1,
            accept_m: 1.0,
            time_limit_s: None,
            step_s: 0.001,
            noise: false,
            walls: false,
            fixed_velocity_m_s: 2.0,
            segment_times: SegmentTimes::SqrtLength,
            timeout_s: 60.0,
            workers: None,
        }
    }
}

/// The controllers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ControllerName {
    /// A cascade of PIDs, poorly tuned on purpose.
    UnstableWaypoint,
    /// A cascade of PIDs, well tuned.
    StableWaypoint,
    /// A fixed speed towards the next waypoint.
    FixedVelocity,
    /// A minimum-snap polynomial through the waypoints, followed by the cascade.
    MinimumSnap,
    /// SE(3) tracking of the planned trajectory.
    Geometric,
    /// A waypoint controller with the Anafi's limits: a stand-in for its closed one.
    Anafi,
}

/// Leg times of the minimum-snap reference.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum SegmentTimes {
    /// By the square root of the leg's length: the sane default.
    SqrtLength,
    /// By the leg's length: the paper's authors' choice.
    Length,
}

/// A distribution: exactly one of `uniform`, `normal`, `choice`. Numbers or arrays of numbers.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Distribution {
    /// Low and high.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub uniform: Option<[serde_json::Value; 2]>,
    /// Mean and standard deviation.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub normal: Option<[serde_json::Value; 2]>,
    /// One of these, equally likely.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub choice: Option<Vec<serde_json::Value>>,
    /// Draws below are drawn again (truncation).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub min: Option<f64>,
    /// Draws above are drawn again.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub max: Option<f64>,
}

/// `[spec]`: what is not given is not judged.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct SpecSection {
    /// Distance from the reference.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub deviation: Option<DeviationSpec>,
    /// Overshoot at waypoints.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub overshoot: Option<MaxMetres>,
    /// Distance to obstacles, the robot's radius subtracted.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub clearance: Option<MinMetres>,
    /// Acceleration.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub acceleration: Option<MaxAcceleration>,
    /// Duration of a run.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub total_time: Option<MaxSeconds>,
    /// Share of cases that may violate the limits above; without it a single one fails.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub violation_share: Option<f64>,
    /// Confidence of the share's interval.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub confidence: Option<f64>,
}

/// `deviation = { max_m, from, corner_m }`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DeviationSpec {
    /// The limit.
    pub max_m: f64,
    /// The reference.
    #[serde(default)]
    pub from: DeviationFrom,
    /// Inside this distance of the leg's own waypoints overshoot is judged instead.
    #[serde(default)]
    pub corner_m: f64,
}

/// The reference of the deviation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum DeviationFrom {
    /// The straight leg being flown.
    #[default]
    Leg,
    /// The nearest of the previous and the current leg.
    NearestLeg,
    /// The programmed path.
    Path,
}

/// `{ max_m }`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MaxMetres {
    /// The limit.
    pub max_m: f64,
}

/// `{ min_m }`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MinMetres {
    /// The limit.
    pub min_m: f64,
}

/// `{ max_m_s2 }`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MaxAcceleration {
    /// The limit.
    pub max_m_s2: f64,
}

/// `{ max_s }`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MaxSeconds {
    /// The limit.
    pub max_s: f64,
}
