//! The worst that there is to find: one pool of executions for all cases that are asked for.
//!
//! | file | does |
//! | --- | --- |
//! | `field` | what is searched: plans, changes and executions come in as a trait |
//! | `scale` | how far two trajectories are apart |
//! | `archive` | the worst that differ, of all that was executed |
//! | `change` | how a plan becomes another |
//! | `portfolio` | which change is tried next |
//!
//! Data flow: draws and seeds are executed and fix the scale → rounds: a change each from what stands in the archive →
//! what is feasible is executed → the archive takes it over, in order → the first that stand are the answer. A round
//! has a fixed size and each of its places a stream of its own, so that the answer is the same on any number of
//! threads.
//!
//! No gradient, no model of the robot: only the order of stresses is used, but for the least distance that keeps near
//! copies of one trajectory from being many cases.

mod archive;
mod change;
mod field;
mod portfolio;
mod scale;
#[cfg(test)]
mod tests;

use std::collections::HashSet;

use rayon::prelude::*;

use self::archive::{Archive, Member};
use self::change::{Change, Child, FIRST_STEP, child};
pub use self::field::{Field, Ran};
use self::portfolio::Portfolio;
pub use self::scale::{Placed, Scale, Trace};
use super::in_loop::Trial;
use crate::math::random::{named_seed, stream};
use crate::trajectory::Route;

/// Share of the executions that is drawn at random before anything is changed.
const DRAWN: u64 = 10;
/// Executions of that kind at least, where there are twice as many in all.
const LEAST_DRAWN: u64 = 20;
/// Pairs of draws that may be nearer than two that stand.
const QUANTILE: f64 = 0.1;
/// Places of a round, at least and at most, and rounds that the executions suffice for.
const PLACES: [u64; 2] = [8, 64];
const ROUNDS: u64 = 40;
/// Parents at least.
const PARENTS: usize = 12;
/// Rounds in a row in which nothing new could be executed before the field counts as used up.
const FRUITLESS: u32 = 20;
/// Draws for one that is feasible, at most.
const DRAWS: u64 = 50;
/// What a child that stands as a parent is worth, beside one that is the worst of all cases.
const REWARD: f64 = 0.3;

/// What is asked for.
#[derive(Debug, Clone, PartialEq)]
pub struct WorstSettings {
    /// Trajectories that differ.
    pub cases: usize,
    /// Stresses that each execution is measured by, 1 or more.
    pub targets: usize,
    /// Executions of all together at most, failed ones included.
    pub executions: u64,
    /// Executions that rounds and the first draws are sized for: as many, unless something else ends the search.
    pub sized_for: u64,
    /// Executions of one trial at most.
    pub per_trial: u64,
    /// Seed of all that is drawn.
    pub seed: u64,
}

/// A trajectory that was found.
#[derive(Debug, Clone)]
pub struct Found<P> {
    /// The plan.
    pub plan: P,
    /// The target that it was kept for.
    pub target: usize,
    /// Its execution, by that target.
    pub trial: Trial,
}

/// The answer.
#[derive(Debug, Clone)]
pub struct Worst<P> {
    /// In turns for each target, the most stressful first, no two nearer than `apart`.
    pub found: Vec<Found<P>>,
    /// The stresses of each execution, one for each target, in order; `None` of those that failed.
    pub stresses: Vec<Option<Vec<f64>>>,
    /// Executions of trajectories that were drawn before anything was changed; they fix the scale.
    pub first: u64,
    /// Executions of all trajectories that were drawn at random.
    pub drawn: u64,
    /// The least distance of two that are found: the 10 % quantile of the distances of those drawn first.
    pub apart: f64,
    /// Why nothing was found, in a sentence's part.
    pub nothing: Option<String>,
}

