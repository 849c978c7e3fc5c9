//! Branch and bound over choices with Lagrangian bounds: proves that no path is heavier than the best.
//!
//! Every problem gets a few steps of its multipliers; then what cannot be any more is out, what must be is in, and a
//! choice on which the relaxed solutions disagree splits what is left (Volgenant & Jonker 1982 for tours).
//!
//! Parts are shared out once, when 32 problems are open, a number that no thread count changes; each part is searched
//! depth first with its own best, and proofs are put together afterwards.

use rayon::prelude::*;

use super::ascent::{Ascent, Ended, Pace};
use super::best::Best;
use super::choices::{Choice, Choices, IN, Made, OPEN, OUT};
use super::problem::Arcs;
use super::record::{Next, Recorder};
use super::relaxation::{Relaxation, path_of};

/// Steps of the multipliers at each look: fewer leave bounds so slack that many times the problems have to be split.
const PACE: Pace = Pace { iterations: 60, alpha: 0.7, patience: 4 };
/// Looks at one problem, as long as each decides at least [`WORTHWHILE`] choices.
const LOOKS: usize = 4;
const WORTHWHILE: usize = 8;
/// How far below the best cost the steps aim, in shares of the gap at the root.
const AIM: f64 = 0.2;
/// Problems that are open before they are shared out: a number that does not depend on threads.
const SHARED_OUT: usize = 32;

/// What all problems of a search share.
#[derive(Clone, Copy)]
pub(super) struct Ground<'a> {
    /// The costs, unscaled.
    pub(super) arcs: &'a Arcs,
    /// What a path is made of: arcs, starts, loops and ends, by number.
    pub(super) choices: &'a Choices,
    /// What costs were multiplied by in multipliers and bounds.
    pub(super) scale: i64,
    /// Bound of the whole less the best cost, scaled.
    pub(super) gap: f64,
    /// Problems looked at, at most, in each part.
    pub(super) most_nodes: u64,
    /// Whether to end early, with what is open told; asked from several threads.
    pub(super) stop: &'a (dyn Fn() -> bool + Sync),
}

/// A problem: choices made, where its multipliers begin, and its bound.
pub(super) struct Open {
    /// Choices that are in or out on the way to this problem, with all that follows from them.
    pub(super) made: Made,
    /// Those of the problem that it was split from: bounds change little, so few steps are needed.
    pub(super) multipliers: Vec<i64>,
    pub(super) bound: i64,
    /// The step and side that it hangs on.
    parent: Option<(usize, u8)>,
}

impl Open {
    /// A problem that hangs on nothing: a root.
    pub(super) fn new(made: Made, multipliers: Vec<i64>, bound: i64) -> Self {
        Self { made, multipliers, bound, parent: None }
    }
}

/// What a search has come to.
pub(super) struct Searched {
    /// The heaviest paths known at its end, those that it began with among them.
    pub(super) best: Best,
    /// The largest bound of what is still open, scaled; `None` if nothing is.
    pub(super) open: Option<i64>,
    /// Problems looked at.
    pub(super) nodes: u64,
    /// The first step of the problem, if steps were recorded.
    pub(super) first: usize,
    /// A heavier path was found before the problems were shared out: the whole is better begun again with it.
    pub(super) again: bool,
}

/// A search on one thread.
struct Branching<'a, R> {
    ground: Ground<'a>,
    relaxation: R,
    ascent: Ascent,
    best: Best,
    record: Recorder,
    nodes: u64,
    decided: Vec<(u32, u8)>,
}

/// What it hangs on, a search, and what it left open.
type Part<'a, R> = (Option<(usize, u8)>, Branching<'a, R>, Option<i64>);

