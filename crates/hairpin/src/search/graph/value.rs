//! The best that is still to come: the dynamic program over legs, last leg first.
//!
//! Backwards from the end, so that what a partial trajectory can still become is looked up and not searched (Bellman
//! 1957). Layers near the start hold values only of the few nodes that a walk meets there.

use super::super::objective::{Additive, Aggregate};
use super::LegGraph;

/// The scores of a graph's legs under one [`super::super::objective::Additive`].
#[derive(Debug, Clone)]
pub(in crate::search) struct LegScores {
    own: Vec<f64>,
    /// What a leg leaves to the one after it; `None` where no leg leaves anything.
    left: Option<Vec<f64>>,
    sink: bool,
}

impl LegScores {
    /// `own` and `left` of every leg; `sink`: the last leg is left nothing.
    ///
    /// One entry per leg of the graph, in its order; an empty `left` leaves nothing. NaN counts as −∞: such a leg is
    /// the last to be chosen, and still a leg.
    pub(in crate::search) fn new(mut own: Vec<f64>, mut left: Vec<f64>, sink: bool) -> Self {
        for score in own.iter_mut().chain(&mut left).filter(|score| score.is_nan()) {
            *score = f64::NEG_INFINITY;
        }
        let left = left.iter().any(|left| *left != 0.0).then_some(left);
        Self { own, left, sink }
    }

    /// The score of `leg` without what was left to it.
    pub(in crate::search) fn own(&self, leg: usize) -> f64 {
        self.own[leg]
    }

    /// What `leg` leaves to the first of the `legs` that come after it.
    pub(in crate::search) fn left(&self, leg: usize, legs: usize) -> f64 {
        self.left.as_ref().filter(|_| self.inherits(legs)).map_or(0.0, |left| left[leg])
    }

    /// Whether anything is left to the first of the last `legs`.
    fn inherits(&self, legs: usize) -> bool {
        legs > usize::from(self.sink)
    }
}

/// Best aggregated score of the walks of exactly s legs from a node to the end, for every s and every node that a walk
/// of the whole length meets with s legs to go.
///
/// Layer s has one number a node, `NO_WALK` (NaN) where no walk of s legs leads to the end, or where no walk of the
/// whole length meets the node with s legs to go.
#[derive(Debug, Clone)]
pub(in crate::search) struct Values {
    aggregate: Aggregate,
    /// Of all legs, the first of which is left nothing; under [`Aggregate::Max`] where legs leave something: of all
    /// legs but the first.
    rest: Vec<Vec<f64>>,
    /// Under [`Aggregate::Max`] where legs leave something: of the first leg, left nothing; that of no legs is empty.
    first: Option<Vec<Vec<f64>>>,
}

/// No walk. Not −∞: a trajectory of worthless legs still is one.
const NO_WALK: f64 = f64::NAN;
/// Legs that are looked at together: comparing one after the other waits for the one before.
const LANES: usize = 4;
/// The nodes near the start are those whose rows make up at most one in so many legs.
const FEW: usize = 16;

impl Values {
    /// The best that a partial trajectory becomes that scored `score` so far, stands at `node`, and whose last leg left
    /// `left` to the first of the `legs` that it still needs; `None` if there is no such walk.
    pub(in crate::search) fn best(&self, (score, left): (f64, f64), node: u32, legs: usize) -> Option<f64> {
        let rest = self.rest[legs][node as usize];
        if rest.is_nan() {
            return None;
        }
        let score = match (&self.first, self.aggregate) {
            (Some(first), _) if legs > 0 => self.aggregate.add(score, left + first[legs][node as usize]),
            (None, Aggregate::Sum) => self.aggregate.add(score, left),
            _ => score,
        };
        Some(self.aggregate.add(score, rest))
    }
}

