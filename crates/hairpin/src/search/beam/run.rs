//! One graph's run: the spine of algorithm 2.
//!
//! Order of an iteration: select, complete or expand each selected one, bound the frontier, ask whether to go on. An
//! entry that was overtaken by better twins since it was pushed is dropped as it comes up.

use std::cmp::Ordering;
use std::hash::Hash;

use super::super::frontier::{IntervalHeap, Tree};
use super::super::growth::{Growth, Parent};
use super::super::objective::LegView;
use super::super::task::{Found, Task};
use super::atlas::{Atlas, KnownLeg};
use super::outcome::{BeamOutcome, Ended};
use super::reduction::Reduction;
use super::settings::BeamSettings;
use crate::feasibility::reach::Reach;

/// Lookahead at most: the backward pass recurses.
const DEEPEST: usize = 64;

/// A partial trajectory on the frontier.
#[derive(Debug, Clone, Copy)]
struct Entry {
    /// Its score above what its legs are worth at least.
    rank: f64,
    id: u32,
}

/// What an observer sees of an iteration: waypoint indices and scores, best first.
///
/// What fig. 4 of the paper shows: which partial trajectories were chosen, and what was put back. Indices are those
/// of the task's candidates, each list begins with 0.
#[derive(Debug, Clone, PartialEq)]
pub struct Snapshot {
    /// Number of the iteration, from 1.
    pub iteration: usize,
    /// What was selected from the frontier.
    pub selected: Vec<(Vec<u32>, f64)>,
    /// The frontier after the iteration.
    pub frontier: Vec<(Vec<u32>, f64)>,
}

/// Better is greater: by rank, ties by waypoint index.
///
/// A total order, so that the search does not depend on how a heap arranges equals. O(1) where ranks differ, else as
/// long as the trajectories since they parted.
/// Its type knows nothing of reach sets: heap and sort are compiled once for all of them.
fn order<M: Clone>(tree: &Tree<M>) -> impl Fn(&Entry, &Entry) -> Ordering {
    |a, b| a.rank.total_cmp(&b.rank).then_with(|| tree.lexicographic(b.id, a.id))
}

fn best_first<M: Clone>(tree: &Tree<M>, entries: &mut [Entry]) {
    let order = order(tree);
    entries.sort_by(|a, b| order(b, a));
}

/// One graph's search in progress; made, run to its end by `finish`, and gone.
pub(super) struct Run<'a, N, R: ?Sized, G: Growth<N>, P> {
    task: &'a Task<'a, N, R>,
    growth: &'a mut G,
    settings: &'a BeamSettings,
    atlas: Atlas<'a, N, R, P>,
    tree: Tree<G::Memory>,
    frontier: IntervalHeap<Entry>,
    /// What each leg is worth at least, as the ranks of the frontier have it.
    least: f64,
    reduction: Option<Reduction>,
    /// Waypoints of the partial trajectory being expanded, one bit each.
    visited: Vec<u64>,
    /// Legs that may extend it.
    open: Vec<usize>,
    outcome: BeamOutcome<N>,
}

