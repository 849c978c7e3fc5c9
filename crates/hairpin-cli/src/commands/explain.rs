//! `hairpin explain`: why nothing, or little, is feasible.

use hairpin::campaign::Losses;
use hairpin_jobs::explain::{ExplainSettings, explain};
use hairpin_jobs::{Problem, Watch};
use serde_json::json;

use crate::args::Explain;
use crate::{console, settings};

/// Runs the command: 0 where something is feasible, 3 where nothing is.
pub(crate) fn run(asked: &Explain, watch: &dyn Watch) -> Result<u8, Problem> {
    settings::take_threads(&asked.threads);
    let settings = ExplainSettings {
        scenario: asked.scenario.clone(),
        sets: settings::keys(&asked.keys, None)?,
        graphs: asked.graphs,
        time_limit_s: asked.time_limit,
        simd: settings::simd(&asked.kernels),
        consent: settings::consent(&asked.commands),
    };
    let (found, verdict) = explain(&settings, watch)?;
    if asked.json {
        let mut object = json!(found);
        object["verdict"] = json!(verdict.sentence);
        object["exit_code"] = json!(verdict.exit_code);
        console::say(&object.to_string());
    } else {
        found.reasons.iter().for_each(|reason| console::say(reason));
        // Where nothing was asked there is nothing to count.
        if found.losses.asked > 0 {
            tell(&found.losses);
        }
        console::say(&verdict.sentence);
    }
    Ok(verdict.exit_code)
}

fn tell(losses: &Losses) {
    let share = |count: u64| format!("{:.1} %", 100.0 * count as f64 / losses.asked.max(1) as f64);
    let header = ["lost at", "limit", "candidates", "share"].map(str::to_owned).to_vec();
    let rows = losses
        .lost
        .iter()
        .map(|lost| vec![lost.stage.word().to_owned(), lost.limit.clone(), lost.count.to_string(), share(lost.count)]);
    let left = vec!["–".into(), "feasible, with a way on".into(), losses.left.to_string(), share(losses.left)];
    console::say_lines(&console::table(&std::iter::once(header).chain(rows).chain([left]).collect::<Vec<_>>()));
    console::say(&format!("of {} {}\n", losses.asked, losses.of));
}
