//! A controller of the caller's own in a campaign: executed, searched against, shrunk with and named as ours are.

use std::sync::Mutex;

use crate::campaigns::{ENDLESS, asked, of, run, scenario};
use hairpin::campaign::flight::FlightSetup;
use hairpin::campaign::generate::Known;
use hairpin::campaign::{
    Case, CaseResult, Run, Setup, Status, assumptions, execute, execute_run, how_obtained, judge, shrink,
};
use hairpin::robot::quadrotor::Quadrotor;
use hairpin::robot::rover::Rover;
use hairpin::simulation::ground::{DriveCommand, DriveState};
use hairpin::simulation::{
    Conditions, Controller, Fault, FlightCommand, FlightState, FlySettings, OwnController, Reference, Sortie, fly_with,
};
use serde_json::{Value, json};

/// Pulls harder from turn to turn: what it remembered of another run would show.
struct Tiring {
    strength: f64,
}

impl Controller<Quadrotor> for Tiring {
    fn control(&mut self, dt: f64, now: &FlightState, to: &Reference<Quadrotor>) -> Result<FlightCommand, Fault> {
        self.strength += 0.02 * dt;
        let pull = ((to.target() - now.position) * self.strength).cap_magnitude(6.0);
        Ok(FlightCommand::Acceleration(pull - now.velocity * 1.5))
    }
}

fn tiring() -> OwnController<Quadrotor> {
    OwnController::new("tiring", |_: &Quadrotor| Tiring { strength: 1.0 })
}

/// `wanted`, executed as `execute` says.
fn campaign(wanted: Value, execute: Value) -> Setup {
    let mut scenario = scenario("flightgoggles", 5, wanted);
    scenario["execute"] = execute;
    scenario["spec"] = json!({ "deviation": { "max_m": 0.3, "from": "leg", "corner_m": 0.0 } });
    of(scenario)
}

fn runs_of(setup: &Setup, cases: &[Case], threads: usize) -> Vec<Run> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    let runs = Mutex::new(Vec::new());
    pool.install(|| execute(setup, cases, &|_, _| true, &ENDLESS, &|run| runs.lock().expect("whole").push(run)));
    let mut runs = runs.into_inner().expect("whole");
    runs.sort_by_key(|run| (run.case, run.run));
    runs
}

#[test]
fn runs_are_those_of_a_fresh_controller_on_any_number_of_threads() {
    let ours = campaign(asked("hull", "uniform", 4), json!({ "repeat": 2, "noise": true }));
    let own = ours.clone().with_controller(tiring()).expect("a controller");
    let (cases, _) = run(&own, &Known::default());
    assert_eq!(cases, run(&ours, &Known::default()).0, "what is feasible is not the controller's business");
    let runs = runs_of(&own, &cases, 1);
    assert!(runs == runs_of(&own, &cases, 3) && runs.len() == 8 && runs != runs_of(&ours, &cases, 1));
    // The same by hand, for a run without noise.
    let quiet = campaign(asked("hull", "uniform", 4), json!({})).with_controller(tiring()).expect("a controller");
    let flight = quiet.own::<FlightSetup>().expect("a flight");
    let sortie = Sortie { robot: &flight.robot, world: &flight.world, waypoints: &cases[2].waypoints, profile: None };
    let settings = FlySettings { time_limit: 45.0, ..FlySettings::default() };
    let by_hand = fly_with(&sortie, &tiring(), &Conditions::default(), &settings, 0).expect("a flight");
    assert_eq!(execute_run(&quiet, &cases[2], 0).outcome, Ok(by_hand));
}

fn deviation(setup: &Setup, case: &Case) -> f64 {
    let result = judge(setup, case, &[execute_run(setup, case, 0)]).expect("a result");
    result.measures.expect("measures").max_deviation
}

/// Searches that execute score by the controller that was brought: in the loop, in rounds, and leg by leg.
#[test]
fn searches_execute_it() {
    let mut in_loop = asked("hull", "in-loop", 2);
    in_loop["search"]["executions"] = json!(12);
    let mut adaptive = asked("hull", "adaptive", 2);
    adaptive["search"]["executions"] = json!(40);
    let mut leg_by_leg = asked("hull", "beam", 2);
    leg_by_leg["score"] = json!("executed");
    leg_by_leg["search"]["executions"] = json!(60);
    for (name, wanted) in [("in-loop", in_loop), ("adaptive", adaptive), ("executed", leg_by_leg)] {
        let ours = campaign(wanted, json!({}));
        let own = ours.clone().with_controller(tiring()).expect("a controller");
        let (cases, _) = run(&own, &Known::default());
        assert_eq!(cases.len(), 2, "{name}");
        for case in &cases {
            assert!((case.score - deviation(&own, case)).abs() < 1e-12, "{name}: {}", case.score);
            assert!((case.score - deviation(&ours, case)).abs() > 1e-3, "{name}: not ours'");
        }
    }
}

#[test]
fn a_case_is_shrunk_with_it() {
    let own = campaign(asked("hull", "uniform", 6), json!({})).with_controller(tiring()).expect("a controller");
    let (cases, _) = run(&own, &Known::default());
    let judged = |setup: &Setup, case: &Case| judge(setup, case, &[execute_run(setup, case, 0)]).expect("a result");
    let failing = |case: &&Case| judged(&own, case).status == Status::Fail;
    let case = cases.iter().find(failing).expect("a case beyond 0.3 m");
    let mut asked_of = 0;
    let mut run = |setup: &Setup, case: &Case| {
        asked_of += 1;
        assert_eq!(setup.controller(), Some("tiring"));
        Some(judged(setup, case))
    };
    let shrunk = shrink(&own, case, &judged(&own, case), &mut run).expect("a smaller case");
    assert!(shrunk.finished && asked_of > 3 && shrunk.case.waypoints.len() <= case.waypoints.len());
    assert_eq!(judged(&own, &shrunk.case).violations, shrunk.result.violations);
}

