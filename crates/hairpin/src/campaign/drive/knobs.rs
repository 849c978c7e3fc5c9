//! The keys of drives that can make more feasible, and what a drive can be freed of.

use serde_json::json;

use super::DriveSetup;
use crate::campaign::Scenario;
use crate::campaign::kind::{Condition, Knob, Knobs, Standing};
use crate::campaign::scenario::{DriveScenario, Manoeuvre};
use crate::judgement::Stress;

/// Keys that are not given have no knob where the robot's bound holds in their place.
///
/// In the order in which they are tried: the task, limits, the world, what makes the search larger, and last limits
/// beside which the robot's own hold.
pub(super) fn knobs(setup: &DriveSetup) -> Knobs {
    let scenario = &setup.scenario;
    Knobs {
        turned: turned(scenario).into_iter().chain(bounded(setup)).collect(),
        conditions: conditions(scenario),
        standing: (!scenario.world.keep_out.is_empty()).then(|| Standing {
            words: "keep-outs",
            key: "world.keep_out",
            count: scenario.world.keep_out.len(),
            keep: |scenario, part| change(scenario, |drive| keep(drive, part)),
        }),
        counts: &["generate.search.graphs", "generate.search.cases"],
        per_graph: "generate.search.per_graph",
        settled: vec![("generate.search.score".into(), scenario.generate.search.score_of_legs().into())],
    }
}

/// Each with the loosest value that it may be turned to.
///
/// Numbers are turned up or down to a loosest value of their own; a switch has one other value. What would change
/// nothing is no knob.
fn turned(scenario: &DriveScenario) -> Vec<Knob> {
    let (task, generate) = (&scenario.task, &scenario.generate);
    let search = &generate.search;
    let belly = generate.limits.belly_clearance_m;
    let mut manoeuvres = generate.manoeuvres.clone();
    let backward = !manoeuvres.contains(&Manoeuvre::Reverse);
    manoeuvres.push(Manoeuvre::Reverse);
    let places = scenario.world.keep_out.is_empty();
    let revisits = || Knob::switch("generate.search.revisits", json!(true), "revisits allowed");
    [
        Knob::either("task.length", task.length, 2),
        Knob::up("task.leg_m[1]", task.leg_m[1], "m"),
        Knob::number("task.leg_m[0]", task.leg_m[0], 0.0625 * task.leg_m[0], "m"),
        belly.and_then(|now| Knob::number("generate.limits.belly_clearance_m", now, now.min(0.0), "m")),
        backward.then(|| Knob::switch("generate.manoeuvres", json!(manoeuvres), "reverse allowed")).flatten(),
        (!places).then(|| Knob::switch("world.keep_out", json!([]), "no keep-outs")).flatten(),
        Knob::up("generate.step_s", generate.step_s, "s"),
        Knob::whole("generate.search.waypoints", search.waypoints, 4),
        Knob::whole("generate.headings", generate.headings, 4),
        (!search.revisits).then(revisits).flatten(),
    ]
    .into_iter()
    .flatten()
    .collect()
}

/// Limits beside which the robot's own bounds hold.
///
/// The loosest value is the robot's own bound; a limit that is not given already lies there, and has no knob. Tilt is
/// bounded by 90°.
fn bounded(setup: &DriveSetup) -> impl Iterator<Item = Knob> {
    let (limits, given) = (&setup.rover.limits, &setup.scenario.generate.limits);
    let tilt = limits.tilt.to_degrees().min(90.0);
    let all = [
        ("generate.limits.curvature_1_m", given.curvature_1_m, limits.curvature, "1/m"),
        ("generate.limits.curvature_rate_1_m2", given.curvature_rate_1_m2, limits.curvature_rate, "1/m²"),
        ("generate.limits.tilt_deg", given.tilt_deg, tilt, "°"),
    ];
    all.into_iter().filter_map(|(key, now, most, unit)| Knob::up_to(key, now?, most, unit))
}

/// What a run meets that its plan does not know.
///
/// Each is something that a run is freed of, to see whether it was that which broke it.
fn conditions(scenario: &DriveScenario) -> Vec<Condition> {
    let execute = &scenario.execute;
    let all = [
        Condition::of(execute.external_force_n.is_some(), "no external force", |all| {
            change(all, |drive| drive.execute.external_force_n = None)
        }),
        Condition::of(execute.noise, "no noise", |all| change(all, |drive| drive.execute.noise = false)),
    ];
    all.into_iter().flatten().collect()
}

/// Nothing for a scenario of another kind.
fn change(scenario: &mut Scenario, how: impl FnOnce(&mut DriveScenario)) {
    if let Some(drive) = scenario.own_mut() {
        how(drive);
    }
}

/// Leaves only the keep-outs at the places `part`.
fn keep(drive: &mut DriveScenario, part: &[usize]) {
    let places = &mut drive.world.keep_out;
    *places = part.iter().map(|place| places[*place].clone()).collect();
    if places.is_empty() {
        // What the search looked for is nothing to a run, and cannot be looked for where there are none.
        drive.generate.search.stress = Stress::default();
    }
}
