//! Polynomial ridge regression: how a number depends on a few others, with degree and penalty chosen by
//! cross-validation.
//!
//! With standardised, clamped inputs z = clamp((x − c)/s, z_min, z_max), monomials m_j(z) of total degree ≤ p,
//! standardised too, and penalty λ > 0:
//!
//! ```text
//! y ≈ b + Σ w_j m_j(z),     w = argmin ‖y − b − M w‖²/n + λ ‖w‖²,     (MᵀM/n + λ I) w = Mᵀ(y − b)/n
//! ```
//!
//! Inputs beyond those that were fitted count as at the edge: a search for the largest value would otherwise be led to
//! where a polynomial knows nothing. Source: Hoerl and Kennard, Technometrics 12(1), 1970.
//!
//! Data flow: [`Rows`] → standardised inputs → monomials, run by run → sums MᵀM, Mᵀy of each fold → one Cholesky
//! factorisation for each fold, degree and penalty → [`PolynomialRidge`]. A fold's training sums are all sums less its
//! own, so that cross-validation costs one pass over the rows whatever the number of folds. With m monomials and n
//! rows: n m² to sum, m³/3 for each of folds × 8 penalties × degrees.

mod factor;
mod monomials;
mod sums;
#[cfg(feature = "unit-tests")]
mod tests;

use serde::{Deserialize, Serialize};
use thiserror::Error;

pub use monomials::{LANES, monomials_of};
use monomials::{MOST_INPUTS, MOST_MONOMIALS, dot, monomials, polynomials, standardise};
use sums::Sums;

/// Penalties tried, each ten times the one before, relative to the variance 1 of every monomial.
const PENALTIES: [f64; 8] = [1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1, 1.0];
/// As many as five inputs have up to the fourth degree, and some more.
const SMALL: usize = 128;

/// Rows to learn from: row i has inputs `inputs[i]`, value `values[i]`, and belongs to `groups[i]`.
///
/// Groups are trajectories: legs of one share their controller's state, and a fold that held some of them would be told
/// of the others.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Rows {
    /// Inputs, all rows of one length.
    pub inputs: Vec<Vec<f64>>,
    /// What they should give.
    pub values: Vec<f64>,
    /// Rows of one group are never on both sides of a fold.
    pub groups: Vec<usize>,
}

/// Why nothing can be fitted.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum NoFit {
    /// Too few groups for the folds.
    #[error("{groups} trajectories; {needed} are needed")]
    Groups {
        /// Groups with different numbers.
        groups: usize,
        /// At least.
        needed: usize,
    },
    /// A number that is none.
    #[error("row {row}: {value} is not finite")]
    NotFinite {
        /// Number of the row, from 0.
        row: usize,
        /// The value.
        value: f64,
    },
    /// Rows of different lengths.
    #[error("row {row} has {found} inputs, the first row {expected}")]
    Ragged {
        /// Number of the row, from 0.
        row: usize,
        /// Its inputs.
        found: usize,
        /// Inputs of row 0.
        expected: usize,
    },
    /// Too many inputs.
    #[error("{inputs} inputs; must be at most {MOST_INPUTS}")]
    Inputs {
        /// Inputs of a row.
        inputs: usize,
    },
    /// Too many monomials.
    #[error("degree {degree}: more than {MOST_MONOMIALS} monomials")]
    Degree {
        /// As asked for.
        degree: u32,
    },
    /// Nothing differs.
    #[error("no input differs between rows: there is nothing to learn from")]
    Constant,
}