impl<N: Copy> LegGraph<'_, N> {
    /// The score of every leg.
    ///
    /// A row at a time, all legs of a node together, which is what scores that are asked of a program or are made in
    /// SIMD lanes need.
    pub(in crate::search) fn scores<O: Additive>(&self, objective: &O) -> LegScores {
        let (mut own, mut left) = (Vec::with_capacity(self.legs()), Vec::new());
        let mut views = Vec::new();
        for node in 0..self.nodes() as u32 {
            views.clear();
            views.extend(self.legs_from(node).map(|leg| self.view(node, leg)));
            for [of_leg, to_next] in objective.own_and_left(&views) {
                // Most scores leave nothing: no room is taken for that.
                if !left.is_empty() || to_next.to_bits() != 0 {
                    left.resize(own.len(), 0.0);
                    left.push(to_next);
                }
                own.push(of_leg);
            }
        }
        LegScores::new(own, left, objective.has_sink())
    }

    /// The nodes that walks of 0, 1, 2 … legs from the start lead to, as long as these are few and the walks have no
    /// more than `length` waypoints.
    ///
    /// Few are nodes whose legs are a sixteenth of all at most. Rows are rising and without repeats.
    pub(in crate::search) fn near_start(&self, length: usize) -> Vec<Vec<u32>> {
        let mut layers = vec![vec![0]];
        let legs = |nodes: &[u32]| nodes.iter().map(|&node| self.legs_from(node).len()).sum::<usize>();
        while layers.len() < length && legs(&layers[layers.len() - 1]) <= self.legs() / FEW {
            let here = &layers[layers.len() - 1];
            let mut next: Vec<u32> = here.iter().flat_map(|&node| &self.to[self.legs_from(node)]).copied().collect();
            next.sort_unstable();
            next.dedup();
            layers.push(next);
        }
        layers
    }

    /// The dynamic program for trajectories of `length` waypoints. `near_start` is [`Self::near_start`].
    ///
    /// ```text
    /// V₀ = neutral at the end,   V_s(v) = max over legs v→w of own ⊕ V_{s−1}(w),   with what legs leave:
    /// Sum:  V_s(v) = max over legs v→w of own + left + V_{s−1}(w)       (left: if there is a leg after it)
    /// Max:  F_s(v) = max over legs v→w of own,   V_s(v) = max over legs v→w of max(left + F_{s−1}(w), V_{s−1}(w))
    /// ```
    ///
    /// O(legs · length) additions and as many comparisons; memory nodes · length doubles, whole layers also where only
    /// few nodes have a value. `scores` must be those of this graph.
    pub(in crate::search) fn values(
        &self,
        length: usize,
        scores: &LegScores,
        aggregate: Aggregate,
        near_start: &[Vec<u32>],
    ) -> Values {
        let at_end = |node| if self.at_end(node) { aggregate.neutral() } else { NO_WALK };
        let mut rest: Vec<Vec<f64>> = vec![(0..self.nodes() as u32).map(at_end).collect()];
        let mut first = (scores.left.is_some() && aggregate == Aggregate::Max).then(|| vec![Vec::new()]);
        let both = scores.left.as_ref().filter(|_| aggregate == Aggregate::Sum);
        let both: Option<Vec<f64>> =
            both.map(|left| scores.own.iter().zip(left).map(|(own, left)| aggregate.add(*own, *left)).collect());
        while rest.len() < length {
            let after = &rest[rest.len() - 1];
            let near = near_start.get(length - 1 - rest.len()).map(Vec::as_slice);
            let layer = match (aggregate, &mut first, &scores.left) {
                (Aggregate::Sum, ..) => {
                    let last = !scores.inherits(rest.len() - 1);
                    let scores = both.as_ref().filter(|_| !last).unwrap_or(&scores.own);
                    self.layer_of_values(rest.len(), after, scores, near, |_, rest, leg| Aggregate::Sum.add(rest, leg))
                }
                (Aggregate::Max, Some(first), Some(left)) => {
                    let own = self.layer_of_values(rest.len(), after, &scores.own, near, |_, _, leg| leg);
                    let next = &first[rest.len() - 1];
                    let layer = if rest.len() == 1 {
                        let none = |value: &f64| if value.is_nan() { NO_WALK } else { aggregate.neutral() };
                        own.iter().map(none).collect()
                    } else {
                        self.layer_of_values(rest.len(), after, left, near, |to, rest, leg| {
                            Aggregate::Max.add(rest, leg + next[to as usize])
                        })
                    };
                    first.push(own);
                    layer
                }
                (Aggregate::Max, ..) => self.layer_of_values(rest.len(), after, &scores.own, near, |_, rest, leg| {
                    Aggregate::Max.add(rest, leg)
                }),
            };
            rest.push(layer);
        }
        Values { aggregate, rest, first }
    }

    /// The layer of walks of `legs` legs, before that of one leg less, of the `nodes` given or of all; `add` is
    /// compiled into the loop.
    ///
    /// Rows are looked at in four lanes with a maximum each; no order of the maxima matters, so that lanes and plain
    /// loops give the same bits.
    fn layer_of_values(
        &self,
        legs: usize,
        after: &[f64],
        scores: &[f64],
        nodes: Option<&[u32]>,
        add: impl Fn(u32, f64, f64) -> f64,
    ) -> Vec<f64> {
        let best = |node| {
            let mut row = self.legs_from(node);
            if legs == 1 {
                // The end is the last waypoint: no leg before those to it ends a walk.
                row.start = row.clone().rev().take_while(|&leg| self.at_end(self.to[leg])).last().unwrap_or(row.end);
            }
            let value = |(&to, &score): (&u32, &f64)| {
                let rest = after[to as usize];
                if rest.is_nan() { NO_WALK } else { add(to, rest, score) }
            };
            let (to, scores) = (self.to[row.clone()].chunks_exact(LANES), scores[row].chunks_exact(LANES));
            let left = to.remainder().iter().zip(scores.remainder()).map(value).fold(NO_WALK, f64::max);
            let mut lanes = [NO_WALK; LANES];
            for (to, scores) in to.zip(scores) {
                for (lane, leg) in lanes.iter_mut().zip(to.iter().zip(scores)) {
                    // No walk is no number, which a maximum passes over.
                    *lane = lane.max(value(leg));
                }
            }
            lanes.into_iter().fold(left, f64::max)
        };
        match nodes {
            Some(nodes) => {
                let mut layer = vec![NO_WALK; self.nodes()];
                nodes.iter().for_each(|&node| layer[node as usize] = best(node));
                layer
            }
            None => (0..self.nodes() as u32).map(best).collect(),
        }
    }
}
