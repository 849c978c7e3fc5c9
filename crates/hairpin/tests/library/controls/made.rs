//! Goals that are feasible by construction: where curves end that keep the bounds.

use std::f64::consts::TAU;

use hairpin::feasibility::steering::shooting::families::Problem;
use hairpin::feasibility::steering::shooting::{Curvatures, Goal, Query};
use hairpin::math::random::Stream;
use hairpin::trajectory::SpeedProfile;
use rand::RngExt;

pub(crate) const BOUNDS: Curvatures = Curvatures { most: 1.0, most_rate: 1.0 };

/// A curve: κ over the share of its metres, κ at the ends exactly, metres.
pub(crate) struct Made {
    pub(crate) curvature: Vec<f64>,
    pub(crate) length: f64,
}

const SAMPLES: usize = 4001;

impl Made {
    /// κ = `shape` over the share σ of the metres, scaled so that the bounds hold with some room.
    pub(crate) fn new(random: &mut Stream, length: f64, shape: impl Fn(f64) -> f64) -> Self {
        let raw: Vec<f64> = (0..SAMPLES).map(|i| shape(i as f64 / (SAMPLES - 1) as f64)).collect();
        let h = length / (SAMPLES - 1) as f64;
        let rate = raw.windows(2).map(|pair| (pair[1] - pair[0]).abs() / h).fold(0.0, f64::max);
        let sharpest = raw.iter().map(|k| k.abs()).fold(rate, f64::max) * 1.002;
        let scale = random.random_range(0.4..1.0) / sharpest;
        Self { curvature: raw.iter().map(|k| k * scale).collect(), length }
    }

    /// Where it ends, x, y, ψ, with a direction of travel that turns evenly from 0 to `swing`: Simpson's rule.
    pub(crate) fn end(&self, swing: f64) -> [f64; 3] {
        let h = 2.0 * self.length / (SAMPLES - 1) as f64;
        let [mut x, mut y, mut yaw] = [0.0; 3];
        for (i, k) in self.curvature.windows(3).step_by(2).enumerate() {
            let s = i as f64 * h;
            let way = |s: f64| swing * s / self.length;
            let middle = yaw + h / 24.0 * (5.0 * k[0] + 8.0 * k[1] - k[2]);
            let last = yaw + h / 6.0 * (k[0] + 4.0 * k[1] + k[2]);
            let at = [yaw + way(s), middle + way(s + 0.5 * h), last + way(s + h)];
            x += h / 6.0 * (at[0].cos() + 4.0 * at[1].cos() + at[2].cos());
            y += h / 6.0 * (at[0].sin() + 4.0 * at[1].sin() + at[2].sin());
            yaw = last;
        }
        [x, y, yaw]
    }

    pub(crate) fn problem(&self, speed: SpeedProfile, swing: f64) -> Problem {
        let [x, y, yaw] = self.end(swing);
        let goal = Goal { x, y, yaw: yaw.rem_euclid(TAU), curvature: self.curvature[SAMPLES - 1] };
        let query = Query::new(self.curvature[0], goal, &BOUNDS).unwrap();
        Problem { query, speed, swing, free_end: false }
    }
}

/// A sum of Chebyshev polynomials up to `order`, of u in [0, 1].
pub(crate) fn polynomial(random: &mut Stream, order: usize) -> impl Fn(f64) -> f64 + use<> {
    let a: Vec<f64> = (0..=order).map(|_| random.random_range(-1.0..1.0)).collect();
    move |u: f64| {
        let angle = (2.0 * u - 1.0).clamp(-1.0, 1.0).acos();
        a.iter().enumerate().map(|(k, a)| a * (k as f64 * angle).cos()).sum()
    }
}

/// The natural cubic spline through `y` at even places of [0, 1], by dense elimination of its bends.
pub(crate) fn spline(y: &[f64]) -> impl Fn(f64) -> f64 + use<> {
    let n = y.len() - 1;
    let h = 1.0 / n as f64;
    let mut rows = vec![vec![0.0; n + 2]; n + 1];
    (rows[0][0], rows[n][n]) = (1.0, 1.0);
    for k in 1..n {
        (rows[k][k - 1], rows[k][k], rows[k][k + 1]) = (1.0, 4.0, 1.0);
        rows[k][n + 1] = 6.0 * (y[k - 1] - 2.0 * y[k] + y[k + 1]) / (h * h);
    }
    for k in 0..=n {
        for other in 0..=n {
            if other != k {
                let (factor, lead) = (rows[other][k] / rows[k][k], rows[k].clone());
                rows[other].iter_mut().zip(&lead).for_each(|(value, lead)| *value -= factor * lead);
            }
        }
    }
    let bends: Vec<f64> = (0..=n).map(|k| rows[k][n + 1] / rows[k][k]).collect();
    let y = y.to_vec();
    move |u| {
        let k = ((u / h) as usize).min(n - 1);
        let (right, left) = (u / h - k as f64, k as f64 + 1.0 - u / h);
        let bent = |t: f64, m: f64| (t.powi(3) - t) * h * h / 6.0 * m;
        left * y[k] + right * y[k + 1] + bent(left, bends[k]) + bent(right, bends[k + 1])
    }
}

/// The share of the time at a share of the metres where v² = v0² + (vf² − v0²) σ.
pub(crate) fn time_share(start: f64, end: f64) -> impl Fn(f64) -> f64 {
    move |share| share * (start + end) / (start + f64::sqrt(start * start + (end * end - start * start) * share))
}