/// Fails in its own words after a while.
struct Tired;

impl Controller<Quadrotor> for Tired {
    fn control(&mut self, _: f64, now: &FlightState, _: &Reference<Quadrotor>) -> Result<FlightCommand, Fault> {
        if now.t > 1.0 { Err("enough".into()) } else { Ok(FlightCommand::Acceleration(-now.velocity)) }
    }
}

#[test]
fn what_it_cannot_command_is_an_execution_that_failed() {
    let tired = OwnController::new("tired", |_: &Quadrotor| Tired);
    let own = campaign(asked("hull", "uniform", 1), json!({})).with_controller(tired).expect("a controller");
    let (cases, _) = run(&own, &Known::default());
    let result: CaseResult = judge(&own, &cases[0], &[execute_run(&own, &cases[0], 0)]).expect("a result");
    assert_eq!(result.status, Status::ExecutorFailed);
    assert_eq!(result.message.as_deref(), Some("run 0: controller `tired` at t = 1.01 s: enough"));
}

#[test]
fn it_is_named_wherever_ours_would_be() {
    let ours = campaign(asked("hull", "uniform", 1), json!({}));
    let own = ours.clone().with_controller(tiring()).expect("a controller");
    assert_eq!((ours.controller(), own.controller()), (Some("stable-waypoint"), Some("tiring")));
    let told = |setup: &Setup| {
        let (cases, tally) = run(setup, &Known::default());
        (how_obtained(setup).join(", "), assumptions(setup, &cases, &tally).join("\n"))
    };
    let (how, said) = told(&own);
    assert!(
        how.ends_with(", tiring on hairpin's inner loops")
            && said.contains("controller `tiring`, the caller's own, on hairpin's inner loops")
    );
    assert!(!said.contains("hairpin's own gains"), "{said}");
    let (how, said) = told(&ours);
    assert!(how.ends_with(", stable-waypoint") && said.contains("`stable-waypoint` with hairpin's own gains"));
}

#[test]
fn what_it_cannot_stand_in_for_is_refused_by_key() {
    let refused = |setup: Setup| setup.with_controller(tiring()).expect_err("a mistake").key;
    let plain = || campaign(asked("hull", "uniform", 1), json!({}));
    assert_eq!(refused(campaign(asked("hull", "uniform", 1), json!({ "command": "sim" }))), "execute.command");
    let mut varied = scenario("flightgoggles", 5, asked("hull", "uniform", 1));
    varied["vary"] = json!({ "execute.controller": { "choice": ["anafi", "geometric"] } });
    assert_eq!(refused(of(varied)), "vary.\"execute.controller\"");
    assert_eq!(refused(drives()), "execute.controller");
    let nameless = OwnController::new(" ", |_: &Quadrotor| Tired);
    assert_eq!(plain().with_controller(nameless).expect_err("a mistake").key, "execute.controller");
    assert!(plain().with_controller(OwnController::new("homing", homing)).is_err());
}

/// Steers at the next waypoint and stops at the last.
struct Homing {
    most: f64,
}

fn homing(nominal: &Rover) -> Homing {
    Homing { most: nominal.limits.curvature }
}

impl Controller<Rover> for Homing {
    fn control(&mut self, _dt: f64, now: &DriveState, to: &Reference<Rover>) -> Result<DriveCommand, Fault> {
        let (dx, dy) = (to.target().x - now.at.x, to.target().y - now.at.y);
        let left = now.at.yaw.cos() * dy - now.at.yaw.sin() * dx;
        let curvature = (2.0 * left / (dx * dx + dy * dy)).clamp(-self.most, self.most);
        let speed = if to.holds() { 0.0 } else { 0.8 };
        Ok(DriveCommand { speed, curvature, ..DriveCommand::default() })
    }
}

/// A car on flat ground, found in the loop.
fn drives() -> Setup {
    let path = format!("{}/../../data/robots/ground/car.toml", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(path).expect("a shipped robot");
    let robot: Value = toml::from_str(&text).expect("its keys");
    let search = json!({ "method": "in-loop", "waypoints": 24, "cases": 2, "executions": 8 });
    of(json!({
        "hairpin": 1, "robot": robot, "seed": 7,
        "world": { "terrain": { "generator": "flat", "size_m": 30, "cell_m": 0.5 } },
        "task": { "start": { "x_m": 15, "y_m": 15 }, "length": 4, "leg_m": [2, 5] },
        "generate": { "reach": "witness", "headings": 2, "search": search, "limits": { "speed_m_s": 1.0 } },
        "execute": { "controller": "stanley" },
    }))
}

#[test]
fn drives_are_searched_with_it_too() {
    let own = drives().with_controller(OwnController::new("homing", homing)).expect("a controller");
    assert_eq!(own.controller(), Some("homing"));
    let (cases, tally) = run(&own, &Known::default());
    assert_eq!(cases.len(), 2);
    for case in &cases {
        assert!((case.score - deviation(&own, case)).abs() < 1e-12, "{} {}", case.score, deviation(&own, case));
        assert!((case.score - deviation(&drives(), case)).abs() > 1e-3);
    }
    let said = assumptions(&own, &cases, &tally).join("\n");
    assert!(said.contains("controller `homing`, the caller's own, knows the nominal vehicle and the plan"), "{said}");
}
