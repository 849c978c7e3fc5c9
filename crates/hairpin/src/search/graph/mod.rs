//! The legs of one graph as a graph of their own: nodes are a reach set's nodes, and a trajectory of L waypoints is a
//! walk of L − 1 legs from the start's node to a node at the end. What is exact about a graph is counted and optimised
//! on it.
//!
//! Step-wise sets make a node of (previous, current), so that legs are feasible triples of waypoints: 252² nodes and
//! about 80 000 legs of 250 waypoints with a quadrotor's hull. A trajectory's score and feasibility are then sums and
//! products over legs, which is what makes optimum, count and uniform draws exact.
//!
//! | step | cost |
//! | --- | --- |
//! | explore from the start, breadth first | one look at the reach set a node |
//! | trim to walks of the right length | two breadth-first passes |
//! | count, value | legs · length additions |
//!
//! Data flow: a start's node and a reach set ([`LegGraph::explore`]), or a list of legs ([`LegGraph::from_legs`]) →
//! breadth first to the length → trimmed to walks that arrive → [`LegGraph::counts`] and values (`value`), on which
//! [`super::exact()`], [`super::uniform()`] and the loop's regrowing stand.

mod build;
mod count;
mod details;
#[cfg(test)]
mod tests;
mod value;

use std::ops::Range;

use nalgebra::Point3;

use super::objective::LegView;
use super::task::Found;
pub(super) use count::Layer;
pub use count::{Count, Counts};
use details::Details;
pub(super) use value::{LegScores, Values};

/// Nodes and legs in compressed rows; node 0 is the start's. Only what a walk from the start can meet is in it.
///
/// Memory: 12 bytes a leg, 48 for each that differs in more than what it turns from, 16 for each turn, and the nodes;
/// 76 a leg where none are alike. u32 numbers: at most four billion legs.
///
/// ```
/// use hairpin::feasibility::reach::{Sphere, StepNode, StepReach, StepSettings};
/// use hairpin::search::{Count, LegGraph};
/// use nalgebra::Point3;
///
/// // Four points in a row, 1 m apart, legs of at most 2 m: 0-1-2-3 is one walk of four waypoints to the end.
/// let points: Vec<Point3<f64>> = (0..4).map(|i| Point3::new(f64::from(i), 0.0, 1.0)).collect();
/// let reach = StepReach::new(&Sphere { radius: 2.1 }, &points, StepSettings::default());
/// let graph = LegGraph::explore(StepNode { previous: 0, current: 0 }, &points, &reach, 4);
/// let counts = graph.counts_by_length(4);
/// assert_eq!(counts[..3], [Count::Exact(0); 3]); // no leg of 3 m
/// assert_eq!(counts[3], Count::Exact(2)); // 0-1-3, 0-2-3
/// ```
#[derive(Debug, Clone)]
pub struct LegGraph<'a, N> {
    candidates: &'a [Point3<f64>],
    nodes: Vec<N>,
    /// Waypoint of every node.
    waypoints: Vec<u32>,
    /// Legs from node v are `first[v]..first[v + 1]`, in rising order of waypoint.
    first: Vec<u32>,
    /// Node that a leg leads to.
    to: Vec<u32>,
    details: Details,
    /// The length for which the legs that no trajectory without revisits has were taken out.
    without_returns: Option<usize>,
}

impl<'a, N: Copy> LegGraph<'a, N> {
    /// Number of nodes.
    ///
    /// At least 1: the start's stays even where nothing leads on from it.
    pub fn nodes(&self) -> usize {
        self.nodes.len()
    }

    /// Number of legs: for step-wise sets, of feasible triples that a walk from the start can meet.
    ///
    /// 0 proves that there is no trajectory of the length that the graph was built for, nor of a shorter one.
    pub fn legs(&self) -> usize {
        self.to.len()
    }

    /// Waypoints of the graph, m.
    pub fn candidates(&self) -> &'a [Point3<f64>] {
        self.candidates
    }

    /// The waypoint index of `node`.
    ///
    /// An index into [`Self::candidates`].
    ///
    /// # Panics
    /// If there is no such node.
    pub fn waypoint(&self, node: u32) -> u32 {
        self.waypoints[node as usize]
    }

    /// The reach set's node behind a number.
    pub(super) fn node(&self, node: u32) -> N {
        self.nodes[node as usize]
    }

    /// Numbers of legs; empty for nodes at the end that nothing leads on from.
    pub(super) fn legs_from(&self, node: u32) -> Range<usize> {
        self.first[node as usize] as usize..self.first[node as usize + 1] as usize
    }

    /// Node that the leg leads to.
    pub(super) fn target(&self, leg: usize) -> u32 {
        self.to[leg]
    }

    /// The legs from `node` to any node at `waypoint`: rows rise with the waypoint, so the first is found by halving.
    pub(super) fn legs_to(&self, node: u32, waypoint: u32) -> impl Iterator<Item = usize> {
        let row = self.legs_from(node);
        let before = self.to[row.clone()].partition_point(|&to| self.waypoint(to) < waypoint);
        (row.start + before..row.end).take_while(move |&leg| self.waypoint(self.target(leg)) == waypoint)
    }

    /// The node that a leg starts from.
    ///
    /// By halving over the rows: O(log nodes).
    pub(super) fn source(&self, leg: u32) -> u32 {
        (self.first.partition_point(|&first| first <= leg) - 1) as u32
    }

    /// The legs along `nodes`, the first of which is the start's; `None` where there is no such leg.
    ///
    /// O(legs of the nodes): the row of each node is looked through once. `None` of an empty list too.
    pub(super) fn legs_along(&self, nodes: &[N]) -> Option<Vec<u32>>
    where
        N: Eq,
    {
        let mut here = 0;
        let mut legs = Vec::with_capacity(nodes.len());
        for node in nodes.get(1..)? {
            let leg = self.legs_from(here).find(|&leg| self.nodes[self.target(leg) as usize] == *node)?;
            legs.push(leg as u32);
            here = self.target(leg);
        }
        Some(legs)
    }

    /// Whether its waypoint is the last candidate. A reach set may have many nodes there (by entry).
    pub(super) fn at_end(&self, node: u32) -> bool {
        self.waypoint(node) as usize + 1 == self.candidates.len()
    }

    /// s.
    pub(super) fn duration(&self, leg: usize) -> f64 {
        self.details.duration(leg)
    }

    /// `from` must be the node that `leg` starts from: it is not looked up, since rows are walked anyway.
    pub(super) fn view(&self, from: u32, leg: usize) -> LegView<'a> {
        let (duration, features) = self.details.of(leg);
        let to = self.waypoint(self.target(leg));
        LegView { candidates: self.candidates, from: self.waypoint(from), to, duration, features }
    }

    /// The trajectory along `legs` from the start.
    pub(super) fn found(&self, legs: &[u32], score: f64) -> Found<N> {
        let targets = || legs.iter().map(|&leg| self.target(leg as usize));
        Found {
            waypoints: std::iter::once(0).chain(targets().map(|node| self.waypoint(node))).collect(),
            nodes: std::iter::once(self.nodes[0]).chain(targets().map(|node| self.nodes[node as usize])).collect(),
            leg_times: legs.iter().map(|&leg| self.duration(leg as usize)).collect(),
            score,
        }
    }
}
