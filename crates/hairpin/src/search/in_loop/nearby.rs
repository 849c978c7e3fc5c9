//! One waypoint of a trajectory put to a place near it: stress hardly jumps from place to place, so what is next to a
//! stressful trajectory is often more so.
//!
//! The sixteen nearest waypoints that the trajectory does not use; both legs at the moved waypoint must be legs of the
//! graph.

use rand::RngExt;

use crate::math::random::Stream;
use crate::search::graph::LegGraph;

/// How many places count as near.
const NEAR: usize = 16;

/// The trajectory along `legs` with its waypoint number `moved` + 1 put to one of those near it that it does not use,
/// drawn uniformly, and all others left; `None` where `graph` has no such legs.
///
/// `legs` are numbers of the graph's legs from the start on, `moved` counts them. Where nodes are pairs of waypoints,
/// the legs after the moved waypoint have other nodes until both of a pair are old ones; each must be in the graph.
pub(super) fn nearby<N: Copy>(
    graph: &LegGraph<'_, N>,
    legs: &[u32],
    moved: usize,
    rng: &mut Stream,
) -> Option<Vec<u32>> {
    let waypoint = |&leg: &u32| graph.waypoint(graph.target(leg as usize));
    let place = near(graph, legs, waypoint(&legs[moved]), rng)?;
    let waypoints = std::iter::once(place).chain(legs[moved + 1..].iter().map(waypoint));
    let mut changed = legs[..moved].to_vec();
    let mut node = changed.last().map_or(0, |&leg| graph.target(leg as usize));
    for (&leg, waypoint) in legs[moved..].iter().zip(waypoints) {
        // Where the way comes to a node that it has come to before, it goes on as it did.
        if changed.len() > moved && graph.source(leg) == node {
            changed.extend_from_slice(&legs[changed.len()..]);
            break;
        }
        let (leg, to) = graph.legs_to(node, waypoint).next()?;
        changed.push(leg as u32);
        node = to;
    }
    Some(changed)
}

/// One of the places nearest to `waypoint` that `legs` do not lead to.
///
/// Uniform among the [`NEAR`] nearest, Euclidean, ties by index. `None` where all are used.
fn near<N: Copy>(graph: &LegGraph<'_, N>, legs: &[u32], waypoint: u32, rng: &mut Stream) -> Option<u32> {
    let candidates = graph.candidates();
    let used = |place: &u32| legs.iter().any(|&leg| graph.waypoint(graph.target(leg as usize)) == *place);
    // Neither the start nor the end.
    let mut places: Vec<u32> = (1..candidates.len() as u32 - 1).filter(|place| !used(place)).collect();
    let here = candidates[waypoint as usize];
    let distance = |place: u32| (candidates[place as usize] - here).norm_squared();
    let near = NEAR.min(places.len());
    if near == 0 {
        return None;
    }
    if near < places.len() {
        places.select_nth_unstable_by(near, |&a, &b| distance(a).total_cmp(&distance(b)).then(a.cmp(&b)));
        places.truncate(near);
        places.sort_unstable();
    }
    Some(places[rng.random_range(0..near)])
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::super::regrow::{Goal, Regrow};
    use super::super::tests::{LENGTH, SMALL};
    use super::*;
    use crate::math::random::stream;
    use crate::search::small::{START, points};

    #[test]
    fn one_waypoint_moves_to_a_place_nearby_and_the_way_stays_feasible() {
        let mut moves = 0;
        for seed in 0..40 {
            let points = points(seed, 30, 11.0);
            let graph = LegGraph::explore(START, &points, &SMALL, LENGTH);
            let mut rng = stream(seed);
            for draw in 0..200 {
                let (mut legs, mut taken) = (Vec::new(), vec![false; points.len()]);
                if !Regrow::new(&graph, Goal::End, &mut taken, &mut rng).grow(0, LENGTH - 1, &mut legs) {
                    continue;
                }
                let moved = draw % (LENGTH - 2);
                let Some(changed) = nearby(&graph, &legs, moved, &mut rng) else { continue };
                let waypoints = |legs: &[u32]| graph.found(legs, 0.0).waypoints;
                let (before, after) = (waypoints(&legs), waypoints(&changed));
                let differ: Vec<usize> = (0..LENGTH).filter(|&k| before[k] != after[k]).collect();
                assert_eq!(differ, [moved + 1], "seed {seed}: {before:?} {after:?}");
                assert!(!before[1..].contains(&after[moved + 1]), "seed {seed}");
                let distance = |w: u32| (points[w as usize] - points[before[moved + 1] as usize]).norm_squared();
                let nearer = (1..points.len() as u32 - 1).filter(|&w| !before[1..].contains(&w));
                assert!(nearer.filter(|&w| distance(w) < distance(after[moved + 1])).count() < NEAR);
                let mut node = 0;
                for &leg in &changed {
                    assert_eq!(graph.source(leg), node);
                    node = graph.target(leg as usize);
                }
                assert!(graph.at_end(node));
                moves += 1;
            }
        }
        assert!(moves > 100, "{moves}");
    }
}