/// A fitted polynomial.
///
/// Plain numbers that say all: serialised, it is a model's file. Inputs keep the caller's units (standardising takes
/// them away), values theirs.
///
/// ```
/// use hairpin::math::ridge::{PolynomialRidge, Rows};
///
/// // y = x² on [−1, 1], twenty rows in ten groups.
/// let x = |row: usize| row as f64 / 9.5 - 1.0;
/// let rows = Rows {
///     inputs: (0..20).map(|row| vec![x(row)]).collect(),
///     values: (0..20).map(|row| x(row) * x(row)).collect(),
///     groups: (0..20).map(|row| row % 10).collect(),
/// };
/// let (model, quality) = PolynomialRidge::choose(&rows, 3, 5)?;
/// assert!(model.degree >= 2 && quality.r2 > 0.999);
/// assert!((model.value(&[0.5]) - 0.25).abs() < 1e-3);
/// assert_eq!(model.value(&[7.0]), model.value(&[1.0])); // beyond the data: as at its edge
/// # Ok::<(), hairpin::math::ridge::NoFit>(())
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PolynomialRidge {
    /// Total degree p.
    pub degree: u32,
    /// Penalty λ.
    pub penalty: f64,
    /// Inputs c that stand for 0, one per input.
    pub centre: Vec<f64>,
    /// Standard deviations s, one per input; 0 for one that never differed or is a multiple of an earlier one: it is
    /// left out.
    pub scale: Vec<f64>,
    /// Least and greatest z that were fitted, one pair per input.
    pub range: Vec<[f64; 2]>,
    /// Powers of every monomial, one per input: [`monomials_of`] the degree and the scale.
    pub powers: Vec<Vec<u32>>,
    /// Weight of every monomial, in units of the value.
    pub weights: Vec<f64>,
    /// Value where every monomial is 0.
    pub intercept: f64,
}

/// How well cross-validation found the choice to do.
///
/// R² = 1 − Σ(y − ŷ)²/Σ(y − ȳ)², every ŷ told by a fit without its group. The choice itself was made by these errors,
/// so that they flatter it slightly; who tells of quality keeps groups out of choosing as well.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Validation {
    /// Folds.
    pub folds: usize,
    /// Share of the variance explained, over all rows, each predicted by a fit that had not seen its group.
    pub r2: f64,
    /// Root of the mean squared error, in units of the value.
    pub rmse: f64,
}

impl Validation {
    /// From the mean squared error `error` of what was told of `values`.
    pub fn of(folds: usize, error: f64, values: &[f64]) -> Self {
        let variance = variance(values);
        let r2 = if variance > 0.0 { 1.0 - error / variance } else { 0.0 };
        Self { folds, r2, rmse: libm::sqrt(error) }
    }
}

impl PolynomialRidge {
    /// Fits `rows` with the degree (1 to `most_degree`) and the penalty whose mean squared error over `folds` folds is
    /// the least; the first of equals. Groups are dealt to folds in the order in which they appear.
    ///
    /// Degrees end early where their monomials exceed 500. Penalties 1e-7 … 1, a decade apart, relative to monomials of
    /// variance 1.
    ///
    /// # Errors
    /// [`NoFit`].
    ///
    /// Inputs are standardised once, by all rows: folds share centre, scale and range, and differ in their weights
    /// alone. Each degree costs two passes over the rows, one of sums and one of errors; `most_degree` of 0 counts as
    /// 1.
    pub fn choose(rows: &Rows, most_degree: u32, folds: usize) -> Result<(Self, Validation), NoFit> {
        let fold_of = check(rows, folds)?;
        let standard = Standard::of(&rows.inputs)?;
        let mut best: Option<(f64, u32, f64)> = None;
        for degree in 1..=most_degree.max(1) {
            if monomials_of(&standard.scale, degree).is_none() {
                break;
            }
            let errors = cross_validate(rows, &standard, degree, &fold_of, folds);
            for (penalty, error) in PENALTIES.into_iter().zip(errors) {
                if best.is_none_or(|(least, ..)| error < least) {
                    best = Some((error, degree, penalty));
                }
            }
        }
        let (error, degree, penalty) = best.ok_or(NoFit::Constant)?;
        let fitted = Self::fit(rows, &standard, degree, penalty)?;
        Ok((fitted, Validation::of(folds, error, &rows.values)))
    }

    /// Fits `rows` with this degree and penalty.
    ///
    /// The penalty is on standardised monomials (variance 1), never on the intercept.
    ///
    /// # Errors
    /// [`NoFit`], of fewer than two groups too.
    pub fn of(rows: &Rows, degree: u32, penalty: f64) -> Result<Self, NoFit> {
        check(rows, 1)?;
        Self::fit(rows, &Standard::of(&rows.inputs)?, degree, penalty)
    }