/// Searches `field` until the executions are used up, nothing new is found, or `stopped`; `told` hears of the number of
/// executions after each round.
///
/// Where there are several targets each has an archive of its own, every execution is offered to all, and a portfolio
/// says for which one a round is made: one plain sum or minimum of them would let one hide the others. Source: Zhang,
/// Hasuo, Arcaini, Multi-armed bandits for Boolean connectives in hybrid system falsification, CAV 2019.
pub fn worst<F: Field>(
    field: &F,
    settings: &WorstSettings,
    stopped: &(dyn Fn() -> bool + Sync),
    told: &dyn Fn(u64),
) -> Worst<F::Plan> {
    let mut search = Search {
        field,
        settings,
        stopped,
        known: HashSet::new(),
        stresses: Vec::new(),
        drawn: 0,
        draws: 0,
        slots: 0,
        nothing: None,
    };
    let executed = search.first(told);
    let first = search.drawn;
    let traces: Vec<Trace> = executed.iter().map(|executed| executed.trace.clone()).collect();
    let scale = Scale::of(&traces);
    let apart = scale.quantile(&traces, QUANTILE);
    let most = PARENTS.max(settings.cases + settings.cases / 4);
    let mut archives: Vec<_> = (0..settings.targets.max(1)).map(|_| Archive::new(scale.clone(), apart, most)).collect();
    offer(&mut archives, executed);
    search.evolve(&mut archives, told);
    let found = dealt(&archives, settings.cases);
    let Search { stresses, drawn, nothing, .. } = search;
    let nothing = if found.is_empty() { nothing } else { None };
    Worst { found, stresses, first, drawn, apart, nothing }
}

/// What is executed is offered to the archive of each target.
fn offer<P: Clone>(archives: &mut [Archive<P>], executed: Vec<Executed<P>>) {
    for (target, archive) in archives.iter_mut().enumerate() {
        let measured = executed.iter().filter(|executed| !executed.trials[target].stress.is_nan());
        let members = measured.map(|executed| Member {
            plan: executed.plan.clone(),
            trial: executed.trials[target],
            placed: archive.place(&executed.trace),
            step: executed.step,
            number: executed.number,
        });
        let members = members.collect();
        archive.take(members);
    }
}

/// `count` of what stands, from each archive in turn, that differ also from each other.
fn dealt<P: Clone>(archives: &[Archive<P>], count: usize) -> Vec<Found<P>> {
    let mut standing: Vec<_> = archives.iter().map(Archive::standing).collect();
    let mut chosen: Vec<(usize, &Member<P>)> = Vec::with_capacity(count);
    let mut passed = 0;
    while chosen.len() < count && passed < standing.len() {
        passed = 0;
        for (target, standing) in standing.iter_mut().enumerate() {
            let differs = |member: &&Member<P>| {
                chosen.iter().all(|(_, other)| archives[target].differ(&member.placed, &other.placed))
            };
            match standing.find(differs) {
                Some(member) if chosen.len() < count => chosen.push((target, member)),
                _ => passed += 1,
            }
        }
    }
    let found = chosen.into_iter();
    found.map(|(target, member)| Found { plan: member.plan.clone(), target, trial: member.trial }).collect()
}

struct Search<'a, F: Field> {
    field: &'a F,
    settings: &'a WorstSettings,
    stopped: &'a (dyn Fn() -> bool + Sync),
    known: HashSet<[u8; 16]>,
    stresses: Vec<Option<Vec<f64>>>,
    drawn: u64,
    /// Draws that were asked for.
    draws: u64,
    /// Places of rounds.
    slots: u64,
    nothing: Option<String>,
}

/// A plan, what came of it, and how far it was stepped from its parent.
struct Executed<P> {
    plan: P,
    trials: Vec<Trial>,
    trace: Trace,
    step: f64,
    /// Executions before it.
    number: u64,
}

/// What became of a place of a round.
struct Slot<P> {
    change: usize,
    child: Option<Child<P>>,
}

