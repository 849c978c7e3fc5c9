//! Vectors side by side in lanes, so that many of them can be compared: what is asked of two is answered to the same
//! bits. Sums over all pairs are added up another way (`pairs`).
//!
//! Eight vectors make a block: coordinate k of all eight lies side by side, so that one instruction serves eight
//! pairs. Four vectors of a block are compared with each other block at once, which keeps 32 sums in registers.
//! [`Outlines`] and their bound save most of the pairs where only the largest distance is asked for, which
//! lies among the vectors that lie farthest out.

use rayon::prelude::*;

use crate::math::simd::{Simd, kernel};

/// Vectors in a block.
pub(super) const LANES: usize = 8;
/// Those of a block that are compared with others at once.
pub(super) const ROWS: usize = 4;
/// More than rounding takes from a bound of a squared distance, as a share.
const ROUNDING: f64 = 1e-9;

/// A number for each pair of four vectors with the eight of a block.
pub(super) type Pairs = [[f64; LANES]; ROWS];

/// Vectors of equal size, block by block, coordinate by coordinate; the last block is filled up with the first vector.
///
/// `values[(block · size + k) · 8 + lane]` is coordinate k of vector 8 · block + lane.
#[derive(Debug, Clone)]
pub(super) struct Lanes {
    pub(super) count: usize,
    size: usize,
    /// Coordinates whose squares are added up before they are added to the others': 3 of places, 1 of numbers.
    group: usize,
    pub(super) values: Vec<f64>,
}

impl Lanes {
    /// `vectors` of `size` coordinates in groups of 3 or 1.
    pub(super) fn new(vectors: &[Vec<f64>], size: usize, group: usize) -> Self {
        let blocks = vectors.len().div_ceil(LANES);
        let mut values = vec![0.0; blocks * size * LANES];
        for at in 0..blocks * LANES {
            let vector = vectors.get(at).unwrap_or(&vectors[0]);
            for (k, value) in vector.iter().enumerate().take(size) {
                values[(at / LANES * size + k) * LANES + at % LANES] = *value;
            }
        }
        Self { count: vectors.len(), size, group, values }
    }

    pub(super) fn blocks(&self) -> usize {
        self.count.div_ceil(LANES)
    }

    /// ‖x − y‖² of vectors `first` … `first` + 3 of block `own` with all of the first `out.len()` blocks.
    fn squares(&self, own: usize, first: usize, out: &mut [Pairs]) {
        if self.size == 0 {
            return;
        }
        squares_with(Simd::Widest, &self.values, self.size * LANES, self.group, own * LANES + first, out);
    }

    /// ‖x − y‖² of vector `one` and each.
    pub(super) fn squares_from(&self, one: usize) -> Vec<f64> {
        let mut pairs = vec![[[0.0; LANES]; ROWS]; self.blocks()];
        self.squares(one / LANES, one % LANES / ROWS * ROWS, &mut pairs);
        pairs.iter().flat_map(|pairs| pairs[one % ROWS]).take(self.count).collect()
    }

    /// The largest ‖x − y‖² + (`left` of x + `left` of y)² of the vectors of a block with those of it and of all
    /// before.
    ///
    /// With all of `left` 0 it is a largest distance, with what outlines leave out a bound of it: (ρ + ρ′)² is added
    /// since the left-out parts may point away from each other.
    fn most_of(&self, own: usize, left: &[f64]) -> f64 {
        let mut pairs = vec![[[0.0; LANES]; ROWS]; own + 1];
        let mut most = [0.0; LANES];
        for first in [0, ROWS] {
            self.squares(own, first, &mut pairs);
            for (pairs, left_of) in pairs.iter().zip(left.chunks_exact(LANES)) {
                for (r, row) in pairs.iter().enumerate() {
                    let left = left[own * LANES + first + r];
                    for ((most, square), other) in most.iter_mut().zip(row).zip(left_of) {
                        let square = square + (left + other) * (left + other);
                        *most = if square > *most { square } else { *most };
                    }
                }
            }
        }
        most.into_iter().fold(0.0, f64::max)
    }
}

