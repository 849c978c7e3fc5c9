//! Controllers that a stranger brings: what they are told, what they may ask for, and what happens when they fail.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};

use crate::ground_drives::site::{plan, plane, shipped};
use allocation_counter::measure;
use hairpin::campaign::convoy::{Convoy, Turn, columns, commands};
use hairpin::math::minimum_snap::minimum_snap;
use hairpin::robot::quadrotor::{Quadrotor, QuadrotorDescription};
use hairpin::robot::rover::Rover;
use hairpin::simulation::ground::{
    DriveCommand, DriveSettings, DriveState, GroundConditions, GroundSortie, drive_with, planned_track,
};
use hairpin::simulation::{
    Conditions, Controller, Demand, Fault, FlightCommand, FlightState, FlySettings, Misbehaviour, OwnController,
    Reference, Schedule, SimulationError, Sortie, fly_with,
};
use hairpin::trajectory::drive::{Gear, Segment};
use hairpin::trajectory::{Drive, Ended, Flight, Profile, ProfileLeg, Track};
use hairpin::world::World;
use hairpin::world::terrain::KeepOuts;
use nalgebra::{Point3, UnitQuaternion, Vector3};
use serde_json::json;

/// FlightGoggles' body without drag, so that closed forms hold.
fn robot() -> Quadrotor {
    let text = include_str!("../../../../data/robots/quadrotor/flightgoggles.toml");
    let robot = toml::from_str::<QuadrotorDescription>(text).expect("a robot file").build().expect("a robot");
    Quadrotor { drag_linear: 0.0, drag_quadratic: 0.0, ..robot }
}

/// A law of the state and the reference, as a controller.
struct Law<F>(F);

impl<F: FnMut(&FlightState, &Reference<Quadrotor>) -> FlightCommand> Controller<Quadrotor> for Law<F> {
    fn control(&mut self, _dt: f64, now: &FlightState, to: &Reference<Quadrotor>) -> Result<FlightCommand, Fault> {
        Ok((self.0)(now, to))
    }
}

fn law<F>(name: &str, law: F) -> OwnController<Quadrotor>
where
    F: FnMut(&FlightState, &Reference<Quadrotor>) -> FlightCommand + Clone + Send + Sync + 'static,
{
    OwnController::new(name, move |_: &Quadrotor| Law(law.clone()))
}

const COURSE: [[f64; 3]; 4] = [[5.0, 5.0, 5.0], [12.0, 6.0, 7.0], [6.0, 14.0, 4.0], [14.0, 14.0, 9.0]];

fn flown(controller: &OwnController<Quadrotor>, settings: &FlySettings) -> Result<Flight, SimulationError> {
    let (robot, waypoints) = (robot(), COURSE.map(Point3::from));
    let world = World::new(Vector3::repeat(30.0), 0.0, vec![]).expect("a world");
    let sortie = Sortie { robot: &robot, world: &world, waypoints: &waypoints, profile: None };
    fly_with(&sortie, controller, &Conditions::default(), settings, 1)
}

/// Acceleration of a spring and a damper towards the next waypoint.
fn pull(now: &FlightState, to: &Reference<Quadrotor>) -> Vector3<f64> {
    ((to.target() - now.position) * 2.0).cap_magnitude(8.0) - now.velocity * 2.5
}

/// Thrust (N) and attitude for an acceleration.
fn attitude(acceleration: Vector3<f64>) -> (f64, UnitQuaternion<f64>) {
    let robot = robot();
    let force = acceleration + Vector3::z() * robot.gravity;
    (force.norm() * robot.mass, Demand::along(force).attitude)
}

