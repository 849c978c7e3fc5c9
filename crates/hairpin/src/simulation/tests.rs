//! The act against closed forms, other integrators and its own promises.

use nalgebra::{Point3, Vector3, Vector4};

use super::*;
use crate::math::integrate::rk4_step;
use crate::math::rotation::{body_z, quaternion_rate, renormalize};
use crate::robot::quadrotor::{Quadrotor, QuadrotorDescription};
use crate::trajectory::{Ended, Flight, Profile, ProfileLeg};
use crate::world::{Obstacle, Shape, World};

/// All controllers of ours.
pub(super) const KINDS: [ControllerKind; 8] = [
    ControllerKind::UnstableWaypoint,
    ControllerKind::StableWaypoint,
    ControllerKind::FixedVelocity,
    ControllerKind::MinimumSnap,
    ControllerKind::Geometric,
    ControllerKind::Anafi,
    ControllerKind::Px4Mission,
    ControllerKind::CrazyflieGoto,
];

/// The shipped robots, FlightGoggles first.
pub(crate) fn shipped() -> Vec<Quadrotor> {
    [
        include_str!("../../../../data/robots/quadrotor/flightgoggles.toml"),
        include_str!("../../../../data/robots/quadrotor/paper-flightgoggles.toml"),
        include_str!("../../../../data/robots/quadrotor/anafi.toml"),
        include_str!("../../../../data/robots/quadrotor/anafi-real.toml"),
        include_str!("../../../../data/robots/quadrotor/crazyflie.toml"),
        include_str!("../../../../data/robots/quadrotor/x500.toml"),
        include_str!("../../../../data/robots/quadrotor/iris.toml"),
    ]
    .map(|text| toml::from_str::<QuadrotorDescription>(text).unwrap().build().unwrap())
    .to_vec()
}

pub(crate) fn flightgoggles() -> Quadrotor {
    shipped().remove(0)
}

pub(super) fn cage() -> World {
    World::new(Vector3::repeat(30.0), 0.0, vec![]).unwrap()
}

fn fly_with(robot: &Quadrotor, world: &World, points: &[[f64; 3]], conditions: &Conditions, seed: u64) -> Flight {
    let waypoints: Vec<Point3<f64>> = points.iter().copied().map(Point3::from).collect();
    let sortie = Sortie { robot, world, waypoints: &waypoints, profile: None };
    let settings = FlySettings { time_limit: 30.0, ..Default::default() };
    fly(&sortie, &ControllerSettings::default(), conditions, &settings, seed).unwrap()
}

#[test]
fn hover_is_held() {
    for robot in shipped() {
        let point = [10.0, 10.0, 10.0];
        let flight = fly_with(&robot, &cage(), &[point, point], &Conditions::default(), 1);
        assert_eq!(flight.ended, Ended::Done, "{}", robot.name);
        assert!((flight.track.times().last().unwrap() - 2.0).abs() < 1e-9);
        let farthest = (0..flight.track.len()).map(|i| (flight.track.position(i) - Point3::from(point)).norm());
        assert!(farthest.fold(0.0, f64::max) < 1e-9, "{}", robot.name);
    }
}

/// FlightGoggles' body without what closed forms do not have.
fn vacuum() -> Quadrotor {
    Quadrotor { drag_quadratic: 0.0, aerodynamic_moment: 0.0, rotor_time_constant: 0.0, ..flightgoggles() }
}

fn run(plant: &Plant, state: PlantState, command: impl Fn(f64) -> Vector4<f64>, time: f64, h: f64) -> PlantState {
    let stepper = Stepper::new(plant, h);
    let mut motion = Motion::new(plant, &state);
    for i in 0..(time / h).round() as usize {
        // Commands change every millisecond, whatever the step.
        let millisecond = (i as f64 * h / 0.001 + 1e-6).floor() * 0.001;
        stepper.advance(plant, &mut motion, &command(millisecond));
    }
    motion.state()
}

