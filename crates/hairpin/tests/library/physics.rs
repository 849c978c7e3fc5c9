//! The quadrotor's equations are the physics they claim: closed forms, conservation, signs, and another integrator.

use differential_equations::prelude::*;
use hairpin::math::integrate::rk4_step;
use hairpin::math::random::{named_seed, stream};
use hairpin::math::rotation;
use hairpin::robot::quadrotor::published::{angular_acceleration, euler_rates, thrust_direction};
use hairpin::robot::quadrotor::{
    EulerState, Quadrotor, QuadrotorDescription, QuadrotorState, from_euler_state, level_rest, to_euler_state,
};
use nalgebra::{Vector3, Vector4};
use rand::RngExt;

fn shipped(name: &str) -> Quadrotor {
    let path = format!("{}/../../data/robots/quadrotor/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(&path).expect("shipped robots are in data/robots/quadrotor");
    toml::from_str::<QuadrotorDescription>(&text).expect(name).build().expect(name)
}

const SHIPPED: [&str; 7] = ["flightgoggles", "paper-flightgoggles", "anafi", "anafi-real", "crazyflie", "x500", "iris"];

/// FlightGoggles without drag and aerodynamic moment: the body that closed forms speak of.
fn vacuum() -> Quadrotor {
    Quadrotor { drag_quadratic: 0.0, aerodynamic_moment: 0.0, ..shipped("flightgoggles") }
}

fn fly(robot: &Quadrotor, state: QuadrotorState, speeds: &Vector4<f64>, time: f64, steps: usize) -> QuadrotorState {
    let h = time / steps as f64;
    (0..steps).fold(state, |state, _| {
        let mut next = rk4_step(|x| robot.derivative(x, speeds), &state, h);
        robot.normalize(&mut next);
        next
    })
}

fn random_state(rng: &mut impl rand::Rng) -> QuadrotorState {
    QuadrotorState::from_fn(|i, _| rng.random_range(-2.0..2.0) * if (3..7).contains(&i) { 0.5 } else { 1.0 })
}

#[test]
fn every_shipped_robot_hovers() {
    for name in SHIPPED {
        let robot = shipped(name);
        let hover =
            robot.unmixing().expect("checked when built") * Vector4::new(robot.mass * robot.gravity, 0.0, 0.0, 0.0);
        let end = fly(&robot, level_rest(), &hover.map(f64::sqrt), 2.0, 200);
        assert!((end - level_rest()).norm() < 1e-6, "{name}: {end}");
        assert!(robot.max_thrust() > robot.mass * robot.gravity, "{name}");
    }
}

#[test]
fn free_fall_and_terminal_velocity() {
    let (robot, off) = (vacuum(), Vector4::zeros());
    let end = fly(&robot, level_rest(), &off, 1.5, 10);
    assert!(
        (end[2] + 0.5 * robot.gravity * 1.5f64.powi(2)).abs() < 1e-12 && (end[9] + 1.5 * robot.gravity).abs() < 1e-12
    );
    // With quadratic drag: v(t) = −v∞ tanh(g t/v∞), v∞ = √(m g/c).
    let robot = shipped("flightgoggles");
    let terminal = (robot.mass * robot.gravity / robot.drag_quadratic).sqrt();
    let end = fly(&robot, level_rest(), &off, 1.5, 300);
    assert!((end[9] + terminal * (robot.gravity * 1.5 / terminal).tanh()).abs() < 1e-9);
}

#[test]
fn a_constant_yaw_torque_turns_by_half_alpha_t_squared() {
    let robot = vacuum();
    // Rotors 1 and 3 (spin +1) faster: reaction +z, counter-clockwise seen from above.
    let speeds = Vector4::new(0.0, 400.0, 0.0, 400.0);
    let alpha = robot.moment_coefficient * 2.0 * 400f64.powi(2) / robot.inertia.z;
    let end = to_euler_state(&fly(&robot, level_rest(), &speeds, 0.4, 400));
    assert!((end[5] - 0.5 * alpha * 0.16).abs() < 1e-9 && (end[11] - alpha * 0.4).abs() < 1e-9, "{}", end[5]);
    assert!(end[3].abs() < 1e-12 && end[4].abs() < 1e-12 && alpha > 0.0);
}

#[test]
fn signs_are_those_of_a_forward_left_up_frame() {
    let robot = shipped("paper-flightgoggles");
    let hover = robot.hover_speed();
    let moved = |rotor: usize| {
        let mut speeds = Vector4::repeat(hover);
        speeds[rotor] *= 1.01;
        fly(&robot, level_rest(), &speeds, 0.1, 100)
    };
    // Pitch is positive nose down: the front rotor faster lifts the nose and drives the body backwards.
    let [front, left, back, right] = [0, 1, 2, 3].map(moved);
    let nose = rotation::unit_quaternion(&front.as_slice()[3..7]) * Vector3::x();
    assert!(nose.z > 0.0 && to_euler_state(&front)[4] < 0.0 && front[7] < 0.0);
    assert!(to_euler_state(&back)[4] > 0.0 && back[7] > 0.0);
    // The left rotor faster lifts the left side: positive roll, motion to the right (−y).
    assert!(to_euler_state(&left)[3] > 0.0 && left[8] < 0.0);
    assert!(to_euler_state(&right)[3] < 0.0 && right[8] > 0.0);
    // Clockwise rotors push the body counter-clockwise.
    assert!(front[12] > 0.0 && back[12] > 0.0 && left[12] < 0.0 && right[12] < 0.0);
}

#[test]
fn mixing_is_that_of_the_plus_and_x_formulas() {
    let plus = shipped("paper-flightgoggles");
    let x = shipped("flightgoggles");
    let w = Vector4::new(900.0, 1100.0, 700.0, 1300.0);
    let s = w.component_mul(&w);
    let (kf, km, d) = (plus.thrust_coefficient, plus.moment_coefficient, 0.16);
    let expected =
        Vector4::new(kf * s.sum(), d * kf * (s[1] - s[3]), d * kf * (s[2] - s[0]), km * (s[0] - s[1] + s[2] - s[3]));
    assert!((plus.wrench(&w) - expected).norm() < 1e-12);
    // FL, RL, RR, FR at (±l, ±l).
    let (l, kf) = (0.08, x.thrust_coefficient);
    let u = x.wrench(&w);
    assert!((u[1] - kf * l * (s[0] + s[1] - s[2] - s[3])).abs() < 1e-12);
    assert!((u[2] - kf * l * (-s[0] + s[1] + s[2] - s[3])).abs() < 1e-12);
    for name in SHIPPED {
        let robot = shipped(name);
        let back = robot.rotor_thrusts(&robot.wrench(&w)).expect("checked when built");
        assert!((back - s * robot.thrust_coefficient).norm() < 1e-9 * back.norm(), "{name}");
    }
}

#[test]
fn without_torque_angular_momentum_and_energy_stay() {
    let robot = Quadrotor { gravity: 9.81, inertia: Vector3::new(0.003, 0.005, 0.007), ..vacuum() };
    let mut state = level_rest();
    for (i, rate) in [3.0, -2.0, 1.5].into_iter().enumerate() {
        state[10 + i] = rate;
    }
    let momentum = |s: &QuadrotorState| {
        let rates = Vector3::new(s[10], s[11], s[12]);
        rotation::unit_quaternion(&s.as_slice()[3..7]) * robot.inertia.component_mul(&rates)
    };
    let spin = |s: &QuadrotorState| {
        let rates = Vector3::new(s[10], s[11], s[12]);
        0.5 * rates.dot(&robot.inertia.component_mul(&rates))
    };
    let fall = |s: &QuadrotorState| 0.5 * (s[7].powi(2) + s[8].powi(2) + s[9].powi(2)) + robot.gravity * s[2];
    let end = fly(&robot, state, &Vector4::zeros(), 3.0, 3000);
    assert!((momentum(&end) - momentum(&state)).norm() < 1e-9 * momentum(&state).norm());
    assert!((spin(&end) - spin(&state)).abs() < 1e-9 * spin(&state));
    assert!((fall(&end) - fall(&state)).abs() < 1e-9);
}

#[test]
fn the_papers_euler_rates_are_the_quaternions() {
    let robot = vacuum();
    let mut rng = stream(named_seed(2, "euler rates", 0));
    for case in 0..200 {
        let mut state = EulerState::from_fn(|_, _| rng.random_range(-1.4..1.4));
        state[5] *= 2.0;
        let speeds = Vector4::from_fn(|_, _| rng.random_range(0.0..2200.0));
        let x = from_euler_state(&state);
        let derivative = robot.derivative(&x, &speeds);
        let u = robot.wrench(&speeds);
        let rates = Vector3::new(state[9], state[10], state[11]);
        let turning = angular_acceleration(&robot, &u, rates.x, rates.y, rates.z);
        let pull = thrust_direction(state[3], state[4], state[5]) * u[0] / robot.mass - Vector3::z() * robot.gravity;
        for i in 0..3 {
            assert!((derivative[10 + i] - turning[i]).abs() < 1e-9 * (1.0 + turning.norm()), "case {case}");
            assert!((derivative[7 + i] - pull[i]).abs() < 1e-9 * (1.0 + pull.norm()), "case {case}");
        }
        // The angles' derivative by central differences along the flow.
        let h = 1e-6;
        let along = |h: f64| to_euler_state(&(x + derivative * h));
        let expected = euler_rates(state[3], state[4], &rates);
        let (ahead, behind) = (along(h), along(-h));
        for i in 0..3 {
            let rate = (ahead[3 + i] - behind[3 + i]) / (2.0 * h);
            assert!((rate - expected[i]).abs() < 1e-5 * (1.0 + expected.norm()), "case {case}, angle {i}");
        }
    }
}

#[test]
fn the_twelve_state_interface_round_trips() {
    let mut rng = stream(named_seed(3, "round trip", 0));
    for _ in 0..200 {
        let mut x = random_state(&mut rng);
        vacuum().normalize(&mut x);
        let back = from_euler_state(&to_euler_state(&x));
        let flip = if back[3] * x[3] + back[4] * x[4] + back[5] * x[5] + back[6] * x[6] < 0.0 { -1.0 } else { 1.0 };
        for i in 0..13 {
            let sign = if (3..7).contains(&i) { flip } else { 1.0 };
            assert!((sign * back[i] - x[i]).abs() < 1e-9);
        }
    }
}

struct AsOde<'a>(&'a Quadrotor, Vector4<f64>);