/// Searches all of a problem; the steps go to `record`.
///
/// Complete with `open` of `None`: then no path outside `best` reaches [`Best::needed`]. Parts know of each other's
/// paths only afterwards, which costs nodes and keeps the result free of the number of threads.
pub(super) fn branch<R: Relaxation>(ground: Ground<'_>, problem: Open, best: Best, record: &mut Recorder) -> Searched {
    let (first, before) = (record.next_number(), best.cost());
    let mut own = Branching::<R>::new(ground, best, std::mem::take(record));
    // Those with the largest bounds first, until there is enough to share out.
    let mut open = vec![problem];
    while !open.is_empty() && open.len() < SHARED_OUT && !own.exhausted() {
        let largest = (0..open.len()).max_by_key(|at| open[*at].bound).unwrap_or(0);
        let problem = open.remove(largest);
        own.look(problem, &mut open);
    }
    let Branching { best, record: mut steps, nodes, .. } = own;
    if best.cost() > before && !open.is_empty() {
        let open = open.iter().map(|problem| problem.bound).max();
        *record = steps;
        return Searched { best, open, nodes, first, again: true };
    }
    let parts: Vec<Part<'_, R>> = open
        .into_par_iter()
        .map(|problem| {
            let parent = problem.parent;
            let mut part = Branching::<R>::new(ground, best.clone(), Recorder::new(steps.wanted));
            let open = part.depth_first(Open { parent: None, ..problem });
            (parent, part, open)
        })
        .collect();
    let mut searched = Searched { best, open: None, nodes, first, again: false };
    for (parent, part, open) in parts {
        part.best.into_paths().into_iter().for_each(|(cost, path)| {
            searched.best.offer(cost, path);
        });
        searched.open = searched.open.max(open);
        searched.nodes += part.nodes;
        let base = steps.append(part.record.steps);
        hang(&mut steps, parent, base);
    }
    *record = steps;
    searched
}

/// Tells the parent's step which step is its child.
fn hang(record: &mut Recorder, parent: Option<(usize, u8)>, child: usize) {
    let Some((step, side)) = parent.filter(|_| record.wanted) else { return };
    if let Next::Branch { out, into, .. } = &mut record.steps[step].next {
        *(if side == OUT { out } else { into }) = child;
    }
}

impl<'a, R: Relaxation> Branching<'a, R> {
    fn new(ground: Ground<'a>, best: Best, record: Recorder) -> Self {
        Self {
            ground,
            relaxation: R::new(ground.choices),
            ascent: Ascent::new(ground.choices, 4 * ground.arcs.largest() * ground.scale),
            best,
            record,
            nodes: 0,
            decided: Vec::new(),
        }
    }

    fn exhausted(&self) -> bool {
        self.nodes >= self.ground.most_nodes || self.nodes.is_multiple_of(4) && (self.ground.stop)()
    }

    /// Least scaled bound that is still of interest.
    fn threshold(&self) -> i64 {
        self.best.needed() * self.ground.scale
    }

    /// Depth first; the largest bound of what was left open.
    fn depth_first(&mut self, problem: Open) -> Option<i64> {
        let mut open = vec![problem];
        while !self.exhausted() {
            let problem = open.pop()?;
            self.look(problem, &mut open);
        }
        open.retain(|problem| !self.is_closed(problem));
        open.iter().map(|problem| problem.bound).max()
    }

    /// Whether a problem that was never looked at is no longer of interest, as a better path was found since; then a
    /// leaf of the certificate says so, by the multipliers that its bound is of.
    fn is_closed(&mut self, problem: &Open) -> bool {
        let choices = self.ground.choices;
        let bound = self.relaxation.solve(choices, &problem.made, &problem.multipliers, true);
        let closed = bound.is_none_or(|bound| bound < self.threshold());
        if closed && self.record.wanted {
            let leaf = self.record.step(choices, &problem.multipliers, Vec::new(), Vec::new());
            hang(&mut self.record, problem.parent, leaf);
        }
        closed
    }

