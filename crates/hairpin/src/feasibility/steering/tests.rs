//! The legs against independent means: other integrators, numeric differences, dense sampling.

use differential_equations::prelude::*;
use nalgebra::{Point3, UnitQuaternion, Vector3};
use rand::RngExt;

use super::flatness::flat_state;
use super::*;
use crate::feasibility::limits::{Infeasible, Limit, Limits};
use crate::math::random::{Stream, stream};
use crate::robot::quadrotor::{Quadrotor, Rotor};
use crate::trajectory::ProfileLeg;
use crate::world::World;

/// FlightGoggles' numbers (drone.yaml of mit-aera/FlightGoggles): X layout, quadratic drag.
pub(crate) fn flightgoggles() -> Quadrotor {
    let rotor = |x: f64, y: f64, spin: f64| Rotor { x, y, spin };
    Quadrotor {
        name: "flightgoggles".into(),
        mass: 1.0,
        inertia: Vector3::new(0.0049, 0.0049, 0.0069),
        rotors: [rotor(0.08, 0.08, 1.0), rotor(-0.08, 0.08, -1.0), rotor(-0.08, -0.08, 1.0), rotor(0.08, -0.08, -1.0)],
        thrust_coefficient: 1.91e-6,
        moment_coefficient: 2.6e-7,
        rotor_speed: (0.0, 2200.0),
        rotor_time_constant: 0.02,
        drag_linear: 0.0,
        drag_quadratic: 0.1,
        aerodynamic_moment: 0.003,
        force_noise: 0.0,
        moment_noise: 0.0,
        max_speed: 18.0,
        clearance_radius: 0.23,
        gravity: 9.81,
        estimated: Vec::new(),
        caveat: String::new(),
    }
}

/// A plus layout with unequal inertias, both kinds of drag and rotors that may not stop.
pub(crate) fn plus() -> Quadrotor {
    let rotor = |x: f64, y: f64, spin: f64| Rotor { x, y, spin };
    Quadrotor {
        name: "plus".into(),
        mass: 0.8,
        inertia: Vector3::new(2.32e-3, 3.0e-3, 4.0e-3),
        rotors: [rotor(0.2, 0.0, 1.0), rotor(0.0, 0.2, -1.0), rotor(-0.2, 0.0, 1.0), rotor(0.0, -0.2, -1.0)],
        rotor_speed: (300.0, 2000.0),
        drag_linear: 0.15,
        drag_quadratic: 0.02,
        aerodynamic_moment: 0.0,
        ..flightgoggles()
    }
}

fn open_world() -> World {
    World::new(Vector3::repeat(1000.0), 0.0, Vec::new()).unwrap()
}

pub(super) fn judge_of(robot: &Quadrotor, limits: Limits) -> LegJudge {
    LegJudge::new(robot, &open_world(), limits, ProofSettings::default()).unwrap()
}

pub(super) fn random_ends(judge: &LegJudge, random: &mut Stream, speed: f64, size: f64) -> (LegEnd, LegEnd) {
    let mut end = || {
        let p = Point3::from(Vector3::from_fn(|_, _| 500.0 + random.random_range(-size..size)));
        let v = Vector3::from_fn(|_, _| random.random_range(-speed..speed));
        judge.end(p, v)
    };
    (end(), end())
}

/// Legs of a few metres in 0.7 … 3 s, about the limits of what the robots here can fly.
fn random_leg(judge: &LegJudge, seed: u64) -> ProfileLeg {
    let mut random = stream(seed);
    let (from, to) = random_ends(judge, &mut random, 4.0, 3.0);
    LegJudge::connect(&from, &to, random.random_range(0.7..3.0))
}

#[test]
fn ends_are_level_and_without_rates() {
    for robot in [flightgoggles(), plus()] {
        let judge = judge_of(&robot, Limits::default());
        for seed in 0..200 {
            let leg = random_leg(&judge, seed);
            for tau in [0.0, leg.duration] {
                let state = judge.flatness().body_state(&leg, tau);
                assert!(state.attitude.angle() < 1e-9, "seed {seed}: {}", state.attitude.angle());
                assert!(state.rates.norm() < 1e-7, "seed {seed}: {}", state.rates.norm());
            }
        }
    }
}

