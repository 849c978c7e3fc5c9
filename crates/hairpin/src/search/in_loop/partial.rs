//! Partial trajectories scored by executing them, as a beam grows them, under a budget.
//!
//! The score is the stress so far. The budget counts legs; what is left of it is dealt to the expansions that a way to
//! the end still takes, so that a trajectory is complete before it is spent, and a part is kept back for executing what
//! is complete. A partial trajectory that the budget does not reach is taken to be as stressful as what it extends,
//! behind all that was executed to that.
//!
//! What fails on the way leads, and all that begins with it fails alike, so that of what begins with one such failure
//! no more trajectories are completed than are wanted: the executions left go to others.

use std::cell::{Cell, OnceCell};
use std::rc::Rc;

use super::Rank;
use crate::math::random::hashed_unit;
use crate::search::growth::{Growth, Parent};
use crate::search::objective::{Additive, LegView};
use crate::search::task::Found;

/// What is asked for.
///
/// With `resumes` a leg costs one; without, a partial trajectory of n legs costs n, for it is flown from the start.
#[derive(Debug, Clone, PartialEq)]
pub struct PartialSettings {
    /// Waypoints of a trajectory, both ends included.
    pub length: usize,
    /// Whether its last leg only leads to the sink of a task without an end, and is not executed.
    pub free_end: bool,
    /// The budget: executions of a whole trajectory. One of n legs counts n, and a partial one the legs that are
    /// executed for it.
    pub executions: u64,
    /// Trajectories that executions are kept back for.
    pub wanted: usize,
    /// Partial trajectories that the beam expands at once.
    pub width: usize,
    /// Whether executions go on from where a partial trajectory has led, or begin at the start each time.
    pub resumes: bool,
    /// Seed of what is drawn.
    pub seed: u64,
}

/// What executing a partial trajectory came to.
///
/// `legs` are what the budget pays: those from the state that execution began at.
#[derive(Debug, Clone, PartialEq)]
pub struct Ran<S> {
    /// The stress so far; NaN: none was measured yet.
    pub stress: f64,
    /// Whether it came to an end that is worse than any stress.
    pub fails: bool,
    /// Robot and controller at its end, to go on from.
    pub state: Option<S>,
    /// Legs that were executed for it.
    pub legs: u64,
}

/// A partial trajectory: its last leg, and what came before.
#[derive(Debug)]
pub struct Step<N, S> {
    before: Option<Rc<Step<N, S>>>,
    node: N,
    waypoint: u32,
    /// Of the leg, s.
    duration: f64,
    /// What executing it came to, once it was executed: its rank's score, and the state that it led to.
    ran: OnceCell<(f64, Option<S>)>,
    /// Trajectories that were completed of what begins with its first failure, if it fails.
    failure: OnceCell<Rc<Cell<usize>>>,
}

impl<N, S> Drop for Step<N, S> {
    /// Not by recursion: trajectories may be long.
    fn drop(&mut self) {
        let mut next = self.before.take();
        while let Some(mut step) = next.and_then(Rc::into_inner) {
            next = step.before.take();
        }
    }
}

impl<N, S> Step<N, S> {
    /// The first failure that it goes on from, as far as was executed.
    fn failed_before(&self) -> Option<Rc<Cell<usize>>> {
        let steps = std::iter::successors(self.before.as_ref(), |step| step.before.as_ref());
        steps.filter_map(|step| step.failure.get()).next().map(Rc::clone)
    }
}

/// A partial trajectory as it is carried along: copies share what they have in common.
pub type Path<N, S> = Rc<Step<N, S>>;

/// Why there is no stress.
enum Unscored {
    /// The budget does not reach.
    Spent,
    /// It could not be executed, or was without a measure.
    Failed,
}

/// What executes partial trajectories over nodes `N`.
///
/// Errors are counts: what failed has used its legs up.
///
/// `whole` matters to robots that brake at their last waypoint: a partial trajectory is executed as if it went on.
pub trait Execute<N> {
    /// A robot and its controller where a partial trajectory has led them.
    type State;

    /// Executes `partial`, from its start or from a state and the number of legs that led to it; `whole`: it will not
    /// be extended.
    ///
    /// # Errors
    /// The number of legs that were executed in vain.
    fn execute(
        &mut self,
        partial: &Found<N>,
        from: Option<(&Self::State, usize)>,
        whole: bool,
    ) -> Result<Ran<Self::State>, u64>;
}

/// Scores by what `execute` measures ([`Rank::score`]); `objective` tells which legs are executed first where not all
/// can be.
///
/// Which legs of an expansion are executed is settled when it meets them: half are those that `objective` puts first,
/// half are drawn. The others stand behind what they extend.
#[derive(Debug)]
pub struct Executed<'o, O, E> {
    settings: PartialSettings,
    objective: &'o O,
    execute: E,
    /// Legs that the budget still has, and that were executed.
    left: u64,
    executed: u64,
    complete: usize,
    /// Whether the budget refused anything when nothing was kept back any more, and whether it refused a whole
    /// trajectory.
    spent: bool,
    stuck: bool,
    /// Which of the legs that were met are to be executed, and the next of them.
    chosen: Vec<bool>,
    next: usize,
    /// Whether what is being extended could not be executed.
    barren: bool,
    best: f64,
    best_so_far: Vec<f64>,
}

