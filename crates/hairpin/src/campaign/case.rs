//! What a campaign is made of: cases (planned), runs (executed), results (judged).
//!
//! | type | made by | file |
//! | --- | --- | --- |
//! | [`Case`] | generate, or imported | `trajectories/`, `profiles/` or `programs/` |
//! | [`Run`] | execute, or an executor | `executions/`, `runs.parquet` |
//! | [`CaseResult`] | judge | `results.parquet` |
//!
//! Plain data: each can be written, read back and handed to the next job without anything else but the scenario.

use nalgebra::{Point3, Vector3};

use super::digits::percent_digits;
use super::{CaseNumber, Environment, FullRate};
use crate::feasibility::reach::LegFeatures;
use crate::judgement::{Measures, Share, Violation, share};
use crate::trajectory::Drive;
use crate::trajectory::program::Program;
use crate::trajectory::{Flight, Profile};

/// What stands behind a case: the evidence words of files, JSON and reports.
///
/// Each word has one meaning everywhere. None of them says anything of a controller or of a real robot.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Evidence {
    /// Nothing was claimed (`none`, `sphere`, missions made elsewhere).
    Unchecked,
    /// Each step lies in the convex hull of sampled end points: a geometric filter.
    HullFeasible,
    /// A control profile integrates through it, for the model.
    Witnessed,
    /// The tool's sphere touches nothing along an arm's segments; the links were not looked at.
    ClearToolSphere,
    /// No link and no tool of an arm touches anything along its moves, and its joints keep their limits.
    ClearAllLinks,
}

impl Evidence {
    /// Every kind, the strongest first.
    /// So that what rests on several cases is told by the strongest first.
    pub const ALL: [Evidence; 5] = [
        Evidence::ClearAllLinks,
        Evidence::ClearToolSphere,
        Evidence::Witnessed,
        Evidence::HullFeasible,
        Evidence::Unchecked,
    ];

    /// Whether it says that nothing is touched.
    pub fn is_clearance(self) -> bool {
        matches!(self, Evidence::ClearToolSphere | Evidence::ClearAllLinks)
    }

    /// The word in files.
    pub fn word(self) -> &'static str {
        match self {
            Evidence::Unchecked => "unchecked",
            Evidence::HullFeasible => "hull-feasible",
            Evidence::Witnessed => "witnessed",
            Evidence::ClearToolSphere => "clear: tool sphere",
            Evidence::ClearAllLinks => "clear: all links",
        }
    }

    /// Whether what is claimed is that of a witness: a control profile, commands or a program.
    pub fn is_of_a_witness(self) -> bool {
        matches!(self, Evidence::Witnessed | Evidence::ClearToolSphere | Evidence::ClearAllLinks)
    }

    /// The evidence whose word in files is `word`.
    ///
    /// The inverse of [`Self::word`]; `None` of any other word.
    pub fn from_word(word: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|e| e.word() == word)
    }
}

/// What a search saw of a leg: what scores are made of, and what stress is learned from.
///
/// Kept with the case so that a model can be learned from executions without planning anew.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SeenLeg {
    /// Speeds, turn, length, climb, slope_in, ground.
    pub features: LegFeatures,
    /// Planned duration, s, before stops were put in.
    pub duration: f64,
}

impl SeenLeg {
    /// Names of [`Self::numbers`], with their units.
    pub const NAMES: [&'static str; 8] =
        ["v_in_m_s", "v_out_m_s", "turn_rad", "length_m", "climb_m", "slope_in", "ground", "duration_s"];

    /// As a row of a file.
    pub fn numbers(&self) -> [f64; 8] {
        let LegFeatures { v_in, v_out, turn, length, climb, slope_in, ground } = self.features;
        [v_in, v_out, turn, length, climb, slope_in, ground, self.duration]
    }

    /// From a row of a file.
    ///
    /// The inverse of [`Self::numbers`].
    pub fn of([v_in, v_out, turn, length, climb, slope_in, ground, duration]: [f64; 8]) -> Self {
        Self { features: LegFeatures { v_in, v_out, turn, length, climb, slope_in, ground }, duration }
    }
}

/// The commands behind a case, by what carries them out.
///
/// What `verify` integrates and what executors may fly: written to files as it is, in coefficients and segments, not
/// in samples.
#[derive(Debug, Clone, PartialEq)]
pub enum Witness {
    /// The flat outputs of a flight as polynomials of time, leg by leg.
    Profile(Profile),
    /// The segments and speeds of a drive.
    Drive(Drive),
    /// What an arm runs.
    Program(Program),
}

impl From<Profile> for Witness {
    fn from(profile: Profile) -> Self {
        Self::Profile(profile)
    }
}

impl From<Drive> for Witness {
    fn from(drive: Drive) -> Self {
        Self::Drive(drive)
    }
}

impl From<Program> for Witness {
    fn from(program: Program) -> Self {
        Self::Program(program)
    }
}

impl Witness {
    /// The same for case number `case`, after which a program is called.
    pub(super) fn of_case(mut self, case: CaseNumber) -> Self {
        if let Self::Program(program) = &mut self {
            program.name = case.of_program();
        }
        self
    }

