//! Parameters of a simulation with chance in it, whose signs lie nearest to those of what was observed.
//!
//! ```text
//! s ∈ ℝᵐ         signs of what was observed: regressions, variances, whatever tells of the parameters
//! s_k(θ)         the same signs of draw k of the simulation, k = 0 … N − 1
//! μ(θ), Σ(θ)     their mean and covariance over draws
//! D(θ) = (s − μ(θ))ᵀ Σ⁻¹ (s − μ(θ))
//! ```
//!
//! A loop that swings ends in another swing after every disturbance, so that its motion cannot be held against a log
//! sample by sample; its signs can (synthetic likelihood: Wood, Nature 466, 2010). Signs may be as biased as they like,
//! as regressions in a closed loop are: those of simulations are so alike (indirect inference: Smith, J. Appl.
//! Econometrics 8, 1993; Gouriéroux, Monfort and Renault, same volume).
//!
//! D is descended by Gauss and Newton, damped, with draws that are common to all θ and slopes G = ∂μ/∂θ that are kept
//! up by Broyden's rank-one steps; from where that ends by clouds of N draws, s_k = μ + G (θ_k − θ) + ε_k
//! ([`Imitation::told`]; regression adjustment: Beaumont, Zhang and Balding, Genetics 162, 2002). At the end, with
//! W = Σ⁻¹ of ε,
//!
//! ```text
//! C = (N − 1)/(N − m − 2) · max(1, D/(m − p)) · (Gᵀ W G)⁻¹          p parameters
//! ```
//!
//! the first factor for what Σ⁻¹ of N draws is too large by (Hartlap, Simon and Schneider, A&A 464, 2007), the second
//! where the simulation does not show what was observed (Birge, Phys. Rev. 40, 1932).

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::output_error::Parameter;
use super::power::square;
use super::random::{named_seed, stream, unit};

/// Signs of the draw of a number with these parameters; `None` where nothing came of it.
///
/// Always of one length, in one order.
pub type Signs<'a> = dyn Fn(&[f64], u64) -> Option<Vec<f64>> + Sync + 'a;

/// What is imitated, and by what.
pub struct Imitation<'a> {
    /// See [`Signs`].
    pub signs: &'a Signs<'a>,
    /// Of what was observed.
    pub observed: Vec<f64>,
    /// The parameters; differences are taken over their steps.
    pub parameters: Vec<Parameter>,
}

/// Where signs are nearest, and how far that can be told.
#[derive(Debug, Clone)]
pub struct Imitated {
    /// The parameters.
    pub theta: Vec<f64>,
    /// Those that act, rising.
    pub free: Vec<usize>,
    /// C of these, in their order.
    pub covariance: DMatrix<f64>,
    /// D over its degrees of freedom: about 1 where the simulation shows what was observed.
    pub misfit: f64,
    /// Degrees of freedom of C.
    pub freedom: f64,
}

/// Draws of Σ in a descent, of differences, of slopes, of a first look, and of a cloud.
const DRAWS: u64 = 40;
const FEW: u64 = 8;
const SLOPES: u64 = 4;
const LOOKS: u64 = 6;
const CLOUD: u64 = 240;
/// Clouds at most, and how far θ moves where it rests, in deviations.
const TURNS: u64 = 5;
const RESTS: f64 = 0.3;
/// The first draw of those that no descent has seen.
const UNSEEN: u64 = 1000;
/// Share of the correlations that few draws are not believed of.
///
/// Of the covariance of a centre's 40 draws, and of a cloud's 240.
const SHRUNK: [f64; 2] = [0.1, 0.05];
/// A start's signs that are farther off than the root of this, in deviations, count as so far.
const FARTHEST: f64 = 50.0;
/// Starts that are descended from, rounds of each, and of the best one.
const BEST: usize = 3;
const ROUNDS: [usize; 2] = [2, 2];
/// Steps within a round, and the farthest of each, in steps of differences.
const STEPS: usize = 4;
const REACH: f64 = 7.0;
/// Damping at first and at most.
const DAMPING: [f64; 2] = [1e-2, 1e2];
/// D that a round must win.
const GAIN: f64 = 1.0;

/// A place, and what stands around it: the mean of signs, weights, and few draws that others are compared with.
///
/// `mean` has m entries, `weights` m × m; `few` are the first 8 draws, whose numbers every other place is asked with.
struct Centre {
    theta: Vec<f64>,
    mean: DVector<f64>,
    weights: DMatrix<f64>,
    few: Vec<Option<Vec<f64>>>,
}

