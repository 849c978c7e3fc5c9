//! Bends given commands until their motion on the ground ends at the goal.
//!
//! The flat solver's answers jump from one way around to another; this continues a single one. The drive is divided
//! into pieces; unknown are what is added to the curvature where they meet and at the end, linear between (nothing at
//! the start), and ε, by which all is stretched. That is more than four equations need; the rest keeps the bounds. The
//! equations' derivatives are those of the plane along the way just predicted,
//!
//! ```text
//! δψ = ∫δκ ds   δ(x, y) = ∫ (y(s) − y_end, x_end − x(s)) δκ ds
//! ```
//!
//! so an iteration costs one prediction. What slopes, slip and lag make of it is learned by Broyden's update (Broyden
//! 1965) of a matrix in front of them.
//!
//! Unknowns: 16 bends (1/m) at the pieces' ends and ε; equations: x, y (m), ψ (rad), κ (1/m) of the end, weighed by the
//! precision. Of the changes that meet them nearly the smallest is taken: LAZY ‖d‖² stands beside the squared
//! residuals. Bounds at samples that a solution exceeds enter as penalties and the system is solved again, a dozen
//! times at most.

mod pieces;
mod sweep;
mod variation;

use std::f64::consts::TAU;

use nalgebra::{Matrix4, SMatrix, Vector4};

pub(super) use self::pieces::{Change, PIECES, UNKNOWNS, bend, changed, divided, refinable};
use self::pieces::{excess, for_each_limit};
use self::sweep::Sweep;
pub(super) use self::sweep::Tangent;
use self::variation::Variation;
use super::course::Course;
use super::miss::{Miss, miss, units};
use super::outcome::Prediction;
use super::predict::predict;
use crate::feasibility::steering::shooting::query::{Curvatures, Precision};
use crate::trajectory::drive::{Planar, Segment, SegmentList};
use crate::world::terrain::Terrain;

/// Predictions of one refinement, at most.
const PREDICTIONS: u32 = 16;
/// Halvings of a step that does not help.
const MOST_HALVINGS: u32 = 3;
/// Passes over the bounds in a step, at most.
const PASSES: u32 = 12;
/// Share of the bounds a step aims to keep; the rest is for what lies between samples.
const ROOM: f64 = 0.996;
/// Weight of squares beyond a bound against those of the goal's errors in units of their precision.
const STRICT: f64 = 1e8;
/// What exceeding a bound by itself counts, in units of the precision.
const EXCESS: f64 = 100.0;
/// Largest step: of curvature, 1/m, and of the length's share.
const BOLDEST: f64 = 0.25;
/// Weight of the squared change.
const LAZY: f64 = 0.1;

/// What commands are refined for.
pub(super) struct Task<'a, 'c, T> {
    pub(super) course: &'a Course<'c, T>,
    pub(super) from: &'a Planar,
    pub(super) goal: &'a Planar,
    pub(super) precision: &'a Precision,
    pub(super) bounds: &'a Curvatures,
    /// Residual that is good enough, in units of the precision.
    ///
    /// 0.2 in the solver.
    pub(super) aim: f64,
    /// Whether the time is over.
    pub(super) over: &'a dyn Fn() -> bool,
}

/// Commands with their motion and its largest error in units of the precision.
pub(super) struct Refined {
    pub(super) segments: SegmentList,
    pub(super) prediction: Prediction,
    pub(super) residual: f64,
}

/// Commands near `segments` that keep the bounds and end nearer to the goal, and the predictions made; begun with their
/// middle moved by about `aside` m to the left.
///
/// `None` where none was found that keep the bounds, and for drives with reversals, turns in place or too many pieces.
///
/// What counts while it goes on is residual + 100 · excess, so that commands over a bound may be passed through but are
/// never answered. A step that does not help is halved, three times at most. `aside` bends the start to pass what lies
/// in the middle.
pub(super) fn refine<T: Terrain>(task: &Task<'_, '_, T>, segments: &SegmentList, aside: f64) -> (Option<Refined>, u32) {
    let mut found: Option<Refined> = None;
    let Some(begun) = divided(segments) else { return (None, 0) };
    let behind = task.course.rover.response.steering_time_constant * task.course.speed.top();
    let mut here: Option<Stand> = None;
    let mut change = swing(&begun, aside);
    let mut learned = Matrix4::identity();
    let (mut predictions, mut halvings) = (0, 0);
    while predictions < PREDICTIONS && !(task.over)() {
        predictions += 1;
        let mut segments = here.as_ref().map_or(begun, |here| here.segments);
        changed(&mut segments, &change);
        let mut sweep = Sweep::new(task.from, behind, &segments);
        let outcome = predict(task.course, task.from, &segments, |driven| sweep.add(driven)).ok();
        let ended = outcome.map(|prediction| (prediction, miss(task.goal, &prediction.end, task.precision)));
        if let (Some(here), Some((_, missed))) = (&here, &ended) {
            learn(&mut learned, &(here.tangent * change), &(here.error - missed.error));
        }
        let excess = segments.iter().map(|segment| excess(segment, task.bounds)).fold(0.0, f64::max);
        let cost = |missed: &Miss| missed.residual + EXCESS * excess;
        let better = |(_, missed): &(Prediction, Miss)| here.as_ref().is_none_or(|here| cost(missed) < here.cost);
        if let Some((prediction, missed)) = ended.filter(better) {
            let Miss { residual, error } = missed;
            if excess == 0.0 && found.as_ref().is_none_or(|found| residual < found.residual) {
                found = Some(Refined { segments, prediction, residual });
                if residual <= task.aim {
                    break;
                }
            }
            halvings = 0;
            here = Some(Stand { segments, tangent: sweep.tangent(&prediction.end), error, cost: cost(&missed) });
        } else {
            halvings += 1;
        }
        // What was learned from a step that did not help goes into the next, which is shorter.
        let Some(next) =
            here.as_ref().filter(|_| halvings <= MOST_HALVINGS).and_then(|here| step(task, here, &learned))
        else {
            break;
        };
        change = next / f64::from(1_u32 << halvings);
    }
    (found, predictions)
}

