//! Minimises a cost along an arc without letting go of its ends or bounds.
//!
//! A step goes along the tangent of the end's conditions by the same quadratic programme as the descent's, then up to
//! four least-norm steps lead back to the goal; damping rises until the cost falls with goal and bounds kept, as
//! Levenberg and Marquardt do.

use super::super::ends::Ends;
use super::super::settings::Cost;
use super::super::task::Task;
use super::heading::{BASIS, Free, SHAPES, basis};
use super::limits::{keeps, penalise};
use super::newton::{Objective, UNKNOWNS, step};
use crate::feasibility::steering::shooting::query::Curvatures;
use crate::math::quadrature::Gauss;

/// ∫BₐB_b of the first and the second derivatives of the basis.
const SLOPES: [[f64; BASIS]; BASIS] = gram(1);
const BENDS: [[f64; BASIS]; BASIS] = gram(2);

/// Seven points: exact for products of sixth order and less.
///
/// Symmetric, in order A, B, C, φ₀, φ₁, φ₂; pure numbers.
const fn gram(order: usize) -> [[f64; BASIS]; BASIS] {
    let rule = Gauss::<7>::RULE;
    let mut out = [[0.0; BASIS]; BASIS];
    let mut i = 0;
    while i < 7 {
        let values = basis(rule.nodes[i], order);
        let mut a = 0;
        while a < BASIS {
            let mut b = 0;
            while b < BASIS {
                out[a][b] += rule.weights[i] * values[a] * values[b];
                b += 1;
            }
            a += 1;
        }
        i += 1;
    }
    out
}

/// Damping at first, by which it grows where a step was no good, and where it ends.
const DAMPING: f64 = 1e-3;
const GROWTH: f64 = 8.0;
const STIFF: f64 = 1e6;
/// A step that gains a smaller share of the cost than this is the last.
const GAIN: f64 = 1e-6;
/// Narrower bounds to stay within, and the weight of leaving them.
const MARGIN: f64 = 1e-3;
const PENALTY: f64 = 10.0;
/// Steps back to the goal after each step along it.
const RETURNS: u32 = 4;
/// ∫κ² alone would have curves grow without end: lengths stay below this multiple of the first.
const LONGEST: f64 = 1.5;

/// The cheapest arc found from `start`, which must meet its end within the tolerance and keep the bounds, as the answer
/// does. Also the steps taken, `iterations` at most.
///
/// ∫κ² ds = fᵀ G₁ f/L and ∫κ′² ds = fᵀ G₂ f/L³ with f the factors of the basis: quadratic in c, so that Newton's matrix
/// is exact. The length grows by at most one half.
///
/// Never worse than `start`: only steps that lower the cost and keep goal and bounds are taken. Ends at a gain below
/// 10⁻⁶ of the cost, at a damping of 10⁶, or where the cost is 0 already.
pub(in super::super) fn refine(task: &Task, ends: &Ends, start: Free, cost: Cost, iterations: u32) -> (Free, u32) {
    let Task { bounds, freedoms, simd, .. } = *task;
    let narrow = Curvatures { most: bounds.most * (1.0 - MARGIN), most_rate: bounds.most_rate * (1.0 - MARGIN) };
    let mut free = start;
    let mut damping = DAMPING;
    for taken in 0..iterations {
        let (value, exact) = objective(ends, &free, cost);
        if !(value > 0.0 && damping < STIFF) {
            return (free, taken);
        }
        let mut objective = damped(&exact, value, &free, damping);
        penalise(simd, ends, &free, &narrow, PENALTY * value, &mut objective);
        let (error, jacobian) = ends.miss(simd, &free);
        let mut next = free;
        next.advance(&step(&objective, &error, &jacobian, freedoms));
        let met = meet(task, ends, &mut next);
        let gained = value - self::objective(ends, &next, cost).0;
        if met && gained > 0.0 && next.length < LONGEST * start.length && keeps(ends, &next, &bounds) {
            free = next;
            damping = (damping / GROWTH).max(1e-9);
            if gained < GAIN * value {
                return (free, taken + 1);
            }
        } else {
            damping *= GROWTH;
        }
    }
    (free, iterations)
}

/// Least-norm steps back to the goal; whether it is met.
///
/// At most four steps, each bounded in its stride, by the least change of c and of ln L in their natural weights.
fn meet(task: &Task, ends: &Ends, free: &mut Free) -> bool {
    for _ in 0..RETURNS {
        let (error, jacobian) = ends.miss(task.simd, free);
        if error[0] * error[0] + error[1] * error[1] < task.tolerance * task.tolerance {
            return true;
        }
        free.advance(&step(&damped(&Objective::default(), 1.0, free, 1.0), &error, &jacobian, task.freedoms));
    }
    false
}

