//! The legs of all nodes, kept once for those that share them.
//!
//! Nodes that differ only in the waypoint before theirs have the same legs, but for those straight back to it where
//! there are to be none. So rows are kept by themselves, and a node has all legs of a row or all outside of one gap.

use std::ops::Range;

use crate::feasibility::reach::LegFeatures;

/// Row 0 has no legs.
pub(super) const EMPTY: u32 = 0;

/// Kept rows, and which of them every node has. Legs are numbered through, node by node, as if each had its own.
///
/// Memory: 72 bytes a leg that is kept, 16 a node.
#[derive(Debug, Clone)]
pub(super) struct Rows {
    /// Legs from node v are `first[v]..first[v + 1]`.
    first: Vec<u32>,
    of: Vec<Row>,
    /// Kept row r is `begin[r]..begin[r + 1]` of what follows.
    begin: Vec<u32>,
    /// Node that a leg leads to; waypoints rise along a row.
    pub(super) to: Vec<u32>,
    /// Number of what is seen of a leg.
    pub(super) look: Vec<u32>,
    /// Duration, s, and what scores see; of nodes that share a row, as one of them sees it. Legs may be gone that are
    /// still seen: moving what stays would cost more than its room.
    pub(super) seen: Vec<(f64, LegFeatures)>,
}

/// A node's row.
#[derive(Debug, Clone, Copy)]
struct Row {
    number: u32,
    /// Places that the node leaves out.
    gap: [u32; 2],
}

impl Default for Rows {
    fn default() -> Self {
        Self { first: vec![0], of: Vec::new(), begin: vec![0, 0], to: Vec::new(), look: Vec::new(), seen: Vec::new() }
    }
}

impl Rows {
    /// Duration, s, and what scores see of the leg at a place.
    #[inline]
    pub(super) fn seen_at(&self, place: usize) -> (f64, LegFeatures) {
        self.seen[self.look[place] as usize]
    }

    /// Ends the row that was appended to `to` and `look`; its number.
    pub(super) fn end_row(&mut self) -> u32 {
        self.begin.push(self.to.len() as u32);
        self.begin.len() as u32 - 2
    }

    /// Gives the next node the legs of kept row `number` that are outside of `gap`, which lies within it or is empty.
    pub(super) fn give(&mut self, number: u32, gap: Range<usize>) {
        let gap = if gap.is_empty() { self.kept(number).end..self.kept(number).end } else { gap };
        self.of.push(Row { number, gap: [gap.start as u32, gap.end as u32] });
        let legs = self.kept(number).len() - gap.len();
        self.first.push(self.first[self.first.len() - 1] + legs as u32);
    }

    /// Of all nodes.
    #[inline]
    pub(super) fn legs(&self) -> usize {
        self.first[self.first.len() - 1] as usize
    }

    /// Numbers of a node's legs.
    #[inline]
    pub(super) fn legs_from(&self, node: u32) -> Range<usize> {
        self.first[node as usize] as usize..self.first[node as usize + 1] as usize
    }

    /// The node that has the leg, by halving: O(log nodes).
    #[inline]
    pub(super) fn source(&self, leg: usize) -> u32 {
        (self.first.partition_point(|&first| first as usize <= leg) - 1) as u32
    }

    /// How many rows are kept.
    pub(super) fn count(&self) -> u32 {
        self.begin.len() as u32 - 1
    }

    /// Places of a kept row.
    #[inline]
    pub(super) fn kept(&self, number: u32) -> Range<usize> {
        self.begin[number as usize] as usize..self.begin[number as usize + 1] as usize
    }

    /// Number of a node's row.
    #[inline]
    pub(super) fn number(&self, node: u32) -> u32 {
        self.of[node as usize].number
    }

    /// Places of its row that a node leaves out.
    #[inline]
    pub(super) fn gap(&self, node: u32) -> Range<usize> {
        let [begin, end] = self.of[node as usize].gap;
        begin as usize..end as usize
    }

    /// Places of a node's legs, in their order.
    #[inline]
    pub(super) fn places(&self, node: u32) -> [Range<usize>; 2] {
        let (row, gap) = (self.kept(self.number(node)), self.gap(node));
        [row.start..gap.start, gap.end..row.end]
    }

    /// Nodes that the legs of a node lead to.
    #[inline]
    pub(super) fn targets(&self, node: u32) -> impl Iterator<Item = u32> {
        let [before, after] = self.places(node);
        self.to[before].iter().chain(&self.to[after]).copied()
    }

    /// Place of leg number `leg`, which `node` has.
    #[inline]
    pub(super) fn place(&self, node: u32, leg: usize) -> usize {
        let ([before, after], number) = (self.places(node), leg - self.legs_from(node).start);
        if number < before.len() { before.start + number } else { after.start + number - before.len() }
    }

    /// Number of the leg of `node` at `place`, which is not in its gap.
    #[inline]
    pub(super) fn leg_at(&self, node: u32, place: usize) -> usize {
        let ([before, after], first) = (self.places(node), self.legs_from(node).start);
        first + if place < before.end { place - before.start } else { place - after.start + before.len() }
    }

    /// Places of a kept row whose legs lead to `waypoint`, by halving; `waypoint_of` is that of a node.
    pub(super) fn to_waypoint(&self, number: u32, waypoint: u32, waypoint_of: impl Fn(u32) -> u32) -> Range<usize> {
        let row = self.kept(number);
        let to = &self.to[row.clone()];
        let begin = to.partition_point(|&to| waypoint_of(to) < waypoint);
        let count = to[begin..].partition_point(|&to| waypoint_of(to) == waypoint);
        row.start + begin..row.start + begin + count
    }

    /// `nodes` by their rows.
    pub(super) fn groups(&self, nodes: impl Iterator<Item = u32> + Clone) -> Groups {
        let mut begin = vec![0; self.begin.len()];
        nodes.clone().for_each(|node| begin[self.number(node) as usize + 1] += 1);
        (1..begin.len()).for_each(|row| begin[row] += begin[row - 1]);
        let (mut next, mut grouped) = (begin.clone(), vec![0; begin[begin.len() - 1]]);
        for node in nodes {
            let place = &mut next[self.number(node) as usize];
            grouped[*place] = node;
            *place += 1;
        }
        Groups { nodes: grouped, begin }
    }
}

/// Nodes by their rows.
pub(super) struct Groups {
    nodes: Vec<u32>,
    /// Those of row r are `begin[r]..begin[r + 1]`.
    begin: Vec<usize>,
}

impl Groups {
    /// Every row that some of the nodes have, and these.
    pub(super) fn iter(&self) -> impl Iterator<Item = (u32, &[u32])> {
        let rows = (0u32..).zip(self.begin.windows(2));
        rows.map(|(row, ends)| (row, &self.nodes[ends[0]..ends[1]])).filter(|(_, nodes)| !nodes.is_empty())
    }
}