fn level(position: Vector3<f64>, rotors: f64) -> PlantState {
    Plant::at_rest(&position, &Vector4::repeat(rotors))
}

/// A tumbling, accelerating flight: four commands that never agree.
fn wild(robot: &Quadrotor) -> impl Fn(f64) -> Vector4<f64> {
    let hover = robot.hover_speed();
    move |t: f64| Vector4::from_fn(|i, _| hover * (1.02 + 0.03 * (1.3 * t + 2.0 * i as f64).sin()))
}

#[test]
fn free_fall_is_a_parabola() {
    let plant = Plant::new(&vacuum());
    let mut state = level(Vector3::new(0.0, 0.0, 100.0), 0.0);
    state[7] = 3.0;
    let end = run(&plant, state, |_| Vector4::zeros(), 2.0, 0.001);
    assert!((end[0] - 6.0).abs() < 1e-9 && (end[2] - (100.0 - 0.5 * 9.81 * 4.0)).abs() < 1e-9);
    // With quadratic drag from rest: v = √(mg/c) tanh(t √(gc/m)).
    let plant = Plant::new(&Quadrotor { drag_quadratic: 0.1, ..vacuum() });
    let end = run(&plant, level(Vector3::zeros(), 0.0), |_| Vector4::zeros(), 2.0, 0.001);
    assert!((end[9] + 98.1f64.sqrt() * (2.0 * 0.981f64.sqrt()).tanh()).abs() < 1e-6);
}

#[test]
fn a_torque_free_tumble_keeps_energy_and_angular_momentum() {
    let robot = vacuum();
    let plant = Plant::new(&robot);
    let mut state = level(Vector3::zeros(), 0.0);
    state.fixed_rows_mut::<3>(10).copy_from(&Vector3::new(3.0, -2.0, 5.0));
    let conserved = |s: &PlantState| {
        let w: Vector3<f64> = s.fixed_rows::<3>(10).into_owned();
        let v2 = s.fixed_rows::<3>(7).norm_squared();
        let turning = 0.5 * w.dot(&robot.inertia.component_mul(&w));
        let momentum = Plant::pose(s).rotation * robot.inertia.component_mul(&w);
        (turning, 0.5 * robot.mass * v2 + robot.mass * robot.gravity * s[2], momentum)
    };
    let (before, after) = (conserved(&state), conserved(&run(&plant, state, |_| Vector4::zeros(), 5.0, 0.001)));
    assert!((before.0 - after.0).abs() < 1e-5 * before.0, "{before:?} {after:?}");
    assert!((before.1 - after.1).abs() < 1e-9);
    assert!((before.2 - after.2).norm() < 1e-4 * before.2.norm(), "{before:?} {after:?}");
}

#[test]
fn a_rotor_answers_with_its_time_constant() {
    let plant = Plant::new(&flightgoggles());
    for h in [0.001, 0.0001] {
        let end = run(&plant, level(Vector3::zeros(), 500.0), |_| Vector4::repeat(1500.0), 0.02, h);
        assert!((end[13] - (1500.0 - 1000.0 * (-1.0f64).exp())).abs() < 1e-9);
    }
}

/// Without lag and noise the plant is the robot of the claim, integrated by the claim's own equations.
#[test]
fn without_lag_it_is_the_robot_itself() {
    for drag in [0.0, 0.1] {
        let robot = Quadrotor { drag_quadratic: drag, aerodynamic_moment: 0.03 * drag, ..vacuum() };
        let (plant, command) = (Plant::new(&robot), wild(&robot));
        let end = run(&plant, level(Vector3::zeros(), 0.0), &command, 2.0, 0.001);
        let mut theirs = crate::robot::quadrotor::level_rest();
        for i in 0..20_000 {
            let u = command((i / 10) as f64 * 0.001);
            theirs = rk4_step(|x| robot.derivative(x, &u), &theirs, 1e-4);
            robot.normalize(&mut theirs);
        }
        let distance = (end.fixed_rows::<3>(0) - theirs.fixed_rows::<3>(0)).norm();
        assert!(theirs.fixed_rows::<3>(0).norm() > 1.0 && distance < 1e-3, "drag {drag}: {distance} m");
    }
}