/// How the end of the motion of `segments` moves with a change of them, suspension and slip included; `None` where they
/// do not pass.
///
/// Rows x, y, ψ, κ; columns bends, then the stretch. One prediction.
pub(super) fn tangent<T: Terrain>(task: &Task<'_, '_, T>, segments: &SegmentList) -> Option<Tangent> {
    let mut variation = Variation::new(task.course, segments);
    predict(task.course, task.from, segments, |driven| variation.add(driven)).ok()?;
    Some(variation.tangent())
}

/// A change that moves the middle of a drive by about `aside` m: y = aside (1 − cos 2πs/L)/2 has y″ = ½ aside (2π/L)²
/// cos 2πs/L.
///
/// To first order, for drives that are nearly straight; the offset is 0 with its slope at both ends. In 1/m; no
/// stretch.
fn swing(segments: &SegmentList, aside: f64) -> Change {
    let length: f64 = segments.iter().map(Segment::length_m).sum();
    let turns = TAU / length.max(f64::MIN_POSITIVE);
    let mut change = Change::zeros();
    let mut s = 0.0;
    for (bend, segment) in change.iter_mut().zip(segments.iter()) {
        s += segment.length_m();
        *bend = 0.5 * aside * turns * turns * libm::cos(turns * s);
    }
    change
}

/// Where a step starts from, and what it is to take away.
struct Stand {
    segments: SegmentList,
    tangent: Tangent,
    error: Vector4<f64>,
    /// Residual and excess together.
    cost: f64,
}

/// Broyden's update of what the ground makes of the plane's effects: where the plane says `expected`, it was `effect`.
///
/// E ← E + (effect − E expected) expectedᵀ/‖expected‖²: the least change that explains what was seen.
fn learn(learned: &mut Matrix4<f64>, expected: &Vector4<f64>, effect: &Vector4<f64>) {
    let size = expected.norm_squared();
    if size > 0.0 {
        *learned += (effect - *learned * expected) * expected.transpose() / size;
    }
}

/// The least change that takes away `error` and keeps the bounds, as far as the plane tells.
///
/// Least squares with a penalty on what exceeds a bound; what does so is found again with every solution.
///
/// Normal equations of min ‖W(E T d − error)‖² + 0.1 ‖d‖², W the reciprocal precisions.
fn step<T>(task: &Task<'_, '_, T>, from: &Stand, learned: &Matrix4<f64>) -> Option<Change> {
    let weights = units(task.precision);
    let weighted = Matrix4::from_diagonal(&weights) * learned * from.tangent;
    let normal = weighted.transpose() * weighted + SMatrix::<f64, UNKNOWNS, UNKNOWNS>::from_diagonal_element(LAZY);
    let right = weighted.transpose() * from.error.component_mul(&weights);
    within_bounds(task, &from.segments, &normal, &right)
}

/// The change d of `segments` with `normal` d = `right`, or nearest to it, that keeps the bounds.
///
/// Bounds at 0.996 of their size. Cut to 0.25 in its largest component at the end, which keeps the bounds if both the
/// commands before and the whole step do. `None` where a system is not positive definite or the change is no number.
pub(super) fn within_bounds<T>(
    task: &Task<'_, '_, T>,
    segments: &SegmentList,
    normal: &SMatrix<f64, UNKNOWNS, UNKNOWNS>,
    right: &Change,
) -> Option<Change> {
    let mut change = normal.cholesky()?.solve(right);
    for _ in 0..PASSES {
        let (mut matrix, mut vector) = (*normal, *right);
        let mut exceeded = false;
        for_each_limit(segments, task.bounds, |row, value, bound| {
            let (reached, bound) = (value + row.dot(&change), ROOM * bound);
            if reached.abs() > bound {
                exceeded = true;
                matrix += STRICT * row * row.transpose();
                vector += STRICT * (bound.copysign(reached) - value) * row;
            }
        });
        if !exceeded {
            break;
        }
        change = matrix.cholesky()?.solve(&vector);
    }
    // Part of a step keeps the bounds as the whole does.
    let change = change * (BOLDEST / change.amax()).min(1.0);
    change.iter().all(|c| c.is_finite()).then_some(change)
}
