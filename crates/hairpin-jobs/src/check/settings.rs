//! What a check is asked.

use std::path::PathBuf;

use hairpin::math::simd::Simd;

use crate::sets::Set;

/// What is checked.
#[derive(Debug, Clone, Default)]
pub struct CheckSettings {
    /// The mission's file.
    pub mission: PathBuf,
    /// A robot's name or file, or a scenario.
    pub robot: String,
    /// A world's name or file, a map, or a scenario whose world it is.
    pub world: Option<String>,
    /// Keys of the scenario with other values.
    pub sets: Vec<Set>,
    /// Version of the kernels.
    pub simd: Simd,
}
