//! What `hairpin new KIND` writes: the shipped scenario of that name, a commented file that runs as it is.

use crate::library;

/// The kinds there is a commented file for.
pub const KINDS: &[&str] = &["quadrotor", "arm", "rover", "car", "differential-drive", "boat"];

/// The text of `KIND.toml`; `None` for a kind that is none of [`KINDS`].
pub fn template(kind: &str) -> Option<&'static str> {
    let kind = KINDS.iter().find(|known| **known == kind)?;
    library::scenarios().find(|shipped| shipped.name == *kind).map(|shipped| shipped.text)
}