#[test]
fn attitude_rates_and_moments_are_each_others_derivatives() {
    for robot in [flightgoggles(), plus()] {
        let judge = judge_of(&robot, Limits { max_tilt: 1.2, ..Limits::default() });
        let mut checked = 0;
        for seed in 0..300 {
            let leg = random_leg(&judge, seed);
            if judge.prove(&leg).is_err() {
                continue;
            }
            checked += 1;
            let (tau, h) = (leg.duration * 0.37, 1e-5);
            let at = |t: f64| judge.flatness().body_state(&leg, t);
            let (before, now, after) = (at(tau - h), at(tau), at(tau + h));
            let turned = before.attitude.rotation_to(&after.attitude);
            let body_turn = now.attitude.inverse() * turned * now.attitude;
            let numeric = body_turn.scaled_axis() / (2.0 * h);
            assert!((numeric - now.rates).norm() < 1e-5 * (1.0 + now.rates.norm()), "seed {seed}");

            // Euler's equation with numeric ω̇ against the moments of the rotors.
            let acceleration = (after.rates - before.rates) / (2.0 * h);
            let i = robot.inertia;
            let wanted = i.component_mul(&acceleration)
                + now.rates.cross(&i.component_mul(&now.rates))
                + now.rates * (robot.aerodynamic_moment * now.rates.norm());
            let mut given = Vector3::zeros();
            for (rotor, w) in robot.rotors.iter().zip(now.rotors) {
                let thrust = robot.thrust_coefficient * w * w;
                let reaction = rotor.spin * robot.moment_coefficient * w * w;
                given += Vector3::new(rotor.y * thrust, -rotor.x * thrust, reaction);
            }
            assert!((wanted - given).norm() < 1e-5 * (1.0 + wanted.norm()), "seed {seed}: {wanted} {given}");
        }
        assert!(checked > 50, "only {checked} legs were flyable");
    }
}

/// The rigid body under the rotor speeds of a leg: position, velocity, quaternion (w, x, y, z), rates.
struct Body<'a> {
    robot: &'a Quadrotor,
    judge: &'a LegJudge,
    leg: &'a ProfileLeg,
}

impl ODE<f64, [f64; 13]> for Body<'_> {
    fn diff(&self, t: f64, y: &[f64; 13], dydt: &mut [f64; 13]) {
        let rotors = self.judge.flatness().body_state(self.leg, t).rotors;
        let robot = self.robot;
        let q = nalgebra::Quaternion::new(y[6], y[7], y[8], y[9]);
        let attitude = UnitQuaternion::from_quaternion(q);
        let (v, w) = (Vector3::new(y[3], y[4], y[5]), Vector3::new(y[10], y[11], y[12]));
        let (mut thrust, mut moment) = (0.0, Vector3::zeros());
        for (rotor, speed) in robot.rotors.iter().zip(rotors) {
            let f = robot.thrust_coefficient * speed * speed;
            thrust += f;
            moment += Vector3::new(rotor.y * f, -rotor.x * f, rotor.spin * robot.moment_coefficient * speed * speed);
        }
        let drag = v * (robot.drag_linear + robot.drag_quadratic * v.norm());
        let a = (attitude * Vector3::z() * thrust - drag) / robot.mass - Vector3::z() * robot.gravity;
        let q_rate = q * nalgebra::Quaternion::from_parts(0.0, w) * 0.5;
        let torque = moment - w.cross(&robot.inertia.component_mul(&w)) - w * (robot.aerodynamic_moment * w.norm());
        let w_rate = torque.component_div(&robot.inertia);
        *dydt = [v.x, v.y, v.z, a.x, a.y, a.z, q_rate.w, q_rate.i, q_rate.j, q_rate.k, w_rate.x, w_rate.y, w_rate.z];
    }
}

