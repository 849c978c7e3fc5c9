//! The whole problem before any branching: a good path, good multipliers, and few arcs left.
//!
//! A split costs many times what kicks cost: the root alternates local search under multipliers' potentials with
//! subgradient steps until neither helps, and only then lets branching begin.

use super::ascent::{Ascent, Ended, Pace};
use super::best::Best;
use super::choices::{Arc, Choices, IN, Made, OPEN, OUT};
use super::cuts::violated;
use super::first_multipliers::first_multipliers;
use super::local::Local;
use super::problem::{Arcs, Ends};
use super::question::HeaviestSettings;
use super::record::{Next, Recorder};
use super::relaxation::{Relaxation, path_of};
use super::rounded::rounded;
use super::whole::Whole;
use crate::math::random::{named_seed, stream};

/// Candidates of each point while multipliers are far from good.
const NEAR: usize = 10;
/// Steps of the multipliers in each round.
const STEPS: usize = 200;
/// The whole table is taken up once so few arcs a point are left of it, or after so many rounds among few of them.
const FEW_LEFT: usize = 20;
const ROUNDS: usize = 8;
/// Rounds without a better path before branching begins.
const PATIENCE: usize = 2;
/// Steps along means of relaxed solutions, where so many arcs a point are left open that branching would be long.
const MEAN_STEPS: usize = 20000;
const MANY_OPEN: usize = 3;
/// Likewise of directed costs, whose means are dearer and mostly bring the bound down by less than splits do.
const MANY_OPEN_DIRECTED: usize = 5;
/// Rounds of cuts, each along means of relaxed solutions again.
const CUT_ROUNDS: usize = 8;
/// Rounds of steps and decisions under a wanted cost.
const NARROWED: usize = 2;
/// Costs times the scale are about so many bits long, so that multipliers are finer than costs.
const BITS: u32 = 33;

/// Units of a multiplier in one unit of cost.
///
/// A power of two, at most 2¹⁶: fine enough for multipliers, coarse enough for sums over n points to stay in 64 bits.
pub(super) fn scale_of(arcs: &Arcs) -> i64 {
    let mut scale = 1;
    while scale < 1 << 16 && arcs.largest().max(1) * scale < 1 << (BITS - 1) {
        scale *= 2;
    }
    scale
}

/// What a root goes back to where a wanted cost was too high.
pub(super) struct Kept {
    choices: Choices,
    made: Made,
    multipliers: Vec<i64>,
    step: usize,
    steps: usize,
    bound: i64,
    wanted: i64,
}

/// What is known of the whole problem.
pub(super) struct Root<'a, R> {
    pub(super) arcs: &'a Arcs,
    ends: Ends,
    pub(super) scale: i64,
    pub(super) choices: Choices,
    pub(super) made: Made,
    relaxation: R,
    ascent: Ascent,
    pub(super) multipliers: Vec<i64>,
    pub(super) best: Best,
    local: Local<'a>,
    pub(super) record: Recorder,
    /// The last step recorded.
    pub(super) step: usize,
    /// Upper bound, scaled.
    pub(super) bound: i64,
    stop: &'a (dyn Fn() -> bool + Sync),
}

impl<'a, R: Relaxation> Root<'a, R> {
    /// Of more than 3 [`NEAR`] points, the ascent begins among each point's [`NEAR`] heaviest arcs. What it reaches
    /// there is no bound of the whole ([`Root::widen`]).
    pub(super) fn new(
        arcs: &'a Arcs,
        settings: &HeaviestSettings,
        path: &[usize],
        record: Recorder,
        stop: &'a (dyn Fn() -> bool + Sync),
    ) -> Self {
        let (scale, ends) = (scale_of(arcs), settings.ends);
        let multipliers = first_multipliers(arcs, scale);
        let random = stream(named_seed(settings.seed, "heaviest path", 0));
        let local = Local::new(arcs, ends, path, &unscaled(&multipliers, scale), random, stop);
        let turns = arcs.symmetric() && ends == Ends::default();
        let mut best = Best::new(settings.programs, turns, settings.min_cost.unwrap_or(0));
        best.offer(arcs.total(path).unwrap_or(0), path.to_vec());
        let few = arcs.points() > 3 * NEAR;
        let choices = if few { Choices::near(arcs, scale, &multipliers, NEAR) } else { Choices::all(arcs, scale) };
        let made = Made::new(&choices, ends).unwrap_or_else(|| Made::nothing(&choices));
        let mut root = Self {
            arcs,
            ends,
            scale,
            relaxation: R::new(&choices),
            ascent: Ascent::new(&choices, 4 * arcs.largest() * scale),
            choices,
            made,
            multipliers,
            best,
            local,
            record,
            step: 0,
            bound: i64::MAX,
            stop,
        };
        root.polish(arcs.points() as u64);
        if few {
            // Among few arcs no bound is one of the whole problem, so that none may end the ascent.
            root.ascend(i64::MIN);
        }
        root
    }

