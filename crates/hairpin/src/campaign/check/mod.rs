//! What kinds of robots have in common where their scenarios are checked: a kind checks by building.
//!
//! ```text
//! keys ─▶ Findings: bounds of single keys ─▶ build: what they describe ─▶ check_vary: the ends of what varies
//! ```
//!
//! All that is wrong is told at once, in the order of the file; there is a setup where nothing is. A `Mistake` has the
//! key as the user wrote it, the value and the bound in words.

mod findings;
mod places;
mod search;
mod spec;
mod vary;

pub(super) use findings::Findings;
pub(super) use places::check_places_within;
pub(super) use search::{check_executed, check_search};
pub(super) use spec::check_spec;
pub(super) use vary::check_vary;
