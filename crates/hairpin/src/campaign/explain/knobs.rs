//! The scenario keys that can make more feasible, and which way they are turned.

use serde_json::{Value, json};

use crate::campaign::scenario::{ArmScenario, DriveScenario, FlightScenario, Manoeuvre, PointsSource, ReachName};
use crate::campaign::setup::{Kind, Setup};

/// One key.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Knob {
    /// Dotted key.
    pub(super) key: &'static str,
    /// How it is turned.
    pub(super) turn: Turn,
}

/// How a key is turned.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Turn {
    /// From `now` as far as `loosest`, whichever is larger; `unit` for people.
    Number { now: f64, loosest: f64, unit: &'static str },
    /// A whole number, likewise.
    Whole { now: u64, loosest: u64 },
    /// A whole number both ways, `now` less or more, down to `least`.
    Either { now: u64, least: u64 },
    /// Another value, told in words.
    Switch { value: Value, words: String },
}

/// Farthest that a number is turned, in multiples of its value, where nothing else bounds it: who mistakes a unit is
/// off by as much.
const FARTHEST: f64 = 1000.0;

/// The keys of a scenario, those first that are thought of first.
pub(super) fn knobs(setup: &Setup) -> Vec<Knob> {
    match setup.kind() {
        Kind::Flight(setup) => of_flight(setup.scenario),
        Kind::Drive(setup) => {
            let mut knobs = of_drive(setup.scenario);
            // The robot's own bounds hold beside the scenario's.
            let limits = &setup.rover.limits;
            let given = &setup.scenario.generate.limits;
            let bounded = [
                ("generate.limits.curvature_1_m", given.curvature_1_m, limits.curvature, "1/m"),
                ("generate.limits.curvature_rate_1_m2", given.curvature_rate_1_m2, limits.curvature_rate, "1/m²"),
                ("generate.limits.tilt_deg", given.tilt_deg, limits.tilt.to_degrees().min(90.0), "°"),
            ];
            for (key, now, loosest, unit) in bounded {
                if let Some(now) = now.filter(|now| *now < loosest) {
                    let loosest = if loosest.is_finite() { loosest } else { FARTHEST * now };
                    knobs.push(Knob { key, turn: Turn::Number { now, loosest, unit } });
                }
            }
            knobs
        }
        Kind::Arm(setup) => of_arm(setup.scenario),
    }
}

fn number(key: &'static str, now: f64, loosest: f64, unit: &'static str) -> Option<Knob> {
    (now != loosest).then_some(Knob { key, turn: Turn::Number { now, loosest, unit } })
}

fn up(key: &'static str, now: f64, unit: &'static str) -> Option<Knob> {
    number(key, now, FARTHEST * now, unit)
}

fn whole(key: &'static str, now: u64, times: u64) -> Option<Knob> {
    Some(Knob { key, turn: Turn::Whole { now, loosest: now.saturating_mul(times).max(times) } })
}

fn switch(key: &'static str, value: Value, words: &str) -> Option<Knob> {
    Some(Knob { key, turn: Turn::Switch { value, words: words.into() } })
}

fn of_flight(scenario: &FlightScenario) -> Vec<Knob> {
    let (generate, world) = (&scenario.generate, &scenario.world);
    let (limits, search) = (&generate.limits, &generate.search);
    let timing = generate.timing_in_force();
    let witness = generate.reach == ReachName::Witness;
    let margin = world.keep_in_margin_m.filter(|margin| *margin > 0.0);
    [
        Some(Knob { key: "task.length", turn: Turn::Either { now: scenario.task.length, least: 2 } }),
        limits.max_speed_m_s.and_then(|now| up("generate.limits.max_speed_m_s", now, "m/s")),
        limits.max_tilt_deg.and_then(|now| number("generate.limits.max_tilt_deg", now, 90.0, "°")),
        limits.max_flight_time_s.and_then(|now| up("generate.limits.max_flight_time_s", now, "s")),
        timing.step_s.and_then(|now| up("generate.timing.step_s", now, "s")),
        timing.leg_time_s.and_then(|[_, now]| up("generate.timing.leg_time_s[1]", now, "s")),
        margin.and_then(|now| number("world.keep_in_margin_m", now, 0.0, "m")),
        (!world.obstacles.is_empty()).then(|| switch("world.obstacles", json!([]), "no obstacles")).flatten(),
        whole("generate.search.waypoints", search.waypoints, 4),
        witness.then(|| whole("generate.velocities", generate.velocities, 4)).flatten(),
        (!search.revisits).then(|| switch("generate.search.revisits", json!(true), "revisits allowed")).flatten(),
    ]
    .into_iter()
    .flatten()
    .collect()
}

