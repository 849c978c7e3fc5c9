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
    /// [`settings_hash`] of the scenario as hairpin wrote it; `None` of earlier versions.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub settings: Option<String>,
    /// [`key_digests`] of it, by which what was edited since has a name; empty of earlier versions.
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

/// BLAKE3 over what runs are executed by: the keys and values of the scenario in `text` but those of `spec`, which may
/// change once there are runs, and the bytes of the user's `controller`. Neither order nor layout of the text counts.
///
/// `None` where it is no TOML.
pub fn settings_hash(text: &str, controller: Option<&[u8]>) -> Option<String> {
    let mut hasher = blake3::Hasher::new();
    update(&mut hasher, &toml::Value::Table(settings(text)?));
    hasher.update(controller.unwrap_or_default());
    Some(hasher.finalize().to_hex().to_string())
}

/// The scenario in `text` but for `spec` and what made it; `None` where it is no TOML.
fn settings(text: &str) -> Option<toml::Table> {
    let mut scenario: toml::Table = text.parse().ok()?;
    scenario.remove(MADE_BY);
    scenario.remove("spec");
    Some(scenario)
}

/// The dotted keys that [`settings_hash`] counts, each with the first 32 bits of its value's BLAKE3: `task.length
/// 5f0c9a1b`. Enough to name what was edited; whether anything was is the whole hash's to say.
///
/// Empty where `text` is no TOML.
pub fn key_digests(text: &str) -> Vec<String> {
    let mut digests = Vec::new();
    if let Some(settings) = settings(text) {
        digest("", &toml::Value::Table(settings), &mut digests);
    }
    digests
}

fn digest(key: &str, value: &toml::Value, digests: &mut Vec<String>) {
    match value {
        toml::Value::Table(table) if key.is_empty() || !table.is_empty() => {
            for (name, value) in table.iter().collect::<BTreeMap<_, _>>() {
                // As it is typed: names of the user's (`[vary]`) may have dots of their own.
                let is_bare = name.chars().all(|c| c.is_ascii_alphanumeric() || "-_".contains(c));
                let name = if is_bare { name.clone() } else { format!("\"{name}\"") };
                digest(&if key.is_empty() { name } else { format!("{key}.{name}") }, value, digests);
            }
        }
        _ => {
            let mut hasher = blake3::Hasher::new();
            update(&mut hasher, value);
            digests.push(format!("{key} {}", &hasher.finalize().to_hex()[..8]));
        }
    }
}

/// The keys of which `text` has other values than `kept` has digests of, those that are gone and those that came
/// included.
pub fn changed_keys(kept: &[String], text: &str) -> Vec<String> {
    let kept: BTreeSet<&str> = kept.iter().map(String::as_str).collect();
    let now = key_digests(text);
    let now: BTreeSet<&str> = now.iter().map(String::as_str).collect();
    let key = |digest: &&str| digest.rsplit_once(' ').map_or_else(String::new, |(key, _)| key.to_owned());
    kept.symmetric_difference(&now).map(key).collect::<BTreeSet<_>>().into_iter().collect()
}

fn update(hasher: &mut blake3::Hasher, value: &toml::Value) {
    match value {
        toml::Value::Table(table) => {
            hasher.update(b"{");
            for (key, value) in table.iter().collect::<BTreeMap<_, _>>() {
                hasher.update(&(key.len() as u64).to_le_bytes()).update(key.as_bytes());
                update(hasher, value);
            }
            hasher.update(b"}");
        }
        toml::Value::Array(values) => {
            hasher.update(b"[");
            values.iter().for_each(|value| update(hasher, value));
            hasher.update(b"]");
        }
        one => {
            let text = one.to_string();
            hasher.update(&(text.len() as u64).to_le_bytes()).update(text.as_bytes());
        }
    }
}

/// `key = value`, tables inline: what stands on one line of a scenario file.
pub fn on_a_line(key: &str, value: &serde_json::Value) -> String {
    let value = toml::Value::try_from(value).map_or_else(|_| value.to_string(), |value| value.to_string());
    format!("{key} = {value}")
}
