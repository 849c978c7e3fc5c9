//! The beam against brute force, its bound, its pruning, its repeatability.

use super::super::objective::{Additive, Aggregate, LegView};
use super::super::score::Score;
use super::super::small::{Octahedron, START, enumerate, points};
use super::super::task::Task;
use super::*;
use crate::feasibility::reach::StepNode;

const SMALL: Octahedron = Octahedron::QUADROTOR;

fn search(points: &[nalgebra::Point3<f64>], seed: u64, settings: &BeamSettings) -> BeamOutcome<StepNode> {
    let task = Task { start: START, candidates: points, reach: &SMALL };
    beam(&task, &Score::Random { seed }, |node, steps| SMALL.may_arrive(points, node, steps), settings)
}

#[test]
fn wide_enough_it_finds_exactly_what_brute_force_finds() {
    let mut total = 0;
    for seed in 0..60 {
        let points = points(seed, 9, 11.0);
        let task = Task { start: START, candidates: &points, reach: &SMALL };
        for revisits in [false, true] {
            for aggregate in [Aggregate::Sum, Aggregate::Max] {
                for length in [2, 3, 5] {
                    let all = enumerate(&task, &Score::Random { seed }, (length, revisits, aggregate));
                    for lookahead in [0, 2, 9] {
                        let per_graph = usize::MAX;
                        let settings = BeamSettings {
                            length,
                            per_graph,
                            revisits,
                            aggregate,
                            keep: None,
                            lookahead,
                            ..Default::default()
                        };
                        let outcome = search(&points, seed, &settings);
                        assert_eq!(outcome.ended, Ended::Exhausted { proof: true }, "seed {seed}");
                        let found: Vec<_> = outcome.found.iter().map(|f| (f.waypoints.clone(), f.score)).collect();
                        assert_eq!(found, all, "seed {seed} length {length} revisits {revisits} {aggregate:?}");
                        total += all.len();
                    }
                }
            }
        }
    }
    assert!(total > 2_000, "the instances are too empty to test anything: {total}");
}

#[test]
fn every_result_is_feasible_and_nothing_beats_the_optimum() {
    let mut solved = 0;
    for seed in 0..100 {
        let points = points(seed, 12, 13.0);
        let task = Task { start: START, candidates: &points, reach: &SMALL };
        for revisits in [false, true] {
            let all = enumerate(&task, &Score::Random { seed }, (5, revisits, Aggregate::Sum));
            let outcome = search(&points, seed, &BeamSettings { length: 5, revisits, ..Default::default() });
            for found in &outcome.found {
                assert!(all.contains(&(found.waypoints.clone(), found.score)), "seed {seed}: {found:?}");
                assert_eq!((found.nodes.len(), found.leg_times.len()), (5, 4));
                assert_eq!(found.nodes[4], StepNode { previous: found.waypoints[3], current: found.waypoints[4] });
                assert!(found.score <= all[0].1, "seed {seed}");
                solved += 1;
            }
            if let Ended::Exhausted { proof: true } = outcome.ended {
                assert!(!outcome.found.is_empty() || all.is_empty(), "seed {seed}: proof of none is wrong");
            }
        }
    }
    assert!(solved > 50, "{solved}");
}

#[test]
fn with_revisits_the_reduction_loses_no_optimum() {
    for seed in 0..60 {
        let points = points(seed, 9, 11.0);
        let task = Task { start: START, candidates: &points, reach: &SMALL };
        for aggregate in [Aggregate::Sum, Aggregate::Max] {
            let all = enumerate(&task, &Score::Random { seed }, (6, true, aggregate));
            for keep in [1, 3] {
                let settings = BeamSettings {
                    length: 6,
                    per_graph: usize::MAX,
                    revisits: true,
                    aggregate,
                    keep: Some(keep),
                    ..Default::default()
                };
                let outcome = search(&points, seed, &settings);
                let best: Vec<f64> = outcome.found.iter().take(keep).map(|f| f.score).collect();
                let expected: Vec<f64> = all.iter().take(keep).map(|f| f.1).collect();
                assert_eq!(best, expected, "seed {seed} {aggregate:?}");
            }
        }
    }
}

