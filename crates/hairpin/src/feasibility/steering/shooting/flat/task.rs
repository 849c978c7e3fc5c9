//! What all descents of one query share.

use crate::feasibility::steering::shooting::query::Curvatures;
use crate::math::simd::Simd;

/// How many of an arc's shape parameters a control has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Freedoms {
    /// c₀: a cubic, as many unknowns as equations.
    One,
    /// c₀, c₁, c₂: fifth order, two unknowns to spare.
    Three,
}

/// Bounds and tolerances.
#[derive(Debug, Clone, Copy)]
pub(super) struct Task {
    /// What the curve may bend.
    pub(super) bounds: Curvatures,
    /// The family of arcs.
    pub(super) freedoms: Freedoms,
    /// The miss at which a descent has arrived, m and rad.
    pub(super) tolerance: f64,
    /// Share of each step that is taken.
    pub(super) step_scale: f64,
    /// Version of the kernels.
    pub(super) simd: Simd,
}
