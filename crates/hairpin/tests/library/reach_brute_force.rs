//! Reach by brute force means what it says: the constant polytope where that holds, and plain simulation where not.

use hairpin::feasibility::reach::{
    BruteForce, BruteForceSettings, CarriedNode, Hull, HullSettings, NoHull, Polytope, Reach, StepReach, StepSet,
    StepSettings, sampling,
};
use hairpin::math::random::{Stream, named_seed, stream};
use hairpin::math::simd::Simd;
use hairpin::robot::quadrotor::{Quadrotor, QuadrotorDescription, QuadrotorState, level_rest};
use nalgebra::{Point3, UnitQuaternion, Vector3};
use rand::RngExt;

fn shipped(name: &str) -> Quadrotor {
    let path = format!("{}/../../data/robots/quadrotor/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(&path).expect("shipped robots are in data/robots/quadrotor");
    toml::from_str::<QuadrotorDescription>(&text).expect(name).build().expect(name)
}

fn random_points(rng: &mut Stream, count: usize, size: f64) -> Vec<Point3<f64>> {
    (0..count).map(|_| Point3::from([0; 3].map(|_| rng.random_range(0.0..size)))).collect()
}

/// Every velocity its own hull, and cells so fine that their middle is as good as the state.
fn settings(resolution: usize) -> BruteForceSettings {
    BruteForceSettings {
        hull: HullSettings { resolution, ..HullSettings::default() },
        velocity_bin: 0.0,
        attitude_bin: 1e-6,
        rate_bin: 1e-5,
        ..BruteForceSettings::default()
    }
}

/// The identity itself: the constant polytope against all runs simulated from the node's own velocity.
#[test]
fn the_constant_polytope_and_brute_force_agree() {
    let robot =
        Quadrotor { drag_linear: 0.1, drag_quadratic: 0.0, aerodynamic_moment: 0.0, ..shipped("flightgoggles") };
    let hull = Hull::new(&robot, &HullSettings { resolution: 3, ..HullSettings::default() }).expect("a hull");
    // Full drag with no quadratic term: every velocity gets its own simulated hull.
    let brute = BruteForce::new(&robot, BruteForceSettings { full_drag: true, ..settings(3) }).expect("settings");
    let mut rng = stream(named_seed(6, "brute force", 0));
    let points = random_points(&mut rng, 200, 16.0);
    let reach = StepReach::new(&hull, &points, StepSettings::default());
    let (mut ours, mut theirs, mut found) = (Vec::new(), Vec::new(), 0);
    for case in 0..12 {
        let (previous, current) = (rng.random_range(0..200u32), rng.random_range(0..200u32));
        ours.clear();
        theirs.clear();
        reach.successors(previous, current, &mut ours);
        brute.legs(&CarriedNode { previous, current, carried: [0; 6] }, &points, &mut theirs);
        // A point within the integrators' disagreement of a facet may fall on either side.
        let carry = StepSet::carry(&hull);
        let near = |i: u32| {
            let [w0, w1, w2] = [previous, current, i].map(|k| points[k as usize]);
            let d = (w2 - w1) - (w1 - w0) * carry;
            hull.polytope().planes().any(|(n, b)| (n.dot(&d) - b).abs() < 0.005)
        };
        for i in 0..200 {
            assert!(ours.contains(&i) == theirs.iter().any(|leg| leg.waypoint == i) || near(i), "case {case}, {i}");
        }
        found += ours.len();
    }
    assert!(found > 5, "{found}: too few legs to tell");
}

/// Ends of the runs of one second from a state, by the midpoint rule in small steps.
fn plain(model: &Quadrotor, start: &QuadrotorState) -> Vec<QuadrotorState> {
    let steps = 20_000;
    let h = 1.0 / steps as f64;
    let run = |speeds: &_| {
        let mut x = *start;
        for _ in 0..steps {
            let half = x + model.derivative(&x, speeds) * (h / 2.0);
            x += model.derivative(&half, speeds) * h;
            let size = x.fixed_rows::<4>(3).norm();
            x.fixed_rows_mut::<4>(3).unscale_mut(size);
        }
        x
    };
    sampling::constant_speeds(model, 2).iter().map(run).collect()
}

fn place(state: &QuadrotorState) -> Vector3<f64> {
    state.fixed_rows::<3>(0).into_owned()
}

fn entering(velocity: Vector3<f64>, attitude: UnitQuaternion<f64>, rates: Vector3<f64>) -> QuadrotorState {
    let mut start = level_rest();
    start.fixed_rows_mut::<4>(3).copy_from_slice(&[attitude.w, attitude.i, attitude.j, attitude.k]);
    start.fixed_rows_mut::<3>(7).copy_from(&velocity);
    start.fixed_rows_mut::<3>(10).copy_from(&rates);
    start
}

/// The legs from `node` are those into the hull of plain runs from its state; returns these runs' ends.
fn legs_are_plain(brute: &BruteForce, model: &Quadrotor, points: &[Point3<f64>], node: CarriedNode) -> usize {
    let [w0, w1] = [node.previous, node.current].map(|i| points[i as usize]);
    let (attitude, rates) = brute.carried_state(&node.carried);
    let ends = plain(model, &entering(w1 - w0, attitude, rates));
    let hull = Polytope::hull(Simd::default(), &ends.iter().map(place).collect::<Vec<_>>()).expect("a hull");
    let mut legs = Vec::new();
    brute.legs(&node, points, &mut legs);
    for i in (0..points.len() as u32).filter(|i| *i != node.current) {
        let d = points[i as usize] - w1;
        let near = hull.planes().any(|(n, b)| (n.dot(&d) - b).abs() < 1e-3);
        assert!(near || hull.contains(&d) == legs.iter().any(|leg| leg.waypoint == i), "{node:?} to {i}");
    }
    // What is carried on is the attitude and the rates of the run that ended nearest.
    for leg in &legs {
        let d = points[leg.waypoint as usize] - w1;
        let (attitude, rates) = brute.carried_state(&leg.to.carried);
        let least = ends.iter().map(|end| (place(end) - d).norm()).fold(f64::INFINITY, f64::min);
        let is_of = |end: &QuadrotorState| {
            let there = UnitQuaternion::new_normalize(nalgebra::Quaternion::new(end[3], end[4], end[5], end[6]));
            let same = rates == Vector3::zeros() || (end.fixed_rows::<3>(10) - rates).norm() < 1e-2;
            let level = attitude == UnitQuaternion::identity() || there.angle_to(&attitude) < 1e-2;
            (place(end) - d).norm() < least + 1e-3 && same && level
        };
        assert!(ends.iter().any(is_of), "{node:?} to {}: carries what no run has", leg.waypoint);
    }
    legs.len()
}

#[test]
fn full_drag_and_what_is_carried_are_those_of_plain_simulation() {
    // Slow to turn, so that plain steps are good, and hovering amid its speeds, so that it stays among the waypoints.
    let robot = shipped("flightgoggles");
    let inertia = robot.inertia * 10.0;
    let dragged = Quadrotor { inertia, rotor_speed: (800.0, 1500.0), drag_quadratic: 0.1, ..robot };
    let bare = Quadrotor { drag_quadratic: 0.0, aerodynamic_moment: 0.0, ..dragged.clone() };
    for (keep_attitude, keep_rates, full_drag) in
        [(false, false, true), (false, true, false), (true, false, false), (true, true, true)]
    {
        let what = BruteForceSettings { keep_attitude, keep_rates, full_drag, ..settings(2) };
        let brute = BruteForce::new(&dragged, what).expect("settings");
        let model = if full_drag { &dragged } else { &bare };
        let mut points = random_points(&mut stream(named_seed(7, "kept", 0)), 200, 5.0);
        points[0] = Point3::new(2.5, 2.5, 2.5);
        let start = CarriedNode { previous: 0, current: 0, carried: [0; 6] };
        let mut legs = Vec::new();
        brute.legs(&start, &points, &mut legs);
        assert!(legs.iter().any(|leg| leg.to.carried != [0; 6]) == (keep_attitude || keep_rates));
        assert!(keep_rates || legs.iter().all(|leg| leg.to.carried[3..] == [0; 3]));
        assert!(keep_attitude || legs.iter().all(|leg| leg.to.carried[..3] == [0; 3]));
        let mut found = legs_are_plain(&brute, model, &points, start);
        for leg in legs.iter().step_by(4).take(3) {
            found += legs_are_plain(&brute, model, &points, leg.to);
        }
        assert!(found > 8, "{what:?}: {found} legs are too few to tell");
    }
}

#[test]
fn coarse_cells_bound_the_memory_and_change_nothing_when_forgotten() {
    let robot = shipped("flightgoggles");
    let carrying = BruteForceSettings { keep_attitude: true, keep_rates: true, ..settings(2) };
    let coarse = BruteForceSettings { attitude_bin: 0.5, rate_bin: 20.0, ..carrying };
    let cells = |settings| {
        let brute = BruteForce::new(&robot, settings).expect("settings");
        let points = random_points(&mut stream(named_seed(7, "cells", 0)), 60, 8.0);
        let mut layer = vec![CarriedNode { previous: 0, current: 0, carried: [0; 6] }];
        let mut all = Vec::new();
        for _ in 0..3 {
            let mut legs = Vec::new();
            for node in &layer {
                brute.legs(node, &points, &mut legs);
            }
            layer = legs.iter().map(|leg| leg.to).take(12).collect();
            all.extend(legs);
        }
        (all, brute.remembered())
    };
    let (all, remembered) = cells(coarse);
    let (again, few) = cells(BruteForceSettings { remembered: 2, ..coarse });
    assert!(all == again && remembered > 2 && (1..=2).contains(&few), "{remembered}, {few}");
}

#[test]
fn settings_out_of_bounds_are_refused() {
    let good = BruteForceSettings::default();
    let slow = StepSettings { max_speed: 0.0, ..good.step };
    let other_step = StepSettings { step: 0.5, ..good.step };
    let bad = [
        ("resolution", BruteForceSettings { hull: HullSettings { resolution: 1, ..HullSettings::default() }, ..good }),
        ("step_s", BruteForceSettings { hull: HullSettings { step: f64::NAN, ..HullSettings::default() }, ..good }),
        ("step_s", BruteForceSettings { step: other_step, ..good }),
        ("max_speed_m_s", BruteForceSettings { step: slow, ..good }),
        ("velocity_bin_m_s", BruteForceSettings { velocity_bin: -1.0, ..good }),
        ("attitude_bin_rad", BruteForceSettings { attitude_bin: 0.0, ..good }),
        ("rate_bin_rad_s", BruteForceSettings { rate_bin: f64::NAN, ..good }),
        ("remembered", BruteForceSettings { remembered: 0, ..good }),
    ];
    let robot = shipped("flightgoggles");
    assert!(BruteForce::new(&robot, good).is_ok());
    for (name, settings) in bad {
        let error = BruteForce::new(&robot, settings).err();
        assert!(matches!(error, Some(NoHull::Setting { field, .. }) if field == name), "{name}: {error:?}");
    }
}
