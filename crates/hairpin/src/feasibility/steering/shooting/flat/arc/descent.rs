//! Fits an arc to both ends under bounds: sequential quadratic programming in four unknowns.
//!
//! Why a penalty and not active bounds: a curve between its start value and its goal may have to pass beyond a bound,
//! and which samples are active changes from step to step. At the end bounds are narrowed by a little and proven, so
//! that softness does not matter.

use super::super::ends::{Ends, KEPT};
use super::super::task::Task;
use super::heading::{Free, SHAPES};
use super::limits::{keeps, penalise};
use super::newton::{Objective, step};
use crate::feasibility::steering::shooting::query::Curvatures;

/// What came of it.
#[derive(Debug, Clone, Copy)]
pub(in super::super) struct Fit {
    /// The curve.
    pub(in super::super) free: Free,
    /// Distance of its end from the goal, m.
    pub(in super::super) miss: f64,
    /// Whether it meets the goal within the bounds.
    pub(in super::super) good: bool,
    /// Steps taken.
    pub(in super::super) iterations: u32,
}

/// Weight of the penalty; that of ½Σ cⱼ²/(2j + 5) = ½∫θ_tt² beyond the cubic's; damping of relative steps of L.
const PENALTY: f64 = 100.0;
const SMOOTH: f64 = 1e-3;
const LENGTH: f64 = 0.1;
/// Samples are held to bounds this much narrower, so that neither the penalty's softness nor peaks between them break
/// the true ones.
const MARGIN: f64 = 2e-3;
/// Below this miss (m) only the goal is aimed at, provided that the bounds hold: then convergence is quadratic.
const NEAR: f64 = 0.05;

/// Follows
/// ```text
/// min ½ Σ cⱼ²/(2j+5) + penalty   such that   position(c, L) = (x, y)
/// ```
/// from `start` until the end is met within the tolerance and the bounds hold, or for `iterations` steps.
///
/// The answer is where it stopped, good or not. `iterations` may be 0: then the start is judged.
///
/// Quadratic near the goal, where the gradient is left out; until then each step is Gauss-Newton for penalty and
/// smoothness with the position linearised. `good` says that both bounds hold everywhere, by [`keeps`].
pub(in super::super) fn descend(task: &Task, ends: &Ends, start: Free, iterations: u32) -> Fit {
    let Task { bounds, freedoms, tolerance, step_scale, simd } = *task;
    let narrow = Curvatures { most: bounds.most * (1.0 - MARGIN), most_rate: bounds.most_rate * (1.0 - MARGIN) };
    let mut fit = Fit { free: start, miss: f64::INFINITY, good: false, iterations: 0 };
    let mut free = start;
    loop {
        let (error, jacobian) = ends.miss(simd, &free);
        let miss = (error[0] * error[0] + error[1] * error[1]).sqrt();
        if !miss.is_finite() {
            return fit;
        }
        let mut objective = smoothness(&free);
        let excess = penalise(simd, ends, &free, &narrow, PENALTY, &mut objective);
        let broken = (1.0 + excess) * (1.0 - MARGIN) > KEPT;
        fit.free = free;
        fit.miss = miss;
        fit.good = miss < tolerance && !broken && keeps(ends, &free, &bounds);
        if fit.good || fit.iterations >= iterations {
            return fit;
        }
        if !broken && miss < NEAR {
            objective = Objective { gradient: [0.0; SHAPES + 1], ..smoothness(&free) };
        }
        free.advance(&step(&objective, &error, &jacobian, freedoms).map(|change| step_scale * change));
        fit.iterations += 1;
    }
}

/// Where the objective begins: the smoothness alone.
///
/// ½ SMOOTH Σ cⱼ²/(2j + 5), 1/(2j + 5) being ∫ φ_j″² dt, and a damping of the length's relative change, which has no
/// gradient. Diagonal.
fn smoothness(free: &Free) -> Objective {
    let mut objective = Objective::default();
    for (j, c) in free.shape.iter().enumerate() {
        let weight = SMOOTH / (2 * j + 5) as f64;
        objective.gradient[j] = weight * c;
        objective.matrix[j][j] = weight;
    }
    objective.matrix[SHAPES][SHAPES] = LENGTH / (free.length * free.length);
    objective
}