    /// Legs between waypoints; `None` for a program, whose moves may be fewer or more.
    ///
    /// One fewer than waypoints where it fits its case.
    pub fn legs(&self) -> Option<usize> {
        match self {
            Self::Profile(profile) => Some(profile.legs.len()),
            Self::Drive(drive) => Some(drive.legs.len()),
            Self::Program(_) => None,
        }
    }

    /// The profile, if it is one.
    pub fn profile(&self) -> Option<&Profile> {
        if let Self::Profile(profile) = self { Some(profile) } else { None }
    }

    /// The commands of a drive, if they are.
    pub fn commands(&self) -> Option<&Drive> {
        if let Self::Drive(drive) = self { Some(drive) } else { None }
    }

    /// The program, if it is one.
    pub fn program(&self) -> Option<&Program> {
        if let Self::Program(program) = self { Some(program) } else { None }
    }
}

/// A generated trajectory: case `number`, counted from 0.
///
/// Everything about it follows from the scenario, its graph and its number; nothing from execution but `score` and
/// `environment` of searches that execute.
#[derive(Debug, Clone, PartialEq)]
pub struct Case {
    /// 0, 1, 2 …; in files `0000`, `0001`, ….
    pub number: CaseNumber,
    /// The case's seed: [`crate::math::random::case_seed`].
    /// Runs, draws and noise have named seeds under it. Of cases that an executor of the user's carried out while
    /// they were searched for, it follows from the waypoints instead, so that they are carried out again alike.
    pub seed: u64,
    /// Number of the sampled graph it was found in.
    pub graph: u64,
    /// Waypoints, both ends included, m, world frame.
    pub waypoints: Vec<Point3<f64>>,
    /// Planned duration of each leg, s.
    /// One fewer than waypoints; empty where nothing is timed.
    pub leg_times: Vec<f64>,
    /// What the search saw of each leg; empty for missions made elsewhere, for arms, and where a search that executes
    /// moved waypoints or made the case of others.
    pub seen: Vec<SeenLeg>,
    /// Score under the scenario's objective; of `in-loop` the stress that was executed.
    /// No unit for scores by hand; the unit of the stress where it was executed. 0 of missions made elsewhere, of
    /// which it says nothing.
    pub score: f64,
    /// Proven upper bound of the score in its graph, where the search has one.
    /// In the unit of the score; equal to it where the optimum is proven.
    pub bound: Option<f64>,
    /// What stands behind it.
    pub evidence: Evidence,
    /// Answer of a certification asked for afterwards: `yes`, `no` or `unknown`.
    pub certified: Option<&'static str>,
    /// The commands that it claims to be carried out by; `None` where it claims no more than its waypoints.
    pub witness: Option<Witness>,
    /// What was found beside the waypoints of a flight or drive.
    pub environment: Option<Environment>,
}

impl Case {
    /// A case of which nothing is known but its waypoints.
    ///
    /// Evidence [`Evidence::Unchecked`], no times, no witness.
    pub fn bare(number: CaseNumber, seed: u64, waypoints: Vec<Point3<f64>>) -> Self {
        Self {
            number,
            seed,
            graph: 0,
            waypoints,
            leg_times: Vec::new(),
            seen: Vec::new(),
            score: 0.0,
            bound: None,
            evidence: Evidence::Unchecked,
            certified: None,
            witness: None,
            environment: None,
        }
    }

    /// The polynomials of its witness, if it has these.
    pub fn profile(&self) -> Option<&Profile> {
        self.witness.as_ref()?.profile()
    }

    /// The drive that is its witness, if it is one.
    pub fn commands(&self) -> Option<&Drive> {
        self.witness.as_ref()?.commands()
    }

    /// The program that is its witness, if it is one.
    pub fn program(&self) -> Option<&Program> {
        self.witness.as_ref()?.program()
    }

