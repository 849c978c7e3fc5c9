//! Keys of flights that no run reads: who flies has no use for them, or they say nothing of what happens.
//!
//! Given, they are told to be passed over. Drawn, they are refused, but for moving air, which is told: what
//! `hairpin new` draws, any shipped robot may meet.

use serde_json::{Value, json};

use super::FlightSetup;
use crate::campaign::check::Findings;
use crate::campaign::kind::PassedOver;
use crate::campaign::scenario::{CONTROLLER_KEY, ExecuteSection, FlightScenario, KeyPath};
use crate::robot::quadrotor::Quadrotor;
use crate::simulation::ControllerKind;

/// Keys under `execute` that few of our controllers read, and which.
///
/// What the others leave unread is told, not refused: whoever changes the controller keeps his numbers.
const OF_FEW: [(&str, &[ControllerKind]); 3] = [
    ("fixed_velocity_m_s", &[ControllerKind::FixedVelocity]),
    ("segment_times", &[ControllerKind::MinimumSnap, ControllerKind::Geometric]),
    ("goto_speed_m_s", &[ControllerKind::CrazyflieGoto]),
];
const NO_NOISE: &str = "the robot has no noise (force_noise_n2_s, moment_noise_n2_m2_s)";
const NO_DRAG: &str = "the robot has no drag (drag_linear_n_s_m, drag_quadratic_n_s2_m2), and feels no air";
const ALL_THE_SAME: &str = "the robot has no noise (force_noise_n2_s, moment_noise_n2_m2_s), the world no gusts";

/// Whether `execute.noise` does nothing to it.
///
/// Spectral densities of force and moment, both 0.
pub(super) fn is_noiseless(robot: &Quadrotor) -> bool {
    robot.force_noise <= 0.0 && robot.moment_noise <= 0.0
}

/// Whether moving air does nothing to it.
fn is_dragless(robot: &Quadrotor) -> bool {
    robot.drag_linear <= 0.0 && robot.drag_quadratic <= 0.0
}

/// Why flights of other seeds are the same flight; `None` where noise, gusts or code of the user's may differ.
///
/// A campaign need not repeat such flights: the same seed or another, the bytes are the same.
pub(super) fn repeats(setup: &FlightSetup) -> Option<&'static str> {
    let keys = &setup.scenario;
    let is_ours = setup.controller.is_none() && keys.execute.controller_in_force().is_some();
    let has_gusts = keys.world.gusts.is_some_and(|gusts| gusts.std_m_s > 0.0);
    let is_drawn = keys.vary.keys().any(|key| key.contains("gusts") || key.contains("noise"));
    (is_ours && !has_gusts && !is_drawn && is_noiseless(&setup.robot)).then_some(ALL_THE_SAME)
}

/// Keys that are given and that nobody reads.
///
/// A value that is the default counts as not given, where the section cannot tell.
pub(super) fn passed_over(setup: &FlightSetup) -> Vec<PassedOver> {
    let (keys, usual) = (&setup.scenario, ExecuteSection::default());
    let execute = &keys.execute;
    let given = [
        (execute.fixed_velocity_m_s != usual.fixed_velocity_m_s).then(|| json!(execute.fixed_velocity_m_s)),
        (execute.segment_times != usual.segment_times).then(|| json!(execute.segment_times)),
        execute.goto_speed_m_s.map(|speed| json!(speed)),
    ];
    let who = execute.controller_word().unwrap_or("a program");
    let is_idle = |of: &[ControllerKind]| !is_read(keys, of);
    let of_few = OF_FEW.iter().zip(given).filter(|((_, of), _)| is_idle(of));
    let no_use = || format!("`{who}` has no use for it");
    let of_few = of_few.filter_map(|((key, _), value)| Some((format!("execute.{key}"), value?, no_use())));
    let noise = execute.noise && execute.command.is_none() && is_noiseless(&setup.robot);
    let noise = (noise && !draws(keys, "noise_n")).then(|| ("execute.noise".into(), json!(true), NO_NOISE.to_owned()));
    let all = of_few.chain(noise).chain(air(setup));
    all.map(|(key, value, why)| PassedOver { key, value: value.to_string(), why }).collect()
}

