//! The keys of arms that can make more feasible. What an arm's program meets is its cell, which nothing is freed of.

use serde_json::{Value, json};

use super::ArmSetup;
use crate::campaign::kind::{Knob, Knobs};
use crate::campaign::scenario::{ArmScenario, PointsSource};

pub(super) fn knobs(setup: &ArmSetup) -> Knobs {
    Knobs {
        turned: turned(&setup.scenario),
        conditions: Vec::new(),
        standing: None,
        counts: &[],
        per_graph: "generate.search.programs",
        settled: Vec::new(),
    }
}

/// In the order they are tried in: first what was asked for beside the program (a least cost), then what moves must
/// keep (clearance, singularity margin, spec), then what is in the way, and last the count of points.
///
/// Each knob has the value that it goes to in the end: 0 for clearance and least cost, a hundredth of themselves for
/// the singularity margin and for what the spec allows, four times itself for a count of drawn points; switches turn
/// a key off, or moves to those in joints.
fn turned(scenario: &ArmScenario) -> Vec<Knob> {
    let (moves, search) = (&scenario.generate.moves, &scenario.generate.search);
    let drawn = match &scenario.task.points {
        PointsSource::Drawn(drawn) => Knob::whole("task.points.count", drawn.count, 4),
        PointsSource::File(_) | PointsSource::List(_) => None,
    };
    let allowed = scenario.spec.path.map(|limit| limit.max_mm);
    let obstacles = !scenario.world.obstacles.is_empty();
    let keep_outs = !scenario.world.keep_out_mm.is_empty();
    let clearance = Some(moves.clearance_mm).filter(|now| *now > 0.0);
    let margin = Some(moves.singularity_margin_deg).filter(|now| *now > 0.0);
    let least = search.min_cost.filter(|cost| *cost > 0.0);
    [
        // Where a cost is asked for, nothing else may help, and patience has an end.
        least.and_then(|now| Knob::number("generate.search.min_cost", now, 0.0, "")),
        clearance.and_then(|now| Knob::number("generate.moves.clearance_mm", now, 0.0, "mm")),
        margin.and_then(|now| Knob::number("generate.moves.singularity_margin_deg", now, 0.01 * now, "°")),
        // Moves are proven clear for whatever the spec allows.
        allowed.and_then(|now| Knob::number("spec.path.max_mm", now, 0.01 * now, "mm")),
        search.start.and_then(|_| Knob::switch("generate.search.start", Value::Null, "any first point")),
        search.end.and_then(|_| Knob::switch("generate.search.end", Value::Null, "any last point")),
        obstacles.then(|| Knob::switch("world.obstacles", json!([]), "no obstacles")).flatten(),
        keep_outs.then(|| Knob::switch("world.keep_out_mm", json!([]), "no keep-outs")).flatten(),
        Knob::switch("generate.moves.kind", json!("joint"), "joint moves"),
        drawn,
    ]
    .into_iter()
    .flatten()
    .collect()
}