    /// From few arcs to all that may be in a heavier path; whether that closes the problem, `None` if it was stopped
    /// before.
    ///
    /// Steps go along few arcs, to which those come that the heaviest tree of the whole has beside them, until its
    /// bound leaves few open. Where costs are directed all arcs come at once.
    pub(super) fn widen(&mut self) -> Option<bool> {
        if !self.arcs.symmetric() {
            self.take_up(Choices::all(self.arcs, self.scale));
            return Some(self.decide());
        }
        let points = self.arcs.points();
        let mut least = self.multipliers.clone();
        for round in 0.. {
            let threshold = self.threshold();
            let multipliers = std::mem::take(&mut self.multipliers);
            let whole = Whole::at(self.arcs, self.ends, self.scale, &multipliers);
            let (bound, tree) =
                whole.as_ref().map_or((i64::MIN, Vec::new()), |whole| (whole.bound, whole.tree().to_vec()));
            if bound < self.bound {
                self.bound = bound;
                least.copy_from_slice(&multipliers);
            }
            let mut left = 0;
            if let Some(whole) = whole.filter(|whole| whole.bound >= threshold) {
                whole.each(threshold, |_, stays| left += usize::from(stays));
            }
            self.multipliers = multipliers;
            if bound < threshold {
                return Some(self.close());
            }
            if left <= FEW_LEFT * points || round == ROUNDS {
                self.multipliers = least;
                return Some(self.keep());
            }
            if (self.stop)() {
                return None;
            }
            self.lack(tree);
            self.ascend(i64::MIN);
            self.polish(points as u64);
        }
        None
    }

    /// Takes arcs to the few that it lacks.
    fn lack(&mut self, tree: Vec<Arc>) {
        let mut arcs = std::mem::take(&mut self.choices.arcs);
        arcs.extend(tree);
        arcs.sort_unstable_by_key(|arc| (arc.from, arc.to));
        arcs.dedup_by_key(|arc| (arc.from, arc.to));
        self.take_up(Choices::new(self.arcs.points(), false, arcs));
    }

    /// Takes up those arcs of the whole that its bound leaves; whether nothing is left.
    fn keep(&mut self) -> bool {
        let threshold = self.threshold();
        let n = self.arcs.points() as u64;
        let (mut kept, mut out) = (Vec::new(), Vec::new());
        let wanted = self.record.wanted;
        let Some(whole) = Whole::at(self.arcs, self.ends, self.scale, &self.multipliers) else { return self.close() };
        whole.each(threshold, |arc, stays| match stays {
            true => kept.push(arc),
            false if wanted => out.push(u64::from(arc.from) * n + u64::from(arc.to)),
            false => {}
        });
        self.look(out, Vec::new());
        self.take_up(Choices::new(self.arcs.points(), false, kept));
        Made::new(&self.choices, self.ends).is_none()
    }

    /// Goes on with these choices, of which nothing is decided but what the ends say.
    fn take_up(&mut self, choices: Choices) {
        self.made = Made::new(&choices, self.ends).unwrap_or_else(|| Made::nothing(&choices));
        self.relaxation = R::new(&choices);
        self.choices = choices;
    }

    /// Takes paths that were found elsewhere; the local search goes on from the best.
    pub(super) fn learn(&mut self, best: Best) {
        for (cost, path) in best.into_paths() {
            self.local.offer(&path);
            self.best.offer(cost, path);
        }
    }

    /// Kicks the local search, and takes what it found.
    fn polish(&mut self, kicks: u64) -> bool {
        self.local.kick(kicks, self.stop);
        let before = self.best.cost();
        for (cost, path) in self.local.take_found() {
            self.best.offer(cost, path);
        }
        self.best.cost() > before
    }

