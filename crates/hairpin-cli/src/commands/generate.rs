//! `hairpin generate`: the trajectories alone.

use hairpin::campaign;
use hairpin::judgement::Verdict;
use hairpin_jobs::generate::{Generated, generate};
use hairpin_jobs::{Problem, Watch};
use serde_json::json;

use super::explained::point_to_explain;
use crate::args::Generate;
use crate::exit::DONE;
use crate::{console, settings};

/// Runs the command: 0 with at least one case, or when the time limit was the reason for none; 3 without.
pub(crate) fn run(asked: &Generate, watch: &dyn Watch) -> Result<u8, Problem> {
    let arguments = &asked.campaign;
    settings::take_threads(&arguments.threads);
    let Generated { work, cases, tally } = generate(&settings::campaign(arguments, None)?, watch)?;
    let asked = work.setup.scenario.search().cases;
    let outcome = if cases.is_empty() && !tally.stopped {
        campaign::verdict(&work.setup, &cases, (&[], None), &tally)
    } else {
        let word = cases.first().map_or("none", |case| case.evidence.word());
        Verdict {
            sentence: format!("GENERATED {}/{asked} cases from {} graphs ({word})", cases.len(), tally.graphs),
            exit_code: DONE,
        }
    };
    if arguments.json {
        let object = json!({
            "verdict": outcome.sentence,
            "exit_code": outcome.exit_code,
            "counts": { "asked": asked, "cases": cases.len() },
            "generation": tally,
            "paths": { "folder": work.folder.path(), "results": work.folder.file("results.parquet") },
        });
        console::say(&object.to_string());
    } else {
        console::say(&outcome.sentence);
        point_to_explain(&work, outcome.exit_code);
    }
    Ok(outcome.exit_code)
}
