//! A campaign that looks like one: flights that overshoot their waypoints in a cage with a mast, judged for real.

use hairpin::campaign::flight::FlightSetup;
use hairpin::campaign::{Case, CaseNumber, CaseResult, Evidence, Run, Scenario, Setup, Status, Tally};
use hairpin::judgement::{Claim, Judged, Limits, Settings, Verdict, Worst, measure, violations};
use hairpin::math::random::case_seed;
use hairpin::trajectory::{Channel, Ended, Flight, Track};
use nalgebra::{Isometry3, Point3, Translation3, UnitQuaternion, Vector3};
use serde_json::json;

use super::Campaign;

pub(crate) fn scenario() -> Scenario {
    let rotor = |x: f64, y: f64, spin: f64| json!({"x_m": x, "y_m": y, "spin": spin});
    serde_json::from_value(json!({
        "hairpin": 1,
        "seed": 10,
        "robot": {
            "kind": "quadrotor", "name": "anafi", "caveat": "a stand-in", "mass_kg": 0.8,
            "rotors": [rotor(0.2, 0.0, 1.0), rotor(0.0, 0.2, -1.0), rotor(-0.2, 0.0, 1.0), rotor(0.0, -0.2, -1.0)],
            "inertia_kg_m2": [2.32e-3, 2.32e-3, 4.0e-3], "thrust_coefficient_n_s2": 1.91e-6,
            "moment_coefficient_n_m_s2": 2.6e-7, "rotor_speed_rad_s": [0.0, 2200.0], "max_speed_m_s": 15.0,
            "clearance_radius_m": 0.25,
        },
        "world": {
            "size_m": [30.0, 30.0, 30.0],
            "obstacles": [
                {"name": "mast <1>", "box": {"center_m": [12.0, 8.0, 5.0], "size_m": [2.0, 2.0, 10.0]}},
                {"name": "balloon", "sphere": {"center_m": [22.0, 20.0, 12.0], "radius_m": 2.0}},
                {"name": "beam", "capsule": {"a_m": [4.0, 24.0, 3.0], "b_m": [12.0, 27.0, 9.0], "radius_m": 0.6}},
            ],
        },
        "task": {"start_m": [3.0, 3.0, 3.0], "end_m": [15.0, 15.0, 15.0], "length": 10},
        "generate": {"search": {"cases": 24}},
        "execute": {"controller": "minimum-snap", "repeat": 5},
        "spec": {"deviation": {"max_m": 0.5, "from": "leg", "corner_m": 1.0}},
    }))
    .unwrap()
}

pub(crate) fn verdict(results: &[CaseResult]) -> Verdict {
    let count = |status| results.iter().filter(|result| result.status == status).count();
    let worst = hairpin::campaign::report::worst_first(results)[0];
    let case = worst.case.to_string();
    hairpin::judgement::verdict(&Judged {
        how: &["simulated", "anafi stand-in", "minimum-snap"],
        cases: results.len(),
        failed: count(Status::Fail),
        executor_failed: count(Status::ExecutorFailed),
        worst: worst.violations.first().map(|value| Worst { case: &case, value, saturation: Some(0.31) }),
        claims: &[Claim { word: "witnessed", count: results.len() }],
        ..Judged::default()
    })
}

pub(crate) fn judged(setup: &Setup, count: usize) -> Campaign {
    let cases: Vec<Case> = (0..count).map(case).collect();
    let (mut runs, mut results) = (Vec::new(), Vec::new());
    for case in &cases {
        let (flight, result) = fly(setup, case);
        results.push(result);
        let drawn = vec![("world.wind_m_s".into(), json!([1.25, -0.5, 0.0]))];
        runs.push(Run { case: case.number, run: 0, drawn, outcome: flight, full_rate: None });
    }
    let tally = Tally { graphs: count as u64 + 3, solved: count as u64, complete: true, ..Tally::default() };
    Campaign { cases, runs, results, tally }
}

fn unit(case: usize, index: usize) -> f64 {
    case_seed(case as u64, index as u64) as f64 / u64::MAX as f64
}

fn case(number: usize) -> Case {
    let inner = |k: usize| Point3::from(std::array::from_fn(|axis| 4.0 + 22.0 * unit(number, 3 * k + axis)));
    let mut waypoints: Vec<Point3<f64>> = (1..9).map(inner).collect();
    waypoints.insert(0, Point3::new(3.0, 3.0, 3.0));
    waypoints.push(Point3::new(15.0, 15.0, 15.0));
    let leg_times: Vec<f64> = waypoints.windows(2).map(|w| (w[1] - w[0]).norm() / 4.0 + 1.0).collect();
    Case {
        graph: number as u64,
        leg_times,
        score: 5.0 + unit(number, 99),
        evidence: Evidence::HullFeasible,
        ..Case::bare(CaseNumber(number), case_seed(10, number as u64), waypoints)
    }
}

