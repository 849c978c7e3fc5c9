//! What a descent came to, judged by the commands that are handed out, and which of two is worth more.

use super::basis::Basis;
use super::clock::Clock;
use super::descend::{Fit, Task, grade};
use super::landing::landing;
use crate::feasibility::steering::shooting::flat::{Cost, Limit, Status, extremes};
use crate::feasibility::steering::shooting::{Curvatures, Precision, Query};
use crate::math::power::power;
use crate::trajectory::drive::{Motion, Segment, SegmentList};

/// The wheels stand where they stand: the first curvature is exact to this, 1/m.
const EXACT: f64 = 1e-7;

/// What a descent came to.
///
/// The fit is what the descent ended with; `segments` and `status` are what counts.
pub(super) struct Found {
    /// In units of the least radius.
    pub(super) fit: Fit,
    /// How deep it comes into what is in the way, m.
    pub(super) depth: f64,
    /// What it costs by what was asked for.
    pub(super) cost: f64,
    /// What it was held to.
    pub(super) task: Task,
    /// What it was found on.
    ///
    /// The functions that its parameters are of.
    pub(super) basis: Basis,
    /// What they are functions of.
    pub(super) clock: Clock,
    /// The commands that are handed out, by how much they differ from the family, and what they are worth.
    ///
    /// Metres and 1/m, driven forward.
    pub(super) segments: SegmentList,
    /// 1/m.
    pub(super) fit_error: f64,
    /// By [`judge`], of the segments.
    pub(super) status: Status,
}

impl Found {
    /// Whether it is worth more: good before not, then what stays clearer, then the cheaper or shorter; or what is
    /// nearer to goal and bounds.
    ///
    /// Lengths and grades in units of the least radius; both must be of one search.
    pub(super) fn better(&self, other: &Self, lowering: Cost) -> bool {
        match (self.status == Status::Ok, other.status == Status::Ok) {
            (true, true) if self.depth != other.depth => self.depth < other.depth,
            (true, true) if lowering != Cost::Any => self.cost < other.cost,
            (true, true) => self.fit.free.length < other.fit.free.length,
            (good, bad) if good != bad => good,
            _ => grade(&self.fit, &self.task) < grade(&other.fit, &other.task),
        }
    }
}

/// ∫κ² ds or ∫κ′² ds of commands, in closed form: Σ aᵢ aⱼ Lⁱ⁺ʲ⁺¹/(i + j + 1); 0 where no cost is asked for.
///
/// 1/m or 1/m³; turns in place cost nothing.
pub(super) fn cost(segments: &[Segment], asked: Cost) -> f64 {
    let of = |segment: &Segment| {
        let length = segment.length_m();
        let Motion::Arc { curvature: a, .. } = segment.motion else { return 0.0 };
        let a = match asked {
            Cost::Any => return 0.0,
            Cost::Curvature => a,
            Cost::Rate => std::array::from_fn(|k| if k < 5 { (k + 1) as f64 * a[k + 1] } else { 0.0 }),
        };
        let term = |i: usize, j: usize| a[i] * a[j] * power(length, i + j + 1) / (i + j + 1) as f64;
        (0..6).map(|i| (0..6).map(|j| term(i, j)).sum::<f64>()).sum()
    };
    segments.iter().map(of).sum()
}

/// Judges by the numbers that are handed out, not by those that made them.
///
/// End by quadrature of the commands, |κ| and |κ′| by their exact extremes. Of several failures the goal's comes first.
///
/// Bounds are kept up to 10⁻⁹ of themselves. `swing` is that of the whole drive; headings are compared with the task's
/// turn, so that a drive that goes round once more than it should is not met.
pub(super) fn judge(
    segments: &[Segment],
    task: &Task,
    query: &Query,
    swing: f64,
    bounds: &Curvatures,
    precision: &Precision,
) -> Status {
    let [x, y, yaw] = landing(segments, swing);
    let missed = libm::hypot(x - query.goal.x, y - query.goal.y);
    let last = segments.last().map_or(query.start_curvature, |last| last.curvature_at(last.length_m()));
    let bent = if task.end.is_some() { (last - query.goal.curvature).abs() } else { 0.0 };
    let turned = (yaw - task.turn).abs();
    let first = segments.first().map_or(0.0, |first| (first.curvature_at(0.0) - query.start_curvature).abs());
    if !(first <= EXACT && missed <= precision.position && turned <= precision.yaw && bent <= precision.curvature) {
        return Status::NotConverged { residual: missed };
    }
    let (mut most, mut rate) = (0.0_f64, 0.0_f64);
    for segment in segments {
        let Motion::Arc { length_m, curvature } = segment.motion else { continue };
        let mut scale = 1.0;
        let mut bend = [0.0; 6];
        for (bend, a) in bend.iter_mut().zip(&curvature) {
            *bend = a * scale;
            scale *= length_m;
        }
        let slope: [f64; 6] = std::array::from_fn(|k| if k < 5 { (k + 1) as f64 * bend[k + 1] } else { 0.0 });
        most = most.max(extremes::largest(&bend) / bounds.most);
        rate = rate.max(extremes::largest(&slope) / (length_m * bounds.most_rate));
    }
    const KEPT: f64 = 1.0 + 1e-9;
    if most <= KEPT && rate <= KEPT {
        Status::Ok
    } else if most >= rate {
        Status::Infeasible { limit: Limit::Curvature, excess: (most - 1.0) * bounds.most }
    } else {
        Status::Infeasible { limit: Limit::CurvatureRate, excess: (rate - 1.0) * bounds.most_rate }
    }
}
