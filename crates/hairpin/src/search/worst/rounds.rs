//! Executions, round by round: draws first, then changes of what stands.
//!
//! Within a round nothing learns: parents, shares and the least stress are those from before it, and results are
//! taken over in the order of places. That is what makes the answer independent of threads; it costs a little, since
//! a round's children do not know of each other.

use std::collections::HashSet;

use rayon::prelude::*;

use super::archive::{Aim, Archive, Member};
use super::change::{Change, Child, FIRST_STEP, child};
use super::field::{Field, Ran};
use super::portfolio::Portfolio;
use super::scale::Trace;
use super::settings::WorstSettings;
use crate::math::random::{named_seed, stream};
use crate::search::in_loop::{Rank, Trial};
use crate::trajectory::Route;

/// Share of the executions that is drawn at random before anything is changed.
const DRAWN: u64 = 10;
/// Executions of that kind at least, where there are twice as many in all.
const LEAST_DRAWN: u64 = 20;
/// Places of a round, at least and at most, and rounds that the executions suffice for.
/// Small rounds learn sooner, large ones keep more threads busy.
const PLACES: [u64; 2] = [8, 64];
const ROUNDS: u64 = 40;
/// Rounds in a row in which nothing new could be executed before the field counts as used up.
const FRUITLESS: u32 = 20;
/// Draws for one that is feasible, at most.
const DRAWS: u64 = 50;
/// What a child that stands as a parent is worth, beside one that is the worst of all cases.
const REWARD: f64 = 0.3;

/// The search as far as it has come.
///
/// `stresses` grows by the executions of each trial, in the order of places: its length is the budget used.
pub(super) struct Search<'a, F: Field> {
    field: &'a F,
    settings: &'a WorstSettings,
    stopped: &'a (dyn Fn() -> bool + Sync),
    known: HashSet<[u8; 16]>,
    /// One for each target, of each execution; `None` of those that failed.
    pub(super) stresses: Vec<Option<Vec<f64>>>,
    /// Executions of what was drawn at random.
    pub(super) drawn: u64,
    /// Draws that were asked for.
    draws: u64,
    /// Places of rounds.
    slots: u64,
    /// Why the last draw gave nothing.
    pub(super) nothing: Option<String>,
}

/// A plan, what came of it, and how far it was stepped from its parent.
pub(super) struct Executed<P> {
    plan: P,
    trials: Vec<Trial>,
    pub(super) trace: Trace,
    step: f64,
    /// Executions before it.
    number: u64,
}

/// What is executed is offered to all archives; one execution may stand in several.
pub(super) fn offer<P: Clone>(archives: &mut [Archive<P>], executed: Vec<Executed<P>>) {
    for archive in archives {
        let member = |executed: &Executed<P>| {
            Some(Member {
                plan: executed.plan.clone(),
                trial: archive.aim.of(&executed.trials)?,
                placed: archive.place(&executed.trace),
                step: executed.step,
                number: executed.number,
            })
        };
        let members = executed.iter().filter_map(member).collect();
        archive.take(members);
    }
}

/// What became of a place of a round.
///
/// `change` is an index into the changes of the field, and is rewarded with 0 where `child` is `None`.
struct Slot<P> {
    change: usize,
    child: Option<Child<P>>,
}

impl<'a, F: Field> Search<'a, F> {
    /// With nothing executed.
    pub(super) fn new(field: &'a F, settings: &'a WorstSettings, stopped: &'a (dyn Fn() -> bool + Sync)) -> Self {
        let (known, stresses) = (HashSet::new(), Vec::new());
        Self { field, settings, stopped, known, stresses, drawn: 0, draws: 0, slots: 0, nothing: None }
    }

    /// Executions so far.
    pub(super) fn executions(&self) -> u64 {
        self.stresses.len() as u64
    }

    /// How many more trials are paid for.
    ///
    /// A trial is paid for in full before it is begun, whatever it takes in the end.
    fn left(&self) -> u64 {
        self.settings.executions.saturating_sub(self.executions()) / self.settings.per_trial.max(1)
    }

    /// Places of a round.
    fn places(&self) -> u64 {
        (self.settings.sized_for / ROUNDS).clamp(PLACES[0], PLACES[1])
    }

    /// Anything is worth being kept.
    fn any(&self) -> Vec<f64> {
        vec![f64::NEG_INFINITY; self.settings.targets.max(1)]
    }

    /// What is executed before anything is changed: seeds and draws.
    ///
    /// Draws go on in batches until enough were executed, at most 50 draws for each that is wanted. Seeds come first
    /// and may use the budget up.
    pub(super) fn first(&mut self, told: &dyn Fn(u64)) -> Vec<Executed<F::Plan>> {
        let executions = self.settings.sized_for;
        let wanted = (executions / DRAWN).max(LEAST_DRAWN.min(executions / 2)).max(1);
        let seeds = self.field.seeds().into_iter();
        let seeds = seeds.map(|plan| Child { plan, step: FIRST_STEP }).collect();
        let mut executed: Vec<_> = self.execute(seeds, &self.any()).into_iter().flatten().collect();
        let most = wanted * DRAWS;
        while self.drawn < wanted && self.draws < most && self.left() > 0 && !(self.stopped)() {
            let count = (wanted - self.drawn).min(self.left()).min(self.places());
            let numbers = self.draws..self.draws + count;
            self.draws += count;
            let drawn: Vec<_> = numbers.into_par_iter().map(|number| self.field.draw(number)).collect();
            let mut children = Vec::new();
            for plan in drawn {
                match plan {
                    Ok(plan) => children.push(Child { plan, step: FIRST_STEP }),
                    Err(reason) => self.nothing = reason.or(self.nothing.take()),
                }
            }
            let before = self.executions();
            executed.extend(self.execute(children, &self.any()).into_iter().flatten());
            self.drawn += self.executions() - before;
            told(self.executions());
        }
        executed
    }

