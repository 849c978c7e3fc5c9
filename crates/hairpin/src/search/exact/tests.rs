//! The optimum against brute force, with and without revisits, and what is said where it is not proven.

use super::super::objective::{LegView, Objective};
use super::super::open_end::OpenEnd;
use super::super::score::Score;
use super::super::small::{Loose, Octahedron, START, enumerate, enumerate_open, points};
use super::super::task::Task;
use super::*;
use crate::feasibility::reach::{Leg, LegFeatures};
use crate::math::random::hashed_unit;
use nalgebra::Point3;

const SMALL: Octahedron = Octahedron::WIDE;

fn close(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-12 * a.abs().max(1.0)
}

#[test]
fn the_best_are_those_of_brute_force() {
    let mut compared = 0;
    for seed in 0..40 {
        let points = points(seed, 9, 11.0);
        let task = Task { start: START, candidates: &points, reach: &SMALL };
        for length in [2, 3, 5, 6] {
            let graph = LegGraph::explore(START, &points, task.reach, length);
            for revisits in [false, true] {
                for aggregate in [Aggregate::Sum, Aggregate::Max] {
                    let score = Score::Random { seed };
                    let all = enumerate(&task, &score, (length, revisits, aggregate));
                    for best in [1, 5, 10_000] {
                        let settings = ExactSettings { length, best, revisits, aggregate, ..Default::default() };
                        let outcome = exact(&graph, &score, &settings);
                        let told = format!("seed {seed} length {length} revisits {revisits} {aggregate:?} best {best}");
                        assert_eq!(outcome.found.len(), all.len().min(best), "{told}");
                        assert_eq!(outcome.proven, outcome.found.len(), "{told}");
                        assert_eq!(outcome.bound.is_none(), all.is_empty(), "{told}");
                        for (found, (_, expected)) in outcome.found.iter().zip(&all) {
                            assert!(close(found.score, *expected), "{told}: {} {expected}", found.score);
                            assert!(
                                all.iter()
                                    .any(|(waypoints, s)| *waypoints == found.waypoints && close(*s, found.score))
                            );
                            compared += 1;
                        }
                    }
                }
            }
        }
    }
    assert!(compared > 5_000, "{compared}");
}

/// The best over legs that are proven as they are asked for is that over all that were proven first.
#[test]
fn what_is_proven_as_it_comes_off_the_queue_is_the_best_there_is() {
    let (mut compared, mut given_up) = (0, 0);
    for seed in 0..40 {
        let points = points(seed, 9, 11.0);
        let graph = LegGraph::explore(START, &points, &SMALL, 6);
        for (share, revisits, aggregate) in [
            (1.1, false, Aggregate::Sum),
            (1.1, true, Aggregate::Max),
            (1.5, true, Aggregate::Sum),
            (1.5, false, Aggregate::Max),
        ] {
            let more = Loose::of(share, &points);
            let possible = LegGraph::explore_possible(START, &points, &more, 6);
            assert!(possible.legs() > graph.legs(), "seed {seed}");
            for score in [Score::Random { seed }, Score::HighVelocity { v_max: 12.0 }] {
                for best in [1, 5] {
                    let settings = ExactSettings { length: 6, best, revisits, aggregate, ..Default::default() };
                    let all = exact(&graph, &score, &settings);
                    let proven = exact_proven(&possible, &more, &score, &settings).expect("within the budget");
                    let scores = |outcome: &ExactOutcome<_>| -> Vec<f64> {
                        outcome.found.iter().map(|found| found.score).collect()
                    };
                    let told = format!("seed {seed} share {share} best {best}");
                    assert_eq!((scores(&proven), proven.bound), (scores(&all), all.bound), "{told}");
                    assert_eq!(proven.proven, all.proven, "{told}");
                    assert!(proven.found.iter().all(|found| found.leg_times == [1.0; 5]), "{told}");
                    compared += proven.found.len();
                    let few = exact_proven(&possible, &more, &score, &ExactSettings { expansions: 2, ..settings });
                    given_up += usize::from(few.is_none());
                }
            }
            // To a free end likewise.
            let (sink, loose) = (OpenEnd::new(SMALL, &points), OpenEnd::new(Loose::of(share, &points), &points));
            let start = sink.task(START).start;
            let open = LegGraph::explore(start, sink.candidates(), &sink, 6);
            let possible_open = LegGraph::explore_possible(start, loose.candidates(), &loose, 6);
            let settings = ExactSettings { length: 6, best: 3, revisits, aggregate, ..Default::default() };
            let score = Score::HighVelocity { v_max: 12.0 };
            let all = exact(&open, &sink.score(&score, aggregate), &settings);
            let proven = exact_proven(&possible_open, &loose, &loose.score(&score, aggregate), &settings);
            let proven = proven.expect("within the budget");
            assert_eq!(proven.bound, all.bound, "seed {seed} share {share}, free end");
            let timed = |leg: &LegView<'_>| leg.duration;
            assert!(
                exact_proven(&possible, &more, &timed, &ExactSettings { length: 6, ..Default::default() }).is_none()
            );
        }
    }
    assert!(compared > 500 && given_up > 100, "{compared} {given_up}");
}

