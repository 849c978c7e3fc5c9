//! `hairpin report`: one HTML file from a judged campaign.

use hairpin::campaign;
use serde_json::json;

use super::parts;
use crate::args::ReportArguments;
use crate::problem::Problem;
use crate::{console, folder};

/// Runs the command: 0 when the report is written, whatever the verdict in it.
pub(crate) fn run(report: &ReportArguments) -> Result<u8, Problem> {
    let work = folder::look(&report.folder)?;
    let cases = work.folder.read_cases()?;
    let tally = work.folder.read_tally()?;
    let results = work.folder.read_results()?;
    if results.len() < cases.len() {
        return Err(Problem::input(format!("not judged yet: hairpin judge {}", report.folder.display())));
    }
    let verdict = campaign::verdict(&work.setup, &cases, &results, &tally);
    let moves = work.folder.read_moves()?;
    let (verdict, regression) = parts::with_moves(&work, &moves, verdict)?;
    parts::report(&work, &cases, &tally, &verdict, (&moves, regression.as_ref()))?;
    let path = work.folder.file("report.html");
    if report.json {
        console::say(&json!({ "verdict": verdict.sentence, "exit_code": 0, "report": path, "coverage": work.folder.read_coverage()? }).to_string());
    } else {
        console::say(&path.display().to_string());
    }
    if report.open {
        let opener = if cfg!(target_os = "macos") { "open" } else { "xdg-open" };
        std::process::Command::new(opener)
            .arg(&path)
            .spawn()
            .map_err(|error| Problem::input(format!("cannot open a browser with {opener}: {error}")))?;
    }
    Ok(0)
}
