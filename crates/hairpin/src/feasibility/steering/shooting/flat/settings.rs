//! What may be chosen, and what is answered.

use crate::feasibility::steering::shooting::query::Precision;
use crate::math::simd::Simd;
use crate::trajectory::drive::SegmentList;
use crate::trajectory::start_table::StartTable;

/// Choices of the solver.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings<'t> {
    /// The errors within which the goal counts as met.
    ///
    /// Descents aim at a thousandth of its position.
    pub precision: Precision,
    /// Steps of each descent at most.
    pub iterations: u32,
    /// Steps of all descents together at most: what bounds the time that a query takes.
    ///
    /// A first descent is begun even with 0, whose start is then judged.
    pub most_steps: u32,
    /// Share of each step that is taken, in (0, 1].
    ///
    /// Below 1 convergence near the goal is linear instead of quadratic.
    pub step_scale: f64,
    /// Ways around (Dubins' words, 6 at most) to start from, at most.
    pub starts: u32,
    /// The family of controls.
    pub control: Control,
    /// What to minimise once goal and bounds are met.
    pub cost: Cost,
    /// Where start values are looked up first.
    ///
    /// Made for one ratio of κ′_max to κ_max²; of other vehicles its arcs are start values as well, but worse ones.
    pub table: Option<&'t StartTable>,
    /// Version of the kernels; all give the same bits.
    pub simd: Simd,
}

impl Default for Settings<'_> {
    /// 1 cm, 0.01 rad, 0.01 1/m; 20 whole steps of each descent, 8 starts; fifth order; the first good curve.
    fn default() -> Self {
        Self {
            precision: Precision::default(),
            iterations: 20,
            most_steps: u32::MAX,
            step_scale: 1.0,
            starts: 8,
            control: Control::default(),
            cost: Cost::default(),
            table: None,
            simd: Simd::default(),
        }
    }
}

/// How curvature may depend on arc length.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Control {
    /// Constant. It reaches positions; heading and curvature are as they come, and a goal that asks for others is
    /// infeasible.
    Arc,
    /// A polynomial of third order.
    Cubic,
    /// A polynomial of fifth order; where none keeps the bounds, a chain of clothoids.
    #[default]
    Quintic,
}

/// What a single arc minimises along itself, with its ends kept exactly. Chains of clothoids are as the descent leaves
/// them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Cost {
    /// Nothing: a short curve that keeps the bounds.
    #[default]
    Any,
    /// ∫κ² ds.
    Curvature,
    /// ∫κ′² ds.
    Rate,
}

/// What was found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Answer {
    /// Whether it does what was asked, and what it lacks otherwise.
    pub status: Status,
    /// The controls: if `Ok`, the answer; if `Infeasible`, a drive to the goal that exceeds the limit least; otherwise
    /// what came nearest.
    pub segments: SegmentList,
    /// Steps over all descents.
    pub iterations: u32,
}

/// How it ended.
///
/// `Infeasible` is about this family of curves: another control, a reversal or a turn in place may do.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Status {
    /// The goal is met within the precision, both bounds hold.
    Ok,
    /// The goal is met only over a limit.
    Infeasible {
        /// Which one is exceeded by the largest factor.
        limit: Limit,
        /// By how much, in its unit.
        ///
        /// Positive; of `Yaw` and `EndCurvature` the difference from the goal's.
        excess: f64,
    },
    /// The goal was not met.
    NotConverged {
        /// Distance from it, m.
        residual: f64,
    },
}

/// What a drive to the goal would break.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Limit {
    /// Largest |κ|, 1/m.
    Curvature,
    /// Largest |κ′|, 1/m².
    CurvatureRate,
    /// The heading of the goal, rad: the control cannot choose it.
    Yaw,
    /// The curvature at the goal, 1/m: the control cannot choose it.
    EndCurvature,
}

impl Limit {
    /// Its name in answers: `curvature_1_m`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Curvature => "curvature_1_m",
            Self::CurvatureRate => "curvature_rate_1_m2",
            Self::Yaw => "yaw_rad",
            Self::EndCurvature => "end_curvature_1_m",
        }
    }
}