impl<'o, O: Additive, E> Executed<'o, O, E> {
    /// With nothing executed yet.
    ///
    /// The budget is executions · legs of a whole trajectory.
    pub fn new(settings: PartialSettings, objective: &'o O, execute: E) -> Self {
        let mut executed = Self {
            settings,
            objective,
            execute,
            left: 0,
            executed: 0,
            complete: 0,
            spent: false,
            stuck: false,
            chosen: Vec::new(),
            next: 0,
            barren: false,
            best: f64::NEG_INFINITY,
            best_so_far: Vec::new(),
        };
        executed.left = executed.settings.executions.saturating_mul(executed.legs());
        executed
    }

    /// Legs executed, all together.
    pub fn legs_executed(&self) -> u64 {
        self.executed
    }

    /// The largest stress of a whole trajectory after as many legs as each execution has; −∞ before the first.
    pub fn into_best_so_far(self) -> Vec<f64> {
        self.best_so_far
    }

    /// Legs of a whole trajectory that are executed.
    fn legs(&self) -> u64 {
        (self.settings.length as u64).saturating_sub(1 + u64::from(self.settings.free_end)).max(1)
    }

    /// Legs kept back.
    ///
    /// (trajectories still wanted) · (legs of one): what only complete trajectories may use.
    fn reserve(&self) -> u64 {
        self.legs().saturating_mul(self.settings.wanted.saturating_sub(self.complete) as u64)
    }

    /// Legs from a partial trajectory of `done` legs that one expansion executes: with `width` expansions for each leg
    /// up to the end the budget lasts until then.
    ///
    /// (left − reserve)/(width · Σ_{l > done} cost(l)), at least 1; cost(l) is 1 leg with resumption, l without.
    fn share(&self, done: u64) -> usize {
        let cost = |legs: u64| if self.settings.resumes { 1 } else { legs };
        let way: u64 = (done + 1..=self.legs()).map(cost).sum();
        let expansions = way.saturating_mul(self.settings.width.max(1) as u64).max(1);
        (self.left.saturating_sub(self.reserve()) / expansions).max(1) as usize
    }

    /// Legs beyond the last one whose end has a state, where executions go on; else all.
    fn pending<N, S>(&self, path: &Path<N, S>) -> u64 {
        let known = |step: &Path<N, S>| self.settings.resumes && matches!(step.ran.get(), Some((_, Some(_))));
        let steps = std::iter::successors(Some(path), |step| step.before.as_ref());
        steps.take_while(|step| step.before.is_some() && !known(step)).count() as u64
    }

    /// The score of `path`, executed if it was not before; `last`: it is a trajectory that is complete.
    fn score<N: Copy>(&mut self, path: &Path<N, E::State>, last: bool) -> Result<f64, Unscored>
    where
        E: Execute<N>,
    {
        if let Some((score, _)) = path.ran.get() {
            return Ok(*score);
        }
        let cost = self.pending(path);
        let kept_back = if last { 0 } else { self.reserve() };
        if cost.saturating_add(kept_back) > self.left {
            self.stuck |= last;
            self.spent |= self.reserve() == 0;
            return Err(Unscored::Spent);
        }
        let found = found(path);
        let done = found.waypoints.len() as u64 - 1;
        let from = std::iter::successors(Some(path), |step| step.before.as_ref()).nth(cost as usize);
        let state = from.filter(|_| self.settings.resumes).and_then(|step| step.ran.get()?.1.as_ref());
        let ran = self.execute.execute(&found, state.map(|state| (state, (done - cost) as usize)), done == self.legs());
        let legs = ran.as_ref().map_or_else(|in_vain| *in_vain, |ran| ran.legs);
        self.left = self.left.saturating_sub(legs);
        self.executed += legs;
        let executions = self.executed.div_ceil(self.legs()) as usize;
        self.best_so_far.resize(executions.max(self.best_so_far.len()), self.best);
        let Ran { stress, fails, state, .. } = ran.map_err(|_| Unscored::Failed)?;
        if !stress.is_nan() {
            if fails {
                let _ = path.failure.set(path.failed_before().unwrap_or_default());
            }
            let score = Rank { fails, stress }.score();
            let _ = path.ran.set((score, state));
            return Ok(score);
        }
        // Nothing was measured yet: as its beginning, but there is a state to go on from.
        let before = path.before.as_ref().and_then(|before| before.ran.get()).map(|(score, _)| *score);
        match (last, before) {
            (false, Some(score)) => {
                let _ = path.ran.set((score, state));
                Ok(score)
            }
            _ => Err(Unscored::Failed),
        }
    }

