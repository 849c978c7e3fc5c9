use nalgebra::{Point3, Vector3};

use super::*;
use crate::feasibility::reach::StepNode;
use crate::search::graph::LegGraph;
use crate::search::objective::Aggregate;
use crate::search::score::Score;
use crate::search::small::{Octahedron, START, enumerate, points};
use crate::search::task::{Found, Task};

pub(super) const SMALL: Octahedron = Octahedron::WIDE;
pub(super) const LENGTH: usize = 6;

/// A stress that no leg alone tells: how sharply two long legs meet, largest over the trajectory.
fn hidden(points: &[Point3<f64>], waypoints: &[u32]) -> Trial {
    let leg = |k: usize| points[waypoints[k + 1] as usize] - points[waypoints[k] as usize];
    let mut trial = Trial { stress: 0.0, fails: false, worst_leg: 0, executions: 1 };
    for k in 1..waypoints.len() - 1 {
        let (before, after) = (leg(k - 1), leg(k));
        let stress = before.norm() * after.norm() - before.dot(&after);
        if stress > trial.stress {
            trial = Trial { stress, fails: false, worst_leg: k, executions: 1 };
        }
    }
    trial
}

/// Some of all trajectories, as a search would hand them over.
fn first(all: &[(Vec<u32>, f64)]) -> Vec<Found<StepNode>> {
    let node = |pair: &[u32]| StepNode { previous: pair[0], current: pair[1] };
    let found = |waypoints: &[u32]| Found {
        waypoints: waypoints.to_vec(),
        nodes: std::iter::once(START).chain(waypoints.windows(2).map(node)).collect(),
        leg_times: vec![1.0; waypoints.len() - 1],
        score: 0.0,
    };
    all.iter().step_by((all.len() / 4).max(1)).map(|(waypoints, _)| found(waypoints)).collect()
}

#[test]
fn the_most_stressful_is_found_and_every_child_is_feasible() {
    let (mut tested, mut reached) = (0, 0);
    for seed in 0..40 {
        let points = points(seed, 11, 11.0);
        let task = Task { start: START, candidates: &points, reach: &SMALL };
        let all = enumerate(&task, &Score::Random { seed }, (LENGTH, false, Aggregate::Sum));
        if !(20..2_000).contains(&all.len()) {
            continue;
        }
        let graph = LegGraph::explore(START, &points, &SMALL, LENGTH);
        let most = all.iter().map(|(waypoints, _)| hidden(&points, waypoints).stress).fold(0.0, f64::max);
        let executions = all.len() as u64;
        let settings = EvolveSettings { length: LENGTH, executions, ..EvolveSettings::default() };
        let mut executed = Vec::new();
        let mut run = |found: &Found<StepNode>, _: Rank| {
            executed.push(found.waypoints.clone());
            Some(hidden(&points, &found.waypoints))
        };
        let evolved = evolve(&graph, &first(&all), seed, &settings, &mut run);
        for waypoints in &executed {
            assert!(all.iter().any(|(known, _)| known == waypoints), "seed {seed}: {waypoints:?} is not feasible");
        }
        let count = executed.len();
        executed.sort();
        executed.dedup();
        assert_eq!(executed.len(), count, "seed {seed}: executed twice");
        assert!(count as u64 <= settings.executions && evolved.best_so_far.len() == count);
        assert!(evolved.best_so_far.is_sorted() && evolved.pool.is_sorted_by(|a, b| a.found.score >= b.found.score));
        assert_eq!(evolved.pool[0].found.score, evolved.best_so_far[count - 1]);
        let again = evolve(&graph, &first(&all), seed, &settings, |found, _| Some(hidden(&points, &found.waypoints)));
        assert_eq!(again, evolved, "seed {seed}");
        tested += 1;
        reached += usize::from(evolved.pool[0].found.score >= most);
    }
    // With as many executions as there are trajectories next to all of them are met.
    assert!(tested >= 8 && 10 * reached >= 9 * tested, "{reached} of {tested}");
}