/// Straight legs at constant speed.
fn plan(case: &Case, t: f64) -> (usize, Point3<f64>) {
    let mut start = 0.0;
    for (leg, duration) in case.leg_times.iter().enumerate() {
        if t < start + duration {
            let s = (t - start) / duration;
            let (a, b) = (case.waypoints[leg], case.waypoints[leg + 1]);
            return (leg, a + (b - a) * s);
        }
        start += duration;
    }
    (case.leg_times.len() - 1, case.waypoints[case.waypoints.len() - 1])
}

pub(crate) fn planned(case: &Case) -> Track {
    let times: Vec<f64> = (0..).map(|i| i as f64 * 0.01).take_while(|t| *t <= case.leg_times.iter().sum()).collect();
    let samples: Vec<_> = times.iter().map(|t| plan(case, *t)).collect();
    let poses = samples.iter().map(|(_, p)| Isometry3::from(Translation3::from(p.coords))).collect();
    let leg = Channel { name: "leg".into(), values: samples.iter().map(|(leg, _)| *leg as f64).collect() };
    Track::new(times, poses, vec![leg]).unwrap()
}

/// A spring and damper behind the plan: it cuts corners and swings over them, more so in some cases than in others.
fn fly(setup: &Setup, case: &Case) -> (Result<Flight, String>, CaseResult) {
    let nobody = |outcome, measures, message| CaseResult {
        case: case.number,
        status: Status::ExecutorFailed,
        run: 0,
        measures,
        of_runs: None,
        ended: outcome,
        left_world: None,
        violations: vec![],
        elsewhere: vec![],
        drawn: vec![],
        message,
        reruns: None,
        draws: None,
    };
    if case.number == CaseNumber(5) {
        let why = "time-out 60 s\nSegmentation fault <core dumped>".to_owned();
        return (Err(why.clone()), nobody("executor-failed".into(), None, Some(why)));
    }
    let flight = flight(case);
    let corner = Settings { corner: 1.0, ..Settings::default() };
    let FlightSetup { world, robot, .. } = setup.own::<FlightSetup>().unwrap();
    let clearance = |p: &Point3<f64>| world.obstacle_distance(p) - robot.clearance_radius;
    let settings = Settings { clearance: Some(&clearance), ..corner };
    let measures = measure(&flight.track, &case.waypoints, &settings).unwrap();
    let limits = Limits { deviation: Some(0.5), ..Limits::default() };
    let found = violations(&measures, &flight, &limits);
    let status = if found.is_empty() { Status::Pass } else { Status::Fail };
    let drawn = vec![("world.wind_m_s".into(), json!([1.25, -0.5, 0.0]))];
    let result =
        CaseResult { status, violations: found, drawn, ..nobody(flight.ended.word().into(), Some(measures), None) };
    (Ok(flight), result)
}

fn flight(case: &Case) -> Flight {
    let (damping, step) = (0.45 + 0.5 * unit(case.number.0, 77), 0.002);
    let duration = case.leg_times.iter().sum::<f64>() + 2.0;
    let (mut p, mut v) = (case.waypoints[0], Vector3::zeros());
    let (mut times, mut poses) = (vec![], vec![]);
    let mut columns: Vec<Vec<f64>> = vec![vec![]; 9];
    for i in 0..(duration / step) as usize {
        let t = i as f64 * step;
        let (leg, goal) = plan(case, t);
        let pull = (goal - p) * 9.0 - v * (6.0 * damping) + (plan(case, t + 0.05).1 - goal) * (20.0 * 6.0 * damping);
        if i % 5 == 0 {
            let tilt = UnitQuaternion::from_euler_angles(-0.05 * pull.y, 0.05 * pull.x, 0.3);
            times.push(t);
            poses.push(Isometry3::from_parts(Translation3::from(p.coords), tilt));
            let swing = |k: f64| {
                (1010.0 + 38.0 * (pull.z + k * pull.x - k * pull.y) + 6.0 * (37.0 * t * k).sin()).clamp(0.0, 2200.0)
            };
            let values = [leg as f64, v.x, v.y, v.z, swing(1.0), swing(-1.0), swing(0.6), swing(-0.6)];
            let saturated = if pull.norm() > 9.0 { 0.25 } else { 0.0 };
            for (column, value) in columns.iter_mut().zip(values.into_iter().chain([saturated])) {
                column.push(value);
            }
        }
        v += pull * step;
        p += v * step;
    }
    let names = [
        "leg",
        "vx_m_s",
        "vy_m_s",
        "vz_m_s",
        "rotor1_rad_s",
        "rotor2_rad_s",
        "rotor3_rad_s",
        "rotor4_rad_s",
        "saturated",
    ];
    let channels = names.iter().zip(columns).map(|(name, values)| Channel { name: (*name).into(), values }).collect();
    let track = Track::new(times, poses, channels).unwrap();
    Flight { track, ended: Ended::Done, left_world: None, reached: vec![Some(0.0); case.waypoints.len()] }
}
