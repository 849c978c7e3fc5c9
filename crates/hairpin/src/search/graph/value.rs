//! The best that is still to come: the dynamic program over legs, last leg first.
//!
//! Backwards from the end, so that what a partial trajectory can still become is looked up and not searched (Bellman
//! 1957). Layers near the start hold values only of the few nodes that a walk meets there.

use std::ops::Range;

use super::super::objective::{Aggregate, LegView};
use super::LegGraph;
use super::rows::Groups;
use super::scoring::Scoring;
use crate::feasibility::reach::LegFeatures;

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
pub(super) const NO_WALK: f64 = f64::NAN;
/// Legs that are looked at together: comparing one after the other waits for the one before.
const LANES: usize = 4;
/// The nodes near the start are those whose rows make up at most one in so many legs.
const FEW: usize = 16;

impl Values {
    /// Those of legs that leave nothing to the next, by the number of legs.
    pub(super) fn of_legs_alone(aggregate: Aggregate, rest: Vec<Vec<f64>>) -> Self {
        Self { aggregate, rest, first: None }
    }

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

impl<'a, N: Copy> LegGraph<'a, N> {
    /// The score of every leg.
    ///
    /// A row at a time, all legs of a node together, which is what scores that are asked of a program or are made in
    /// SIMD lanes need.
    pub(in crate::search) fn scores(&self, objective: &dyn Scoring) -> LegScores {
        let (mut own, mut left) = (Vec::with_capacity(self.legs()), Vec::new());
        let mut views = Vec::new();
        for node in 0..self.nodes() as u32 {
            self.views(node, &mut views);
            for [of_leg, to_next] in objective.worth_and_left(&views) {
                // Most scores leave nothing: no room is taken for that.
                if !left.is_empty() || to_next.to_bits() != 0 {
                    left.resize(own.len(), 0.0);
                    left.push(to_next);
                }
                own.push(of_leg);
            }
        }
        LegScores::new(own, left, objective.to_sink())
    }

    /// Views of the legs of `node`, in the place of what `views` had.
    ///
    /// Legs to the states of one waypoint follow on one another, and share how they are entered.
    fn views(&self, node: u32, views: &mut Vec<LegView<'a>>) {
        views.clear();
        for place in self.rows.places(node).into_iter().flatten() {
            let view = self.kept_view(node, place);
            let features = match views.last() {
                Some(LegView { to, features: LegFeatures { turn, slope_in, .. }, .. }) if *to == view.to => {
                    LegFeatures { turn: *turn, slope_in: *slope_in, ..view.features }
                }
                _ => self.entered(view.features, node, view.to),
            };
            views.push(LegView { features, ..view });
        }
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
            let mut next: Vec<u32> = here.iter().flat_map(|&node| self.rows.targets(node)).collect();
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
        let all = self.rows.groups(0..self.nodes() as u32);
        while rest.len() < length {
            let after = &rest[rest.len() - 1];
            let few = near_start.get(length - 1 - rest.len());
            let few = few.map(|nodes| self.rows.groups(nodes.iter().copied()));
            let nodes = few.as_ref().unwrap_or(&all);
            let layer = match (aggregate, &mut first, &scores.left) {
                (Aggregate::Sum, ..) => {
                    let last = !scores.inherits(rest.len() - 1);
                    let scores = both.as_ref().filter(|_| !last).unwrap_or(&scores.own);
                    self.layer_of_values(after, scores, nodes, |_, rest, leg| Aggregate::Sum.add(rest, leg))
                }
                (Aggregate::Max, Some(first), Some(left)) => {
                    let own = self.layer_of_values(after, &scores.own, nodes, |_, _, leg| leg);
                    let next = &first[rest.len() - 1];
                    let layer = if rest.len() == 1 {
                        let none = |value: &f64| if value.is_nan() { NO_WALK } else { aggregate.neutral() };
                        own.iter().map(none).collect()
                    } else {
                        self.layer_of_values(after, left, nodes, |to, rest, leg| {
                            Aggregate::Max.add(rest, leg + next[to as usize])
                        })
                    };
                    first.push(own);
                    layer
                }
                (Aggregate::Max, ..) => {
                    self.layer_of_values(after, &scores.own, nodes, |_, rest, leg| Aggregate::Max.add(rest, leg))
                }
            };
            rest.push(layer);
        }
        Values { aggregate, rest, first }
    }

    /// The layer of walks that are one leg longer than those of `after`, of the `nodes` given or of all; `add` is
    /// compiled into the loop.
    ///
    /// What is to come is looked up once for all nodes that share a row. No order of the maxima matters, so that rows
    /// and their lanes give the same bits in any.
    fn layer_of_values(
        &self,
        after: &[f64],
        scores: &[f64],
        nodes: &Groups,
        add: impl Fn(u32, f64, f64) -> f64,
    ) -> Vec<f64> {
        let (mut layer, mut rest) = (vec![NO_WALK; self.nodes()], Vec::new());
        for (row, nodes) in nodes.iter() {
            let row = self.rows.kept(row);
            let to = &self.rows.to[row.clone()];
            rest.clear();
            rest.extend(to.iter().map(|&to| after[to as usize]));
            let Some(first) = rest.iter().position(|rest| !rest.is_nan()) else { continue };
            for &node in nodes {
                let legs = self.legs_from(node);
                let [before, behind] = self.rows.places(node);
                let (from, gap) = (first.min(before.len()), behind.start - row.start);
                let best =
                    |places: Range<usize>, scores: &[f64]| best_of(&to[places.clone()], &rest[places], scores, &add);
                let scores = &scores[legs];
                let early = best(from..before.len(), &scores[from..before.len()]);
                let late = best(gap..row.len(), &scores[before.len()..]);
                layer[node as usize] = early.max(late);
            }
        }
        layer
    }
}

/// The best of some legs of one row.
///
/// In four lanes with a maximum each.
#[inline(always)]
fn best_of(to: &[u32], rest: &[f64], scores: &[f64], add: impl Fn(u32, f64, f64) -> f64) -> f64 {
    // No walk is no number, which a maximum passes over.
    let value = |to: u32, rest: f64, score: f64| if rest.is_nan() { NO_WALK } else { add(to, rest, score) };
    let mut lanes = [NO_WALK; LANES];
    let whole = to.len() / LANES * LANES;
    for begin in (0..whole).step_by(LANES) {
        for (k, lane) in lanes.iter_mut().enumerate() {
            *lane = lane.max(value(to[begin + k], rest[begin + k], scores[begin + k]));
        }
    }
    let left = (whole..to.len()).map(|leg| value(to[leg], rest[leg], scores[leg])).fold(NO_WALK, f64::max);
    lanes.into_iter().fold(left, f64::max)
}