/// The equations of [`Plant`] as they stand there, in no way a step.
fn derivative(plant: &Plant, state: &PlantState, asked: &Vector4<f64>) -> PlantState {
    let vector = |at: usize| Vector3::new(state[at], state[at + 1], state[at + 2]);
    let (q, v, w) = (&state.as_slice()[3..7], vector(7), vector(10));
    let rotors = Vector4::new(state[13], state[14], state[15], state[16]);
    let lagging = plant.time_constant > 0.0;
    let turning = if lagging { rotors } else { *asked };
    let squares = turning.component_mul(&turning);
    let wrench = plant.allocation.map(|row| Vector4::from(row).dot(&squares));
    let through_air = v - plant.air;
    let drag = through_air * -(plant.drag_linear + plant.drag_quadratic * through_air.norm());
    let acceleration = (body_z(q) * wrench[0] + drag + plant.force) * plant.inverse_mass - Vector3::z() * plant.gravity;
    let moment = Vector3::new(wrench[1], wrench[2], wrench[3]) + plant.moment;
    let mut out = PlantState::zeros();
    out.fixed_rows_mut::<3>(0).copy_from(&v);
    out.as_mut_slice()[3..7].copy_from_slice(&quaternion_rate(q, &w));
    out.fixed_rows_mut::<3>(7).copy_from(&acceleration);
    out.fixed_rows_mut::<3>(10).copy_from(&plant.angular(&w, &moment));
    if lagging {
        out.fixed_rows_mut::<4>(13).copy_from(&((asked - rotors) / plant.time_constant));
    }
    out
}

/// The cheap scheme against Runge-Kutta on the plant's equations, lag included, at a tenth of the step.
#[test]
fn a_step_is_as_good_as_runge_kutta_at_a_tenth() {
    for robot in shipped() {
        let (plant, command) = (Plant::new(&robot), wild(&robot));
        let start = level(Vector3::zeros(), robot.hover_speed());
        let end = run(&plant, start, &command, 1.0, 0.001);
        let mut exact = start;
        for i in 0..10_000 {
            let u = command((i / 10) as f64 * 0.001);
            exact = rk4_step(|x| derivative(&plant, x, &u), &exact, 1e-4);
            renormalize(&mut exact.as_mut_slice()[3..7]);
        }
        let distance = (end.fixed_rows::<3>(0) - exact.fixed_rows::<3>(0)).norm();
        assert!(distance < 1e-3, "{}: {distance} m", robot.name);
        let order = (end - exact).norm() / (run(&plant, start, &command, 1.0, 0.0005) - exact).norm();
        assert!(order > 3.5 && order < 4.5, "{}: error falls by {order} when the step is halved", robot.name);
    }
}

/// A closed loop at 1 kHz and at 10 kHz physics, the same controller: within millimetres over 10 s.
#[test]
fn a_finer_step_moves_the_flight_by_millimetres() {
    for robot in shipped() {
        let waypoints = [[5.0, 5.0, 5.0], [9.0, 7.0, 6.0], [6.0, 14.0, 7.0], [14.0, 14.0, 9.0]].map(Point3::from);
        let world = cage();
        let sortie = Sortie { robot: &robot, world: &world, waypoints: &waypoints, profile: None };
        let at = |step: f64| {
            let settings = FlySettings { step, time_limit: 10.0, linger: 100.0, ..Default::default() };
            fly(&sortie, &ControllerSettings::default(), &Conditions::default(), &settings, 1).unwrap().track
        };
        let (coarse, fine) = (at(0.001), at(0.0001));
        assert_eq!(coarse.len(), fine.len());
        let worst = (0..fine.len()).map(|i| (coarse.position(i) - fine.position(i)).norm()).fold(0.0, f64::max);
        assert!(worst < 3e-3, "{}: {worst} m", robot.name);
    }
}

