//! What kinds of robots have in common where their scenarios are checked: a kind checks by building.

mod findings;
mod search;
mod spec;
mod vary;

pub(super) use findings::Findings;
pub(super) use search::{check_executed, check_search};
pub(super) use spec::check_spec;
pub(super) use vary::check_vary;
