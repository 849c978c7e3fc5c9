//! A walk drawn at random leg by leg, where judging all legs of a graph would cost more than what the walk is for.

use nalgebra::Point3;
use rand::RngExt;

use super::proven_legs::ProveLegs;
use crate::math::random::{Stream, unit};
use crate::trajectory::{Profile, ProfileLeg};

/// Legs judged for one walk, at most.
const BUDGET: u32 = 20_000;
/// States drawn for one step, at most, before the walk goes back by one.
const DRAWS: u32 = 400;

/// A walk, and the witness along it.
#[derive(Debug, Clone, PartialEq)]
pub struct Wandered {
    /// The waypoints it passes, both ends included.
    pub waypoints: Vec<Point3<f64>>,
    /// Its legs.
    pub profile: Profile,
}

/// How states of waypoints are made.
pub(in crate::feasibility) struct Ends<'a, E> {
    /// At rest.
    pub(in crate::feasibility) at_rest: &'a dyn Fn(&Point3<f64>) -> E,
    /// At a waypoint with its number, at a speed, in a direction drawn at random.
    pub(in crate::feasibility) moving: &'a dyn Fn(usize, f64, &mut Stream) -> E,
}

struct Passed<E> {
    waypoint: usize,
    end: E,
    /// The leg that led there.
    leg: Option<ProfileLeg>,
}

/// A walk of `length` waypoints of `points` from the first to the last, none twice, with leg times of `rungs`; `None`
/// where none was met within 20 000 judged legs.
///
/// At each step waypoints are drawn, each with a speed that is uniform up to the top speed, until a leg to one is
/// proven, in the shortest time for which it is, and the end is not out of reach from there by its distance alone;
/// where none is met the walk goes back by one. So walks are not equally likely: those through states with few ways on
/// come more often than the others.
pub(in crate::feasibility) fn wander<J: ProveLegs>(
    judge: &J,
    points: &[Point3<f64>],
    rungs: &[f64],
    ends: &Ends<J::End>,
    length: usize,
    random: &mut Stream,
) -> Option<Wandered> {
    let last = points.len().checked_sub(1)?;
    let mut walk = vec![Passed { waypoint: 0, end: (ends.at_rest)(&points[0]), leg: None }];
    let mut spent = 0;
    while walk.len() < length {
        let left = length - walk.len();
        let next = if left == 1 {
            spent += 1;
            let end = (ends.at_rest)(&points[last]);
            let leg = leg(judge, points, rungs, &walk[walk.len() - 1], (last, &end));
            leg.map(|leg| Passed { waypoint: last, end, leg: Some(leg) })
        } else {
            drawn(judge, points, rungs, ends, &walk, (left, &mut spent), random)
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

/// A state that a leg leads to from the walk's last, with `left` legs to go, this one included.
fn drawn<J: ProveLegs>(
    judge: &J,
    points: &[Point3<f64>],
    rungs: &[f64],
    ends: &Ends<J::End>,
    walk: &[Passed<J::End>],
    (left, spent): (usize, &mut u32),
    random: &mut Stream,
) -> Option<Passed<J::End>> {
    let from = &walk[walk.len() - 1];
    let farthest = judge.fastest() * rungs.last().copied().unwrap_or(0.0);
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
        let end = (ends.moving)(waypoint, judge.top_speed() * unit(random), random);
        if let Some(leg) = leg(judge, points, rungs, from, (waypoint, &end)) {
            return Some(Passed { waypoint, end, leg: Some(leg) });
        }
    }
    None
}

/// The leg to `end` at waypoint number `to` in the shortest time for which it is proven.
fn leg<J: ProveLegs>(
    judge: &J,
    points: &[Point3<f64>],
    rungs: &[f64],
    from: &Passed<J::End>,
    (to, end): (usize, &J::End),
) -> Option<ProfileLeg> {
    let least = (points[to] - points[from.waypoint]).norm() / judge.fastest();
    rungs.iter().filter(|rung| **rung >= least).find_map(|rung| judge.leg(&from.end, end, *rung).ok())
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