#[test]
fn what_fails_is_kept_before_what_is_stressed_more() {
    let points = points(3, 11, 11.0);
    let task = Task { start: START, candidates: &points, reach: &SMALL };
    let all = enumerate(&task, &Score::Random { seed: 3 }, (LENGTH, false, Aggregate::Sum));
    let graph = LegGraph::explore(START, &points, &SMALL, LENGTH);
    // Those through one waypoint crash, a hundred times less stressed until then.
    let crash = all[0].0[1];
    let execute = |found: &Found<StepNode>, _: Rank| {
        let trial = hidden(&points, &found.waypoints);
        let fails = found.waypoints.contains(&crash);
        Some(Trial { stress: if fails { 0.01 * trial.stress } else { trial.stress }, fails, ..trial })
    };
    let settings = EvolveSettings { length: LENGTH, executions: all.len() as u64, ..EvolveSettings::default() };
    let evolved = evolve(&graph, &first(&all), 3, &settings, execute);
    let [best, other, ..] = &evolved.pool[..] else { panic!("{:?}", evolved.pool) };
    assert!(best.trial.fails && other.trial.fails && best.trial.stress >= other.trial.stress);
    let largest = evolved.best_so_far.last().expect("executed");
    assert!(evolved.best_so_far.is_sorted() && *largest > best.trial.stress, "the curve is of stress");

    // A wall at y > 1, met before anything is strained.
    let line = [0.0, 1.0, 2.0, 3.0].map(|x| Point3::new(x, 0.0, 0.0));
    let settings = ShiftSettings { executions: 200, per_trial: 1, step: 0.3, largest: 0.6, free_end: false };
    let walled = |y: f64| {
        let fails = y > 1.0;
        Trial { stress: if fails { 0.1 * (2.0 - y) } else { y }, fails, worst_leg: 1, executions: 1 }
    };
    let within = |moved: &[Point3<f64>]| moved.iter().all(|p| p.y.abs() <= 2.0).then(|| moved[1].y);
    let shifted = shift(&line, walled(0.0), 1, &settings, within, |y, _| Some(walled(*y)));
    assert!(shifted.trial.fails && shifted.best_so_far.is_sorted(), "{:?}", shifted.trial);
    assert!(shifted.trial.stress > 0.09 && shifted.best_so_far[199] > 0.5, "{:?}", shifted.trial);
    let climbed = climb(&[0.0], walled(0.0), 1, [200, 1], |_| {}, |x, _| Some(walled(2.0 * x[0])));
    assert!(climbed.trial.fails && climbed.best_so_far.is_sorted() && climbed.best_so_far[199] > 0.5);
}

#[test]
fn a_small_graph_is_used_up_and_failures_count() {
    let points = points(3, 4, 9.0);
    let task = Task { start: START, candidates: &points, reach: &SMALL };
    let all = enumerate(&task, &Score::Random { seed: 0 }, (4, false, Aggregate::Sum));
    assert!((2..40).contains(&all.len()), "{}", all.len());
    let graph = LegGraph::explore(START, &points, &SMALL, 4);
    let settings = EvolveSettings { length: 4, executions: 1_000, ..EvolveSettings::default() };
    let evolved = evolve(&graph, &[], 5, &settings, |found, _| Some(hidden(&points, &found.waypoints)));
    assert_eq!(evolved.best_so_far.len(), all.len(), "each once, and then an end");
    let failed = evolve(&graph, &[], 5, &settings, |_: &Found<StepNode>, _| None);
    assert!(failed.pool.is_empty() && failed.best_so_far.len() <= all.len());
}