/// What a cloud says of the signs at its middle.
///
/// m × p, in units of a sign by a parameter.
struct Cloud {
    mean: DVector<f64>,
    /// G of all its parameters.
    slopes: DMatrix<f64>,
    weights: DMatrix<f64>,
    /// Variance of each parameter's slopes, of a sign that scatters by 1.
    scatter: Vec<f64>,
    /// Draws that came to something, less one for each of its parameters: one more than Σ has degrees of freedom.
    draws: f64,
}

/// Where a descent has come to.
///
/// `slopes` has a column for each of the free parameters, in their order.
struct Descent {
    theta: Vec<f64>,
    slopes: DMatrix<f64>,
    /// D.
    reached: f64,
}

impl Imitation<'_> {
    /// Few draws at each of `starts` say from which to descend in the parameters `free`; the nearest of what these come
    /// to. `None` where no simulation comes of any, or no parameter acts.
    ///
    /// Cost: 6 draws a start; for each of the three best a slope of 4 draws at both sides of each parameter, two rounds
    /// of 40 draws and a few tries of 8; two more rounds from the nearest. Draws run in parallel; the answer does not
    /// depend on it.
    pub fn nearest(&self, starts: &[Vec<f64>], free: &[usize]) -> Option<Vec<f64>> {
        let mut looked: Vec<(f64, &Vec<f64>)> =
            starts.iter().filter_map(|start| Some((self.look(start)?, start))).collect();
        looked.sort_by(|(a, _), (b, _)| a.total_cmp(b));
        let begun = |(_, start): &(f64, &Vec<f64>)| {
            let slopes = self.slopes(start, free, SLOPES)?;
            self.descend(start, free, slopes, ROUNDS[0])
        };
        let ended = looked.iter().take(BEST).filter_map(begun);
        let nearest = ended.min_by(|a, b| a.reached.total_cmp(&b.reached))?;
        self.descend(&nearest.theta, free, nearest.slopes, ROUNDS[1]).map(|descent| descent.theta)
    }

    /// On from `theta` by clouds, and the spread where that ends; of those of the parameters `all` of which a change by
    /// `by` moves the signs by `least` at least in D.
    ///
    /// A cloud is of draws that no descent has seen, each at a place of its own around θ: a linear regression of their
    /// signs on their places says μ, G and Σ at once, and from these the next θ follows. Where loops swing, draws that
    /// are common to two places are as far apart as any.
    ///
    /// At most five clouds of 240 draws. It rests where no parameter moves by more than 0.3 of its deviation. `free`
    /// are the parameters whose change moves the signs by more than chance makes of it; the others have neither slope
    /// nor covariance. `None` where more than a quarter of a cloud's draws fail, or a matrix cannot be factorised.
    pub fn told(&self, theta: &[f64], all: &[usize], by: &dyn Fn(usize) -> f64, least: f64) -> Option<Imitated> {
        let mut theta = theta.to_vec();
        let mut widths: Vec<f64> = all.iter().map(|own| 2.0 * self.parameters[*own].step).collect();
        for turn in 1.. {
            let Cloud { mean, slopes, weights, scatter, draws } = self.cloud(&theta, all, &widths, turn)?;
            let signs = self.observed.len() as f64;
            let acts = |at: &usize| {
                let by = by(all[*at]);
                let moved = slopes.column(*at) * by;
                // Twice what chance alone makes of it.
                moved.dot(&(&weights * &moved)) >= least + 2.0 * signs * by * by * scatter[*at]
            };
            let acting: Vec<usize> = (0..all.len()).filter(acts).collect();
            let free: Vec<usize> = acting.iter().map(|at| all[*at]).collect();
            let slopes = slopes.select_columns(&acting);
            let off = DVector::from_column_slice(&self.observed) - &mean;
            let there = self.step(&theta, &free, (&slopes, &weights, &off), 0.0).unwrap_or_else(|| theta.clone());
            let moved = DVector::from_fn(free.len(), |a, _| there[free[a]] - theta[free[a]]);
            let left = off - &slopes * &moved;
            let found = self.spread(there, free, (&slopes, &weights, draws), left.dot(&(&weights * &left)))?;
            let deviation = |a: usize| found.covariance[(a, a)].sqrt();
            let rests = (0..moved.len()).all(|a| moved[a].abs() <= RESTS * deviation(a));
            if rests || turn == TURNS {
                return Some(found);
            }
            for (a, at) in acting.iter().enumerate() {
                let step = self.parameters[all[*at]].step;
                widths[*at] = (2.0 * deviation(a)).clamp(0.3 * step, 4.0 * step);
            }
            theta = found.theta;
        }
        None
    }

    /// See [`Self::told`]: draws at places that are off by up to `widths` and a half times that.
    ///
    /// ```text
    /// s_k = μ + Σ_j g_j (θ_kj − θ_j) + ε_k,   θ_kj uniform within ± 1.5 width_j, cut to the bounds
    /// (μ, g) by least squares,   Σ = Σ_k ε_k ε_kᵀ/(n − p − 1)
    /// ```
    fn cloud(&self, theta: &[f64], all: &[usize], widths: &[f64], turn: u64) -> Option<Cloud> {
        let draw = |number: u64| {
            let mut random = stream(named_seed(turn, "cloud", number));
            let (mut there, mut row) = (theta.to_vec(), vec![1.0]);
            for (own, width) in all.iter().zip(widths) {
                let Parameter { low, high, .. } = self.parameters[*own];
                there[*own] = (theta[*own] + 1.5 * width * (2.0 * unit(&mut random) - 1.0)).clamp(low, high);
                row.push((there[*own] - theta[*own]) / width);
            }
            (self.signs)(&there, UNSEEN * turn + number).map(|signs| (row, signs))
        };
        let drawn: Vec<_> = (0..CLOUD).into_par_iter().filter_map(draw).collect();
        if 4 * drawn.len() < 3 * CLOUD as usize {
            return None;
        }
        let (n, m, p) = (drawn.len(), self.observed.len(), all.len());
        let places = DMatrix::from_fn(n, p + 1, |i, k| drawn[i].0[k]);
        let signs = DMatrix::from_fn(n, m, |i, j| drawn[i].1[j]);
        // Where a bound leaves a parameter no place but one it has no slope.
        let normal = places.transpose() * &places + DMatrix::identity(p + 1, p + 1) * 1e-9;
        let normal = normal.cholesky()?;
        let all_slopes = normal.solve(&(places.transpose() * &signs));
        let left = &signs - &places * &all_slopes;
        let covariance = left.transpose() * &left / (n - p - 1) as f64;
        let slopes = DMatrix::from_fn(m, p, |j, k| all_slopes[(k + 1, j)] / widths[k]);
        let inverted = normal.inverse();
        let scatter = (0..p).map(|k| inverted[(k + 1, k + 1)] / (widths[k] * widths[k])).collect();
        let (mean, weights) = (all_slopes.row(0).transpose(), inverse(&covariance, SHRUNK[1])?);
        Some(Cloud { mean, slopes, weights, scatter, draws: (n - p) as f64 })
    }

    /// C with these slopes and weights, Σ⁻¹ of `n` draws, where D is `misfit`.
    ///
    /// ```text
    /// C = (n − 1)/(n − m − 2) · max(1, D/(m − p)) · (Gᵀ W G)⁻¹,   m the signs that have a weight
    /// ```
    ///
    /// Inverted with unit diagonal, so that parameters of different units do not spoil it. The freedom told is n − m.
    fn spread(
        &self,
        theta: Vec<f64>,
        free: Vec<usize>,
        (slopes, weights, n): (&DMatrix<f64>, &DMatrix<f64>, f64),
        misfit: f64,
    ) -> Option<Imitated> {
        let known = weights.diagonal().iter().filter(|weight| **weight > 0.0).count();
        let (m, p) = (known as f64, free.len() as f64);
        let curvature = slopes.transpose() * weights * slopes;
        let scale = curvature.diagonal().map(|c| c.sqrt().recip());
        let scaled = DMatrix::from_fn(free.len(), free.len(), |a, b| curvature[(a, b)] * scale[a] * scale[b]);
        let ridge = DMatrix::identity(free.len(), free.len()) * 1e-9;
        let inverse = (scaled + ridge).cholesky()?.inverse();
        let misfit = misfit / (m - p).max(1.0);
        let factor = (n - 1.0) / (n - m - 2.0).max(1.0) * misfit.max(1.0);
        let covariance =
            DMatrix::from_fn(free.len(), free.len(), |a, b| factor * inverse[(a, b)] * scale[a] * scale[b]);
        Some(Imitated { theta, free, covariance, misfit, freedom: n - m })
    }

    fn draws(&self, theta: &[f64], which: std::ops::Range<u64>) -> Vec<Option<Vec<f64>>> {
        which.into_par_iter().map(|draw| (self.signs)(theta, draw)).collect()
    }

    /// How far signs at `theta` are off, each by its own deviation.
    ///
    /// Σ over signs of min(50, (s − μ)²/σ²); correlations are left out, as 6 draws say nothing of them.
    fn look(&self, theta: &[f64]) -> Option<f64> {
        let draws = most(self.draws(theta, 0..LOOKS))?;
        let (mean, covariance) = moments(&draws);
        let off = |(i, s): (usize, &f64)| {
            let (square, variance) = ((s - mean[i]) * (s - mean[i]), covariance[(i, i)]);
            if variance > 0.0 { (square / variance).min(FARTHEST) } else { 0.0 }
        };
        Some(self.observed.iter().enumerate().map(off).sum())
    }

    /// 40 draws.
    fn centre(&self, theta: &[f64]) -> Option<Centre> {
        let draws = self.draws(theta, 0..DRAWS);
        let few = draws[..FEW as usize].to_vec();
        let (mean, covariance) = moments(&most(draws)?);
        Some(Centre { theta: theta.to_vec(), mean, weights: inverse(&covariance, SHRUNK[0])?, few })
    }

    /// ∂μ/∂θ by the parameters `free`, central differences of common draws, one-sided at bounds.
    fn slopes(&self, theta: &[f64], free: &[usize], draws: u64) -> Option<DMatrix<f64>> {
        let column = |&k: &usize| {
            let Parameter { low, high, step } = self.parameters[k];
            let moved = |by: f64| {
                let mut there = theta.to_vec();
                there[k] = (theta[k] + by).clamp(low, high);
                (there[k], self.draws(&there, 0..draws))
            };
            let ((ahead, after), (behind, before)) = (moved(step), moved(-step));
            Some(change(&before, &after)? / (ahead - behind))
        };
        let columns = free.par_iter().map(column).collect::<Option<Vec<_>>>()?;
        Some(DMatrix::from_columns(&columns))
    }

    /// Where a descent of at most so many rounds ends: Σ anew each round, slopes anew where one wins little.
    ///
    /// A round that wins less than 1 of D has the slopes taken anew; after two of them in a row it ends.
    fn descend(&self, start: &[f64], free: &[usize], slopes: DMatrix<f64>, rounds: usize) -> Option<Descent> {
        let theta = start.iter().zip(&self.parameters).map(|(x, p)| x.clamp(p.low, p.high)).collect();
        let mut descent = Descent { theta, slopes, reached: f64::INFINITY };
        let (mut damping, mut idle) = (DAMPING[0], 0);
        for _ in 0..rounds {
            let mut centre = self.centre(&descent.theta)?;
            if idle > 0 {
                descent.slopes = self.slopes(&descent.theta, free, SLOPES)?;
            }
            let (before, after) = self.round(&mut centre, free, &mut descent.slopes, &mut damping);
            (descent.theta, descent.reached) = (centre.theta, after);
            idle = if before - after < GAIN { idle + 1 } else { 0 };
            if idle > 1 {
                break;
            }
        }
        Some(descent)
    }

    /// Steps with one Σ; D before and after them.
    ///
    /// D is followed by the mean change of 8 common draws from one place to the other, which takes most of chance out
    /// of it. A step that does not come nearer multiplies the damping by 10, one that does divides it by 10.
    fn round(&self, centre: &mut Centre, free: &[usize], slopes: &mut DMatrix<f64>, damping: &mut f64) -> (f64, f64) {
        let mut off = DVector::from_column_slice(&self.observed) - &centre.mean;
        let weighed = |off: &DVector<f64>, weights: &DMatrix<f64>| off.dot(&(weights * off));
        let before = weighed(&off, &centre.weights);
        let (mut now, mut taken) = (before, 0);
        while *damping < DAMPING[1] && taken < STEPS {
            let there = self.step(&centre.theta, free, (slopes, &centre.weights, &off), *damping);
            let drawn = there.map(|there| (self.draws(&there, 0..FEW), there));
            let Some((few, there, change)) =
                drawn.and_then(|(few, there)| change(&centre.few, &few).map(|change| (few, there, change)))
            else {
                *damping *= 10.0;
                continue;
            };
            self.keep_up(slopes, free, (&centre.theta, &there), &change);
            let nearer = &off - change;
            let found = weighed(&nearer, &centre.weights);
            if found >= now {
                *damping *= 10.0;
                continue;
            }
            let gain = now - found;
            (now, off, centre.theta, centre.few) = (found, nearer, there, few);
            (*damping, taken) = ((*damping * 0.1).max(1e-6), taken + 1);
            if gain < 0.1 * before {
                break;
            }
        }
        if *damping >= DAMPING[1] {
            *damping = DAMPING[0];
        }
        (before, now)
    }

    /// Broyden's: the least change, in units of the parameters' steps, by which slopes say what was seen.
    fn keep_up(&self, slopes: &mut DMatrix<f64>, free: &[usize], (from, to): (&[f64], &[f64]), change: &DVector<f64>) {
        let moved = DVector::from_fn(free.len(), |a, _| to[free[a]] - from[free[a]]);
        let unit = DVector::from_fn(free.len(), |a, _| moved[a] / square(self.parameters[free[a]].step));
        let squared = moved.dot(&unit);
        if squared > 1e-12 {
            *slopes += (change - &*slopes * &moved) * unit.transpose() / squared;
        }
    }

    /// (GᵀWG + λ diag) δ = GᵀW(s − μ) within bounds and [`REACH`]; `None` where there is no step.
    fn step(
        &self,
        theta: &[f64],
        free: &[usize],
        (slopes, weights, off): (&DMatrix<f64>, &DMatrix<f64>, &DVector<f64>),
        damping: f64,
    ) -> Option<Vec<f64>> {
        let weighed = slopes.transpose() * weights;
        let (curvature, gradient) = (&weighed * slopes, weighed * off);
        let blocked = |a: usize| {
            let (p, x) = (self.parameters[free[a]], theta[free[a]]);
            curvature[(a, a)] <= 0.0 || (x <= p.low && gradient[a] < 0.0) || (x >= p.high && gradient[a] > 0.0)
        };
        let moving: Vec<usize> = (0..free.len()).filter(|&a| !blocked(a)).collect();
        let scale: Vec<f64> = moving.iter().map(|&a| curvature[(a, a)].sqrt().recip()).collect();
        let scaled = DMatrix::from_fn(moving.len(), moving.len(), |a, b| {
            let entry = curvature[(moving[a], moving[b])] * scale[a] * scale[b];
            if a == b { 1.0 + damping + 1e-9 } else { entry }
        });
        let right = DVector::from_fn(moving.len(), |a, _| gradient[moving[a]] * scale[a]);
        let delta = scaled.cholesky()?.solve(&right);
        let mut there = theta.to_vec();
        for (a, &at) in moving.iter().enumerate() {
            let (p, own) = (self.parameters[free[at]], free[at]);
            let most = REACH * p.step;
            there[own] = (theta[own] + (delta[a] * scale[a]).clamp(-most, most)).clamp(p.low, p.high);
        }
        (there != theta).then_some(there)
    }
}

