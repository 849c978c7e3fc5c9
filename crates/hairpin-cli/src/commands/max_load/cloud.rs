//! The heaviest programs of an arm through a cloud of points.

use std::path::Path;

use hairpin::search::heaviest::Outcome;
use hairpin_jobs::max_load::{CloudAnswer, CloudSearch, CloudSettings, Programs, search_cloud};
use hairpin_jobs::{Problem, Watch};
use serde_json::{Value, json};

use super::answer::{code, proven_over};
use crate::args::MaxLoad;
use crate::exit::{INCONCLUSIVE, NOTHING_FEASIBLE};
use crate::{console, settings};

/// Runs the command on `points` in `cell`, or on the cell's own.
pub(super) fn run(asked: &MaxLoad, points: Option<&Path>, cell: &str, watch: &dyn Watch) -> Result<u8, Problem> {
    let settings = CloudSettings {
        cell: cell.into(),
        points: points.map(Path::to_owned),
        sets: settings::split(&asked.sets)?,
        programs: Programs {
            start: asked.start,
            end: asked.end,
            min_cost: asked.min_cost.clone(),
            programs: asked.programs.into(),
            visits: asked.visits.into(),
            seed: asked.seed,
        },
        time_limit_s: asked.time_limit,
    };
    let answer = search_cloud(&settings, watch)?;
    // Of an answer that cannot be kept it is not said that it was found: its folder is.
    if let (CloudAnswer::Searched(searched), Some(out)) = (&answer, &asked.out) {
        searched.keep(out, settings::if_there(false, asked.force), watch)?;
    }
    if asked.json {
        console::say(&object(&answer, asked.programs > 1, asked.out.as_deref()).to_string());
    } else {
        tell(asked, &answer);
    }
    Ok(exit_code(&answer))
}

/// 3 if there is no program, 5 if that is not found out.
fn exit_code(answer: &CloudAnswer) -> u8 {
    match answer {
        CloudAnswer::Searched(searched) => code(&searched.found),
        // What rests on estimates alone is not found out.
        CloudAnswer::Nothing { open: Some(_), .. } => INCONCLUSIVE,
        CloudAnswer::Nothing { open: None, .. } => NOTHING_FEASIBLE,
    }
}

/// What `max-load --cloud --json` says; `all`: every program that was found, `out`: where the campaign goes.
pub fn object(answer: &CloudAnswer, all: bool, out: Option<&Path>) -> Value {
    match answer {
        CloudAnswer::Searched(searched) => searched_object(searched, all, out),
        CloudAnswer::Nothing { reason, open, time } => json!({
            "path": Value::Null, "cost": Value::Null, "bound": Value::Null, "gap_percent": Value::Null,
            "proven": open.is_none(), "time_s": time.as_secs_f64(), "method": "graph",
            "reason": with_what_is_open(reason, open.as_deref()), "exit_code": exit_code(answer),
        }),
    }
}

fn searched_object(searched: &CloudSearch, all: bool, out: Option<&Path>) -> Value {
    let CloudSearch { setup, graph, found, time, .. } = searched;
    let value = |cost: i64| cost as f64 * graph.unit;
    let best = found.paths.first();
    let mut object = json!({
        "path": best.map(|(_, path)| path),
        "cost": best.map(|(cost, _)| value(*cost)),
        "bound": found.bound.filter(|_| best.is_some()).map(value),
        "gap_percent": found.gap_percent().filter(|gap| gap.is_finite()),
        "proven": found.proven,
        "time_s": time.as_secs_f64(),
        "method": found.method.name(),
        "unit": graph.unit_name,
        "points": graph.points(),
        "density": graph.reachability.density(),
        "queries_per_pair": graph.reachability.queries_per_pair(),
        "mode": setup.scenario.reach(),
        "estimated": setup.estimated(),
        "exit_code": code(found),
    });
    if let Some(passed) = found.passed.first() {
        object["passed"] = json!(passed);
    }
    if all {
        let paths = found.paths.iter().enumerate().map(|(number, (cost, path))| {
            let mut one = json!({ "path": path, "cost": value(*cost) });
            if let Some(passed) = found.passed.get(number) {
                one["passed"] = json!(passed);
            }
            one
        });
        object["paths"] = paths.collect();
    }
    if let Some(out) = out.filter(|_| best.is_some()) {
        object["folder"] = json!(out);
    }
    if let Some(reason) = &searched.why_none {
        object["reason"] = reason.as_str().into();
    }
    object
}

fn tell(asked: &MaxLoad, answer: &CloudAnswer) {
    let searched = match answer {
        CloudAnswer::Searched(searched) => searched,
        CloudAnswer::Nothing { reason, open, .. } => {
            let word = if open.is_some() { "INCONCLUSIVE" } else { "NOTHING FEASIBLE" };
            return console::say(&format!("{word}: {}", with_what_is_open(reason, open.as_deref())));
        }
    };
    let CloudSearch { setup, graph, found, time, .. } = &**searched;
    let best = found.paths.first();
    let Some((cost, path)) = best else {
        // What was not found in time is not known to be none.
        let word = if found.outcome == Outcome::NotFound { "INCONCLUSIVE" } else { "NOTHING FEASIBLE" };
        return console::say(&format!("{word}: {}", searched.why_none.as_deref().unwrap_or_default()));
    };
    let evidence = if found.proven {
        format!("optimal: {}", proven_over(asked.visits))
    } else {
        found.gap_percent().map_or_else(String::new, |gap| format!("gap {gap:.4} %"))
    };
    // What an arc passes stands in brackets.
    let passed = found.passed.first().map_or(&[][..], Vec::as_slice);
    let row = |row: &usize| if passed.contains(row) { format!("({row})") } else { row.to_string() };
    let rows: Vec<String> = path.iter().map(row).collect();
    console::say(&format!(
        "cost {:.3} {}, {evidence}; {:.3} s by {}, {} points, density {:.2} ({} mode{})",
        *cost as f64 * graph.unit,
        graph.unit_name,
        time.as_secs_f64(),
        found.method.name(),
        graph.points(),
        graph.reachability.density(),
        setup.scenario.reach(),
        setup.unknown_shapes().map_or(String::new(), |shapes| format!(", {shapes}"))
    ));
    console::say(&rows.join(" → "));
}

/// Why there is no program, and why that is not found out, where it is not.
fn with_what_is_open(reason: &str, open: Option<&str>) -> String {
    open.map_or_else(|| reason.to_owned(), |open| format!("{reason}; {open}"))
}
