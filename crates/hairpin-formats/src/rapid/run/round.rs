//! Whether a loop that is not left goes on as it does: one that comes back to where a round began never ends, and is
//! not followed until the bound of work tells it.

use std::collections::{BTreeMap, BTreeSet};

use super::scope::Scope;
use super::{Demanded, Frame, Machine};
use crate::rapid::value::Variable;

/// Values that are held beside what is executed, at most, and as many again as there were steps: so that looking takes
/// no longer than following.
const HELD: usize = 100_000;

/// All that decides what a round does. What depends on the cell is unknown in it, in every round.
#[derive(PartialEq)]
pub(super) struct State {
    globals: Scope<Variable>,
    variables: Vec<BTreeMap<String, Variable>>,
    demanded: Demanded,
    gripped: bool,
    soft: bool,
    carried: BTreeSet<String>,
}

impl Machine<'_> {
    /// The state in which round number `round` of a loop begins, from 1; of some rounds, ever fewer.
    pub(super) fn begun(&mut self, round: usize) -> Option<State> {
        let size = self.size + 1;
        if !round.is_power_of_two() || self.held.saturating_add(size) > HELD.saturating_add(self.steps) {
            return None;
        }
        self.held += size;
        Some(self.state())
    }

    /// Whether a round has ended where it `begun`: all that follow are as it was.
    pub(super) fn comes_again(&self, begun: Option<&State>) -> bool {
        begun.is_some_and(|begun| *begun == self.state())
    }

    fn state(&self) -> State {
        State {
            globals: self.globals.clone(),
            variables: self.frames.iter().map(|Frame { variables, .. }| variables.clone()).collect(),
            demanded: self.demanded,
            gripped: self.gripped,
            soft: self.soft,
            carried: self.carried.clone(),
        }
    }
}
