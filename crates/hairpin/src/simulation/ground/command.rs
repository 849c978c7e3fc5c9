//! What drives as its controllers see it: what is measured, and what motors and steering take.

use crate::robot::rover::Rover;
use crate::simulation::controller::Controlled;
use crate::trajectory::Track;
use crate::trajectory::drive::Planar;

/// What is measured of a drive: the plant's own state, with noise on x, y and ψ where the run asks for it. World frame:
/// x east, y north, z up.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DriveState {
    /// When, s.
    pub t: f64,
    /// x and y of the body's origin, m; yaw ψ, rad, not wrapped; and the curvature that the wheels are steered to, 1/m.
    pub at: Planar,
    /// z of the body's origin, m.
    pub height: f64,
    /// Of the wheels, m/s, negative in reverse.
    pub speed: f64,
    /// Of a turn in place, rad/s.
    pub turn_rate: f64,
    /// Roll φ and pitch θ, rad.
    pub lean: [f64; 2],
    /// Of travel in the body, as the wheels are steered, rad.
    pub direction: f64,
}

/// What a controller asks of motors and steering until its next turn; it acts after the latency, within the vehicle's
/// limits and lags.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct DriveCommand {
    /// Along the direction of travel, m/s, negative in reverse.
    pub speed: f64,
    /// Of the path, 1/m, positive to the left.
    pub curvature: f64,
    /// In place, rad/s; acts only while the vehicle stands, and makes it stand where it is not 0.
    pub turn_rate: f64,
    /// Of travel in the body, rad; 0 for what has no crab steering.
    pub direction: f64,
}

impl Controlled for Rover {
    const DOES: &'static str = "it drives";
    type State = DriveState;
    /// Poses in time with the channel `leg`.
    type Plan = Track;
    type Command = DriveCommand;

    fn is_finite(command: &DriveCommand) -> bool {
        let DriveCommand { speed, curvature, turn_rate, direction } = *command;
        [speed, curvature, turn_rate, direction].iter().all(|number| number.is_finite())
    }
}