/// A number per leg, and another that the leg leaves to the next.
struct Leaving {
    seed: u64,
}

impl Objective for Leaving {
    type Memory = f64;

    fn start(&self) -> f64 {
        0.0
    }

    fn extend(&self, before: &f64, leg: &LegView<'_>) -> (f64, f64) {
        (self.own(leg) + before, self.left(leg))
    }
}

impl Additive for Leaving {
    fn own(&self, leg: &LegView<'_>) -> f64 {
        assert!((leg.to as usize) < leg.candidates.len(), "a sink is nobody's business but the search's");
        hashed_unit(self.seed, &[leg.from.into(), leg.to.into()])
    }

    fn left(&self, leg: &LegView<'_>) -> f64 {
        2.0 * hashed_unit(self.seed + 1, &[leg.from.into(), leg.to.into()]) - 0.5
    }
}

#[test]
fn what_legs_leave_to_the_next_is_searched_as_brute_force_finds_it() {
    let (mut compared, mut open) = (0, 0);
    for seed in 0..40 {
        let points = points(seed, 9, 11.0);
        let task = Task { start: START, candidates: &points, reach: &SMALL };
        let sink = OpenEnd::new(SMALL, &points);
        for (length, revisits) in [(2, false), (3, true), (5, false), (5, true)] {
            for aggregate in [Aggregate::Sum, Aggregate::Max] {
                let score = Leaving { seed };
                let graph = LegGraph::explore(START, &points, task.reach, length);
                let told = format!("seed {seed} length {length} revisits {revisits} {aggregate:?}");
                // The beam that takes over where the proof is given up never comes back to a waypoint.
                let few = if revisits { 50_000 } else { 1 };
                for (best, expansions) in [(1, 50_000), (7, 50_000), (1, few)] {
                    let settings = ExactSettings { length, best, revisits, aggregate, expansions, width: 10_000 };
                    let all = enumerate(&task, &score, (length, revisits, aggregate));
                    let outcome = exact(&graph, &score, &settings);
                    assert_eq!(outcome.found.len(), all.len().min(best), "{told}");
                    assert!(outcome.bound.is_none_or(|bound| bound >= all[0].1 - 1e-12), "{told}");
                    for (found, (_, expected)) in outcome.found.iter().zip(&all) {
                        assert!(close(found.score, *expected), "{told}: {} {expected}", found.score);
                        assert!(all.iter().any(|(walk, s)| *walk == found.waypoints && close(*s, found.score)));
                        compared += 1;
                    }
                    open += usize::from(outcome.proven < outcome.found.len());

                    // To a sink, to which nothing is left.
                    let all = enumerate_open(&task, &score, (length, revisits, aggregate));
                    let settings = ExactSettings { length: length + 1, ..settings };
                    let start = sink.task(START).start;
                    let graph = LegGraph::explore(start, sink.candidates(), &sink, length + 1);
                    let outcome = exact(&graph, &sink.score(&score, aggregate), &settings);
                    assert_eq!(outcome.found.len(), all.len().min(best), "{told}, free end");
                    for (found, (_, expected)) in outcome.found.iter().zip(&all) {
                        assert!(close(found.score, *expected), "{told}, free end: {} {expected}", found.score);
                        compared += 1;
                    }
                }
            }
        }
    }
    assert!(compared > 1_000 && open > 50, "{compared} {open}");
}

