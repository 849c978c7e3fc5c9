//! Cutting a leg graph down to what can be part of a trajectory.

use std::borrow::Cow;
use std::collections::HashMap;

use rustc_hash::FxBuildHasher;

use super::LegGraph;
use super::rows::{EMPTY, Rows};

/// No waypoint.
const NONE: u32 = u32::MAX;
/// More than one waypoint.
const MANY: u32 = u32::MAX - 1;

/// What stays of a graph.
trait Stays {
    /// Of what kind a node is; `None` where no leg of it stays.
    fn kind(&self, node: u32) -> Option<u32>;
    /// Whether legs of nodes of a kind to node `to` stay.
    fn leg(&self, kind: u32, to: u32) -> bool;
    /// The waypoint to which no leg of a node stays; `NONE` or `MANY` if there is none.
    fn barred(&self, node: u32) -> u32;
}

/// Walks from the start to the end of at most `most` legs, by the fewest from the start and to the end.
struct Short {
    after: Vec<u32>,
    before: Vec<u32>,
    most: u32,
}

impl Stays for Short {
    fn kind(&self, node: u32) -> Option<u32> {
        Some(self.after[node as usize])
    }

    fn leg(&self, kind: u32, to: u32) -> bool {
        kind.saturating_add(1).saturating_add(self.before[to as usize]) <= self.most
    }

    fn barred(&self, _: u32) -> u32 {
        NONE
    }
}

/// Walks that come to no waypoint for which one glance shows that they have been there.
struct Onward<'w> {
    waypoints: &'w [u32],
    end: u32,
    /// The only waypoint that a node can be entered from.
    entered_from: Vec<u32>,
}

impl Stays for Onward<'_> {
    fn kind(&self, node: u32) -> Option<u32> {
        (self.waypoints[node as usize] != self.end).then_some(0)
    }

    fn leg(&self, _: u32, to: u32) -> bool {
        self.waypoints[to as usize] != 0
    }

    fn barred(&self, node: u32) -> u32 {
        self.entered_from[node as usize]
    }
}

/// Nodes that share a row of what stays.
struct Shared {
    /// The row that they shared before.
    row: u32,
    kind: u32,
    /// The waypoint that is barred to all of them.
    barred: u32,
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
    /// The length is remembered, so that asking again for the same costs nothing. O(nodes + legs kept).
    pub fn into_without_returns(self, length: usize) -> Self {
        if self.without_returns == Some(length) {
            return self;
        }
        let (end, entered_from) = (self.candidates.len() as u32 - 1, self.only_entries());
        let fewer = self.what_stays(&Onward { waypoints: &self.waypoints, end, entered_from });
        Self { without_returns: Some(length), ..self.cut(fewer).trimmed(length) }
    }

    /// Only nodes and legs on a walk from the start to the end of at most `length` waypoints.
    ///
    /// Two breadth-first passes and a copy; a leg that is gone cannot bring back another, so once is enough.
    pub(super) fn trimmed(self, length: usize) -> Self {
        let most = length.saturating_sub(1) as u32;
        let short = Short { after: self.distances_from_start(), before: self.distances_to_end(), most };
        let fewer = self.what_stays(&short);
        self.cut(fewer)
    }

    /// What stays, with what is seen of its legs, which is not copied.
    fn cut(self, mut fewer: Self) -> Self {
        fewer.rows.seen = self.rows.seen;
        fewer
    }

    /// The legs that stay, and the nodes that they lead to or start from, without what is seen of them.
    ///
    /// Nodes that shared a row and are of one kind share what stays of it. A node to which a waypoint was barred before
    /// can only be entered from there, so no other one is barred to it later.
    fn what_stays(&self, stays: &impl Stays) -> Self {
        let (of, sharing) = self.sharing(stays);
        let mut rows = Rows::default();
        for Shared { row, kind, barred } in &sharing {
            for place in self.rows.kept(*row) {
                let to = self.rows.to[place];
                if stays.leg(*kind, to) && self.waypoint(to) != *barred {
                    rows.to.push(to);
                    rows.look.push(self.rows.look[place]);
                }
            }
            rows.end_row();
        }
        let mut stay = vec![false; self.nodes()];
        stay[0] = true;
        let mut gaps = Vec::with_capacity(self.nodes());
        for (node, &row) in (0u32..).zip(&of) {
            let gap = rows.to_waypoint(row, self.barred(stays, node), |node| self.waypoint(node));
            stay[node as usize] |= rows.kept(row).len() > gap.len();
            gaps.push(gap);
        }
        rows.to.iter().for_each(|&to| stay[to as usize] = true);
        let mut number = vec![0; self.nodes()];
        let mut left = Self {
            candidates: self.candidates,
            nodes: Vec::new(),
            waypoints: Vec::new(),
            previous: Vec::new(),
            rows,
            without_returns: self.without_returns,
        };
        for node in (0..self.nodes()).filter(|&node| stay[node]) {
            number[node] = left.nodes.len() as u32;
            left.nodes.push(self.nodes[node]);
            left.waypoints.push(self.waypoints[node]);
            left.previous.push(self.previous[node]);
            left.rows.give(of[node], gaps[node].clone());
        }
        left.rows.to.iter_mut().for_each(|to| *to = number[*to as usize]);
        left
    }

