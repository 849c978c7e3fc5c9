//! Keys of `[vary]` that no run of a drive reads.

use crate::campaign::check::Findings;
use crate::campaign::scenario::{DriveScenario, GroundDescription, KeyPath};

/// What the plan keeps to, and the vehicle does not know.
const OF_THE_PLAN: [&str; 3] = ["tilt_deg", "joint_deg", "curvature_rate_1_m2"];

/// A program of the user's is handed the robot, and may read any of its keys.
pub(super) fn check(keys: &DriveScenario, robot: Option<&GroundDescription>, found: &mut Findings) {
    if keys.execute.controller_in_force().is_some() {
        found.drawn_for_nobody(&keys.vary, |path| unread(path, keys, robot));
    }
}

/// Why no run reads it.
fn unread(path: &KeyPath, keys: &DriveScenario, robot: Option<&GroundDescription>) -> Option<&'static str> {
    let within: Vec<&str> = path.segments().iter().map(String::as_str).collect();
    match within[..] {
        ["robot", "limits", limit] if OF_THE_PLAN.contains(&limit) => {
            Some("plans keep this limit, and none is made anew for a run")
        }
        ["robot", "mass_kg" | "slip_load_exponent"] if is_weightless(keys, robot) => {
            Some("without robot.forces, robot.wheels.torque_n_m and a load nothing weighs")
        }
        _ => None,
    }
}

/// Whether nothing that a run does depends on the mass.
fn is_weightless(keys: &DriveScenario, robot: Option<&GroundDescription>) -> bool {
    let drawn = ["robot.load_kg", "robot.forces", "robot.wheels"];
    let is_drawn = keys.vary.keys().any(|key| drawn.iter().any(|own| key.starts_with(own)));
    let weighs = match robot {
        Some(GroundDescription::Rover(rover)) => {
            rover.load_kg > 0.0 || rover.forces.is_some() || rover.wheels.torque_n_m.is_some()
        }
        _ => true,
    };
    !weighs && !is_drawn
}
