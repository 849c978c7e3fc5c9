//! Where along its planned path a recorded motion is: monotone alignment in position and orientation.
//!
//! d² = |Δp|² + (weight θ)², θ by the quaternions' chord: a move that only turns has a length, too. The whole alignment
//! is one dynamic program of samples × poses; beyond a million cells every k-th sample is aligned first and the others
//! between their neighbours.
//!
//! Data flow: [`Way::new`] lays the plan by length → `nearest` assigns samples to poses in their order → `progress`
//! projects them between poses → distances of samples and points from the path about their pose.

use std::ops::Range;

use nalgebra::{Isometry3, Point3};

use crate::judgement::narrow::narrowed;
use crate::math::cubic::{Cubic, nearest_along};
use crate::math::power::square;
use crate::trajectory::{PlannedPath, Track};

/// The planned path by distance: poses that differ, how far along each lies, and where moves end.
///
/// `poses` and `along` are of one length, without poses nearer than 10⁻⁹ m to the one before; `planned` has one entry
/// a stamp of the plan.
pub(super) struct Way {
    poses: Vec<Isometry3<f64>>,
    /// How places go from each pose to the next where that is not straight, one less than poses.
    ways: Vec<Option<Cubic>>,
    /// Length up to each, m: of position and weighted turn together.
    along: Vec<f64>,
    /// Length at the end of each move.
    pub(super) ends: Vec<f64>,
    /// Index of the pose at the end of each move.
    pub(super) end_poses: Vec<usize>,
    /// Length at every stamp of the plan.
    pub(super) planned: Vec<f64>,
    /// 1 rad counts as so many metres.
    weight: f64,
}

/// Poses before and after those that are meant of which segments are looked at.
const BESIDE: usize = 2;
/// Cells of the alignment at most; above it only every few samples are aligned over the whole path, the others between
/// them.
const MOST_CELLS: usize = 1 << 20;

impl Way {
    /// `weight` in m/rad.
    pub(super) fn new(path: &PlannedPath, weight: f64) -> Self {
        let (mut poses, mut along): (Vec<Isometry3<f64>>, Vec<f64>) = (Vec::new(), Vec::new());
        let (mut kept, mut ways) = (Vec::with_capacity(path.track().len()), Vec::new());
        for (i, pose) in path.track().poses().iter().enumerate() {
            match (poses.last(), along.last()) {
                (Some(last), Some(length)) => {
                    let step = square_distance(last, pose, weight).sqrt();
                    if step > 1e-9 {
                        along.push(length + step);
                        poses.push(*pose);
                        ways.push(path.track().way(i - 1).copied());
                    }
                }
                _ => {
                    along.push(0.0);
                    poses.push(*pose);
                }
            }
            kept.push(poses.len() - 1);
        }
        let end_poses: Vec<usize> = path.moves().iter().map(|m| kept[m.end]).collect();
        let ends = end_poses.iter().map(|end| along[*end]).collect();
        let planned = kept.iter().map(|index| along[*index]).collect();
        Self { poses, ways, along, ends, end_poses, planned, weight }
    }

    /// Pose `i`.
    pub(super) fn pose(&self, i: usize) -> &Isometry3<f64> {
        &self.poses[i]
    }

    /// Where pose `i` is.
    pub(super) fn place(&self, i: usize) -> Point3<f64> {
        self.poses[i].translation.vector.into()
    }

    /// The move that a length along the path belongs to.
    ///
    /// The first move that ends at or behind it; the last beyond all.
    pub(super) fn owner(&self, along: f64) -> usize {
        self.ends.partition_point(|end| *end < along).min(self.ends.len() - 1)
    }

    /// The nearest pose of the path to each sample, in order: the rising sequence j(0) ≤ j(1) ≤ … that minimises
    /// Σ d(sample_i, pose_j(i))², among equals the one that stays behind longest. Poses may be skipped. Where the
    /// recording tells its move, poses of that one and its neighbours alone are looked at.
    fn nearest(&self, recording: &Track) -> Vec<usize> {
        let samples = recording.len();
        let windows = self.windows(recording);
        let cells: usize = windows.iter().map(Range::len).sum();
        let stride = cells.div_ceil(MOST_CELLS);
        let all: Vec<usize> = (0..samples).collect();
        if stride <= 1 {
            return self.rising(recording, &all, &windows);
        }
        let mut coarse: Vec<usize> = (0..samples).step_by(stride).collect();
        if coarse.last() != Some(&(samples - 1)) {
            coarse.push(samples - 1);
        }
        let of_coarse: Vec<Range<usize>> = coarse.iter().map(|i| windows[*i].clone()).collect();
        let found = self.rising(recording, &coarse, &of_coarse);
        let mut between = Vec::with_capacity(samples);
        for (pair, place) in coarse.windows(2).zip(found.windows(2)) {
            between.extend((pair[0]..pair[1]).map(|_| place[0]..place[1] + 1));
        }
        let last = found[found.len() - 1];
        between.push(last..last + 1);
        self.rising(recording, &all, &between)
    }

    /// From the end of the move before the one before, to the end of the next: a recorder's word for its move may be
    /// one off. Without the channel `move` the whole path.
    fn windows(&self, recording: &Track) -> Vec<Range<usize>> {
        let whole = 0..self.poses.len();
        let Some(moves) = recording.channel("move") else { return vec![whole; recording.len()] };
        let last = self.end_poses.len() - 1;
        let mut furthest = 0;
        let windows = moves.iter().map(|value| {
            // A move that is told again is not gone back to.
            furthest = furthest.max(value.clamp(0.0, last as f64) as usize);
            let first = if furthest < 2 { 0 } else { self.end_poses[furthest - 2] };
            first..self.end_poses[(furthest + 1).min(last)] + 1
        });
        windows.collect()
    }

