//! `execute.flaky`: how often violations are run again.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::findings::Findings;

/// `flaky = { reruns = 20 }`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FlakySection {
    /// Runs of every violation, with what was drawn for it and other noise each.
    pub reruns: u64,
}

impl FlakySection {
    pub(super) fn check(section: Option<Self>, found: &mut Findings) {
        if let Some(section) = section {
            found.count("execute.flaky.reruns", section.reruns, 1, 100_000);
        }
    }
}