    fn fit(rows: &Rows, standard: &Standard, degree: u32, penalty: f64) -> Result<Self, NoFit> {
        let powers = monomials_of(&standard.scale, degree).ok_or(NoFit::Degree { degree })?;
        let sums = Sums::over(powers.len(), 0..rows.values.len(), |row, monomials| {
            standard.monomials(&rows.inputs[row], degree, monomials);
            rows.values[row]
        });
        let (weights, intercept) = sums.solve(penalty);
        let Standard { centre, scale, range } = standard.clone();
        Ok(Self { degree, penalty, centre, scale, range, powers, weights, intercept })
    }

    /// Number of inputs.
    pub fn inputs(&self) -> usize {
        self.centre.len()
    }

    /// The value at `inputs`.
    ///
    /// b + Σ w_j m_j(z), one product for each monomial beyond the first degree and one for each weight.
    ///
    /// # Panics
    /// If their number is not [`Self::inputs`].
    pub fn value(&self, inputs: &[f64]) -> f64 {
        self.values([inputs; LANES])[0]
    }

    /// The values at several `inputs`, each the same to the bit as [`Self::value`].
    ///
    /// # Panics
    /// If the number of one is not [`Self::inputs`].
    pub fn values(&self, inputs: [&[f64]; LANES]) -> [f64; LANES] {
        assert!(inputs.iter().all(|inputs| inputs.len() == self.centre.len()), "as many inputs as were fitted");
        // Searches ask millions of times: what is not needed is not cleared.
        if self.weights.len() <= SMALL {
            self.values_in::<SMALL>(inputs)
        } else {
            self.values_in::<MOST_MONOMIALS>(inputs)
        }
    }

    fn values_in<const N: usize>(&self, inputs: [&[f64]; LANES]) -> [f64; LANES] {
        let mut buffer = [[0.0; LANES]; N];
        let count = standardise(inputs, &self.centre, &self.scale, &self.range, &mut buffer);
        polynomials(count, self.degree, &self.weights, &mut buffer).map(|sum| self.intercept + sum)
    }
}

/// How inputs are standardised.
#[derive(Clone)]
struct Standard {
    centre: Vec<f64>,
    scale: Vec<f64>,
    range: Vec<[f64; 2]>,
}

impl Standard {
    /// Standard deviations have n in the denominator. Of two inputs that are linear in each other, |correlation| > 1 −
    /// 1e-12, the later one is left out. O(rows · inputs²).
    fn of(inputs: &[Vec<f64>]) -> Result<Self, NoFit> {
        let n = inputs.len() as f64;
        let mut standard = Self { centre: Vec::new(), scale: Vec::new(), range: Vec::new() };
        for i in 0..inputs[0].len() {
            let centre = inputs.iter().map(|row| row[i]).sum::<f64>() / n;
            let variance = inputs.iter().map(|row| (row[i] - centre) * (row[i] - centre)).sum::<f64>() / n;
            let scale = libm::sqrt(variance);
            // What differs by rounding only carries nothing, and what is another input in other units nothing new.
            let differs = scale > 1e-9 * centre.abs().max(1e-9);
            let mut others = (0..i).filter(|other| standard.scale[*other] > 0.0);
            let known = others.any(|other| standard.repeats(inputs, other, i, centre, scale));
            let scale = if differs && !known { scale } else { 0.0 };
            let (mut least, mut greatest) = (f64::INFINITY, f64::NEG_INFINITY);
            for row in inputs {
                let z = if scale > 0.0 { (row[i] - centre) / scale } else { 0.0 };
                (least, greatest) = (least.min(z), greatest.max(z));
            }
            standard.centre.push(centre);
            standard.scale.push(scale);
            standard.range.push([least, greatest]);
        }
        if standard.scale.iter().all(|scale| *scale == 0.0) { Err(NoFit::Constant) } else { Ok(standard) }
    }