#[test]
fn wind_carries_a_falling_body_along() {
    let mut plant = Plant::new(&flightgoggles());
    plant.air = Vector3::new(3.0, -2.0, 0.0);
    let end = run(&plant, level(Vector3::zeros(), 0.0), |_| Vector4::zeros(), 3.0, 0.001);
    assert!(end[7] > 1.0 && end[7] < 3.0 && end[8] < -0.7 && end[8] > -2.0, "{end}");
    // A controlled flight is pushed the same way before its integral works.
    let conditions = Conditions { wind: Vector3::new(6.0, 0.0, 0.0), ..Default::default() };
    let point = [10.0, 10.0, 10.0];
    let flight = fly_with(&flightgoggles(), &cage(), &[point, point], &conditions, 1);
    assert!((0..flight.track.len()).map(|i| flight.track.position(i).x).fold(0.0, f64::max) > 10.05);
}

#[test]
fn noise_is_a_random_walk_of_the_robots_density() {
    let robot = vacuum();
    let mut plant = Plant::new(&robot);
    let (runs, time) = (400, 0.25);
    for h in [0.001, 0.0005] {
        let stepper = Stepper::new(&plant, h);
        let (mut velocity, mut rates) = (0.0, 0.0);
        for seed in 0..runs {
            let conditions = Conditions { noise: true, ..Default::default() };
            let mut noise = Disturbances::new(&robot, &conditions, h, seed);
            let mut motion = Motion::new(&plant, &level(Vector3::zeros(), 0.0));
            for _ in 0..(time / h) as usize {
                noise.act_on(&mut plant);
                stepper.advance(&plant, &mut motion, &Vector4::zeros());
            }
            let state = motion.state();
            velocity += (state[7].powi(2) + state[8].powi(2)) / (2 * runs) as f64;
            rates += (state[10].powi(2) + state[11].powi(2)) / (2 * runs) as f64;
        }
        // Var v = S t/m², Var p = S t/I²; 800 squares have a relative error of 5 %, four of which are allowed.
        let expected = (robot.force_noise * time, robot.moment_noise * time / robot.inertia.x.powi(2));
        assert!((velocity / expected.0 - 1.0).abs() < 0.2, "{velocity} {}", expected.0);
        assert!((rates / expected.1 - 1.0).abs() < 0.2, "{rates} {}", expected.1);
    }
}

/// White noise moves a held hover by the same at 1 kHz and at 10 kHz, though its draws differ.
#[test]
fn a_finer_step_is_shaken_by_the_same_noise() {
    let (robot, world) = (flightgoggles(), cage());
    let waypoints = [Point3::new(10.0, 10.0, 10.0); 2];
    let sortie = Sortie { robot: &robot, world: &world, waypoints: &waypoints, profile: None };
    let conditions = Conditions { noise: true, ..Default::default() };
    let shaken = |step: f64| {
        let settings = FlySettings { step, time_limit: 20.0, linger: 100.0, ..Default::default() };
        let (mut sum, mut count) = ([0.0; 2], 0);
        for seed in 0..6 {
            let flight = fly(&sortie, &ControllerSettings::default(), &conditions, &settings, seed).unwrap();
            for (total, names) in sum.iter_mut().zip([["vx_m_s", "vy_m_s"], ["p_rad_s", "q_rad_s"]]) {
                let squares = |name| flight.track.channel(name).unwrap().iter().map(|v| v * v).sum::<f64>();
                *total += names.map(squares).iter().sum::<f64>();
            }
            count += 2 * flight.track.len();
        }
        sum.map(|sum| (sum / count as f64).sqrt())
    };
    let (coarse, fine) = (shaken(0.001), shaken(0.0001));
    // Some 240 independent velocities: their deviation is known to 5 %, the quotient to 7 %.
    assert!((coarse[0] / fine[0] - 1.0).abs() < 0.25 && fine[0] > 0.01, "{coarse:?} {fine:?} m/s");
    assert!((coarse[1] / fine[1] - 1.0).abs() < 0.1 && fine[1] > 0.01, "{coarse:?} {fine:?} rad/s");
}