impl<'a, N, R, G, P> Run<'a, N, R, G, P>
where
    N: Copy + Eq + Ord + Hash,
    R: Reach<N> + ?Sized,
    G: Growth<N>,
    P: Fn(&N, usize) -> bool,
{
    /// Lengths below 2 and tasks with fewer than two candidates begin with an empty frontier: exhausted, with proof.
    pub(super) fn new(task: &'a Task<'a, N, R>, growth: &'a mut G, may_arrive: P, settings: &'a BeamSettings) -> Self {
        let (score, memory) = growth.start(&task.start);
        let tree = Tree::new(0, 0, score, memory);
        let mut frontier = IntervalHeap::new();
        if settings.length >= 2 && task.candidates.len() >= 2 {
            frontier.push(Entry { rank: score, id: 0 }, order(&tree));
        }
        Self {
            task,
            growth,
            settings,
            atlas: Atlas::new(task, may_arrive, settings.revisits, settings.length),
            tree,
            frontier,
            least: 0.0,
            reduction: settings.keep.map(Reduction::new),
            visited: vec![0; task.candidates.len().div_ceil(64)],
            open: Vec::new(),
            outcome: BeamOutcome {
                found: Vec::new(),
                ended: Ended::Capped,
                iterations: 0,
                expansions: 0,
                evaluations: 0,
                dropped: 0,
                unkept: 0,
                pruned: 0,
                reduced: 0,
                duplicates: 0,
            },
        }
    }

    /// Runs the graph to its end.
    ///
    /// The observer is shown each iteration after it was made; sorting the frontier for it is paid for only if there is
    /// one.
    pub(super) fn finish(mut self, mut observe: Option<&mut dyn FnMut(&Snapshot)>) -> BeamOutcome<N> {
        let mut selected = Vec::with_capacity(self.settings.width.max(1));
        while self.outcome.iterations < self.settings.iterations {
            self.select(&mut selected);
            if selected.is_empty() {
                self.outcome.ended = Ended::Exhausted { proof: self.nothing_was_lost() };
                break;
            }
            self.outcome.iterations += 1;
            let shown = observe.is_some().then(|| self.show(&selected));
            for &entry in &selected {
                if self.tree.get(entry.id).length as usize == self.settings.length {
                    self.complete(entry.id);
                } else {
                    self.expand(entry.id);
                }
            }
            self.rank_again();
            self.bound();
            if let (Some(observe), Some(selected)) = (observe.as_mut(), shown) {
                let mut frontier = self.frontier.items().to_vec();
                best_first(&self.tree, &mut frontier);
                let iteration = self.outcome.iterations;
                observe(&Snapshot { iteration, selected, frontier: self.show(&frontier) });
            }
            let (found, wanted) = (self.outcome.found.len(), self.settings.per_graph.max(1));
            if !self.growth.goes_on(found, wanted) {
                self.outcome.ended = if found < wanted { Ended::Capped } else { Ended::Complete };
                break;
            }
        }
        self.outcome.evaluations = self.atlas.evaluations;
        Found::sort(&mut self.outcome.found);
        self.outcome
    }

    /// Takes the best `width` off the frontier.
    fn select(&mut self, selected: &mut Vec<Entry>) {
        selected.clear();
        while selected.len() < self.settings.width.max(1) {
            let Some(entry) = self.frontier.pop_best(order(&self.tree)) else { break };
            let partial = self.tree.get(entry.id);
            let overtaken =
                |reduction: &Reduction| !reduction.still_admits(partial.node, partial.length, partial.score);
            if self.reduction.as_ref().is_some_and(overtaken) {
                self.outcome.reduced += 1;
                self.tree.release(entry.id);
            } else {
                selected.push(entry);
            }
        }
    }

    /// Puts every partial trajectory that is one leg longer on the frontier.
    ///
    /// In the order of the graph's legs: those that revisit are left out, then those that cannot arrive, then the
    /// growth meets what is left and scores it, and the reduction says which of them stay. A partial trajectory that
    /// got no child gives its slot back.
    fn expand(&mut self, id: u32) {
        self.outcome.expansions += 1;
        let settings = self.settings;
        let parent = *self.tree.get(id);
        let steps_after = settings.length - parent.length as usize - 1;
        if !settings.revisits {
            for partial in self.tree.backwards(id) {
                self.visited[partial.waypoint as usize / 64] |= 1 << (partial.waypoint % 64);
            }
        }
        let (mut grown, mut blocked) = (false, false);
        self.open.clear();
        for index in self.atlas.legs(parent.node) {
            let leg = *self.atlas.leg(index);
            if !settings.revisits && self.visited[leg.waypoint as usize / 64] >> (leg.waypoint % 64) & 1 == 1 {
                blocked = true;
            } else if self.atlas.arrives(leg.to, steps_after, settings.lookahead.min(DEEPEST)) {
                self.open.push(index);
            } else {
                self.outcome.pruned += 1;
            }
        }
        let (candidates, atlas) = (self.task.candidates, &self.atlas);
        let view = |index: usize| {
            let KnownLeg { waypoint, duration, features, .. } = *atlas.leg(index);
            LegView { candidates, from: parent.waypoint, to: waypoint, duration, features }
        };
        let (score, length) = (parent.score, parent.length as usize);
        let mut whole = Vec::new();
        self.growth
            .meet(&Parent { score, memory: self.tree.memory(id), length }, self.open.iter().map(|&index| view(index)));
        for &index in &self.open {
            let leg = *atlas.leg(index);
            let before = Parent { score, memory: self.tree.memory(id), length };
            let Some((score, memory)) = self.growth.extend(&before, &view(index), &atlas.node(leg.to)) else {
                self.outcome.unkept += 1;
                blocked = true;
                continue;
            };
            let reduction = self.reduction.as_mut();
            if reduction.is_some_and(|reduction| !reduction.admits(leg.to, parent.length + 1, score)) {
                self.outcome.reduced += 1;
                blocked = true;
                continue;
            }
            let child = self.tree.grow(id, (leg.to, leg.waypoint), leg.duration, score, memory);
            if G::AT_ONCE && length + 1 == settings.length {
                whole.push(child);
            } else {
                self.frontier.push(self.entry(child), order(&self.tree));
            }
            grown = true;
        }
        whole.into_iter().for_each(|child| self.complete(child));
        self.visited.fill(0);
        if !grown {
            if !blocked {
                self.atlas.learn_dead(parent.node, steps_after + 1);
            }
            self.tree.release(id);
        }
        self.atlas.tidy();
    }

    /// Keeps a trajectory of full length; that it ends at the end was asked when it was made.
    ///
    /// Two are the same if their waypoints are, whatever nodes they pass: the one that came first is kept, the other
    /// counted as a duplicate.
    fn complete(&mut self, id: u32) {
        let waypoints = self.tree.waypoints(id);
        if self.outcome.found.iter().any(|found| found.waypoints == waypoints) {
            self.outcome.duplicates += 1;
        } else {
            let mut nodes: Vec<N> = self.tree.backwards(id).map(|p| self.atlas.node(p.node)).collect();
            let mut leg_times: Vec<f64> = self.tree.backwards(id).map(|p| p.duration).collect();
            nodes.reverse();
            leg_times.pop(); // the start has no leg
            leg_times.reverse();
            self.outcome.found.push(Found { waypoints, nodes, leg_times, score: self.tree.get(id).score });
        }
        self.tree.release(id);
    }

    /// A partial trajectory among others: score − (length − 1) · least, which is the score itself where `least` is 0.
    fn entry(&self, id: u32) -> Entry {
        let partial = self.tree.get(id);
        Entry { rank: partial.score - f64::from(partial.length - 1) * self.least, id }
    }

    /// Orders the frontier anew where a leg was worth less than all before it.
    ///
    /// O(n log n) whenever a new least is met; `least` never rises and is 0 at first, so that scores of 0 and more
    /// never pay for it.
    fn rank_again(&mut self) {
        if self.growth.least() >= self.least {
            return;
        }
        self.least = self.growth.least();
        for Entry { id, .. } in std::mem::replace(&mut self.frontier, IntervalHeap::new()).items() {
            self.frontier.push(self.entry(*id), order(&self.tree));
        }
    }

    /// Drops the worst until the frontier has its size.
    ///
    /// Every drop is counted and ends all hope of a proof.
    fn bound(&mut self) {
        while self.frontier.len() > self.settings.frontier {
            let Some(worst) = self.frontier.pop_worst(order(&self.tree)) else { return };
            self.tree.release(worst.id);
            self.outcome.dropped += 1;
        }
    }

    /// Whether what is not on the frontier any more cannot reach the end, or has a kept twin with the same futures.
    fn nothing_was_lost(&self) -> bool {
        self.outcome.dropped + self.outcome.unkept == 0 && (self.outcome.reduced == 0 || self.settings.revisits)
    }

    /// Indices of candidates with the aggregated score, in the order given.
    fn show(&self, entries: &[Entry]) -> Vec<(Vec<u32>, f64)> {
        entries.iter().map(|entry| (self.tree.waypoints(entry.id), self.tree.get(entry.id).score)).collect()
    }
}
