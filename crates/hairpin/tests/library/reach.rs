//! A reach set means what it says: its ends are those of the simulated model, its hull holds them, its legs are right.

use std::cell::{Cell, RefCell};

use hairpin::feasibility::reach::{
    Everywhere, Filtered, Hull, HullSettings, Leg, NoHull, PairMask, Reach, Sphere, StepNode, StepReach, StepSet,
    StepSettings, sampling,
};
use hairpin::math::random::{Stream, named_seed, stream};
use hairpin::math::simd::Simd;
use hairpin::robot::quadrotor::{Quadrotor, QuadrotorDescription};
use nalgebra::{Point3, Vector3};
use rand::RngExt;

fn shipped(name: &str) -> Quadrotor {
    let path = format!("{}/../../data/robots/quadrotor/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(&path).expect("shipped robots are in data/robots/quadrotor");
    toml::from_str::<QuadrotorDescription>(&text).expect(name).build().expect(name)
}

const SHIPPED: [&str; 7] = ["flightgoggles", "paper-flightgoggles", "anafi", "anafi-real", "crazyflie", "x500", "iris"];

fn random_points(rng: &mut Stream, count: usize, size: f64) -> Vec<Point3<f64>> {
    (0..count).map(|_| Point3::from([0; 3].map(|_| rng.random_range(0.0..size)))).collect()
}

fn farthest_apart(a: &[Vector3<f64>], b: &[Vector3<f64>]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max)
}

#[test]
fn half_and_a_tenth_of_the_step_move_no_end_by_5_mm() {
    for name in SHIPPED {
        let robot = shipped(name);
        for time in [0.5, 1.0] {
            let speeds = sampling::constant_speeds(&robot, 5);
            let steps = sampling::steps(&robot, time);
            let ends = |steps| sampling::end_points(Simd::default(), &robot, &speeds, time, steps);
            let (once, half, tenth) = (ends(steps), ends(2 * steps), ends(10 * steps));
            let (half, tenth) = (farthest_apart(&once, &half), farthest_apart(&once, &tenth));
            assert!(half < 0.005 && tenth < 0.005, "{name}, {time} s, {steps} steps: {half} m, {tenth} m");
        }
    }
}

#[test]
fn linear_drag_is_in_the_hull_and_the_self_check_sees_it() {
    let robot = Quadrotor { drag_linear: 0.3, ..shipped("flightgoggles") };
    let hull =
        Hull::new(&robot, &HullSettings::default()).expect("the self-check runs the full model with linear drag");
    assert!((StepSet::carry(&hull) - (1.0 - (-0.3f64).exp()) / 0.3).abs() < 1e-12);
    let speeds = sampling::constant_speeds(&robot, 5);
    let other = Quadrotor { drag_linear: 0.6, ..robot };
    assert!(matches!(hull.self_check(&other, &speeds), Err(NoHull::SelfCheck { .. })));
}

#[test]
fn hulls_hold_their_samples_and_no_more_than_their_hull() {
    for name in SHIPPED {
        let hull = Hull::new(&shipped(name), &HullSettings::default()).expect(name);
        let k = hull.polytope();
        assert!(hull.samples().iter().all(|sample| k.contains(sample)), "{name}");
        // Every facet touches the samples, and a point just beyond a facet is outside.
        for (normal, offset) in k.planes() {
            let reached = hull.samples().iter().map(|s| normal.dot(s)).fold(f64::NEG_INFINITY, f64::max);
            assert!((reached - offset).abs() < 1e-9 && (normal.norm() - 1.0).abs() < 1e-12, "{name}");
        }
        let extent = k.bounding_box();
        assert!(k.volume() > 0.0 && k.volume() < (extent.1 - extent.0).product());
        assert!(hull.farthest() >= k.vertices().iter().map(|v| v.norm()).fold(0.0, f64::max) - 1e-12);
    }
}