#[test]
fn rotor_speeds_fly_the_leg_in_another_integrator() {
    for robot in [flightgoggles(), plus()] {
        let judge = judge_of(&robot, Limits { max_tilt: 1.0, ..Limits::default() });
        let mut flown = 0;
        for seed in 0..400 {
            let leg = random_leg(&judge, seed);
            if judge.prove(&leg).is_err() {
                continue;
            }
            let (p, v) = (leg.position(0.0), leg.derivative(0.0, 1));
            let start = [p.x, p.y, p.z, v.x, v.y, v.z, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
            let body = Body { robot: &robot, judge: &judge, leg: &leg };
            let method = ExplicitRungeKutta::dop853().rtol(1e-10).atol(1e-10);
            let solution = IVP::ode(&body, 0.0, leg.duration, start).method(method).solve().unwrap();
            let end = solution.y.last().unwrap();
            let miss = Vector3::new(end[0], end[1], end[2]) - leg.position(leg.duration).coords;
            let drift = Vector3::new(end[3], end[4], end[5]) - leg.derivative(leg.duration, 1);
            let tilt = 2.0 * Vector3::new(end[7], end[8], end[9]).norm();
            assert!(miss.norm() < 1e-5 && drift.norm() < 1e-5 && tilt < 1e-6, "seed {seed}: {miss} {drift} {tilt}");
            flown += 1;
            if flown == 25 {
                break;
            }
        }
        assert_eq!(flown, 25);
    }
}

/// Whether the limits hold at `samples` instants, without any of the room that proofs leave.
fn densely_feasible(robot: &Quadrotor, limits: &Limits, judge: &LegJudge, leg: &ProfileLeg, samples: usize) -> bool {
    (0..=samples).all(|k| {
        let demand = judge.flatness().demand(&flat_state(leg, leg.duration * k as f64 / samples as f64));
        let (low, high) = (robot.rotor_speed.0.powi(2), robot.rotor_speed.1.powi(2));
        demand.speed <= limits.max_speed
            && demand.force[2] >= flatness::LEAST_VERTICAL_THRUST * robot.mass * robot.gravity
            && (demand.force[2] / demand.thrust).acos() <= limits.max_tilt
            && demand.rotors.iter().all(|w2| *w2 >= low && *w2 <= high)
    })
}

#[test]
fn accepted_legs_hold_at_a_hundred_thousand_instants_and_few_good_ones_are_refused() {
    for robot in [flightgoggles(), plus()] {
        let limits = Limits { max_speed: 6.0, max_tilt: 0.8 };
        let judge = judge_of(&robot, limits);
        let (mut accepted, mut good, mut lost) = (0, 0, 0);
        for seed in 0..4000 {
            let leg = random_leg(&judge, seed);
            let verdict = judge.prove(&leg);
            if let Err(Infeasible::Violates { limit, at, margin, .. }) = verdict {
                assert!(margin < 0.0 && (0.0..=leg.duration).contains(&at), "seed {seed}: {limit:?}");
                continue;
            }
            // Coarse first; some of the legs that were accepted are sampled finely.
            let coarse = densely_feasible(&robot, &limits, &judge, &leg, 2000);
            good += usize::from(coarse);
            lost += usize::from(coarse && verdict.is_err());
            if verdict.is_ok() {
                accepted += 1;
                assert!(coarse, "seed {seed} violates a limit at 2000 instants");
                assert!(accepted > 30 || densely_feasible(&robot, &limits, &judge, &leg, 100_000), "seed {seed}");
            }
        }
        assert!(accepted > 400, "{accepted}");
        // Conservatism: of the legs without a violation at 2000 instants, less than one in a thousand is refused.
        assert!(lost * 1000 <= good, "{lost} of {good} feasible legs refused");
    }
}

#[test]
fn a_violation_of_one_millisecond_between_samples_is_refused() {
    let robot = flightgoggles();
    let wide = judge_of(&robot, Limits::default());
    let (mut checked, mut missed_by_sampling) = (0, 0);
    for seed in 0..3000 {
        let leg = random_leg(&wide, seed);
        if wide.prove(&leg).is_err() {
            continue;
        }
        // Which rotor speed is exceeded for just 1 ms? Take the peak, and lower the limit to what holds 0.5 ms beside
        // it.
        let square = |t: f64| wide.flatness().demand(&flat_state(&leg, t)).rotors.into_iter().fold(0.0, f64::max);
        let samples = 20_000;
        let times = (1..samples).map(|k| leg.duration * k as f64 / samples as f64);
        let peak = times.max_by(|a, b| square(*a).total_cmp(&square(*b))).unwrap();
        if peak < 0.01 || peak > leg.duration - 0.01 {
            continue;
        }
        let limit = square(peak - 0.0005).max(square(peak + 0.0005)).sqrt();
        let excess = square(peak).sqrt() - limit;
        if excess <= 1e-7 {
            continue;
        }
        checked += 1;
        let tight = judge_of(&Quadrotor { rotor_speed: (0.0, limit), ..robot.clone() }, Limits::default());
        let refused = tight.prove(&leg).expect_err("a violation went unseen");
        assert_eq!(refused.limit(), Limit::RotorMax, "seed {seed}: {refused}");
        missed_by_sampling += usize::from((0..=100).all(|k| square(leg.duration * k as f64 / 100.0).sqrt() <= limit));
        // The same leg passes when the limit is as far above the peak as it was below.
        let loose = judge_of(
            &Quadrotor { rotor_speed: (0.0, square(peak).sqrt() + excess), ..robot.clone() },
            Limits::default(),
        );
        assert_eq!(loose.prove(&leg), Ok(()), "seed {seed}");
        if checked == 60 {
            break;
        }
    }
    assert!(
        checked == 60 && missed_by_sampling > 40,
        "{checked} checked, {missed_by_sampling} invisible to 100 samples"
    );
}

#[test]
fn free_fall_and_inverted_are_refused() {
    let judge = judge_of(&flightgoggles(), Limits::default());
    let rest = |x: f64, z: f64| judge.end(Point3::new(x, 500.0, z), Vector3::zeros());
    // 40 m down in 2 s asks for more than free fall; so does a parabola whose acceleration is just −g.
    let refused = judge.judge(&rest(500.0, 500.0), &rest(500.0, 460.0), 2.0).unwrap_err();
    assert!(matches!(refused, Infeasible::Violates { limit: Limit::Thrust, .. }), "{refused}");
    let mut fall = ProfileLeg { duration: 1.0, coefficients: [[0.0; 8]; 3] };
    for (axis, c) in fall.coefficients.iter_mut().enumerate() {
        c[0] = 500.0;
        c[2] = if axis == 2 { -0.5 * 9.81 } else { 0.0 };
    }
    assert_eq!(judge.prove(&fall).unwrap_err().limit(), Limit::Thrust);
    // Body x vertical: no vertical thrust at all, but plenty sideways.
    fall.coefficients[0][2] = 5.0;
    assert_eq!(judge.prove(&fall).unwrap_err().limit(), Limit::Thrust);
    // Inverted, pushing downwards.
    fall.coefficients[2][2] = -10.0;
    assert_eq!(judge.prove(&fall).unwrap_err().limit(), Limit::Thrust);
    for duration in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-9] {
        assert!(judge.judge(&rest(500.0, 500.0), &rest(501.0, 500.0), duration).is_err());
    }
    assert!(judge.judge(&rest(500.0, 500.0), &rest(f64::NAN, 500.0), 1.0).is_err());
}

