//! Building a leg graph: outwards from the start.

use std::collections::HashMap;
use std::hash::Hash;

use nalgebra::Point3;
use rustc_hash::FxBuildHasher;

use super::rows::{EMPTY, Rows};
use super::{LegGraph, OWN};
use crate::feasibility::reach::{Entry, Leg, Reach};

impl<'a, N: Copy + Eq + Ord + Hash> LegGraph<'a, N> {
    /// All legs that a trajectory of at most `length` waypoints can use: from `start` at `candidates[0]`, by `reach`.
    ///
    /// With trajectories of L waypoints a leg v→w is kept where d(start, v) + 1 + d(w, end) ≤ L − 1 in legs: what no
    /// such walk uses would only be carried along.
    ///
    /// The end is the last candidate. `length` counts both ends; a graph serves all shorter lengths as well. Each state
    /// reached is one call of `reach`, which is nearly all of the time. With a step-wise set the nodes are pairs of
    /// waypoints, so up to n² of them.
    ///
    /// Lengths below 2, and graphs of fewer than two candidates, give the start's node alone, without legs.
    pub fn explore<R: Reach<N> + ?Sized>(start: N, candidates: &'a [Point3<f64>], reach: &R, length: usize) -> Self {
        let legs_of = |from: &N, out: &mut Vec<Leg<N>>| reach.legs(from, candidates, out);
        Self::grow(start, candidates, length, legs_of, |from| reach.entry(from)).trimmed(length)
    }

    /// The same of all legs that may be by `reach`, of which those that are none are still among them.
    pub fn explore_possible<R: Reach<N> + ?Sized>(
        start: N,
        candidates: &'a [Point3<f64>],
        reach: &R,
        length: usize,
    ) -> Self {
        let legs_of = |from: &N, out: &mut Vec<Leg<N>>| reach.possible(from, candidates, out);
        Self::grow(start, candidates, length, legs_of, |from| reach.entry(from)).trimmed(length)
    }

    /// The same from a list of (from, leg); their order does not matter. Of legs between the same two nodes the first
    /// in the list is taken.
    ///
    /// For reach sets that were judged before, and for tests by enumeration.
    ///
    /// `to` of every leg must be a node at its `waypoint`: it is not asked. O(m log m) for m legs.
    pub fn from_legs(start: N, candidates: &'a [Point3<f64>], legs: &[(N, Leg<N>)], length: usize) -> Self {
        let mut order: Vec<u32> = (0..legs.len() as u32).collect();
        let key = |&i: &u32| {
            let (from, leg) = &legs[i as usize];
            (*from, leg.waypoint, leg.to)
        };
        order.sort_by_key(key);
        order.dedup_by_key(|i| key(i));
        let legs_of = |from: &N, out: &mut Vec<Leg<N>>| {
            let first = order.partition_point(|&i| legs[i as usize].0 < *from);
            let same = order[first..].iter().map(|&i| &legs[i as usize]).take_while(|(node, _)| node == from);
            out.extend(same.map(|(_, leg)| *leg));
        };
        Self::grow(start, candidates, length, legs_of, |_| None).trimmed(length)
    }

    /// Breadth first from `start`, one layer a leg: nodes at depth `length` − 1 and beyond get no legs. O(nodes +
    /// legs), each state's legs asked for once.
    fn grow(
        start: N,
        candidates: &'a [Point3<f64>],
        length: usize,
        mut legs_of: impl FnMut(&N, &mut Vec<Leg<N>>),
        entry_of: impl Fn(&N) -> Option<Entry>,
    ) -> Self {
        let mut graph = Self {
            candidates,
            nodes: vec![start],
            waypoints: vec![0],
            previous: Vec::new(),
            rows: Rows::default(),
            without_returns: None,
        };
        let mut numbers = HashMap::from_iter([(start, 0)]);
        let mut of_states: HashMap<usize, u32, FxBuildHasher> = HashMap::default();
        let mut legs = Vec::new();
        let (mut node, mut layer_end, mut steps) = (0, 1, 1);
        while node < graph.nodes.len() {
            if node == layer_end {
                (layer_end, steps) = (graph.nodes.len(), steps + 1);
            }
            let from = graph.nodes[node];
            let entry = entry_of(&from);
            let known = entry.and_then(|entry| of_states.get(&entry.state).copied());
            // Nodes first met by the last leg of the longest trajectory need no legs.
            let row = if steps >= length || candidates.len() < 2 {
                EMPTY
            } else if let Some(row) = known {
                row
            } else {
                legs.clear();
                legs_of(&from, &mut legs);
                let row = graph.add_row(&legs, &mut numbers);
                of_states.extend(entry.map(|entry| (entry.state, row)));
                row
            };
            graph.rows.give(row, 0..0);
            graph.previous.push(entry.map_or(OWN, |entry| entry.previous));
            node += 1;
        }
        graph
    }

    /// Keeps a row of legs, and adds the nodes that they lead to where these are new; its number.
    fn add_row(&mut self, legs: &[Leg<N>], numbers: &mut HashMap<N, u32, FxBuildHasher>) -> u32 {
        for leg in legs {
            let next = self.nodes.len() as u32;
            let to = *numbers.entry(leg.to).or_insert(next);
            if to == next {
                self.nodes.push(leg.to);
                self.waypoints.push(leg.waypoint);
            }
            self.rows.to.push(to);
            self.rows.look.push(self.rows.seen.len() as u32);
            self.rows.seen.push((leg.duration, leg.features));
        }
        self.rows.end_row()
    }
}
