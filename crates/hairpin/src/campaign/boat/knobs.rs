//! The keys of boats that can make more feasible, and what a run can be freed of.

use serde_json::json;

use super::BoatSetup;
use super::keys::BoatScenario;
use crate::campaign::Scenario;
use crate::campaign::kind::{Condition, Knob, Knobs, Standing};
use crate::judgement::Stress;

/// Leg times and score are written out, so that a default can be turned as well.
pub(super) fn knobs(setup: &BoatSetup) -> Knobs {
    let scenario = &setup.scenario;
    let count = scenario.world.keep_out.len();
    Knobs {
        turned: turned(scenario),
        conditions: conditions(scenario),
        standing: (count > 0).then_some(Standing {
            words: "keep-outs",
            key: "world.keep_out",
            count,
            keep: |scenario, part| change(scenario, |boat| keep(boat, part)),
        }),
        counts: &["generate.search.graphs", "generate.search.cases"],
        per_graph: "generate.search.per_graph",
        settled: vec![
            ("generate.score".into(), scenario.generate.score_of_legs().into()),
            ("generate.leg_time_s".into(), json!(scenario.generate.leg_time_s)),
        ],
    }
}

/// In the order they are tried in: the task's length, limits, the longest leg time, the waters, and last what makes
/// the search larger.
///
/// Numbers that are not given bind nothing and have no knob; a share of thrust goes up to 1.
fn turned(scenario: &BoatScenario) -> Vec<Knob> {
    let (generate, world) = (&scenario.generate, &scenario.world);
    let (limits, search) = (&generate.limits, &generate.search);
    let margin = Some(world.keep_in_margin_m).filter(|margin| *margin > 0.0);
    [
        Knob::either("task.length", scenario.task.length, 2),
        limits.max_speed_m_s.and_then(|now| Knob::up("generate.limits.max_speed_m_s", now, "m/s")),
        limits.thrust_share.and_then(|now| Knob::up_to("generate.limits.thrust_share", now, 1.0, "")),
        limits.max_time_s.and_then(|now| Knob::up("generate.limits.max_time_s", now, "s")),
        Knob::up("generate.leg_time_s[1]", generate.leg_time_s[1], "s"),
        margin.and_then(|now| Knob::number("world.keep_in_margin_m", now, 0.0, "m")),
        (!world.keep_out.is_empty()).then(|| Knob::switch("world.keep_out", json!([]), "no keep-outs")).flatten(),
        Knob::whole("generate.search.waypoints", search.waypoints, 4),
        Knob::whole("generate.velocities", generate.velocities, 4),
        (!search.revisits).then(|| Knob::switch("generate.search.revisits", json!(true), "revisits allowed")).flatten(),
    ]
    .into_iter()
    .flatten()
    .collect()
}

/// Each is what takes it away from the scenario.
///
/// The current is one of them: plans know it, runs without it show whether it is what breaks them.
fn conditions(scenario: &BoatScenario) -> Vec<Condition> {
    let execute = &scenario.execute;
    let force = execute.external_force_n.is_some_and(|force| force != [0.0; 2]);
    let current = scenario.world.current() != [0.0; 2];
    let all = [
        Condition::of(force, "no steady force", |all| change(all, |boat| boat.execute.external_force_n = None)),
        Condition::of(current, "no current", |all| change(all, |boat| boat.world.current_m_s = None)),
        Condition::of(execute.noise, "no noise", |all| change(all, |boat| boat.execute.noise = false)),
    ];
    all.into_iter().flatten().collect()
}

/// Nothing for a scenario of another kind.
fn change(scenario: &mut Scenario, how: impl FnOnce(&mut BoatScenario)) {
    if let Some(boat) = scenario.own_mut() {
        how(boat);
    }
}

/// Leaves only the keep-outs at the places `part`.
fn keep(boat: &mut BoatScenario, part: &[usize]) {
    let places = &mut boat.world.keep_out;
    *places = part.iter().map(|place| places[*place].clone()).collect();
    if places.is_empty() {
        // What the search looked for is nothing to a run, and cannot be looked for where there are none.
        boat.generate.search.stress = Stress::default();
    }
}