#[test]
fn successors_are_those_of_the_second_difference() {
    let hull = Hull::new(&shipped("flightgoggles"), &HullSettings::default()).expect("a hull");
    for seed in 0..5 {
        let points = random_points(&mut stream(named_seed(seed, "successors", 0)), 130, 25.0);
        let reach = StepReach::new(&hull, &points, StepSettings { max_speed: 9.0, ..StepSettings::default() });
        let mut legs: Vec<Leg<StepNode>> = Vec::new();
        let mut successors = Vec::new();
        let mut found = 0;
        for (previous, current) in (0..130).flat_map(|i| [(i, (i * 7 + 3) % 130), (i, i)]) {
            let [w0, w1] = [previous, current].map(|i: u32| points[i as usize]);
            let expected: Vec<u32> = (0..130)
                .filter(|&i| {
                    let w2 = points[i as usize];
                    i != current && (w2 - w1).norm() <= 9.0 && hull.contains(&((w2 - w1) - (w1 - w0)))
                })
                .collect();
            successors.clear();
            reach.successors(previous, current, &mut successors);
            assert_eq!(successors, expected, "seed {seed}");
            legs.clear();
            reach.legs(&StepNode { previous, current }, &points, &mut legs);
            assert!(legs.iter().map(|leg| leg.waypoint).eq(expected.iter().copied()));
            for leg in &legs {
                let there = points[leg.waypoint as usize];
                assert!(reach.feasible(&(w1 - w0), &(there - w1)));
                assert!((leg.features.v_out - (there - w1).norm()).abs() < 1e-12);
                assert!((leg.features.climb - (there.z - w1.z)).abs() < 1e-12);
                let slope_in = if previous == current { 0.0 } else { (w1.z - w0.z) / (w1 - w0).norm() };
                assert!((leg.features.slope_in - slope_in).abs() < 1e-12);
                let turn = if previous == current { 0.0 } else { (w1 - w0).angle(&(there - w1)) };
                assert!((leg.features.turn - turn).abs() < 1e-6);
            }
            found += legs.len();
        }
        assert!(found > 20, "seed {seed}: too few legs to tell");
    }
}

#[test]
fn none_and_sphere_and_filters() {
    let points = random_points(&mut stream(named_seed(9, "sphere", 0)), 70, 30.0);
    let node = StepNode { previous: 4, current: 11 };
    let mut legs = Vec::new();
    StepReach::new(&Everywhere, &points, StepSettings::default()).legs(&node, &points, &mut legs);
    assert!(legs.iter().map(|leg| leg.waypoint).eq((0..70).filter(|i| *i != 11)));
    legs.clear();
    let sphere = Sphere { radius: 14.0 };
    let reach = StepReach::new(&sphere, &points, StepSettings::default());
    reach.legs(&node, &points, &mut legs);
    let near: Vec<u32> = (0..70).filter(|&i| i != 11 && (points[i as usize] - points[11]).norm() <= 14.0).collect();
    assert!(legs.iter().map(|leg| leg.waypoint).eq(near.iter().copied()) && !near.is_empty());
    let mask = RefCell::new(PairMask::new(points.len()));
    let asked = Cell::new(0);
    let keep = |from: &StepNode, leg: &Leg<StepNode>| {
        let low = || {
            asked.set(asked.get() + 1);
            points[from.current as usize].z + points[leg.waypoint as usize].z < 30.0
        };
        mask.borrow_mut().allows(from.current, leg.waypoint, low)
    };
    let filtered = Filtered { inner: reach, keep };
    let mut kept = vec![legs[0]];
    filtered.legs(&node, &points, &mut kept);
    let (once, mut again) = (asked.get(), Vec::new());
    filtered.legs(&node, &points, &mut again);
    assert!(again == kept[1..] && once == near.len() && asked.get() == once, "every pair is judged once");
    let expected = near.iter().copied().filter(|&i| points[i as usize].z + points[11].z < 30.0);
    assert!(kept[1..].iter().map(|leg| leg.waypoint).eq(expected));
}

#[test]
fn what_can_be_reached_in_n_steps_passes_the_pruning_test() {
    for drag_linear in [0.0, 0.2] {
        let robot = Quadrotor { drag_linear, ..shipped("flightgoggles") };
        let hull = Hull::new(&robot, &HullSettings::default()).expect("a hull");
        let mut rng = stream(named_seed(4, "pruning", 0));
        let mut refused = 0;
        for case in 0..300 {
            let steps = rng.random_range(1..7u32);
            let start = Vector3::from_fn(|_, _| rng.random_range(0.0..30.0));
            let before = Vector3::from_fn(|_, _| rng.random_range(-4.0..4.0));
            let (mut at, mut leg) = (start, before);
            for _ in 0..steps {
                leg = leg * StepSet::carry(&hull) + hull.samples()[rng.random_range(0..hull.samples().len())] * 0.999;
                at += leg;
            }
            assert!(hull.may_reach(&start, &before, &at, steps), "case {case}");
            refused += usize::from(!hull.may_reach(&start, &before, &(at + Vector3::new(200.0, 0.0, 0.0)), steps));
        }
        assert!(refused > 200, "{refused}");
    }
}

#[test]
fn settings_out_of_bounds_are_refused() {
    let robot = shipped("flightgoggles");
    for (resolution, step) in [(1, 1.0), (13, 1.0), (5, 0.0), (5, f64::NAN), (5, 11.0)] {
        assert!(matches!(
            Hull::new(&robot, &HullSettings { resolution, step, ..HullSettings::default() }),
            Err(NoHull::Setting { .. })
        ));
    }
}
