//! Gauss collocation: the implicit Runge-Kutta method of order 12 with 6 stages. It keeps quadratic invariants, so a
//! rotation matrix stays one. Its coefficients are computed here, not copied.
//! Hairer, Nørsett, Wanner: Solving Ordinary Differential Equations I, section II.7.
//!
//! Symplectic and symmetric of order 2s = 12: ẋ at the nodes of Gauss' quadrature, x(t + c_i h) = x + h Σ_j a_ij
//! f(x_j). RᵀR is a quadratic invariant, so that no renormalisation hides an error.
//!
//! ```text
//! P₆(2c_i − 1) = 0,   b_i = 1/((1 − x_i²) P₆′(x_i)²) with x_i = 2c_i − 1,   a_ij = ∫₀^c_i ℓ_j(τ) dτ
//! ```
//!
//! ℓ_j is Lagrange's polynomial of node j, of degree 5: the method's own six-point quadrature, exact to degree 11,
//! integrates it without error.

/// Stages.
pub(super) const STAGES: usize = 6;

/// Nodes, weights and matrix of the method on [0, 1].
#[derive(Debug, Clone, Copy)]
pub(super) struct Gauss {
    /// Nodes, rising.
    pub(super) nodes: [f64; STAGES],
    weights: [f64; STAGES],
    matrix: [[f64; STAGES]; STAGES],
    /// Lagrange polynomials at the next step's nodes.
    ahead: [[f64; STAGES]; STAGES],
}

impl Gauss {
    /// Nodes are the roots of the shifted Legendre polynomial; the matrix holds the integrals of the Lagrange
    /// polynomials from 0 to each node, which the method's own quadrature gives exactly.
    ///
    /// Newton on P₆ from Chebyshev-like guesses, to the last digits; weights 1/((1 − x²) P₆′(x)²) on [0, 1].
    pub(super) fn new() -> Self {
        let mut nodes = [0.0; STAGES];
        let mut weights = [0.0; STAGES];
        for (i, (node, weight)) in nodes.iter_mut().zip(&mut weights).enumerate() {
            let mut x = -libm::cos(std::f64::consts::PI * (i as f64 + 0.75) / (STAGES as f64 + 0.5));
            for _ in 0..20 {
                let (p, slope) = legendre(x);
                x -= p / slope;
            }
            let (_, slope) = legendre(x);
            *node = 0.5 * (1.0 + x);
            *weight = 1.0 / ((1.0 - x * x) * slope * slope);
        }
        let lagrange = |j: usize, at: f64| -> f64 {
            (0..STAGES).filter(|&k| k != j).map(|k| (at - nodes[k]) / (nodes[j] - nodes[k])).product()
        };
        let matrix = std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                let integral: f64 = (0..STAGES).map(|k| weights[k] * lagrange(j, nodes[i] * nodes[k])).sum();
                nodes[i] * integral
            })
        });
        let ahead = std::array::from_fn(|i| std::array::from_fn(|j| lagrange(j, 1.0 + nodes[i])));
        Self { nodes, weights, matrix, ahead }
    }

    /// One step of length `h` from `state`; `f(stage, x)` is ẋ at the time of that stage. The stages are solved by
    /// fixed-point iteration, which contracts for h small against the system's own times; `None` where it does not.
    /// `slopes` are those of the step before, if it was as long, and are continued to begin with.
    ///
    /// `slopes` are replaced by this step's. `None` where 60 iterations do not converge or something is no number: the
    /// caller halves the step. Convergence is 10⁻¹⁴ relative to 1 + |x|, or 10⁻¹¹ where rounding stops it.
    pub(super) fn step<const N: usize>(
        &self,
        state: &[f64; N],
        h: f64,
        slopes: &mut Option<Slopes<N>>,
        mut f: impl FnMut(usize, &[f64; N]) -> [f64; N],
    ) -> Option<[f64; N]> {
        let mut current: Slopes<N> = match slopes.take() {
            Some(before) => std::array::from_fn(|stage| combine(&[0.0; N], 1.0, &self.ahead[stage], &before)),
            None => std::array::from_fn(|stage| f(stage, state)),
        };
        let mut before = f64::INFINITY;
        for _ in 0..60 {
            let mut change = 0.0f64;
            for stage in 0..STAGES {
                let slope = f(stage, &combine(state, h, &self.matrix[stage], &current));
                for ((old, new), x) in current[stage].iter().zip(&slope).zip(state) {
                    change = change.max(h * (old - new).abs() / (1.0 + x.abs()));
                }
                current[stage] = slope;
            }
            if !change.is_finite() {
                return None;
            }
            // Converged, or as near as rounding lets it come.
            if change < 1e-14 || (change < 1e-11 && change >= before) {
                let end = combine(state, h, &self.weights, &current);
                *slopes = Some(current);
                return Some(end);
            }
            before = change;
        }
        None
    }
}

/// ẋ at every stage.
pub(super) type Slopes<const N: usize> = [[f64; N]; STAGES];

/// state + h Σ weight_j slope_j.
///
/// At the stages with a row of the matrix, at the step's end with the weights b.
fn combine<const N: usize>(state: &[f64; N], h: f64, weights: &[f64; STAGES], slopes: &Slopes<N>) -> [f64; N] {
    let mut at = *state;
    for (weight, slope) in weights.iter().zip(slopes) {
        for (x, k) in at.iter_mut().zip(slope) {
            *x += h * weight * k;
        }
    }
    at
}

/// The Legendre polynomial of degree [`STAGES`] and its derivative, by the three-term recurrence.
///
/// (n + 1) P_(n+1) = (2n + 1) x P_n − n P_(n−1);  P_s′ = s (x P_s − P_(s−1))/(x² − 1): not at x = ±1, where no node
/// is.
fn legendre(x: f64) -> (f64, f64) {
    let (mut before, mut p) = (1.0, x);
    for n in 1..STAGES {
        let n = n as f64;
        (before, p) = (p, ((2.0 * n + 1.0) * x * p - n * before) / (n + 1.0));
    }
    (p, STAGES as f64 * (x * p - before) / (x * x - 1.0))
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;

    #[test]
    fn integrates_polynomials_exactly() {
        let gauss = Gauss::new();
        for power in 0..12 {
            let f = |stage: usize, _: &[f64; 1]| [gauss.nodes[stage].powi(power)];
            let end = gauss.step(&[0.0], 1.0, &mut None, f).unwrap();
            assert!((end[0] - 1.0 / f64::from(power + 1)).abs() < 1e-14, "x^{power}: {}", end[0]);
        }
        let [twelfth] =
            gauss.step(&[0.0], 1.0, &mut None, |stage, _: &[f64; 1]| [gauss.nodes[stage].powi(12)]).unwrap();
        assert!((twelfth - 1.0 / 13.0).abs() > 1e-9, "order 12 must end at degree 11");
    }

    #[test]
    fn has_order_twelve_and_keeps_the_circle() {
        let gauss = Gauss::new();
        let error = |n: usize| {
            let (mut x, mut slopes) = ([1.0, 0.0], None);
            for _ in 0..n {
                x = gauss.step(&x, 3.0 / n as f64, &mut slopes, |_, x: &[f64; 2]| [-2.0 * x[1], 2.0 * x[0]]).unwrap();
            }
            assert!((x[0].hypot(x[1]) - 1.0).abs() < 1e-13);
            (x[0] - 6.0f64.cos()).hypot(x[1] - 6.0f64.sin())
        };
        let order = (error(3) / error(6)).log2();
        assert!((11.0..13.5).contains(&order), "{order}");
    }
}
