//! What a program says of itself in its first `ready`.

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::failure::excerpt;
use super::heard::ReadyMessage;

/// Room for a name.
const LONGEST_NAME: usize = 100;

/// A program by its own words.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Greeting {
    /// Its name; empty where it has none.
    pub name: String,
    /// Which version of it this is.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub version: Option<String>,
    /// The protocol that it speaks.
    pub protocol: u64,
    /// Whether, by its own word, the same mission is the same flight to the bit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub deterministic: Option<bool>,
    /// Whether missions come with their timed motion, which is nearly all of their length; they do unless it says no.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub timed: Option<bool>,
}

impl Greeting {
    /// Whether it is that of the same version of the same program, by their own words.
    pub fn is_of_same(&self, other: &Self) -> bool {
        (&self.name, &self.version) == (&other.name, &other.version)
    }

    /// That of its `ready`, in `protocol`.
    pub(super) fn of(ready: &ReadyMessage, protocol: u64) -> Self {
        let version = ready.version.as_ref().map(|version| match version {
            Value::String(text) => excerpt(text, LONGEST_NAME),
            other => excerpt(&other.to_string(), LONGEST_NAME),
        });
        let name = excerpt(ready.name.trim(), LONGEST_NAME);
        Self { name, version, protocol, deterministic: ready.deterministic, timed: ready.timed }
    }
}
