//! Building a leg graph: outwards from the start, then cut down to what can be part of a trajectory.

use std::borrow::Cow;
use std::collections::HashMap;
use std::hash::Hash;

use nalgebra::Point3;
use rustc_hash::FxBuildHasher;

use super::{Details, LegGraph};
use crate::feasibility::reach::{Leg, Reach};

impl<'a, N: Copy + Eq + Ord + Hash> LegGraph<'a, N> {
    /// All legs that a trajectory of at most `length` waypoints can use: from `start` at `candidates[0]`, by `reach`.
    ///
    /// With trajectories of L waypoints a leg v→w is kept where d(start, v) + 1 + d(w, end) ≤ L − 1 in legs: what no
    /// such walk uses would only be carried along.
    ///
    /// The end is the last candidate. `length` counts both ends; a graph serves all shorter lengths as well. Each node
    /// reached is one call of `reach`, which is nearly all of the time. With a step-wise set the nodes are pairs of
    /// waypoints, so up to n² of them.
    ///
    /// Lengths below 2, and graphs of fewer than two candidates, give the start's node alone, without legs.
    pub fn explore<R: Reach<N> + ?Sized>(start: N, candidates: &'a [Point3<f64>], reach: &R, length: usize) -> Self {
        Self::grow(start, candidates, length, |from, out| reach.legs(from, candidates, out)).trimmed(length)
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
        Self::grow(start, candidates, length, legs_of).trimmed(length)
    }

    /// Breadth first from `start`, one layer a leg: nodes at depth `length` − 1 and beyond get no legs. O(nodes +
    /// legs), each node's legs asked for once.
    fn grow(
        start: N,
        candidates: &'a [Point3<f64>],
        length: usize,
        mut legs_of: impl FnMut(&N, &mut Vec<Leg<N>>),
    ) -> Self {
        let mut graph = Self {
            candidates,
            nodes: vec![start],
            waypoints: vec![0],
            first: vec![0],
            to: Vec::new(),
            details: Details::default(),
            without_returns: None,
        };
        let mut known = Known { numbers: HashMap::from_iter([(start, 0)]), rows: HashMap::default() };
        let mut legs = Vec::new();
        let (mut node, mut layer_end, mut steps) = (0, 1, 1);
        while node < graph.nodes.len() {
            if node == layer_end {
                (layer_end, steps) = (graph.nodes.len(), steps + 1);
            }
            // Nodes first met by the last leg of the longest trajectory need no legs.
            if steps < length && candidates.len() >= 2 {
                legs.clear();
                legs_of(&graph.nodes[node], &mut legs);
                graph.add_row(&legs, &mut known);
            }
            graph.first.push(graph.to.len() as u32);
            node += 1;
        }
        graph
    }
}

/// What is found again while a graph grows.
struct Known<N> {
    /// Of every node.
    numbers: HashMap<N, u32, FxBuildHasher>,
    /// First leg of the row that had as many legs, whose first led to this node with this entry speed.
    rows: HashMap<(N, u64, usize), usize, FxBuildHasher>,
}

impl<N: Copy + Eq + Hash> LegGraph<'_, N> {
    /// Appends the legs of one node. Where nodes differ in what was before their waypoint, rows lead to the same nodes:
    /// these are copied, and not looked up.
    ///
    /// Rows are taken for alike where their first legs lead to the same node at the same speed and they are as long;
    /// then leg by leg, so that a row is only copied where all of it is the same.
    fn add_row(&mut self, legs: &[Leg<N>], known: &mut Known<N>) {
        let Some(head) = legs.first() else { return };
        let begin = *known.rows.entry((head.to, head.features.v_in.to_bits(), legs.len())).or_insert(self.to.len());
        let is_like =
            |(at, leg): (usize, &Leg<N>)| self.nodes[self.to[at] as usize] == leg.to && self.details.is_onward(at, leg);
        if begin < self.to.len() && (begin..).zip(legs).all(is_like) {
            self.to.extend_from_within(begin..begin + legs.len());
            (begin..).zip(legs).for_each(|(at, leg)| self.details.push_like(at, leg));
        } else {
            legs.iter().for_each(|leg| self.add_leg(leg, known));
        }
    }

    /// Appends a leg, and the node that it leads to where that is new.
    fn add_leg(&mut self, leg: &Leg<N>, known: &mut Known<N>) {
        let next = self.nodes.len() as u32;
        let to = *known.numbers.entry(leg.to).or_insert(next);
        if to == next {
            self.nodes.push(leg.to);
            self.waypoints.push(leg.waypoint);
        }
        self.to.push(to);
        self.details.push(leg);
    }
}

