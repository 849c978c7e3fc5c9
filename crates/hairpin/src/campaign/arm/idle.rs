//! Keys of arms that no run reads: given, they are told to be passed over; drawn, they are refused.

use serde_json::{Value, json};

use super::ArmSetup;
use crate::campaign::check::Findings;
use crate::campaign::kind::PassedOver;
use crate::campaign::scenario::{ArmExecute, ArmScenario, KeyPath};

const OWN_LAGS: &str = "the arm has lags of its own (robot.joints.lag_s)";
const OF_PROGRAMS: &str = "it is how controllers tell programs, which only what reads and writes them looks at";
const NO_FAULT: &str = "neither execute.faults.backlash_deg nor execute.faults.slower says what is wrong with the axis";
const RECORDED: &str = "runs come from execute.logs, and none is simulated";

/// Keys under `execute` that are given and that nobody reads.
pub(super) fn passed_over(setup: &ArmSetup) -> Vec<PassedOver> {
    let (execute, usual) = (&setup.scenario.execute, ArmExecute::default());
    let lag = setup.station.arm.lags.is_some() && execute.servo_lag_s != usual.servo_lag_s;
    let noise = execute.logs.is_some() && execute.noise_mm != usual.noise_mm;
    let lag = lag.then(|| ("servo_lag_s", json!(execute.servo_lag_s), OWN_LAGS));
    let noise = noise.then(|| ("noise_mm", json!(execute.noise_mm), RECORDED));
    let axis = execute.faults.axis.filter(|_| !has_fault_of_axis(&setup.scenario));
    let axis = axis.map(|axis| ("faults.axis", json!(axis), NO_FAULT));
    let all = lag.into_iter().chain(noise).chain(axis);
    let told = |(key, value, why): (&str, Value, &str)| PassedOver {
        key: format!("execute.{key}"),
        value: value.to_string(),
        why: why.to_owned(),
    };
    all.map(told).collect()
}

/// A run reads who executes, the limits, and of the robot its joints. What moves were proven clear of is not looked at
/// again: drawn, it would be told of runs that never saw it.
pub(super) fn check_varied(keys: &ArmScenario, found: &mut Findings) {
    let bound = "a key that runs of an arm read: of `execute`, of `spec`, or of `robot.joints`, `robot.opw`, `robot.chain`; cell, points \
                 and moves are searched and proven once, as they stand";
    for key in keys.vary.keys() {
        let path = KeyPath::parse(key);
        let within = path.as_ref().map_or(&[][..], KeyPath::segments);
        let is_unread = match within {
            [table, ..] if ["world", "task", "generate"].contains(&table.as_str()) => true,
            [robot, part, ..] => robot == "robot" && !["joints", "opw", "chain"].contains(&part.as_str()),
            _ => false,
        };
        found.require(!is_unread, &KeyPath::of(&["vary", key]).to_string(), format!("\"{key}\""), bound);
    }
    found.drawn_for_nobody(&keys.vary, |path| unread(path, keys));
}

/// Why no run reads it.
fn unread(path: &KeyPath, keys: &ArmScenario) -> Option<&'static str> {
    let within: Vec<&str> = path.segments().iter().map(String::as_str).collect();
    match within[..] {
        ["execute", "servo_lag_s"] if has_own_lags(keys) => Some(OWN_LAGS),
        ["execute", "faults", "axis"] if !has_fault_of_axis(keys) => Some(NO_FAULT),
        ["robot", "joints", "j23_coupled"] | ["robot", "chain", "controller_mm" | "controller_rpy_deg", ..] => {
            Some(OF_PROGRAMS)
        }
        _ => None,
    }
}

/// Whether there is anything wrong with an axis, as it is given or drawn.
fn has_fault_of_axis(keys: &ArmScenario) -> bool {
    let faults = &keys.execute.faults;
    let of_axis = ["execute.faults.backlash_deg", "execute.faults.slower"];
    let is_drawn = |key: &String| {
        let whole = KeyPath::parse(key).map(|path| path.to_string()).unwrap_or_default();
        whole == "execute.faults" || of_axis.contains(&&whole[..])
    };
    faults.backlash_deg > 0.0 || faults.slower > 0.0 || keys.vary.keys().any(is_drawn)
}

/// Whether every run has the arm's own lags, as they are given or drawn.
fn has_own_lags(keys: &ArmScenario) -> bool {
    let given = keys.robot.resolved().is_ok_and(|arm| arm.joints.lag_s.is_some());
    given || keys.vary.keys().any(|key| key.starts_with("robot.joints.lag_s"))
}
