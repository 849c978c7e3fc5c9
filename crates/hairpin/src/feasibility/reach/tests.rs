//! Every kernel of the reach sets at the widest level of this machine, against the version that all machines have: to
//! the bit.

use nalgebra::{Point3, Vector3};
use rand::RngExt;

use super::cloud::{Cloud, Farthest, Plane};
use super::features::{LANES, eight_features};
use super::graph::{Graph, WORD};
use super::refusal::refusal_order;
use super::sampling::{constant_speeds, end_points, steps};
use super::{Hull, HullSettings, Leg, Polytope, Reach, StepNode, StepReach, StepSettings};
use crate::math::random::{Stream, named_seed, stream};
use crate::math::simd::Simd;
use crate::robot::quadrotor::{Quadrotor, QuadrotorDescription};

fn shipped() -> [Quadrotor; 3] {
    [
        include_str!("../../../../../data/robots/quadrotor/flightgoggles.toml"),
        include_str!("../../../../../data/robots/quadrotor/anafi.toml"),
        include_str!("../../../../../data/robots/quadrotor/crazyflie.toml"),
    ]
    .map(|text| toml::from_str::<QuadrotorDescription>(text).expect("a robot file").build().expect("a robot"))
}

/// What `answer` gives at both levels, which must be one.
fn same<T: PartialEq + std::fmt::Debug>(what: &str, answer: impl Fn(Simd) -> T) -> T {
    let (widest, portable) = (answer(Simd::Widest), answer(Simd::Portable));
    assert!(widest == portable, "{what} at {}: {widest:?}, not {portable:?}", Simd::Widest.level());
    portable
}

/// To the bit: 0 is not −0, and NaN is NaN.
fn bits(points: &[Vector3<f64>]) -> Vec<[u64; 3]> {
    points.iter().map(|p| [p.x, p.y, p.z].map(f64::to_bits)).collect()
}

fn points(random: &mut Stream, count: usize, size: f64) -> Vec<Vector3<f64>> {
    (0..count).map(|_| Vector3::from_fn(|_, _| random.random_range(-size..size))).collect()
}

fn planes(random: &mut Stream, count: usize) -> Vec<Plane> {
    let normals = points(random, count, 1.0).into_iter().map(|v| v.normalize());
    normals.map(|n| [n.x, n.y, n.z, random.random_range(0.0..1.0)]).collect()
}

#[test]
fn runs_end_at_the_same_bits() {
    for robot in shipped() {
        for (resolution, time) in [(3, 1.0), (5, 0.3)] {
            let speeds = constant_speeds(&robot, resolution);
            let ends = |simd| bits(&end_points(simd, &robot, &speeds, time, steps(&robot, time)));
            assert_eq!(same(&robot.name, ends).len(), speeds.len());
        }
    }
}

#[test]
fn scans_of_clouds_give_the_same_bits() {
    for seed in 0..20 {
        let mut random = stream(named_seed(seed, "levels: cloud", 0));
        let size = 10f64.powi(random.random_range(-3..4));
        let count = random.random_range(1..300);
        let all = points(&mut random, count, size);
        let planes = planes(&mut random, 40);
        let cloud = |simd| Cloud::new(simd, &all, (0..count as u32).collect());
        let farthest = same("farthest", |simd| {
            let mut found = Vec::new();
            cloud(simd).farthest(&planes, 0.0, &mut found);
            found.iter().map(|Farthest { distance, point }| (distance.to_bits(), *point)).collect::<Vec<_>>()
        });
        let spans = same("spans", |simd| {
            let spans = cloud(simd).spans(&planes);
            spans.iter().map(|(low, high)| [low.to_bits(), high.to_bits()]).collect::<Vec<_>>()
        });
        assert_eq!((farthest.len(), spans.len()), (planes.len(), planes.len()), "seed {seed}");
        same("outside", |simd| cloud(simd).outside(&planes, 0.1 * size));
    }
}

