//! Polynomial ridge regression: how a number depends on a few others, with degree and penalty chosen by cross-validation.
//!
//! With standardised, clamped inputs z = clamp((x − c)/s, z_min, z_max), monomials m_j(z) of total degree ≤ p, standardised
//! too, and penalty λ > 0:
//!
//! ```text
//! y ≈ b + Σ w_j m_j(z),     w = argmin ‖y − b − M w‖²/n + λ ‖w‖²,     (MᵀM/n + λ I) w = Mᵀ(y − b)/n
//! ```
//!
//! Inputs beyond those that were fitted count as at the edge: a search for the largest value would otherwise be led to where
//! a polynomial knows nothing. Source: Hoerl and Kennard, Technometrics 12(1), 1970.

use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::simd::{Simd, kernel};

/// Penalties tried, each ten times the one before, relative to the variance 1 of every monomial.
const PENALTIES: [f64; 8] = [1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1, 1.0];
/// Monomials at most: their products are kept as one matrix per fold.
const MOST_MONOMIALS: usize = 500;
/// As many as five inputs have up to the fourth degree, and some more.
const SMALL: usize = 128;
/// Inputs at most.
const MOST_INPUTS: usize = 32;

/// Rows to learn from: row i has inputs `inputs[i]`, value `values[i]`, and belongs to `groups[i]`.
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
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PolynomialRidge {
    /// Total degree p.
    pub degree: u32,
    /// Penalty λ.
    pub penalty: f64,
    /// Inputs c that stand for 0, one per input.
    pub centre: Vec<f64>,
    /// Standard deviations s, one per input; 0 for one that never differed or is a multiple of an earlier one: it is left out.
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

impl PolynomialRidge {
    /// Fits `rows` with the degree (1 to `most_degree`) and the penalty whose mean squared error over `folds` folds is the
    /// least; the first of equals. Groups are dealt to folds in the order in which they appear.
    ///
    /// # Errors
    /// [`NoFit`].
    pub fn choose(rows: &Rows, most_degree: u32, folds: usize) -> Result<(Self, Validation), NoFit> {
        let fold_of = check(rows, folds)?;
        let variance = variance(&rows.values);
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
        let r2 = if variance > 0.0 { 1.0 - error / variance } else { 0.0 };
        Ok((fitted, Validation { folds, r2, rmse: libm::sqrt(error) }))
    }

    /// Fits `rows` with this degree and penalty.
    ///
    /// # Errors
    /// [`NoFit`], of fewer than two groups too.
    pub fn of(rows: &Rows, degree: u32, penalty: f64) -> Result<Self, NoFit> {
        check(rows, 1)?;
        Self::fit(rows, &Standard::of(&rows.inputs)?, degree, penalty)
    }

    fn fit(rows: &Rows, standard: &Standard, degree: u32, penalty: f64) -> Result<Self, NoFit> {
        let powers = monomials_of(&standard.scale, degree).ok_or(NoFit::Degree { degree })?;
        let mut sums = Sums::new(powers.len());
        let mut monomials = [0.0; MOST_MONOMIALS];
        for (inputs, &value) in rows.inputs.iter().zip(&rows.values) {
            sums.add(standard.monomials(inputs, degree, &mut monomials), value);
        }
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
    /// # Panics
    /// If their number is not [`Self::inputs`].
    pub fn value(&self, inputs: &[f64]) -> f64 {
        assert_eq!(inputs.len(), self.centre.len(), "as many inputs as were fitted");
        // Searches ask millions of times: what is not needed is not cleared.
        if self.weights.len() <= SMALL {
            self.value_in::<SMALL>(inputs)
        } else {
            self.value_in::<MOST_MONOMIALS>(inputs)
        }
    }

    fn value_in<const N: usize>(&self, inputs: &[f64]) -> f64 {
        let mut buffer = [0.0; N];
        let monomials = monomials(inputs, &self.centre, &self.scale, &self.range, self.degree, &mut buffer);
        self.intercept + dot(&self.weights, monomials)
    }
}

fn standardised(x: f64, centre: f64, scale: f64, [least, greatest]: [f64; 2]) -> f64 {
    if scale > 0.0 { ((x - centre) / scale).clamp(least, greatest) } else { 0.0 }
}

/// All monomials of total degree 1 to `degree` in the standardised inputs, in the order of [`monomials_of`]. Those of one degree are,
/// input after input, the input times those of the degree before that have no earlier input: a run at the end of their block.
fn monomials<'m>(
    inputs: &[f64],
    centre: &[f64],
    scale: &[f64],
    range: &[[f64; 2]],
    degree: u32,
    out: &'m mut [f64],
) -> &'m [f64] {
    let mut count = 0;
    for i in (0..inputs.len()).filter(|&i| scale[i] > 0.0) {
        out[count] = standardised(inputs[i], centre[i], scale[i], range[i]);
        count += 1;
    }
    let mut starts = [0; MOST_INPUTS];
    (0..count).for_each(|i| starts[i] = i);
    let mut end = count;
    for _ in 1..degree {
        let (known, new) = out.split_at_mut(end);
        let mut length = 0;
        for i in 0..count {
            let z = known[i];
            let run = &known[starts[i]..];
            starts[i] = end + length;
            for (out, monomial) in new[length..].iter_mut().zip(run) {
                *out = z * monomial;
            }
            length += run.len();
        }
        end += length;
    }
    &out[..end]
}

