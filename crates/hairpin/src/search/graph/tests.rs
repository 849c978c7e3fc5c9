//! Counts and graphs against brute force.

use super::super::objective::Aggregate;
use super::super::score::Score;
use super::super::small::{Octahedron, START, enumerate, points};
use super::super::task::Task;
use super::*;
use crate::feasibility::reach::{Entry, Leg, Reach, StepNode};

const SMALL: Octahedron = Octahedron::WIDE;

#[test]
fn counts_of_every_length_are_those_of_brute_force() {
    let mut total = 0;
    for seed in 0..40 {
        let points = points(seed, 8, 11.0);
        let task = Task { start: START, candidates: &points, reach: &SMALL };
        let graph = LegGraph::explore(START, &points, task.reach, 6);
        let counts = graph.counts_by_length(6);
        let kept = graph.counts(6);
        assert_eq!(counts.len(), 7);
        for (length, count) in counts.iter().enumerate() {
            assert_eq!(graph.has_walk(length), !count.is_zero(), "seed {seed}, length {length}");
        }
        for (length, count) in counts.iter().enumerate().skip(2) {
            let all = enumerate(&task, &Score::Random { seed }, (length, true, Aggregate::Sum)).len();
            assert_eq!(*count, Count::Exact(all as u128), "seed {seed} length {length}");
            assert_eq!(kept.from_start(length - 1), *count);
            total += all;
        }
    }
    assert!(total > 2_000, "{total}");
}

#[test]
fn without_returns_no_loop_free_trajectory_is_lost() {
    for seed in 0..40 {
        let points = points(seed, 8, 11.0);
        let task = Task { start: START, candidates: &points, reach: &SMALL };
        let graph = LegGraph::explore(START, &points, task.reach, 5);
        let fewer = graph.without_returns(5);
        let score = Score::Random { seed };
        let loop_free = enumerate(&task, &score, (5, false, Aggregate::Sum)).len() as f64;
        let walks = graph.counts_by_length(5)[5].as_f64();
        let no_returns = fewer.counts_by_length(5)[5].as_f64();
        assert!(loop_free <= no_returns && no_returns <= walks, "seed {seed}: {loop_free} {no_returns} {walks}");
        // At length 4 only the way straight back and the passing of an end can repeat a waypoint.
        let short = fewer.counts_by_length(4)[4];
        let expected = enumerate(&task, &score, (4, false, Aggregate::Sum)).len() as u128;
        assert_eq!(short, Count::Exact(expected), "seed {seed}");
    }
}

#[test]
fn a_list_of_legs_is_the_same_graph() {
    let points = points(2, 10, 11.0);
    let task = Task { start: START, candidates: &points, reach: &SMALL };
    let mut legs: Vec<(StepNode, Leg<StepNode>)> = Vec::new();
    let n = points.len() as u32;
    for node in (0..n * n).map(|i| StepNode { previous: i / n, current: i % n }) {
        let mut out = Vec::new();
        SMALL.legs(&node, &points, &mut out);
        legs.extend(out.into_iter().map(|leg| (node, leg)));
    }
    legs.reverse();
    let listed = LegGraph::from_legs(START, &points, &legs, 6);
    let explored = LegGraph::explore(START, &points, task.reach, 6);
    assert!(explored.legs() > 50);
    assert_eq!((listed.nodes(), listed.legs()), (explored.nodes(), explored.legs()));
    assert_eq!(listed.counts_by_length(6), explored.counts_by_length(6));
}

#[test]
fn counts_beyond_128_bits_are_marked() {
    // Everything follows everything: n − 1 choices a leg, about (n − 1)^(L − 2) trajectories.
    let everything = Octahedron { centre: nalgebra::Vector3::zeros(), half: nalgebra::Vector3::repeat(1e9) };
    let points = points(0, 20, 1.0);
    let task = Task { start: START, candidates: &points, reach: &everything };
    let graph = LegGraph::explore(START, &points, task.reach, 50);
    let counts = graph.counts_by_length(50);
    assert_eq!(counts[3], Count::Exact(20));
    // Walks of s legs between two different vertices of the complete graph: ((n−1)^s − (−1)^s)/n.
    assert_eq!(counts[20], Count::Exact((21u128.pow(19) + 1) / 22));
    let Count::About(about) = counts[50] else { panic!("{}", counts[50]) };
    let expected = 21f64.powi(49) / 22.0;
    assert!((about / expected - 1.0).abs() < 1e-9, "{about} {expected}");
    assert!(counts[50].to_string().starts_with('~'), "{}", counts[50]);
}

/// Legs of at most 7 m; nodes of one waypoint are of one state, which is told or not.
struct Near {
    told: bool,
}

impl Reach<StepNode> for Near {
    fn legs(&self, from: &StepNode, candidates: &[Point3<f64>], out: &mut Vec<Leg<StepNode>>) {
        let StepNode { previous, current } = *from;
        for next in (0..candidates.len() as u32).filter(|&next| next != current) {
            let way = candidates[next as usize] - candidates[current as usize];
            if way.norm() <= 7.0 {
                let features =
                    LegFeatures { v_out: way.norm(), length: way.norm(), climb: way.z, ..Default::default() }
                        .entered(candidates, [previous, current, next]);
                let to = StepNode { previous: current, current: next };
                out.push(Leg { to, waypoint: next, duration: way.norm(), features });
            }
        }
    }

