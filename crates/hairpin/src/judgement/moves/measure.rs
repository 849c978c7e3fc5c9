//! What a recording did on each move: how far it was off the path, and when it arrived.

use super::MovesError;
use super::align::Way;
use super::approach::{Approach, approaches};
use super::gap::Unseen;
use crate::trajectory::{PlannedPath, Track};

/// Which times are judged.
///
/// An arm that starts late is late: taking an offset off hides exactly that.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Clock {
    /// Those of the recording: a late start is late.
    #[default]
    AsRecorded,
    /// Those of the recording less the estimated offset: asked for by name where two clocks are known to differ.
    OffsetRemoved,
}

/// How recordings are measured.
///
/// `arrival` is applied to the plan as to the recording, so that the servo's lag at a stop does not count as lateness.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeasureSettings {
    /// A target counts as arrived at when this much of the way to it (m) is left, in the plan and in the recording
    /// alike: the last of an approach takes a servo for ever.
    pub arrival: f64,
    /// For alignment alone 1 rad counts as this many metres; 0 where the recording has no orientation.
    pub turn_weight: f64,
    /// Which times are judged.
    pub clock: Clock,
}

impl Default for MeasureSettings {
    /// 1 mm before the target, 0.1 m a radian, times as recorded.
    fn default() -> Self {
        Self { arrival: 1e-3, turn_weight: 0.1, clock: Clock::AsRecorded }
    }
}

/// One move of one recording.
///
/// m and s; a move without samples (shorter than the log's period) has no deviation.
#[derive(Debug, Clone, PartialEq)]
pub struct MoveMeasures {
    /// As in the plan.
    pub name: String,
    /// Largest distance from the path, m; `None` without a sample on the move.
    pub deviation: Option<f64>,
    /// When that was, s, by the recording's clock.
    pub deviation_at: f64,
    /// When it arrived, s, by the judged clock; `None`: it did not. Between two samples an estimate.
    pub arrived: Option<f64>,
    /// Not before this, s: the last sample at which it was not there yet. `None` where the recording begins behind it.
    pub after: Option<f64>,
    /// Not after this, s: the first sample at which it had arrived.
    pub by: Option<f64>,
    /// When it was to arrive, s.
    pub planned: f64,
    /// Since the arrival before, s; of the first move since the start of the clock, or since it set out where the
    /// offset is removed.
    pub duration: Option<f64>,
    /// The same as planned, s.
    pub planned_duration: f64,
    /// How near it came to the target; `None` without a sample about it.
    pub approach: Option<Approach>,
    /// Where it did not arrive: what was left of the way to the target in the end, turns weighed in, and how much may
    /// be left where it counts as arrived, m.
    pub left: Option<[f64; 2]>,
}

impl MoveMeasures {
    /// How late it arrived, s; negative is early.
    ///
    /// `None` too where the recording only begins behind it, too late to say that it was on time: when it was there
    /// nobody saw.
    pub fn late(&self) -> Option<f64> {
        let late = self.arrived? - self.planned;
        (self.after.is_some() || late <= 0.0).then_some(late)
    }

    /// How late it arrived at least and at most, s, whatever it did between two samples.
    ///
    /// A straight line between samples arrives later than who brakes, and earlier than who sets out.
    pub fn late_between(&self) -> Option<[f64; 2]> {
        let by = self.by? - self.planned;
        Some([self.after.map_or(f64::NEG_INFINITY, |after| after - self.planned), by])
    }
}

/// By how much the recording's clock differs from the plan's: estimated, told, and not applied unless asked for.
///
/// 1.4826 · median |x − median| estimates σ of a normal spread and does not mind outliers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Offset {
    /// Median of all arrivals' lateness, s.
    pub seconds: f64,
    /// Their spread: 1.4826 times the median distance from it, s.
    pub spread: f64,
    /// Whether it was taken off.
    pub removed: bool,
}

/// One recording, measured.
#[derive(Debug, Clone, PartialEq)]
pub struct Measured {
    /// In the order of the plan.
    pub moves: Vec<MoveMeasures>,
    /// The estimated offset; `None` if nothing arrived.
    pub offset: Option<Offset>,
    /// Median time between samples, s.
    pub sample: f64,
    /// Distance from the path at every sample, m.
    pub deviations: Vec<f64>,
    /// The move that every sample belongs to, from 0; never falls.
    pub legs: Vec<usize>,
    /// Of recordings from elsewhere: what they do not show.
    pub unseen: Option<Unseen>,
}

