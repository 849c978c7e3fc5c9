//! Makes commands that meet their goal cheaper along the motion they lead to, without letting go of the goal or the
//! bounds.
//!
//! The drive is divided into pieces as for refinement: what is added to the curvature where they meet, and the stretch,
//! are seventeen unknowns for four end conditions. Costs that the ground decides have a gradient g by one-sided
//! differences of predictions; with T the end's derivatives a step goes along
//!
//! ```text
//! d = −(M − MTᵀ(TMTᵀ)⁻¹TM) g     M⁻¹ = I + c DᵀD
//! ```
//! the steepest way down that leaves the end, to first order (the multipliers of Lagrange eliminated), in a metric that
//! counts the differences D of neighbouring bends as well, so that steps are smooth and leave κ′ its room. ∫κ² and ∫κ′²
//! are known exactly to second order (`model`): there a step minimises the quadratic along the bounds that it meets, as
//! steepest descent would only creep. Refinement then brings the end back exactly, within the bounds. Only steps that
//! lower the cost are kept.

use nalgebra::SMatrix;

use super::cost::{Along, GroundCost};
use super::model::Model;
use super::outcome::Prediction;
use super::predict::predict;
use super::refine::{Change, Task, UNKNOWNS, changed, divided, refine, tangent, within_bounds};
use crate::trajectory::drive::{Segment, SegmentList};
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
/// Costs of commands alone would have drives grow without end: lengths stay below this multiple of the first.
const LONGEST: f64 = 1.5;
/// Steps by a model; its damping at first, by which it grows where a step was no good, and where it ends.
const MODEL_STEPS: u32 = 12;
const DAMPING: f64 = 1e-3;
const GROWTH: f64 = 8.0;
const STIFF: f64 = 1e4;

/// Commands that cost less, with their motion.
pub(super) struct Cheaper {
    pub(super) segments: SegmentList,
    pub(super) prediction: Prediction,
}

/// The cheapest commands found from `segments`, which must meet the goal; `None` if none are cheaper or they cannot be
/// bent. Also the predictions made.
///
/// `None` as well where the first prediction does not pass. Costs of commands: a prediction for each tangent and up to
/// 16 for each step back to the goal; costs of the ground: 17 more for each gradient.
pub(super) fn cheaper<T: Terrain>(
    task: &Task<'_, '_, T>,
    segments: &SegmentList,
    cost: GroundCost,
) -> (Option<Cheaper>, u32) {
    let Some(here) = divided(segments) else { return (None, 0) };
    let longest = LONGEST * length(&here);
    let mut search = Search { task, cost, here, value: 0.0, longest, found: None, predictions: 0 };
    let Some((value, _)) = search.cost_of(&here) else { return (None, search.predictions) };
    search.value = value;
    match cost {
        GroundCost::Any => {}
        GroundCost::Curvature | GroundCost::Rate => search.by_model(),
        GroundCost::Tilt | GroundCost::Slip | GroundCost::Energy => search.by_differences(),
    }
    (search.found, search.predictions)
}

fn length(segments: &[Segment]) -> f64 {
    segments.iter().map(Segment::length_m).sum()
}

/// A search under way.
struct Search<'a, 'b, 'c, T> {
    task: &'a Task<'b, 'c, T>,
    cost: GroundCost,
    /// The cheapest so far, and what it costs.
    here: SegmentList,
    /// In the cost's own unit.
    value: f64,
    /// m.
    longest: f64,
    found: Option<Cheaper>,
    predictions: u32,
}

