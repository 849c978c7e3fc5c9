//! Keys of `[vary]` that no run of a drive reads.

use crate::campaign::check::Findings;
use crate::campaign::scenario::{DriveScenario, GeneratorName, GroundDescription, KeyPath};

/// What the plan keeps to, and the vehicle does not know.
const OF_THE_PLAN: [&str; 3] = ["tilt_deg", "joint_deg", "curvature_rate_1_m2"];
/// What the wheels may do, and which of them steer.
const OF_THE_WHEELS: [&str; 5] =
    ["steer_limit_deg", "steer_rate_deg_s", "speed_rad_s", "acceleration_rad_s2", "effective_track_m"];
/// What makes the ground that a generator makes, and of flat ground nothing but its edge, which plans know.
const OF_THE_GROUND: [&str; 3] = ["seed", "size_m", "cell_m"];
/// What a vehicle of one axle needs its outline for: the disc that keep-outs are grown by.
const OF_THE_OUTLINE: [&str; 3] = ["length_m", "width_m", "radius_m"];

/// A program of the user's is handed the robot, and may read any of its keys; a controller of the user's knows the
/// nominal one, and steers ours.
pub(super) fn check(keys: &DriveScenario, robot: Option<&GroundDescription>, found: &mut Findings) {
    if keys.execute.command.is_none() {
        found.drawn_for_nobody(&keys.vary, |path| unread(path, keys, robot));
    }
}

/// Why no run reads it.
fn unread(path: &KeyPath, keys: &DriveScenario, robot: Option<&GroundDescription>) -> Option<&'static str> {
    let within: Vec<&str> = path.segments().iter().map(String::as_str).collect();
    let terrain = &keys.world.terrain;
    match within[..] {
        ["robot", "limits", limit] if OF_THE_PLAN.contains(&limit) => {
            Some("plans keep this limit, and none is made anew for a run")
        }
        ["robot", "wheels", part] if OF_THE_WHEELS.contains(&part) => {
            Some("plans keep what the wheels may do, and none is made anew for a run")
        }
        ["robot", "steering"] => Some("plans ask which wheels steer, and none is made anew for a run"),
        ["robot", "speed_m_s"] => Some("plans command it, and none is made anew for a run"),
        ["robot", part] if OF_THE_OUTLINE.contains(&part) && !has_places(keys) => {
            Some("it grows keep-outs, and there are none")
        }
        ["robot", "response", "latency_s"] if is_late(keys) => Some("execute.latency_s takes its place"),
        ["robot", "mass_kg" | "slip_load_exponent"] if is_weightless(keys, robot) => {
            Some("without robot.forces, robot.wheels.torque_n_m and a load nothing weighs")
        }
        ["world", "terrain", part] if OF_THE_GROUND.contains(&part) && is_flat(keys) => {
            Some("flat ground is the same wherever it is, and plans know its edge")
        }
        ["world", "terrain", "no_data"] if terrain.generator.is_some() => Some("generated ground has data everywhere"),
        _ => None,
    }
}

/// Whether there may be anything to keep out of: the world's, or what a search places.
fn has_places(keys: &DriveScenario) -> bool {
    let placed = keys.generate.environment.and_then(|asked| asked.obstacles);
    !keys.world.keep_out.is_empty() || placed.is_some()
}

/// Whether every run that is drawn has the scenario's latency.
fn is_late(keys: &DriveScenario) -> bool {
    keys.execute.latency_s.is_some() || keys.vary.contains_key("execute.latency_s")
}

/// Whether the ground is flat in every run.
fn is_flat(keys: &DriveScenario) -> bool {
    keys.world.terrain.generator == Some(GeneratorName::Flat) && !keys.vary.contains_key("world.terrain.generator")
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
