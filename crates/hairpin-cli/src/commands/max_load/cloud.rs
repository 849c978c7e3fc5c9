//! The heaviest programs of an arm through a cloud of points.

use std::path::Path;
use std::time::Duration;

use hairpin::search::heaviest::Outcome;
use hairpin_jobs::max_load::{CloudAnswer, CloudSearch, CloudSettings, search_cloud};
use hairpin_jobs::sets::Set;
use hairpin_jobs::{Problem, Watch};
use serde_json::{Value, json};

use super::answer::{code, proven_over};
use crate::args::MaxLoad;
use crate::exit::{INCONCLUSIVE, NOTHING_FEASIBLE};
use crate::{console, settings};

/// Runs the command on `points` in `cell`.
pub(super) fn run(asked: &MaxLoad, points: &Path, cell: &str, watch: &dyn Watch) -> Result<u8, Problem> {
    let settings =
        CloudSettings { cell: cell.into(), points: points.into(), sets: sets(asked)?, time_limit_s: asked.time_limit };
    let searched = match search_cloud(&settings, watch)? {
        CloudAnswer::Searched(searched) => searched,
        CloudAnswer::Nothing { reason, open, time } => return Ok(nothing(asked, &reason, open.as_deref(), time)),
    };
    tell(asked, &searched);
    if let Some(out) = &asked.out {
        searched.keep(out, settings::if_there(false, asked.force), watch)?;
    }
    Ok(code(&searched.found))
}

/// The flags as keys of the scenario.
fn sets(asked: &MaxLoad) -> Result<Vec<Set>, Problem> {
    let mut sets = settings::split(&asked.sets)?;
    let mut set = |key: &str, value: Option<String>| sets.extend(value.map(|value| (key.to_owned(), value)));
    set("generate.search.start", asked.start.map(|row| row.to_string()));
    set("generate.search.end", asked.end.map(|row| row.to_string()));
    set("generate.search.min_cost", asked.min_cost.clone());
    set("generate.search.programs", Some(asked.programs.to_string()));
    set("generate.search.visits", (asked.visits > 1).then(|| asked.visits.to_string()));
    set("seed", (asked.seed > 0).then(|| asked.seed.to_string()));
    Ok(sets)
}

fn tell(asked: &MaxLoad, searched: &CloudSearch) {
    let CloudSearch { setup, graph, found, time, .. } = searched;
    let value = |cost: i64| cost as f64 * graph.unit;
    let best = found.paths.first();
    if asked.json {
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
        if asked.programs > 1 {
            let paths = found.paths.iter().enumerate().map(|(number, (cost, path))| {
                let mut one = json!({ "path": path, "cost": value(*cost) });
                if let Some(passed) = found.passed.get(number) {
                    one["passed"] = json!(passed);
                }
                one
            });
            object["paths"] = paths.collect();
        }
        if let Some(out) = asked.out.as_ref().filter(|_| best.is_some()) {
            object["folder"] = json!(out);
        }
        if let Some(reason) = &searched.why_none {
            object["reason"] = reason.as_str().into();
        }
        return console::say(&object.to_string());
    }
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
        value(*cost),
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

/// No program, because no point or no move is possible.
fn nothing(asked: &MaxLoad, reason: &str, open: Option<&str>, time: Duration) -> u8 {
    // What rests on estimates alone is not found out.
    let (code, word) =
        if open.is_some() { (INCONCLUSIVE, "INCONCLUSIVE") } else { (NOTHING_FEASIBLE, "NOTHING FEASIBLE") };
    let reason = open.map_or_else(|| reason.to_owned(), |open| format!("{reason}; {open}"));
    if asked.json {
        let object = json!({
            "path": Value::Null, "cost": Value::Null, "bound": Value::Null, "gap_percent": Value::Null, "proven": open.is_none(),
            "time_s": time.as_secs_f64(), "method": "graph", "reason": reason, "exit_code": code,
        });
        console::say(&object.to_string());
    } else {
        console::say(&format!("{word}: {reason}"));
    }
    code
}
