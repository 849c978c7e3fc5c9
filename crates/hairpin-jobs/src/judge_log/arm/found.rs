//! What an arm's log was found to be, and what it came to.

use hairpin::campaign::CaseResult;
use hairpin::campaign::arm::Shorter;
use hairpin::judgement::moves::Offset;

use super::super::matching::Matched;
use super::super::source::SourceTold;

/// Which joints of a log are the arm's axes.
#[derive(Debug, Clone, PartialEq)]
pub struct JointsTold {
    /// Their names in the log, axes 1 to 6.
    pub names: Vec<String>,
    /// The same in the order in which the log has them.
    pub order: Vec<String>,
    /// Whether they are called as the arm's file says; else they are numbered.
    pub by_name: bool,
    /// What their angles are in: `rad`, `deg`, or both.
    pub unit: &'static str,
    /// What else the log has.
    pub others: Vec<String>,
}

/// What an arm's log was found to be.
#[derive(Debug)]
pub struct FoundProgram {
    /// The case.
    pub case: String,
    /// How that was found out.
    pub matched: Option<Matched>,
    /// Where its joints or poses, and its times, are from.
    pub source: SourceTold,
    /// Its joints by name; `None` where it has none.
    pub joints: Option<JointsTold>,
    /// Whether its program was proven clear in one posture.
    pub in_one_posture: bool,
    /// When the program is taken to begin, s of the log.
    pub begins_s: f64,
    /// Where it ends before its program does.
    pub short: Option<Shorter>,
    /// `--to`, s of the log, where that left samples out.
    pub to_s: Option<f64>,
    /// What it was judged to be.
    pub result: CaseResult,
    /// By how much its clock is estimated to be off the program's, and the time between samples, s.
    pub offset: Option<(Offset, f64)>,
    /// How late it arrived at least and at most, s, leg by leg: all that samples tell of it. `None` where it did not.
    pub late_between: Vec<Option<[f64; 2]>>,
    /// Largest distance from the path that is not excluded between samples, m, where that is over the limit.
    pub not_excluded_m: Option<f64>,
    /// The largest deviation of the same case in simulation, m, where that was judged.
    pub simulated_m: Option<f64>,
    /// What else its reader should know.
    pub notes: Vec<String>,
}