#[test]
fn gusts_have_their_deviation_and_correlation() {
    let robot = flightgoggles();
    let conditions = Conditions { gusts: Some(Gusts { std: 2.0, correlation: 0.05 }), ..Default::default() };
    let (mut process, mut plant) = (Disturbances::new(&robot, &conditions, 0.001, 3), Plant::new(&robot));
    let samples: Vec<f64> = (0..400_000)
        .map(|_| {
            process.act_on(&mut plant);
            plant.air.y
        })
        .collect();
    let product = |lag: usize| {
        let pairs = samples.iter().zip(&samples[lag..]);
        pairs.map(|(a, b)| a * b).sum::<f64>() / (samples.len() - lag) as f64
    };
    assert!((product(0).sqrt() - 2.0).abs() < 0.1, "{}", product(0));
    assert!((product(50) / product(0) - (-1.0f64).exp()).abs() < 0.06, "{}", product(50) / product(0));
}

#[test]
fn a_discrete_gust_comes_once_and_goes() {
    let robot = flightgoggles();
    let gust = DiscreteGust { velocity: Vector3::new(0.0, -4.0, 2.0), start: 0.5, duration: 2.0 };
    let conditions = Conditions { wind: Vector3::x(), discrete_gust: Some(gust), ..Default::default() };
    let (mut process, mut plant) = (Disturbances::new(&robot, &conditions, 0.001, 3), Plant::new(&robot));
    let air: Vec<Vector3<f64>> = (0..4000)
        .map(|_| {
            process.act_on(&mut plant);
            plant.air
        })
        .collect();
    let sum: Vector3<f64> = air.iter().map(|air| air - Vector3::x()).sum();
    assert!((air[1500] - Vector3::new(1.0, -4.0, 2.0)).norm() < 1e-9 && (air[1000].y + 2.0).abs() < 1e-9);
    assert!(air[..=500].iter().chain(&air[2500..]).all(|air| (air - Vector3::x()).norm() < 1e-12));
    // Half of its peak in the mean.
    assert!((sum * 1e-3 - gust.velocity).norm() < 1e-6, "{sum}");
    let calm = DiscreteGust { duration: 0.0, ..gust };
    let error = fly_with_conditions(&Conditions { discrete_gust: Some(calm), ..Default::default() }).unwrap_err();
    assert!(error.to_string().contains("discrete_gust.duration"), "{error}");
}

/// What a flight under `conditions` comes to.
fn fly_with_conditions(conditions: &Conditions) -> Result<Flight, SimulationError> {
    let (robot, world) = (flightgoggles(), cage());
    let waypoints = [Point3::new(5.0, 5.0, 5.0), Point3::new(9.0, 7.0, 6.0)];
    let sortie = Sortie { robot: &robot, world: &world, waypoints: &waypoints, profile: None };
    fly(&sortie, &ControllerSettings::default(), conditions, &FlySettings::default(), 1)
}

#[test]
fn the_same_seed_flies_the_same_flight() {
    let gusts = Some(Gusts { std: 1.0, correlation: 1.0 });
    let conditions = Conditions { wind: Vector3::x(), gusts, noise: true, ..Default::default() };
    let points = [[5.0, 5.0, 5.0], [9.0, 7.0, 6.0]];
    let fly = |seed| fly_with(&flightgoggles(), &cage(), &points, &conditions, seed);
    assert_eq!(fly(1), fly(1));
    assert_ne!(fly(1).track, fly(2).track);
}

