//! Levenberg and Marquardt's descent of the composite likelihood within bounds.

use nalgebra::DMatrix;

use super::objective::{Objective, Value};

/// Turns at most.
const TURNS: usize = 25;
/// Damping at first, and at most: beyond it no step is found.
const DAMPING: f64 = 1e-3;
const MOST_DAMPING: f64 = 1e4;
/// Q that a turn must win for another one: far below the rise that an interval is told by.
const LEAST_GAIN: f64 = 0.1;
/// Turns at most where derivatives stay as they are.
const CHORDS: usize = 4;

/// Where a descent ended.
#[derive(Debug, Clone)]
pub struct Descent {
    /// The parameters.
    pub theta: Vec<f64>,
    /// Q there.
    pub q: f64,
    pub(super) value: Value,
}

/// The minimum of Q over the parameters `free` that is met from `start`, the others as they are there; `None` where
/// there is no simulation at the start.
///
/// (H + λ diag H) δ = g, each δ cut to the bounds; λ falls by 10 where Q does and rises by 10 where it does not
/// (Marquardt 1963). A parameter at a bound that the gradient pushes against is left out of the turn.
///
/// At most 25 turns, each a derivative of 2 simulations a parameter and one simulation for each try of λ (1e-9 … 1e4).
/// Ends where a turn wins less than 0.1 of Q. A local minimum: who wants another starts elsewhere.
pub fn descend(objective: &Objective, start: &[f64], free: &[usize]) -> Option<Descent> {
    let mut theta: Vec<f64> = start.iter().zip(&objective.parameters).map(|(x, p)| x.clamp(p.low, p.high)).collect();
    let mut value = objective.at(&theta)?;
    let mut damping = DAMPING;
    for _ in 0..TURNS {
        let Some(jacobian) = objective.jacobian(&theta, free) else { break };
        let (h, g) = objective.normal_equations(&value, &jacobian, 0..objective.blocks());
        let before = value.q;
        while damping <= MOST_DAMPING {
            let there = step(objective, &theta, free, (&h, &g), damping);
            match there.as_deref().and_then(|there| objective.at(there)) {
                Some(lower) if lower.q < value.q => {
                    (theta, value) = (there.unwrap_or_default(), lower);
                    damping = (damping * 0.1).max(1e-9);
                    break;
                }
                _ => damping *= 10.0,
            }
        }
        if before - value.q < LEAST_GAIN {
            break;
        }
    }
    Some(Descent { theta, q: value.q, value })
}

/// The same in few turns with the derivatives `jacobian`, a column for each of `free`, which were taken nearby: a
/// simulation a turn. Where that ends Q is an upper bound of its minimum.
///
/// At most 5 simulations, one of them at the start.
pub(super) fn settle(objective: &Objective, start: &[f64], free: &[usize], jacobian: &DMatrix<f64>) -> Option<Descent> {
    let mut theta: Vec<f64> = start.iter().zip(&objective.parameters).map(|(x, p)| x.clamp(p.low, p.high)).collect();
    let mut value = objective.at(&theta)?;
    for _ in 0..CHORDS {
        let (h, g) = objective.normal_equations(&value, jacobian, 0..objective.blocks());
        let there = step(objective, &theta, free, (&h, &g), DAMPING);
        let Some((there, lower)) = there.and_then(|there| objective.at(&there).map(|lower| (there, lower))) else {
            break;
        };
        if lower.q >= value.q {
            break;
        }
        let gain = value.q - lower.q;
        (theta, value) = (there, lower);
        if gain < LEAST_GAIN {
            break;
        }
    }
    Some(Descent { theta, q: value.q, value })
}

/// The damped step from `theta`; `None` where there is none.
///
/// The sign: g = Σ w J r with J = ∂f/∂θ, so that θ + δ descends. Cut entry by entry, which may turn the step but keeps
/// every bound. `None` also where nothing moves.
fn step(
    objective: &Objective,
    theta: &[f64],
    free: &[usize],
    (h, g): (&DMatrix<f64>, &nalgebra::DVector<f64>),
    damping: f64,
) -> Option<Vec<f64>> {
    let blocked = |at: usize| {
        let (p, x) = (objective.parameters[free[at]], theta[free[at]]);
        h[(at, at)] <= 0.0 || (x <= p.low && g[at] < 0.0) || (x >= p.high && g[at] > 0.0)
    };
    let moving: Vec<usize> = (0..free.len()).filter(|&at| !blocked(at)).collect();
    let size = moving.len();
    let damped = DMatrix::from_fn(size, size, |a, b| {
        let entry = h[(moving[a], moving[b])];
        if a == b { entry * (1.0 + damping) } else { entry }
    });
    let gradient = nalgebra::DVector::from_fn(size, |a, _| g[moving[a]]);
    let delta = damped.cholesky()?.solve(&gradient);
    let mut there = theta.to_vec();
    for (a, &at) in moving.iter().enumerate() {
        let p = objective.parameters[free[at]];
        there[free[at]] = (theta[free[at]] + delta[a]).clamp(p.low, p.high);
    }
    (there != theta).then_some(there)
}
