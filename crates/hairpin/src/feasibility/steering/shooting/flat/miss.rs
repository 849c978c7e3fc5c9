//! How far the end of a drive is from the goal, from the numbers that are handed out.

use std::f64::consts::TAU;

use super::extremes::hull_of;
use crate::feasibility::steering::shooting::query::{Precision, Query};
use crate::math::circular::sin_cos;
use crate::math::quadrature::Gauss;
use crate::math::simd::{Simd, kernel};
use crate::trajectory::drive::{Motion, Segment};

/// Points a panel; panels turn by two radians or less, up to this many of them in a segment.
const NODES: usize = 8;
const PANELS: f64 = 256.0;

/// Errors at the end of a drive.
///
/// Of the commands as they are handed out, not of what made them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Miss {
    /// Distance from the goal, m.
    pub(super) position: f64,
    /// Heading less the goal's, modulo 2π, rad, in [−π, π].
    pub(super) yaw: f64,
    /// κ less the goal's, 1/m.
    pub(super) curvature: f64,
}

impl Miss {
    /// Whether the goal counts as met.
    pub(super) fn within(&self, precision: &Precision) -> bool {
        self.position <= precision.position
            && self.yaw.abs() <= precision.yaw
            && self.curvature.abs() <= precision.curvature
    }
}

/// Integrates `segments` from the origin, driving forward.
///
/// Eight Gauss points a panel; the error is below 10⁻¹⁰ m for drives of hundreds of metres.
///
/// Gears are taken as forward. An empty list ends at the origin with the start's curvature. Turns in place leave the
/// curvature as it was. A place or heading that is no number is within no precision.
pub(super) fn miss(simd: Simd, segments: &[Segment], query: &Query) -> Miss {
    let (mut x, mut y, mut heading, mut curvature) = (0.0, 0.0, 0.0, query.start_curvature);
    for segment in segments {
        match segment.motion {
            Motion::Arc { length_m, curvature: polynomial } => {
                let mut driven = [0.0; 3];
                drive(simd, length_m, &polynomial, &mut driven);
                let [dx, dy, turn] = driven;
                let (sin, cos) = sin_cos(heading);
                x += cos * dx - sin * dy;
                y += sin * dx + cos * dy;
                heading += turn;
                curvature = segment.curvature_at(length_m);
            }
            Motion::Turn { angle_rad } => heading += angle_rad,
        }
    }
    let goal = &query.goal;
    let yaw = heading - goal.yaw;
    Miss {
        position: libm::hypot(x - goal.x, y - goal.y),
        yaw: yaw - (yaw / TAU).round() * TAU,
        curvature: curvature - goal.curvature,
    }
}

kernel! {
    /// Change of position in the frame of the beginning, and of heading, along one polynomial.
    ///
    /// θ(t) = Σ aᵢ Lⁱ⁺¹ tⁱ⁺¹/(i + 1), t = s/L; out: L ∫ cos θ dt, L ∫ sin θ dt, θ(1).
    fn drive(length: f64, polynomial: &[f64; 6], out: &mut [f64; 3]) {
        // θ over t = s/L.
        let mut heading = [0.0; 6];
        let mut turning = [0.0; 6];
        let mut scale = 1.0;
        for (i, slot) in heading.iter_mut().enumerate() {
            scale *= length;
            turning[i] = polynomial[i] * scale;
            *slot = turning[i] / (i + 1) as f64;
        }
        let panels = (0.5 * hull_of(&turning)).ceil().clamp(1.0, PANELS);
        let width = 1.0 / panels;
        let rule = Gauss::<NODES>::RULE;
        let (mut cos, mut sin) = ([0.0; NODES], [0.0; NODES]);
        for panel in 0..panels as usize {
            for i in 0..NODES {
                let t = (panel as f64 + rule.nodes[i]) * width;
                let angle = heading.iter().rev().fold(0.0, |sum, a| (sum + a) * t);
                let (s, c) = sin_cos(angle);
                cos[i] += rule.weights[i] * c;
                sin[i] += rule.weights[i] * s;
            }
        }
        let total = |row: &[f64; NODES]| row.iter().fold(0.0, |sum, value| sum + value) * width * length;
        *out = [total(&cos), total(&sin), heading.iter().fold(0.0, |sum, a| sum + a)];
    }
}
