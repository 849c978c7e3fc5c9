//! What a recording does not show: gaps between its samples and what is missing at its ends, told against the plan.
//!
//! A motion with |ẍ| ≤ a that is known a time h apart stays within a·h²/8 of its chord: so far off the path it may
//! have been, though no sample says so. Where what was measured is within its limit and what may be hidden is not,
//! nothing is known, whether a is the arm's or an estimate: an estimate that is too large is mended by the arm's own
//! number, and one that is passed over would pass what nobody saw. When it arrived is known to the interval of two
//! samples, whatever bounds the motion: a limit within that is open.
//!
//! Data flow: plan and recording are aligned (`align`) → gaps, ends, moves without samples, what was left out → each
//! is held against the limits with what it may hide → [`Unseen`]: what is told always, and what leaves the verdict
//! open.

mod late;
mod left_out;

use nalgebra::Point3;

use super::MovesError;
use super::align::Way;
use super::gap::{Gap, Unseen};
use super::measure::{MeasureSettings, Measured, median, targets};
use crate::trajectory::{PlannedPath, Track};

/// What may have been between sample `i` and the one after it.
///
/// The arm's part: what joints can do between two samples, as the tool's point would show it. `i` is an index of the
/// recording, not the last.
pub trait Between {
    /// Farthest from the chord, m: a·h²/8.
    fn hidden(&self, i: usize) -> f64;

    /// Farthest of the chord from the nearer of both samples, m.
    fn half(&self, i: usize) -> f64;

    /// So many points of the chord, evenly.
    fn chord(&self, i: usize, count: usize) -> Vec<Point3<f64>>;
}

/// What a recording is held against.
///
/// Limits that are `None` are not looked at: what nothing limits, no gap leaves open.
#[derive(Clone, Copy)]
pub struct Hidden<'a> {
    /// Largest distance from the path, m.
    pub path: Option<f64>,
    /// Latest arrival, s.
    pub late: Option<f64>,
    /// How far what deviations are measured from may be from the planned path itself, m.
    pub corner: f64,
    /// What may have been between samples.
    pub between: &'a dyn Between,
    /// The key whose absence makes that rest on estimates; `None` where it does not.
    pub estimated: Option<&'a str>,
}

/// A gap is longer than so many median intervals.
/// An even clock that stutters has none.
const OUTLYING: f64 = 5.0;
/// Share of the first move that a log may begin behind.
const LEAST_SHARE: f64 = 0.1;
/// Points of a chord that are looked at.
const POINTS: usize = 32;
const MILLI: f64 = 1e3;

/// What `recording` does not show of `path`, along which it was `measured` by the same settings.
///
/// # Errors
/// As [`super::measure_moves`].
///
/// `recording` is in the plan's frame, m and s, both clocks from the same moment. Times in answers are the
/// recording's.
///
/// At least two samples, and one move; else an error. Linear in the samples beside the alignment.
pub fn unseen(
    path: &PlannedPath,
    recording: &Track,
    settings: &MeasureSettings,
    hidden: &Hidden<'_>,
    measured: &Measured,
) -> Result<Unseen, MovesError> {
    if path.moves().is_empty() {
        return Err(MovesError::NoMoves);
    }
    if recording.len() < 2 {
        return Err(MovesError::Samples { found: recording.len() });
    }
    let way = Way::new(path, settings.turn_weight);
    let (progress, nearest) = way.progress(recording);
    let times = recording.times();
    let usual = median(times.windows(2).map(|pair| pair[1] - pair[0]).collect());
    let targets = targets(&way.ends, settings.arrival);
    let look = Look { path, recording, hidden, way: &way, progress: &progress, nearest: &nearest, usual, targets };
    Ok(look.all(measured))
}

/// `progress` and `nearest` have one entry a sample, rising.
struct Look<'a> {
    path: &'a PlannedPath,
    recording: &'a Track,
    hidden: &'a Hidden<'a>,
    way: &'a Way,
    progress: &'a [f64],
    nearest: &'a [usize],
    /// Median interval, s.
    usual: f64,
    /// Where each move counts as arrived, by length.
    targets: Vec<f64>,
}