    /// The name in files.
    ///
    /// `0117`.
    pub fn id(&self) -> String {
        self.number.to_string()
    }

    /// How far below the proven bound the score lies, as a share of the score's size: 0 for the best there is. `None`
    /// without a bound.
    ///
    /// (bound − score) / |score|, at least 0.
    pub fn gap(&self) -> Option<f64> {
        let short = (self.bound? - self.score).max(0.0);
        Some(if short == 0.0 { 0.0 } else { short / self.score.abs() })
    }

    /// The evidence word, and where the search proved a bound `optimal` or `gap 3.1 %`.
    ///
    /// `witnessed`, `hull-feasible, gap 3.1 %`, `clear: all links, optimal`.
    pub fn claim(&self) -> String {
        match self.gap() {
            None => self.evidence.word().into(),
            Some(gap) => format!("{}, {}", self.evidence.word(), gap_word(gap, "gap")),
        }
    }
}

/// `optimal` for no gap that is more than rounding, else `{gap} 3.1 %`.
pub(super) fn gap_word(share: f64, gap: &str) -> String {
    if share <= 1e-9 { "optimal".into() } else { format!("{gap} {} %", percent_digits(share)) }
}

/// One sample of the planned motion.
///
/// World frame. Given to controllers and executors that track a plan in time.
#[derive(Debug, Clone, PartialEq)]
pub struct Timed {
    /// Stamp, s.
    pub t: f64,
    /// Position, m.
    pub position: Point3<f64>,
    /// Velocity, m/s.
    pub velocity: Vector3<f64>,
}

/// One execution of a case: run 0 is the nominal one.
///
/// A pure function of the scenario, the case and `run` where our own simulator carried it out.
#[derive(Debug, Clone, PartialEq)]
pub struct Run {
    /// Number of the case.
    pub case: CaseNumber,
    /// 0: nominal.
    pub run: usize,
    /// Values drawn for `[vary]`, by key.
    pub drawn: Vec<(String, serde_json::Value)>,
    /// What happened, or why the executor failed.
    /// A sentence of the executor's, or ours of what it did not answer.
    pub outcome: Result<Flight, String>,
    /// What was measured of it before rows were left out; `None` while all of its rows are there.
    pub full_rate: Option<Box<FullRate>>,
}

/// The verdict on a case or run.
///
/// Of a case over all of its runs, in this precedence: fail, executor failed, inconclusive, then pass or unjudged.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Status {
    /// Within spec.
    Pass,
    /// At least one limit violated.
    Fail,
    /// Nothing was asked for, and nothing crashed or left the world: neither pass nor fail.
    Unjudged,
    /// The executor failed: neither pass nor fail.
    ExecutorFailed,
    /// The data do not allow a verdict.
    Inconclusive,
}

impl Status {
    /// The word in files: `pass`, `fail`, `unjudged`, `executor-failed`, `inconclusive`.
    pub fn word(self) -> &'static str {
        match self {
            Status::Pass => "pass",
            Status::Fail => "fail",
            Status::Unjudged => "unjudged",
            Status::ExecutorFailed => "executor-failed",
            Status::Inconclusive => "inconclusive",
        }
    }

    /// The status whose word in files is `word`.
    ///
    /// The inverse of [`Self::word`].
    pub fn from_word(word: &str) -> Option<Self> {
        [Status::Pass, Status::Fail, Status::Unjudged, Status::ExecutorFailed, Status::Inconclusive]
            .into_iter()
            .find(|s| s.word() == word)
    }
}

/// A violation that was run again with other noise.
///
/// Other noise, the same draws: whether the violation is the mission's or the noise's.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Reruns {
    /// Runs that violate.
    pub violated: usize,
    /// Of so many that were judged.
    pub of: usize,
}

impl Reruns {
    /// The share that violates, with its Clopper-Pearson interval.
    ///
    /// `confidence` in 0 … 1; `None` where no run was judged.
    pub fn share(&self, confidence: f64) -> Option<Share> {
        share(self.violated, self.of, confidence)
    }
}

/// The runs of a case whose values `[vary]` drew: at random and each by itself, so that their share of violations is an
/// estimate, of this case.
///
/// An estimate for this case's mission under `[vary]`, never for cases, which a search chose.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Draws {
    /// Runs that violate.
    pub violated: usize,
    /// Of so many that were judged.
    pub of: usize,
}

impl Draws {
    /// The share that violates, with its Clopper-Pearson interval.
    pub fn share(&self, confidence: f64) -> Option<Share> {
        share(self.violated, self.of, confidence)
    }
}

