//! What runs did on the moves of their programs, as plain numbers: `moves.json`, and of earlier releases
//! `baseline.json`.

use nalgebra::Isometry3;
use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::campaign::{Case, RunDeviation};
use crate::judgement::moves::{Measured, MoveMeasures, Offset};
use crate::trajectory::program::{Motion, Program};

/// Every run of a campaign, move by move.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Moves {
    /// In the order of their numbers.
    pub cases: Vec<CaseMoves>,
}

/// The runs of one program.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CaseMoves {
    /// Number of the case.
    pub case: usize,
    /// Digest of what the controller is told: programs of equal digest move alike.
    pub program: String,
    /// Names of the moves.
    pub moves: Vec<String>,
    /// In the order of their numbers.
    pub runs: Vec<RunMoves>,
}

/// One run; its lists have one value a move.
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
}

/// What earlier releases did, oldest first; the last is what new runs are held against.
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
#[derive(Debug, Clone, PartialEq, Error)]
#[error("release `{release}`, case {case:04}: {what}")]
pub struct BaselineError {
    /// Which release.
    pub release: String,
    /// Which case.
    pub case: usize,
    /// What is wrong with it.
    pub what: String,
}

/// Releases that a baseline carries on at most, the last ones.
const MOST_RELEASES: usize = 50;
/// What tells two programs apart: m, °, a quaternion's part, m/s.
const TELLING: f64 = 1e-6;
/// Repeats that a spread takes.
const LEAST_RUNS: usize = 2;

impl Baseline {
    /// The release `name` on top of what it was held against itself.
    ///
    /// # Errors
    /// As [`Self::checked`].
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
        let Some(last) = self.releases.last() else { return refuse("", 0, "there is no release".into()) };
        if last.cases.is_empty() {
            return refuse(&last.name, 0, "there is none: a baseline needs programs that were run".into());
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
    /// The runs of `case`, those that were measured.
    pub(super) fn of(case: &Case, program: &Program, runs: &[&RunDeviation]) -> Option<Self> {
        let measured: Vec<(usize, &Measured)> =
            runs.iter().filter_map(|run| Some((run.run, run.moves.as_ref()?))).collect();
        let moves = measured.first()?.1.moves.iter().map(|one| one.name.clone()).collect();
        let run = |(run, measured): &(usize, &Measured)| RunMoves {
            run: *run,
            sample_s: measured.sample,
            offset_s: measured.offset.map(|offset| offset.seconds),
            offset_spread_s: measured.offset.map(|offset| offset.spread),
            offset_removed: measured.offset.is_some_and(|offset| offset.removed),
            duration_s: measured.moves.iter().map(|one| one.duration).collect(),
            deviation_m: measured.moves.iter().map(|one| one.deviation).collect(),
        };
        Some(Self { case: case.number, program: digest(program), moves, runs: measured.iter().map(run).collect() })
    }

    /// The runs as the oracle takes them.
    pub(super) fn measured(&self) -> Vec<Measured> {
        let of = |run: &RunMoves| Measured {
            moves: (self.moves.iter().zip(&run.duration_s).zip(&run.deviation_m))
                .map(|((name, duration), deviation)| MoveMeasures {
                    name: name.clone(),
                    deviation: *deviation,
                    deviation_at: 0.0,
                    arrived: None,
                    planned: 0.0,
                    duration: *duration,
                    planned_duration: 0.0,
                })
                .collect(),
            offset: run.offset(),
            sample: run.sample_s,
            deviations: Vec::new(),
        };
        self.runs.iter().map(of).collect()
    }

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

/// What the controller is told, in a few letters: targets to a micrometre and a millionth of a degree or a quaternion's
/// part, speeds, zones, tools and work objects; no names, and nothing of how the program was found.
fn digest(program: &Program) -> String {
    let mut told: Vec<f64> = Vec::new();
    program.tools.iter().for_each(|tool| tell_pose(&mut told, &tool.tcp));
    program.work_objects.iter().for_each(|object| tell_pose(&mut told, &object.base_from_object()));
    for one in &program.moves {
        told.push(match &one.motion {
            Motion::AbsoluteJoint(_) => 0.0,
            Motion::Joint(_) => 1.0,
            Motion::Linear(_) => 2.0,
            Motion::Circular { .. } => 3.0,
        });
        if let Motion::AbsoluteJoint(to) = &one.motion {
            told.extend(to.joints.map(|angle| angle.to_degrees() / TELLING));
        }
        for target in one.motion.poses() {
            tell_pose(&mut told, &target.pose);
            told.extend(target.configuration.unwrap_or([9; 4]).map(f64::from));
        }
        let (speed, zone) = (&one.speed, &one.zone);
        told.extend(
            [speed.tcp, speed.orientation, one.duration.unwrap_or(-1.0), zone.tcp].map(|value| value / TELLING),
        );
        told.extend([f64::from(u8::from(zone.fine)), one.tool as f64, one.work_object as f64]);
    }
    let mut hasher = blake3::Hasher::new();
    for value in told {
        // Adding 0 makes −0 and 0 one.
        hasher.update(&(value.round() + 0.0).to_bits().to_le_bytes());
    }
    hasher.finalize().to_hex()[..16].to_owned()
}

fn tell_pose(told: &mut Vec<f64>, pose: &Isometry3<f64>) {
    told.extend(pose.translation.vector.iter().map(|part| part / TELLING));
    let q = pose.rotation.coords;
    // q and −q are one orientation.
    let leading = q.iter().rev().find(|part| part.abs() > TELLING).map_or(1.0, |part| part.signum());
    told.extend(q.iter().map(|part| leading * part / TELLING));
}
