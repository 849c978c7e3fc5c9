//! Frames as scenarios give them.

use nalgebra::{Isometry3, Translation3, Vector3};

use crate::campaign::scenario::{FrameSection, Mistake};
use crate::robot::arm::{ArmError, unit_quaternion_of};

/// `parent_from_frame` of a section.
///
/// # Errors
/// `key.mm`, `key.q1_q4`.
pub(super) fn frame_of(key: &str, section: &FrameSection) -> Result<Isometry3<f64>, Mistake> {
    let turn = unit_quaternion_of("q1_q4", section.q1_q4).map_err(|error| mistake(key, error))?;
    Ok(Isometry3::from_parts(Translation3::from(Vector3::from(section.mm) * 1e-3), turn))
}

/// What is wrong with a table of the scenario, in its own words.
pub(super) fn mistake(table: &str, error: ArmError) -> Mistake {
    Mistake { key: format!("{table}.{}", error.field), value: error.value, bound: error.bound }
}