#[test]
fn the_frontier_and_its_memory_stay_bounded() {
    let points = points(3, 120, 18.0);
    let settings = BeamSettings {
        length: 40,
        per_graph: usize::MAX,
        frontier: 300,
        iterations: 3_000,
        keep: None,
        ..Default::default()
    };
    let task = Task { start: START, candidates: &points, reach: &SMALL };
    let mut largest = 0;
    let score = Score::Random { seed: 3 };
    let arrives = |node: &StepNode, steps| SMALL.may_arrive(&points, node, steps);
    let outcome = beam_observed(&task, &score, arrives, &settings, |seen| {
        largest = largest.max(seen.frontier.len());
        assert!(seen.frontier.is_sorted_by(|a, b| a.1 >= b.1));
    });
    assert_eq!(largest, 300);
    assert!(outcome.dropped > 300, "{}", outcome.dropped);
}

#[test]
fn ties_go_to_the_lower_waypoint_index() {
    let points = points(5, 40, 14.0);
    let task = Task { start: START, candidates: &points, reach: &SMALL };
    let settings = BeamSettings { length: 4, width: 1, keep: None, ..Default::default() };
    let flat = |_: &super::super::objective::LegView<'_>| 1.0;
    let outcome = beam(&task, &flat, |_, _| true, &settings);
    let all = enumerate(&task, &flat, (4, false, Aggregate::Sum));
    assert_eq!(outcome.found[0].waypoints, all[0].0);
}

#[test]
fn the_same_twice() {
    for seed in 0..20 {
        let points = points(seed, 60, 24.0);
        let settings = BeamSettings { length: 8, per_graph: 7, ..Default::default() };
        assert_eq!(search(&points, seed, &settings), search(&points, seed, &settings));
    }
}

#[test]
fn scores_below_zero_take_no_longer() {
    let (mut above, mut below) = (0, 0);
    for seed in 0..20 {
        let points = points(seed, 60, 24.0);
        let wide = Octahedron::WIDE;
        let task = Task { start: START, candidates: &points, reach: &wide };
        let settings = BeamSettings { length: 10, ..Default::default() };
        let search = |shift: f64| {
            let score = |leg: &LegView<'_>| Score::Random { seed }.own(leg) - shift;
            beam(&task, &score, |node, steps| wide.may_arrive(&points, node, steps), &settings)
        };
        let (plain, shifted) = (search(0.0), search(1.0));
        assert_eq!((plain.found.is_empty(), plain.ended), (shifted.found.is_empty(), shifted.ended), "seed {seed}");
        assert!(shifted.found.iter().all(|found| found.score < 0.0), "seed {seed}");
        above += plain.expansions;
        below += shifted.expansions;
    }
    // The shortest first, they were ten times as many.
    assert!(above > 500 && below < 2 * above, "{above} expansions, {below} below zero");
}

#[test]
fn an_objective_may_remember() {
    // Scores the k-th leg with k: only a memory can know it.
    struct Counting;
    impl Objective for Counting {
        type Memory = u32;
        fn start(&self) -> u32 {
            0
        }
        fn extend(&self, memory: &u32, _: &super::super::objective::LegView<'_>) -> (f64, u32) {
            (f64::from(memory + 1), memory + 1)
        }
    }
    let points = points(1, 60, 20.0);
    let task = Task { start: START, candidates: &points, reach: &SMALL };
    let outcome = beam(&task, &Counting, |_, _| true, &BeamSettings { length: 6, ..Default::default() });
    assert!(!outcome.found.is_empty());
    assert!(outcome.found.iter().all(|found| found.score == 15.0));
}

#[test]
fn nothing_to_search_is_no_panic() {
    for (count, length) in [(0, 2), (5, 0), (5, 1), (5, 70)] {
        let points = points(0, count, 1_000.0);
        let settings = BeamSettings { length, width: 0, per_graph: 0, frontier: 0, ..Default::default() };
        assert_eq!(search(&points, 0, &settings).found, []);
        assert_eq!(search(&points[..1], 0, &settings).found, []);
        assert_eq!(search(&[], 0, &settings).found, []);
    }
}