    fn entry(&self, from: &StepNode) -> Option<Entry> {
        self.told.then_some(Entry { state: from.current as usize, previous: from.previous })
    }
}

#[test]
fn nodes_that_share_their_legs_have_those_of_their_own() {
    let mut legs = 0;
    for (seed, length) in (0..40).zip([2, 4, 5, 7].into_iter().cycle()) {
        let points = points(seed, 12, 11.0);
        let both = [true, false].map(|told| LegGraph::explore(START, &points, &Near { told }, length));
        let kept = both.each_ref().map(|graph| graph.rows.to.len());
        assert!(length == 2 || kept[0] < kept[1], "{kept:?}");
        for [shared, own] in [both.clone(), both.map(|graph| graph.into_without_returns(length))] {
            assert_eq!((shared.nodes(), shared.legs()), (own.nodes(), own.legs()), "seed {seed}");
            assert_eq!(shared.counts_by_length(length), own.counts_by_length(length), "seed {seed}");
            let score = Score::HighVelocityTurn { v_max: 7.0, turn: 1.0, product: false };
            let [a, b] = [&shared, &own].map(|graph| graph.scores(&score));
            for node in 0..own.nodes() as u32 {
                assert_eq!(shared.node(node), own.node(node));
                assert!(shared.steps(node).eq(own.steps(node)), "seed {seed}");
                for (leg, to) in own.steps(node) {
                    let views = [&shared, &own].map(|graph| graph.view(node, leg));
                    assert_eq!((views[0].features, views[0].duration), (views[1].features, views[1].duration));
                    assert_eq!(a.own(leg).to_bits(), b.own(leg).to_bits());
                    assert_eq!((shared.target(leg), shared.source(leg as u32)), (to, node));
                    assert!(shared.legs_to(node, shared.waypoint(to)).eq([(leg, to)]));
                    legs += 1;
                }
            }
            for aggregate in [Aggregate::Sum, Aggregate::Max] {
                let [a, b] = [(&shared, &a), (&own, &b)].map(|(graph, scores)| {
                    let values = graph.values(length, scores, aggregate, &graph.near_start(length));
                    values.best((aggregate.neutral(), 0.0), 0, length - 1)
                });
                assert_eq!(a, b, "seed {seed}");
            }
        }
    }
    assert!(legs > 2_000, "{legs}");
}

/// Legs of at most 7 m between waypoints that are passed at one of four speeds; nodes are the waypoint before, the one
/// here and the speed.
struct Fast;

impl Reach<(u32, u32, u32)> for Fast {
    fn legs(&self, from: &(u32, u32, u32), candidates: &[Point3<f64>], out: &mut Vec<Leg<(u32, u32, u32)>>) {
        let (previous, here, speed) = *from;
        for next in (0..candidates.len() as u32).filter(|&next| next != here) {
            let way = candidates[next as usize] - candidates[here as usize];
            for faster in (0..4).filter(|_| way.norm() <= 7.0) {
                let [v_in, v_out] = [speed, faster].map(|speed| 0.3 + 1.7 * f64::from(speed));
                let features = LegFeatures { v_in, v_out, length: way.norm(), climb: way.z, ..Default::default() }
                    .entered(candidates, [previous, here, next]);
                out.push(Leg { to: (here, next, faster), waypoint: next, duration: way.norm(), features });
            }
        }
    }

    fn entry(&self, &(previous, here, speed): &(u32, u32, u32)) -> Option<Entry> {
        Some(Entry { state: (4 * here + speed) as usize, previous })
    }
}

#[test]
fn values_by_turns_are_those_of_scores_to_the_bit() {
    let mut compared = 0;
    for (seed, length) in (0..8).zip([3, 4, 6, 9].into_iter().cycle()) {
        let points = points(seed, 20, 11.0);
        let graph = LegGraph::explore((0, 0, 0), &points, &Fast, length);
        for graph in [graph.clone(), graph.into_without_returns(length)] {
            let near_start = graph.near_start(length);
            for name in Score::NAMES {
                let score = Score::named(name, seed, 7.0).unwrap();
                for aggregate in [Aggregate::Sum, Aggregate::Max] {
                    let Some(values) = graph.values_by_turn(length, &score, aggregate, &near_start) else { continue };
                    let all = graph.values(length, &graph.scores(&score), aggregate, &near_start);
                    for (node, legs) in (0..graph.nodes() as u32).flat_map(|node| (0..length).map(move |n| (node, n))) {
                        let [a, b] = [&values, &all].map(|values| values.best((aggregate.neutral(), 0.0), node, legs));
                        assert_eq!(a.map(f64::to_bits), b.map(f64::to_bits), "{name} seed {seed} {aggregate:?}");
                        compared += usize::from(a.is_some());
                    }
                }
            }
        }
    }
    assert!(compared > 10_000, "{compared}");
}