/// a·b in eight sums, the same on every machine.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sum = 0.0;
    sum_of_products(Simd::Widest, a, b, &mut sum);
    sum
}

kernel! {
    fn sum_of_products(a: &[f64], b: &[f64], sum: &mut f64) {
        let mut lanes = [0.0; 8];
        let (a, b) = (a.chunks_exact(8), b.chunks_exact(8));
        let rest = a.remainder().iter().zip(b.remainder()).map(|(a, b)| a * b).sum::<f64>();
        for (a, b) in a.zip(b) {
            for lane in 0..8 {
                lanes[lane] += a[lane] * b[lane];
            }
        }
        *sum = lanes.iter().sum::<f64>() + rest;
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

    fn monomials<'m>(&self, inputs: &[f64], degree: u32, out: &'m mut [f64; MOST_MONOMIALS]) -> &'m [f64] {
        monomials(inputs, &self.centre, &self.scale, &self.range, degree, out)
    }
}

/// Powers of all monomials of total degree 1 to `degree` in the inputs that differ (`scale` above 0), lower degrees first and the first
/// input's higher powers first; `None` of more than 500.
pub fn monomials_of(scale: &[f64], degree: u32) -> Option<Vec<Vec<u32>>> {
    let mut all = Vec::new();
    for total in 1..=degree {
        let mut powers = vec![0; scale.len()];
        each(scale, total, 0, &mut powers, &mut all);
        if all.len() > MOST_MONOMIALS || total as usize > MOST_MONOMIALS {
            return None;
        }
    }
    Some(all)
}

fn each(scale: &[f64], left: u32, input: usize, powers: &mut Vec<u32>, all: &mut Vec<Vec<u32>>) {
    if left == 0 {
        all.push(powers.clone());
        return;
    }
    if input == scale.len() || all.len() > MOST_MONOMIALS {
        return;
    }
    let most = if scale[input] > 0.0 { left } else { 0 };
    for power in (0..=most).rev() {
        powers[input] = power;
        each(scale, left - power, input + 1, powers, all);
    }
    powers[input] = 0;
}

/// Sums over rows that a fit needs.
#[derive(Clone)]
struct Sums {
    count: f64,
    products: DMatrix<f64>,
    monomials: DVector<f64>,
    with_value: DVector<f64>,
    value: f64,
}

impl Sums {
    fn new(monomials: usize) -> Self {
        Self {
            count: 0.0,
            products: DMatrix::zeros(monomials, monomials),
            monomials: DVector::zeros(monomials),
            with_value: DVector::zeros(monomials),
            value: 0.0,
        }
    }

    fn add(&mut self, monomials: &[f64], value: f64) {
        self.count += 1.0;
        self.value += value;
        for (j, &b) in monomials.iter().enumerate() {
            self.monomials[j] += b;
            self.with_value[j] += b * value;
            // One triangle; the other follows when it is solved.
            for (i, &a) in monomials.iter().enumerate().skip(j) {
                self.products[(i, j)] += a * b;
            }
        }
    }

    fn without(&self, other: &Sums) -> Self {
        Self {
            count: self.count - other.count,
            products: &self.products - &other.products,
            monomials: &self.monomials - &other.monomials,
            with_value: &self.with_value - &other.with_value,
            value: self.value - other.value,
        }
    }

