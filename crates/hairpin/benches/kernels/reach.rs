//! Reach sets: end points of 625 runs, their hull, and expansions on a graph of 252 waypoints.

use divan::{Bencher, black_box};
use hairpin::feasibility::reach::{
    Hull, HullSettings, Leg, Polytope, Reach, StepNode, StepReach, StepSettings, sampling,
};
use hairpin::math::random::{named_seed, stream};
use hairpin::math::simd::Simd;
use hairpin::robot::quadrotor::{Quadrotor, QuadrotorDescription};
use nalgebra::Point3;
use rand::RngExt;

fn shipped(name: &str) -> Quadrotor {
    let path = format!("{}/../../data/robots/quadrotor/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(path).expect("shipped robots are in data/robots/quadrotor");
    toml::from_str::<QuadrotorDescription>(&text).expect("a robot").build().expect("a robot")
}

fn graph() -> Vec<Point3<f64>> {
    let mut rng = stream(named_seed(1, "bench graph", 0));
    let mut points = vec![Point3::new(10.0, 10.0, 10.0)];
    points.extend((0..250).map(|_| Point3::from([0; 3].map(|_| rng.random_range(0.0..30.0)))));
    points.push(Point3::new(20.0, 20.0, 20.0));
    points
}

#[divan::bench(args = ["flightgoggles", "anafi", "anafi-real", "crazyflie", "paper-flightgoggles", "x500", "iris"])]
fn end_points_of_625_runs(bencher: Bencher, name: &str) {
    let robot = shipped(name);
    let speeds = sampling::constant_speeds(&robot, 5);
    bencher
        .bench(|| sampling::end_points(Simd::default(), black_box(&robot), &speeds, 1.0, sampling::steps(&robot, 1.0)));
}

#[divan::bench(args = ["flightgoggles", "anafi", "anafi-real", "crazyflie", "paper-flightgoggles", "x500", "iris"])]
fn hull_of_625_points(bencher: Bencher, name: &str) {
    let hull = Hull::new(&shipped(name), &HullSettings::default()).expect("a hull");
    bencher.bench(|| Polytope::hull(Simd::default(), black_box(hull.samples())));
}

/// Every feasible (previous, current) pair of the graph, expanded once.
fn pairs(reach: &StepReach<Hull>) -> Vec<StepNode> {
    let n = reach.len() as u32;
    let mut nodes = Vec::new();
    let mut next = Vec::new();
    for previous in 0..n {
        next.clear();
        reach.successors(previous, previous, &mut next);
        nodes.extend(next.iter().map(|&current| StepNode { previous, current }));
    }
    nodes
}

#[divan::bench]
fn every_feasible_node_expanded(bencher: Bencher) {
    let hull = Hull::new(&shipped("flightgoggles"), &HullSettings::default()).expect("a hull");
    let points = graph();
    let reach = StepReach::new(&hull, &points, StepSettings::default());
    let nodes: Vec<StepNode> = pairs(&reach);
    let mut legs: Vec<Leg<StepNode>> = Vec::new();
    bencher.counter(divan::counter::ItemsCount::new(nodes.len())).bench_local(|| {
        let mut found = 0;
        for node in &nodes {
            legs.clear();
            reach.legs(black_box(node), &points, &mut legs);
            found += legs.len();
        }
        found
    });
}

#[divan::bench]
fn all_triples_of_252_waypoints(bencher: Bencher) {
    let hull = Hull::new(&shipped("flightgoggles"), &HullSettings::default()).expect("a hull");
    let points = graph();
    let reach = StepReach::new(&hull, &points, StepSettings::default());
    let mut next = Vec::new();
    bencher.bench_local(|| {
        let mut triples = 0;
        for previous in 0..points.len() as u32 {
            for current in 0..points.len() as u32 {
                next.clear();
                reach.successors(previous, current, &mut next);
                triples += next.len();
            }
        }
        triples
    });
}
