//! Makes commands that meet their goal cheaper along the motion they lead to, without letting go of the goal or the bounds.
//!
//! The drive is divided into pieces as for refinement: what is added to the curvature where they meet, and the stretch, are
//! seventeen unknowns for four end conditions. The cost's gradient g by them comes from one-sided differences of predictions;
//! with T the end's derivatives a step goes along
//!
//! ```text
//! d = −(M − MTᵀ(TMTᵀ)⁻¹TM) g     M⁻¹ = I + c DᵀD
//! ```
//! the steepest way down that leaves the end, to first order (the multipliers of Lagrange eliminated), in a metric that counts the
//! differences D of neighbouring bends as well, so that steps are smooth and leave κ′ its room; refinement then brings the end back exactly, within the bounds. Only steps that lower the cost are kept.

use nalgebra::SMatrix;

use super::cost::{Along, GroundCost};
use super::predict::{Prediction, predict};
use super::refine::{Change, Task, UNKNOWNS, changed, divided, refine, tangent};
use crate::trajectory::drive::SegmentList;
use crate::world::terrain::Terrain;

/// Steps down, and trials of each, at most.
const STEPS: u32 = 8;
const TRIALS: u32 = 5;
/// Differences are taken over this change of curvature (1/m) and of the length's share.
const DIFFERENCE: f64 = 1e-3;
/// Largest change of a first trial: of curvature, 1/m, and of the length's share; and its least.
const STRIDE: f64 = 0.2;
const LEAST: f64 = 2e-3;
/// A step that gains a smaller share of the cost than this is the last.
const GAIN: f64 = 1e-3;
/// c: bends are moved alike over about √c pieces.
const SMOOTH: f64 = 16.0;
/// Residual, in units of the precision, up to which an end is kept.
const KEPT: f64 = 0.8;

/// Commands that cost less, with their motion.
pub(super) struct Cheaper {
    pub(super) segments: SegmentList,
    pub(super) prediction: Prediction,
}

/// The cheapest commands found from `segments`, which must meet the goal; `None` if none are cheaper or they cannot be bent. Also the
/// predictions made.
pub(super) fn cheaper<T: Terrain>(
    task: &Task<'_, '_, T>,
    segments: &SegmentList,
    cost: GroundCost,
) -> (Option<Cheaper>, u32) {
    let mut predictions = 0;
    let mut found = None;
    let Some(mut here) = divided(segments) else { return (None, 0) };
    let mut cost_of = |commands: &SegmentList| {
        predictions += 1;
        let mut along = Along::new(task.course, cost, commands);
        predict(task.course, task.from, commands, |driven| along.add(driven))
            .ok()
            .map(|prediction| (along.total(), prediction))
    };
    let Some((mut value, _)) = cost_of(&here) else { return (None, predictions) };
    let Some(metric) = smooth() else { return (None, predictions) };
    let (mut stride, mut refined_with) = (STRIDE, 0);
    for _ in 0..STEPS {
        if (task.over)() {
            break;
        }
        let mut gradient = Change::zeros();
        for unknown in 0..UNKNOWNS {
            let mut change = Change::zeros();
            change[unknown] = DIFFERENCE;
            let mut moved = here;
            changed(&mut moved, &change);
            // Where the ground does not let a neighbour pass, nothing is learned of it.
            gradient[unknown] = cost_of(&moved).map_or(0.0, |(moved, _)| (moved - value) / DIFFERENCE);
        }
        let Some(down) = tangent(task, &here).and_then(|t| {
            let (lifted, pulled) = (metric * t.transpose(), metric * gradient);
            let inverse = (t * lifted).try_inverse()?;
            Some(lifted * (inverse * (t * pulled)) - pulled)
        }) else {
            break;
        };
        if !(down.amax() > 0.0 && down.amax().is_finite()) {
            break;
        }
        let mut gained = 0.0;
        for _ in 0..TRIALS {
            let mut tried = here;
            changed(&mut tried, &(down * (stride / down.amax())));
            let (refined, taken) = refine(task, &tried, 0.0);
            refined_with += taken;
            let better = refined.filter(|refined| refined.residual <= KEPT).and_then(|refined| {
                let (cost, prediction) = cost_of(&refined.segments)?;
                (cost < value).then_some((cost, refined.segments, prediction))
            });
            if let Some((cost, segments, prediction)) = better {
                gained = value - cost;
                (value, here) = (cost, segments);
                found = Some(Cheaper { segments, prediction });
                stride = (2.0 * stride).min(STRIDE);
                break;
            }
            stride *= 0.4;
            if stride < LEAST || (task.over)() {
                break;
            }
        }
        if gained <= GAIN * value {
            break;
        }
    }
    (found, predictions + refined_with)
}

/// M of the metric; the stretch stands by itself.
fn smooth() -> Option<SMatrix<f64, UNKNOWNS, UNKNOWNS>> {
    let mut metric = SMatrix::<f64, UNKNOWNS, UNKNOWNS>::identity();
    // The start's bend stays, so the first difference is the first bend itself.
    for i in 0..UNKNOWNS - 1 {
        metric[(i, i)] += SMOOTH;
        if i > 0 {
            metric[(i - 1, i - 1)] += SMOOTH;
            metric[(i, i - 1)] -= SMOOTH;
            metric[(i - 1, i)] -= SMOOTH;
        }
    }
    metric.try_inverse()
}