/// Air that moves about a robot of ours which does not feel it; drawn as well, for it is what `hairpin new` draws, and
/// every shipped robot may take the place of the template's.
fn air(setup: &FlightSetup) -> impl Iterator<Item = (String, Value, String)> {
    let (keys, world) = (&setup.scenario, &setup.scenario.world);
    let is_felt = feels_air(setup);
    let given = [
        ("wind_m_s", world.wind_m_s.filter(|wind| *wind != [0.0; 3]).map(|wind| json!(wind))),
        ("gusts", world.gusts.map(|gusts| json!(gusts))),
        ("discrete_gust", world.discrete_gust.map(|gust| json!(gust))),
    ];
    let given = given.into_iter().filter_map(|(key, value)| Some((format!("world.{key}"), value?)));
    let drawn = keys.vary.iter().filter(|(key, _)| is_air(key));
    let drawn = drawn.map(|(key, draw)| (KeyPath::of(&["vary", key]).to_string(), json!(draw)));
    given.chain(drawn).filter(move |_| !is_felt).map(|(key, value)| (key, value, NO_DRAG.to_owned()))
}

/// Why no run feels what is drawn for `key`.
pub(super) fn unfelt(setup: &FlightSetup, key: &str) -> Option<&'static str> {
    (is_air(key) && !feels_air(setup)).then_some(NO_DRAG)
}

/// Whether moving air may do something to a flight. A program of the user's has physics of its own.
fn feels_air(setup: &FlightSetup) -> bool {
    let keys = &setup.scenario;
    keys.execute.command.is_some() || !is_dragless(&setup.robot) || draws(keys, "drag_")
}

/// Keys of `[world]`, whole or by a part.
fn is_air(key: &str) -> bool {
    ["world.wind_m_s", "world.gusts", "world.discrete_gust"].iter().any(|air| key.starts_with(air))
}

/// Keys of `[vary]` that no run reads. A program of the user's is handed robot and world, and may read any of theirs; a
/// controller of the user's is told numbers of the robot, and these are none of them.
pub(super) fn check_varied(keys: &FlightScenario, robot: Option<&Quadrotor>, found: &mut Findings) {
    if keys.execute.command.is_none() {
        found.drawn_for_nobody(&keys.vary, |path| unread(path, keys, robot));
    }
}

/// Why no run reads it.
fn unread(path: &KeyPath, keys: &FlightScenario, robot: Option<&Quadrotor>) -> Option<String> {
    let within: Vec<&str> = path.segments().iter().map(String::as_str).collect();
    match within[..] {
        ["world", "keep_in_margin_m"] => Some("plans keep the margin, and none is made anew for a run".into()),
        ["robot", "battery", ..] => Some("no run drains a battery".into()),
        ["execute", "noise"] if robot.is_some_and(is_noiseless) && !draws(keys, "noise_n") => Some(NO_NOISE.into()),
        ["execute", key] => {
            let (_, of) = OF_FEW.iter().find(|(of_few, _)| *of_few == key)?;
            let who = keys.execute.controller_word().unwrap_or_default();
            (!is_read(keys, of)).then(|| format!("`{who}` has no use for it"))
        }
        _ => None,
    }
}

/// Whether one of those flies, or may be drawn to.
fn is_read(keys: &FlightScenario, of: &[ControllerKind]) -> bool {
    draws(keys, CONTROLLER_KEY) || keys.execute.controller_in_force().is_some_and(|ours| of.contains(&ours))
}

fn draws(keys: &FlightScenario, part: &str) -> bool {
    keys.vary.keys().any(|key| key.contains(part))
}
