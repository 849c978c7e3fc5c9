//! What the executions of a search came to that was stopped: with them it comes to where it was without executing
//! anything twice, and goes on from there.
//!
//! Kept beside the tally of an interrupted search `worst`. Fingerprints cover everything that decides an execution,
//! so that an answer is used for the same plan alone.

use std::collections::BTreeMap;

use crate::search::in_loop::Trial;
use crate::search::worst::Ran;

/// Executions by the fingerprints of what was executed; of what failed there is nothing.
///
/// In the order of fingerprints, so that files have one form.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Answers(BTreeMap<[u8; 16], Option<Ran>>);

/// An execution in plain numbers, as files have it.
///
/// A [`Ran`] without types of the search.
#[derive(Debug, Clone, PartialEq)]
pub struct Executed {
    /// By each target the stress (NaN where it was not measured), the leg that it is owed to, and how many executions
    /// it took.
    pub trials: Vec<(f64, usize, u64)>,
    /// Measures that tell it from others, or the stress of each leg (NaN where it was not measured) for who learns it.
    pub behaviour: Vec<f64>,
    /// Whether it violates something, whatever is limited.
    pub fails: bool,
}

/// What an execution came to; `None` of one that failed.
pub type Answer = Option<Executed>;

impl From<&Ran> for Executed {
    fn from(Ran { trials, behaviour }: &Ran) -> Self {
        let fails = trials.iter().any(|trial| trial.fails);
        let trial = |trial: &Trial| (trial.stress, trial.worst_leg, trial.executions);
        Self { trials: trials.iter().map(trial).collect(), behaviour: behaviour.clone(), fails }
    }
}

impl From<Executed> for Ran {
    fn from(Executed { trials, behaviour, fails }: Executed) -> Self {
        let trial = |(stress, worst_leg, executions)| Trial { stress, fails, worst_leg, executions };
        Self { trials: trials.into_iter().map(trial).collect(), behaviour }
    }
}

impl Answers {
    /// Those of `rows`.
    pub fn of_rows(rows: impl IntoIterator<Item = ([u8; 16], Answer)>) -> Self {
        Self(rows.into_iter().map(|(fingerprint, row)| (fingerprint, row.map(Ran::from))).collect())
    }

    /// All of them, in the order of their fingerprints.
    pub fn rows(&self) -> impl Iterator<Item = ([u8; 16], Answer)> {
        self.0.iter().map(|(fingerprint, ran)| (*fingerprint, ran.as_ref().map(Executed::from)))
    }

    /// What the execution of the plan with this fingerprint came to, if it was executed.
    ///
    /// `Some(None)`: executed, and failed.
    pub(super) fn of(&self, fingerprint: &[u8; 16]) -> Option<&Option<Ran>> {
        self.0.get(fingerprint)
    }

    /// Takes in what one came to.
    pub(super) fn take(&mut self, fingerprint: [u8; 16], ran: Option<Ran>) {
        self.0.insert(fingerprint, ran);
    }
}