    /// Weights of plain monomials, and the intercept. Monomials are standardised on the way, so that one penalty fits all.
    fn solve(&self, penalty: f64) -> (Vec<f64>, f64) {
        let n = self.count;
        let mean = &self.monomials / n;
        let value = self.value / n;
        let size = mean.len();
        let variance = |j: usize| self.products[(j, j)] / n - mean[j] * mean[j];
        // A monomial that does not differ gets no weight.
        let inverse: Vec<f64> =
            (0..size).map(|j| if variance(j) > 1e-12 { 1.0 / libm::sqrt(variance(j)) } else { 0.0 }).collect();
        let mut matrix = DMatrix::zeros(size, size);
        let mut right = DVector::zeros(size);
        for j in 0..size {
            right[j] = (self.with_value[j] / n - mean[j] * value) * inverse[j];
            for i in j..size {
                let covariance = (self.products[(i, j)] / n - mean[i] * mean[j]) * inverse[i] * inverse[j];
                matrix[(i, j)] = covariance;
                matrix[(j, i)] = covariance;
            }
            matrix[(j, j)] += penalty;
        }
        // Positive definite but for rounding: the penalty is ten thousand times larger than that.
        let scaled = matrix.cholesky().map_or_else(|| DVector::zeros(size), |factor| factor.solve(&right));
        let weights: Vec<f64> = (0..size).map(|j| scaled[j] * inverse[j]).collect();
        let intercept = value - weights.iter().zip(mean.iter()).map(|(weight, mean)| weight * mean).sum::<f64>();
        (weights, intercept)
    }
}

