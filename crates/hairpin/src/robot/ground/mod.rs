//! Cars and differential drives on flat ground: their files, and the vehicle that the generator of drives and the plant
//! take them for.
//!
//! In the plane, without slip: what a file gives becomes bounds on κ and κ′ at a speed and a response, in the numbers
//! of a [`Rover`] without a suspension, so that everything that drives rovers drives these.

mod car;
mod differential_drive;
mod response;

#[cfg(feature = "unit-tests")]
mod tests;

pub use car::{Car, CarDescription, CarKind, CarLimits};
pub use differential_drive::{
    DifferentialDrive, DifferentialDriveDescription, DifferentialDriveKind, DifferentialDriveLimits,
};
pub use response::GroundResponse;

use std::collections::BTreeMap;

use crate::robot::estimated::{EstimatedNumber, OWN_NUMBERS, estimated_keys};
use crate::robot::rover::{
    Belly, Body, Kinematics, Limits, Response, Rims, Rover, RoverError, Slip, Suspension, Wheels,
};

fn named(name: &str) -> Result<String, RoverError> {
    if name.trim().is_empty() {
        return Err(RoverError { field: "name".into(), value: "\"\"".into(), bound: "a name for reports".into() });
    }
    Ok(name.to_owned())
}

/// The keys that a file calls estimated, of those that logs tell.
fn estimates(
    told: &BTreeMap<String, EstimatedNumber>,
    response: Option<&GroundResponse>,
) -> Result<Vec<&'static str>, RoverError> {
    let keys = estimated_keys(told, &GroundResponse::numbers(response));
    let wrong = |key: &str| RoverError { field: "estimated".into(), value: key.into(), bound: OWN_NUMBERS.into() };
    keys.map_err(wrong)
}

/// What car and differential drive have in common as vehicles without suspension.
struct Named<'a> {
    name: &'a str,
    caveat: &'a str,
    source: &'a str,
    estimated: &'a [&'static str],
    /// Its outline, seen from above.
    outline: Belly,
    /// Its two driven wheels, where they steer it.
    rims: Option<Rims>,
}

impl Named<'_> {
    /// No wheels, no weight, no slip; the outline is the underside's rectangle at height 0, by which keep-outs go.
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
            rims: self.rims,
            slip: Slip::default(),
            weight: None,
            kinematics: Kinematics::default(),
            default_speed,
            estimated: self.estimated.to_vec(),
        }
    }
}
