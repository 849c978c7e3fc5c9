//! Which part of a path a sample belongs to, where nobody told: monotone assignment, never the nearest part, since
//! paths cross and revisit.
//!
//! A dynamic program over samples × pieces, as in dynamic time warping (Sakoe and Chiba, IEEE ASSP 26(1), 1978) with
//! pieces that may be skipped. The nearest leg would be wrong wherever a path crosses itself, and a stressful one does.

mod lanes;
mod piece;
#[cfg(feature = "unit-tests")]
mod tests;

use std::ops::Range;

use nalgebra::Point3;

use super::narrow::narrowed;
use crate::math::power::square;
use crate::math::segment::point_distance;
use crate::math::simd::Simd;
use lanes::Lanes;
pub(super) use piece::{Piece, leg_pieces};

/// The rising sequence of pieces j(0) ≤ j(1) ≤ … that minimises Σ weight_i · distance(sample_i, piece_j(i))²; among
/// equals the one that stays behind longest. Pieces may be skipped. In O(samples + pieces) time and linear memory
/// (Hirschberg 1975: the middle sample's piece splits the problem in two): exact where samples are near their pieces
/// ([`narrowed`]) or there are few of both; else the best in a band around the assignment of every so-many-th sample,
/// which widens until the best touches it nowhere.
pub(super) fn monotone(samples: &[Point3<f64>], weights: &[f64], pieces: &[Piece]) -> Vec<usize> {
    let mut assigned = vec![0; samples.len()];
    if !pieces.is_empty() {
        let problem = Problem { samples, weights, pieces, lanes: &Lanes::of(pieces) };
        let whole = std::iter::repeat_n(0..pieces.len(), samples.len());
        let windows = narrowed(whole, |sample, piece| problem.cost(sample, piece));
        match windows.iter().map(Range::len).sum::<usize>() {
            much if much > MUCH => problem.around(&windows, &mut assigned),
            _ => problem.split(0, &windows, 0..pieces.len(), &mut assigned),
        }
    }
    assigned
}

/// Pairs of a sample and a piece that are looked at all.
const MUCH: usize = 200_000;
/// Samples that are assigned first where there are more pairs.
const FIRST: usize = 128;
/// Pieces on either side of a band at first, and how many times wider the next one is.
const BAND: usize = 8;
const WIDER: usize = 4;

struct Problem<'a> {
    samples: &'a [Point3<f64>],
    weights: &'a [f64],
    pieces: &'a [Piece],
    /// The same pieces, to be compared with a sample side by side.
    lanes: &'a Lanes,
}

/// Least costs of assigning some samples in order, by how far they may go: those of the pieces from `first` on. Beyond
/// them they stay as they are, before them nothing is possible.
struct Costs {
    first: usize,
    of: Vec<f64>,
}

