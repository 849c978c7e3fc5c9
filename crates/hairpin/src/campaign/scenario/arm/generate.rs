//! `[generate]`: how the programs that load the arm most are searched for.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::campaign::scenario::{LEARNED, SearchMethod, SearchSection, Target};

/// `[generate]`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ArmGenerate {
    /// joint: every link checked; cartesian: the tool's sphere only.
    pub mode: ArmMode,
    /// distance | time | controller-load | joint-effort | learned:MODEL | { table = "arc_ms.csv" } | { distance = 1.0,
    /// time = 2.0, … }.
    pub cost: CostSection,
    /// What moves are made of.
    pub moves: MovesSection,
    /// The search.
    pub search: ProgramSearch,
}

impl Default for ArmGenerate {
    fn default() -> Self {
        Self {
            mode: ArmMode::Joint,
            cost: CostSection::Named(CostName::Distance),
            moves: MovesSection::default(),
            search: ProgramSearch::default(),
        }
    }
}

/// What is proven clear.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ArmMode {
    /// Every link, along the joints' motion.
    Joint,
    /// The tool's sphere along the straight segment; the arm behind it is not looked at.
    Cartesian,
}

impl ArmMode {
    /// The word in scenarios.
    pub fn word(self) -> &'static str {
        match self {
            Self::Joint => "joint",
            Self::Cartesian => "cartesian",
        }
    }
}

/// What a program costs: the sum of its moves' costs is made as large as it can be.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum CostSection {
    /// One of ours.
    Named(CostName),
    /// What was learned.
    Learned(LearnedCost),
    /// What was measured.
    Table(CostTable),
    /// Several, each times its weight.
    Weighted(CostWeights),
}

impl CostSection {
    /// The word in reports.
    pub fn word(&self) -> &'static str {
        match self {
            Self::Named(name) => name.word(),
            Self::Learned(_) => "learned",
            Self::Table(_) => "table",
            Self::Weighted(_) => "weighted sum",
        }
    }
}

/// Costs by name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum CostName {
    /// Length of the tool's way, m.
    Distance,
    /// Duration under the joints' limits of speed and acceleration, s.
    Time,
    /// Interpolation steps and iterations of inverse kinematics of our own virtual controller.
    ControllerLoad,
    /// ∫ of squared torque where the arm has masses, else of squared joint acceleration.
    JointEffort,
}

impl CostName {
    /// The word in scenarios.
    pub fn word(self) -> &'static str {
        match self {
            Self::Distance => "distance",
            Self::Time => "time",
            Self::ControllerLoad => "controller-load",
            Self::JointEffort => "joint-effort",
        }
    }
}

/// `"learned:FILE"`: what a model of executed moves expects (`hairpin learn`).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(try_from = "String", into = "String")]
#[schemars(extend("pattern" = "^learned:"))]
pub struct LearnedCost {
    /// As written.
    pub score: String,
}

impl TryFrom<String> for LearnedCost {
    type Error = String;

    fn try_from(score: String) -> Result<Self, Self::Error> {
        match score.starts_with(LEARNED) {
            true => Ok(Self { score }),
            false => Err(format!("\"{score}\" is neither the name of a cost nor learned:FILE")),
        }
    }
}

impl From<LearnedCost> for String {
    fn from(cost: LearnedCost) -> Self {
        cost.score
    }
}

/// `{ table = "arc_ms.csv" }`: N×N numbers, row = from, empty = no such move.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CostTable {
    /// The file.
    pub table: String,
}

/// Weights of costs; what is not given has none.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default, rename_all = "kebab-case")]
pub struct CostWeights {
    /// Per m.
    pub distance: f64,
    /// Per s.
    pub time: f64,
    /// Per step.
    pub controller_load: f64,
    /// Per unit of effort.
    pub joint_effort: f64,
}

