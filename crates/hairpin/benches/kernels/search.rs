//! The kernels of the searches, for profiling, on the graphs of `hairpin bench`, which measures the promised figures
//! through the whole pipeline: `hull` of FlightGoggles, 250 waypoints, start (10, 10, 10), end (20, 20, 20), no speed
//! cap.

use std::cell::Cell;

use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use hairpin::feasibility::reach::{Hull, HullSettings, StepNode, StepReach, StepSettings};
use hairpin::math::random::{named_seed, stream};
use hairpin::robot::quadrotor::QuadrotorDescription;
use hairpin::search::graph::LegGraph;
use hairpin::search::uniform::Sampler;
use hairpin::search::{Aggregate, BeamOutcome, BeamSettings, ExactSettings, Score, Task, beam, exact};
use hairpin::world::{Sampling, World, sample_free};
use nalgebra::{Point3, Vector3};

const START: StepNode = StepNode { previous: 0, current: 0 };

fn flightgoggles() -> Hull {
    let path = format!("{}/../../data/robots/quadrotor/flightgoggles.toml", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(path).expect("shipped robots are in data/robots/quadrotor");
    let robot = toml::from_str::<QuadrotorDescription>(&text).expect("a robot").build().expect("a robot");
    Hull::new(&robot, &HullSettings::default()).expect("a hull")
}

fn points(graph: u64) -> Vec<Point3<f64>> {
    let world = World::new(Vector3::repeat(30.0), 0.0, Vec::new()).expect("an empty cage");
    let free = sample_free(&world, 250, 0.0, Sampling::Uniform, named_seed(1, "bench graph", graph));
    let mut points = vec![Point3::new(10.0, 10.0, 10.0)];
    points.extend(free.expect("all of it is free"));
    points.push(Point3::new(20.0, 20.0, 20.0));
    points
}

fn score(hull: &Hull) -> Score {
    Score::named("high-velocity-90", 0, hull.farthest() / hull.step()).expect("a score")
}

fn one_graph(hull: &Hull, graph: u64, settings: &BeamSettings) -> BeamOutcome<StepNode> {
    let points = points(graph);
    let reach = StepReach::new(hull, &points, StepSettings::default());
    let end = points[points.len() - 1].coords;
    let may_arrive = |node: &StepNode, steps: usize| {
        let (before, now) = (points[node.previous as usize], points[node.current as usize]);
        hull.may_reach(&now.coords, &(now - before), &end, steps as u32)
    };
    beam(&Task { start: START, candidates: &points, reach: &reach }, &score(hull), may_arrive, settings)
}

/// Distinct trajectories per second: items are trajectories, over 200 graphs a sample.
#[divan::bench(args = [(8, false), (10, false), (50, false), (50, true)], sample_count = 10, sample_size = 1)]
fn beam_trajectories(bencher: Bencher, (length, revisits): (usize, bool)) {
    let hull = flightgoggles();
    let settings = BeamSettings { length, revisits, ..Default::default() };
    let sweep = || (0..200).map(|graph| one_graph(&hull, graph, &settings).found.len()).sum::<usize>();
    bencher.counter(ItemsCount::new(sweep())).bench(sweep);
}

/// Expansions per second: items are partial trajectories expanded until the first completion, over 100 graphs a sample.
#[divan::bench(args = [false, true], sample_count = 10, sample_size = 1)]
fn beam_expansions_at_50(bencher: Bencher, revisits: bool) {
    let hull = flightgoggles();
    let settings = BeamSettings { length: 50, revisits, ..Default::default() };
    let sweep = || (0..100).map(|graph| one_graph(&hull, graph, &settings).expansions).sum::<u64>();
    bencher.counter(ItemsCount::new(sweep())).bench(sweep);
}

fn explored<'a>(hull: &Hull, points: &'a [Point3<f64>], length: usize) -> LegGraph<'a, StepNode> {
    let reach = StepReach::new(hull, points, StepSettings::default());
    LegGraph::explore(START, points, &reach, length)
}

/// All triples and the number of trajectories of every length to 50, per graph.
#[divan::bench]
fn exact_counts_to_50(bencher: Bencher) {
    let (hull, points) = (flightgoggles(), points(0));
    bencher.bench(|| explored(black_box(&hull), &points, 50).counts_by_length(50));
}

/// What the optimum costs on top, per graph.
#[divan::bench(args = [Aggregate::Sum, Aggregate::Max])]
fn exact_optimum_at_50(bencher: Bencher, aggregate: Aggregate) {
    let (hull, points) = (flightgoggles(), points(0));
    let graph = explored(&hull, &points, 50);
    let settings = ExactSettings { length: 50, revisits: true, aggregate, ..Default::default() };
    bencher.bench(|| exact(black_box(&graph), &score(&hull), &settings));
}

/// Best without revisits, per graph: proven at length 10, with its gap at 50.
#[divan::bench(args = [10, 50])]
fn exact_without_revisits(bencher: Bencher, length: usize) {
    let (hull, points) = (flightgoggles(), points(0));
    let graph = explored(&hull, &points, length);
    let settings = ExactSettings { length, ..Default::default() };
    bencher.bench(|| exact(black_box(&graph), &score(&hull), &settings));
}

/// Uniform samples per second: items are draws.
#[divan::bench(args = [10, 50])]
fn uniform_draws(bencher: Bencher, length: usize) {
    const DRAWS: usize = 10_000;
    let (hull, points) = (flightgoggles(), points(0));
    let graph = explored(&hull, &points, length);
    let sampler = Sampler::new(&graph, length).expect("a graph with trajectories");
    let (rng, legs) = (Cell::new(Some(stream(0))), Cell::new(Vec::new()));
    bencher.counter(ItemsCount::new(DRAWS)).bench_local(|| {
        let (mut generator, mut drawn) = (rng.take().expect("put back"), legs.take());
        for _ in 0..DRAWS {
            sampler.draw(&mut generator, &mut drawn);
            black_box(&drawn);
        }
        rng.set(Some(generator));
        legs.set(drawn);
    });
}
