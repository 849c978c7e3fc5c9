//! A walk drawn at random leg by leg, where judging all legs of a graph would cost more than what the walk is for.

use nalgebra::Point3;
use rand::RngExt;

use super::proven_legs::{ProveLegs, WitnessNode};
use super::states::States;
use crate::math::random::Stream;

/// Legs judged for one walk, at most.
const BUDGET: u32 = 20_000;
/// States drawn for one step, at most, before the walk goes back by one.
const DRAWS: u32 = 400;

impl<J: ProveLegs> States<'_, J> {
    /// A walk of `length` waypoints from the start to the end, none twice; `None` where none was met within 20 000 judged legs.
    ///
    /// At each step every state that a proven leg leads to, and from which the end is not out of reach by its distance
    /// alone, is equally likely; a walk that leads nowhere goes back by one. So walks are not equally likely: those
    /// through states with few ways on come more often than the others.
    pub(in crate::feasibility) fn wander(&self, length: usize, random: &mut Stream) -> Option<Vec<WitnessNode>> {
        let end = (self.points().len() - 1) as u32;
        let mut walk = vec![self.start()];
        let mut spent = 0;
        while walk.len() < length {
            let left = length - walk.len();
            let next = if left == 1 {
                spent += 1;
                self.step(walk[walk.len() - 1], end, 0)
            } else {
                self.drawn(&walk, left, &mut spent, random)
            };
            match next {
                Some(node) => walk.push(node),
                None if spent >= BUDGET => return None,
                // The leg to the end is found only by drawing what comes before it anew.
                None => walk.truncate((walk.len() - 1).max(1)),
            }
        }
        Some(walk)
    }

    /// A state that a leg leads to from the walk's last, with `left` legs to go, this one included.
    fn drawn(&self, walk: &[WitnessNode], left: usize, spent: &mut u32, random: &mut Stream) -> Option<WitnessNode> {
        let (from, points) = (walk[walk.len() - 1], self.points());
        let farthest = self.longest() * self.judge().fastest();
        let within = |a: &Point3<f64>, b: &Point3<f64>, legs: usize| (b - a).norm() <= legs as f64 * farthest;
        for _ in 0..DRAWS {
            *spent += 1;
            if *spent >= BUDGET {
                return None;
            }
            let waypoint = random.random_range(1..points.len() - 1);
            let states = self.of(waypoint);
            let velocity = random.random_range(0..states.end - states.start);
            let place = &points[waypoint];
            let possible = within(&points[from.waypoint as usize], place, 1)
                && within(place, &points[points.len() - 1], left - 1)
                && walk.iter().all(|node| node.waypoint != waypoint as u32);
            if let Some(node) = possible.then(|| self.step(from, waypoint as u32, velocity)).flatten() {
                return Some(node);
            }
        }
        None
    }

    /// The node at velocity `velocity` of `waypoint`, if a leg from `from` leads there.
    fn step(&self, from: WitnessNode, waypoint: u32, velocity: u32) -> Option<WitnessNode> {
        let to = WitnessNode { previous: from.waypoint, waypoint, velocity };
        self.rung(&from, &to).map(|_| to)
    }
}