#[test]
fn necessary_tests_never_refuse_what_the_proof_accepts() {
    for robot in [flightgoggles(), plus()] {
        let limits = Limits { max_speed: 7.0, max_tilt: 0.9 };
        let judge = judge_of(&robot, limits);
        let mut accepted = 0;
        for seed in 0..5000 {
            let mut random = stream(seed);
            let (from, to) = random_ends(&judge, &mut random, 3.0, 3.0);
            let duration = random.random_range(0.8..3.0);
            let proven = judge.prove(&LegJudge::connect(&from, &to, duration)).is_ok();
            let judged = judge.judge(&from, &to, duration).is_ok();
            assert_eq!(proven, judged, "seed {seed}");
            accepted += usize::from(proven);
        }
        assert!(accepted > 300, "{accepted}");
    }
}

#[test]
fn speed_may_vanish_in_flight() {
    // Through v = 0 with acceleration: |v|v has no second derivative there, the bound holds both sides.
    let judge = judge_of(&flightgoggles(), Limits::default());
    let from = judge.end(Point3::new(500.0, 500.0, 500.0), Vector3::new(2.0, 0.0, 0.0));
    let to = judge.end(Point3::new(500.0, 500.0, 500.0), Vector3::new(-2.0, 0.0, 0.0));
    assert!(judge.judge(&from, &to, 2.0).is_ok());
    // A ball thrown straight up on a hovering thrust: one axis only.
    let up = judge.end(Point3::new(500.0, 500.0, 500.0), Vector3::new(0.0, 0.0, 2.0));
    let down = judge.end(Point3::new(500.0, 500.0, 500.0), Vector3::new(0.0, 0.0, -2.0));
    assert!(judge.judge(&up, &down, 2.0).is_ok());
}
