//! A recording of a real arm as a run of a program.

use super::ArmSetup;
use super::execute::legs_of;
use crate::campaign::Case;
use crate::judgement::moves::{MeasureSettings, measure_moves};
use crate::simulation::SimulationError;
use crate::trajectory::{ATTITUDE_UNKNOWN, Channel, Ended, Flight, Track};

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

impl ArmSetup {
    /// `recording` (`base_from_tcp`, its channel `move` if it has one counted from 0 after home) as a run of the
    /// program of `case`, on its own stamps.
    ///
    /// It is shorter than the program if it does not arrive at the last target but one, or ends nearer to that than to
    /// the last: where the last target is only missed, by whatever distance, that is for the judge.
    ///
    /// # Errors
    /// A case whose program cannot be planned; a recording that the oracle cannot align, moves that the program has
    /// not.
    pub fn recorded(
        &self,
        case: &Case,
        recording: Track,
        orientation_known: bool,
    ) -> Result<Result<Flight, Shorter>, SimulationError> {
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
        let usual = MeasureSettings::default();
        let turn_weight = if orientation_known { usual.turn_weight } else { 0.0 };
        let measured =
            measure_moves(&path, &recording, &MeasureSettings { turn_weight, ..usual }).map_err(|error| {
                SimulationError::new("recording", error.to_string(), "one that can be aligned with the program")
            })?;
        let ends = recording.times().last().copied().unwrap_or(0.0);
        let last = moves.saturating_sub(1);
        let reached =
            measured.moves.iter().rposition(|one| one.arrived.is_some()).map_or(0, |arrived| (arrived + 1).min(last));
        let place = |index: usize| path.track().position(index);
        let (end, before) =
            (place(path.moves()[last].end), place(last.checked_sub(1).map_or(0, |one| path.moves()[one].end)));
        let stands = recording.position(recording.len() - 1);
        let missed = measured.moves[last].arrived.is_none();
        if missed && (reached < last || (stands - before).norm() < (stands - end).norm()) {
            let name = path.moves()[reached].name.clone();
            return Ok(Err(Shorter { ends, reached, moves, name }));
        }
        let mut times = vec![recording.times().first().copied()];
        times.extend(measured.moves.iter().map(|one| one.arrived));
        times[moves] = times[moves].or(Some(ends));
        let unknown = Channel { name: ATTITUDE_UNKNOWN.into(), values: vec![1.0; recording.len()] };
        let channels = recording.channels().iter().cloned().chain((!orientation_known).then_some(unknown)).collect();
        let track = Track::new(recording.times().to_vec(), recording.poses().to_vec(), channels)
            .map_err(|error| SimulationError::new("recording", error.to_string(), "a track"))?;
        Ok(Ok(Flight { track: legs_of(&track)?, ended: Ended::Done, left_world: None, reached: times }))
    }
}
