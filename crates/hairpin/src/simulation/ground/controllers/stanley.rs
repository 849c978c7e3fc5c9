//! Stanley: the leading axle is steered along the path's tangent, and towards it the more the farther away it is.
//!
//! δ = (χ_path − χ) − atan(e / d), κ = tan(δ) / L − γ, with e the distance of the leading axle to the left of its path,
//! χ the directions of travel, and d the way on which e is to decay; the path of the leading axle is that of the plan's
//! own one, whose tangent is χ_plan + atan((κ_plan + γ) L), γ what the direction of travel turns by in the body per
//! metre. In reverse the axle leads at the other end. Source: Thrun et al. 2006 (d = v / k).

use std::f64::consts::FRAC_PI_2;

use crate::robot::rover::Rover;
use crate::simulation::ground::command::DriveState;
use crate::simulation::ground::guide::{Along, wrap};
use crate::simulation::ground::plan::{direction_at, heading, station_at, turning};
use crate::trajectory::drive::Planar;

/// Way of decay at rest, in smallest turning radii: the vehicle must be able to drive the curve that the law asks for.
const RADII: f64 = 0.6;
/// Way of decay per speed, s: room for the delays of steering.
const TIME: f64 = 0.3;

/// Numbers of a run.
#[derive(Debug, Clone)]
pub(in crate::simulation::ground) struct Stanley {
    most: f64,
    axle: f64,
}

impl Stanley {
    /// Largest curvature and steered axle are the planned vehicle's.
    pub(super) fn new(nominal: &Rover) -> Self {
        Self { most: nominal.limits.curvature, axle: nominal.response.steered_axle }
    }

    /// κ in 1/m, within the largest curvature; d = 0.6 smallest radii + 0.3 s · v.
    pub(super) fn steer(&self, measured: &DriveState, along: &Along) -> f64 {
        let plan = station_at(along.stations, along.s, along.sign);
        let direction = direction_at(along.stations, along.s);
        let turning = turning(along.stations, along.s, self.axle);
        let leading = |at: &Planar, heading: f64| {
            let (sin, cos) = libm::sincos(at.yaw + heading);
            [at.x + self.axle * cos, at.y + self.axle * sin]
        };
        let planned = heading(direction, along.sign);
        let (wanted, actual) = (leading(&plan, planned), leading(&measured.at, along.heading));
        let bend = libm::atan((along.sign * plan.curvature + turning) * self.axle);
        let (sin, cos) = libm::sincos(plan.yaw + planned + bend);
        let off = cos * (actual[1] - wanted[1]) - sin * (actual[0] - wanted[0]);
        let decay = RADII / self.most + TIME * along.speed;
        let astray = wrap(plan.yaw - measured.at.yaw + (direction - measured.direction));
        let steering = astray + bend - libm::atan(off / decay);
        // Beyond a right angle the tangent would turn round.
        let steering = steering.clamp(-0.99 * FRAC_PI_2, 0.99 * FRAC_PI_2);
        (along.sign * (libm::tan(steering) / self.axle - turning)).clamp(-self.most, self.most)
    }
}
