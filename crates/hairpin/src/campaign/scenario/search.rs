//! `generate.search`: how a graph is searched, whatever moves through it.

use std::borrow::Cow;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Serialize};

use crate::judgement::Stress;
use crate::search::Aggregate;
use crate::world::Sampling;

/// The score that is the stress which partial trajectories were executed to.
pub const EXECUTED: &str = "executed";
/// What a score begins with that a model tells: `learned:FILE`.
pub const LEARNED: &str = "learned:";
/// What a score of the user's own begins with: `python:FILE`.
pub const PYTHON: &str = "python:";

/// `generate.search`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct SearchSection {
    /// worst | beam | exact | uniform | in-loop | adaptive.
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
    /// `worst`: executions for each case asked for, all in one pool; `in-loop`, and the score `executed`: executions
    /// per graph at most; `adaptive`: executions of all rounds together.
    pub executions: u64,
    /// `worst`: time for the search, s, in the place of `executions`; what is found then depends on the clock.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub seconds: Option<f64>,
    /// `worst`, `in-loop`: executions under noise that what would be kept is given in addition; its stress is the mean.
    /// 0: none.
    pub confirm: u64,
    /// `adaptive`: rounds of executing and learning; in the first nothing is known, and all is drawn uniformly. If not
    /// given, one for 45 executions, at least 4 where there are enough, at most 15.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rounds: Option<u64>,
    /// `adaptive`: share of every later round's executions that no model chooses: half of them drawn uniformly, half
    /// optima of scores by hand.
    pub explore: f64,
    /// `adaptive`: time for executing and learning beside `executions`; what is found then depends on the clock.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub time_s: Option<f64>,
    /// `worst`, `in-loop`: whether waypoints are moved off their graph, as far as the reach set lets them; if not
    /// given, `worst` moves them and `in-loop` does not.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub move_waypoints: Option<bool>,
    /// `worst`: what is searched for; if not given, each limit of `[spec]`, by its margin in spreads of what is drawn
    /// at random: deviation | clearance | acceleration | time | overshoot | tip-over | lateness.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub target: Option<Target>,
    /// `in-loop`, `adaptive`, and the score `executed`: what is searched for: max-deviation | mean-deviation |
    /// max-acceleration | time | overshoot | saturation | clearance | tilt.
    pub stress: Stress,
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
            executions: 200,
            seconds: None,
            confirm: 0,
            rounds: None,
            explore: 0.2,
            time_s: None,
            move_waypoints: None,
            target: None,
            stress: Stress::MaxDeviation,
        }
    }
}

/// Why nothing was found where all that was executed went without the measure that is searched for, in a sentence's
/// part.
pub(in crate::campaign) const UNMEASURED: &str = "no execution came to a measure of what is searched for";

/// The key of what is searched for.
pub const TARGET_KEY: &str = "generate.search.target";

/// What the method `worst` searches for.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub enum Target {
    /// Largest deviation from the reference.
    Deviation,
    /// Least distance from obstacles.
    Clearance,
    /// Largest acceleration.
    Acceleration,
    /// Time taken.
    Time,
    /// Largest overshoot at a waypoint.
    Overshoot,
    /// Least angle by which the body must still lean to tip over; of what flies, its largest tilt.
    TipOver,
    /// Latest arrival at a waypoint, by its planned time.
    Lateness,
    /// What a function of the user's makes of a run: `python:FILE`, its file.
    Python(String),
}

impl Target {
    const MEASURED: [Self; 7] = [
        Self::Deviation,
        Self::Clearance,
        Self::Acceleration,
        Self::Time,
        Self::Overshoot,
        Self::TipOver,
        Self::Lateness,
    ];

    /// The word in scenarios.
    pub fn word(&self) -> String {
        let word = match self {
            Self::Deviation => "deviation",
            Self::Clearance => "clearance",
            Self::Acceleration => "acceleration",
            Self::Time => "time",
            Self::Overshoot => "overshoot",
            Self::TipOver => "tip-over",
            Self::Lateness => "lateness",
            Self::Python(file) => return format!("{PYTHON}{file}"),
        };
        word.into()
    }

