//! Many queries from a file: their table, and what came of them in numbers.

use std::path::Path;

use hairpin_formats::atomic;
use hairpin_formats::quote::shortened;
use hairpin_formats::steering::Status;
use hairpin_jobs::steer::{Batch, Vehicle};
use hairpin_jobs::{Problem, Watch};
use serde_json::json;

use crate::args::Steer;
use crate::console;
use crate::exit::{DONE, WRONG_INPUT};

/// Wrong rows that are told one by one.
const MOST_TOLD: usize = 10;

pub(super) fn run(steer: &Steer, vehicle: &Vehicle, path: &Path, watch: &dyn Watch) -> Result<u8, Problem> {
    let batch = vehicle.answer_file(path, watch)?;
    let table = batch.table()?;
    match &steer.out {
        Some(out) => atomic::write(out, &table)?,
        // One object on stdout is all that --json says.
        None if steer.json => {}
        None => console::say_text(&String::from_utf8_lossy(&table)),
    }
    if let Some(plot) = &steer.plot {
        batch.draw(plot, watch)?;
    }
    let code = if batch.nothing_asked() { WRONG_INPUT } else { DONE };
    tell(steer, path, &batch, code);
    Ok(code)
}

/// Counts on stdout if the table is in a file; wrong rows on stderr.
fn tell(steer: &Steer, path: &Path, batch: &Batch, code: u8) {
    let rows = batch.queries.rows.iter();
    let told = |line: u64, wrong: &dyn std::fmt::Display| {
        shortened(&format!("{}, line {line}: {wrong}", path.display())).into_owned()
    };
    let wrong: Vec<String> = rows.filter_map(|row| Some(told(row.line, row.asked.as_ref().err()?))).collect();
    wrong.iter().take(MOST_TOLD).for_each(|line| console::warn(line));
    if wrong.len() > MOST_TOLD {
        console::warn(&format!("… and {} more wrong rows", wrong.len() - MOST_TOLD));
    }
    let all = [Status::Ok, Status::Infeasible, Status::NotConverged, Status::TimeLimit, Status::Invalid];
    let ([mean, worst], queries) = (batch.solving_us(), batch.answers.len());
    if steer.json {
        let mut object = json!({ "queries": queries, "mean_time_us": mean, "max_time_us": worst, "exit_code": code });
        for status in all {
            object[status.to_string()] = batch.count(status).into();
        }
        object["wrong"] = wrong.into();
        console::say(&object.to_string());
    } else if steer.out.is_some() {
        let counts: Vec<String> = all
            .iter()
            .filter(|status| **status == Status::Ok || batch.count(**status) > 0)
            .map(|status| format!("{} {status}", batch.count(*status)))
            .collect();
        let counts = counts.join(", ");
        console::say(&format!("{queries} queries: {counts}; solving {mean:.1} µs in the mean, {worst:.0} µs at most"));
    }
}