/// `exact` with a matrix made safe: `damping` · `value` in the natural units of each unknown.
fn damped(exact: &Objective, value: f64, free: &Free, damping: f64) -> Objective {
    let mut objective = *exact;
    for j in 0..SHAPES {
        objective.matrix[j][j] += damping * value / (2 * j + 5) as f64;
    }
    objective.matrix[SHAPES][SHAPES] =
        objective.matrix[SHAPES][SHAPES].max(0.0) + (1.0 + damping) * value / (free.length * free.length);
    objective
}

/// L⁻ᵖ fᵀGf with its gradient and matrix by c and L; f the factors of the basis, p = 1 for ∫κ² and 3 for ∫κ′².
///
/// Gradient by (c₀, c₁, c₂, L), lower triangle of the exact second derivatives; in 1/m for ∫κ², 1/m³ for ∫κ′².
fn objective(ends: &Ends, free: &Free, cost: Cost) -> (f64, Objective) {
    let (gram, power) = match cost {
        Cost::Any => return (0.0, Objective::default()),
        Cost::Curvature => (&SLOPES, 1.0),
        Cost::Rate => (&BENDS, 3.0),
    };
    let length = free.length;
    let factors = ends.factors(free);
    let by_length = [ends.start, 0.0, ends.end, 0.0, 0.0, 0.0];
    let apply = |v: &[f64; BASIS]| -> [f64; BASIS] {
        std::array::from_fn(|a| gram[a].iter().zip(v).fold(0.0, |sum, (g, v)| sum + g * v))
    };
    let dot = |a: &[f64; BASIS], b: &[f64; BASIS]| a.iter().zip(b).fold(0.0, |sum, (a, b)| sum + a * b);
    let (image, length_image) = (apply(&factors), apply(&by_length));
    let scale = match cost {
        Cost::Rate => 1.0 / (length * length * length),
        _ => 1.0 / length,
    };
    let square = dot(&factors, &image);
    let cross = dot(&by_length, &image);
    let mut gradient = [0.0; UNKNOWNS];
    let mut matrix = [[0.0; UNKNOWNS]; UNKNOWNS];
    for j in 0..SHAPES {
        gradient[j] = 2.0 * scale * image[BASIS - SHAPES + j];
        for k in 0..=j {
            matrix[j][k] = 2.0 * scale * gram[BASIS - SHAPES + j][BASIS - SHAPES + k];
        }
        matrix[SHAPES][j] =
            2.0 * scale * (length_image[BASIS - SHAPES + j] - power / length * image[BASIS - SHAPES + j]);
    }
    gradient[SHAPES] = scale * (2.0 * cross - power / length * square);
    matrix[SHAPES][SHAPES] = scale
        * (2.0 * dot(&by_length, &length_image) - 4.0 * power / length * cross
            + power * (power + 1.0) / (length * length) * square);
    (scale * square, Objective { gradient, matrix })
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;

    #[test]
    fn derivatives_of_the_cost_agree_with_central_differences() {
        let ends = Ends { x: 0.0, y: 0.0, turn: 0.7, start: 0.3, end: -0.4 };
        let free = Free { shape: [3.0, -5.0, 8.0], length: 4.0 };
        let moved = |i: usize, by: f64| {
            let mut free = free;
            if i < SHAPES {
                free.shape[i] += by;
            } else {
                free.length += by;
            }
            free
        };
        for cost in [Cost::Curvature, Cost::Rate] {
            let (value, exact) = objective(&ends, &free, cost);
            let turning = ends.turning(&free);
            let direct = |t: f64| match cost {
                Cost::Rate => (1..6).rev().fold(0.0, |sum, k| sum * t + k as f64 * turning[k]) / 16.0,
                _ => turning.iter().rev().fold(0.0, |sum, a| sum * t + a) / 4.0,
            };
            let rule = Gauss::<12>::RULE;
            let integral: f64 = (0..12).map(|i| 4.0 * rule.weights[i] * direct(rule.nodes[i]).powi(2)).sum();
            assert!((value / integral - 1.0).abs() < 1e-12, "{cost:?}: {value} {integral}");
            for i in 0..UNKNOWNS {
                let (up, down) = (objective(&ends, &moved(i, 1e-5), cost), objective(&ends, &moved(i, -1e-5), cost));
                assert!(((up.0 - down.0) / 2e-5 - exact.gradient[i]).abs() < 1e-7, "{cost:?} gradient {i}");
                for j in i..UNKNOWNS {
                    let difference = (up.1.gradient[j] - down.1.gradient[j]) / 2e-5;
                    assert!((difference - exact.matrix[j][i]).abs() < 1e-7, "{cost:?} matrix {j} {i}");
                }
            }
        }
    }
}