    /// Whether input `i` is a linear function of the input `other`.
    fn repeats(&self, inputs: &[Vec<f64>], other: usize, i: usize, centre: f64, scale: f64) -> bool {
        let products = inputs.iter().map(|row| (row[other] - self.centre[other]) * (row[i] - centre)).sum::<f64>();
        let correlation = products / (inputs.len() as f64 * self.scale[other] * scale);
        correlation.abs() > 1.0 - 1e-12
    }

    /// Writes the monomials at `inputs` and gives those that there are.
    fn monomials<'m>(&self, inputs: &[f64], degree: u32, out: &'m mut [[f64; 1]]) -> &'m [f64] {
        let count = standardise([inputs], &self.centre, &self.scale, &self.range, out);
        let end = monomials(count, degree, out);
        out[..end].as_flattened()
    }
}

/// Mean squared error of every penalty.
///
/// ```text
/// error(λ) = Σ over rows (y − ŷ_λ)²/n,   ŷ_λ by a fit without the row's fold
/// ```
fn cross_validate(
    rows: &Rows,
    standard: &Standard,
    degree: u32,
    fold_of: &[usize],
    folds: usize,
) -> [f64; PENALTIES.len()] {
    let mut buffer = [[0.0]; MOST_MONOMIALS];
    let count = standard.monomials(&rows.inputs[0], degree, &mut buffer).len();
    let of_fold = |fold| {
        let rows_of_fold = (0..rows.values.len()).filter(|row| fold_of[*row] == fold);
        Sums::over(count, rows_of_fold, |row, monomials| {
            standard.monomials(&rows.inputs[row], degree, monomials);
            rows.values[row]
        })
    };
    let parts: Vec<Sums> = (0..folds).map(of_fold).collect();
    let mut all = Sums::new(count);
    parts.iter().for_each(|part| all.include(part));
    let fits: Vec<Vec<(Vec<f64>, f64)>> = parts
        .iter()
        .map(|part| {
            let others = all.without(part);
            PENALTIES.iter().map(|&penalty| others.solve(penalty)).collect()
        })
        .collect();
    let mut squares = [0.0; PENALTIES.len()];
    for (row, inputs) in rows.inputs.iter().enumerate() {
        let monomials = standard.monomials(inputs, degree, &mut buffer);
        for (square, (weights, intercept)) in squares.iter_mut().zip(&fits[fold_of[row]]) {
            let told = intercept + dot(weights, monomials);
            *square += (rows.values[row] - told) * (rows.values[row] - told);
        }
    }
    squares.map(|square| square / rows.values.len() as f64)
}

/// The fold of every row.
///
/// Group number k, as they first appear, goes to fold k mod `folds`. Groups, lengths of rows and finite numbers are
/// asked in this order.
fn check(rows: &Rows, folds: usize) -> Result<Vec<usize>, NoFit> {
    let mut seen: Vec<usize> = Vec::new();
    let mut fold_of = Vec::with_capacity(rows.groups.len());
    for &group in &rows.groups {
        let place = seen.iter().rposition(|known| *known == group).unwrap_or_else(|| {
            seen.push(group);
            seen.len() - 1
        });
        fold_of.push(place % folds);
    }
    if seen.len() < folds.max(2) {
        return Err(NoFit::Groups { groups: seen.len(), needed: folds.max(2) });
    }
    let expected = rows.inputs[0].len();
    if expected > MOST_INPUTS {
        return Err(NoFit::Inputs { inputs: expected });
    }
    for (row, (inputs, value)) in rows.inputs.iter().zip(&rows.values).enumerate() {
        if inputs.len() != expected {
            return Err(NoFit::Ragged { row, found: inputs.len(), expected });
        }
        if let Some(&value) = inputs.iter().chain([value]).find(|value| !value.is_finite()) {
            return Err(NoFit::NotFinite { row, value });
        }
    }
    Ok(fold_of)
}

fn variance(values: &[f64]) -> f64 {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    values.iter().map(|value| (value - mean) * (value - mean)).sum::<f64>() / n
}
