//! One step towards the end and down an objective at once: a quadratic programme with two equations in four unknowns.
//!
//! The Schur complement J H⁻¹ Jᵀ is 2 × 2, so that a step is a Cholesky factorisation of 4 × 4, three solutions and a
//! determinant. A ridge of 10⁻⁹ of its trace keeps it regular where the end moves in one direction only, as on a
//! straight.

use super::super::task::Freedoms;
use super::heading::{Free, SHAPES};

/// c₀, c₁, c₂, L.
pub(super) const UNKNOWNS: usize = SHAPES + 1;

/// What is to become small, to second order.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Objective {
    /// g.
    pub(super) gradient: [f64; UNKNOWNS],
    /// Lower triangle; positive definite.
    pub(super) matrix: [[f64; UNKNOWNS]; UNKNOWNS],
}

/// d of min gᵀd + ½dᵀHd such that Jd = −e: d = −H⁻¹(g + Jᵀλ), (JH⁻¹Jᵀ)λ = e − JH⁻¹g.
///
/// With one freedom c₁ and c₂ stay as they are: the curve is a cubic.
///
/// `error` in m, J by (c₀, c₁, c₂, L). Where H is not definite the factorisation lifts the pivot and the step is
/// bounded by [`Free::advance`] alone.
pub(super) fn step(
    objective: &Objective,
    error: &[f64; 2],
    jacobian: &[[f64; UNKNOWNS]; 2],
    freedoms: Freedoms,
) -> [f64; UNKNOWNS] {
    let mut jacobian = *jacobian;
    let Objective { mut gradient, mut matrix } = *objective;
    if freedoms == Freedoms::One {
        for fixed in 1..SHAPES {
            jacobian[0][fixed] = 0.0;
            jacobian[1][fixed] = 0.0;
            gradient[fixed] = 0.0;
            for other in 0..UNKNOWNS {
                matrix[fixed.max(other)][fixed.min(other)] = if other == fixed { 1.0 } else { 0.0 };
            }
        }
    }
    let factor = Cholesky::new(&matrix);
    let downhill = factor.solve(&gradient);
    let pulls = [factor.solve(&jacobian[0]), factor.solve(&jacobian[1])];
    let dot = |a: &[f64; UNKNOWNS], b: &[f64; UNKNOWNS]| (a[0] * b[0] + a[1] * b[1]) + (a[2] * b[2] + a[3] * b[3]);
    let (mut s00, s01, mut s11) =
        (dot(&jacobian[0], &pulls[0]), dot(&jacobian[0], &pulls[1]), dot(&jacobian[1], &pulls[1]));
    // Where the end can move in one direction only, it moves in that one.
    let ridge = 1e-9 * (s00 + s11);
    s00 += ridge;
    s11 += ridge;
    let (b0, b1) = (error[0] - dot(&jacobian[0], &downhill), error[1] - dot(&jacobian[1], &downhill));
    let determinant = s00 * s11 - s01 * s01;
    let (l0, l1) = ((s11 * b0 - s01 * b1) / determinant, (s00 * b1 - s01 * b0) / determinant);
    std::array::from_fn(|i| -downhill[i] - pulls[0][i] * l0 - pulls[1][i] * l1)
}

/// No step turns the curve by more than this anywhere, rad, or changes its length by more than half of it.
const STRIDE: f64 = 1.0;

impl Free {
    /// Moves by `step`, or by the part of it that is no longer than a stride.
    ///
    /// Keeps L > 0: no step takes more than half of it away.
    pub(super) fn advance(&mut self, step: &[f64; UNKNOWNS]) {
        // The largest values of |φ₀|, |φ₁|, |φ₂| are just below 1/32, 1/112 and 1/190.
        let turn = step[0].abs() / 32.0 + step[1].abs() / 112.0 + step[2].abs() / 190.0;
        let size = turn.max(2.0 * step[SHAPES].abs() / self.length);
        let scale = if size > STRIDE { STRIDE / size } else { 1.0 };
        for (value, change) in self.shape.iter_mut().zip(step) {
            *value += scale * change;
        }
        self.length += scale * step[SHAPES];
    }
}

/// H = CCᵀ, with the reciprocals of the diagonal.
struct Cholesky {
    lower: [[f64; UNKNOWNS]; UNKNOWNS],
    inverse: [f64; UNKNOWNS],
}

impl Cholesky {
    /// From the lower triangle; pivots that rounding makes negative are lifted.
    fn new(matrix: &[[f64; UNKNOWNS]; UNKNOWNS]) -> Self {
        let mut lower = [[0.0; UNKNOWNS]; UNKNOWNS];
        let mut inverse = [0.0; UNKNOWNS];
        for i in 0..UNKNOWNS {
            for j in 0..i {
                let sum: f64 = (0..j).map(|k| lower[i][k] * lower[j][k]).sum();
                lower[i][j] = (matrix[i][j] - sum) * inverse[j];
            }
            let sum: f64 = lower[i][..i].iter().map(|c| c * c).sum();
            inverse[i] = 1.0 / (matrix[i][i] - sum).max(1e-300).sqrt();
        }
        Self { lower, inverse }
    }

    /// H⁻¹ right, by two substitutions.
    fn solve(&self, right: &[f64; UNKNOWNS]) -> [f64; UNKNOWNS] {
        let mut x = *right;
        for i in 0..UNKNOWNS {
            let sum: f64 = (0..i).map(|k| self.lower[i][k] * x[k]).sum();
            x[i] = (x[i] - sum) * self.inverse[i];
        }
        for i in (0..UNKNOWNS).rev() {
            let sum: f64 = (i + 1..UNKNOWNS).map(|k| self.lower[k][i] * x[k]).sum();
            x[i] = (x[i] - sum) * self.inverse[i];
        }
        x
    }
}
