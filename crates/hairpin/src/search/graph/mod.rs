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
mod by_turn;
mod count;
mod rows;
mod scoring;
#[cfg(feature = "unit-tests")]
mod tests;
mod trim;
mod value;

use std::ops::Range;

use nalgebra::Point3;

use super::objective::LegView;
use super::task::Found;
use crate::feasibility::reach::LegFeatures;
pub(super) use count::Layer;
pub use count::{Count, Counts};
use rows::Rows;
pub(super) use scoring::Scoring;
pub(super) use value::{LegScores, Values};

/// Nodes and legs in compressed rows; node 0 is the start's. Only what a walk from the start can meet is in it.
///
/// Memory: that of the nodes, and 72 bytes a leg; legs that nodes share count once. u32 numbers: at most four billion
/// legs.
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
    /// Waypoint before that of every node, from which its legs are seen; `OWN` where they are kept as it sees them.
    previous: Vec<u32>,
    /// Legs, in rising order of waypoint.
    rows: Rows,
    /// The length for which the legs that no trajectory without revisits has were taken out.
    without_returns: Option<usize>,
}

/// No waypoint before.
const OWN: u32 = u32::MAX;

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
        self.rows.legs()
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
        self.rows.legs_from(node)
    }

    /// Numbers of legs from `node`, and the nodes that they lead to.
    pub(super) fn steps(&self, node: u32) -> impl Iterator<Item = (usize, u32)> {
        self.legs_from(node).zip(self.rows.targets(node))
    }

    /// Node that the leg leads to; [`Self::steps`] knows it of all legs of a node.
    pub(super) fn target(&self, leg: usize) -> u32 {
        self.rows.to[self.rows.place(self.rows.source(leg), leg)]
    }

    /// The legs from `node` to any node at `waypoint`, and these nodes: rows rise with the waypoint, so the first is
    /// found by halving.
    pub(super) fn legs_to(&self, node: u32, waypoint: u32) -> impl Iterator<Item = (usize, u32)> {
        let places = self.rows.to_waypoint(self.rows.number(node), waypoint, |node| self.waypoint(node));
        let gap = self.rows.gap(node);
        let there = places.filter(move |place| !gap.contains(place));
        there.map(move |place| (self.rows.leg_at(node, place), self.rows.to[place]))
    }

    /// The node that a leg starts from.
    ///
    /// By halving over the rows: O(log nodes).
    pub(super) fn source(&self, leg: u32) -> u32 {
        self.rows.source(leg as usize)
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
            let (leg, to) = self.steps(here).find(|&(_, to)| self.nodes[to as usize] == *node)?;
            legs.push(leg as u32);
            here = to;
        }
        Some(legs)
    }

    /// Whether its waypoint is the last candidate. A reach set may have many nodes there (by entry).
    pub(super) fn at_end(&self, node: u32) -> bool {
        self.waypoint(node) as usize + 1 == self.candidates.len()
    }

    /// s; `from` must be the node that `leg` starts from: it is not looked up, since rows are walked anyway.
    pub(super) fn duration(&self, from: u32, leg: usize) -> f64 {
        self.rows.seen_at(self.rows.place(from, leg)).0
    }

    /// `from` must be the node that `leg` starts from.
    pub(super) fn view(&self, from: u32, leg: usize) -> LegView<'a> {
        let place = self.rows.place(from, leg);
        let view = self.kept_view(from, place);
        LegView { features: self.entered(view.features, from, view.to), ..view }
    }

    /// The leg at a place of the row of `from`, as one of those sees it that share the row.
    #[inline]
    fn kept_view(&self, from: u32, place: usize) -> LegView<'a> {
        let (duration, features) = self.rows.seen_at(place);
        let to = self.waypoint(self.rows.to[place]);
        LegView { candidates: self.candidates, from: self.waypoint(from), to, duration, features }
    }

    /// What scores see of a leg to waypoint `to` as `from` sees it.
    #[inline]
    fn entered(&self, features: LegFeatures, from: u32, to: u32) -> LegFeatures {
        match self.previous[from as usize] {
            OWN => features,
            previous => features.entered(self.candidates, [previous, self.waypoint(from), to]),
        }
    }

    /// The trajectory along `legs` from the start.
    pub(super) fn found(&self, legs: &[u32], score: f64) -> Found<N> {
        let (mut nodes, mut leg_times) = (vec![0], Vec::with_capacity(legs.len()));
        for &leg in legs {
            let place = self.rows.place(nodes[nodes.len() - 1], leg as usize);
            leg_times.push(self.rows.seen_at(place).0);
            nodes.push(self.rows.to[place]);
        }
        Found {
            waypoints: nodes.iter().map(|&node| self.waypoint(node)).collect(),
            nodes: nodes.iter().map(|&node| self.node(node)).collect(),
            leg_times,
            score,
        }
    }
}