    /// As a stress, of which more is worse; `None` of what only the user's function knows.
    pub fn stress(&self) -> Option<Stress> {
        match self {
            Self::Deviation => Some(Stress::MaxDeviation),
            Self::Clearance => Some(Stress::Clearance),
            Self::Acceleration => Some(Stress::MaxAcceleration),
            Self::Time => Some(Stress::Time),
            Self::Overshoot => Some(Stress::Overshoot),
            Self::TipOver => Some(Stress::Tilt),
            Self::Lateness => Some(Stress::Lateness),
            Self::Python(_) => None,
        }
    }
}

impl From<Target> for String {
    fn from(target: Target) -> Self {
        target.word()
    }
}

impl TryFrom<String> for Target {
    type Error = String;

    fn try_from(word: String) -> Result<Self, String> {
        if let Some(file) = word.strip_prefix(PYTHON) {
            return Ok(Self::Python(file.into()));
        }
        let words = || Self::MEASURED.iter().map(|target| format!("`{}`", target.word())).collect::<Vec<_>>();
        let unknown = || format!("unknown variant `{word}`, expected one of {}, `{PYTHON}FILE`", words().join(", "));
        Self::MEASURED.into_iter().find(|target| target.word() == word).ok_or_else(unknown)
    }
}

impl JsonSchema for Target {
    fn schema_name() -> Cow<'static, str> {
        "Target".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "description": "What the method `worst` searches for: a measure, or `python:FILE`, a function of your own.",
            "anyOf": [
                { "enum": Self::MEASURED.map(|target| target.word()) },
                { "type": "string", "pattern": format!("^{PYTHON}") },
            ],
        })
    }
}

/// The searches.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum SearchMethod {
    /// One pool of executions for all cases: what is executed decides what is tried next, and the worst that differ are
    /// kept.
    Worst,
    /// Algorithms 1 and 2 of the paper.
    Beam,
    /// Dynamic programming: the optimum, or the proof that there is none.
    Exact,
    /// Uniform over all feasible trajectories: the random baseline.
    Uniform,
    /// Simulation in the loop: trajectories are scored by executing them.
    InLoop,
    /// Rounds of executing trajectories and learning from them which are worth executing next.
    Adaptive,
}

impl SearchMethod {
    /// The word in scenarios.
    pub fn word(self) -> &'static str {
        match self {
            Self::Worst => "worst",
            Self::Beam => "beam",
            Self::Exact => "exact",
            Self::Uniform => "uniform",
            Self::InLoop => "in-loop",
            Self::Adaptive => "adaptive",
        }
    }

    /// Whether trajectories are executed while they are searched for.
    pub fn executes(self) -> bool {
        matches!(self, Self::Worst | Self::InLoop | Self::Adaptive)
    }

    /// Whether the scenario's score is asked: executions, or what rounds learn of them, take its place else.
    pub fn reads_scores(self) -> bool {
        !matches!(self, Self::Worst | Self::Adaptive)
    }
}

/// Executions that a round needs at least to learn from: one more than a model does, so that one that fails does not
/// cost the round.
pub(in crate::campaign) const LEAST_PER_ROUND: u64 = 13;
/// Executions of a round where the scenario does not say how many there are: what a round taught decides what the next
/// one executes, so that many small ones get farther than few large ones, as long as each has something to teach.
const PER_ROUND: u64 = 45;
/// Rounds then, where there are enough executions for them.
const ROUNDS: [u64; 2] = [4, 15];

impl SearchSection {
    /// Graphs that an adaptive campaign executes in.
    pub fn adaptive_graphs(&self) -> u64 {
        self.cases.div_ceil(self.per_graph.max(1))
    }

    /// Executions that a round needs: one in each graph, and enough to learn from.
    pub(in crate::campaign) fn least_per_round(&self) -> u64 {
        self.adaptive_graphs().max(LEAST_PER_ROUND)
    }

    /// Rounds of an adaptive campaign.
    pub fn adaptive_rounds(&self) -> u64 {
        let [least, most] = ROUNDS;
        let enough = (self.executions / self.least_per_round()).max(1);
        self.rounds.unwrap_or_else(|| (self.executions / PER_ROUND).clamp(least, most).min(enough))
    }