    /// [`STEPS`] subgradient steps from the multipliers; the local search ranks its candidates by them afterwards.
    fn ascend(&mut self, threshold: i64) -> Ended {
        let pace = Pace { iterations: STEPS, alpha: 0.7, patience: 6 };
        let target = self.best.aim() as f64 * self.scale as f64;
        let problem = (&self.choices, &self.made);
        let ended =
            self.ascent.run(&mut self.relaxation, problem, &self.multipliers, (threshold, target), pace, self.stop);
        self.multipliers.copy_from_slice(&self.ascent.best);
        self.local.rank(&unscaled(&self.multipliers, self.scale));
        ended
    }

    /// Multipliers along means of relaxed solutions, kept if their bound is smaller; the local search goes on from the
    /// path that the last mean is close to.
    ///
    /// Kicks do not come from one order of narrow clusters to another; that path mostly has the right one.
    fn average(&mut self) -> Ended {
        let aims = (self.threshold(), self.best.aim() as f64 * self.scale as f64);
        let problem = (&self.choices, &self.made);
        let ended = self.ascent.mean(&mut self.relaxation, problem, &self.multipliers, aims, MEAN_STEPS, self.stop);
        if self.ascent.bound < self.bound || ended == Ended::Closed {
            self.multipliers.copy_from_slice(&self.ascent.best);
        }
        if ended == Ended::Open {
            self.local.rank(&unscaled(&self.multipliers, self.scale));
            self.local.mend(&rounded(&self.choices, &self.ascent.shares), self.stop);
            self.polish(self.arcs.points() as u64);
        }
        ended
    }

    /// Prices cuts that the mean of relaxed solutions violates, at first with 0; whether there is one.
    fn cut(&mut self) -> bool {
        if !self.arcs.symmetric() {
            return false;
        }
        let cuts = violated(&self.choices, &self.ascent.shares);
        let any = !cuts.is_empty();
        self.choices.cuts.extend(cuts);
        self.multipliers.resize(self.choices.multipliers(), 0);
        self.relaxation = R::new(&self.choices);
        any
    }

    /// Whether a round took a twentieth of what was left between the bound and the best.
    ///
    /// gap after < 0.95 · gap before, in scaled costs, both against the best path so far.
    fn nearer(&self, before: i64) -> bool {
        let best = self.best.cost().max(0) * self.scale;
        ((self.ascent.bound - best) as f64) < 0.95 * (before - best) as f64
    }

    /// Whether branching would be long: more than [`MANY_OPEN`] arcs a point ([`MANY_OPEN_DIRECTED`]) are neither in
    /// nor out, or of more than half of all points it is open whether they are met.
    pub(super) fn many_open(&self) -> bool {
        let n = self.arcs.points();
        let open = |from: usize, to: usize| self.made.state[from..to].iter().filter(|state| **state == OPEN).count();
        let loops = self.choices.looped(0);
        let many = if self.choices.directed { MANY_OPEN_DIRECTED } else { MANY_OPEN };
        open(0, self.choices.arcs.len()) > many * n || 2 * open(loops, loops + n) > n
    }

    /// Least scaled bound of interest: that of a path heavier than the best.
    fn threshold(&self) -> i64 {
        self.best.needed() * self.scale
    }

    /// Bounds the whole problem, and goes on while paths get better; whether nothing is left to prove.
    ///
    /// Rounds go in three stages: kicks and subgradient steps while paths get better and two rounds beyond; then,
    /// where much is open, steps along means of relaxed solutions; then cuts that the mean violates, priced by further
    /// means, eight rounds of them at most.
    pub(super) fn settle(&mut self, kicks: u64) -> bool {
        self.polish(2 * kicks);
        let (mut waited, mut averaged, mut rounds) = (0, false, 0);
        loop {
            if self.decide() {
                return true;
            }
            let patient = waited < PATIENCE;
            if (self.stop)() || !patient && (averaged || !self.many_open()) {
                return false;
            }
            let ended = if !patient {
                let before = self.bound;
                let ended = self.average();
                rounds += 1;
                averaged = rounds > CUT_ROUNDS || ended != Ended::Open || !self.cut() && !self.nearer(before);
                ended
            } else {
                waited = if self.polish(kicks) { 0 } else { waited + 1 };
                self.ascend(self.threshold())
            };
            match ended {
                Ended::Closed => return self.close(),
                Ended::Path => self.take_path(),
                Ended::Open => {}
            }
        }
    }

    /// Wants nothing below `least`, a cost that may be too high, and decides what follows; what to go back to, and
    /// whether nothing is left.
    pub(super) fn want(&mut self, least: i64) -> (Kept, bool) {
        let kept = Kept {
            choices: self.choices.clone(),
            made: self.made.clone(),
            multipliers: self.multipliers.clone(),
            step: self.step,
            steps: self.record.next_number(),
            bound: self.bound,
            wanted: self.best.want(least),
        };
        (kept, self.narrow())
    }

