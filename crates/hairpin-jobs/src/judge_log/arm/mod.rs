//! A log of an arm against the program that it ran: read as a recording, made a run as `execute --logs` does, and
//! judged as `judge OUT` judges that.
//!
//! ```text
//! MCAP ─ logs::read ─▶ Joints ─ names ─▶ axes ─┐
//! CSV ─────────── controller_log::read ────────┴▶ ControllerLog ─ matching ─▶ case ─ recorded ─▶ Run ─ judge_runs
//! ```

mod found;
mod matching;
mod names;
mod read;
mod told;

#[cfg(test)]
mod tests;

use std::path::Path;

use hairpin::campaign::arm::ArmSetup;
use hairpin::campaign::scenario::ArmMode;
use hairpin::campaign::{Case, Run, Setup, judge_runs};
use hairpin::judgement::moves::MoveMeasures;
use hairpin::trajectory::Track;
use rayon::prelude::*;

use super::against::Ready;
use super::asks::Asks;
use super::found::JudgedLog;
use super::over;
use super::settings::LogSettings;
use super::told::name_in;
use crate::Problem;

pub use found::{FoundProgram, JointsTold};

/// The arm whose logs are recordings of programs; `None` of what moves about.
pub(crate) fn arm_of(setup: &Setup) -> Option<&ArmSetup> {
    setup.own::<ArmSetup>()
}

/// The recording of `arm` in `file`, and which of `cases` it ran; a bag's begins with its program.
///
/// # Errors
/// It is no recording of this arm, or of no program of the campaign.
pub(crate) fn ran<'a>(
    file: &Path,
    arm: &ArmSetup,
    cases: &'a [Case],
    asks: &Asks,
) -> Result<(&'a Case, Track), Problem> {
    let read = read::recording(file, arm, (None, [None; 2]), asks)?;
    let (case, _) = matching::matched(arm, cases, &read.log, asks).map_err(|why| Problem::of_file(file, why))?;
    Ok((case, read.log.track))
}

/// The programs of a campaign, which logs are held against.
pub(super) struct Programs<'a> {
    arm: &'a ArmSetup,
    cases: Vec<Case>,
}

impl<'a> Programs<'a> {
    /// Those of `against`, if they are an arm's.
    ///
    /// # Errors
    /// The folder's files are broken.
    pub(super) fn of(against: &'a Ready) -> Result<Option<Self>, Problem> {
        let Some(arm) = arm_of(&against.setup) else { return Ok(None) };
        let cases = against.cases.par_iter().map(|case| against.whole(case)).collect::<Result<Vec<Case>, Problem>>()?;
        Ok(Some(Self { arm, cases }))
    }

    /// Judges the log in `file`.
    ///
    /// # Errors
    /// It is no recording of this arm, or of no program of the campaign.
    pub(super) fn judge_file(
        &self,
        file: &Path,
        against: &Ready,
        settings: &LogSettings,
    ) -> Result<JudgedLog, Problem> {
        let refuse = |why: String| Problem::of_file(file, why);
        let part = (settings.source.as_deref(), [settings.from_s, settings.to_s]);
        let read = read::recording(file, self.arm, part, &Asks::JUDGE)?;
        let (case, matched) = matching::matched(self.arm, &self.cases, &read.log, &Asks::JUDGE).map_err(refuse)?;
        let recorded = self.arm.recorded(case, read.log.track, read.log.orientation_known);
        let (flight, short) = recorded.map_err(|error| refuse(error.to_string()))?;
        let run = Run { case: case.number, run: 0, drawn: Vec::new(), outcome: Ok(flight), full_rate: None };
        let (result, deviations) = judge_runs(&against.setup, case, std::slice::from_ref(&run))?;
        let measured = deviations.into_iter().next().and_then(|run| run.moves);
        let simulated = against.simulated.iter().find(|result| result.case == case.number);
        let found = FoundProgram {
            case: case.id(),
            matched,
            source: read.source,
            joints: read.joints,
            in_one_posture: self.arm.scenario.generate.mode == ArmMode::Joint,
            begins_s: read.begins_s,
            short,
            to_s: read.to_s,
            result,
            late_between: measured.iter().flat_map(|run| &run.moves).map(MoveMeasures::late_between).collect(),
            not_excluded_m: measured.as_ref().and_then(|run| run.unseen.as_ref()?.not_excluded),
            offset: measured.as_ref().and_then(|measured| Some((measured.offset?, measured.sample))),
            simulated_m: simulated.and_then(|result| Some(result.measured()?.max_deviation)),
            notes: read.notes,
        };
        let judged = told::judged((file, &name_in(&settings.path, file)), found, &against.setup);
        match settings.page {
            Some(_) => over::of_program(judged, case, &run, against),
            None => Ok(judged),
        }
    }
}
