//! A small campaign with everything in it that a file must carry: used by the tests of what goes out.

pub(crate) mod stress;

use hairpin::campaign::{Case, CaseNumber, CaseResult, Draws, Evidence, Reruns, Run, Status, Tally};
use hairpin::judgement::Violation;
use hairpin::judgement::{LegMeasures, Measures};
use hairpin::trajectory::{Channel, Ended, Flight, Profile, ProfileLeg, Track};
use nalgebra::{Isometry3, Point3, Translation3, UnitQuaternion, Vector3};
use serde_json::json;

pub(crate) struct Campaign {
    pub(crate) cases: Vec<Case>,
    pub(crate) runs: Vec<Run>,
    pub(crate) results: Vec<CaseResult>,
    pub(crate) tally: Tally,
}

pub(crate) fn campaign() -> Campaign {
    let cases = vec![case(0, Evidence::Witnessed), case(1, Evidence::HullFeasible), case(2, Evidence::Unchecked)];
    let mut runs = Vec::new();
    for run in 0..3 {
        let drawn = if run == 0 { vec![] } else { drawn(run) };
        runs.push(Run {
            case: CaseNumber(0),
            run,
            drawn,
            outcome: Ok(flight(&cases[0], 0.1 * run as f64)),
            full_rate: None,
        });
    }
    runs.push(Run {
        case: CaseNumber(1),
        run: 0,
        drawn: vec![],
        outcome: Err("timed out after 60 s\nlog line".into()),
        full_rate: None,
    });
    runs.push(Run {
        case: CaseNumber(2),
        run: 0,
        drawn: vec![],
        outcome: Ok(flight(&cases[2], 0.05)),
        full_rate: None,
    });
    let results = vec![failed(), executor_failed(), passed()];
    let tally = Tally { graphs: 7, solved: 3, expansions: 12345, complete: false, ..Tally::default() };
    Campaign { cases, runs, results, tally }
}

fn drawn(run: usize) -> Vec<(String, serde_json::Value)> {
    vec![
        ("world.wind_m_s".into(), json!([0.1 + run as f64, -2.5, 0.0])),
        ("execute.controller".into(), json!(["anafi", "geometric"][run % 2])),
        ("execute.noise".into(), json!(run.is_multiple_of(2))),
        ("robot.mass_kg".into(), json!(0.8 + 0.1 / run as f64)),
        ("seed".into(), json!(run)),
    ]
}

fn case(number: usize, evidence: Evidence) -> Case {
    let waypoints = vec![
        Point3::new(3.0, 3.0, 3.0),
        Point3::new(9.0 + number as f64, 4.1, 7.3),
        Point3::new(14.0, 12.0, 5.0 - 0.1 / 3.0),
        Point3::new(15.0, 15.0, 15.0),
    ];
    let leg = |k: usize| ProfileLeg {
        duration: 1.3 + 0.1 * k as f64,
        coefficients: std::array::from_fn(|axis| {
            std::array::from_fn(
                |i| if i == 0 { waypoints[k][axis] } else { (axis as f64 - 0.7) / (1.0 + (i * k) as f64) },
            )
        }),
    };
    let profile = (evidence == Evidence::Witnessed).then(|| Profile { legs: (0..3).map(leg).collect() });
    Case {
        graph: 11 * number as u64,
        leg_times: if number == 2 { vec![] } else { vec![1.3, 1.4, 1.5] },
        score: 2.0 / 3.0 + number as f64,
        bound: (number != 1).then_some(4.0),
        evidence,
        certified: (number == 1).then_some("unknown"),
        witness: profile.map(Into::into),
        ..Case::bare(CaseNumber(number), 0xFEDC_BA98_7654_3210 - number as u64, waypoints)
    }
}

