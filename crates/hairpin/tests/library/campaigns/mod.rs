//! Small campaigns to check by equations of the tests' own. Not every test asks everything of them.

use hairpin::campaign::flight::FlightSetup;
use hairpin::campaign::generate::Known;
use hairpin::campaign::{Case, OwnSimulator, Scenario, Setup, Stop, Tally, generate, verify};
use hairpin::robot::quadrotor::QuadrotorDescription;
use nalgebra::{Point3, Vector3};
use serde_json::{Value, json};

pub(crate) fn robot(name: &str) -> Value {
    let path = format!("{}/../../data/robots/quadrotor/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(&path).expect("shipped robots are in data/robots/quadrotor");
    serde_json::to_value(toml::from_str::<QuadrotorDescription>(&text).expect(name)).expect(name)
}

/// A small campaign in a cage with a mast; `generate` is put over the section's own values.
pub(crate) fn scenario(name: &str, length: usize, generate: Value) -> Value {
    json!({
        "hairpin": 1, "robot": robot(name), "seed": 7,
        "world": { "size_m": [20, 20, 20], "keep_in_margin_m": 1.0,
            "obstacles": [{ "name": "mast", "box": { "center_m": [8, 7, 5], "size_m": [1, 1, 10] } }] },
        "task": { "start_m": [3, 3, 3], "end_m": [12, 12, 12], "length": length },
        "generate": generate,
    })
}

pub(crate) fn of(scenario: Value) -> Setup {
    Setup::new(serde_json::from_value::<Scenario>(scenario).expect("a scenario")).expect("a campaign")
}

pub(crate) fn setup(name: &str, length: usize, generate: Value) -> Setup {
    of(scenario(name, length, generate))
}

pub(crate) fn asked(reach: &str, method: &str, cases: usize) -> Value {
    let limits = json!({ "max_speed_m_s": 8.0, "max_tilt_deg": 45, "max_flight_time_s": 60 });
    let search = json!({ "method": method, "waypoints": 60, "width": 5, "cases": cases });
    json!({ "reach": reach, "resolution": 3, "velocities": 4, "search": search, "limits": limits })
}

pub(crate) const ENDLESS: Stop = Stop { cancelled: &|| false, progress: &|_, _| {}, clock: &|| 0.0 };

pub(crate) fn run(setup: &Setup, known: &Known) -> (Vec<Case>, Tally) {
    let mut cases = known.cases.clone();
    let tally = generate(setup, known, &OwnSimulator, &ENDLESS, &mut |new, _| cases.extend_from_slice(new));
    (cases, tally)
}

/// Convex-hull membership by projection (Gilbert's algorithm): the distance of `d` from the hull of `points`.
pub(crate) fn distance_to_hull(points: &[Vector3<f64>], d: &Vector3<f64>) -> f64 {
    let mut nearest = points[0];
    for _ in 0..200_000 {
        let towards = d - nearest;
        let support = points.iter().max_by(|a, b| a.dot(&towards).total_cmp(&b.dot(&towards))).expect("not empty");
        let edge = support - nearest;
        // No point of the hull lies farther towards `d` by more than this: the gap bounds what is left to gain.
        if edge.dot(&towards) <= 1e-6 * towards.norm() || towards.norm() < 1e-3 {
            break;
        }
        nearest += edge * (edge.dot(&towards) / edge.norm_squared()).clamp(0.0, 1.0);
    }
    (d - nearest).norm()
}

/// Distance of a point from the mast's surface, from its six planes.
pub(crate) fn from_mast(p: &Point3<f64>) -> f64 {
    let out = Vector3::new((p.x - 8.0).abs() - 0.5, (p.y - 7.0).abs() - 0.5, (p.z - 5.0).abs() - 5.0);
    out.map(|c| c.max(0.0)).norm()
}

/// The witness proves itself to independent code; between its ends it keeps clear and below the cap.
pub(crate) fn check_witness(setup: &Setup, case: &Case, what: &str) {
    let proof = verify(setup, case).proof.expect("a witnessed case has a proof");
    assert!(proof.findings.is_empty(), "{what}: {:?}", proof.findings);
    let radius = setup.own::<FlightSetup>().expect("a flight").robot.clearance_radius;
    for leg in &case.profile().expect("a witness").legs {
        for k in 0..=1000 {
            let t = leg.duration * f64::from(k) / 1000.0;
            let horner = |c: &[f64; 8]| c.iter().rev().fold(0.0, |sum, c| sum * t + c);
            let slope = |c: &[f64; 8]| (1..8).rev().fold(0.0, |sum, i| sum * t + i as f64 * c[i]);
            let p = Point3::from(leg.coefficients.each_ref().map(horner));
            let v = Vector3::from(leg.coefficients.each_ref().map(slope));
            assert!(v.norm() <= 8.0 + 1e-9, "{what}: {} m/s", v.norm());
            assert!(from_mast(&p) >= radius - 1e-9, "{what}: {p}");
            assert!(p.iter().all(|c| (1.0 - 1e-9..=19.0 + 1e-9).contains(c)), "{what}: {p}");
        }
    }
}
