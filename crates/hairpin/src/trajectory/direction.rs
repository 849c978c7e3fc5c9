//! The direction of travel in the body: constant for crabbing, or turned evenly along the drive.

use serde::{Deserialize, Serialize};

/// δ of vehicles with all wheels steered, rad, left positive: δ(s) = start + (end − start) s/L over the L metres of a
/// drive.
///
/// Crabbing moves the body without turning it: ψ̇ is κ v alone, and the path's tangent is ψ + δ. κ is the body's turn
/// per metre, not the path's bend where δ changes.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Direction {
    /// Where the drive begins.
    pub start: f64,
    /// Where it ends.
    pub end: f64,
}

impl Direction {
    /// The same all along.
    pub fn constant(direction: f64) -> Self {
        Self { start: direction, end: direction }
    }

    /// end − start, rad.
    pub fn swing(&self) -> f64 {
        self.end - self.start
    }

    /// δ after `s` of `length` metres, rad; before the drive as at its start, after it as at its end.
    pub fn at(&self, s: f64, length: f64) -> f64 {
        let swing = self.swing();
        if swing == 0.0 || length <= 0.0 { self.start } else { self.start + swing * (s / length).clamp(0.0, 1.0) }
    }

    /// dδ/ds over a drive of `length` metres, rad/m.
    pub fn rate(&self, length: f64) -> f64 {
        if length > 0.0 { self.swing() / length } else { 0.0 }
    }
}

impl From<f64> for Direction {
    fn from(direction: f64) -> Self {
        Self::constant(direction)
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;

    #[test]
    fn it_turns_evenly_and_stays_where_it_ends() {
        let direction = Direction { start: 0.2, end: -0.4 };
        for (s, expected) in [(-1.0, 0.2), (0.0, 0.2), (1.0, -0.1), (2.0, -0.4), (3.0, -0.4)] {
            assert!((direction.at(s, 2.0) - expected).abs() < 1e-15, "{s}");
        }
        assert_eq!((direction.at(1.0, 0.0), direction.rate(0.0)), (0.2, 0.0));
        assert!((direction.rate(2.0) + 0.3).abs() < 1e-15);
        assert_eq!(Direction::from(0.3).at(5.0, 2.0), 0.3);
    }
}
