//! A recording of a real arm as a run of a program.

use super::ArmSetup;
use super::execute::legs_of;
use crate::campaign::Case;
use crate::campaign::scenario::LogClock;
use crate::judgement::moves::{MeasureSettings, Measured, measure_moves};
use crate::simulation::SimulationError;
use crate::trajectory::{ATTITUDE_UNKNOWN, Channel, Ended, Flight, PlannedPath, Track};

/// A recording that ends before its program does.
#[derive(Debug, Clone, PartialEq)]
pub struct Shorter {
    /// Its last stamp, s.
    pub ends: f64,
    /// The move that it ends on, from 0.
    pub reached: usize,
    /// Moves of the program.
    pub moves: usize,
    /// That move's name.
    pub name: String,
}

/// A recording begins within so many times the program's duration of where that begins, and within so many seconds.
const FAR_BEHIND: f64 = 10.0;
const FAR_BEHIND_S: f64 = 60.0;

/// Samples of a recording that are looked at to find its program.
///
/// Alignment costs samples times path: 512 tell one program from another.
const SAMPLES: usize = 512;

impl ArmSetup {
    /// `recording` (`base_from_tcp`, its channel `move` if it has one counted from 0 after home) as a run of the
    /// program of `case`, on its own stamps; and where it ends, if that is before its program does.
    ///
    /// It is shorter than the program if it does not arrive at the last target but one, or ends nearer to that than to
    /// the last: where the last target is only missed, by whatever distance, that is for the judge.
    ///
    /// # Errors
    /// A case whose program cannot be planned; a recording that the oracle cannot align, moves that the program has
    /// not, times of another clock where arrivals are limited by them.
    pub fn recorded(
        &self,
        case: &Case,
        recording: Track,
        orientation_known: bool,
    ) -> Result<(Flight, Option<Shorter>), SimulationError> {
        let path = self.planned_path(case)?;
        let moves = path.moves().len();
        if let Some(value) =
            recording.channel("move").and_then(|values| values.iter().find(|value| **value > moves as f64))
        {
            return Err(SimulationError::new(
                "move",
                value.to_string(),
                "one of the program, counted from 0 after the start at home",
            ));
        }
        self.is_by_the_programs_clock(&path, &recording)?;
        let measured = aligned(&path, &recording, orientation_known)?;
        let ends = recording.times().last().copied().unwrap_or(0.0);
        let short = shorter(&path, &measured, &recording);
        let mut times = vec![recording.times().first().copied()];
        times.extend(measured.moves.iter().map(|one| one.arrived));
        times[moves] = times[moves].or((short.is_none()).then_some(ends));
        let unknown = Channel { name: ATTITUDE_UNKNOWN.into(), values: vec![1.0; recording.len()] };
        let channels = recording.channels().iter().cloned().chain((!orientation_known).then_some(unknown)).collect();
        let track = Track::new(recording.times().to_vec(), recording.poses().to_vec(), channels)
            .map_err(|error| SimulationError::new("recording", error.to_string(), "a track"))?;
        Ok((Flight { track: legs_of(&track)?, ended: Ended::Done, left_world: None, reached: times }, short))
    }

    /// Refuses a recording that begins far behind all of the program where its arrivals are limited by its own clock:
    /// one of another clock, as Unix seconds are, is late by as much as that clock shows.
    fn is_by_the_programs_clock(&self, path: &PlannedPath, recording: &Track) -> Result<(), SimulationError> {
        let takes = path.moves().len().checked_sub(1).map_or(0.0, |last| path.passes(last));
        let begins = recording.times().first().copied().unwrap_or(0.0);
        let limited = self.scenario.spec.arrival.is_some() && self.scenario.execute.log_clock == LogClock::AsRecorded;
        let most = (FAR_BEHIND * takes).max(FAR_BEHIND_S);
        if !limited || begins.abs() <= most {
            return Ok(());
        }
        let value = format!("{begins:.3} s, of a program that takes {takes:.2} s");
        Err(SimulationError::new(
            "the log's first time",
            value,
            "within ten of its durations, or a minute, of where it begins: these times are of another clock; \
             `judge LOG --from S` says when the program began, `execute.log_clock = \"offset-removed\"` takes an \
             estimated offset off",
        ))
    }

    /// Mean distance (m) of `recording` from the path of `case`, and whether it runs to its end: which program it is
    /// of.
    ///
    /// # Errors
    /// A case whose program cannot be planned; a recording that the oracle cannot align.
    /// What tells which of several programs a recording is of: the case of the least.
    pub fn distance(
        &self,
        case: &Case,
        recording: &Track,
        orientation_known: bool,
    ) -> Result<(f64, bool), SimulationError> {
        let path = self.planned_path(case)?;
        let last = recording.len().saturating_sub(1);
        let stride = recording.len().div_ceil(SAMPLES).max(1);
        let which: Vec<usize> = (0..last).step_by(stride).chain([last]).collect();
        let times = which.iter().map(|i| recording.times()[*i]).collect();
        let thin = Track::new(times, which.iter().map(|i| recording.poses()[*i]).collect(), Vec::new())
            .map_err(|error| SimulationError::new("recording", error.to_string(), "a track"))?;
        let measured = aligned(&path, &thin, orientation_known)?;
        let mean = measured.deviations.iter().sum::<f64>() / measured.deviations.len() as f64;
        Ok((mean, shorter(&path, &measured, &thin).is_none()))
    }
}

/// `recording` along `path`.
///
/// Turns count in the alignment only where orientations were recorded.
fn aligned(path: &PlannedPath, recording: &Track, orientation_known: bool) -> Result<Measured, SimulationError> {
    let usual = MeasureSettings::default();
    let turn_weight = if orientation_known { usual.turn_weight } else { 0.0 };
    measure_moves(path, recording, &MeasureSettings { turn_weight, ..usual }).map_err(|error| {
        SimulationError::new("recording", error.to_string(), "one that can be aligned with the program")
    })
}

/// Where `recording` ends, if that is before its program does.
///
/// ```text
/// reached = 1 + last move whose target was arrived at, at most the last; 0 where none was
/// short   ⇔ the last target was missed, and (reached < last, or |end − p_(last−1)| < |end − p_last|)
/// ```
///
/// Places in m, base frame; p_k is where the planned path passes target k.
fn shorter(path: &PlannedPath, measured: &Measured, recording: &Track) -> Option<Shorter> {
    let moves = path.moves().len();
    let last = moves.saturating_sub(1);
    let reached =
        measured.moves.iter().rposition(|one| one.arrived.is_some()).map_or(0, |arrived| (arrived + 1).min(last));
    let place = |index: usize| path.track().position(index);
    let (end, before) =
        (place(path.moves()[last].end), place(last.checked_sub(1).map_or(0, |one| path.moves()[one].end)));
    let stands = recording.position(recording.len() - 1);
    let missed = measured.moves[last].arrived.is_none();
    let short = missed && (reached < last || (stands - before).norm() < (stands - end).norm());
    let ends = recording.times().last().copied().unwrap_or(0.0);
    short.then(|| Shorter { ends, reached, moves, name: path.moves()[reached].name.clone() })
}
