//! One sampled graph: what is asked of it, and what it gives.

mod outcome;
mod search;

pub(super) use outcome::{Outcome, Plan};
pub(super) use search::{Question, search};
