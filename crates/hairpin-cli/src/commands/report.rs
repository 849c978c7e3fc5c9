//! `hairpin report`: one HTML file from a judged campaign.

use hairpin_jobs::Problem;
use hairpin_jobs::report::{Reported, report};
use serde_json::json;

use crate::args::ReportArguments;
use crate::console;
use crate::exit::DONE;

/// Runs the command: 0 when the report is written, whatever the verdict in it.
pub(crate) fn run(asked: &ReportArguments) -> Result<u8, Problem> {
    let Reported { path, verdict, coverage, told } = report(&asked.folder, &asked.case, asked.picture.as_deref())?;
    told.iter().for_each(|line| console::warn(line));
    if asked.json {
        let object = json!({ "verdict": verdict.sentence, "exit_code": DONE, "report": path, "coverage": coverage });
        console::say(&object.to_string());
    } else {
        console::say(&path.display().to_string());
    }
    if asked.open {
        let opener = if cfg!(target_os = "macos") { "open" } else { "xdg-open" };
        std::process::Command::new(opener)
            .arg(&path)
            .spawn()
            .map_err(|error| Problem::input(format!("cannot open a browser with {opener}: {error}")))?;
    }
    Ok(DONE)
}
