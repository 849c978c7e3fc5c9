//! One sampled graph: what is asked of it, and what it gives.

mod in_order;
mod outcome;
mod search;

pub(super) use in_order::in_order;
pub(super) use outcome::{Outcome, Plan};
pub(super) use search::{Question, search};