impl<F: Field> Search<'_, F> {
    /// How many more trials are paid for.
    fn left(&self) -> u64 {
        self.settings.executions.saturating_sub(self.stresses.len() as u64) / self.settings.per_trial.max(1)
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
    fn first(&mut self, told: &dyn Fn(u64)) -> Vec<Executed<F::Plan>> {
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
                    Err(reason) => self.nothing = Some(reason),
                }
            }
            let before = self.stresses.len();
            executed.extend(self.execute(children, &self.any()).into_iter().flatten());
            self.drawn += (self.stresses.len() - before) as u64;
            told(self.stresses.len() as u64);
        }
        executed
    }

    /// Rounds of changes, each for one target.
    fn evolve(&mut self, archives: &mut [Archive<F::Plan>], told: &dyn Fn(u64)) {
        let changes: &[Change] = if self.field.moves() { &Change::ALL } else { &Change::OF_GRAPHS };
        let mut portfolios = vec![Portfolio::new(changes.len()); archives.len()];
        let mut targets = Portfolio::new(archives.len());
        let (mut fruitless, mut number) = (0, 0);
        while self.left() > 0 && fruitless < FRUITLESS && !(self.stopped)() {
            let target = targets.draw(&mut stream(named_seed(self.settings.seed, "target", number)));
            number += 1;
            let (archive, portfolio) = (&archives[target], &mut portfolios[target]);
            if archives.iter().all(|archive| archive.len() == 0) {
                break;
            }
            let cases = self.settings.cases.div_ceil(archives.len());
            let least: Vec<f64> = archives.iter().map(|archive| archive.least(cases)).collect();
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
                let reward = match number.and_then(|number| archives[target].rank(number)) {
                    Some(rank) if rank < cases => 1.0 - (1.0 - REWARD) * rank as f64 / cases as f64,
                    Some(_) => REWARD,
                    None => 0.0,
                };
                portfolios[target].reward(change, reward);
                targets.reward(target, reward);
                self.drawn += u64::from(changes[change] == Change::Draw && number.is_some());
            }
            told(self.stresses.len() as u64);
        }
    }

    /// The children of one round.
    fn round(&mut self, archive: &Archive<F::Plan>, changes: &[Change], portfolio: &Portfolio) -> Vec<Slot<F::Plan>> {
        let count = self.places().min(self.left());
        let (first, draws) = (self.slots, self.draws);
        self.slots += count;
        self.draws += count;
        let (field, seed) = (self.field, self.settings.seed);
        let (parents, cases): (Vec<_>, _) = (archive.standing().collect(), self.settings.cases);
        (first..first + count)
            .into_par_iter()
            .map(|slot| {
                let mut random = stream(named_seed(seed, "worst", slot));
                let change = portfolio.draw(&mut random);
                let child = child(field, changes[change], (&parents, cases), draws + (slot - first), &mut random);
                Slot { change, child }
            })
            .collect()
    }

    /// Executes what was not executed before; what failed, or was known, is `None`.
    fn execute(&mut self, children: Vec<Child<F::Plan>>, least: &[f64]) -> Vec<Option<Executed<F::Plan>>> {
        let mut left = self.left();
        let mut is_new = |child: &Child<F::Plan>| {
            let new = left > 0 && self.known.insert(self.field.fingerprint(&child.plan));
            left -= u64::from(new);
            new
        };
        let new: Vec<bool> = children.iter().map(&mut is_new).collect();
        let (field, stopped) = (self.field, self.stopped);
        let ran: Vec<Option<Option<Ran>>> = children
            .par_iter()
            .zip(&new)
            .map(|(child, new)| (*new && !stopped()).then(|| field.run(&child.plan, least)))
            .collect();
        let mut executed = Vec::with_capacity(children.len());
        for (Child { plan, step }, ran) in children.into_iter().zip(ran) {
            let Some(ran) = ran else {
                executed.push(None);
                continue;
            };
            // An infinite stress could not be told from a mistake.
            let ran = ran.map(|ran| {
                let finite =
                    |trial: Trial| if trial.stress.is_finite() { trial } else { Trial { stress: f64::NAN, ..trial } };
                Ran { trials: ran.trials.into_iter().map(finite).collect(), ..ran }
            });
            let stresses = ran.as_ref().map(|ran| ran.trials.iter().map(|trial| trial.stress).collect());
            let number = self.stresses.len() as u64;
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