/// Flies with a controller and settings of its own.
fn fly_as(kind: ControllerKind, world: &World, points: &[[f64; 3]], settings: &FlySettings) -> Flight {
    let waypoints: Vec<Point3<f64>> = points.iter().copied().map(Point3::from).collect();
    let robot = flightgoggles();
    let sortie = Sortie { robot: &robot, world, waypoints: &waypoints, profile: None };
    let controller = ControllerSettings { kind, ..Default::default() };
    fly(&sortie, &controller, &Conditions::default(), settings, 1).unwrap()
}

#[test]
fn a_run_says_why_it_ended() {
    let (world, settings) = (cage(), FlySettings::default());
    let stable = |world: &World, points: &[[f64; 3]], settings: &FlySettings| {
        fly_as(ControllerKind::StableWaypoint, world, points, settings)
    };
    let leg = [[5.0, 5.0, 5.0], [15.0, 5.0, 5.0]];
    let done = stable(&world, &leg, &settings);
    assert_eq!(done.ended, Ended::Done);
    let (end, last) = (*done.track.times().last().unwrap(), done.reached[1].unwrap());
    assert!((end - last - 2.0).abs() < 1e-9 && done.reached[0] == Some(0.0));

    let late = stable(&world, &leg, &FlySettings { time_limit: 1.0, ..settings });
    assert_eq!((late.ended, late.reached[1]), (Ended::Time, None));
    assert!((late.track.times().last().unwrap() - 1.0).abs() < 1e-9);

    let dive = stable(&world, &[[5.0, 5.0, 5.0], [5.0, 5.0, -3.0]], &settings);
    assert_eq!(dive.ended, Ended::Ground);
    assert!(dive.track.position(dive.track.len() - 1).z < 0.0);

    let ball = Shape::Sphere { center: Point3::new(10.0, 5.2, 5.0), radius: 0.1 };
    let blocked = World::new(Vector3::repeat(30.0), 0.0, vec![Obstacle { name: "ball".into(), shape: ball }]).unwrap();
    let hit = stable(&blocked, &leg, &settings);
    assert_eq!(hit.ended, Ended::Obstacle);
    let x = hit.track.position(hit.track.len() - 1).x;
    assert!(x > 9.6 && x < 10.0, "{x}: within the clearance of 0.23 m");
    let nothing_there = stable(&blocked, &leg, &FlySettings { obstacles: false, ..settings });
    assert_eq!(nothing_there.ended, Ended::Done);

    let out = [[5.0, 5.0, 5.0], [5.0, -3.0, 5.0]];
    let left = stable(&world, &out, &settings);
    assert!(left.ended == Ended::Done && left.left_world.is_some_and(|t| t > 0.5));
    let wall = stable(&world, &out, &FlySettings { walls: true, ..settings });
    assert_eq!((wall.ended, wall.left_world), (Ended::Wall, left.left_world));
}

/// A floor-level start, as the paper's authors have it, is no crash.
#[test]
fn a_take_off_from_the_floor_is_no_crash() {
    for height in [0.0, 0.1] {
        let points = [[0.1, 0.1, height], [5.0, 5.0, 5.0]];
        let flight = fly_as(ControllerKind::UnstableWaypoint, &cage(), &points, &FlySettings::default());
        assert!(flight.ended == Ended::Done, "{:?}", flight.ended);
    }
}