/// Those draws that came to something, if three of four did.
fn most(draws: Vec<Option<Vec<f64>>>) -> Option<Vec<Vec<f64>>> {
    let all = draws.len();
    let some: Vec<Vec<f64>> = draws.into_iter().flatten().collect();
    (4 * some.len() >= 3 * all).then_some(some)
}

/// Mean of the differences of draws that came to something both times.
fn change(before: &[Option<Vec<f64>>], after: &[Option<Vec<f64>>]) -> Option<DVector<f64>> {
    let both = before.iter().zip(after).filter_map(|(a, b)| Some((a.as_ref()?, b.as_ref()?)));
    let differences: Vec<DVector<f64>> =
        both.map(|(a, b)| DVector::from_iterator(a.len(), a.iter().zip(b).map(|(a, b)| b - a))).collect();
    if 2 * differences.len() < before.len() {
        return None;
    }
    let count = differences.len() as f64;
    differences.into_iter().reduce(|sum, one| sum + one).map(|sum| sum / count)
}

/// Mean and covariance.
fn moments(draws: &[Vec<f64>]) -> (DVector<f64>, DMatrix<f64>) {
    let (count, m) = (draws.len() as f64, draws[0].len());
    let mut mean = DVector::zeros(m);
    draws.iter().for_each(|draw| mean += DVector::from_column_slice(draw) / count);
    let mut covariance = DMatrix::zeros(m, m);
    for draw in draws {
        let off = DVector::from_column_slice(draw) - &mean;
        covariance.ger(1.0 / (count - 1.0), &off, &off, 1.0);
    }
    (mean, covariance)
}

