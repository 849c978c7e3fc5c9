//! Bounds on κ and κ′ as a penalty: half the squares of what samples of the curve exceed them by.

use super::super::ends::{Bends, Ends, KEPT};
use super::super::extremes::{largest, within};
use super::heading::{BASIS, Free, SHAPES, basis};
use super::newton::Objective;
use crate::feasibility::steering::shooting::query::Curvatures;
use crate::math::simd::{Simd, kernel};

/// Samples of κ and κ′, ends included, in lanes.
const LANES: usize = 8;
const GROUPS: usize = 3;
const LAST: usize = LANES * GROUPS - 1;
type Table = [[f64; LANES]; GROUPS];

/// First and second derivatives of the basis at the samples.
const SLOPES: [Table; BASIS] = at_samples(1);
const BENDS: [Table; BASIS] = at_samples(2);

const fn at_samples(order: usize) -> [Table; BASIS] {
    let mut out = [[[0.0; LANES]; GROUPS]; BASIS];
    let mut i = 0;
    while i <= LAST {
        let values = basis(i as f64 / LAST as f64, order);
        let mut b = 0;
        while b < BASIS {
            out[b][i / LANES][i % LANES] = values[b];
            b += 1;
        }
        i += 1;
    }
    out
}

/// Adds `weight`/2 · Σ max(0, |κᵢ|/most − 1)² + max(0, |κ′ᵢ|/most_rate − 1)² over all samples, with its Gauss-Newton
/// matrix. Returns the largest relative excess of a sample over its bound, 0 if there is none.
///
/// 24 samples, ends included; what lies between is asked of [`keeps`].
///
/// Only the lower triangle of the matrix is added to. Second derivatives of the excess by L are left out, as Gauss and
/// Newton do. The excess answered is ≥ 0, relative to `bounds`.
pub(super) fn penalise(
    simd: Simd,
    ends: &Ends,
    free: &Free,
    bounds: &Curvatures,
    weight: f64,
    objective: &mut Objective,
) -> f64 {
    let (mut turning, mut bending) = ([[0.0; LANES]; GROUPS], [[0.0; LANES]; GROUPS]);
    samples(simd, &ends.factors(free), &mut turning, &mut bending);
    let length = free.length;
    // θ_t = Lκ and θ_tt = L²κ′.
    let kinds = [
        (&turning, &SLOPES, length * bounds.most, 1.0 / length),
        (&bending, &BENDS, length * length * bounds.most_rate, 2.0 / length),
    ];
    let mut worst: f64 = 0.0;
    for (values, table, most, growth) in kinds {
        let scale = 1.0 / most;
        for sample in 0..=LAST {
            let (group, lane) = (sample / LANES, sample % LANES);
            let value = values[group][lane];
            let excess = value.abs() * scale - 1.0;
            if excess <= 0.0 {
                continue;
            }
            worst = worst.max(excess);
            let at = |b: usize| table[b][group][lane];
            let sign = scale.copysign(value);
            // What is allowed grows with L at the relative rate `growth`.
            let by_length = sign * (ends.start * at(0) + ends.end * at(2)) - (1.0 + excess) * growth;
            let row = [sign * at(3), sign * at(4), sign * at(5), by_length];
            for a in 0..=SHAPES {
                objective.gradient[a] += weight * excess * row[a];
                for b in 0..=a {
                    objective.matrix[a][b] += weight * row[a] * row[b];
                }
            }
        }
    }
    worst
}

kernel! {
    /// Adds Lκ and L²κ′ at the samples to zeros.
    ///
    /// 24 evenly spaced t, both ends among them.
    fn samples(factors: &[f64; BASIS], turning: &mut Table, bending: &mut Table) {
        for (b, factor) in factors.iter().enumerate() {
            for group in 0..GROUPS {
                for lane in 0..LANES {
                    turning[group][lane] += factor * SLOPES[b][group][lane];
                    bending[group][lane] += factor * BENDS[b][group][lane];
                }
            }
        }
    }
}

/// Lκ and L²κ′ as polynomials of t.
fn polynomials(ends: &Ends, free: &Free) -> ([f64; 6], [f64; 6]) {
    let turning = ends.turning(free);
    let [_, a, b, c, d, e] = turning;
    (turning, [a, 2.0 * b, 3.0 * c, 4.0 * d, 5.0 * e, 0.0])
}

/// Whether the curve keeps both bounds everywhere.
///
/// By bounds of the polynomials themselves, not by samples.
///
/// Up to 10⁻⁹ of each bound, and the 10⁻¹⁰ of [`within`].
pub(super) fn keeps(ends: &Ends, free: &Free, bounds: &Curvatures) -> bool {
    let (turning, bending) = polynomials(ends, free);
    within(&turning, free.length * bounds.most * KEPT)
        && within(&bending, free.length * free.length * bounds.most_rate * KEPT)
}

/// The largest bends of the curve.
pub(in super::super) fn bends(ends: &Ends, free: &Free, bounds: &Curvatures) -> Bends {
    let (turning, bending) = polynomials(ends, free);
    let length = free.length;
    Bends {
        curvature: largest(&turning) / (length * bounds.most),
        rate: largest(&bending) / (length * length * bounds.most_rate),
    }
}
