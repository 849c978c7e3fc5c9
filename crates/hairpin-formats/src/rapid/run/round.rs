//! Whether a loop that is not left goes on as it does: one that comes back to where a round began never ends, and is
//! not followed until the bound of work tells it. The cycles of `main` are such rounds.

use std::collections::{BTreeMap, BTreeSet};

use super::scope::Scope;
use super::{Demanded, Machine};
use crate::rapid::predefined;
use crate::rapid::value::Variable;

/// Values that are held beside what is executed, at most, and as many again as there were steps: so that looking takes
/// no longer than following.
const HELD: usize = 100_000;

/// All that decides what a round does. What depends on the cell is unknown in it, in every round.
pub(super) struct State {
    globals: Scope<Variable>,
    variables: Vec<BTreeMap<String, Variable>>,
    demanded: Demanded,
    gripped: bool,
    soft: bool,
    carried: BTreeSet<String>,
    /// Number of the round, from 1.
    round: usize,
}

impl Machine<'_> {
    /// Keeps in `begun` the state in which round number `round` of a loop begins, from 1; of some rounds, ever fewer
    /// (Brent's method), so that a loop is found that comes back after several rounds.
    pub(super) fn begins(&mut self, round: usize, begun: &mut Option<State>) {
        if round.is_power_of_two() && self.may_look() {
            self.keep(round, begun);
        }
    }

    /// The same of a cycle. The first is kept at any size: it is what was declared just now, and most programs begin
    /// again as they began.
    pub(super) fn begins_cycle(&mut self, cycle: usize, begun: &mut Option<State>) {
        if cycle == 1 || (cycle.is_power_of_two() && self.may_look()) {
            self.keep(cycle, begun);
            (self.said, self.found) = Default::default();
        }
    }

    fn keep(&self, round: usize, begun: &mut Option<State>) {
        *begun = Some(State {
            globals: self.globals.clone(),
            variables: self.frames.iter().map(|frame| frame.variables.clone()).collect(),
            demanded: self.demanded,
            gripped: self.gripped,
            soft: self.soft,
            carried: self.carried.clone(),
            round,
        });
    }

    /// Whether a round has ended where one has `begun`: all that follow are as those since. What only counts and tells
    /// may have gone on ([`super::decides`]).
    pub(super) fn comes_again(&mut self, begun: Option<&State>) -> bool {
        begun.is_some_and(|begun| self.may_look() && self.is_as(begun))
    }

    /// Whether a cycle has ended where one has `begun`. What every cycle since has said itself before it moved (ConfL,
    /// ConfJ), and that tools have moved to which nothing was ever assigned, makes no difference to what they do.
    pub(super) fn begins_as(&mut self, begun: Option<&mut State>) -> bool {
        let Some(begun) = begun.filter(|begun| begun.round == 1 || self.may_look()) else { return false };
        if !self.found.linear {
            begun.demanded.linear = self.demanded.linear;
        }
        if !self.found.joint {
            begun.demanded.joint = self.demanded.joint;
        }
        begun.carried.extend(self.carried.iter().filter(|name| self.is_never_assigned(name)).cloned());
        self.is_as(begun)
    }

    /// Whether no module has data of the name that anything was assigned to; of none at all it is the controller's.
    fn is_never_assigned(&self, name: &str) -> bool {
        let mut of_modules = self.globals.all(name).peekable();
        let is_known = of_modules.peek().is_some()
            || self.known.tools.iter().any(|tool| tool.name.eq_ignore_ascii_case(name))
            || predefined::value(name).is_some();
        is_known && of_modules.all(|variable| variable.untouched)
    }

    fn is_as(&self, begun: &State) -> bool {
        let deciding = self.deciding.get_or_init(|| super::decides::deciding(self.source));
        let counts = |name: &str| !deciding.contains(name);
        let frames = begun.variables.iter().zip(&self.frames);
        (begun.demanded, begun.gripped, begun.soft) == (self.demanded, self.gripped, self.soft)
            && begun.carried == self.carried
            && begun.variables.len() == self.frames.len()
            && frames.into_iter().all(|(then, now)| agree(then, &now.variables, &counts))
            && begun.globals.agrees(&self.globals, |then, now| agree(then, now, &counts))
    }

    /// Leaves out the moves of the rounds since one has `begun` where as many rounds before were the same moves: a loop
    /// that first has to come to its state is not told twice. `before` are the moves before each round.
    pub(super) fn tell_once(&mut self, begun: Option<&State>, before: &[usize]) {
        let Some(last) = begun.map(|begun| begun.round - 1) else { return };
        let Some(earlier) = (2 * last).checked_sub(before.len()) else { return };
        let (from, to) = (before[earlier], before[last]);
        let is_same = self.moves[from..to] == self.moves[to..];
        if is_same && self.unclear.is_none_or(|(certain, _)| certain <= to) {
            self.moves.truncate(to);
        }
    }

    /// Whether there is work left for looking, which is taken.
    fn may_look(&mut self) -> bool {
        let held = self.held.saturating_add(self.size + 1);
        let may = held <= HELD.saturating_add(self.steps);
        if may {
            self.held = held;
        }
        may
    }
}

/// Whether both hold the same, but for what `counts`.
fn agree(then: &BTreeMap<String, Variable>, now: &BTreeMap<String, Variable>, counts: &dyn Fn(&str) -> bool) -> bool {
    let same = |(name, was): (&String, &Variable)| counts(name) || now.get(name) == Some(was);
    then.len() == now.len() && then.iter().all(same)
}