#[test]
fn every_form_of_command_flies_the_course() {
    let laws = [
        law("velocity", |now, to| FlightCommand::Velocity(((to.target() - now.position) * 0.9).cap_magnitude(5.0))),
        law("acceleration", |now, to| FlightCommand::Acceleration(pull(now, to))),
        law("force", |now, to| FlightCommand::Force(Demand::along(pull(now, to) + Vector3::z() * robot().gravity))),
        law("attitude", |now, to| {
            let (thrust, attitude) = attitude(pull(now, to));
            FlightCommand::Attitude { thrust, attitude }
        }),
        law("rates", |now, to| {
            let (thrust, wanted) = attitude(pull(now, to));
            let off = now.attitude.inverse() * wanted;
            FlightCommand::Rates { thrust, rates: off.imag() * (14.0 * off.w.signum()) }
        }),
    ];
    let flights = laws.map(|law| flown(&law, &FlySettings::default()).expect("a flight"));
    for flight in &flights {
        assert_eq!(flight.ended, Ended::Done);
        let last = flight.track.position(flight.track.len() - 1);
        assert!((last - Point3::from(COURSE[3])).norm() < 0.5, "{last}");
    }
    assert_eq!(flights[1], flights[2], "an acceleration is its thrust vector, to the bit");
}

/// Flies by one command for `time` s and returns the last state that the controller was told.
fn held(command: FlightCommand, time: f64) -> FlightState {
    let told = Arc::new(Mutex::new(Vec::new()));
    let seen = told.clone();
    let holds = law("holds", move |now, _| {
        seen.lock().expect("not poisoned").push(*now);
        command
    });
    let flight = flown(&holds, &FlySettings { time_limit: time, ..FlySettings::default() }).expect("a flight");
    assert_eq!(flight.ended, Ended::Time);
    let told = told.lock().expect("not poisoned");
    told[told.len() - 1]
}

#[test]
fn commands_do_what_they_say() {
    let robot = robot();
    let weight = robot.mass * robot.gravity;
    // Velocity: it is reached.
    let wanted = Vector3::new(2.0, -1.0, 0.5);
    let end = held(FlightCommand::Velocity(wanted), 2.0);
    assert!((end.velocity - wanted).norm() < 0.15, "{}", end.velocity);
    // Attitude: it is held, and its thrust accelerates by g tan φ along the tilt, once that is there.
    let tilt = UnitQuaternion::from_euler_angles(0.0, 0.2, 0.0);
    let end = held(FlightCommand::Attitude { thrust: weight / 0.2_f64.cos(), attitude: tilt }, 2.0);
    let gained = robot.gravity * 0.2_f64.tan() * end.t;
    assert!(end.attitude.angle_to(&tilt) < 1e-3 && end.rates.norm() < 1e-2, "{:?}", end);
    assert!((end.velocity.x / gained - 1.0).abs() < 0.15 && end.velocity.y.abs() < 1e-6, "{} {gained}", end.velocity);
    // Rates: the body turns with them, and what was not asked for stays.
    let end = held(FlightCommand::Rates { thrust: weight, rates: Vector3::new(0.0, 0.0, 0.5) }, 2.0);
    let (roll, pitch, yaw) = end.attitude.euler_angles();
    assert!((end.rates.z - 0.5).abs() < 0.02 && (yaw / (0.5 * end.t) - 1.0).abs() < 0.15, "{} {yaw}", end.rates);
    assert!(roll.abs() < 1e-6 && pitch.abs() < 1e-6 && (end.position.z - 5.0).abs() < 0.05);
    // A thrust that is not there is the least that there is: it falls, and keeps its moments.
    let end = held(FlightCommand::Attitude { thrust: 0.0, attitude: UnitQuaternion::identity() }, 0.8);
    assert!(end.velocity.z < -5.0 && end.attitude.angle() < 1e-6);
}

/// What a controller was told, turn by turn.
#[derive(Default)]
struct Told {
    resets: usize,
    turns: Vec<(f64, FlightState, usize, bool)>,
    planned: usize,
}

struct Listener(Arc<Mutex<Told>>);

impl Controller<Quadrotor> for Listener {
    fn period(&self) -> Option<f64> {
        Some(0.02)
    }

