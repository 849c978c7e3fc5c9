//! The path of a ground vehicle as it is commanded: arcs whose curvature is a polynomial of arc length, and turns in place.

/// What one [`Segment`] of a drive does.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Motion {
    /// Drives `length_m` metres; ψ̇ = direction · v · κ(s), κ(s) = Σ aᵢ sⁱ, s from 0 in each segment.
    Arc {
        /// Arc length, m, ≥ 0.
        length_m: f64,
        /// a₀ … a₅ of the curvature, 1/m^(i+1).
        curvature: [f64; 6],
    },
    /// Turns in place.
    Turn {
        /// Change of yaw, rad, left positive.
        angle_rad: f64,
    },
}

/// One piece of a drive without a change of gear.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Segment {
    /// What it does.
    pub motion: Motion,
    /// Forward or reverse; forward for turns in place.
    pub gear: Gear,
}

/// Which way the vehicle moves along its path.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Gear {
    /// Along the body's x axis.
    Forward,
    /// Against it.
    Reverse,
}

impl Gear {
    /// +1 forward, −1 in reverse.
    pub fn sign(self) -> f64 {
        match self {
            Self::Forward => 1.0,
            Self::Reverse => -1.0,
        }
    }

    /// The other one.
    pub fn opposite(self) -> Self {
        match self {
            Self::Forward => Self::Reverse,
            Self::Reverse => Self::Forward,
        }
    }
}

impl Segment {
    /// A straight line of `length_m`.
    pub fn straight(length_m: f64, gear: Gear) -> Self {
        Self { motion: Motion::Arc { length_m, curvature: [0.0; 6] }, gear }
    }

    /// A clothoid: curvature from `start` to `end` (1/m), linear over `length_m`.
    pub fn clothoid(length_m: f64, start: f64, end: f64, gear: Gear) -> Self {
        let rate = if length_m > 0.0 { (end - start) / length_m } else { 0.0 };
        Self { motion: Motion::Arc { length_m, curvature: [start, rate, 0.0, 0.0, 0.0, 0.0] }, gear }
    }

    /// Metres driven; 0 for a turn in place.
    pub fn length_m(&self) -> f64 {
        match self.motion {
            Motion::Arc { length_m, .. } => length_m,
            Motion::Turn { .. } => 0.0,
        }
    }

    /// κ(s), 1/m; 0 for a turn in place.
    pub fn curvature_at(&self, s: f64) -> f64 {
        match self.motion {
            Motion::Arc { curvature, .. } => curvature.iter().rev().fold(0.0, |sum, a| sum * s + a),
            Motion::Turn { .. } => 0.0,
        }
    }
}
