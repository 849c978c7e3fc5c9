//! Keys of `[vary]` that no run of a boat reads.

use super::keys::BoatScenario;
use crate::campaign::check::Findings;
use crate::campaign::scenario::{CONTROLLER_KEY, KeyPath};
use crate::robot::boat::BoatDescription;
use crate::simulation::boat::BoatControllerKind;

/// A program of the user's is handed robot and world, and may read any of their keys; a controller of the user's knows
/// the nominal boat, and steers ours.
pub(super) fn check_varied(keys: &BoatScenario, robot: Option<&BoatDescription>, found: &mut Findings) {
    if keys.execute.command.is_none() {
        found.drawn_for_nobody(&keys.vary, |path| unread(path, keys, robot));
    }
}

/// Why no run reads it.
fn unread(path: &KeyPath, keys: &BoatScenario, robot: Option<&BoatDescription>) -> Option<String> {
    let within: Vec<&str> = path.segments().iter().map(String::as_str).collect();
    match within[..] {
        ["world", "keep_in_margin_m"] => Some("plans keep the margin, and none is made anew for a run".into()),
        ["robot", "speed_m_s"] => {
            Some("who steers knows the nominal boat's; execute.speed_m_s is what `line-of-sight` sails at".into())
        }
        ["robot", "radius_m" | "length_m" | "beam_m"] if keys.world.keep_out.is_empty() => {
            Some("the hull's disc meets keep-outs alone, and there are none".into())
        }
        ["robot", "length_m" | "beam_m"] if has_own_radius(keys, robot) => {
            Some("the hull's disc has a radius of its own (robot.radius_m)".into())
        }
        ["execute", "speed_m_s"] if !sails_at_a_speed(keys) => {
            let who = keys.execute.controller_word().unwrap_or_default();
            Some(format!("`{who}` has no use for it"))
        }
        _ => None,
    }
}

/// Whether every run that is drawn has a radius that does not follow from length and beam.
fn has_own_radius(keys: &BoatScenario, robot: Option<&BoatDescription>) -> bool {
    robot.is_some_and(|boat| boat.radius_m.is_some()) || keys.vary.contains_key("robot.radius_m")
}

/// Whether `line-of-sight` steers, or may be drawn to.
fn sails_at_a_speed(keys: &BoatScenario) -> bool {
    let ours = keys.execute.controller_in_force();
    ours == Some(BoatControllerKind::LineOfSight) || keys.vary.contains_key(CONTROLLER_KEY)
}
