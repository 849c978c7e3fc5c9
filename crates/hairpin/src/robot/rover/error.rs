//! What a vehicle's file is refused for, and the questions that most of its numbers are asked.

use nalgebra::Vector3;
use thiserror::Error;

/// Why a file's numbers are no vehicle.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("{field} = {value}: must be {bound}")]
pub struct RoverError {
    /// Key of the robot file, such as `suspension.wheel_radius_m`.
    pub field: String,
    /// The offending value.
    pub value: String,
    /// What it must be.
    pub bound: String,
}

/// A place on the vehicle.
pub(super) fn place(key: &str, at: &[f64; 3]) -> Result<Vector3<f64>, RoverError> {
    for value in at {
        within(key, *value, -100.0, 100.0)?;
    }
    Ok(Vector3::from(*at))
}

/// `value`, if it lies between the two.
pub(in crate::robot) fn within(key: &str, value: f64, low: f64, high: f64) -> Result<f64, RoverError> {
    if (low..=high).contains(&value) {
        Ok(value)
    } else {
        Err(wrong(key, value, format!("a number from {low} to {high}")))
    }
}

pub(super) fn wrong(field: &str, value: impl ToString, bound: impl Into<String>) -> RoverError {
    RoverError { field: field.into(), value: value.to_string(), bound: bound.into() }
}