#[test]
fn turning_over_and_numbers_without_end_are_tumbles() {
    let world = cage();
    let at = Vector3::new(5.0, 5.0, 5.0);
    let mut hazards = hazard::Hazards::new(0.2, &FlySettings::default(), &at);
    assert_eq!(hazards.note(&world, 0.0, &at, -0.5), None);
    assert_eq!(hazards.note(&world, 0.4, &at, -0.5), None);
    assert_eq!(hazards.note(&world, 0.6, &at, -0.5), Some(Ended::Tumble));
    assert_eq!(hazards.note(&world, 0.7, &Vector3::new(f64::NAN, 0.0, 0.0), 1.0), Some(Ended::Tumble));
    // Rotors too close to the centre to hold the body against the moments: it turns over, high above the ground.
    let mut robot = Quadrotor { moment_noise: 1e-3, ..flightgoggles() };
    for rotor in &mut robot.rotors {
        (rotor.x, rotor.y) = (0.02 * rotor.x, 0.02 * rotor.y);
    }
    let conditions = Conditions { noise: true, ..Default::default() };
    let flight = fly_with(&robot, &world, &[[15.0, 15.0, 900.0], [5.0, 5.0, 900.0]], &conditions, 1);
    assert_eq!(flight.ended, Ended::Tumble);
    let (times, poses) = (flight.track.times(), flight.track.poses());
    let end = times[times.len() - 1];
    let upside_down = |i: usize| (poses[i].rotation * Vector3::z()).z < 0.0;
    assert!((0..times.len()).all(|i| upside_down(i) || times[i] < end - 0.505), "0.5 s before it counts");
    assert!((0..times.len()).any(|i| !upside_down(i) && times[i] > end - 0.53), "and not longer");
    // A gale that no double holds ends the run, not the program; the track has what was finite.
    let conditions = Conditions { wind: Vector3::new(1e200, 0.0, 0.0), ..Default::default() };
    let flight = fly_with(&flightgoggles(), &world, &[[5.0, 5.0, 5.0], [9.0, 5.0, 5.0]], &conditions, 1);
    assert_eq!(flight.ended, Ended::Tumble);
}

/// A tracker's leg is its reference's, and passing a waypoint by is told.
#[test]
fn a_tracker_is_judged_by_its_schedule() {
    let points = [[5.0, 5.0, 5.0], [12.0, 5.0, 5.0], [12.0, 12.0, 5.0]];
    let settings = FlySettings::default();
    let close = fly_as(ControllerKind::Geometric, &cage(), &points, &settings);
    assert_eq!(close.ended, Ended::Done);
    let legs = close.track.channel("leg").unwrap();
    assert!(legs.windows(2).all(|pair| pair[0] <= pair[1]) && legs[0] == 0.0 && *legs.last().unwrap() == 1.0);
    // The planned profile misses the middle waypoint by 3 m: leg and end still come, `done` does not.
    let waypoints = points.map(Point3::from);
    let mut missed = waypoints;
    missed[1].z += 3.0;
    let coefficients = crate::math::minimum_snap::minimum_snap(&missed, &[3.0, 3.0]).unwrap();
    let legs = coefficients.into_iter().map(|coefficients| ProfileLeg { duration: 3.0, coefficients }).collect();
    let (robot, profile, world) = (flightgoggles(), Profile { legs }, cage());
    let sortie = Sortie { robot: &robot, world: &world, waypoints: &waypoints, profile: Some(&profile) };
    let controller = ControllerSettings { kind: ControllerKind::Geometric, ..Default::default() };
    let flight = fly(&sortie, &controller, &Conditions::default(), &settings, 1).unwrap();
    assert_eq!((flight.ended, flight.reached[1]), (Ended::Time, None));
    assert!((flight.track.times().last().unwrap() - 8.0).abs() < 0.1);
    let worst = (0..flight.track.len()).map(|i| {
        let (leg, tau) = profile.locate(flight.track.times()[i]).unwrap();
        (flight.track.position(i) - profile.legs[leg].position(tau)).norm()
    });
    assert!(worst.fold(0.0, f64::max) < 0.1, "the geometric tracker follows a gentle profile within 10 cm");
}

