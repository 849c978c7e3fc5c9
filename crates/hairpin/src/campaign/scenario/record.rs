//! `execute.record`: of which runs the motion is kept.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What stays of runs beside what was measured of them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Record {
    /// The motion of every run.
    #[default]
    All,
    /// That of the worst run of each of the ten worst cases.
    Worst,
    /// None.
    None,
}

impl Record {
    /// Whether nothing is left out.
    pub fn is_all(&self) -> bool {
        *self == Self::All
    }

    /// The word in scenarios: `all`, `worst`, `none`.
    pub fn word(self) -> &'static str {
        match self {
            Self::All => "all",
            Self::Worst => "worst",
            Self::None => "none",
        }
    }
}
