//! The sum of the distances of all pairs, whose number is the square of that of the vectors: by products in place of
//! differences, and a tile of blocks at a time.

use rayon::prelude::*;

use super::lanes::{LANES, Lanes, Pairs, ROWS, centred};
use crate::math::simd::{Simd, kernel};

/// Blocks that each block before them is compared with while it lies in the nearest cache: all of a campaign's are more
/// than a processor's own caches hold.
const TILE: usize = 8;
/// More than a distance, as a share of the largest, can be wrong by where it comes from products.
const ALIKE: f64 = 1e-6;

/// Vectors around their mean, for sums over all pairs by ‖x − y‖² = ‖x‖² + ‖y‖² − 2 x·y: half the work of differences,
/// and as exact but where two are alike.
///
/// Around the mean, as ‖x‖² and 2 x·y cancel the less the smaller they are. Coordinates that are the same of all, as of
/// ways that begin and end together, add nothing to a distance and are left out.
#[derive(Debug, Clone)]
pub(super) struct Centred {
    lanes: Lanes,
    /// Their squares.
    squares: Vec<f64>,
}

impl Centred {
    /// Of `vectors`, at least one, of as many coordinates each.
    pub(super) fn new(vectors: &[Vec<f64>]) -> Self {
        let differ = |k: &usize| vectors.iter().any(|vector| vector[*k] != vectors[0][*k]);
        let differing: Vec<usize> = (0..vectors[0].len()).filter(differ).collect();
        let short = |vector: &Vec<f64>| differing.iter().map(|k| vector[*k]).collect();
        let (short, size): (Vec<Vec<f64>>, _) = (vectors.iter().map(short).collect(), differing.len());
        let lanes = Lanes::new(&centred(&short, size), size, 1);
        let mut squares = vec![0.0; lanes.blocks() * LANES];
        for (at, square) in squares.iter_mut().enumerate() {
            let block = &lanes.values[at / LANES * size * LANES..][..size * LANES];
            *square = block.iter().skip(at % LANES).step_by(LANES).map(|x| x * x).sum();
        }
        Self { lanes, squares }
    }
}

/// What the vectors of a block come to with those before them, lane by lane.
#[derive(Debug, Clone, Copy)]
struct Found {
    sums: [f64; LANES],
    least: [f64; LANES],
}

impl Found {
    const NOTHING: Self = Self { sums: [0.0; LANES], least: [f64::INFINITY; LANES] };

    #[inline(always)]
    fn take(&mut self, apart: &[f64; LANES], lanes: usize) {
        for ((sum, least), apart) in self.sums.iter_mut().zip(&mut self.least).zip(&apart[..lanes]) {
            *sum += apart;
            *least = if *apart < *least { *apart } else { *least };
        }
    }
}

/// Of `weights[0]` ‖x − y‖ + `weights[1]` ‖u − v‖, x and u of either part: the sum over all pairs; and the vectors that
/// may be nearest to one before them.
///
/// Of each block a sum; they are added up in their order, on any number of threads.
///
/// Each pair once, and none of a vector with itself or with what fills up the last block.
pub(super) fn over_pairs(parts: [&Centred; 2], weights: [f64; 2]) -> (f64, Vec<usize>) {
    let (count, blocks) = (parts[0].lanes.count, parts[0].lanes.blocks());
    let parts = parts.map(|part| (part.lanes.values.as_slice(), part.squares.as_slice()));
    let of_tile = |tile: usize| {
        let from = tile * TILE;
        let mut found = vec![Found::NOTHING; TILE.min(blocks - from)];
        add_pairs(Simd::Widest, parts, weights, (from, count), &mut found);
        found
    };
    let tiles: Vec<Vec<Found>> = (0..blocks.div_ceil(TILE)).into_par_iter().map(of_tile).collect();
    let least = |found: &Found| found.least.into_iter().fold(f64::INFINITY, f64::min);
    let all: Vec<(f64, f64)> =
        tiles.iter().flatten().map(|found| (found.sums.into_iter().sum(), least(found))).collect();
    let nearest = all.iter().map(|(_, least)| *least).fold(f64::INFINITY, f64::min);
    let near = all.iter().enumerate().filter(|(_, (_, least))| *least <= nearest + ALIKE);
    let near = near.flat_map(|(own, _)| own * LANES..((own + 1) * LANES).min(count)).collect();
    (all.iter().map(|(sum, _)| sum).sum(), near)
}

kernel! {
    fn add_pairs(
        parts: [(&[f64], &[f64]); 2],
        weights: [f64; 2],
        place: (usize, usize),
        tile: &mut [Found],
    ) {
        let (from, count) = place;
        for first in [0, ROWS] {
            for block in 0..from + tile.len() {
                for (own, kept) in (from..).zip(&mut *tile).skip(block.saturating_sub(from)) {
                    let apart = apart(&parts, &weights, (own, first), block);
                    let mut found = *kept;
                    if block < own && (own + 1) * LANES <= count {
                        apart.iter().for_each(|apart| found.take(apart, LANES));
                    } else {
                        // Each pair once, and none of what fills the last block up.
                        for (row, apart) in (own * LANES + first..count).zip(&apart) {
                            found.take(apart, (row - block * LANES).min(LANES));
                        }
                    }
                    *kept = found;
                }
            }
        }
    }
}

/// How far the vectors `first` … `first` + 3 of block `own` are from those of `block`.
#[inline(always)]
fn apart(parts: &[(&[f64], &[f64]); 2], weights: &[f64; 2], (own, first): (usize, usize), block: usize) -> Pairs {
    let mut apart = [[0.0; LANES]; ROWS];
    for part in 0..2 {
        let (values, squares) = parts[part];
        let size = values.len() / squares.len() * LANES;
        let dots = dots(&values[own * size..][..size], first, &values[block * size..][..size]);
        let (of_own, of_other) = (&squares[own * LANES..][..LANES], &squares[block * LANES..][..LANES]);
        for r in 0..ROWS {
            for l in 0..LANES {
                let square = of_own[first + r] + of_other[l] - 2.0 * dots[r][l];
                apart[r][l] += weights[part] * if square > 0.0 { square } else { 0.0 }.sqrt();
            }
        }
    }
    apart
}

/// x·y of four vectors of one block with the eight of another.
#[inline(always)]
fn dots(own: &[f64], first: usize, other: &[f64]) -> Pairs {
    let mut total = [[0.0; LANES]; ROWS];
    for (own, other) in own.as_chunks::<LANES>().0.iter().zip(other.as_chunks::<LANES>().0) {
        for r in 0..ROWS {
            for l in 0..LANES {
                total[r][l] += own[first + r] * other[l];
            }
        }
    }
    total
}