/// `moves = { speeds, zones, clearance_mm }`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct MovesSection {
    /// linear: MoveL; joint: MoveJ.
    pub kind: MoveName,
    /// Whether an arc (MoveC) through a point may stand for the two straight moves to it and from it, where it costs
    /// more.
    pub arcs: bool,
    /// Names of speeds; where there are several, moves take them in turn by draws.
    pub speeds: Vec<String>,
    /// Names of zones, likewise.
    pub zones: Vec<String>,
    /// What links and tool keep from obstacles beside touching none.
    pub clearance_mm: f64,
    /// Distance of the wrist, elbow and shoulder from their singularities.
    pub singularity_margin_deg: f64,
    /// Name of the procedure in written programs.
    pub procedure: String,
}

impl Default for MovesSection {
    fn default() -> Self {
        Self {
            kind: MoveName::Linear,
            arcs: false,
            speeds: vec!["v1000".into()],
            zones: vec!["fine".into()],
            clearance_mm: 0.0,
            singularity_margin_deg: 2.0,
            procedure: "stress".into(),
        }
    }
}

/// Kinds of moves between points.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum MoveName {
    /// MoveL: the tool goes straight.
    Linear,
    /// MoveJ: the joints do.
    Joint,
}

/// `search = { programs, visits, time_limit_s }`, or `search = { method = "worst", programs, executions, target }`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ProgramSearch {
    /// heaviest: those of largest cost | worst: those whose execution goes worst, found by executing.
    #[serde(skip_serializing_if = "ProgramMethod::is_heaviest")]
    pub method: ProgramMethod,
    /// Programs asked for, pairwise different, the heaviest or the worst first.
    pub programs: u64,
    /// `worst`: executions for each program asked for, all in one pool; 200 if not given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub executions: Option<u64>,
    /// `worst`: time for the search in the place of `executions`; what is found then depends on the clock.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub seconds: Option<f64>,
    /// `worst`: executions with other noise that what would be kept is given in addition; none if not given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub confirm: Option<u64>,
    /// `worst`: what is searched for: deviation | acceleration | time | overshoot | lateness; if not given, each limit
    /// of `[spec]`, by its margin in spreads of what is drawn at random.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub target: Option<Target>,
    /// `worst`: points of a program; as many as the heaviest has if not given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub points: Option<u64>,
    /// How often a point may come: 1 is loop-free.
    pub visits: u64,
    /// Time for the search of each program; to the proof if not given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub time_limit_s: Option<f64>,
    /// A program of less cost is not wanted, in the cost's own unit.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub min_cost: Option<f64>,
    /// Row of the point that programs begin with, from 0; any if not given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub start: Option<u64>,
    /// Row of the point that they end with.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub end: Option<u64>,
}

impl Default for ProgramSearch {
    fn default() -> Self {
        Self {
            method: ProgramMethod::Heaviest,
            programs: 1,
            executions: None,
            seconds: None,
            confirm: None,
            target: None,
            points: None,
            visits: 1,
            time_limit_s: None,
            min_cost: None,
            start: None,
            end: None,
        }
    }
}

/// How programs are searched for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ProgramMethod {
    /// The programs of largest total cost, proven.
    #[default]
    Heaviest,
    /// The programs that the controller executes worst, found by executing them.
    Worst,
}

impl ProgramMethod {
    fn is_heaviest(&self) -> bool {
        *self == Self::Heaviest
    }
}

impl ProgramSearch {
    /// The part that other robots' searches have as well: one graph of `points`, exactly searched, or executed in.
    pub(in crate::campaign::scenario) fn section(&self, points: u64) -> SearchSection {
        let usual = SearchSection::default();
        SearchSection {
            method: match self.method {
                ProgramMethod::Heaviest => SearchMethod::Exact,
                ProgramMethod::Worst => SearchMethod::Worst,
            },
            executions: self.executions.unwrap_or(usual.executions),
            seconds: self.seconds,
            confirm: self.confirm.unwrap_or(usual.confirm),
            target: self.target.clone(),
            waypoints: points,
            cases: self.programs,
            per_graph: self.programs,
            revisits: self.visits > 1,
            graphs: Some(1),
            ..usual
        }
    }
}
