//! A walk drawn at random leg by leg, where judging all legs of a graph would cost more than what the walk is for.

use nalgebra::{Point3, Vector3};
use rand::RngExt;

use super::proven_legs::ProveLegs;
use crate::feasibility::steering::LegTiming;
use crate::math::random::{Stream, unit};
use crate::trajectory::{Profile, ProfileLeg};

/// Legs judged for one walk, at most.
const BUDGET: u32 = 20_000;
/// States drawn for one step, at most, before the walk goes back by one.
const DRAWS: u32 = 400;

/// A walk, and the witness along it.
///
/// `waypoints` are as many as were asked for; the profile has one leg fewer.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Wandered {
    /// The waypoints it passes, both ends included.
    pub(crate) waypoints: Vec<Point3<f64>>,
    /// Its legs.
    pub(crate) profile: Profile,
}

struct Passed<E> {
    waypoint: usize,
    end: E,
    /// The leg that led there.
    leg: Option<ProfileLeg>,
}

/// A walk of `length` waypoints of `points` from the first to the last, none twice, with leg times of `timing`; `None`
/// where none was met within 20 000 judged legs.
///
/// At each step waypoints are drawn, each with a speed that is uniform up to the top speed, until a leg to one is
/// proven, in the shortest time for which it is, and the end is not out of reach from there by its distance alone;
/// where none is met the walk goes back by one. So walks are not equally likely: those through states with few ways on
/// come more often than the others.
pub(crate) fn wander<J: ProveLegs>(
    judge: &J,
    points: &[Point3<f64>],
    timing: &LegTiming,
    length: usize,
    random: &mut Stream,
) -> Option<Wandered> {
    let walker = Walker { judge, points, rungs: timing.rungs() };
    let last = points.len().checked_sub(1)?;
    let at_rest =
        |waypoint: usize, leg| Passed { waypoint, end: judge.state(&points[waypoint], &Vector3::zeros()), leg };
    let mut walk = vec![at_rest(0, None)];
    let mut spent = 0;
    while walk.len() < length {
        let left = length - walk.len();
        let next = if left == 1 {
            spent += 1;
            let end = at_rest(last, None);
            walker.leg(&walk[walk.len() - 1], &end).map(|leg| Passed { leg: Some(leg), ..end })
        } else {
            walker.drawn(&walk, left, &mut spent, random)
        };
        match next {
            Some(passed) => walk.push(passed),
            None if spent >= BUDGET => return None,
            // The leg to the end is found only by drawing what comes before it anew.
            None => walk.truncate((walk.len() - 1).max(1)),
        }
    }
    let waypoints = walk.iter().map(|passed| points[passed.waypoint]).collect();
    Some(Wandered { waypoints, profile: Profile { legs: walk.into_iter().filter_map(|passed| passed.leg).collect() } })
}

struct Walker<'a, J> {
    judge: &'a J,
    points: &'a [Point3<f64>],
    /// Leg times, rising, s.
    rungs: Vec<f64>,
}

impl<J: ProveLegs> Walker<'_, J> {
    /// A state that a leg leads to from the walk's last, with `left` legs to go, this one included.
    fn drawn(
        &self,
        walk: &[Passed<J::End>],
        left: usize,
        spent: &mut u32,
        random: &mut Stream,
    ) -> Option<Passed<J::End>> {
        let Self { judge, points, rungs } = self;
        let from = &walk[walk.len() - 1];
        let longest = rungs.last().copied().unwrap_or(0.0);
        let farthest = judge.fastest() * longest;
        let within = |a: usize, b: usize, legs: usize| (points[b] - points[a]).norm() <= legs as f64 * farthest;
        if points.len() < 3 {
            return None;
        }
        for _ in 0..DRAWS {
            *spent += 1;
            if *spent >= BUDGET {
                return None;
            }
            let waypoint = random.random_range(1..points.len() - 1);
            let possible = within(from.waypoint, waypoint, 1)
                && within(waypoint, points.len() - 1, left - 1)
                && walk.iter().all(|passed| passed.waypoint != waypoint);
            if !possible {
                continue;
            }
            let speed = judge.top_speed() * unit(random);
            let velocity = judge.aimed(points, waypoint, speed, longest, random);
            let Some(end) = judge.passing(&points[waypoint], &velocity) else { continue };
            let passed = Passed { waypoint, end, leg: None };
            if let Some(leg) = self.leg(from, &passed) {
                return Some(Passed { leg: Some(leg), ..passed });
            }
        }
        None
    }

    /// The leg from one state to another in the shortest time for which it is proven.
    fn leg(&self, from: &Passed<J::End>, to: &Passed<J::End>) -> Option<ProfileLeg> {
        let least = (self.points[to.waypoint] - self.points[from.waypoint]).norm() / self.judge.fastest();
        let possible = self.rungs.iter().filter(|rung| **rung >= least);
        possible.map(|rung| self.judge.leg(&from.end, &to.end, *rung)).find_map(Result::ok)
    }
}

/// A waypoint of `points` within `radius` (m) of waypoint `own`, drawn at random; the nearest where none was met in so
/// many draws as there are waypoints.
pub(in crate::feasibility) fn another(points: &[Point3<f64>], own: usize, radius: f64, random: &mut Stream) -> usize {
    let distance = |w: usize| (points[w] - points[own]).norm();
    for _ in 0..points.len() {
        let drawn = random.random_range(0..points.len());
        if drawn != own && distance(drawn) <= radius {
            return drawn;
        }
    }
    let others = (0..points.len()).filter(|w| *w != own);
    others.min_by(|a, b| distance(*a).total_cmp(&distance(*b))).unwrap_or(own)
}
