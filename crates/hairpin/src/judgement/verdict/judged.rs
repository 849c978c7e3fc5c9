//! What a campaign came to, as far as its verdict tells it.

use crate::judgement::chosen::Chosen;
use crate::judgement::spec::Violation;

/// How many cases stand on which evidence.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Claim<'a> {
    /// The evidence word: `witnessed`, `hull-feasible`, `unchecked`.
    pub word: &'a str,
    /// Cases.
    pub count: usize,
}

/// The worst of all runs: of the violations if there is one, else the value that came nearest to its limit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Worst<'a> {
    /// The case's name, such as `0117`.
    pub case: &'a str,
    /// What was measured, where, and its limit (which need not be exceeded).
    pub value: &'a Violation,
    /// Share of rotor-time at a limit, 0 … 1, on that leg or run.
    pub saturation: Option<f64>,
}

/// Cases that nobody chose, for the worst to stand beside.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Beside<'a> {
    /// What the worst is the worst of: `4 000 flown`.
    pub of: &'a str,
    /// What the others came to: `random feasible ones 1.22 m in the mean (1.05 to 1.40), 1.90 m at worst of 20`.
    pub by_chance: &'a str,
}

/// What a campaign came to.
///
/// Counts, not cases: what they rest on stays with the campaign.
#[derive(Debug, Clone, Copy)]
pub struct Judged<'a> {
    /// How obtained, in order: `["simulated", "anafi stand-in", "minimum-snap"]`.
    pub how: &'a [&'a str],
    /// Runs per case.
    pub runs: usize,
    /// Runs that came to no flight, of how many.
    pub unflown: [usize; 2],
    /// Cases in all.
    pub cases: usize,
    /// Whether runs were held against anything; where they were not, crashes and leaving the world alone are counted.
    pub limited: bool,
    /// Cases asked for, where fewer were found; told, not counted.
    pub asked: usize,
    /// Cases with a violation.
    pub failed: usize,
    /// Cases that the executor failed to fly.
    pub executor_failed: usize,
    /// Cases whose data allow no verdict.
    pub inconclusive: usize,
    /// Cases that were not executed or not judged for want of time.
    pub undone: usize,
    /// What was left undone of the campaign for want of time, in a sentence's part: it is no pass then.
    pub cut: Option<&'a str>,
    /// Executions of the search that failed, of how many: what it kept says nothing of the trajectories of these, so
    /// that it is no pass then.
    pub search_failed: [u64; 2],
    /// Why one of these did.
    pub search_trouble: &'a str,
    /// What the executor's failures were: `time-out 60 s, stderr kept`.
    pub trouble: &'a str,
    /// Why the data of the first case that allows no verdict allow none.
    pub doubt: &'a str,
    /// The worst of all runs; `None` where nothing is limited.
    pub worst: Option<Worst<'a>>,
    /// What the worst stands beside, where that is known.
    pub beside: Option<Beside<'a>>,
    /// Share of cases that may violate; `None` or 0: not one.
    pub share_limit: Option<f64>,
    /// Confidence of the share's interval.
    pub confidence: f64,
    /// How the cases were come by, which says whether their share has an interval.
    pub chosen: Chosen,
    /// Of the runs of an only case whose values were drawn: how many violate, of how many that were judged.
    pub draws: Option<[usize; 2]>,
    /// Evidence of the cases, those of count 0 left out.
    pub claims: &'a [Claim<'a>],
    /// How often violations come again, where they were run again.
    pub reruns: Option<&'a str>,
    /// What of the runs a limit was not held against: `2 of 20 legs within corner_m of their waypoints`.
    pub passed_over: &'a [String],
    /// What the claims rest on that is not known, or leave out: `link shapes estimated`.
    pub estimated: Option<&'a str>,
    /// How far from the best the cases' scores can be, where every case has a proof: `optimal`, `gap at most 3.1 %`.
    pub proof: Option<&'a str>,
}

impl Default for Judged<'_> {
    fn default() -> Self {
        Self {
            how: &[],
            runs: 1,
            unflown: [0, 0],
            cases: 0,
            limited: true,
            asked: 0,
            failed: 0,
            executor_failed: 0,
            inconclusive: 0,
            undone: 0,
            cut: None,
            search_failed: [0, 0],
            search_trouble: "",
            trouble: "",
            doubt: "",
            worst: None,
            beside: None,
            share_limit: None,
            confidence: 0.95,
            chosen: Chosen::default(),
            draws: None,
            claims: &[],
            reruns: None,
            passed_over: &[],
            estimated: None,
            proof: None,
        }
    }
}
