//! ∫κ² and ∫κ′² of a drive in pieces, to second order in its changes.
//!
//! Bends b are added before the stretch ε, so that with Q(b), quadratic, the cost without it,
//!
//! ```text
//! F(b, ε) = (1 + ε)ᵖ Q(b)     p = 1 for ∫κ², −1 for ∫κ′²
//! ```
//!
//! Q's matrix does not depend on b, since κ is linear in the bends; the mixed derivative by b and ε is p ∇Q. Order of
//! unknowns as in [`Change`]: 16 bends, then the stretch.

use nalgebra::SMatrix;

use super::cost::GroundCost;
use super::miss::units;
use super::refine::{Change, PIECES, Tangent, UNKNOWNS, bend};
use crate::feasibility::steering::shooting::query::Precision;
use crate::math::quadrature::Gauss;
use crate::trajectory::drive::{Motion, Segment};

/// Points of a piece: exact for squares of fifth order.
const POINTS: usize = 6;
/// Weight of squared misses of the end in units of the precision, against the cost's share.
const EXACT: f64 = 100.0;

/// Value, gradient and matrix of second derivatives.
pub(super) struct Model {
    value: f64,
    gradient: Change,
    matrix: SMatrix<f64, UNKNOWNS, UNKNOWNS>,
}

impl Model {
    /// Of `cost`, one of the two, at `pieces` as they are.
    ///
    /// Exact to rounding: six Gauss points a piece for polynomials of order 10.
    pub(super) fn of(pieces: &[Segment], cost: GroundCost) -> Self {
        let mut model = Self { value: 0.0, gradient: Change::zeros(), matrix: SMatrix::zeros() };
        let rule = Gauss::<POINTS>::RULE;
        for (piece, segment) in pieces.iter().enumerate() {
            let Motion::Arc { length_m, curvature } = segment.motion else { continue };
            for (&share, weight) in rule.nodes.iter().zip(&rule.weights) {
                let (mut value, mut rate) = (0.0, 0.0);
                for a in curvature.iter().rev() {
                    rate = rate * share * length_m + value;
                    value = value * share * length_m + a;
                }
                let (asked, row) = match cost {
                    GroundCost::Rate => (rate, bend(piece, -1.0 / length_m, 1.0 / length_m)),
                    _ => (value, bend(piece, 1.0 - share, share)),
                };
                let weight = weight * length_m;
                model.value += weight * asked * asked;
                model.gradient += 2.0 * weight * asked * row;
                model.matrix += 2.0 * weight * row * row.transpose();
            }
        }
        let power = if cost == GroundCost::Rate { -1.0 } else { 1.0 };
        let by_both = power * model.gradient;
        model.matrix.set_row(PIECES, &by_both.transpose());
        model.matrix.set_column(PIECES, &by_both);
        model.gradient[PIECES] = power * model.value;
        model.matrix[(PIECES, PIECES)] = power * (power - 1.0) * model.value;
        model
    }

    /// Matrix and right side of the least squares for a step d that lowers the cost's share and leaves the end,
    /// `tangent` d = 0, with `damping` of every unknown in its own units.
    ///
    /// Everything is over the value of the cost, so that weights against the end's conditions mean a share of it. The
    /// conditions are a penalty of 100 on squared misses in units of the precision, not a constraint: refinement makes
    /// them exact.
    pub(super) fn damped(
        &self,
        damping: f64,
        tangent: &Tangent,
        precision: &Precision,
    ) -> (SMatrix<f64, UNKNOWNS, UNKNOWNS>, Change) {
        let mut matrix = self.matrix;
        for i in 0..PIECES {
            matrix[(i, i)] *= 1.0 + damping;
        }
        // Q's own curvature along a stretch is p(p − 1)Q; with 2Q the whole is positive for both powers.
        matrix[(PIECES, PIECES)] = 2.0 * self.value * (1.0 + damping);
        let scale = 1.0 / self.value;
        let weighted = SMatrix::<f64, 4, 4>::from_diagonal(&units(precision)) * tangent;
        (scale * matrix + EXACT * weighted.transpose() * weighted, -scale * self.gradient)
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::super::refine::{changed, divided};
    use super::*;
    use crate::trajectory::drive::{Gear, SegmentList};

    #[test]
    fn derivatives_agree_with_central_differences() {
        let mut drive = SegmentList::default();
        let curvature = [0.3, -0.5, 0.4, 0.2, -0.1, 0.05];
        drive.add(Segment { motion: Motion::Arc { length_m: 1.6, curvature }, gear: Gear::Forward });
        drive.add(Segment::clothoid(0.7, 0.2, -0.4, Gear::Forward));
        let drive = divided(&drive).expect("pieces");
        for cost in [GroundCost::Curvature, GroundCost::Rate] {
            let model = Model::of(&drive, cost);
            let at = |steps: &[(usize, f64)]| {
                let mut change = Change::zeros();
                steps.iter().for_each(|&(unknown, size)| change[unknown] += size);
                let mut other = drive;
                changed(&mut other, &change);
                cost.of_commands(&other)
            };
            assert!((model.value - at(&[])).abs() < 1e-12, "{cost:?}");
            let h = 1e-3;
            for i in 0..UNKNOWNS {
                let slope = (at(&[(i, h)]) - at(&[(i, -h)])) / (2.0 * h);
                assert!((slope - model.gradient[i]).abs() < 1e-4, "{cost:?} {i}: {slope}, not {}", model.gradient[i]);
                for j in 0..=i {
                    let bent = (at(&[(i, h), (j, h)]) - at(&[(i, h), (j, -h)]) - at(&[(i, -h), (j, h)])
                        + at(&[(i, -h), (j, -h)]))
                        / (4.0 * h * h);
                    let found = model.matrix[(i, j)];
                    assert!((bent - found).abs() < 1e-3 * (1.0 + found.abs()), "{cost:?} {i} {j}: {bent}, not {found}");
                }
            }
        }
    }
}