    fn reset(&mut self, reference: &Reference<Quadrotor>) -> Result<(), Fault> {
        let mut told = self.0.lock().expect("not poisoned");
        assert!(told.turns.is_empty() && reference.next == 1 && reference.waypoints == COURSE.map(Point3::from));
        told.resets += 1;
        Ok(())
    }

    fn control(&mut self, dt: f64, now: &FlightState, to: &Reference<Quadrotor>) -> Result<FlightCommand, Fault> {
        let mut told = self.0.lock().expect("not poisoned");
        assert!(to.accept == 1.0 && to.waypoints.len() == 4);
        told.planned = to.plan.map_or(0, |plan| plan.legs.len());
        told.turns.push((dt, *now, to.next, to.holds()));
        Ok(FlightCommand::Acceleration(pull(now, to)))
    }
}

#[test]
fn a_controller_is_told_the_state_as_it_is_logged_and_where_it_is_in_its_course() {
    let (robot, waypoints) = (robot(), COURSE.map(Point3::from));
    let world = World::new(Vector3::repeat(30.0), 0.0, vec![]).expect("a world");
    let legs = minimum_snap(&waypoints, &[3.0; 3]).expect("a curve");
    let legs = legs.into_iter().map(|coefficients| ProfileLeg { duration: 3.0, coefficients }).collect();
    let profile = Profile { legs };
    for plan in [None, Some(&profile)] {
        let told = Arc::new(Mutex::new(Told::default()));
        let own = OwnController::new("listener", {
            let told = told.clone();
            move |_: &Quadrotor| Listener(told.clone())
        });
        let sortie = Sortie { robot: &robot, world: &world, waypoints: &waypoints, profile: plan };
        let conditions = Conditions { wind: Vector3::x(), ..Conditions::default() };
        let flight = fly_with(&sortie, &own, &conditions, &FlySettings::default(), 1).expect("a flight");
        let told = told.lock().expect("not poisoned");
        assert_eq!((told.resets, told.planned), (1, plan.map_or(0, |plan| plan.legs.len())));
        let (track, reached) = (&flight.track, &flight.reached);
        for (i, (dt, now, next, holds)) in told.turns.iter().enumerate() {
            // Every other sample of the log is a turn.
            let logged = |name: &str| track.channel(name).expect("a channel")[2 * i];
            let three = |names: [&str; 3]| Vector3::from(names.map(logged));
            assert_eq!((*dt, now.t), (0.02, track.times()[2 * i]));
            assert_eq!(now.position, track.poses()[2 * i].translation.vector);
            assert_eq!(now.velocity, three(["vx_m_s", "vy_m_s", "vz_m_s"]));
            assert_eq!(now.rates, three(["p_rad_s", "q_rad_s", "r_rad_s"]));
            assert!(now.attitude.angle_to(&track.poses()[2 * i].rotation) < 1e-7);
            assert!((now.attitude.norm() - 1.0).abs() < 1e-9);
            let passed = reached.iter().filter(|at| at.is_some_and(|at| at <= now.t)).count();
            assert_eq!((*next, *holds), (passed, passed == 4), "t = {}", now.t);
        }
        assert!(told.turns.iter().any(|turn| turn.3), "it was told to hold");
    }
}

/// Follows its own clock, two seconds a leg.
struct Clocked(f64);

impl Controller<Quadrotor> for Clocked {
    fn control(&mut self, dt: f64, now: &FlightState, to: &Reference<Quadrotor>) -> Result<FlightCommand, Fault> {
        self.0 += dt;
        let goal = to.waypoints[(self.0 / 2.0) as usize % 4];
        Ok(FlightCommand::Velocity((goal.coords - now.position).cap_magnitude(1.0)))
    }

    fn schedule(&self) -> Option<Schedule> {
        Some(Schedule { leg: (self.0 / 2.0) as usize, over: self.0 > 60.0 })
    }
}