    /// Takes note of a complete trajectory.
    fn completed<N>(&mut self, path: &Path<N, E::State>, score: f64)
    where
        E: Execute<N>,
    {
        self.complete += 1;
        if let Some(completed) = path.failure.get() {
            completed.set(completed.get() + 1);
        }
        let stress = Rank::of_score(score).stress;
        if stress > self.best {
            self.best = stress;
            if let Some(last) = self.best_so_far.last_mut() {
                *last = stress;
            }
        }
    }
}

/// A partial trajectory in full.
fn found<N: Copy, S>(path: &Path<N, S>) -> Found<N> {
    let mut steps: Vec<&Path<N, S>> = std::iter::successors(Some(path), |step| step.before.as_ref()).collect();
    steps.reverse();
    Found {
        waypoints: steps.iter().map(|step| step.waypoint).collect(),
        nodes: steps.iter().map(|step| step.node).collect(),
        leg_times: steps[1..].iter().map(|step| step.duration).collect(),
        score: 0.0,
    }
}

impl<N, O, E> Growth<N> for Executed<'_, O, E>
where
    N: Copy,
    O: Additive,
    E: Execute<N>,
{
    type Memory = Path<N, E::State>;

    // Its score is measured: nothing is left to wait for, and the budget may end before its turn comes.
    const AT_ONCE: bool = true;

    fn start(&mut self, node: &N) -> (f64, Self::Memory) {
        let ran = OnceCell::from((f64::NEG_INFINITY, None));
        let failure = OnceCell::new();
        (f64::NEG_INFINITY, Rc::new(Step { before: None, node: *node, waypoint: 0, duration: 0.0, ran, failure }))
    }

    /// Chooses the legs of this parent that are to be executed, as the budget's share allows: half of them those that
    /// the plain objective puts first, half drawn by a hash of leg and depth, so that no order of calls changes the
    /// draw.
    fn meet<'l>(&mut self, parent: &Parent<Self::Memory>, legs: impl Iterator<Item = LegView<'l>>) {
        let done = parent.length as u64 - 1;
        (self.next, self.barren) = (0, false);
        self.chosen.clear();
        if done >= self.legs() {
            return;
        }
        // It may have been passed over: its legs are then executed once, not with each that extends it.
        self.barren = matches!(self.score(parent.memory, false), Err(Unscored::Failed));
        let (objective, seed) = (self.objective, self.settings.seed);
        let drawn = |leg: &LegView| hashed_unit(seed, &[leg.from.into(), leg.to.into(), done]);
        let both: Vec<[f64; 2]> = legs.map(|leg| [objective.own(&leg), drawn(&leg)]).collect();
        let share = self.share(done);
        self.chosen.resize(both.len(), both.len() <= share);
        if both.len() > share {
            // Half are those that the objective puts first, the others are drawn.
            for (by, count) in [(0, share.div_ceil(2)), (1, share / 2)] {
                let mut order: Vec<usize> = (0..both.len()).filter(|&leg| !self.chosen[leg]).collect();
                highest_first(&mut order, &|leg| both[leg][by]);
                order.iter().take(count).for_each(|&leg| self.chosen[leg] = true);
            }
        }
    }

    /// An executed leg's score is that of what was measured; a leg passed over inherits its parent's, one unit in the
    /// last place lower, so that what was measured leads. A parent that could not be executed has no legs, nor has what
    /// begins with a failure that enough trajectories begin with.
    fn extend(&mut self, parent: &Parent<Self::Memory>, leg: &LegView<'_>, to: &N) -> Option<(f64, Self::Memory)> {
        let done = parent.length as u64;
        let before = Some(Rc::clone(parent.memory));
        let (ran, failure) = (OnceCell::new(), OnceCell::new());
        let path = Rc::new(Step { before, node: *to, waypoint: leg.to, duration: leg.duration, ran, failure });
        if path.failed_before().is_some_and(|completed| completed.get() >= self.settings.wanted.max(1)) {
            return None;
        }
        if done >= self.legs() + u64::from(self.settings.free_end) {
            let whole = if self.settings.free_end { parent.memory } else { &path };
            let score = self.score(whole, true).ok()?;
            self.completed(whole, score);
            return Some((score, path));
        }
        let chosen = self.chosen.get(self.next).copied().unwrap_or(false);
        self.next += 1;
        if self.barren {
            return None;
        }
        if chosen {
            match self.score(&path, false) {
                Ok(score) => return Some((score, path)),
                Err(Unscored::Failed) => return None,
                Err(Unscored::Spent) => {}
            }
        }
        Some((parent.score.next_down(), path))
    }

    fn goes_on(&self, found: usize, wanted: usize) -> bool {
        self.left > 0 && if found < wanted { !self.stuck } else { !self.spent }
    }
}

/// Ties in the order of the legs. Beside the searches, which are compiled for each kind of node: a sort is as large as
/// they are.
fn highest_first(legs: &mut [usize], of: &dyn Fn(usize) -> f64) {
    legs.sort_by(|&a, &b| of(b).total_cmp(&of(a)).then(a.cmp(&b)));
}
