//! How numbers of a robot's file were estimated from logs.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How a number of a robot file was estimated.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EstimatedNumber {
    /// 95 % interval, in the key's unit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub interval: Option<[f64; 2]>,
    /// From what.
    pub from: String,
}

/// The keys that a file calls estimated, of those that it may: `given` has each, and whether the file has a number for
/// it.
///
/// # Errors
/// A key that is none of them, or has no number in the file.
pub(super) fn estimated_keys<'a>(
    told: &'a BTreeMap<String, EstimatedNumber>,
    given: &[(&'static str, bool)],
) -> Result<Vec<&'static str>, &'a str> {
    let known = |key: &'a String| {
        given.iter().find(|(name, has)| name == key && *has).map(|(name, _)| *name).ok_or(key.as_str())
    };
    told.keys().map(known).collect()
}

/// What [`estimated_keys`] asks of keys.
pub(super) const OWN_NUMBERS: &str = "keys of this file that have a number of their own";
