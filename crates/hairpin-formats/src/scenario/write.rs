//! The resolved scenario of a campaign folder: a scenario file that runs again, with what made it.

use std::collections::{BTreeMap, BTreeSet};

use hairpin::campaign::Scenario;
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// The key of [`MadeBy`].
pub(crate) const MADE_BY: &str = "made_by";

/// `[made_by]`: what a campaign's results depend on beside the scenario. Readers of scenarios pass over it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MadeBy {
    /// Version of hairpin.
    pub version: String,
    /// Root seed.
    pub root_seed: u64,
    /// [`Digests::settings`] of the scenario as hairpin wrote it; `None` of earlier versions.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub settings: Option<String>,
    /// [`Digests::keys`] of it, by which what was edited since has a name; empty of earlier versions.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub keys: Vec<String>,
    /// How far off their paths (mm) what was proven clear of the plans holds, whatever `spec` has become since; `None`
    /// of earlier versions, and where nothing was proven.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub clear_within_mm: Option<f64>,
    /// SIMD level of the kernels: `portable`, `baseline`, `avx2`, `avx512` or `neon`. It stands last, so that what was
    /// cut off is missed.
    pub simd: String,
}

/// A scenario that TOML cannot hold: a whole number above 2⁶³ − 1, which checking refuses.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("the scenario cannot be written as TOML: {0}")]
pub struct WriteError(String);

#[derive(Serialize)]
struct Resolved<'s> {
    #[serde(flatten)]
    scenario: &'s Scenario,
    #[serde(skip_serializing_if = "Option::is_none")]
    made_by: Option<&'s MadeBy>,
}

/// What made the scenario in `text`; `None` where it does not say.
pub fn read_made_by(text: &str) -> Option<MadeBy> {
    #[derive(Deserialize)]
    struct Written {
        made_by: MadeBy,
    }
    toml::from_str::<Written>(text).ok().map(|written| written.made_by)
}

/// The scenario as TOML; reading it again gives the same scenario.
///
/// # Errors
/// [`WriteError`].
pub fn to_toml(scenario: &Scenario, made_by: Option<&MadeBy>) -> Result<String, WriteError> {
    toml::to_string(&Resolved { scenario, made_by }).map_err(|error| WriteError(error.to_string()))
}

/// Digests of what runs are executed by, one walk over its text.
pub struct Digests {
    /// BLAKE3 over the keys and values of the scenario but those of `spec`, which may change once there are runs, and
    /// the bytes of the user's controller. Neither order nor layout of the text counts.
    pub settings: String,
    /// The dotted keys of it, each with the first 32 bits of its value's BLAKE3: `task.length 5f0c9a1b`. Enough to name
    /// what was edited; whether anything was is the whole hash's to say.
    pub keys: Vec<String>,
}

impl Digests {
    /// Of the scenario in `text` and the bytes of the user's `controller`; `None` where it is no TOML.
    pub fn of(text: &str, controller: Option<&[u8]>) -> Option<Self> {
        let mut scenario: toml::Table = text.parse().ok()?;
        scenario.remove(MADE_BY);
        scenario.remove("spec");
        let (mut bytes, mut keys) = (Vec::new(), Vec::new());
        digest(&toml::Value::Table(scenario), Some(""), &mut bytes, &mut keys);
        bytes.extend_from_slice(controller.unwrap_or_default());
        Some(Self { settings: blake3::hash(&bytes).to_hex().to_string(), keys })
    }
}

/// Adds `value` to `bytes`, and the digest of each value in it to `keys`, dotted behind its own `key`; what an array
/// holds has none.
fn digest(value: &toml::Value, key: Option<&str>, bytes: &mut Vec<u8>, keys: &mut Vec<String>) {
    let from = bytes.len();
    let part = |bytes: &mut Vec<u8>, text: &str| {
        bytes.extend_from_slice(&(text.len() as u64).to_le_bytes());
        bytes.extend_from_slice(text.as_bytes());
    };
    // An empty table is a value.
    let mut has_keys = false;
    match value {
        toml::Value::Table(table) => {
            has_keys = key.is_some_and(|key| key.is_empty() || !table.is_empty());
            bytes.push(b'{');
            for (name, value) in table.iter().collect::<BTreeMap<_, _>>() {
                part(bytes, name);
                let within = key.map(|key| dotted(key, name));
                digest(value, within.as_deref(), bytes, keys);
            }
            bytes.push(b'}');
        }
        toml::Value::Array(values) => {
            bytes.push(b'[');
            values.iter().for_each(|value| digest(value, None, bytes, keys));
            bytes.push(b']');
        }
        one => part(bytes, &one.to_string()),
    }
    if let Some(key) = key.filter(|_| !has_keys) {
        keys.push(format!("{key} {}", &blake3::hash(&bytes[from..]).to_hex()[..8]));
    }
}

/// As it is typed: names of the user's (`[vary]`) may have dots of their own.
fn dotted(key: &str, name: &str) -> String {
    let is_bare = name.chars().all(|c| c.is_ascii_alphanumeric() || "-_".contains(c));
    let name = if is_bare { name.to_owned() } else { format!("\"{name}\"") };
    if key.is_empty() { name } else { format!("{key}.{name}") }
}

/// The keys of which `now` has other digests than `kept`, those that are gone and those that came included.
pub fn changed_keys(kept: &[String], now: &[String]) -> Vec<String> {
    let [kept, now] = [kept, now].map(|digests| digests.iter().map(String::as_str).collect::<BTreeSet<_>>());
    let key = |digest: &&str| digest.rsplit_once(' ').map_or_else(String::new, |(key, _)| key.to_owned());
    kept.symmetric_difference(&now).map(key).collect::<BTreeSet<_>>().into_iter().collect()
}

/// `key = value`, tables inline: what stands on one line of a scenario file.
pub fn on_a_line(key: &str, value: &serde_json::Value) -> String {
    let value = toml::Value::try_from(value).map_or_else(|_| value.to_string(), |value| value.to_string());
    format!("{key} = {value}")
}
