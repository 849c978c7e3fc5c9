//! The (μ/μ_w, λ) evolution strategy with covariance matrix adaptation, as its tutorial has it.
//!
//! Source: Hansen, "The CMA evolution strategy: a tutorial", arXiv:1604.00772, 2016 (default parameters of its table 1,
//! without negative weights). Written here because the crate `cmaes` evaluates candidates where it draws them and
//! learns from the step that it drew: a candidate that is repaired cannot be told back to it.

use hairpin::math::random::{Stream, standard_normals, stream};
use nalgebra::{DMatrix, DVector};

/// Where the smallest variance is less than this share of the largest, the matrix is not drawn out further.
const LEAST_VARIANCE: f64 = 1e-14;

/// State of the strategy.
pub(super) struct Cmaes {
    mean: DVector<f64>,
    sigma: f64,
    covariance: DMatrix<f64>,
    /// Columns: principal axes.
    axes: DMatrix<f64>,
    /// Standard deviations along them.
    lengths: DVector<f64>,
    path_sigma: DVector<f64>,
    path_c: DVector<f64>,
    generation: i32,
    random: Stream,
}

/// What follows from dimension and weights.
struct Rates {
    mu_w: f64,
    c_sigma: f64,
    d_sigma: f64,
    c_c: f64,
    c_1: f64,
    c_mu: f64,
    /// E‖N(0, I)‖.
    chi: f64,
}

impl Rates {
    fn of(n: f64, weights: &[f64]) -> Self {
        let mu_w = 1.0 / weights.iter().map(|w| w * w).sum::<f64>();
        let c_sigma = (mu_w + 2.0) / (n + mu_w + 5.0);
        let d_sigma = 1.0 + 2.0 * (((mu_w - 1.0) / (n + 1.0)).sqrt() - 1.0).max(0.0) + c_sigma;
        let c_c = (4.0 + mu_w / n) / (n + 4.0 + 2.0 * mu_w / n);
        let c_1 = 2.0 / ((n + 1.3) * (n + 1.3) + mu_w);
        let c_mu = (1.0 - c_1).min(2.0 * (mu_w - 2.0 + 1.0 / mu_w) / ((n + 2.0) * (n + 2.0) + mu_w));
        let chi = n.sqrt() * (1.0 - 1.0 / (4.0 * n) + 1.0 / (21.0 * n * n));
        Self { mu_w, c_sigma, d_sigma, c_c, c_1, c_mu, chi }
    }
}

/// Candidates of a generation: 4 + ⌊3 ln n⌋.
pub(super) fn candidates(dimensions: usize) -> usize {
    4 + (3.0 * libm::log(dimensions.max(1) as f64)) as usize
}

impl Cmaes {
    /// About `mean`, with standard deviation `sigma` in each coordinate.
    pub(super) fn new(mean: DVector<f64>, sigma: f64, seed: u64) -> Self {
        let n = mean.len();
        Self {
            mean,
            sigma,
            covariance: DMatrix::identity(n, n),
            axes: DMatrix::identity(n, n),
            lengths: DVector::repeat(n, 1.0),
            path_sigma: DVector::zeros(n),
            path_c: DVector::zeros(n),
            generation: 0,
            random: stream(seed),
        }
    }

    pub(super) fn mean(&self) -> &DVector<f64> {
        &self.mean
    }

    /// m + σ B D z for `count` standard normal z.
    pub(super) fn ask(&mut self, count: usize) -> Vec<DVector<f64>> {
        let n = self.mean.len();
        let mut one = || {
            let z = DVector::from_fn(n, |_, _| standard_normals::<1>(&mut self.random)[0]);
            &self.mean + (&self.axes * self.lengths.component_mul(&z)) * self.sigma
        };
        (0..count).map(|_| one()).collect()
    }

    /// Takes what was asked for, or what it was repaired to, the best first; the better half counts.
    ///
    /// A generation of which nothing was left halves the step.
    pub(super) fn tell(&mut self, ranked: &[DVector<f64>]) {
        let parents = ranked.len().div_ceil(2);
        if parents == 0 {
            self.sigma *= 0.5;
            return;
        }
        let n = self.mean.len() as f64;
        let half = 0.5 * (ranked.len() as f64 + 1.0);
        let raw: Vec<f64> = (1..=parents).map(|i| (libm::log(half.max(1.5)) - libm::log(i as f64)).max(0.0)).collect();
        let sum: f64 = raw.iter().sum();
        let weights: Vec<f64> = raw.iter().map(|w| w / sum).collect();
        let rates = Rates::of(n, &weights);
        let steps: Vec<DVector<f64>> = ranked[..parents].iter().map(|x| (x - &self.mean) / self.sigma).collect();
        let mut step = DVector::zeros(self.mean.len());
        weights.iter().zip(&steps).for_each(|(w, y)| step += y * *w);
        self.mean += &step * self.sigma;

        // C^(−1/2) y = B D⁻¹ Bᵀ y.
        let whitened = &self.axes * (self.axes.transpose() * &step).component_div(&self.lengths);
        let kept = (rates.c_sigma * (2.0 - rates.c_sigma) * rates.mu_w).sqrt();
        self.path_sigma = &self.path_sigma * (1.0 - rates.c_sigma) + whitened * kept;
        self.generation += 1;
        let grown = (1.0 - libm::pow(1.0 - rates.c_sigma, f64::from(2 * self.generation))).sqrt();
        let norm = self.path_sigma.norm();
        let h = f64::from(u8::from(norm / grown < (1.4 + 2.0 / (n + 1.0)) * rates.chi));
        let kept = (rates.c_c * (2.0 - rates.c_c) * rates.mu_w).sqrt();
        self.path_c = &self.path_c * (1.0 - rates.c_c) + &step * (h * kept);

        let lost = (1.0 - h) * rates.c_1 * rates.c_c * (2.0 - rates.c_c);
        let mut covariance = &self.covariance * (1.0 - rates.c_1 - rates.c_mu + lost);
        covariance += &self.path_c * self.path_c.transpose() * rates.c_1;
        weights.iter().zip(&steps).for_each(|(w, y)| covariance += y * y.transpose() * (rates.c_mu * *w));
        self.covariance = covariance;
        self.sigma *= libm::exp(rates.c_sigma / rates.d_sigma * (norm / rates.chi - 1.0)).min(2.0);
        self.decompose();
    }