/// Mean squared error of every penalty.
fn cross_validate(
    rows: &Rows,
    standard: &Standard,
    degree: u32,
    fold_of: &[usize],
    folds: usize,
) -> [f64; PENALTIES.len()] {
    let mut buffer = [0.0; MOST_MONOMIALS];
    let count = standard.monomials(&rows.inputs[0], degree, &mut buffer).len();
    let mut parts = vec![Sums::new(count); folds];
    for (row, inputs) in rows.inputs.iter().enumerate() {
        parts[fold_of[row]].add(standard.monomials(inputs, degree, &mut buffer), rows.values[row]);
    }
    let mut all = Sums::new(count);
    for part in &parts {
        all.count += part.count;
        all.products += &part.products;
        all.monomials += &part.monomials;
        all.with_value += &part.with_value;
        all.value += part.value;
    }
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::{stream, unit};

    fn rows(count: usize, noise: f64, seed: u64, truth: impl Fn(&[f64]) -> f64) -> Rows {
        let mut rng = stream(seed);
        let mut rows = Rows::default();
        for row in 0..count {
            let inputs = vec![10.0 * unit(&mut rng), 5.0 - unit(&mut rng), 1e4 + unit(&mut rng)];
            rows.values.push(truth(&inputs) + noise * (unit(&mut rng) - 0.5));
            rows.inputs.push(inputs);
            rows.groups.push(row / 5);
        }
        rows
    }

    #[test]
    fn a_polynomial_is_found_again() {
        let truth = |x: &[f64]| 3.0 - 2.0 * x[0] + 0.5 * x[0] * x[0] + 4.0 * (x[2] - 1e4) * x[1];
        let (fitted, validation) = PolynomialRidge::choose(&rows(400, 0.0, 1, truth), 4, 10).unwrap();
        assert!(validation.r2 > 1.0 - 1e-9, "{validation:?}");
        for inputs in [[1.0, 4.3, 1e4 + 0.5], [9.0, 4.9, 1e4 + 0.1]] {
            assert!((fitted.value(&inputs) - truth(&inputs)).abs() < 1e-3, "{}", fitted.value(&inputs));
        }
    }

    #[test]
    fn noise_is_not_explained_and_a_low_degree_wins() {
        let (fitted, validation) = PolynomialRidge::choose(&rows(400, 1.0, 2, |_| 0.0), 4, 10).unwrap();
        assert!(validation.r2 < 0.05, "{validation:?}");
        assert!(fitted.value(&[5.0, 4.5, 1e4]).abs() < 0.2);
        let (fitted, validation) = PolynomialRidge::choose(&rows(600, 1.0, 3, |x| x[0]), 4, 10).unwrap();
        assert_eq!(fitted.degree, 1, "{validation:?}");
        // Variance of x is 100/12, that of the noise 1/12.
        assert!((validation.r2 - (1.0 - 1.0 / 101.0)).abs() < 0.003, "{validation:?}");
    }

    #[test]
    fn weights_solve_the_normal_equations() {
        let rows = rows(50, 3.0, 4, |x| x[0] * x[1]);
        let penalty = 0.1;
        let fitted = PolynomialRidge::of(&rows, 1, penalty).unwrap();
        // Gradient of ‖y − b − Z w‖²/n + λ‖w‖² over standardised inputs, by hand.
        let n = rows.values.len() as f64;
        for input in 0..3 {
            let z = |row: usize| (rows.inputs[row][input] - fitted.centre[input]) / fitted.scale[input];
            let gradient: f64 = (0..50).map(|row| (fitted.value(&rows.inputs[row]) - rows.values[row]) * z(row)).sum();
            let place = fitted.powers.iter().position(|powers| powers[input] == 1).unwrap();
            assert!((gradient / n + penalty * fitted.weights[place]).abs() < 1e-9);
        }
    }

    #[test]
    fn monomials_are_products_by_their_powers() {
        let (centre, scale, range) = ([0.5, 9.0, 1.0, -2.0], [2.0, 0.0, 0.5, 3.0], [[-1.5, 1.5]; 4]);
        let inputs = [1.3, 4.0, 0.2, 11.0];
        let z: Vec<f64> = (0..4).map(|i| standardised(inputs[i], centre[i], scale[i], range[i])).collect();
        assert_eq!(z[3], 1.5);
        for degree in 1..=5 {
            let powers = monomials_of(&scale, degree).unwrap();
            let mut buffer = [0.0; MOST_MONOMIALS];
            let told = monomials(&inputs, &centre, &scale, &range, degree, &mut buffer);
            assert_eq!(told.len(), powers.len());
            for (told, powers) in told.iter().zip(&powers) {
                let product: f64 = z.iter().zip(powers).map(|(z, &power)| z.powi(power as i32)).product();
                assert!((told - product).abs() < 1e-12, "{powers:?}: {told}, {product}");
            }
        }
        assert!(monomials_of(&[1.0; 8], 4).is_some_and(|all| all.len() == 494) && monomials_of(&[1.0; 8], 5).is_none());
        assert!(monomials_of(&[0.0; 3], u32::MAX).is_none());
    }

    #[test]
    fn an_input_told_twice_is_taken_once() {
        let mut twice = rows(200, 0.0, 5, |x| x[0] * x[0] + x[1]);
        twice.inputs.iter_mut().for_each(|inputs| inputs.push(3.6 * inputs[0] - 1.0));
        let (fitted, _) = PolynomialRidge::choose(&twice, 3, 10).unwrap();
        assert_eq!(fitted.scale[3], 0.0);
        assert!(fitted.powers.iter().all(|powers| powers[3] == 0));
        // Nothing is told by what never differs, though its mean is a little beside it: 0.1 summed up 200 times is not 20.
        twice.inputs.iter_mut().for_each(|inputs| inputs.insert(0, 0.1));
        let (fitted, _) = PolynomialRidge::choose(&twice, 3, 10).unwrap();
        assert!(fitted.scale[0] == 0.0 && fitted.scale[4] == 0.0, "{:?}", fitted.scale);
        assert!(fitted.scale[1..4].iter().all(|scale| *scale > 0.0), "{:?}", fitted.scale);
        let again = PolynomialRidge::of(&twice, fitted.degree, fitted.penalty).unwrap();
        assert_eq!(again, fitted);
    }

    #[test]
    fn beyond_what_was_fitted_counts_as_at_the_edge() {
        let (fitted, _) = PolynomialRidge::choose(&rows(200, 0.0, 5, |x| x[0] * x[0]), 3, 10).unwrap();
        assert_eq!(fitted.value(&[1e6, 4.5, 1e4 + 0.5]), fitted.value(&[2e6, 4.5, 1e4 + 0.5]));
        assert!(fitted.value(&[1e6, 4.5, 1e4 + 0.5]) < 101.0);
    }

    #[test]
    fn what_cannot_be_fitted_is_told() {
        let good = rows(200, 0.0, 6, |x| x[0]);
        let few = Rows { groups: vec![7; 200], ..good.clone() };
        assert_eq!(PolynomialRidge::choose(&few, 3, 10), Err(NoFit::Groups { groups: 1, needed: 10 }));
        let mut broken = good.clone();
        broken.inputs[3][1] = f64::NAN;
        assert!(matches!(PolynomialRidge::choose(&broken, 3, 10), Err(NoFit::NotFinite { row: 3, .. })));
        let mut ragged = good.clone();
        ragged.inputs[5].pop();
        assert_eq!(PolynomialRidge::choose(&ragged, 3, 10), Err(NoFit::Ragged { row: 5, found: 2, expected: 3 }));
        let steep = PolynomialRidge::of(&good, 40, 0.1);
        assert_eq!(steep, Err(NoFit::Degree { degree: 40 }));
        let flat = Rows { inputs: vec![vec![1.0, 2.0]; 200], ..good };
        assert_eq!(PolynomialRidge::choose(&flat, 3, 10), Err(NoFit::Constant));
    }
}
