//! What models are made of.

use serde::{Deserialize, Serialize};

/// A feature of legs that models are made of.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Feature {
    /// Its name.
    pub name: String,
    /// Its unit.
    pub unit: String,
}