impl<T: Terrain> Search<'_, '_, '_, T> {
    /// What `commands` cost along their motion.
    fn cost_of(&mut self, commands: &SegmentList) -> Option<(f64, Prediction)> {
        self.predictions += 1;
        let mut along = Along::new(self.task.course, self.cost, commands);
        let prediction = predict(self.task.course, self.task.from, commands, |driven| along.add(driven)).ok()?;
        Some((along.total(), prediction))
    }

    /// Goes along `change`, brings the end back, and stays there if that costs less: by how much.
    ///
    /// `None` where nothing is gained: not back within 0.8 of the precision, too long, or no cheaper.
    fn gained_by(&mut self, change: &Change) -> Option<f64> {
        let mut tried = self.here;
        changed(&mut tried, change);
        let (refined, taken) = refine(self.task, &tried, 0.0);
        self.predictions += taken;
        let refined = refined.filter(|refined| refined.residual <= KEPT && length(&refined.segments) < self.longest)?;
        let (cost, prediction) = match self.cost {
            GroundCost::Curvature | GroundCost::Rate => (self.cost.of_commands(&refined.segments), refined.prediction),
            _ => self.cost_of(&refined.segments)?,
        };
        let gained = self.value - cost;
        if gained.is_nan() || gained <= 0.0 {
            return None;
        }
        (self.value, self.here) = (cost, refined.segments);
        self.found = Some(Cheaper { segments: refined.segments, prediction });
        Some(gained)
    }

    /// Newton's steps along the ends' conditions and the bounds, damped.
    ///
    /// Damping falls by 8 with every gain and rises by 8 with every failure; ends at a gain below a thousandth of the
    /// cost.
    fn by_model(&mut self) {
        let mut damping = DAMPING;
        for _ in 0..MODEL_STEPS {
            if (self.task.over)() || self.value <= 0.0 {
                return;
            }
            self.predictions += 1;
            let Some(tangent) = tangent(self.task, &self.here) else { return };
            let model = Model::of(&self.here, self.cost);
            let mut gained = 0.0;
            while gained <= 0.0 && damping < STIFF && !(self.task.over)() {
                let (matrix, vector) = model.damped(damping, &tangent, self.task.precision);
                let change = within_bounds(self.task, &self.here, &matrix, &vector);
                gained = change.and_then(|change| self.gained_by(&change)).unwrap_or(0.0);
                damping *= if gained > 0.0 { 1.0 / GROWTH } else { GROWTH };
            }
            damping = damping.max(1e-6);
            if gained <= GAIN * self.value {
                return;
            }
        }
    }

    /// Steepest descent, by differences of predictions.
    ///
    /// Forward differences of 10⁻³ 1/m and of 10⁻³ of the length; along the projected gradient at most 0.2 (1/m, or of
    /// the length) at once, shrunk by 0.4 until the cost falls.
    fn by_differences(&mut self) {
        let Some(metric) = smooth() else { return };
        let mut stride = STRIDE;
        for _ in 0..STEPS {
            if (self.task.over)() {
                return;
            }
            let (here, value) = (self.here, self.value);
            let mut gradient = Change::zeros();
            for unknown in 0..UNKNOWNS {
                let mut change = Change::zeros();
                change[unknown] = DIFFERENCE;
                let mut moved = here;
                changed(&mut moved, &change);
                // Where the ground does not let a neighbour pass, nothing is learned of it.
                gradient[unknown] = self.cost_of(&moved).map_or(0.0, |(moved, _)| (moved - value) / DIFFERENCE);
            }
            let Some(down) = tangent(self.task, &here).and_then(|t| {
                let (lifted, pulled) = (metric * t.transpose(), metric * gradient);
                let inverse = (t * lifted).try_inverse()?;
                Some(lifted * (inverse * (t * pulled)) - pulled)
            }) else {
                return;
            };
            if !(down.amax() > 0.0 && down.amax().is_finite()) {
                return;
            }
            let mut gained = 0.0;
            for _ in 0..TRIALS {
                if let Some(less) = self.gained_by(&(down * (stride / down.amax()))) {
                    gained = less;
                    stride = (2.0 * stride).min(STRIDE);
                    break;
                }
                stride *= 0.4;
                if stride < LEAST || (self.task.over)() {
                    break;
                }
            }
            if gained <= GAIN * self.value {
                return;
            }
        }
    }
}

/// M of the metric; the stretch stands by itself.
///
/// `None` never in practice: I + c DᵀD is positive definite. Symmetric; order as in [`Change`].
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
