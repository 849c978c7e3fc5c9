//! A log as its page has it.

use hairpin::campaign::report::Shown;
use hairpin::campaign::{Case, CaseResult};

/// A log as its page has it.
#[derive(Debug)]
pub struct Sheet {
    pub(super) case: Case,
    pub(super) shown: Shown,
    /// What the same case came to in simulation.
    pub(super) simulated: Option<CaseResult>,
    /// What is not drawn, and why.
    pub(super) notes: Vec<String>,
}
