//! The first nodes that a search over any reach set meets, and what becomes of their candidates.

use std::collections::{HashSet, VecDeque};
use std::hash::Hash;

use nalgebra::Point3;

use super::losses::{Counter, Stage};
use crate::feasibility::reach::{Leg, Reach};

/// Nodes of a graph whose candidates are counted, the nearest to the start first.
const NODES: usize = 32;
/// Graphs whose candidates are counted, at most.
pub(in crate::campaign) const GRAPHS: u64 = 4;

/// A graph, and the searches' question to it.
///
/// For explaining, never for searching.
pub(in crate::campaign) struct Explored<'a, N, R> {
    /// Its waypoints, the start first.
    pub(in crate::campaign) points: &'a [Point3<f64>],
    /// What follows what.
    pub(in crate::campaign) reach: R,
    /// The node at the start.
    pub(in crate::campaign) start: N,
    /// Waypoints of a trajectory.
    pub(in crate::campaign) length: usize,
    /// Whether trajectories end at the last waypoint.
    pub(in crate::campaign) ends: bool,
    /// What the reach set is called.
    pub(in crate::campaign) name: &'a str,
}

impl<N: Copy + Eq + Hash, R: Reach<N>> Explored<'_, N, R> {
    /// Counts the candidates of the first nodes. `before` and `after` give the limit that refuses a leg between two
    /// waypoints whatever the reach set says, and though it has the leg; `may_arrive` is necessary for the end to be
    /// reached in so many legs.
    ///
    /// Breadth first, 32 nodes at most; each has all other waypoints as candidates.
    pub(in crate::campaign) fn count(
        &self,
        place: impl Fn(&N) -> u32,
        before: impl Fn(usize, usize) -> Option<(Stage, String)>,
        after: impl Fn(usize, usize) -> Option<(Stage, String)>,
        may_arrive: impl Fn(&N, usize) -> bool,
        counter: &mut Counter,
    ) {
        let mut open = VecDeque::from([(self.start, 1)]);
        let mut seen = HashSet::from([self.start]);
        let mut legs: Vec<Leg<N>> = Vec::new();
        for _ in 0..NODES {
            let Some((node, passed)) = open.pop_front() else { break };
            if passed >= self.length {
                break;
            }
            let here = place(&node) as usize;
            let left = self.length - passed - 1;
            legs.clear();
            self.reach.legs(&node, self.points, &mut legs);
            for next in (0..self.points.len()).filter(|next| *next != here) {
                let leg = legs.iter().find(|leg| leg.waypoint as usize == next);
                if let Some((stage, limit)) = before(here, next) {
                    counter.lose(stage, &limit);
                } else if let Some(leg) = leg {
                    let arrives =
                        if self.ends && left == 0 { next + 1 == self.points.len() } else { may_arrive(&leg.to, left) };
                    match after(here, next) {
                        Some((stage, limit)) => counter.lose(stage, &limit),
                        None if !arrives => counter.lose(Stage::EndPoint, "task.end_m"),
                        None => {
                            counter.keep();
                            if seen.insert(leg.to) {
                                open.push_back((leg.to, passed + 1));
                            }
                        }
                    }
                } else {
                    counter.lose(Stage::Reach, self.name);
                }
            }
        }
    }
}