    /// Looks at one problem; what is left of it goes to `open`.
    ///
    /// In rounds: bound, decide by reduced costs, follow what is decided, and bound again while that decides enough;
    /// then split on the contested choice. The side without it is pushed last, so that depth first looks at it first;
    /// sides that contradict themselves become leaves of the certificate.
    fn look(&mut self, problem: Open, open: &mut Vec<Open>) {
        let Open { mut made, mut multipliers, parent, bound: mut least } = problem;
        self.nodes += 1;
        let choices = self.ground.choices;
        let mut last_step = None;
        for look in 1.. {
            let threshold = self.threshold();
            let target = self.best.aim() as f64 * self.ground.scale as f64 - AIM * self.ground.gap;
            let ended = self.ascent.run(
                &mut self.relaxation,
                (choices, &made),
                &multipliers,
                (threshold, target),
                PACE,
                &|| false,
            );
            multipliers.copy_from_slice(&self.ascent.best);
            if ended == Ended::Path {
                self.take_path();
            }
            let closed = ended == Ended::Closed || self.ascent.bound < self.threshold();
            least = least.min(self.ascent.bound);
            let decided = if closed { Some(0) } else { self.decide(&mut made, &multipliers) };
            let (out, into) = self.numbers(closed);
            let step = self.record.step(choices, &multipliers, out, into);
            match last_step {
                None => hang(&mut self.record, parent, step),
                Some(before) => self.record.follow(before, Next::Again(step)),
            }
            last_step = Some(step);
            let Some(decided) = decided.filter(|_| !closed) else { return };
            if decided >= WORTHWHILE && look < LOOKS {
                continue;
            }
            let Some(choice) = self.contested(&made) else {
                if decided > 0 {
                    // All is decided: the next look finds the path that is left, or that it is none.
                    continue;
                }
                return;
            };
            let number = self.ground.choices.number(choice);
            self.record.follow(step, Next::Branch { choice: number, out: step, into: step });
            for side in [IN, OUT] {
                let mut child = made.clone();
                let holds = child.choose(choices, choice, side).is_some() && child.follow(choices).is_some();
                let parent = Some((step, side));
                if holds {
                    open.push(Open { made: child, multipliers: multipliers.clone(), bound: least, parent });
                } else if self.record.wanted {
                    let leaf = self.record.step(choices, &multipliers, Vec::new(), Vec::new());
                    hang(&mut self.record, parent, leaf);
                }
            }
            return;
        }
    }

    /// Makes the choices that the bound at `multipliers` decides; how many, `None` if they contradict each other.
    fn decide(&mut self, made: &mut Made, multipliers: &[i64]) -> Option<usize> {
        let choices = self.ground.choices;
        self.decided.clear();
        let bound = self.relaxation.solve(choices, made, multipliers, false)?;
        let threshold = self.threshold();
        self.relaxation.decided(choices, made, multipliers, bound, threshold, &mut self.decided);
        for (id, state) in &self.decided {
            made.choose(choices, *id as usize, *state)?;
        }
        made.follow(choices)?;
        Some(self.decided.len())
    }

    /// What was decided, as a certificate has it: out, and in.
    fn numbers(&self, closed: bool) -> (Vec<u64>, Vec<u64>) {
        if closed || !self.record.wanted {
            return Default::default();
        }
        let of = |wanted: u8| {
            let chosen = self.decided.iter().filter(|(_, state)| *state == wanted);
            chosen.map(|(id, _)| self.ground.choices.number(*id as usize)).collect()
        };
        (of(OUT), of(IN))
    }

    /// The relaxed solution as a path, offered with its true cost.
    fn take_path(&mut self) {
        let path = path_of(self.ground.choices, self.relaxation.used());
        if let Some(cost) = self.ground.arcs.total(&path) {
            self.best.offer(cost, path);
        }
    }

    /// The open choice that is in about half of the relaxed solutions: whether a point is met at all rather than arcs,
    /// which mean little while that is open, and arcs rather than ends.
    fn contested(&self, made: &Made) -> Option<usize> {
        let score = |id: &usize| {
            let off = (self.ascent.share(*id) - 0.5).abs();
            match self.ground.choices.kind(*id) {
                Choice::Loop(_) => off - 0.3,
                Choice::Arc(_) => off,
                Choice::Start(_) | Choice::End(_) => off + 0.1,
            }
        };
        let open = (0..self.ground.choices.len()).filter(|id| made.state[*id] == OPEN);
        open.min_by(|a, b| score(a).total_cmp(&score(b)))
    }
}
