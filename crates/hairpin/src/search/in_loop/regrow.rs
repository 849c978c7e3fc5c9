//! A stretch of a trajectory grown anew: a random walk of a given number of legs between two nodes.
//!
//! A randomised depth-first search with a budget of looks: it finds a stretch where there are many, and gives up where
//! there are few.

use rand::RngExt;

use crate::math::random::{Stream, unit};
use crate::search::graph::LegGraph;

/// Legs that are looked at before a stretch is given up.
const BUDGET: u32 = 3_000;
/// Share of legs that are sought among the shortest: a waypoint just passed by, and the way back, are a stress that
/// blind draws among all legs hardly ever meet.
const SHORT: f64 = 0.25;
/// How many count as the shortest.
const SHORTEST: usize = 8;

/// Where a stretch must lead.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Goal {
    /// To this node.
    Node(u32),
    /// To any node at the end.
    End,
}

/// A depth-first search that tries legs in random order, the shortest ones more often.
pub(super) struct Regrow<'g, 'a, N> {
    /// Where legs come from.
    pub(super) graph: &'g LegGraph<'a, N>,
    /// Where the stretch ends.
    pub(super) goal: Goal,
    /// Waypoints that may not be used, by index; empty where all may.
    pub(super) taken: &'g mut [bool],
    /// Of the search that it belongs to.
    pub(super) rng: &'g mut Stream,
    spent: u32,
}

impl<'g, 'a, N: Copy> Regrow<'g, 'a, N> {
    /// With nothing spent of the budget of [`BUDGET`] legs, which all calls of [`Regrow::grow`] share.
    pub(super) fn new(graph: &'g LegGraph<'a, N>, goal: Goal, taken: &'g mut [bool], rng: &'g mut Stream) -> Self {
        Self { graph, goal, taken, rng, spent: 0 }
    }

    /// Appends `steps` legs from `node` to the goal; `false` leaves `legs` as it was.
    ///
    /// Neither uniform over stretches nor complete: `false` is no proof that there is none. `taken` is as before
    /// afterwards.
    pub(super) fn grow(&mut self, node: u32, steps: usize, legs: &mut Vec<u32>) -> bool {
        if steps == 0 || self.graph.legs_from(node).is_empty() {
            return false;
        }
        if let (1, Goal::Node(goal)) = (steps, self.goal) {
            return self.last(node, goal, legs);
        }
        for (leg, to) in self.order(node) {
            self.spent += 1;
            if self.spent > BUDGET {
                return false;
            }
            if steps == 1 {
                if !self.graph.at_end(to) {
                    continue;
                }
                legs.push(leg as u32);
                return true;
            }
            let waypoint = self.graph.waypoint(to) as usize;
            if self.taken.get(waypoint).copied().unwrap_or(false) {
                continue;
            }
            legs.push(leg as u32);
            self.take(waypoint, true);
            let grown = self.grow(to, steps - 1, legs);
            self.take(waypoint, false);
            if grown {
                return true;
            }
            legs.pop();
        }
        false
    }

    /// The legs from `node`, and where they lead, in the order in which they are tried: from a random one on, or one of
    /// the shortest and on to the longest.
    fn order(&mut self, node: u32) -> Vec<(usize, u32)> {
        let mut legs: Vec<(usize, u32)> = self.graph.steps(node).collect();
        if unit(self.rng) < SHORT {
            let place = |node: u32| self.graph.candidates()[self.graph.waypoint(node) as usize];
            let length = |to: u32| (place(to) - place(node)).norm_squared();
            shortest_first(&mut legs, &length);
            let first = self.rng.random_range(0..legs.len().min(SHORTEST));
            legs.swap(0, first);
        } else {
            let first = self.rng.random_range(0..legs.len());
            legs.rotate_left(first);
        }
        legs
    }

    /// Marks a waypoint, where marks are kept.
    fn take(&mut self, waypoint: usize, taken: bool) {
        if let Some(mark) = self.taken.get_mut(waypoint) {
            *mark = taken;
        }
    }

    /// The leg to the goal.
    fn last(&mut self, node: u32, goal: u32, legs: &mut Vec<u32>) -> bool {
        self.spent += 1;
        let found = self.graph.legs_to(node, self.graph.waypoint(goal)).find(|&(_, to)| to == goal);
        legs.extend(found.map(|(leg, _)| leg as u32));
        found.is_some()
    }
}

/// Beside the searches, which are compiled for each kind of node: a sort is as large as they are.
fn shortest_first(legs: &mut [(usize, u32)], length: &dyn Fn(u32) -> f64) {
    legs.sort_by(|&(_, a), &(_, b)| length(a).total_cmp(&length(b)));
}
