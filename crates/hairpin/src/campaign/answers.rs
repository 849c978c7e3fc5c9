//! What the executions of a search came to that was stopped: with them it comes to where it was without executing
//! anything twice, and goes on from there.

use std::collections::BTreeMap;

use crate::search::worst::Ran;

/// Executions by the fingerprints of what was executed; of what failed there is nothing.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Answers(BTreeMap<[u8; 16], Option<Ran>>);

impl Answers {
    /// What the execution of the plan with this fingerprint came to, if it was executed.
    pub fn of(&self, fingerprint: &[u8; 16]) -> Option<&Option<Ran>> {
        self.0.get(fingerprint)
    }

    /// Takes in what one came to.
    pub fn take(&mut self, fingerprint: [u8; 16], ran: Option<Ran>) {
        self.0.insert(fingerprint, ran);
    }

    /// All of them, in the order of their fingerprints.
    pub fn iter(&self) -> impl Iterator<Item = (&[u8; 16], Option<&Ran>)> {
        self.0.iter().map(|(fingerprint, ran)| (fingerprint, ran.as_ref()))
    }
}