#[test]
fn half_spaces_are_ordered_and_asked_equally() {
    for seed in 0..20 {
        let mut random = stream(named_seed(seed, "levels: polytope", 0));
        let planes = planes(&mut random, 60);
        let (min, max) = (Vector3::repeat(-2.0), Vector3::repeat(2.0));
        let order = same("refusal order", |simd| refusal_order(simd, &planes, &min, &max));
        assert_eq!(order.len(), planes.len());

        let given = points(&mut random, 100, 5.0);
        let polytope = same("polytope", |simd| Polytope::hull(simd, &given).expect("a hull"));
        let asked = points(&mut random, 512, 6.0);
        let from = asked[0] * 0.1;
        let kept = same("selection", |simd| {
            let mut bits = vec![u64::MAX; asked.len().div_ceil(64)];
            polytope.select(simd, &from, &asked, &mut bits);
            bits
        });
        let inside = asked.iter().enumerate().filter(|(i, _)| kept[i / 64] >> (i % 64) & 1 == 1).count();
        assert!(inside > 10 && inside < asked.len(), "seed {seed}: {inside}");
    }
}

#[test]
fn whole_hulls_are_the_same() {
    for robot in shipped() {
        let hull = |simd| Hull::new(&robot, &HullSettings { simd, ..HullSettings::default() });
        let vertices = same(&robot.name, |simd| hull(simd).map(|hull| bits(hull.polytope().vertices())));
        let planes = same(&robot.name, |simd| hull(simd).map(|hull| hull.polytope().planes().collect::<Vec<_>>()));
        assert!(vertices.is_ok_and(|v| v.len() > 3) && planes.is_ok_and(|p| p.len() > 3), "{}", robot.name);
    }
}

#[test]
fn waypoints_are_found_and_legs_measured_equally() {
    for seed in 0..20 {
        let mut random = stream(named_seed(seed, "levels: legs", 0));
        let all: Vec<Point3<f64>> = points(&mut random, 300, 20.0).into_iter().map(Point3::from).collect();
        let graph = Graph::new(&all);
        let (min, max) = (Vector3::new(-9.0, -12.0, -3.0), Vector3::new(8.0, 9.0, 14.0));
        let near = same("box", |simd| {
            let mut bits = vec![0; graph.words()];
            graph.near_box(simd, &min, &max, 0, &mut bits);
            bits
        });
        assert_eq!(near.len(), all.len().div_ceil(WORD));
        assert!(near.iter().any(|word| *word != 0), "seed {seed}");

        let before = all[0].coords;
        let legs = [0, 1, 2].map(|axis| std::array::from_fn::<f64, LANES, _>(|lane| all[lane][axis]));
        same("legs", |simd| {
            let numbers = eight_features(simd, &before, &legs, 0.7);
            numbers.map(|f| [f.v_in, f.v_out, f.turn, f.length, f.climb, f.slope_in].map(f64::to_bits))
        });
    }
}

/// Also of waypoints that no leg leads to, and by way of what they were not entered from.
#[test]
fn one_leg_is_that_of_all() {
    let hull = Hull::new(&shipped()[0], &HullSettings::default()).unwrap();
    let (mut found, mut none) = (0, 0);
    for seed in 0..5 {
        let mut random = stream(named_seed(seed, "one leg", 0));
        let all: Vec<Point3<f64>> = points(&mut random, 150, 12.0).into_iter().map(Point3::from).collect();
        let reach = StepReach::new(&hull, &all, StepSettings { max_speed: 12.0, ..StepSettings::default() });
        for (previous, current) in [(0, 0), (0, 70), (149, 3), (64, 63)] {
            let from = StepNode { previous, current };
            let mut legs: Vec<Leg<StepNode>> = Vec::new();
            reach.legs(&from, &all, &mut legs);
            for next in 0..150 {
                let to = StepNode { previous: current, current: next };
                let leg = legs.iter().find(|leg| leg.to == to);
                assert_eq!(reach.leg(&from, &to, &all).as_ref(), leg, "seed {seed}, {from:?} to {next}");
                (found, none) = (found + usize::from(leg.is_some()), none + usize::from(leg.is_none()));
            }
            assert_eq!(reach.leg(&from, &StepNode { previous: current + 1, current: 5 }, &all), None);
        }
    }
    assert!(found > 50 && none > 50, "{found} legs, {none} none");
}