#[test]
fn a_schedule_says_which_leg_is_flown_however_far_it_runs_on() {
    let own = OwnController::new("clocked", |_: &Quadrotor| Clocked(0.0));
    let settings = FlySettings { time_limit: 10.0, ..FlySettings::default() };
    let flight = flown(&own, &settings).expect("a flight");
    let legs = flight.track.channel("leg").expect("legs");
    for (t, leg) in flight.track.times().iter().zip(legs) {
        let by_clock = (t / 2.0 - 1e-9).floor().clamp(0.0, 2.0);
        assert!(*leg == by_clock || (t / 2.0 - (t / 2.0).round()).abs() < 0.02, "t = {t}: leg {leg}");
    }
    assert_eq!((flight.ended, legs[legs.len() - 1]), (Ended::Time, 2.0));
}

#[test]
fn what_is_no_number_ends_the_run_by_the_controllers_name() {
    let nan = Vector3::new(0.0, f64::NAN, 0.0);
    let level = UnitQuaternion::identity();
    let broken = [
        FlightCommand::Velocity(nan),
        FlightCommand::Acceleration(Vector3::new(f64::INFINITY, 0.0, 0.0)),
        FlightCommand::Force(Demand { rates: nan, ..Demand::along(Vector3::z() * 9.8) }),
        FlightCommand::Force(Demand { angular_acceleration: nan, ..Demand::along(Vector3::z() * 9.8) }),
        FlightCommand::Attitude { thrust: f64::NAN, attitude: level },
        FlightCommand::Rates { thrust: 9.8, rates: -nan },
    ];
    for command in broken {
        let breaks = law(
            "breaks",
            move |now, to| {
                if now.t < 0.495 { FlightCommand::Acceleration(pull(now, to)) } else { command }
            },
        );
        match flown(&breaks, &FlySettings::default()) {
            Err(SimulationError::Controller { name, t, why: Misbehaviour::NotFinite { command } }) => {
                assert!(name == "breaks" && (t - 0.5).abs() < 1e-9, "{name} {t}");
                assert!(command.contains("NaN") || command.contains("inf"), "{command}");
            }
            other => panic!("{command:?}: {other:?}"),
        }
    }
}

/// Fails as it is told to.
struct Fails {
    period: Option<f64>,
    at_reset: bool,
}

impl Controller<Quadrotor> for Fails {
    fn period(&self) -> Option<f64> {
        self.period
    }

    fn reset(&mut self, _: &Reference<Quadrotor>) -> Result<(), Fault> {
        if self.at_reset { Err("no way through".into()) } else { Ok(()) }
    }

    fn control(&mut self, _: f64, now: &FlightState, to: &Reference<Quadrotor>) -> Result<FlightCommand, Fault> {
        if now.t > 0.2 { Err("the solver gave up".into()) } else { Ok(FlightCommand::Acceleration(pull(now, to))) }
    }
}

#[test]
fn a_controller_that_fails_is_told_in_its_own_words() {
    let told = |period, at_reset| {
        let own = OwnController::new("mpc", move |_: &Quadrotor| Fails { period, at_reset });
        flown(&own, &FlySettings::default()).expect_err("a failure").to_string()
    };
    assert_eq!(told(None, true), "controller `mpc` at t = 0 s: no way through");
    assert_eq!(told(None, false), "controller `mpc` at t = 0.21 s: the solver gave up");
    for period in [0.0, -1.0, f64::NAN, f64::INFINITY, 2.0] {
        assert!(told(Some(period), false).starts_with(&format!("controller.period = {period} (mpc)")));
    }
}

/// A flight's memory is taken when it begins: ten times as long a one allocates as often.
#[test]
fn turns_allocate_nothing() {
    let circles = law("circles", |now, _| {
        let centre = Point3::new(10.0, 10.0, 8.0);
        FlightCommand::Acceleration((centre.coords - now.position) * 0.5 - now.velocity * 0.1)
    });
    let count = |time_limit| {
        let settings = FlySettings { time_limit, ..FlySettings::default() };
        measure(|| drop(flown(&circles, &settings).expect("a flight"))).count_total
    };
    assert_eq!(count(2.0), count(20.0));
}