impl ODE<f64, [f64; 13]> for AsOde<'_> {
    fn diff(&self, _t: f64, y: &[f64; 13], dydt: &mut [f64; 13]) {
        dydt.copy_from_slice(self.0.derivative(&QuadrotorState::from(*y), &self.1).as_slice());
    }
}

#[test]
fn another_integrator_agrees_and_the_order_is_four() {
    let robot = shipped("flightgoggles");
    let speeds = Vector4::new(1000.0, 1150.0, 1220.0, 1080.0);
    let mut start = level_rest();
    start[7] = 4.0;
    start[11] = 0.7;
    let problem = AsOde(&robot, speeds);
    let solution = IVP::ode(&problem, 0.0, 0.5, <[f64; 13]>::from(start))
        .method(ExplicitRungeKutta::dop853())
        .rtol(1e-13)
        .atol(1e-13)
        .solve()
        .expect("a smooth problem");
    let truth = QuadrotorState::from(*solution.y.last().expect("a solution has an end"));
    let error = |steps: usize| {
        let h = 0.5 / steps as f64;
        (0..steps).fold(start, |x, _| rk4_step(|x| robot.derivative(x, &speeds), &x, h)) - truth
    };
    assert!(error(4000).norm() < 1e-9, "{}", error(4000).norm());
    let order = (error(100).norm() / error(200).norm()).log2();
    assert!((order - 4.0).abs() < 0.3, "order {order}");
}
