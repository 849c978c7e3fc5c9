//! Which part of a path a sample belongs to, where nobody told: monotone assignment, never the nearest part, since
//! paths cross and revisit.
//!
//! A dynamic program over samples × pieces, as in dynamic time warping (Sakoe and Chiba, IEEE ASSP 26(1), 1978) with
//! pieces that may be skipped. The nearest leg would be wrong wherever a path crosses itself, and a stressful one does.

use nalgebra::Point3;

use crate::math::power::square;
use crate::math::segment::point_distance;

/// A straight part of a path, and what it belongs to.
#[derive(Debug, Clone, Copy)]
pub(super) struct Piece {
    /// First end.
    pub(super) from: Point3<f64>,
    /// Other end.
    pub(super) to: Point3<f64>,
    /// The leg, or the first segment of the path, that it stands for.
    pub(super) owner: usize,
}

/// Parts that legs are cut into in all, at least: progress along a leg must be monotone too, or a path that goes back
/// and forth could not be told from one that stays.
const PIECES: f64 = 256.0;

/// The legs between `waypoints`, cut into parts of about equal length.
pub(super) fn leg_pieces(waypoints: &[Point3<f64>]) -> Vec<Piece> {
    let total: f64 = waypoints.windows(2).map(|leg| (leg[1] - leg[0]).norm()).sum();
    let mut pieces = Vec::new();
    for (owner, leg) in waypoints.windows(2).enumerate() {
        let share = if total > 0.0 { (leg[1] - leg[0]).norm() / total } else { 0.0 };
        let parts = (PIECES * share).ceil().max(1.0);
        let at = |k: usize| leg[0] + (leg[1] - leg[0]) * (k as f64 / parts);
        pieces.extend((0..parts as usize).map(|k| Piece { from: at(k), to: at(k + 1), owner }));
    }
    pieces
}

/// The rising sequence of pieces j(0) ≤ j(1) ≤ … that minimises Σ weight_i · distance(sample_i, piece_j(i))²; among
/// equals the one that stays behind longest. Pieces may be skipped. Exact, in O(samples · pieces) time and linear
/// memory (Hirschberg 1975: the middle sample's piece splits the problem in two).
pub(super) fn monotone(samples: &[Point3<f64>], weights: &[f64], pieces: &[Piece]) -> Vec<usize> {
    let mut assigned = vec![0; samples.len()];
    if !pieces.is_empty() {
        split(samples, weights, pieces, 0, &mut assigned);
    }
    assigned
}

/// Halves the samples (Hirschberg, CACM 18, 1975): least sums of weighted squared distances of the first half ending by
/// each piece and of the second half from it on meet at the piece where the middle belongs. O(samples · pieces) time,
/// O(pieces) memory.
fn split(samples: &[Point3<f64>], weights: &[f64], pieces: &[Piece], offset: usize, out: &mut [usize]) {
    if pieces.len() == 1 || samples.is_empty() {
        out.fill(offset);
        return;
    }
    if samples.len() == 1 {
        let distances = pieces.iter().map(|piece| point_distance(&samples[0], &piece.from, &piece.to));
        out[0] = offset + first_least(distances);
        return;
    }
    let middle = samples.len() / 2;
    // before[j]: least cost of the first half ending at piece j or before; after[j]: of the rest from j on.
    let before = prefix_costs(samples[..middle].iter().zip(weights), pieces.iter());
    let after = prefix_costs(samples[middle..].iter().zip(&weights[middle..]).rev(), pieces.iter().rev());
    let meeting = first_least(before.iter().zip(after.iter().rev()).map(|(b, a)| b + a));
    let (first, rest) = out.split_at_mut(middle);
    split(&samples[..middle], &weights[..middle], &pieces[..=meeting], offset, first);
    split(&samples[middle..], &weights[middle..], &pieces[meeting..], offset + meeting, rest);
}

/// Least cost of assigning all samples in order to pieces no later than each.
fn prefix_costs<'a>(
    samples: impl Iterator<Item = (&'a Point3<f64>, &'a f64)>,
    pieces: impl ExactSizeIterator<Item = &'a Piece> + Clone,
) -> Vec<f64> {
    let mut costs = vec![0.0f64; pieces.len()];
    for (sample, weight) in samples {
        let mut least = f64::INFINITY;
        for (cost, piece) in costs.iter_mut().zip(pieces.clone()) {
            let own = *cost + weight * square(point_distance(sample, &piece.from, &piece.to));
            least = least.min(own);
            *cost = least;
        }
    }
    costs
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

#[cfg(test)]
mod tests {
    use rand::RngExt;

    use super::*;
    use crate::math::random::stream;

    /// Every rising sequence, tried.
    fn by_enumeration(samples: &[Point3<f64>], weights: &[f64], pieces: &[Piece]) -> f64 {
        fn rest(samples: &[Point3<f64>], weights: &[f64], pieces: &[Piece]) -> f64 {
            let Some(sample) = samples.first() else { return 0.0 };
            (0..pieces.len())
                .map(|j| {
                    let own = weights[0] * point_distance(sample, &pieces[j].from, &pieces[j].to).powi(2);
                    own + rest(&samples[1..], &weights[1..], &pieces[j..])
                })
                .fold(f64::INFINITY, f64::min)
        }
        rest(samples, weights, pieces)
    }

    #[test]
    fn is_the_best_of_all_rising_sequences() {
        for seed in 0..200 {
            let mut random = stream(seed);
            let mut draw = || Point3::from([(); 3].map(|_| random.random_range(-3.0..3.0)));
            let corners: Vec<Point3<f64>> = (0..5).map(|_| draw()).collect();
            let samples: Vec<Point3<f64>> = (0..7).map(|_| draw()).collect();
            let weights: Vec<f64> = (0..7).map(|i| 1.0 + 0.1 * i as f64).collect();
            let pieces: Vec<Piece> = corners
                .windows(2)
                .enumerate()
                .map(|(owner, ends)| Piece { from: ends[0], to: ends[1], owner })
                .collect();
            let found = monotone(&samples, &weights, &pieces);
            assert!(found.is_sorted(), "seed {seed}: {found:?}");
            let cost: f64 = (0..7)
                .map(|i| weights[i] * point_distance(&samples[i], &pieces[found[i]].from, &pieces[found[i]].to).powi(2))
                .sum();
            let best = by_enumeration(&samples, &weights, &pieces);
            assert!((cost - best).abs() <= 1e-9 * (1.0 + best), "seed {seed}: {cost} {best}");
        }
    }
}
