//! How far estimates scatter where residuals are coloured: a jackknife of blocks.
//!
//! ```text
//! H = Σ_b H_b,  s_b = Σ_{i ∈ b} w r J           white residuals would give the covariance H⁻¹
//! Δ_b = −(H − H_b)⁻¹ s_b                        what the estimate moves by when block b is left out, to first order
//! C = (m − 1)/m (Σ_b Δ_b Δ_bᵀ + ½ Σ_b (Δ_b Δ_{b+1}ᵀ + Δ_{b+1} Δ_bᵀ))      pairs of blocks that follow each other
//! ```
//!
//! With white residuals Δ_b of a parameter has the variance v_b = uᵀ H_b u, u its row of (H − H_b)⁻¹, and its C is as
//! good as known from so many independent blocks:
//!
//! ```text
//! ν = (m − n)/m (Σ v_b)²/(Σ v_b² + ½ Σ v_b v_{b+1})         n parameters, pairs as above
//! ```
//!
//! the degrees of freedom by which the first two moments of C are those of χ²_ν (Satterthwaite 1946; of few or unlike
//! blocks Bell and McCaffrey, Survey Methodology 28(2), 2002): of a number that two blocks tell of, ν is about two
//! however many the others are.
//!
//! The first sum is the sandwich H⁻¹ (Σ s sᵀ) H⁻¹ with each block's leverage taken out, which few blocks need (Künsch,
//! The jackknife and the bootstrap for general stationary observations, Ann. Statist. 17(3), 1989; MacKinnon and White
//! 1985); the second is Bartlett's weight of the neighbour, for what a block leaves to the next (Newey and West 1987).

use nalgebra::{DMatrix, DVector};

use super::descend::Descent;
use super::objective::Objective;

/// Second moments about an estimate, in the order of the free parameters.
#[derive(Debug, Clone)]
pub struct Spread {
    /// Covariance C.
    pub covariance: DMatrix<f64>,
    /// H.
    pub curvature: DMatrix<f64>,
    /// H⁻¹: the covariance if residuals were white.
    pub white: DMatrix<f64>,
    /// ν: so many independent blocks each one's variance rests on.
    pub freedom: Vec<f64>,
    pub(super) jacobian: DMatrix<f64>,
}

/// The spread about `at` of the parameters `free`. `None` where too few blocks or parameters without effect leave none.
pub fn spread(objective: &Objective, at: &Descent, free: &[usize]) -> Option<Spread> {
    let (m, n) = (objective.blocks(), free.len());
    let beyond = m.checked_sub(n).filter(|beyond| *beyond > 0)? as f64 / m as f64;
    let jacobian = objective.jacobian(&at.theta, free)?;
    let (h, _) = objective.normal_equations(&at.value, &jacobian, 0..m);
    // Parameters in units of their own white deviations, so that nothing is ill scaled but what is confounded.
    let scale = DVector::from_fn(n, |k, _| h[(k, k)].sqrt().recip());
    if scale.iter().any(|s| !s.is_finite()) {
        return None;
    }
    let scaled = |h: &DMatrix<f64>| DMatrix::from_fn(n, n, |a, b| h[(a, b)] * scale[a] * scale[b]);
    let whole = scaled(&h);
    let moves: Option<Vec<[DVector<f64>; 2]>> = (0..m)
        .map(|block| {
            let (part, score) = objective.normal_equations(&at.value, &jacobian, block..block + 1);
            let part = scaled(&part);
            let rest = (&whole - &part + DMatrix::identity(n, n) * RIDGE).cholesky()?;
            let u = rest.inverse();
            Some([-rest.solve(&score.component_mul(&scale)), (&u * part * &u).diagonal()])
        })
        .collect();
    let moves = moves?;
    let mut sum = DMatrix::zeros(n, n);
    let (mut once, mut twice) = (DVector::zeros(n), DVector::<f64>::zeros(n));
    for (block, [own, v]) in moves.iter().enumerate() {
        sum += own * own.transpose();
        once += v;
        twice += v.component_mul(v);
        if block + 1 < m && !objective.begins[block + 1] {
            let [next, next_v] = &moves[block + 1];
            let cross = own * next.transpose();
            sum += (&cross + cross.transpose()) * 0.5;
            twice += v.component_mul(next_v) * 0.5;
        }
    }
    let freedom = once.iter().zip(&twice).map(|(once, twice)| beyond * once * once / twice).collect();
    let back = |c: &DMatrix<f64>| DMatrix::from_fn(n, n, |a, b| c[(a, b)] * scale[a] * scale[b]);
    let white = (whole + DMatrix::identity(n, n) * RIDGE).try_inverse()?;
    let covariance = back(&(sum * ((m - 1) as f64 / m as f64)));
    Some(Spread { covariance, curvature: h, white: back(&white), freedom, jacobian })
}

/// Against rounding where parameters are confounded, of a matrix with ones on its diagonal.
const RIDGE: f64 = 1e-10;

/// Those of the parameters `all` of which a change by `by` moves Q by `least` at least, where the others stay.
pub fn acting(objective: &Objective, at: &Descent, all: &[usize], by: &dyn Fn(usize) -> f64, least: f64) -> Vec<usize> {
    let Some(jacobian) = objective.jacobian(&at.theta, all) else { return Vec::new() };
    let (h, _) = objective.normal_equations(&at.value, &jacobian, 0..objective.blocks());
    let acts = |k: usize| h[(k, k)] * by(all[k]) * by(all[k]) >= least;
    (0..all.len()).filter(|&k| acts(k)).map(|k| all[k]).collect()
}