/// A tilted, turning flight along the case's legs, `off` metres beside them.
pub(crate) fn flight(case: &Case, off: f64) -> Flight {
    let per_leg = 40;
    let legs = case.waypoints.len() - 1;
    let (mut times, mut poses, mut leg_numbers, mut speed) = (vec![], vec![], vec![], vec![]);
    for k in 0..legs {
        for i in 0..per_leg {
            let s = i as f64 / per_leg as f64;
            let p = case.waypoints[k] + (case.waypoints[k + 1] - case.waypoints[k]) * s;
            let side = off * (std::f64::consts::PI * s).sin();
            let turn = UnitQuaternion::from_euler_angles(0.3 * s, -0.2, 0.9 + 0.1 * k as f64);
            times.push((k * per_leg + i) as f64 * 0.1);
            poses.push(Isometry3::from_parts(Translation3::from(p.coords + Vector3::new(side, -side, side)), turn));
            leg_numbers.push(k as f64);
            speed.push(1.0 + s);
        }
    }
    let channel = |name: &str, values: Vec<f64>| Channel { name: name.into(), values };
    let rotor = |i: usize| {
        channel(&format!("rotor{i}_rad_s"), times.iter().map(|t| 1000.0 + 50.0 * (t * i as f64).sin()).collect())
    };
    let mut channels = vec![
        channel("leg", leg_numbers),
        channel("vx_m_s", speed.clone()),
        channel("vy_m_s", speed.iter().map(|v| -0.5 * v).collect()),
        channel("vz_m_s", speed.iter().map(|v| 0.25 * v).collect()),
    ];
    channels.extend((1..=4).map(rotor));
    channels.push(channel("saturated", times.iter().map(|t| if *t > 9.0 { 0.5 } else { 0.0 }).collect()));
    let reached = (0..=legs).map(|k| (k < legs).then_some((k * per_leg) as f64 * 0.1)).collect();
    let track = Track::new(times, poses, channels).unwrap();
    Flight { track, ended: Ended::Time, left_world: (off > 0.0).then_some(8.5), reached }
}

pub(crate) fn planned(case: &Case) -> Track {
    flight(case, 0.0).track
}

fn measures(deviation: f64) -> Measures {
    let leg = |k: usize| LegMeasures {
        max_deviation: deviation / (k + 1) as f64,
        mean_deviation: deviation / 3.0,
        max_acceleration: 4.0 + k as f64,
        time: 4.0,
        overshoot: 0.1 * k as f64,
        min_clearance: None,
        min_tip_over_margin: Some(7.25 + k as f64),
        max_tilt: Some(20.5 + k as f64),
        saturation_share: Some(0.25),
        joint_effort: Some(1.5 + k as f64),
        lateness: None,
    };
    Measures {
        max_deviation: deviation,
        t_worst: 12.34,
        leg_worst: 2,
        mean_deviation: deviation / 3.0,
        max_acceleration: 6.0,
        t_acceleration: 1.0,
        max_speed_rate: 5.5,
        total_time: 12.0,
        overshoots: vec![0.0, 0.1, 0.2],
        t_overshoot: 9.0,
        min_clearance: Some(1.25),
        t_clearance: 2.0,
        min_tip_over_margin: Some(7.25),
        t_tip_over_margin: 3.0,
        max_tilt: Some(22.5),
        t_tilt: 4.0,
        saturation_share: Some(0.31),
        joint_effort: Some(7.5),
        legs: (0..3).map(leg).collect(),
        ..Measures::default()
    }
}

pub(crate) fn failed() -> CaseResult {
    let deviation =
        Violation { what: "deviation".into(), value: 0.65, limit: 0.5, unit: "m".into(), at: 12.34, leg: 2 };
    let left = Violation { what: "left-world".into(), value: 8.5, limit: 0.0, unit: "s".into(), at: 8.5, leg: 2 };
    CaseResult {
        case: CaseNumber(0),
        status: Status::Fail,
        run: 2,
        measures: Some(measures(0.65)),
        // Another run took the worst of other measures.
        of_runs: Some(Box::new(measures(0.65).worst_of_each(&measures(0.8)))),
        ended: "time".into(),
        left_world: Some(8.5),
        violations: vec![deviation, left],
        elsewhere: vec!["run 1: overshoot 0.60 m > 0.50 m at t=3.00 s".into()],
        drawn: drawn(2),
        message: None,
        // A violation that was run again keeps what came of it.
        reruns: Some(Reruns { violated: 3, of: 10 }),
        draws: Some(Draws { violated: 2, of: 4 }),
    }
}

pub(crate) fn executor_failed() -> CaseResult {
    CaseResult {
        case: CaseNumber(1),
        status: Status::ExecutorFailed,
        run: 0,
        measures: None,
        of_runs: None,
        ended: "executor-failed".into(),
        left_world: None,
        violations: vec![],
        elsewhere: vec![],
        drawn: vec![],
        message: Some("timed out after 60 s\nlog \u{1b}[31mred\u{1b}[0m \u{7} <line> & \"quotes\"".into()),
        reruns: None,
        draws: None,
    }
}

pub(crate) fn passed() -> CaseResult {
    CaseResult {
        case: CaseNumber(2),
        status: Status::Pass,
        run: 0,
        measures: Some(measures(0.21)),
        of_runs: None,
        ended: "done".into(),
        left_world: None,
        violations: vec![],
        elsewhere: vec![],
        drawn: vec![],
        message: None,
        reruns: None,
        draws: None,
    }
}