    /// Decides, and takes steps where that leaves fewer arcs; whether nothing is left.
    fn narrow(&mut self) -> bool {
        for _ in 0..NARROWED {
            if self.decide() {
                return true;
            }
            match self.ascend(self.threshold()) {
                Ended::Closed => return self.close(),
                Ended::Path => self.take_path(),
                Ended::Open => {}
            }
        }
        self.decide()
    }

    /// Goes back to what was before [`Root::want`].
    pub(super) fn go_back(&mut self, kept: Kept) {
        self.record.forget(kept.steps);
        self.best.want(kept.wanted);
        (self.multipliers, self.step, self.bound) = (kept.multipliers, kept.step, kept.bound);
        (self.choices, self.made) = (kept.choices, kept.made);
        self.relaxation = R::new(&self.choices);
    }

    /// The relaxed solution as a path, offered with its true cost.
    fn take_path(&mut self) {
        let path = path_of(&self.choices, self.relaxation.used());
        if let Some(cost) = self.arcs.total(&path) {
            self.best.offer(cost, path);
        }
    }

    /// Records that the bound at the multipliers is below what is wanted.
    fn close(&mut self) -> bool {
        self.look(Vec::new(), Vec::new());
        true
    }

    /// A step of the proof at the multipliers, after the last one.
    fn look(&mut self, out: Vec<u64>, into: Vec<u64>) {
        let first = self.record.next_number() == 0;
        let step = self.record.step(&self.choices, &self.multipliers, out, into);
        if !first {
            self.record.follow(self.step, Next::Again(step));
        }
        self.step = step;
    }

    /// Decides what the bound at the multipliers decides, and forgets the arcs that are out; whether nothing is left.
    ///
    /// The first time of the full table: O(m log m) and the tree's exchanges; then of few arcs.
    fn decide(&mut self) -> bool {
        let Some(bound) = self.relaxation.solve(&self.choices, &self.made, &self.multipliers, true) else {
            return self.close();
        };
        self.bound = self.bound.min(bound);
        let threshold = self.threshold();
        if bound < threshold {
            return self.close();
        }
        let mut decided = Vec::new();
        self.relaxation.decided(&self.choices, &self.made, &self.multipliers, bound, threshold, &mut decided);
        let numbers = |wanted: u8| {
            let those = decided.iter().filter(|(_, state)| *state == wanted && self.record.wanted);
            those.map(|(id, _)| self.choices.number(*id as usize)).collect()
        };
        let (out, into) = (numbers(OUT), numbers(IN));
        self.look(out, into);
        for (id, state) in &decided {
            if self.made.choose(&self.choices, *id as usize, *state).is_none() {
                return true;
            }
        }
        if self.made.follow(&self.choices).is_none() {
            return true;
        }
        let arcs = self.made.state[..self.choices.arcs.len()].iter().filter(|state| **state != OUT).count();
        if arcs < self.choices.arcs.len() {
            let Some((choices, made)) = forget(&self.choices, &self.made) else { return true };
            (self.choices, self.made) = (choices, made);
            self.relaxation = R::new(&self.choices);
        }
        false
    }
}

/// In units of cost, rounded towards 0: the local search only ranks by them.
fn unscaled(multipliers: &[i64], scale: i64) -> Vec<i64> {
    multipliers.iter().map(|multiplier| multiplier / scale).collect()
}

/// The same problem without the arcs that are out.
///
/// `None` where what is left contradicts itself. Choices keep their certificate numbers, as these do not count arcs
/// ([`Choices::number`]). O(m + n).
fn forget(choices: &Choices, made: &Made) -> Option<(Choices, Made)> {
    let kept: Vec<usize> = (0..choices.arcs.len()).filter(|id| made.state[*id] != OUT).collect();
    let mut few = Choices::new(choices.points, choices.directed, kept.iter().map(|id| choices.arcs[*id]).collect());
    few.cuts.clone_from(&choices.cuts);
    let mut small = Made::nothing(&few);
    let others = |choices: &Choices| choices.arcs.len()..choices.len();
    for (old, new) in kept.into_iter().chain(others(choices)).zip(0..few.len()) {
        if made.state[old] != OPEN {
            small.choose(&few, new, made.state[old])?;
        }
    }
    small.follow(&few)?;
    Some((few, small))
}