#[test]
fn without_a_proof_the_gap_is_told() {
    let mut open = 0;
    for seed in 0..20 {
        let points = points(seed, 10, 11.0);
        let task = Task { start: START, candidates: &points, reach: &SMALL };
        let graph = LegGraph::explore(START, &points, task.reach, 6);
        let score = Score::Random { seed };
        let all = enumerate(&task, &score, (6, false, Aggregate::Sum));
        let settings = ExactSettings { length: 6, expansions: 2, width: 10_000, ..Default::default() };
        let outcome = exact(&graph, &score, &settings);
        if outcome.proven == 0 && !all.is_empty() {
            // So wide a beam is complete; the bound must stay above it.
            assert!(close(outcome.found[0].score, all[0].1), "seed {seed}");
            assert!(outcome.bound.unwrap() >= all[0].1 - 1e-12, "seed {seed}");
            assert!(outcome.gap().unwrap() >= 0.0);
            open += 1;
        }
        let narrow = exact(&graph, &score, &ExactSettings { width: 1, ..settings });
        assert!(narrow.found.iter().all(|found| all.iter().any(|(waypoints, _)| *waypoints == found.waypoints)));
    }
    assert!(open > 5, "{open}");
}

#[test]
fn where_no_walk_is_there_is_no_bound() {
    let points = points(0, 5, 1_000.0);
    let task = Task { start: START, candidates: &points, reach: &SMALL };
    let graph = LegGraph::explore(START, &points, task.reach, 6);
    let outcome = exact(&graph, &Score::Random { seed: 0 }, &ExactSettings { length: 6, ..Default::default() });
    assert!(!graph.has_walk(6) && outcome.bound.is_none() && outcome.found.is_empty());
    for length in [0, 1] {
        let settings = ExactSettings { length, ..Default::default() };
        assert!(exact(&graph, &Score::Random { seed: 0 }, &settings).found.is_empty());
    }
}

#[test]
fn worthless_legs_make_trajectories_too() {
    let mut tested = 0;
    for seed in 0..10 {
        let points = points(seed, 9, 11.0);
        let task = Task { start: START, candidates: &points, reach: &SMALL };
        let graph = LegGraph::explore(START, &points, task.reach, 5);
        for aggregate in [Aggregate::Sum, Aggregate::Max] {
            for revisits in [true, false] {
                let exists = !enumerate(&task, &Score::Random { seed }, (5, revisits, aggregate)).is_empty();
                let settings = ExactSettings { length: 5, aggregate, revisits, ..Default::default() };
                let outcome = exact(&graph, &|_: &LegView<'_>| f64::NAN, &settings);
                assert_eq!((outcome.found.len(), outcome.proven), (exists.into(), exists.into()), "seed {seed}");
                tested += usize::from(exists);
            }
        }
    }
    assert!(tested > 10, "{tested}");
}

#[test]
fn a_narrow_beginning_is_no_different() {
    // From the start to 1, between 1 and 2 as often as one likes, then through a thicket to the end: forwards, by
    // another program.
    const END: u32 = 23;
    let points: Vec<Point3<f64>> = (0..=END).map(|i| Point3::new(f64::from(i), 0.0, 0.0)).collect();
    let thicket = 3..=END;
    let mut pairs = vec![(0, 1), (1, 2), (2, 1)];
    pairs.extend(thicket.clone().map(|to| (2, to)));
    pairs.extend(thicket.flat_map(|from| (3..=END).filter(move |to| *to != from).map(move |to| (from, to))));
    let features = LegFeatures::default();
    let legs: Vec<(u32, Leg<u32>)> =
        pairs.iter().map(|&(from, to)| (from, Leg { to, waypoint: to, duration: 1.0, features })).collect();
    for length in 4..12 {
        let graph = LegGraph::from_legs(0, &points, &legs, length);
        for (seed, aggregate) in (0..20).flat_map(|seed| [(seed, Aggregate::Sum), (seed, Aggregate::Max)]) {
            let mut best = vec![None; points.len()];
            best[0] = Some(aggregate.neutral());
            for _ in 1..length {
                let mut next = vec![None; points.len()];
                for &(from, to) in &pairs {
                    let Some(so_far) = best[from as usize] else { continue };
                    let value = aggregate.add(so_far, hashed_unit(seed, &[from.into(), to.into()]));
                    let here = &mut next[to as usize];
                    *here = Some(here.map_or(value, |old: f64| old.max(value)));
                }
                best = next;
            }
            let settings = ExactSettings { length, aggregate, revisits: true, ..Default::default() };
            let outcome = exact(&graph, &Score::Random { seed }, &settings);
            let expected = best[END as usize].expect("a way");
            assert!(outcome.proven == 1 && close(outcome.found[0].score, expected), "{length} {seed} {aggregate:?}");
        }
    }
}