fn of_drive(scenario: &DriveScenario) -> Vec<Knob> {
    let (task, generate) = (&scenario.task, &scenario.generate);
    let search = &generate.search;
    let belly = generate.limits.belly_clearance_m;
    let mut manoeuvres = generate.manoeuvres.clone();
    let backward = !manoeuvres.contains(&Manoeuvre::Reverse);
    manoeuvres.push(Manoeuvre::Reverse);
    let places = scenario.world.keep_out.is_empty();
    [
        Some(Knob { key: "task.length", turn: Turn::Either { now: task.length, least: 2 } }),
        up("task.leg_m[1]", task.leg_m[1], "m"),
        number("task.leg_m[0]", task.leg_m[0], 0.0625 * task.leg_m[0], "m"),
        belly.and_then(|now| number("generate.limits.belly_clearance_m", now, now.min(0.0), "m")),
        backward.then(|| switch("generate.manoeuvres", json!(manoeuvres), "reverse allowed")).flatten(),
        (!places).then(|| switch("world.keep_out", json!([]), "no keep-outs")).flatten(),
        up("generate.step_s", generate.step_s, "s"),
        whole("generate.search.waypoints", search.waypoints, 4),
        whole("generate.headings", generate.headings, 4),
        (!search.revisits).then(|| switch("generate.search.revisits", json!(true), "revisits allowed")).flatten(),
    ]
    .into_iter()
    .flatten()
    .collect()
}

fn of_arm(scenario: &ArmScenario) -> Vec<Knob> {
    let (moves, search) = (&scenario.generate.moves, &scenario.generate.search);
    let drawn = match &scenario.task.points {
        PointsSource::Drawn(drawn) => whole("task.points.count", drawn.count, 4),
        PointsSource::File(_) | PointsSource::List(_) => None,
    };
    let allowed = scenario.spec.path.map(|limit| limit.max_mm);
    let obstacles = !scenario.world.obstacles.is_empty();
    let keep_outs = !scenario.world.keep_out_mm.is_empty();
    let (clearance, margin) = (moves.clearance_mm, moves.singularity_margin_deg);
    [
        (clearance > 0.0).then(|| number("generate.moves.clearance_mm", clearance, 0.0, "mm")).flatten(),
        (margin > 0.0).then(|| number("generate.moves.singularity_margin_deg", margin, 0.01 * margin, "°")).flatten(),
        // Moves are proven clear for whatever the spec allows.
        allowed.and_then(|now| number("spec.path.max_mm", now, 0.01 * now, "mm")),
        search.min_cost.filter(|cost| *cost > 0.0).and_then(|now| number("generate.search.min_cost", now, 0.0, "")),
        search.start.and_then(|_| switch("generate.search.start", Value::Null, "any first point")),
        search.end.and_then(|_| switch("generate.search.end", Value::Null, "any last point")),
        obstacles.then(|| switch("world.obstacles", json!([]), "no obstacles")).flatten(),
        keep_outs.then(|| switch("world.keep_out_mm", json!([]), "no keep-outs")).flatten(),
        switch("generate.moves.kind", json!("joint"), "joint moves"),
        drawn,
    ]
    .into_iter()
    .flatten()
    .collect()
}
