//! Cars and differential drives on flat ground: kinematic models, their files, and the vehicle that the generator of drives
//! takes them for.

mod car;
mod differential_drive;

#[cfg(test)]
mod tests;

pub use car::{Car, CarDescription, CarKind, CarLimits};
pub use differential_drive::{
    DifferentialDrive, DifferentialDriveDescription, DifferentialDriveKind, DifferentialDriveLimits,
};

use nalgebra::{Isometry3, SVector, Translation3};

use super::Dynamics;
use crate::math::integrate::rk4_step;
use crate::math::rotation::{quaternion_from_euler, unit_quaternion};
use crate::robot::rover::{Body, Limits, Response, Rover, RoverError, Slip, Suspension, Wheels};

fn named(name: &str) -> Result<String, RoverError> {
    if name.trim().is_empty() {
        return Err(RoverError { field: "name".into(), value: "\"\"".into(), bound: "a name for reports".into() });
    }
    Ok(name.to_owned())
}

/// `world_from_body` of x, y, ψ.
fn planar_pose(x: f64, y: f64, yaw: f64) -> Isometry3<f64> {
    Isometry3::from_parts(Translation3::new(x, y, 0.0), unit_quaternion(&quaternion_from_euler(0.0, 0.0, yaw)))
}

/// Longest step of a sampled run, s, and steps at least.
const STEP: f64 = 0.005;
const LEAST_STEPS: f64 = 100.0;

/// x, y (m), ψ (rad) after `time` s of constant `control` from `start`, states kept within their limits.
fn run<D: Dynamics<State = SVector<f64, 5>>>(robot: &D, start: &D::State, control: &D::Control, time: f64) -> [f64; 3] {
    let steps = (time / STEP).ceil().max(LEAST_STEPS);
    let mut state = *start;
    robot.normalize(&mut state);
    // A state at its limit moves as it stands there, at every stage of a step.
    let derivative = |x: &D::State| {
        let mut within = *x;
        robot.normalize(&mut within);
        robot.derivative(&within, control)
    };
    for _ in 0..steps as usize {
        state = rk4_step(derivative, &state, time / steps);
        robot.normalize(&mut state);
    }
    [state[0], state[1], state[2]]
}

/// `count` numbers from −`most` to `most`, both included; 0 for one.
fn grid(most: f64, count: usize) -> impl Iterator<Item = f64> + Clone {
    (0..count).map(move |i| if count > 1 { most * (2.0 * i as f64 / (count - 1) as f64 - 1.0) } else { 0.0 })
}

/// What car and differential drive have in common as vehicles without suspension.
struct Named<'a> {
    name: &'a str,
    caveat: &'a str,
    source: &'a str,
    estimated: &'a [&'static str],
}

impl Named<'_> {
    fn vehicle(&self, limits: Limits, response: Response, default_speed: f64) -> Rover {
        Rover {
            name: self.name.into(),
            caveat: self.caveat.into(),
            source: self.source.into(),
            suspension: Suspension::Level,
            body: Body::default(),
            wheels: Wheels::default(),
            limits,
            response,
            slip: Slip::default(),
            default_speed,
            estimated: self.estimated.to_vec(),
        }
    }
}