/// Measures `recording` against the planned path, move by move.
///
/// Samples are aligned with the path monotonely; arrival is when progress along it first comes within `arrival` of a
/// target's, between samples by linear interpolation.
///
/// Deviation is the distance of positions from the line through the planned poses, curved where the plan says how, of
/// the segments beside the aligned one.
/// Samples · poses, in the whole at most a million.
///
/// # Errors
/// A plan without a move, fewer than two samples, settings out of their bounds.
pub fn measure_moves(
    path: &PlannedPath,
    recording: &Track,
    settings: &MeasureSettings,
) -> Result<Measured, MovesError> {
    for (field, value) in [("arrival", settings.arrival), ("turn_weight", settings.turn_weight)] {
        if !(value >= 0.0 && value.is_finite()) {
            return Err(MovesError::Setting { field, value, bound: "at least 0" });
        }
    }
    if path.moves().is_empty() {
        return Err(MovesError::NoMoves);
    }
    if recording.len() < 2 {
        return Err(MovesError::Samples { found: recording.len() });
    }
    let way = Way::new(path, settings.turn_weight);
    let (progress, nearest) = way.progress(recording);
    let targets: Vec<f64> = targets(&way.ends, settings.arrival);
    let planned = arrivals(path.track().times(), &way.planned, &targets);
    let as_recorded = arrivals(recording.times(), &progress, &targets);
    let around: Vec<Around> = targets.iter().map(|target| Around::of(recording.times(), &progress, *target)).collect();
    // What was passed before the recording begins says nothing of its clock.
    let is_seen = |index: usize| around[index].after.is_some() || targets[index] <= 0.0;
    let lateness = |times: &dyn Fn(usize) -> Option<f64>| -> Vec<f64> {
        let seen = (0..targets.len()).filter(|index| is_seen(*index));
        seen.filter_map(|index| Some(times(index)? - planned[index]?)).collect()
    };
    let offset = offset(&lateness(&|index| as_recorded[index]), settings.clock);
    let removed = offset.filter(|offset| offset.removed);
    let shift = removed.map_or(0.0, |offset| offset.seconds);
    // The median of what each may have been at least, and at most: the offset is no better known than arrivals are.
    let bound = |of: &dyn Fn(usize) -> Option<f64>| removed.map_or(0.0, |_| median(lateness(of)));
    let shifts = [bound(&|index| around[index].after.or(around[index].by)), bound(&|index| around[index].by)];
    let arrived: Vec<Option<f64>> = as_recorded.iter().map(|time| time.map(|time| time - shift)).collect();
    let deviations: Vec<f64> = nearest.iter().zip(recording.poses()).map(|(j, pose)| way.deviation(*j, pose)).collect();
    // Without a common clock the first move begins when the arm sets out.
    let set_out = |times: &[f64], progress: &[f64]| {
        let first = targets[0].min(settings.arrival);
        arrivals(times, progress, &[first])[0]
    };
    let begins = match settings.clock {
        Clock::AsRecorded => [Some(0.0), Some(0.0)],
        Clock::OffsetRemoved => [
            set_out(recording.times(), &progress).map(|time| time - shift),
            set_out(path.track().times(), &way.planned),
        ],
    };
    let approaches = approaches(&way, recording, &progress, settings.arrival, settings.turn_weight > 0.0);
    let furthest = progress[progress.len() - 1];
    let mut moves: Vec<MoveMeasures> = Vec::with_capacity(targets.len());
    for (index, given) in path.moves().iter().enumerate() {
        let before = if index == 0 { begins } else { [arrived[index - 1], planned[index - 1]] };
        let since = |time: Option<f64>, before: Option<f64>| Some(time? - before?);
        moves.push(MoveMeasures {
            name: given.name.clone(),
            deviation: None,
            deviation_at: 0.0,
            arrived: arrived[index],
            after: around[index].after.map(|time| time - shifts[1]),
            by: around[index].by.map(|time| time - shifts[0]),
            planned: planned[index].unwrap_or_else(|| path.passes(index)),
            duration: since(arrived[index], before[0]),
            planned_duration: since(planned[index], before[1]).unwrap_or(0.0),
            approach: approaches[index],
            left: arrived[index].is_none().then(|| [furthest, targets[index]].map(|along| way.ends[index] - along)),
        });
    }
    let legs: Vec<usize> = progress.iter().map(|along| way.owner(*along)).collect();
    for (sample, deviation) in deviations.iter().enumerate() {
        let one = &mut moves[legs[sample]];
        if one.deviation.is_none_or(|most| *deviation > most) {
            one.deviation = Some(*deviation);
            one.deviation_at = recording.times()[sample];
        }
    }
    let steps = recording.times().windows(2).map(|pair| pair[1] - pair[0]).collect();
    Ok(Measured { moves, offset, sample: median(steps), deviations, legs, unseen: None })
}

/// Where along the path each move counts as arrived; never before the one before it.
pub(super) fn targets(ends: &[f64], arrival: f64) -> Vec<f64> {
    let mut before = 0.0;
    let targets = ends.iter().map(|end| {
        // A move shorter than twice the distance is over at its middle.
        let target = (end - arrival).max(0.5 * (before + end));
        before = *end;
        target
    });
    targets.collect()
}

/// When progress first reaches each target, between samples linearly.
fn arrivals(times: &[f64], progress: &[f64], targets: &[f64]) -> Vec<Option<f64>> {
    let reach = |target: &f64| {
        let i = progress.partition_point(|progress| progress < target);
        if i == progress.len() {
            return None;
        }
        if i == 0 {
            return Some(times[0]);
        }
        let share = (target - progress[i - 1]) / (progress[i] - progress[i - 1]);
        Some(times[i - 1] + share * (times[i] - times[i - 1]))
    };
    targets.iter().map(reach).collect()
}

/// The samples between which a target was arrived at, s.
struct Around {
    after: Option<f64>,
    by: Option<f64>,
}

impl Around {
    fn of(times: &[f64], progress: &[f64], target: f64) -> Self {
        let i = progress.partition_point(|progress| *progress < target);
        Self { after: i.checked_sub(1).map(|before| times[before]), by: times.get(i).copied() }
    }
}

/// `late`: of every arrival, s.
fn offset(late: &[f64], clock: Clock) -> Option<Offset> {
    if late.is_empty() {
        return None;
    }
    let seconds = median(late.to_vec());
    let spread = 1.4826 * median(late.iter().map(|late| (late - seconds).abs()).collect());
    Some(Offset { seconds, spread, removed: clock == Clock::OffsetRemoved })
}

/// Of at least one value.
pub(super) fn median(mut values: Vec<f64>) -> f64 {
    values.sort_unstable_by(f64::total_cmp);
    let half = values.len() / 2;
    if values.len().is_multiple_of(2) { 0.5 * (values[half - 1] + values[half]) } else { values[half] }
}
