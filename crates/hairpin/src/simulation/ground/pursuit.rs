//! Pure pursuit: the circle through the vehicle, along its way, that meets the path a lookahead further on. A
//! controller of its own, and what others fall back on.
//!
//! κ + δ′ = 2 y / D², with y the distance of the point to the left of the way and D its distance; δ′ is what a
//! direction of travel that turns in the body bends the way by. Source: Coulter 1992.

use super::command::DriveState;
use super::guide::Along;
use super::plan::{station_at, turning};
use crate::math::power::square;
use crate::robot::rover::Rover;

/// Lookahead at rest, in smallest turning radii: shorter ones ask for circles that the vehicle cannot drive.
const RADII: f64 = 0.5;
/// Lookahead per speed, s: room for the delays of steering.
const TIME: f64 = 0.3;

/// Numbers of a run.
#[derive(Debug, Clone)]
pub(super) struct PurePursuit {
    most: f64,
}

impl PurePursuit {
    /// For the vehicle as it was planned with.
    pub(super) fn new(nominal: &Rover) -> Self {
        Self { most: nominal.limits.curvature }
    }

    /// Curvature to the point ahead, 1/m. In reverse the way leads backwards, and the wheels bend it the other way.
    ///
    /// Lookahead 0.5 smallest radii + 0.3 s · v, along the path's commanded metres; the answer is within the largest
    /// curvature.
    pub(super) fn steer(&self, measured: &DriveState, along: &Along) -> f64 {
        let ahead = RADII / self.most + TIME * along.speed;
        let target = station_at(along.stations, along.s + ahead, along.sign);
        let (sin, cos) = libm::sincos(measured.at.yaw + along.heading);
        let (dx, dy) = (target.x - measured.at.x, target.y - measured.at.y);
        let left = cos * dy - sin * dx;
        let bend = 2.0 * left / (square(dx) + square(dy)).max(f64::MIN_POSITIVE);
        let curvature = along.sign * (bend - turning(along.stations, along.s, ahead));
        curvature.clamp(-self.most, self.most)
    }
}