/// Steers at the next waypoint and stops at the last.
struct Homing {
    most: f64,
    planned: Track,
    told: Arc<Mutex<Vec<(f64, DriveState, usize)>>>,
}

impl Controller<Rover> for Homing {
    fn control(&mut self, dt: f64, now: &DriveState, to: &Reference<Rover>) -> Result<DriveCommand, Fault> {
        self.told.lock().expect("not poisoned").push((dt, *now, to.next));
        assert!(to.plan == Some(&self.planned) && to.waypoints.len() == 4);
        if to.holds() {
            return Ok(DriveCommand::default());
        }
        let (dx, dy) = (to.target().x - now.at.x, to.target().y - now.at.y);
        let left = now.at.yaw.cos() * dy - now.at.yaw.sin() * dx;
        let curvature = (2.0 * left / (dx * dx + dy * dy)).clamp(-self.most, self.most);
        Ok(DriveCommand { speed: 0.1, curvature, ..DriveCommand::default() })
    }
}

fn bends() -> Drive {
    let bend = |from, to| vec![Segment::clothoid(2.0, from, to, Gear::Forward)];
    plan(&[bend(0.0, 0.3), bend(0.3, -0.3), bend(-0.3, 0.0)], 0.1)
}

fn driven(controller: &OwnController<Rover>, vehicle: &Rover) -> Result<Flight, SimulationError> {
    let (map, none) = (plane(0.1, 0.05), KeepOuts::default());
    let plan = bends();
    let sortie = GroundSortie {
        vehicle,
        nominal: vehicle,
        terrain: &map,
        keep_outs: &none,
        clearance_radius: 0.0,
        drive: &plan,
    };
    drive_with(&sortie, controller, &GroundConditions::default(), &DriveSettings::default(), 1)
}

#[test]
fn a_drivers_controller_is_told_the_state_and_comes_to_every_waypoint() {
    for name in ["rocky8", "generic"] {
        let vehicle = shipped(name);
        let told = Arc::new(Mutex::new(Vec::new()));
        let own = OwnController::new("homing", {
            let (told, planned) = (told.clone(), planned_track(&vehicle, &plane(0.1, 0.05), &bends()).expect("a plan"));
            move |rover: &Rover| Homing { most: rover.limits.curvature, planned: planned.clone(), told: told.clone() }
        });
        let flight = driven(&own, &vehicle).expect("a drive");
        assert_eq!(flight.ended, Ended::Done, "{name}");
        let legs = flight.track.channel("leg").expect("legs");
        assert!(legs.windows(2).all(|pair| pair[0] <= pair[1]) && legs[legs.len() - 1] == 2.0);
        let (told, track) = (told.lock().expect("not poisoned"), &flight.track);
        let speeds = track.channel("speed_m_s").expect("speeds");
        let mut met = 0;
        for (dt, now, next) in told.iter() {
            let passed = flight.reached.iter().filter(|at| at.is_some_and(|at| at <= now.t)).count();
            assert!((dt - 0.1).abs() < 1e-12 && *next == passed, "{name}, t = {}: {dt} {next}", now.t);
            let Ok(i) = track.times().binary_search_by(|t| t.total_cmp(&now.t)) else { continue };
            let place = track.position(i);
            assert_eq!((now.at.x, now.at.y, now.speed), (place.x, place.y, speeds[i]), "{name}");
            assert!((now.height - place.z).abs() < 1e-9, "{name}: {} {}", now.height, place.z);
            met += 1;
        }
        assert!(met > 100, "{met} of {} turns were logged", told.len());
    }
}

/// Gives what it is made of.
struct Gives(DriveCommand);

impl Controller<Rover> for Gives {
    fn control(&mut self, _: f64, _: &DriveState, _: &Reference<Rover>) -> Result<DriveCommand, Fault> {
        Ok(self.0)
    }
}