    /// Of every node the number of its row of what stays, and what these are made of, row 1 first.
    fn sharing(&self, stays: &impl Stays) -> (Vec<u32>, Vec<Shared>) {
        let mut numbers: HashMap<(u32, u32), u32, FxBuildHasher> = HashMap::default();
        let mut sharing: Vec<Shared> = Vec::new();
        let row_of = |node| {
            let row = self.rows.number(node);
            let Some(kind) = stays.kind(node).filter(|_| row != EMPTY) else { return EMPTY };
            let barred = self.barred(stays, node);
            let number = *numbers.entry((row, kind)).or_insert(sharing.len() as u32 + 1);
            match sharing.get_mut(number as usize - 1) {
                None => sharing.push(Shared { row, kind, barred }),
                Some(of) if of.barred != barred => of.barred = NONE,
                Some(_) => {}
            }
            number
        };
        ((0..self.nodes() as u32).map(row_of).collect(), sharing)
    }

    /// The waypoint to which a node has no leg, from now on or already.
    fn barred(&self, stays: &impl Stays, node: u32) -> u32 {
        self.rows.gap(node).next().map_or_else(|| stays.barred(node), |place| self.waypoint(self.rows.to[place]))
    }

    /// The only waypoint that a node can be entered from; `NONE` or `MANY` if that is not one.
    fn only_entries(&self) -> Vec<u32> {
        let mut entered_from = vec![NONE; self.nodes()];
        for (row, nodes) in self.rows.groups(0..self.nodes() as u32).iter() {
            // Nodes that share a row stand at one waypoint, and some of them has each of its legs.
            let from = self.waypoint(nodes[0]);
            for &to in &self.rows.to[self.rows.kept(row)] {
                let entry = &mut entered_from[to as usize];
                *entry = if *entry == NONE || *entry == from { from } else { MANY };
            }
        }
        entered_from
    }

    /// Fewest legs from the start; `u32::MAX` where there is no way.
    ///
    /// Breadth first, O(nodes + legs kept): of a row that nodes share, a later node looks only at what those before it
    /// left out.
    fn distances_from_start(&self) -> Vec<u32> {
        let mut distance = vec![u32::MAX; self.nodes()];
        distance[0] = 0;
        let mut left: Vec<_> = (0..self.rows.count()).map(|row| self.rows.kept(row)).collect();
        let mut queue = vec![0u32];
        let mut head = 0;
        while let Some(&node) = queue.get(head) {
            head += 1;
            let (left, gap) = (&mut left[self.rows.number(node) as usize], self.rows.gap(node));
            for place in left.clone().filter(|place| !gap.contains(place)) {
                let to = self.rows.to[place];
                if distance[to as usize] == u32::MAX {
                    distance[to as usize] = distance[node as usize] + 1;
                    queue.push(to);
                }
            }
            *left = left.start.max(gap.start)..left.end.min(gap.end);
        }
        distance
    }

    /// Fewest legs to the end; `u32::MAX` where there is no way. In rounds over the nodes whose distance is not known:
    /// a list of the legs backwards would take longer, for few rounds are needed.
    ///
    /// O(rounds · legs kept), as many rounds as the farthest node has legs to the end.
    fn distances_to_end(&self) -> Vec<u32> {
        let nodes = 0..self.nodes() as u32;
        let mut distance: Vec<u32> = nodes.clone().map(|node| if self.at_end(node) { 0 } else { u32::MAX }).collect();
        let mut open: Vec<u32> = nodes.filter(|&node| distance[node as usize] != 0).collect();
        for round in 1.. {
            // A node has a leg to what is met where the first or the last of its row is outside of its gap.
            let met = |row| {
                let is_met = |place: &usize| distance[self.rows.to[*place] as usize] == round - 1;
                let mut places = self.rows.kept(row);
                places.clone().find(is_met).zip(places.rfind(is_met))
            };
            let ends: Vec<_> = (0..self.rows.count()).map(met).collect();
            let here = |node: &u32| {
                let gap = self.rows.gap(*node);
                ends[self.rows.number(*node) as usize].is_some_and(|(a, b)| !gap.contains(&a) || !gap.contains(&b))
            };
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
