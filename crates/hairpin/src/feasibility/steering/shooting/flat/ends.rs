//! What a curve is held to: where it ends, how it bends there, and how much it may bend between.

use crate::feasibility::steering::shooting::query::{Curvatures, Query};

use super::dubins::Word;

/// A query with its heading unwrapped: the whole turn from start to end is chosen.
///
/// In the frame of the start, driven forward.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ends {
    /// Where the curve ends, m.
    pub(super) x: f64,
    pub(super) y: f64,
    /// Change of heading along it, rad: not modulo 2π.
    pub(super) turn: f64,
    /// κ at both ends, 1/m.
    pub(super) start: f64,
    pub(super) end: f64,
}

impl Ends {
    /// Of the headings equal modulo 2π, the one that is nearest to the turn of `word`.
    ///
    /// So that a curve that follows the word turns as it does, with loops where it has them.
    pub(super) fn along(query: &Query, word: &Word) -> Self {
        let goal = &query.goal;
        let whole = ((word.turn() - goal.yaw) / std::f64::consts::TAU).round();
        Self {
            x: goal.x,
            y: goal.y,
            turn: goal.yaw + whole * std::f64::consts::TAU,
            start: query.start_curvature,
            end: goal.curvature,
        }
    }
}

/// The largest bends of a curve, over what is allowed: at most 1 each where both bounds are kept.
///
/// ∞ where nothing is known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Bends {
    /// max |κ| / most.
    pub(super) curvature: f64,
    /// max |κ′| / most_rate.
    pub(super) rate: f64,
}

/// A bound is kept up to this factor: rounding may exceed one that is met with equality.
pub(super) const KEPT: f64 = 1.0 + 1e-9;

impl Bends {
    /// Whether both bounds hold.
    pub(super) fn within(&self) -> bool {
        self.worst() <= KEPT
    }

    /// The larger of both.
    pub(super) fn worst(&self) -> f64 {
        self.curvature.max(self.rate)
    }
}

/// Bounds between which numbers stay tame: no vehicle has others. What is no number becomes the least.
///
/// Positive and finite; a path that breaks no such bound does not exist for any vehicle.
///
/// κ_max in 10⁻⁹ … 10⁶ 1/m, κ′_max in 10⁻¹² … 10¹² 1/m².
pub(super) fn tame(bounds: &Curvatures) -> Curvatures {
    let between = |value: f64, least: f64, most: f64| if value > least { value.min(most) } else { least };
    Curvatures { most: between(bounds.most, 1e-9, 1e6), most_rate: between(bounds.most_rate, 1e-12, 1e12) }
}
