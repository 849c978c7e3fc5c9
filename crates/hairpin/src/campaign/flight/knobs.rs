//! The keys of flights that can make more feasible, and what a flight can be freed of.

use serde_json::json;

use super::FlightSetup;
use crate::campaign::Scenario;
use crate::campaign::kind::{Condition, Knob, Knobs, Standing};
use crate::campaign::scenario::{FlightScenario, ReachName};
use crate::judgement::Stress;

/// Timing is written out, so that a default can be turned as well.
///
/// The score is written out for the same reason.
pub(super) fn knobs(setup: &FlightSetup) -> Knobs {
    let scenario = &setup.scenario;
    let timing = json!(scenario.generate.timing_in_force());
    Knobs {
        turned: turned(scenario),
        conditions: conditions(scenario),
        standing: (!scenario.world.obstacles.is_empty()).then(|| Standing {
            words: "obstacles",
            key: "world.obstacles",
            count: scenario.world.obstacles.len(),
            keep: |scenario, part| change(scenario, |flight| keep(flight, part)),
        }),
        counts: &["generate.search.graphs", "generate.search.cases"],
        per_graph: "generate.search.per_graph",
        // The timing as a key that is there, which can be turned.
        settled: vec![
            ("generate.score".into(), scenario.generate.score_of_legs().into()),
            ("generate.timing".into(), timing),
        ],
    }
}

/// Limits that are not given bind nothing and have none; a tilt that is below goes up to 90°, margins down to 0.
///
/// In the order in which they are tried: the task, limits, timing, the world, and last what makes the search larger.
fn turned(scenario: &FlightScenario) -> Vec<Knob> {
    let (generate, world) = (&scenario.generate, &scenario.world);
    let (limits, search) = (&generate.limits, &generate.search);
    let timing = generate.timing_in_force();
    let witness = generate.reach == ReachName::Witness;
    let margin = world.keep_in_margin_m.filter(|margin| *margin > 0.0);
    let revisits = || Knob::switch("generate.search.revisits", json!(true), "revisits allowed");
    [
        Knob::either("task.length", scenario.task.length, 2),
        limits.max_speed_m_s.and_then(|now| Knob::up("generate.limits.max_speed_m_s", now, "m/s")),
        limits.max_tilt_deg.and_then(|now| Knob::number("generate.limits.max_tilt_deg", now, now.max(90.0), "°")),
        limits.max_flight_time_s.and_then(|now| Knob::up("generate.limits.max_flight_time_s", now, "s")),
        timing.step_s.and_then(|now| Knob::up("generate.timing.step_s", now, "s")),
        timing.leg_time_s.and_then(|[_, now]| Knob::up("generate.timing.leg_time_s[1]", now, "s")),
        margin.and_then(|now| Knob::number("world.keep_in_margin_m", now, 0.0, "m")),
        (!world.obstacles.is_empty()).then(|| Knob::switch("world.obstacles", json!([]), "no obstacles")).flatten(),
        Knob::whole("generate.search.waypoints", search.waypoints, 4),
        witness.then(|| Knob::whole("generate.velocities", generate.velocities, 4)).flatten(),
        (!search.revisits).then(revisits).flatten(),
    ]
    .into_iter()
    .flatten()
    .collect()
}

/// Gusts, discrete gust, wind and noise, each only where there is some.
fn conditions(scenario: &FlightScenario) -> Vec<Condition> {
    let (world, noise) = (&scenario.world, scenario.execute.noise);
    let wind = world.wind_m_s.is_some_and(|wind| wind != [0.0; 3]);
    let all = [
        Condition::of(world.gusts.is_some(), "no gusts", |all| change(all, |flight| flight.world.gusts = None)),
        Condition::of(world.discrete_gust.is_some(), "no discrete gust", |all| {
            change(all, |flight| flight.world.discrete_gust = None)
        }),
        Condition::of(wind, "no wind", |all| change(all, |flight| flight.world.wind_m_s = None)),
        Condition::of(noise, "no noise", |all| change(all, |flight| flight.execute.noise = false)),
    ];
    all.into_iter().flatten().collect()
}

/// Nothing for a scenario of another kind.
fn change(scenario: &mut Scenario, how: impl FnOnce(&mut FlightScenario)) {
    if let Some(flight) = scenario.own_mut() {
        how(flight);
    }
}

/// Leaves only the obstacles at the places `part`.
fn keep(flight: &mut FlightScenario, part: &[usize]) {
    let obstacles = &mut flight.world.obstacles;
    *obstacles = part.iter().map(|place| obstacles[*place].clone()).collect();
    if obstacles.is_empty() {
        // What the search looked for is nothing to a run, and cannot be looked for where there are none.
        flight.generate.search.stress = Stress::default();
    }
}