impl Problem<'_> {
    /// weight · distance².
    fn cost(&self, sample: usize, piece: usize) -> f64 {
        let Piece { from, to, .. } = &self.pieces[piece];
        self.weights[sample] * square(point_distance(&self.samples[sample], from, to))
    }

    /// The best in a band around the assignment of every so-many-th sample, within `windows`.
    fn around(&self, windows: &[Range<usize>], out: &mut [usize]) {
        let stride = self.samples.len().div_ceil(FIRST);
        let samples: Vec<_> = self.samples.iter().copied().step_by(stride).collect();
        let weights: Vec<f64> = self.weights.chunks(stride).map(|block| block.iter().sum()).collect();
        let first = Problem { samples: &samples, weights: &weights, ..*self };
        let few: Vec<_> = windows.iter().cloned().step_by(stride).collect();
        let mut near = vec![0; samples.len()];
        first.split(0, &few, 0..self.pieces.len(), &mut near);
        let mut side = BAND;
        loop {
            let band = |(sample, window): (usize, &Range<usize>)| {
                let (before, after) = (near[sample / stride], near[(sample / stride + 1).min(near.len() - 1)]);
                let start = before.saturating_sub(side).clamp(window.start, window.end - 1);
                start..(after + side + 1).clamp(start + 1, window.end)
            };
            let banded: Vec<Range<usize>> = windows.iter().enumerate().map(band).collect();
            self.split(0, &banded, 0..self.pieces.len(), out);
            let touches = |(piece, (band, window)): (&usize, (&Range<usize>, &Range<usize>))| {
                (*piece == band.start && band.start > window.start) || (piece + 1 == band.end && band.end < window.end)
            };
            if !out.iter().zip(banded.iter().zip(windows)).any(touches) {
                return;
            }
            side *= WIDER;
        }
    }

    /// Halves the samples (Hirschberg, CACM 18, 1975): least sums of weighted squared distances of the first half
    /// ending by each piece and of the second half from it on meet at the piece where the middle belongs. `windows`
    /// are those of the samples from `first` on, which get pieces of `range`.
    fn split(&self, first: usize, windows: &[Range<usize>], range: Range<usize>, out: &mut [usize]) {
        if range.len() == 1 || windows.is_empty() {
            out.fill(range.start);
            return;
        }
        if let [window] = windows {
            let within = within(window, &range);
            let distance =
                |piece: usize| point_distance(&self.samples[first], &self.pieces[piece].from, &self.pieces[piece].to);
            out[0] = within.start + first_least(within.map(distance));
            return;
        }
        let half = windows.len() / 2;
        let middle = first + half;
        let before = self.least(windows[..half].iter().enumerate().map(|(i, w)| (first + i, within(w, &range))));
        // Seen from the end: pieces are counted backwards, and so are samples.
        let mirrored = |w: &Range<usize>| {
            let w = within(w, &range);
            range.end - w.end..range.end - w.start
        };
        let rest = windows[half..].iter().enumerate().rev();
        let after = self.mirrored_least(range.end, rest.map(|(i, w)| (middle + i, mirrored(w))));
        let last = range.end - after.first;
        let from_end = |piece: usize| after.at(range.end - 1 - piece);
        let meeting = before.first + first_least((before.first..last).map(|piece| before.at(piece) + from_end(piece)));
        let (front, back) = out.split_at_mut(half);
        self.split(first, &windows[..half], range.start..meeting + 1, front);
        self.split(middle, &windows[half..], meeting..range.end, back);
    }

    /// Of samples in order, each within its window.
    fn least(&self, samples: impl Iterator<Item = (usize, Range<usize>)>) -> Costs {
        by_rows(samples, |sample, window, row| self.costs(sample, window, row))
    }

    /// Of samples from the last one back, pieces counted from `end` backwards.
    fn mirrored_least(&self, end: usize, samples: impl Iterator<Item = (usize, Range<usize>)>) -> Costs {
        by_rows(samples, |sample, window, row| {
            self.costs(sample, end - window.end..end - window.start, row);
            row.reverse();
        })
    }

    /// [`Self::cost`] of the pieces of `window`, to the same bits.
    fn costs(&self, sample: usize, window: Range<usize>, row: &mut [f64]) {
        self.lanes.squares(Simd::Widest, &self.samples[sample], window, row);
        row.iter_mut().for_each(|square| *square *= self.weights[sample]);
    }
}

/// Least costs of assigning all samples in order to pieces no later than each, sample by sample; `costs_of` fills in
/// those of a sample with the pieces of its window.
fn by_rows(
    samples: impl Iterator<Item = (usize, Range<usize>)>,
    costs_of: impl Fn(usize, Range<usize>, &mut [f64]),
) -> Costs {
    let mut costs = Costs { first: 0, of: vec![0.0] };
    let mut row = Vec::new();
    for (sample, window) in samples {
        row.clear();
        row.resize(window.len(), 0.0);
        costs_of(sample, window.clone(), &mut row);
        costs.add_to(&mut row, window.start);
        let mut least = f64::INFINITY;
        for cost in &mut row {
            least = if *cost < least { *cost } else { least };
            *cost = least;
        }
        costs.first = window.start;
        std::mem::swap(&mut costs.of, &mut row);
    }
    costs
}

impl Costs {
    /// Of ending by a piece that is not before the first.
    fn at(&self, piece: usize) -> f64 {
        self.of[(piece - self.first).min(self.of.len() - 1)]
    }

    /// Adds [`Self::at`] to a row of the pieces from `first` on.
    fn add_to(&self, row: &mut [f64], first: usize) {
        let last = self.of.len() - 1;
        let own = &self.of[(first - self.first).min(last)..];
        let (among, beyond) = row.split_at_mut(own.len().min(row.len()));
        among.iter_mut().zip(own).for_each(|(cost, before)| *cost += before);
        beyond.iter_mut().for_each(|cost| *cost += self.of[last]);
    }
}

/// What of a window lies in `range`.
fn within(window: &Range<usize>, range: &Range<usize>) -> Range<usize> {
    let start = window.start.max(range.start).min(range.end - 1);
    start..window.end.min(range.end).max(start + 1)
}

fn first_least(values: impl Iterator<Item = f64>) -> usize {
    let mut best = (0, f64::INFINITY);
    for (index, value) in values.enumerate() {
        if value < best.1 {
            best = (index, value);
        }
    }
    best.0
}