/// A judged case: one row of `results.parquet`, its worst run.
///
/// The worst run is the gravest: a violation before none, a crash before other violations, then the larger deviation;
/// the first of equals.
#[derive(Debug, Clone, PartialEq)]
pub struct CaseResult {
    /// Number of the case.
    pub case: CaseNumber,
    /// Verdict over all runs of the case.
    pub status: Status,
    /// The worst run.
    pub run: usize,
    /// Measures of the worst run; `None` where the executor failed in every run.
    pub measures: Option<Measures>,
    /// The worst of each measure over all runs, where several were measured: which run is the worst one depends on what
    /// is limited, and these do not. [`Self::measured`] is what to ask.
    pub of_runs: Option<Box<Measures>>,
    /// How the worst run ended (`done`, `time`, …, `executor-failed`).
    pub ended: String,
    /// First time outside the world in the worst run, s.
    /// A violation of its own, whatever is limited.
    pub left_world: Option<f64>,
    /// All limits that the worst run violates, the gravest first.
    /// Empty of a pass, and of what was not asked for.
    pub violations: Vec<Violation>,
    /// Limits that other runs violate and the worst one does not, each by the run that breaks it most:
    /// `run 2: deviation 1.90 m > 1.70 m at t=3.20 s`.
    pub elsewhere: Vec<String>,
    /// Values drawn for the worst run.
    pub drawn: Vec<(String, serde_json::Value)>,
    /// Message of a failed executor.
    pub message: Option<String>,
    /// How often the violation comes again.
    pub reruns: Option<Reruns>,
    /// How many of the runs with drawn values violate; `None` where none was drawn.
    pub draws: Option<Draws>,
}

/// What of a case was not done because the time for the whole campaign was over.
///
/// The verdict then says what the budget cut off; such a case passes and fails nothing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Undone {
    /// No run of it was executed.
    NotExecuted,
    /// It was executed, and not judged.
    NotJudged,
}

impl Undone {
    /// How such a case [ended](CaseResult::ended): `not-executed`, `not-judged`.
    pub fn word(self) -> &'static str {
        match self {
            Undone::NotExecuted => "not-executed",
            Undone::NotJudged => "not-judged",
        }
    }
}

impl CaseResult {
    /// A result of which there is no more than the status, in whose word it also ended: of run 0, nothing measured.
    pub fn bare(case: CaseNumber, status: Status) -> Self {
        Self {
            case,
            status,
            run: 0,
            measures: None,
            of_runs: None,
            ended: status.word().into(),
            left_world: None,
            violations: Vec::new(),
            elsewhere: Vec::new(),
            drawn: Vec::new(),
            message: None,
            reruns: None,
            draws: None,
        }
    }

    /// The worst of each measure over its runs; `None` where nothing was measured.
    ///
    /// What is told of a case, and compared with other cases. Of one run, and in tables that do not have those of all,
    /// what the worst run measured.
    pub fn measured(&self) -> Option<&Measures> {
        self.of_runs.as_deref().or(self.measures.as_ref())
    }

    /// The result of a case of which something was left undone: neither pass nor fail.
    pub fn undone(case: CaseNumber, what: Undone) -> Self {
        Self {
            ended: what.word().into(),
            message: Some(format!("{}: the budget of time was used up", what.word().replace('-', " "))),
            ..Self::bare(case, Status::Inconclusive)
        }
    }

    /// Whether it is one of [`Self::undone`].
    pub fn is_undone(&self, what: Undone) -> bool {
        self.status == Status::Inconclusive && self.ended == what.word()
    }

    /// Whether a budget left anything of it undone.
    pub fn is_left_undone(&self) -> bool {
        [Undone::NotExecuted, Undone::NotJudged].into_iter().any(|what| self.is_undone(what))
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;

    #[test]
    fn a_bound_makes_a_claim_stronger() {
        let case = |score, bound| {
            let evidence = Evidence::HullFeasible;
            Case { score, bound, evidence, ..Case::bare(CaseNumber(7), 0, Vec::new()) }
        };
        assert_eq!(case(2.0, None).claim(), "hull-feasible");
        assert_eq!(case(2.0, Some(2.0)).claim(), "hull-feasible, optimal");
        assert_eq!(case(-2.0, Some(-1.9)).claim(), "hull-feasible, gap 5.0 %");
        assert_eq!(case(2.0, Some(2.001)).claim(), "hull-feasible, gap 0.050 %");
        assert_eq!(case(0.0, Some(0.0)).gap(), Some(0.0));
    }
}