    fn decompose(&mut self) {
        let symmetric = (&self.covariance + self.covariance.transpose()) * 0.5;
        let (variances, axes) = eigen(symmetric);
        let most = variances.max();
        self.axes = axes;
        self.lengths = variances.map(|variance| variance.max(LEAST_VARIANCE * most).sqrt());
    }
}

/// Sweeps over all pairs of axes at most; a dozen settle what there is.
const SWEEPS: usize = 40;

/// Eigenvalues and eigenvectors (columns) of a symmetric matrix by cyclic Jacobi rotations, which need no more than
/// square roots: the same bits on every machine. Source: Golub and Van Loan, Matrix Computations, 4th ed., section 8.5.
fn eigen(mut matrix: DMatrix<f64>) -> (DVector<f64>, DMatrix<f64>) {
    let n = matrix.nrows();
    let mut axes = DMatrix::identity(n, n);
    let whole = matrix.norm();
    for _ in 0..SWEEPS {
        let mut off = 0.0;
        for p in 0..n {
            for q in p + 1..n {
                let beside = matrix[(p, q)];
                off += beside * beside;
                if beside == 0.0 {
                    continue;
                }
                let tau = (matrix[(q, q)] - matrix[(p, p)]) / (2.0 * beside);
                let t = (1.0 / (tau.abs() + (1.0 + tau * tau).sqrt())).copysign(tau);
                let cos = 1.0 / (1.0 + t * t).sqrt();
                let sin = t * cos;
                for k in 0..n {
                    let (a, b) = (matrix[(k, p)], matrix[(k, q)]);
                    (matrix[(k, p)], matrix[(k, q)]) = (cos * a - sin * b, sin * a + cos * b);
                }
                for k in 0..n {
                    let (a, b) = (matrix[(p, k)], matrix[(q, k)]);
                    (matrix[(p, k)], matrix[(q, k)]) = (cos * a - sin * b, sin * a + cos * b);
                    let (a, b) = (axes[(k, p)], axes[(k, q)]);
                    (axes[(k, p)], axes[(k, q)]) = (cos * a - sin * b, sin * a + cos * b);
                }
            }
        }
        if off.sqrt() <= 1e-15 * whole {
            break;
        }
    }
    (matrix.diagonal(), axes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_are_those_of_the_matrix() {
        let a = DMatrix::from_fn(7, 7, |i, j| libm::sin((3 * i + 5 * j) as f64));
        let symmetric = &a * a.transpose();
        let (values, axes) = eigen(symmetric.clone());
        let again = &axes * DMatrix::from_diagonal(&values) * axes.transpose();
        assert!((again - &symmetric).norm() < 1e-12 * symmetric.norm(), "{values}");
        assert!((axes.transpose() * &axes - DMatrix::identity(7, 7)).norm() < 1e-12);
    }

    /// Smallest value of `f` after so many generations.
    fn least(f: impl Fn(&DVector<f64>) -> f64, n: usize, generations: usize) -> f64 {
        let mut strategy = Cmaes::new(DVector::repeat(n, 3.0), 1.0, 5);
        let mut least = f64::INFINITY;
        for _ in 0..generations {
            let mut asked = strategy.ask(candidates(n));
            asked.sort_by(|a, b| f(a).total_cmp(&f(b)));
            least = least.min(f(&asked[0]));
            strategy.tell(&asked);
        }
        least
    }

    #[test]
    fn it_finds_the_least_of_round_and_of_drawn_out_bowls() {
        assert_eq!((candidates(3), candidates(10), candidates(24)), (7, 10, 13));
        let round = least(|x| x.norm_squared(), 8, 150);
        assert!(round < 1e-8, "{round}");
        // Axes of 1 to 1000: without the covariance it would still be far away.
        let drawn_out = |x: &DVector<f64>| {
            let n = x.len() as f64 - 1.0;
            x.iter().enumerate().map(|(i, x)| libm::pow(1e6, i as f64 / n) * x * x).sum::<f64>()
        };
        let drawn_out = least(drawn_out, 6, 400);
        assert!(drawn_out < 1e-6, "{drawn_out}");
    }

    #[test]
    fn a_generation_without_anything_makes_smaller_steps() {
        let mut strategy = Cmaes::new(DVector::repeat(2, 1.0), 1.0, 1);
        strategy.tell(&[]);
        assert_eq!((strategy.sigma, strategy.mean()[0]), (0.5, 1.0));
        // One that is left is all there is to follow.
        strategy.tell(&[DVector::repeat(2, 4.0)]);
        assert_eq!(strategy.mean()[1], 4.0);
    }
}
