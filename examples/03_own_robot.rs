//! A robot of one's own, from its numbers to trajectories that it can fly: `cargo run --example 03_own_robot`.

use std::error::Error;

use hairpin::campaign::generate::Known;
use hairpin::campaign::{Case, OwnSimulator, Scenario, Setup, Stop, generate, verify};
use serde_json::json;

fn main() -> Result<(), Box<dyn Error>> {
    let rotor = |x: f64, y: f64, spin: f64| json!({ "x_m": x, "y_m": y, "spin": spin });
    let robot = json!({
        "kind": "quadrotor", "name": "mine", "mass_kg": 0.5, "thrust_to_weight": 2.4, "max_speed_m_s": 12.0,
        "rotors": [rotor(0.1, 0.1, 1.0), rotor(-0.1, 0.1, -1.0), rotor(-0.1, -0.1, 1.0), rotor(0.1, -0.1, -1.0)],
    });
    let scenario = json!({
        "hairpin": 1, "robot": robot, "seed": 7,
        "world": { "size_m": [20, 20, 20], "keep_in_margin_m": 1.0 },
        "task": { "start_m": [3, 3, 3], "end_m": [12, 12, 12], "length": 5 },
        "generate": {
            "reach": "witness", "limits": { "max_speed_m_s": 8.0, "max_tilt_deg": 45 },
            "search": { "method": "beam", "waypoints": 60, "cases": 3 },
        },
    });
    let setup = Setup::new(serde_json::from_value::<Scenario>(scenario)?)?;
    println!("{}: estimated, because nobody gave it: {}", setup.robot_name(), setup.estimated().join(", "));
    let mut cases = Vec::new();
    generate(&setup, &Known::default(), &OwnSimulator, &Stop::never(), &mut |found, _| cases.extend_from_slice(found));
    for case in &cases {
        let planned: f64 = case.leg_times.iter().sum();
        println!("case {}: {} waypoints in {planned:.1} s, {}", case.id(), case.waypoints.len(), case.claim());
    }
    // Nobody has to believe it: independent code integrates the rotor speeds.
    let holds = |case: &&Case| verify(&setup, case).proof.is_some_and(|proof| proof.findings.is_empty());
    println!("{} of {} claims hold", cases.iter().filter(holds).count(), cases.len());
    Ok(())
}