    /// Executions of the pool of the method `worst`.
    pub fn pooled_executions(&self) -> u64 {
        self.executions.saturating_mul(self.cases)
    }

    /// Keys that stand there with another value than the usual one and that the method has no use for under `score`,
    /// with their values.
    pub fn passed_over(&self, score: &str) -> Vec<(&'static str, String)> {
        let usual = Self::default();
        let (pools, executes) = (self.method == SearchMethod::Worst, self.executes(score));
        let no_rounds = self.method != SearchMethod::Adaptive;
        let beside_target = self.target.is_some() && self.stress != usual.stress;
        let given = [
            ("width", pools && self.width != usual.width, self.width.to_string()),
            ("per_graph", pools && self.per_graph != usual.per_graph, self.per_graph.to_string()),
            ("aggregate", pools && self.aggregate == Aggregate::Max, "\"max\"".to_owned()),
            ("executions", !executes && self.executions != usual.executions, self.executions.to_string()),
            ("confirm", !executes && self.confirm != usual.confirm, self.confirm.to_string()),
            ("move_waypoints", !executes && self.move_waypoints == Some(true), "true".to_owned()),
            ("rounds", no_rounds && self.rounds.is_some(), self.rounds.unwrap_or_default().to_string()),
            ("explore", no_rounds && self.explore.to_bits() != usual.explore.to_bits(), self.explore.to_string()),
            ("time_s", no_rounds && self.time_s.is_some(), self.time_s.unwrap_or_default().to_string()),
            ("stress", pools && beside_target, format!("\"{}\"", self.stress.word())),
        ];
        given.into_iter().filter(|(_, idle, _)| *idle).map(|(key, _, value)| (key, value)).collect()
    }

    /// Whether waypoints are moved off their graphs.
    pub fn moves_waypoints(&self) -> bool {
        self.move_waypoints.unwrap_or(self.method == SearchMethod::Worst)
    }

    /// Whether trajectories are executed while they are searched for under `score`.
    pub fn executes(&self, score: &str) -> bool {
        self.method.executes() || score == EXECUTED
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;

    #[test]
    fn what_a_method_has_no_use_for_is_known() {
        let usual = SearchSection { method: SearchMethod::Worst, ..SearchSection::default() };
        let under = |search: &SearchSection, score| {
            search.passed_over(score).into_iter().map(|(key, _)| key).collect::<Vec<_>>()
        };
        let keys = |search: &SearchSection| under(search, "random");
        assert!(keys(&usual).is_empty());
        let idle = SearchSection { per_graph: 3, rounds: Some(2), stress: Stress::Time, ..usual };
        assert_eq!(keys(&idle), ["per_graph", "rounds"], "a stress without a target is what is searched for");
        let aimed = SearchSection { target: Some(Target::Deviation), ..idle };
        assert_eq!(keys(&aimed), ["per_graph", "rounds", "stress"]);
        // What never executes has no use for executions.
        let beam = SearchSection { executions: 30, confirm: 2, move_waypoints: Some(true), ..SearchSection::default() };
        assert_eq!(beam.passed_over("random")[0], ("executions", "30".to_owned()));
        assert_eq!(keys(&beam), ["executions", "confirm", "move_waypoints"]);
        assert!(under(&beam, EXECUTED).is_empty() && keys(&SearchSection::default()).is_empty());
        let rounds = SearchSection { explore: 0.3, time_s: Some(9.0), rounds: Some(2), ..SearchSection::default() };
        assert_eq!(keys(&rounds), ["rounds", "explore", "time_s"]);
        assert!(keys(&SearchSection { method: SearchMethod::Adaptive, ..rounds }).is_empty());
    }

    #[test]
    fn rounds_follow_from_executions() {
        let rounds = |cases, executions, rounds| {
            SearchSection { cases, executions, rounds, ..SearchSection::default() }.adaptive_rounds()
        };
        let of_six = [12, 26, 52, 200, 360, 900].map(|executions| rounds(6, executions, None));
        assert_eq!(of_six, [1, 2, 4, 4, 8, 15]);
        assert_eq!((rounds(100, 250, None), rounds(100, 250, Some(7))), (2, 7));
    }
}
