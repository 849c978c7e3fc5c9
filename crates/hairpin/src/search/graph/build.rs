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
    pub fn explore<R: Reach<N> + ?Sized>(start: N, candidates: &'a [Point3<f64>], reach: &R, length: usize) -> Self {
        Self::grow(start, candidates, length, |from, out| reach.legs(from, candidates, out)).trimmed(length)
    }

    /// The same from a list of (from, leg); their order does not matter. Of legs between the same two nodes the first
    /// in the list is taken.
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
            details: Vec::new(),
            without_returns: None,
        };
        let mut numbers: HashMap<N, u32, FxBuildHasher> = HashMap::default();
        numbers.insert(start, 0);
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
                for leg in &legs {
                    let next = graph.nodes.len() as u32;
                    let to = *numbers.entry(leg.to).or_insert(next);
                    if to == next {
                        graph.nodes.push(leg.to);
                        graph.waypoints.push(leg.waypoint);
                    }
                    graph.to.push(to);
                    graph.details.push(Details { duration: leg.duration, features: leg.features });
                }
            }
            graph.first.push(graph.to.len() as u32);
            node += 1;
        }
        graph
    }
}

impl<N: Copy> LegGraph<'_, N> {
    /// Without the legs that no trajectory without revisits has: into the start, from the end on, and back to the only
    /// waypoint that their first node can be entered from. What is left are still walks, but far fewer. Itself where that was done before.
    pub fn without_returns(&self, length: usize) -> Cow<'_, Self> {
        if self.without_returns == Some(length) {
            return Cow::Borrowed(self);
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
        let fewer = self.filtered(|from, leg| {
            let to = self.waypoint(self.target(leg));
            to != 0 && !self.at_end(from) && entered_from[from as usize] != to
        });
        Cow::Owned(Self { without_returns: Some(length), ..fewer.trimmed(length) })
    }

    /// Only nodes and legs on a walk from the start to the end of at most `length` waypoints.
    fn trimmed(&self, length: usize) -> Self {
        let after = self.distances_from_start();
        let before = self.distances_to_end();
        let most = length.saturating_sub(1) as u32;
        self.filtered(|from, leg| {
            let rest = before[self.target(leg) as usize];
            after[from as usize].saturating_add(1).saturating_add(rest) <= most
        })
    }

    /// The legs for which `keep(from, leg)` holds, and the nodes that they lead to or start from.
    fn filtered(&self, keep: impl Fn(u32, usize) -> bool) -> Self {
        const GONE: u32 = u32::MAX;
        let mut number = vec![GONE; self.nodes()];
        number[0] = 0;
        let mut kept = Vec::new();
        for from in 0..self.nodes() as u32 {
            for leg in self.legs_from(from).filter(|&leg| keep(from, leg)) {
                (number[from as usize], number[self.target(leg) as usize]) = (0, 0);
                kept.push((from, leg));
            }
        }
        let olds: Vec<u32> = (0..self.nodes() as u32).filter(|&node| number[node as usize] != GONE).collect();
        for (new, &old) in olds.iter().enumerate() {
            number[old as usize] = new as u32;
        }
        let mut first = vec![0u32; olds.len() + 1];
        for &(from, _) in &kept {
            first[number[from as usize] as usize + 1] += 1;
        }
        for node in 0..olds.len() {
            first[node + 1] += first[node];
        }
        Self {
            candidates: self.candidates,
            nodes: olds.iter().map(|&old| self.nodes[old as usize]).collect(),
            waypoints: olds.iter().map(|&old| self.waypoint(old)).collect(),
            first,
            to: kept.iter().map(|&(_, leg)| number[self.target(leg) as usize]).collect(),
            details: kept.iter().map(|&(_, leg)| self.details[leg]).collect(),
            without_returns: self.without_returns,
        }
    }

    /// Fewest legs from the start; `u32::MAX` where there is no way.
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

    /// Fewest legs to the end; `u32::MAX` where there is no way.
    fn distances_to_end(&self) -> Vec<u32> {
        let mut first = vec![0u32; self.nodes() + 1];
        for &to in &self.to {
            first[to as usize + 1] += 1;
        }
        for node in 0..self.nodes() {
            first[node + 1] += first[node];
        }
        let mut sources = vec![0u32; self.legs()];
        let mut next = first.clone();
        for from in 0..self.nodes() as u32 {
            for leg in self.legs_from(from) {
                let place = &mut next[self.target(leg) as usize];
                sources[*place as usize] = from;
                *place += 1;
            }
        }
        let mut queue: Vec<u32> = (0..self.nodes() as u32).filter(|&node| self.at_end(node)).collect();
        let mut distance = vec![u32::MAX; self.nodes()];
        queue.iter().for_each(|&node| distance[node as usize] = 0);
        let mut head = 0;
        while let Some(&node) = queue.get(head) {
            head += 1;
            for &from in &sources[first[node as usize] as usize..first[node as usize + 1] as usize] {
                if distance[from as usize] == u32::MAX {
                    distance[from as usize] = distance[node as usize] + 1;
                    queue.push(from);
                }
            }
        }
        distance
    }
}
