//! `execute.flaky`: how often violations are run again.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// `flaky = { reruns = 20 }`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FlakySection {
    /// Runs of every violation, with what was drawn for it and other noise each.
    pub reruns: u64,
}