/// The inverse of a covariance whose correlations are believed but for a share of them; 0 for signs that no draw moves.
fn inverse(covariance: &DMatrix<f64>, shrunk: f64) -> Option<DMatrix<f64>> {
    let m = covariance.nrows();
    let known: Vec<usize> = (0..m).filter(|&i| covariance[(i, i)] > 1e-24).collect();
    let deviation: Vec<f64> = known.iter().map(|&i| covariance[(i, i)].sqrt()).collect();
    let correlations = DMatrix::from_fn(known.len(), known.len(), |a, b| {
        if a == b { 1.0 } else { (1.0 - shrunk) * covariance[(known[a], known[b])] / (deviation[a] * deviation[b]) }
    });
    let inverse = correlations.cholesky()?.inverse();
    let mut all = DMatrix::zeros(m, m);
    for (a, &i) in known.iter().enumerate() {
        for (b, &j) in known.iter().enumerate() {
            all[(i, j)] = inverse[(a, b)] / (deviation[a] * deviation[b]);
        }
    }
    Some(all)
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;
    use crate::math::random::standard_normals;

    /// An AR(1) process seen through noise, of which least squares make too little memory: mean, variance and two
    /// covariances of 400 samples.
    fn signs(theta: &[f64], draw: u64) -> Option<Vec<f64>> {
        let [memory, level] = [theta[0], theta[1]];
        let mut random = stream(draw);
        let mut x = 0.0;
        let y: Vec<f64> = (0..400)
            .map(|_| {
                let [drive, noise] = standard_normals(&mut random);
                x = memory * x + drive;
                level + x + noise
            })
            .collect();
        let mean = y.iter().sum::<f64>() / 400.0;
        let at = |lag: usize| y.iter().zip(&y[lag..]).map(|(a, b)| (a - mean) * (b - mean)).sum::<f64>() / 400.0;
        // The last one is the same for all draws.
        Some(vec![mean, libm::log(at(0)), at(1) / at(0), at(2) / at(1), theta[2] * 0.0 + 1.0])
    }

    fn parameters() -> Vec<Parameter> {
        [(-0.95, 0.95, 0.02), (-9.0, 9.0, 0.2), (0.0, 1.0, 0.02)]
            .map(|(low, high, step)| Parameter { low, high, step })
            .to_vec()
    }

    #[test]
    fn what_regressions_are_biased_by_does_not_bias_it_and_its_intervals_hold() {
        let (mut held, draws) = ([0; 2], 40);
        for draw in 0..draws {
            let truth = [0.5 + 0.01 * draw as f64, 1.0, 0.5];
            let observed = signs(&truth, 77_000 + draw).unwrap();
            let imitation = Imitation { signs: &signs, observed, parameters: parameters() };
            let starts = [vec![0.0, 0.0, 0.5], vec![0.8, 0.0, 0.5]];
            let found = imitation.nearest(&starts, &[0, 1]).unwrap();
            let told = imitation.told(&found, &[0, 1, 2], &|k| [0.2, 1.0, 0.2][k], 0.5).unwrap();
            assert_eq!(told.free, [0, 1]);
            for k in 0..2 {
                held[k] += u32::from((told.theta[k] - truth[k]).abs() <= 2.0 * told.covariance[(k, k)].sqrt());
            }
            // Through noise that is nearly as large as the process the first correlation is not its memory.
            assert!((told.theta[0] - truth[0]).abs() < 0.25, "{told:?}");
        }
        assert!(held.iter().all(|held| *held >= 36), "{held:?}");
    }

    #[test]
    fn what_nobody_simulates_is_not_found() {
        let nothing = |_: &[f64], _: u64| None;
        let imitation = Imitation { signs: &nothing, observed: vec![0.0; 5], parameters: parameters() };
        assert!(imitation.nearest(&[vec![0.0, 0.0, 0.5]], &[0]).is_none());
    }
}
