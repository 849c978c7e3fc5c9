//! Many queries from a file: their table, and what came of them in numbers.

use std::path::Path;

use hairpin_formats::quote::shortened;
use hairpin_formats::steering::{Status, Wrong, objects};
use hairpin_jobs::steer::{Answers, Batch, Vehicle};
use hairpin_jobs::{Problem, Watch};
use serde_json::json;

use crate::args::Steer;
use crate::console;
use crate::exit::{DONE, WRONG_INPUT};

/// Wrong rows that are told one by one.
const MOST_TOLD: usize = 10;

pub(super) fn run(steer: &Steer, vehicle: &Vehicle, path: &Path, watch: &dyn Watch) -> Result<u8, Problem> {
    let mut rows = String::new();
    let mut keep = |text: &str| rows.push_str(text);
    let answers = match &steer.out {
        Some(out) if steer.resume => Answers::Resumed(out),
        Some(out) => Answers::File(out),
        // One object on stdout is all that --json says.
        None if steer.json => Answers::Shown(&mut keep),
        None => Answers::Shown(&mut console::say_text),
    };
    let batch = vehicle.answer_file(path, answers, steer.plot.is_some(), watch)?;
    if let Some(plot) = &steer.plot {
        batch.draw(plot)?;
    }
    let code = if batch.nothing_asked() { WRONG_INPUT } else { DONE };
    tell(steer, path, (&batch, &rows), code);
    Ok(code)
}

/// Counts on stdout if the table is in a file, or with its `rows` in an object; wrong rows on stderr.
fn tell(steer: &Steer, path: &Path, (batch, rows): (&Batch, &str), code: u8) {
    let told =
        |(line, wrong): &(u64, Wrong)| shortened(&format!("{}, line {line}: {wrong}", path.display())).into_owned();
    let wrong: Vec<String> = batch.wrong.iter().map(told).collect();
    wrong.iter().take(MOST_TOLD).for_each(|line| console::warn(line));
    if wrong.len() > MOST_TOLD {
        console::warn(&format!("… and {} more wrong rows", wrong.len() - MOST_TOLD));
    }
    let ([mean, worst], queries) = (batch.solving_us(), batch.queries);
    if steer.json {
        let mut object = json!({ "queries": queries, "mean_time_us": mean, "max_time_us": worst, "exit_code": code });
        for status in Status::ALL {
            object[status.to_string()] = batch.ended(status).into();
        }
        object["wrong"] = wrong.into();
        if steer.out.is_none() {
            object["answers"] = objects(rows).into();
        }
        console::say(&object.to_string());
    } else if steer.out.is_some() {
        let counts: Vec<String> = Status::ALL
            .iter()
            .filter(|status| **status == Status::Ok || batch.ended(**status) > 0)
            .map(|status| format!("{} {status}", batch.ended(*status)))
            .collect();
        let counts = counts.join(", ");
        console::say(&format!("{queries} queries: {counts}; solving {mean:.1} µs in the mean, {worst:.0} µs at most"));
    }
}
