//! What of a robot was not given decides what is proven of it: then nothing is.
//!
//! A proof from numbers that were guessed is none: `proven` becomes `not found`, with the keys named. Which keys count:
//!
//! | limit | rests on |
//! | --- | --- |
//! | speed | the top speed, where the scenario gives none that is lower |
//! | thrust, duration | mass, thrust, drag as fits told them; drag that was derived; the top speed likewise |
//! | cage, clearance | the radius, unless a point would break it as well |

use super::FlightSetup;
use crate::campaign::passage::{Broken, Certainty};

/// Keys that bound what a robot can become faster, slower or turn by; of drag those that are derived as well.
///
/// Keys that a fit has written are estimates too: they are in the robot's own table of what was estimated.
const PULL: [&str; 6] = [
    "mass_kg",
    "thrust_coefficient_n_s2",
    "rotor_speed_rad_s",
    "thrust_to_weight",
    "drag_linear_n_s_m",
    "drag_quadratic_n_s2_m2",
];
const TOP_SPEED: &str = "max_speed_m_s";
const DRAG: &str = "drag_quadratic_n_s2_m2";
const RADIUS: &str = "clearance_radius_m";

/// The keys that `broken`, if it is proven, rests on and that were not given; it is proven no more then, and says so.
pub(super) fn doubt(setup: &FlightSetup, broken: &mut Broken) -> Vec<String> {
    if broken.certainty != Certainty::Proven {
        return Vec::new();
    }
    let keys = guessed(setup, broken);
    if !keys.is_empty() {
        broken.certainty = Certainty::NotFound;
        broken.words += &format!(", by what is estimated of {}, not given: {}", setup.robot.name, keys.join(", "));
    }
    keys
}

/// What was not given of what the limit rests on.
///
/// A thrust that only its parts are derived of is given: the thrust to weight is. An excess beyond the whole radius is
/// one of a point too.
fn guessed(setup: &FlightSetup, broken: &Broken) -> Vec<String> {
    let robot = &setup.robot;
    let told = setup.scenario.robot.resolved().map(|described| &described.estimated);
    let by_logs = |key: &str| told.as_ref().is_ok_and(|told| told.contains_key(key));
    let derived = |key: &str| robot.estimated.iter().any(|known| known == key);
    let given_speed = setup.scenario.generate.limits.max_speed_m_s.unwrap_or(f64::INFINITY);
    let speed = (robot.max_speed < given_speed && derived(TOP_SPEED)).then_some(TOP_SPEED);
    let keys: Vec<&str> = match broken.limit {
        "speed" => speed.into_iter().collect(),
        "thrust" | "duration" => {
            PULL.into_iter().filter(|key| by_logs(key) || (*key == DRAG && derived(key))).chain(speed).collect()
        }
        "cage" | "clearance" => {
            let within = broken.excess.is_none_or(|excess| excess <= robot.clearance_radius);
            (within && derived(RADIUS)).then_some(RADIUS).into_iter().collect()
        }
        _ => Vec::new(),
    };
    keys.into_iter().map(str::to_owned).collect()
}
