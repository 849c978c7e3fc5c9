//! Cars and differential drives on flat ground: kinematic models, their files, and the vehicle that the generator of drives
//! takes them for.
//!
//! Each has equations of its own ([`crate::robot::Dynamics`], five states, for plants and sampled reach sets) and a
//! `vehicle()`: the numbers by which generator of drives, controllers and judge take it for a [`Rover`] without
//! suspension, with bounds on κ and κ′ that its own limits imply at its default speed. So a car's drive is one that the
//! car's own equations can follow.

mod car;
mod differential_drive;

#[cfg(test)]
mod tests;

pub use car::{Car, CarDescription, CarKind, CarLimits};
pub use differential_drive::{
    DifferentialDrive, DifferentialDriveDescription, DifferentialDriveKind, DifferentialDriveLimits,
};

use nalgebra::{Isometry3, Translation3};

use crate::math::rotation::{quaternion_from_euler, unit_quaternion};
use crate::robot::rover::{Belly, Body, Kinematics, Limits, Response, Rover, RoverError, Slip, Suspension, Wheels};

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

/// What car and differential drive have in common as vehicles without suspension.
struct Named<'a> {
    name: &'a str,
    caveat: &'a str,
    source: &'a str,
    estimated: &'a [&'static str],
    /// Its outline, seen from above.
    outline: Belly,
}

impl Named<'_> {
    fn vehicle(&self, limits: Limits, response: Response, default_speed: f64) -> Rover {
        Rover {
            name: self.name.into(),
            caveat: self.caveat.into(),
            source: self.source.into(),
            suspension: Suspension::Level,
            body: Body { belly: self.outline, ..Body::default() },
            wheels: Wheels::default(),
            limits,
            response,
            slip: Slip::default(),
            weight: None,
            kinematics: Kinematics::default(),
            default_speed,
            estimated: self.estimated.to_vec(),
        }
    }
}
