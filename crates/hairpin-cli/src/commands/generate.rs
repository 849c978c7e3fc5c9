//! `hairpin generate`: the trajectories alone.

use hairpin::campaign;
use hairpin::judgement::Verdict;
use serde_json::json;

use super::parts;
use crate::args::Generate;
use crate::interrupt::Deadline;
use crate::problem::Problem;
use crate::{console, folder};

/// Runs the command: 0 with at least one case, or when the time limit was the reason for none; 3 without.
pub(crate) fn run(generate: &Generate) -> Result<u8, Problem> {
    let arguments = &generate.campaign;
    let work = folder::begin(arguments, None)?;
    let deadline = Deadline::after(arguments.time_limit);
    let (cases, tally) = parts::generate(&work, deadline)?;
    let asked = work.setup.scenario.search().cases;
    let outcome = if cases.is_empty() && !tally.stopped {
        campaign::verdict(&work.setup, &cases, &[], &tally)
    } else {
        let word = cases.first().map_or("none", |case| case.evidence.word());
        Verdict {
            sentence: format!("GENERATED {}/{asked} cases from {} graphs ({word})", cases.len(), tally.graphs),
            exit_code: 0,
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
        parts::point_to_explain(&work, outcome.exit_code);
    }
    Ok(outcome.exit_code)
}