    /// Rounds of changes, each for one archive, of those that have members.
    ///
    /// Reward of a child that stands as number r of the cases, from 0: 1 − 0.7 r / cases; 0.3 for one that stands
    /// behind them; 0 else. The archive of the round gets the same rewards as the change.
    pub(super) fn evolve(&mut self, archives: &mut [Archive<F::Plan>], told: &dyn Fn(u64)) {
        let changes: &[Change] = if self.field.moves() { &Change::ALL } else { &Change::OF_GRAPHS };
        let mut portfolios = vec![Portfolio::new(changes.len()); archives.len()];
        let mut aims = Portfolio::new(archives.len());
        let (mut fruitless, mut number) = (0, 0);
        while self.left() > 0 && fruitless < FRUITLESS && !(self.stopped)() {
            let open: Vec<bool> = archives.iter().map(|archive| archive.len() > 0).collect();
            let Some(of) = aims.draw(&open, &mut stream(named_seed(self.settings.seed, "target", number))) else {
                break;
            };
            number += 1;
            let (archive, portfolio) = (&archives[of], &mut portfolios[of]);
            let cases = self.settings.cases.div_ceil(open.iter().filter(|open| **open).count());
            let targets = archives.iter().filter(|archive| archive.aim != Aim::Failures);
            let least: Vec<f64> = targets.map(|archive| archive.least(cases)).collect();
            let slots = self.round(archive, changes, portfolio);
            let (mut tried, mut children) = (Vec::new(), Vec::new());
            for Slot { change, child } in slots {
                match child {
                    Some(child) => {
                        tried.push(change);
                        children.push(child);
                    }
                    None => portfolio.reward(change, 0.0),
                }
            }
            let executed = self.execute(children, &least);
            fruitless = if executed.iter().any(Option::is_some) { 0 } else { fruitless + 1 };
            let numbers: Vec<Option<u64>> =
                executed.iter().map(|executed| executed.as_ref().map(|executed| executed.number)).collect();
            offer(archives, executed.into_iter().flatten().collect());
            for (change, number) in tried.into_iter().zip(numbers) {
                let reward = match number.and_then(|number| archives[of].rank(number)) {
                    Some(rank) if rank < cases => 1.0 - (1.0 - REWARD) * rank as f64 / cases as f64,
                    Some(_) => REWARD,
                    None => 0.0,
                };
                portfolios[of].reward(change, reward);
                aims.reward(of, reward);
                self.drawn += u64::from(changes[change] == Change::Draw && number.is_some());
            }
            told(self.executions());
        }
    }

    /// The children of one round.
    ///
    /// Draw numbers and places are given out before the parallel part, one of each a place, used or not.
    fn round(&mut self, archive: &Archive<F::Plan>, changes: &[Change], portfolio: &Portfolio) -> Vec<Slot<F::Plan>> {
        let count = self.places().min(self.left());
        let (first, draws) = (self.slots, self.draws);
        self.slots += count;
        self.draws += count;
        let (field, seed) = (self.field, self.settings.seed);
        let (parents, cases): (Vec<_>, _) = (archive.standing().collect(), self.settings.cases);
        let open = vec![true; changes.len()];
        (first..first + count)
            .into_par_iter()
            .map(|slot| {
                let mut random = stream(named_seed(seed, "worst", slot));
                let change = portfolio.draw(&open, &mut random).unwrap_or_default();
                let child = child(field, changes[change], (&parents, cases), draws + (slot - first), &mut random);
                Slot { change, child }
            })
            .collect()
    }

    /// Executes what was not executed before; what failed, or was known, is `None`.
    ///
    /// As many entries as `children`, in their order. Of equal fingerprints in one round only the first is executed.
    /// What `stopped` cut off counts as known.
    fn execute(&mut self, children: Vec<Child<F::Plan>>, least: &[f64]) -> Vec<Option<Executed<F::Plan>>> {
        let mut left = self.left();
        let mut is_new = |child: &Child<F::Plan>| {
            let new = left > 0 && self.known.insert(self.field.fingerprint(&child.plan));
            left -= u64::from(new);
            new
        };
        let new: Vec<bool> = children.iter().map(&mut is_new).collect();
        let plans: Vec<&F::Plan> =
            children.iter().zip(&new).filter(|(_, new)| **new).map(|(child, _)| &child.plan).collect();
        let mut ran = self.field.run_all(&plans, least, self.stopped).into_iter();
        let mut executed = Vec::with_capacity(children.len());
        for (Child { plan, step }, new) in children.into_iter().zip(new) {
            let Some(ran) = new.then(|| ran.next().flatten()).flatten() else {
                executed.push(None);
                continue;
            };
            let ran = ran.map(|ran| {
                let ranked = |trial: Trial| Trial { stress: Rank::of(trial.fails, Some(trial.stress)).stress, ..trial };
                Ran { trials: ran.trials.into_iter().map(ranked).collect(), ..ran }
            });
            let stresses = ran.as_ref().map(|ran| ran.trials.iter().map(|trial| trial.stress).collect());
            let number = self.executions();
            let executions =
                ran.as_ref().map_or(1, |ran| ran.trials.iter().map(|trial| trial.executions).max().unwrap_or(1));
            self.stresses.extend((0..executions).map(|_| stresses.clone()));
            executed.push(ran.map(|Ran { trials, behaviour }| {
                let route = Route::along(self.field.points(&plan));
                Executed { plan, trials, trace: Trace { route, behaviour }, step, number }
            }));
        }
        executed
    }
}
