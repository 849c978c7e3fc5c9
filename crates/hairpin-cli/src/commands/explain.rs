//! `hairpin explain`: why nothing, or little, is feasible.

use std::time::Instant;

use hairpin::campaign::Stop;
use hairpin::campaign::explain::{Deaths, explain};
use hairpin_formats::scenario::setup_for;
use serde_json::json;

use crate::args::Explain;
use crate::interrupt::{self, Deadline};
use crate::problem::Problem;
use crate::{console, folder};

/// Runs the command: 0 where something is feasible, 3 where nothing is.
pub(crate) fn run(asked: &Explain) -> Result<u8, Problem> {
    folder::take_threads(&asked.threads);
    let mut sets = folder::split(&asked.sets)?;
    sets.extend(asked.seed.map(|seed| ("seed".to_owned(), seed.to_string())));
    let setup = setup_for(&asked.scenario, &sets)?.with_simd(folder::simd(&asked.kernels));
    let (began, deadline) = (Instant::now(), Deadline::after(asked.time_limit));
    let stop = Stop { cancelled: &interrupt::asked, progress: &|_, _| {}, clock: &|| began.elapsed().as_secs_f64() };
    let found = explain(&setup, asked.graphs, &stop, &|| deadline.passed())?;
    if interrupt::asked() {
        return Err(Problem::Interrupted("stopped".into()));
    }
    let verdict = found.verdict(&setup);
    if asked.json {
        let mut object = json!(found);
        object["verdict"] = json!(verdict.sentence);
        object["exit_code"] = json!(verdict.exit_code);
        console::say(&object.to_string());
    } else {
        tell(&found.deaths);
        console::say(&verdict.sentence);
    }
    Ok(verdict.exit_code)
}

fn tell(deaths: &Deaths) {
    let share = |count: u64| format!("{:.1} %", 100.0 * count as f64 / deaths.asked.max(1) as f64);
    let header = ["lost at", "limit", "candidates", "share"].map(str::to_owned).to_vec();
    let rows = deaths
        .lost
        .iter()
        .map(|lost| vec![lost.stage.word().to_owned(), lost.limit.clone(), lost.count.to_string(), share(lost.count)]);
    let left = vec!["–".into(), "feasible, with a way on".into(), deaths.left.to_string(), share(deaths.left)];
    console::say(&console::table(&std::iter::once(header).chain(rows).chain([left]).collect::<Vec<_>>()));
    console::say(&format!("of {} {}\n", deaths.asked, deaths.of));
}