#[test]
fn what_cannot_be_flown_is_refused_with_its_name() {
    let (robot, world) = (flightgoggles(), cage());
    let two = [Point3::new(5.0, 5.0, 5.0), Point3::new(6.0, 5.0, 5.0)];
    let refuse = |robot: &Quadrotor, waypoints: &[Point3<f64>], conditions: Conditions, settings: FlySettings| {
        let sortie = Sortie { robot, world: &world, waypoints, profile: None };
        fly(&sortie, &ControllerSettings::default(), &conditions, &settings, 1).unwrap_err().field()
    };
    let (still, default) = (Conditions::default(), FlySettings::default());
    assert_eq!(refuse(&robot, &two[..1], still, default), "waypoints");
    assert_eq!(refuse(&robot, &[two[0], Point3::new(f64::NAN, 0.0, 0.0)], still, default), "waypoints");
    assert_eq!(refuse(&robot, &two, still, FlySettings { step: 0.01, ..default }), "step");
    assert_eq!(refuse(&robot, &two, still, FlySettings { accept: f64::NAN, ..default }), "accept");
    let wind = Conditions { wind: Vector3::new(0.0, f64::INFINITY, 0.0), ..still };
    assert_eq!(refuse(&robot, &two, wind, default), "wind");
    let mut flat = robot.clone();
    flat.rotors = [flat.rotors[0]; 4];
    assert_eq!(refuse(&flat, &two, still, default), "robot.rotors");
}

/// Pushes sideways by the clock, whatever it is told.
struct Clocked;

impl Controller<Quadrotor> for Clocked {
    fn control(&mut self, _: f64, now: &FlightState, _: &Reference<Quadrotor>) -> Result<FlightCommand, Fault> {
        Ok(FlightCommand::Acceleration(Vector3::x() * (3.0 * now.t).min(2.0)))
    }
}

/// What is ordered by the clock alone is flown as much later as commands are late.
#[test]
fn late_commands_move_a_flight_in_time() {
    let (robot, world) = (flightgoggles(), cage());
    let waypoints = [[5.0, 5.0, 5.0], [25.0, 5.0, 5.0]].map(Point3::from);
    let sortie = Sortie { robot: &robot, world: &world, waypoints: &waypoints, profile: None };
    let own = OwnController::new("clocked", |_: &Quadrotor| Clocked);
    let fly = |latency| {
        let settings = FlySettings { latency, time_limit: 2.0, ..FlySettings::default() };
        crate::simulation::fly_with(&sortie, &own, &Conditions::default(), &settings, 1).unwrap().track
    };
    // A whole number of turns of the log and of the attitude loop.
    let (prompt, late) = (fly(0.0), fly(0.08));
    for i in 0..190 {
        let off = (prompt.position(i) - late.position(i + 8)).norm();
        assert!(off < 1e-9, "{i}: {off}");
    }
    assert!(prompt.position(190).x > 6.5, "it flew");
}

/// A loop of twice the bandwidth settles in half of the time, but for the inner loops, whichever controller has it.
#[test]
fn bandwidth_is_the_pace_of_a_step() {
    let (robot, world) = (flightgoggles(), cage());
    let waypoints = [[5.0, 5.0, 5.0], [5.5, 5.0, 5.0]].map(Point3::from);
    let sortie = Sortie { robot: &robot, world: &world, waypoints: &waypoints, profile: None };
    for kind in [ControllerKind::StableWaypoint, ControllerKind::Anafi] {
        let half = |bandwidth| {
            let controller = ControllerSettings { kind, bandwidth, ..Default::default() };
            let settings = FlySettings { accept: 0.001, time_limit: 20.0, ..FlySettings::default() };
            let track = fly(&sortie, &controller, &Conditions::default(), &settings, 1).unwrap().track;
            let there = (0..track.len()).find(|i| track.position(*i).x > 5.25).unwrap();
            track.times()[there]
        };
        let (slow, own) = (half(0.5), half(1.0));
        assert!((1.6..2.05).contains(&(slow / own)), "{kind:?}: {slow} s, {own} s");
    }
}
