//! The part of the graph that the beam has seen: nodes by number, their legs, and from where the end cannot be reached.
//!
//! Expanding the same node again costs nothing: its legs stay until there are too many. Dead ends are remembered by
//! (node, steps left), exactly within the lookahead and by the caller's necessary test beyond it.
//!
//! Knowing an expansion already makes the beam cheap: many partial trajectories end at one node, and the reach set,
//! which is dear, is asked once a node rather than once a trajectory. Numbers are dense, so that what is known of a
//! node is an index away; they depend on the order of expansion alone, hence are the same in every run.

use std::collections::HashMap;
use std::hash::Hash;
use std::ops::Range;

use rustc_hash::FxBuildHasher;

use super::super::task::Task;
use crate::feasibility::reach::{Leg, LegFeatures, Reach};

/// A leg between numbered nodes.
///
/// Features are kept with the leg, because an objective asks for them at every extension.
#[derive(Debug, Clone, Copy)]
pub(super) struct KnownLeg {
    /// Number of the node that it leads to.
    pub(super) to: u32,
    /// That node's waypoint, an index into the task's candidates.
    pub(super) waypoint: u32,
    /// Planned duration, s.
    pub(super) duration: f64,
    /// What objectives see of the leg.
    pub(super) features: LegFeatures,
}

/// Legs remembered between two expansions at most (64 bytes each); past it they are forgotten and asked for again.
const MOST_LEGS: usize = 1 << 18;

/// Not evaluated.
const UNKNOWN: (u32, u32) = (u32::MAX, 0);

/// What is remembered of a graph. A node's number is the order in which it was first seen.
pub(super) struct Atlas<'a, N, R: ?Sized, P> {
    task: &'a Task<'a, N, R>,
    may_arrive: P,
    /// Whether start and end may be passed through.
    revisits: bool,
    numbers: HashMap<N, u32, FxBuildHasher>,
    nodes: Vec<N>,
    waypoints: Vec<u32>,
    spans: Vec<(u32, u32)>,
    legs: Vec<KnownLeg>,
    fresh: Vec<Leg<N>>,
    /// Per node and steps left: can arrive, cannot arrive. `words` words a node.
    can: Vec<u64>,
    cannot: Vec<u64>,
    words: usize,
    /// Times the reach set was asked, nodes that were forgotten and asked again counted again.
    pub(super) evaluations: u64,
}

impl<'a, N, R, P> Atlas<'a, N, R, P>
where
    N: Copy + Eq + Hash,
    R: Reach<N> + ?Sized,
    P: Fn(&N, usize) -> bool,
{
    /// An atlas that knows the start, node 0, for trajectories of `length` waypoints.
    ///
    /// `may_arrive(node, s)` is a necessary condition for the end to be reachable from `node` in exactly s legs; it may
    /// be true too often, never false where a walk exists. Without `revisits` a node at the end or back at the start
    /// has no future but the empty one.
    pub(super) fn new(task: &'a Task<'a, N, R>, may_arrive: P, revisits: bool, length: usize) -> Self {
        let mut atlas = Self {
            task,
            may_arrive,
            revisits,
            numbers: HashMap::with_capacity_and_hasher(1 << 10, FxBuildHasher),
            nodes: Vec::new(),
            waypoints: Vec::new(),
            spans: Vec::new(),
            legs: Vec::new(),
            fresh: Vec::new(),
            can: Vec::new(),
            cannot: Vec::new(),
            words: length.div_ceil(64),
            evaluations: 0,
        };
        atlas.number(task.start, 0);
        atlas
    }

    /// The node of a number; numbers come from [`Atlas::legs`] and stay valid for good.
    pub(super) fn node(&self, number: u32) -> N {
        self.nodes[number as usize]
    }

    /// The leg at an index that [`Atlas::legs`] gave since the last [`Atlas::tidy`].
    pub(super) fn leg(&self, index: usize) -> &KnownLeg {
        &self.legs[index]
    }

    /// The legs from `node`: indices that hold until [`Atlas::tidy`].
    ///
    /// The first time one question to the reach set; afterwards O(1). Indices are into one list of all legs known, in
    /// the order of the reach set's answer.
    pub(super) fn legs(&mut self, node: u32) -> Range<usize> {
        let (mut first, mut count) = self.spans[node as usize];
        if (first, count) == UNKNOWN {
            let mut fresh = std::mem::take(&mut self.fresh);
            fresh.clear();
            self.task.reach.legs(&self.nodes[node as usize], self.task.candidates, &mut fresh);
            self.evaluations += 1;
            (first, count) = (self.legs.len() as u32, fresh.len() as u32);
            for leg in &fresh {
                let to = self.number(leg.to, leg.waypoint);
                let Leg { waypoint, duration, features, .. } = *leg;
                self.legs.push(KnownLeg { to, waypoint, duration, features });
            }
            self.spans[node as usize] = (first, count);
            self.fresh = fresh;
        }
        first as usize..(first + count) as usize
    }

    /// Forgets all legs if there are too many.
    pub(super) fn tidy(&mut self) {
        if self.legs.len() > MOST_LEGS {
            self.legs.clear();
            self.spans.fill(UNKNOWN);
        }
    }

    /// Whether `node` may still arrive at the end in `steps` legs: exactly, over walks, for at most `lookahead` steps.
    ///
    /// A_s(v) = necessary(v, s) ∧ (s > lookahead ∨ ∃ leg v→w: A_{s−1}(w)), A_0(v) = v is at the end. Answers are
    /// remembered in one bit per (node, s), two for yes and no, so that the recursion visits each pair once: O(legs ·
    /// lookahead) for the whole graph. It is over walks: a yes may still be blocked by waypoints that the trajectory
    /// has used, a no is final.
    pub(super) fn arrives(&mut self, node: u32, steps: usize, lookahead: usize) -> bool {
        let end = self.task.end();
        let waypoint = self.waypoints[node as usize];
        if steps == 0 {
            return waypoint == end;
        }
        if !self.revisits && (waypoint == end || (waypoint == 0 && node != 0)) {
            return false;
        }
        let (word, bit) = (node as usize * self.words + steps / 64, 1u64 << (steps % 64));
        if self.cannot[word] & bit != 0 {
            return false;
        }
        if self.can[word] & bit != 0 {
            return true;
        }
        let exact = steps <= lookahead;
        let arrives = (self.may_arrive)(&self.nodes[node as usize], steps)
            && (!exact || self.legs(node).any(|leg| self.arrives(self.legs[leg].to, steps - 1, lookahead)));
        let known = if arrives { &mut self.can } else { &mut self.cannot };
        known[word] |= bit;
        arrives
    }

    /// Remembers that no `steps` legs lead from `node` to the end.
    ///
    /// Beyond the lookahead the condition is only necessary; an expansion that left nothing, and for no reason of its
    /// own trajectory (a waypoint visited, a score refused), tells it for all.
    pub(super) fn learn_dead(&mut self, node: u32, steps: usize) {
        let word = node as usize * self.words + steps / 64;
        self.cannot[word] |= 1 << (steps % 64);
    }

    /// New nodes get the next number and room for their bits: `words` words each for yes and for no.
    fn number(&mut self, node: N, waypoint: u32) -> u32 {
        let next = self.nodes.len() as u32;
        let number = *self.numbers.entry(node).or_insert(next);
        if number == next {
            self.nodes.push(node);
            self.waypoints.push(waypoint);
            self.spans.push(UNKNOWN);
            self.can.resize(self.can.len() + self.words, 0);
            self.cannot.resize(self.cannot.len() + self.words, 0);
        }
        number
    }
}