#[test]
fn a_drivers_command_that_is_no_number_ends_the_run_by_name() {
    let vehicle = shipped("rocky8");
    let good = DriveCommand { speed: 0.1, ..DriveCommand::default() };
    for bad in [
        DriveCommand { speed: f64::NAN, ..good },
        DriveCommand { curvature: f64::INFINITY, ..good },
        DriveCommand { turn_rate: f64::NAN, ..good },
        DriveCommand { direction: f64::NEG_INFINITY, ..good },
    ] {
        let own = OwnController::new("gives", move |_: &Rover| Gives(bad));
        let error = driven(&own, &vehicle).expect_err("a failure");
        let SimulationError::Controller { name, why: Misbehaviour::NotFinite { .. }, .. } = &error else {
            panic!("{error}")
        };
        assert_eq!((name.as_str(), error.field()), ("gives", "controller"));
    }
    // Straight on misses the waypoints, and that is told.
    let own = OwnController::new("straight", move |_: &Rover| Gives(good));
    let flight = driven(&own, &vehicle).expect("a drive");
    assert!(flight.ended != Ended::Done && flight.reached.iter().any(Option::is_none), "{:?}", flight.ended);
}

/// Of a run in a convoy.
fn turn(run: u64, t_s: f64) -> Turn {
    Turn { run, t_s, state: json!({ "p_m": [t_s, 0.0] }), reference: json!({ "next": run, "p_m": null }) }
}

/// Runs of other lengths, each on its thread: every question has all that are under way, every run its own answers.
#[test]
fn all_that_are_under_way_are_asked_at_once() {
    let (convoy, questions) = (Convoy::default(), AtomicUsize::new(0));
    let runs: Vec<u64> = (0..4).map(|_| convoy.join(|_| Ok(())).unwrap()).collect();
    let ask = |asked: &[Turn]| {
        questions.fetch_add(1, Ordering::Relaxed);
        Ok(asked.iter().map(|turn| Ok(json!(turn.t_s + turn.run as f64))).collect())
    };
    std::thread::scope(|scope| {
        for run in &runs {
            let (convoy, ask) = (&convoy, &ask);
            scope.spawn(move || {
                for k in 0..5 * run {
                    assert_eq!(convoy.turn(turn(*run, k as f64), ask).unwrap(), json!(k as f64 + *run as f64));
                }
                convoy.leave();
            });
        }
    });
    assert_eq!(questions.into_inner(), 20);
}

#[test]
fn an_error_is_that_of_each_and_who_is_not_told_does_not_set_out() {
    let convoy = Convoy::default();
    assert_eq!(convoy.join(|_| Err("full".into())), Err("full".into()));
    let run = convoy.join(|_| Ok(())).unwrap();
    assert_eq!(convoy.turn(turn(run, 0.0), |_| Err("gone".into())), Err("gone".into()));
}

#[test]
fn turns_become_columns_and_columns_commands() {
    let asked = columns(&[turn(3, 0.5), turn(5, 1.5)]);
    assert_eq!(asked["runs"], json!([3, 5]));
    assert_eq!(asked["state"], json!({ "p_m": [[0.5, 0.0], [1.5, 0.0]] }));
    assert_eq!(asked["reference"], json!({ "next": [3, 5], "p_m": [null, null] }));
    let answer = json!({ "v_m_s": [[1.0, 2.0], [3.0, null]], "thrust_n": [1.0, 2.0] });
    let found = commands(answer.as_object().unwrap(), 2).unwrap();
    assert_eq!(found[0], Ok(json!({ "v_m_s": [1.0, 2.0], "thrust_n": 1.0 })));
    assert!(found[1].as_ref().is_err_and(|why| why.contains("not finite")));
    assert!(commands(answer.as_object().unwrap(), 3).unwrap_err().contains("a row for each of 3 runs"));
}