    /// Each sample takes a pose of its window, not before its predecessor's, so that the sum of squared distances is
    /// least; the earliest of equals. Dynamic programming, O(total length of what is left of the windows where no best
    /// sequence is left out).
    fn rising(&self, recording: &Track, samples: &[usize], windows: &[Range<usize>]) -> Vec<usize> {
        let cost =
            |row: usize, j: usize| square_distance(&self.poses[j], &recording.poses()[samples[row]], self.weight);
        self.rising_in(recording, samples, &narrowed(windows.iter().cloned(), cost))
    }

    /// The dynamic program over rows of windows; what is kept of a row are bits and the last row's costs.
    fn rising_in(&self, recording: &Track, samples: &[usize], windows: &[Range<usize>]) -> Vec<usize> {
        // own[row][j − first]: the best up to j ends at j itself.
        let mut own: Vec<Vec<bool>> = Vec::with_capacity(samples.len());
        let mut before: Vec<f64> = Vec::new();
        let mut earlier = 0..0;
        for (sample, window) in samples.iter().zip(windows) {
            let pose = &recording.poses()[*sample];
            let (mut least, mut costs) = (f64::INFINITY, Vec::with_capacity(window.len()));
            let mut row = Vec::with_capacity(window.len());
            for j in window.clone() {
                let base = match before.last() {
                    None => 0.0,
                    Some(last) if j >= earlier.end => *last,
                    Some(_) => before[j - earlier.start],
                };
                let cost = base + square_distance(&self.poses[j], pose, self.weight);
                row.push(cost < least);
                least = least.min(cost);
                costs.push(least);
            }
            own.push(row);
            before = costs;
            earlier = window.clone();
        }
        let mut found = vec![0; samples.len()];
        let mut at = usize::MAX;
        for row in (0..samples.len()).rev() {
            let window = &windows[row];
            at = at.min(window.end - 1);
            while at > window.start && !own[row][at - window.start] {
                at -= 1;
            }
            found[row] = at;
        }
        found
    }

    /// How far along the path each sample has come at least, m.
    ///
    /// Never falls: what was passed stays passed. With it the pose that each sample belongs to.
    pub(super) fn progress(&self, recording: &Track) -> (Vec<f64>, Vec<usize>) {
        let nearest = self.nearest(recording);
        let mut furthest = 0.0f64;
        let progress = nearest.iter().zip(recording.poses()).map(|(j, pose)| {
            furthest = furthest.max(self.project(*j, pose));
            furthest
        });
        (progress.collect(), nearest)
    }

    /// Length along the path at the foot of `pose` on the two segments beside pose `j`, by the law of cosines.
    fn project(&self, j: usize, pose: &Isometry3<f64>) -> f64 {
        let (mut best, mut along) = (f64::INFINITY, self.along[j]);
        for first in [j.checked_sub(1), (j + 1 < self.poses.len()).then_some(j)].into_iter().flatten() {
            let length = self.along[first + 1] - self.along[first];
            let a = square_distance(&self.poses[first], pose, self.weight);
            let b = square_distance(&self.poses[first + 1], pose, self.weight);
            let foot = (0.5 * (a - b + square(length)) / length).clamp(0.0, length);
            let aside = a + foot * (foot - (a - b + square(length)) / length);
            if aside < best {
                (best, along) = (aside, self.along[first] + foot);
            }
        }
        along
    }

    /// Distance of a point from the path about the poses of `range`, m.
    ///
    /// Two poses more on either side, so that a segment at the range's border counts.
    pub(super) fn distance(&self, range: &Range<usize>, point: &Point3<f64>) -> f64 {
        let (first, last) = (range.start.saturating_sub(BESIDE), (range.end + BESIDE).min(self.poses.len() - 1));
        self.distance_from(first..last, point, range.start)
    }

    /// Distance of `pose`'s position from the path about pose `j`, m.
    pub(super) fn deviation(&self, j: usize, pose: &Isometry3<f64>) -> f64 {
        let (first, last) = (j.saturating_sub(BESIDE), (j + BESIDE).min(self.poses.len() - 1));
        self.distance_from(first..last, &pose.translation.vector.into(), j)
    }

    /// Distance of `point` from pose `j` and from the ways that begin at the poses of `range`, curved ones as they are,
    /// m.
    fn distance_from(&self, range: Range<usize>, point: &Point3<f64>, j: usize) -> f64 {
        let nearest = |i: usize| nearest_along(self.ways[i].as_ref(), point, &self.place(i), &self.place(i + 1));
        range.map(|i| (point - nearest(i)).norm()).fold((point - self.place(j)).norm(), f64::min)
    }
}

/// |Δp|² + (weight·θ)², with θ² by the chord of the quaternions, 4·|q − r|² = 8(1 − |q·r|).
fn square_distance(a: &Isometry3<f64>, b: &Isometry3<f64>, weight: f64) -> f64 {
    let shift = (a.translation.vector - b.translation.vector).norm_squared();
    let turn = 8.0 * (1.0 - a.rotation.coords.dot(&b.rotation.coords).abs()).max(0.0);
    shift + square(weight) * turn
}