/// The largest ‖x − y‖² of all pairs of `vectors`, which must not be empty, added up in groups of `group` coordinates.
///
/// Those that lie farthest out, r = ‖x − mean‖, stand first, and by the triangle inequality ‖x − y‖ ≤ r + r′: from
/// where on this is below a distance that was found, none is looked at. Of the others blocks are looked at in the order
/// of what outlines along the orthonormal `directions` say of them, until they say that none is left.
///
/// Exact, not a bound: only blocks whose bound, less a share of 10⁻⁹ for rounding, is below a distance that was
/// found are left out. O(n²) bounds of few numbers, and whole vectors, in the worst case.
pub(super) fn largest_square(vectors: &[Vec<f64>], group: usize, directions: &[Vec<f64>]) -> f64 {
    let size = vectors[0].len();
    let around = centred(vectors, size);
    let mut outermost: Vec<(f64, usize)> = around.iter().map(|v| norm(v)).zip(0..).collect();
    outermost.sort_unstable_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    let in_order = |all: &[Vec<f64>]| outermost.iter().map(|(_, at)| all[*at].clone()).collect::<Vec<_>>();
    let lanes = Lanes::new(&in_order(vectors), size, group);
    let mut most = lanes.squares_from(0).into_iter().fold(0.0, f64::max);
    let farthest = |r: f64| (outermost[0].0 + r) * (outermost[0].0 + r) * (1.0 + ROUNDING);
    let count = outermost.partition_point(|(r, _)| farthest(*r) >= most);
    let outlines = Outlines::new(&in_order(&around)[..count], directions);
    let blocks: Vec<usize> = (0..outlines.vectors.blocks()).collect();
    let bound = |own: &usize| (outlines.vectors.most_of(*own, &outlines.left), *own);
    let mut order: Vec<(f64, usize)> = blocks.par_iter().map(bound).collect();
    order.sort_unstable_by(|a, b| b.0.total_cmp(&a.0));
    let nothing = vec![0.0; lanes.blocks() * LANES];
    for few in order.chunks(LANES) {
        if few[0].0 * (1.0 + ROUNDING) < most {
            break;
        }
        most = few.par_iter().map(|(_, own)| lanes.most_of(*own, &nothing)).reduce(|| most, f64::max);
    }
    most
}

fn norm(vector: &[f64]) -> f64 {
    vector.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// Shorter vectors, each with the length ρ of what they leave out: those that they stand for are never farther apart
/// than √(‖x − y‖² + (ρ + ρ')²).
///
/// By Pythagoras ‖x − y‖² = ‖short(x) − short(y)‖² + ‖rest(x) − rest(y)‖², and the last norm is at most ρ + ρ′.
#[derive(Debug, Clone)]
struct Outlines {
    vectors: Lanes,
    left: Vec<f64>,
}

impl Outlines {
    /// The components of `vectors` along the orthonormal `directions`.
    ///
    /// ρ² = ‖v‖² − ‖short(v)‖², taken a little larger so that rounding never makes the bound too small; `vectors`
    /// must not be empty.
    fn new(vectors: &[Vec<f64>], directions: &[Vec<f64>]) -> Self {
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
        let short: Vec<Vec<f64>> = vectors.iter().map(|v| directions.iter().map(|d| dot(v, d)).collect()).collect();
        let left = vectors.iter().zip(&short).map(|(v, short)| {
            // What rounding takes from a difference of squares is a share of the whole.
            (dot(v, v) * (1.0 + ROUNDING * ROUNDING.sqrt()) - dot(short, short)).max(0.0).sqrt()
        });
        let mut left: Vec<f64> = left.collect();
        let vectors = Lanes::new(&short, directions.len(), 1);
        left.resize(vectors.blocks() * LANES, left[0]);
        Self { vectors, left }
    }
}

kernel! {
    fn squares_with(values: &[f64], block: usize, group: usize, row: usize, out: &mut [Pairs]) {
        let (own, first) = (&values[row / LANES * block..][..block], row % LANES);
        for (out, other) in out.iter_mut().zip(values.chunks_exact(block)) {
            *out = if group == 3 { squares::<3>(own, first, other) } else { squares::<1>(own, first, other) };
        }
    }
}

/// Sums have one order, that of [`Scale::apart`](super::Scale::apart): groups of three coordinates first, then one
/// group after another, at every SIMD level.
#[inline(always)]
fn squares<const GROUP: usize>(own: &[f64], first: usize, other: &[f64]) -> Pairs {
    let mut total = [[0.0; LANES]; ROWS];
    for (own, other) in own.chunks_exact(GROUP * LANES).zip(other.chunks_exact(GROUP * LANES)) {
        for r in 0..ROWS {
            for l in 0..LANES {
                let difference = own[first + r] - other[l];
                let mut square = difference * difference;
                for k in 1..GROUP {
                    let difference = own[k * LANES + first + r] - other[k * LANES + l];
                    square += difference * difference;
                }
                total[r][l] += square;
            }
        }
    }
    total
}

/// `vectors` less their mean.
pub(super) fn centred(vectors: &[Vec<f64>], size: usize) -> Vec<Vec<f64>> {
    let mean: Vec<f64> =
        (0..size).map(|k| vectors.iter().map(|vector| vector[k]).sum::<f64>() / vectors.len() as f64).collect();
    vectors.iter().map(|vector| vector.iter().zip(&mean).map(|(x, mean)| x - mean).collect()).collect()
}