impl<N: Copy> LegGraph<'_, N> {
    /// Without the legs that no trajectory without revisits has: into the start, from the end on, and back to the only
    /// waypoint that their first node can be entered from. What is left are still walks, but far fewer. Itself where
    /// that was done before.
    ///
    /// Trajectories without revisits are all still there; walks that fly straight back are not, which tightens every
    /// bound taken over walks.
    pub fn without_returns(&self, length: usize) -> Cow<'_, Self> {
        if self.without_returns == Some(length) {
            Cow::Borrowed(self)
        } else {
            Cow::Owned(self.clone().into_without_returns(length))
        }
    }

    /// [`Self::without_returns`] of a graph that nobody needs as it was: dense graphs take hundreds of megabytes, which
    /// are cheaper kept than copied.
    ///
    /// The length is remembered, so that asking again for the same costs nothing. O(legs).
    pub fn into_without_returns(self, length: usize) -> Self {
        if self.without_returns == Some(length) {
            return self;
        }
        const MANY: u32 = u32::MAX;
        const NONE: u32 = u32::MAX - 1;
        let mut entered_from = vec![NONE; self.nodes()];
        for from in 0..self.nodes() as u32 {
            for leg in self.legs_from(from) {
                let entry = &mut entered_from[self.target(leg) as usize];
                let waypoint = self.waypoint(from);
                *entry = if *entry == NONE || *entry == waypoint { waypoint } else { MANY };
            }
        }
        let end = self.candidates.len() as u32 - 1;
        let fewer = self.retain(|waypoints, from, to| {
            let to = waypoints[to as usize];
            to != 0 && waypoints[from as usize] != end && entered_from[from as usize] != to
        });
        Self { without_returns: Some(length), ..fewer.trimmed(length) }
    }

    /// Only nodes and legs on a walk from the start to the end of at most `length` waypoints.
    ///
    /// Two breadth-first passes and a copy in place; a leg that is gone cannot bring back another, so once is enough.
    fn trimmed(self, length: usize) -> Self {
        let after = self.distances_from_start();
        let before = self.distances_to_end();
        let most = length.saturating_sub(1) as u32;
        self.retain(|_, from, to| after[from as usize].saturating_add(1).saturating_add(before[to as usize]) <= most)
    }

    /// The legs for which `keep(waypoints of the nodes, from, to)` holds, and the nodes that they lead to or start
    /// from; in place.
    fn retain(mut self, keep: impl Fn(&[u32], u32, u32) -> bool) -> Self {
        const GONE: u32 = u32::MAX;
        let mut number = vec![GONE; self.nodes()];
        number[0] = 0;
        let mut ends = Vec::with_capacity(self.nodes());
        let mut kept = 0;
        for from in 0..self.nodes() as u32 {
            for leg in self.legs_from(from) {
                let to = self.to[leg];
                if keep(&self.waypoints, from, to) {
                    (number[from as usize], number[to as usize]) = (0, 0);
                    // Never ahead of the leg that is looked at.
                    self.to[kept] = to;
                    self.details.put(kept, leg);
                    kept += 1;
                }
            }
            ends.push(kept as u32);
        }
        self.to.truncate(kept);
        self.details.truncate(kept);
        self.first.truncate(1);
        let mut left = 0;
        for (old, number) in number.iter_mut().enumerate().filter(|(_, number)| **number != GONE) {
            *number = left as u32;
            (self.nodes[left], self.waypoints[left]) = (self.nodes[old], self.waypoints[old]);
            self.first.push(ends[old]);
            left += 1;
        }
        self.nodes.truncate(left);
        self.waypoints.truncate(left);
        self.to.iter_mut().for_each(|to| *to = number[*to as usize]);
        self
    }

    /// Fewest legs from the start; `u32::MAX` where there is no way.
    ///
    /// Breadth first, O(nodes + legs).
    fn distances_from_start(&self) -> Vec<u32> {
        let mut distance = vec![u32::MAX; self.nodes()];
        distance[0] = 0;
        let mut queue = vec![0u32];
        let mut head = 0;
        while let Some(&node) = queue.get(head) {
            head += 1;
            for leg in self.legs_from(node) {
                let to = self.target(leg);
                if distance[to as usize] == u32::MAX {
                    distance[to as usize] = distance[node as usize] + 1;
                    queue.push(to);
                }
            }
        }
        distance
    }

    /// Fewest legs to the end; `u32::MAX` where there is no way. In rounds over the nodes whose distance is not known:
    /// a list of the legs backwards would take longer, for few rounds are needed.
    ///
    /// O(rounds · legs of what is open), as many rounds as the farthest node has legs to the end.
    fn distances_to_end(&self) -> Vec<u32> {
        let nodes = 0..self.nodes() as u32;
        let mut distance: Vec<u32> = nodes.clone().map(|node| if self.at_end(node) { 0 } else { u32::MAX }).collect();
        let mut open: Vec<u32> = nodes.filter(|&node| distance[node as usize] != 0).collect();
        for round in 1.. {
            let here = |node: &u32| self.to[self.legs_from(*node)].iter().any(|&to| distance[to as usize] == round - 1);
            let (met, left): (Vec<u32>, Vec<u32>) = open.into_iter().partition(here);
            met.iter().for_each(|&node| distance[node as usize] = round);
            open = left;
            if met.is_empty() {
                break;
            }
        }
        distance
    }
}
