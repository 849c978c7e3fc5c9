//! `unstable-waypoint`: the same cascade, its position loop faster than its velocity loop and its integral winding up
//! while the tilt is at its limit, so that a 10 m step overshoots by 30 to 60 % before it settles.

use nalgebra::Vector3;

use super::cascade::{Cascade, Gains};
use crate::robot::quadrotor::Quadrotor;

/// Fixed by `tests/library/step_responses.rs`.
const GAINS: Gains = Gains {
    position: Vector3::new(3.0, 3.0, 1.5),
    velocity_p: Vector3::new(1.5, 1.5, 1.5),
    velocity_i: Vector3::new(0.55, 0.55, 0.3),
    velocity_d: Vector3::new(0.0, 0.0, 0.0),
    winds_up: true,
    max_speed: 15.0,
    max_tilt: 0.5,
};

/// With these gains and the robot's own top speed.
pub(super) fn cascade(robot: &Quadrotor) -> Cascade {
    Cascade::new(robot, GAINS)
}
