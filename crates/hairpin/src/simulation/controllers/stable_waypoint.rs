//! `stable-waypoint`: the cascade with gains that settle a 10 m step within 6 s and overshoot it by less than 5 %.

use nalgebra::Vector3;

use super::cascade::{Cascade, Gains};
use crate::robot::quadrotor::Quadrotor;

/// Fixed by `tests/library/step_responses.rs`.
const GAINS: Gains = Gains {
    position: Vector3::new(0.9, 0.9, 0.9),
    velocity_p: Vector3::new(2.5, 2.5, 3.0),
    velocity_i: Vector3::new(0.1, 0.1, 0.3),
    velocity_d: Vector3::new(0.05, 0.05, 0.05),
    winds_up: false,
    max_speed: 5.0,
    max_tilt: 0.5,
};

/// Commands of velocity go through one of these as well, whatever controller gives them.
pub(in crate::simulation) fn cascade(robot: &Quadrotor) -> Cascade {
    Cascade::new(robot, GAINS)
}