impl Look<'_> {
    fn all(&self, measured: &Measured) -> Unseen {
        let intervals = 0..self.recording.len() - 1;
        let longest = intervals.clone().max_by(|a, b| self.seconds(*a).total_cmp(&self.seconds(*b))).unwrap_or(0);
        let longest = self.gap(longest);
        let unseen = self.moves_unseen();
        let mut open = self.ends();
        let mut not_excluded = None;
        if let Some(limit) = self.hidden.path {
            let over = intervals.filter_map(|i| Some((i, self.beyond(i, limit)?)));
            if let Some((i, most)) = over.max_by(|a, b| a.1.total_cmp(&b.1)) {
                open = open.or_else(|| Some(self.told(i, most, limit)));
                not_excluded = Some(most);
            }
        }
        let (late_open, late_proven) = self.late(&measured.moves);
        let open = open.or(late_open).or_else(|| self.left_out());
        let moves = self.path.moves().len();
        Unseen { longest, seen: [moves - unseen.len(), moves], late_proven, not_excluded, open }
    }

    /// The interval after sample `i`.
    fn seconds(&self, i: usize) -> f64 {
        self.recording.times()[i + 1] - self.recording.times()[i]
    }

    /// When the plan is so far along, s.
    fn planned(&self, along: f64) -> f64 {
        let at = self.way.planned.partition_point(|length| *length < along);
        self.path.track().times()[at.min(self.way.planned.len() - 1)]
    }

    /// The plan's time, s.
    fn whole(&self) -> f64 {
        let last = self.path.moves().len() - 1;
        self.path.passes(last).max(f64::MIN_POSITIVE)
    }

    /// Moves from the first that is not over at its begin to the one that is under way at its end.
    fn gap(&self, i: usize) -> Gap {
        let (a, b) = (self.progress[i], self.progress[i + 1]);
        let last = self.way.owner(b);
        // What has ended at the first sample is seen.
        let first = self.way.ends.partition_point(|end| *end <= a).min(last);
        let name = |index: usize| self.path.moves()[index].name.clone();
        Gap {
            from: self.recording.times()[i],
            seconds: self.seconds(i),
            ratio: self.seconds(i) / self.usual,
            moves: [first, last],
            names: [name(first), name(last)],
            share: (self.planned(b) - self.planned(a)) / self.whole(),
        }
    }

    /// How far off the path the arm may have been between two samples, m, where that is beyond the limit.
    ///
    /// The larger of both samples' deviations and those of 32 points of the chord, plus what bulges out of it, the
    /// corner, and half a step of these points; a quick bound refuses most intervals first.
    fn beyond(&self, i: usize, limit: f64) -> Option<f64> {
        let poses = self.recording.poses();
        let measured =
            [i, i + 1].map(|k| self.way.deviation(self.nearest[k], &poses[k])).into_iter().fold(0.0, f64::max);
        let aside = self.hidden.between.hidden(i) + self.hidden.corner;
        let half = self.hidden.between.half(i);
        if measured + half + aside <= limit {
            return None;
        }
        let range = self.nearest[i]..self.nearest[i + 1] + 1;
        let chord = self.hidden.between.chord(i, POINTS);
        let off = chord.iter().map(|point| self.way.distance(&range, point)).fold(measured, f64::max);
        let most = off + aside + half / POINTS as f64;
        (most > limit).then_some(most)
    }

    /// In mm, with what the bound rests on.
    fn told(&self, i: usize, most: f64, limit: f64) -> String {
        let gap = self.gap(i);
        let estimated = self
            .hidden
            .estimated
            .map_or(String::new(), |key| format!(", estimated: `{key}` in its file decides, or more samples a second"));
        format!(
            "{gap}: {:.2} mm off the path are not excluded there (a_max h²/8 of the arm's joints{estimated}), the limit is {:.2} mm",
            MILLI * most,
            MILLI * limit
        )
    }

    /// Moves without any sample.
    fn moves_unseen(&self) -> Vec<usize> {
        let mut seen = vec![false; self.path.moves().len()];
        for along in self.progress {
            seen[self.way.owner(*along)] = true;
        }
        seen.iter().enumerate().filter(|(_, seen)| !**seen).map(|(index, _)| index).collect()
    }

    /// What is missing before the first sample and after the last.
    ///
    /// Only where the path is limited: a log may begin within the limit of the plan's begin, or in the first tenth of
    /// its first move.
    fn ends(&self) -> Option<String> {
        let limit = self.hidden.path?;
        let (first, last) = (self.progress[0], self.progress[self.progress.len() - 1]);
        let (ends, times) = (&self.way.ends, self.recording.times());
        let names = |index: usize| self.path.moves()[index].name.as_str();
        if first > limit.max(LEAST_SHARE * ends[0]) {
            let index = self.way.owner(first);
            return Some(format!(
                "the log begins at t = {:.3} s, {:.1} mm along the plan, on move {} of {} ({}): what came before is not seen",
                times[0],
                MILLI * first,
                index + 1,
                ends.len(),
                names(index)
            ));
        }
        let left = ends[ends.len() - 1] - last;
        (left > limit.max(ends[ends.len() - 1] - self.targets[ends.len() - 1])).then(|| {
            let index = self.way.owner(last);
            format!(
                "the log ends at t = {:.3} s, {:.1} mm before the plan's end, on move {} of {} ({}): the rest is not seen",
                times[times.len() - 1],
                MILLI * left,
                index + 1,
                ends.len(),
                names(index)
            )
        })
    }
}
