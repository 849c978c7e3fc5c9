//! What runs did on the moves of their programs, as plain numbers: `moves.json`, and of earlier releases
//! `baseline.json`.
//!
//! SI units; lists of one length, one entry a move. What is compared is the time from arrival to arrival and the
//! largest distance from the path; clocks are brought together by one estimated offset a run.

use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::CaseNumber;
use crate::judgement::moves::Offset;

/// Every run of a campaign, move by move.
///
/// Written by `judge` where motions are programs.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Moves {
    /// In the order of their numbers.
    pub cases: Vec<CaseMoves>,
}

/// The runs of one program.
///
/// Runs of the same program in two releases are compared by its digest, whatever its number is.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CaseMoves {
    /// Number of the case.
    pub case: CaseNumber,
    /// Digest of what the controller is told: programs of equal digest move alike.
    pub program: String,
    /// Names of the moves.
    pub moves: Vec<String>,
    /// In the order of their numbers.
    pub runs: Vec<RunMoves>,
}

/// One run; its lists have one value a move.
///
/// s and m.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RunMoves {
    /// 0: nominal.
    pub run: usize,
    /// Median time between samples.
    pub sample_s: f64,
    /// By how much the recording's clock differs from the plan's, as estimated; `None` if nothing arrived.
    pub offset_s: Option<f64>,
    /// Spread of that estimate.
    pub offset_spread_s: Option<f64>,
    /// Whether it was taken off, as asked.
    pub offset_removed: bool,
    /// Time from arrival to arrival; `None`: did not arrive.
    pub duration_s: Vec<Option<f64>>,
    /// Largest distance from the path; `None` without a sample on the move.
    pub deviation_m: Vec<Option<f64>>,
    /// Of logs: what they do not show.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unseen: Option<RunUnseen>,
}

/// What a log does not show.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RunUnseen {
    /// Longest time between two samples.
    pub longest_gap_s: f64,
    /// The stamp before it.
    pub from_s: f64,
    /// The first and the last move that it hides some of.
    pub moves: [String; 2],
    /// Share of the plan's time that it hides.
    pub plan_share: f64,
    /// Moves with a sample on them.
    pub moves_seen: usize,
    /// Largest distance from the path that is not excluded between samples, where that is over the limit; earlier
    /// releases called it `estimated_m`.
    #[serde(default, skip_serializing_if = "Option::is_none", alias = "estimated_m")]
    pub not_excluded_m: Option<f64>,
}

/// What earlier releases did, oldest first; the last is what new runs are held against.
///
/// Spreads come from the runs of one release: two at least.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Baseline {
    /// One at least.
    pub releases: Vec<ReleaseMoves>,
}

/// A release by its name.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ReleaseMoves {
    /// As verdicts call it: `7.14`.
    pub name: String,
    /// Its programs.
    pub cases: Vec<CaseMoves>,
}

/// Why numbers are no baseline.
///
/// Told with the file's name by the door.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("release `{release}`, case {case}: {what}")]
pub struct BaselineError {
    /// Which release.
    pub release: String,
    /// Which case.
    pub case: CaseNumber,
    /// What is wrong with it.
    pub what: String,
}

/// Releases that a baseline carries on at most, the last ones.
const MOST_RELEASES: usize = 50;
/// Repeats that a spread takes.
const LEAST_RUNS: usize = 2;

impl Baseline {
    /// The release `name` on top of what it was held against itself.
    ///
    /// # Errors
    /// As [`Self::checked`].
    ///
    /// The oldest are dropped beyond 50.
    pub fn of(earlier: Option<Self>, name: &str, moves: Moves) -> Result<Self, BaselineError> {
        let mut releases = earlier.map_or_else(Vec::new, |baseline| baseline.releases);
        releases.push(ReleaseMoves { name: name.into(), cases: moves.cases });
        let first = releases.len().saturating_sub(MOST_RELEASES);
        Self { releases: releases.split_off(first) }.checked()
    }

    /// The baseline, if it is one.
    ///
    /// # Errors
    /// No release; a case without moves, or fewer than two runs of one in the last release; lists of other lengths;
    /// numbers that are no times and distances.
    pub fn checked(self) -> Result<Self, BaselineError> {
        let refuse = |release: &str, case, what| Err(BaselineError { release: release.into(), case, what });
        let Some(last) = self.releases.last() else { return refuse("", CaseNumber(0), "there is no release".into()) };
        if last.cases.is_empty() {
            return refuse(&last.name, CaseNumber(0), "there is none: a baseline needs programs that were run".into());
        }
        for one in &last.cases {
            if one.runs.len() < LEAST_RUNS {
                let found = one.runs.len();
                let runs = if found == 1 { "run" } else { "runs" };
                let what = format!(
                    "{found} {runs}: must be at least {LEAST_RUNS}, for the band comes from their spread (execute.repeat)"
                );
                return refuse(&last.name, one.case, what);
            }
        }
        for release in &self.releases {
            for one in &release.cases {
                if let Some(what) = one.wrong() {
                    return refuse(&release.name, one.case, what);
                }
            }
        }
        Ok(self)
    }
}

impl CaseMoves {
    fn wrong(&self) -> Option<String> {
        let moves = self.moves.len();
        if moves == 0 {
            return Some("no move".into());
        }
        for RunMoves { run, sample_s, duration_s, deviation_m, .. } in &self.runs {
            for (name, values) in [("duration_s", duration_s), ("deviation_m", deviation_m)] {
                if values.len() != moves {
                    return Some(format!("run {run}: {} values of {name}, must be {moves}", values.len()));
                }
                if let Some(index) =
                    values.iter().position(|value| value.is_some_and(|value| !(value >= 0.0 && value.is_finite())))
                {
                    let value = values[index].unwrap_or(f64::NAN);
                    return Some(format!("run {run}: {name}[{index}] = {value}: must be ≥ 0"));
                }
            }
            if !(*sample_s >= 0.0 && sample_s.is_finite()) {
                return Some(format!("run {run}: sample_s = {sample_s}: must be ≥ 0"));
            }
        }
        None
    }
}

impl RunMoves {
    /// By how much its clock differs from the plan's.
    pub fn offset(&self) -> Option<Offset> {
        Some(Offset { seconds: self.offset_s?, spread: self.offset_spread_s?, removed: self.offset_removed })
    }
}