#[test]
fn waypoints_move_to_the_edge_of_what_is_feasible_and_never_beyond() {
    let points = [0.0, 1.0, 2.0, 3.0].map(|x| Point3::new(x, 0.0, 0.0));
    let settings = ShiftSettings { executions: 400, per_trial: 1, step: 0.3, largest: 0.6, free_end: false };
    let feasible = |moved: &[Point3<f64>]| {
        assert_eq!((moved[0], moved[3]), (points[0], points[3]), "ends stay");
        moved.iter().all(|p| p.y.abs() <= 2.0 && p.z.abs() <= 1.0).then(|| moved.to_vec())
    };
    let execute = |plan: &Vec<Point3<f64>>, _: Rank| {
        Some(Trial { stress: plan[1].y + plan[2].z, fails: false, worst_leg: 1, executions: 1 })
    };
    let trial = Trial { stress: 0.0, fails: false, worst_leg: 1, executions: 1 };
    let shifted = shift(&points, trial, 1, &settings, feasible, execute);
    assert!(shifted.trial.stress > 2.9 && shifted.trial.stress <= 3.0, "{}", shifted.trial.stress);
    assert_eq!(shifted.best_so_far.len(), 400);
    let stuck = shift(&points, trial, 1, &settings, |_| None::<()>, |(), _| None);
    assert!(stuck.plan.is_none() && stuck.best_so_far.is_empty());
    let far = Vector3::new(1.0, 1.0, 1.0);
    let free = ShiftSettings { executions: 50, per_trial: 1, step: 0.3, largest: 0.6, free_end: true };
    let moved = shift(
        &points,
        trial,
        2,
        &free,
        |p| Some(p[3]),
        |end, _| Some(Trial { stress: end.coords.dot(&far), fails: false, worst_leg: 2, executions: 1 }),
    );
    assert!(moved.trial.stress > 3.0);
}

#[test]
fn what_is_confirmed_counts_within_the_budget_and_luck_is_let_go_of() {
    let points = points(3, 11, 11.0);
    let everywhere = Octahedron { centre: Vector3::zeros(), half: Vector3::repeat(1e9) };
    let graph = LegGraph::explore(START, &points, &everywhere, LENGTH);
    // Every second trajectory is ten times as stressful at first, and not at all under noise.
    let lucky = |found: &Found<StepNode>| found.waypoints.iter().sum::<u32>() % 2 == 0;
    let settings = EvolveSettings { length: LENGTH, executions: 100, per_trial: 3, pool: 4, ..Default::default() };
    let (mut executed, mut confirmed) = (0, 0);
    let evolved = evolve(&graph, &[], 2, &settings, |found, least| {
        let lasting = hidden(&points, &found.waypoints);
        let first = if lucky(found) { 10.0 * lasting.stress } else { lasting.stress };
        let again = first >= least.stress;
        let trial = Trial { stress: if again { lasting.stress / 2.0 } else { first }, ..lasting };
        executed += if again { 3 } else { 1 };
        confirmed += u64::from(again);
        Some(Trial { executions: if again { 3 } else { 1 }, ..trial })
    });
    assert!(executed <= 100 && executed > 97 && confirmed > 4, "{executed}");
    assert_eq!(evolved.best_so_far.len(), executed);
    for tested in &evolved.pool {
        assert_eq!(tested.trial.stress, hidden(&points, &tested.found.waypoints).stress / 2.0);
    }
    let settings = ShiftSettings { executions: 50, per_trial: 3, step: 0.3, largest: 0.6, free_end: false };
    let mut executed = 0;
    let start = Trial { stress: points[1].x, fails: false, worst_leg: 1, executions: 1 };
    let moved = shift(
        &points[..4],
        start,
        1,
        &settings,
        |p| Some(p[1].x),
        |&x, least| {
            let executions = if x >= least.stress { 3 } else { 1 };
            executed += executions;
            Some(Trial { stress: x, fails: false, worst_leg: 1, executions })
        },
    );
    assert!(executed <= 50 && executed > 47 && moved.trial.stress > points[1].x);
    assert_eq!(moved.best_so_far.len() as u64, executed);
}

#[test]
fn legs_are_found_again_by_their_nodes() {
    let mut tested = 0;
    for seed in 0..10 {
        let points = points(seed, 8, 11.0);
        let task = Task { start: START, candidates: &points, reach: &SMALL };
        let all = enumerate(&task, &Score::Random { seed }, (LENGTH, false, Aggregate::Sum));
        let graph = LegGraph::explore(START, &points, &SMALL, LENGTH);
        for found in first(&all) {
            let legs = graph.legs_along(&found.nodes).expect("its own legs");
            let mut from = 0;
            for (&leg, &waypoint) in legs.iter().zip(&found.waypoints[1..]) {
                assert_eq!(graph.source(leg), from);
                from = graph.target(leg as usize);
                assert_eq!(graph.waypoint(from), waypoint);
            }
            assert!(graph.at_end(from));
            tested += 1;
        }
    }
    assert!(tested > 10, "{tested}");
}
