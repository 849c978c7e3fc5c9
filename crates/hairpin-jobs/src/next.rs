//! The commands that go on from a judged campaign, exact and to be copied: a place is quoted where a shell would take
//! it apart.

use std::path::Path;

use hairpin::campaign::report::worst_first;
use hairpin::campaign::{CaseResult, Status};
use hairpin_formats::quote::shell_word;

use crate::work::Work;

/// `hairpin replay OUT --case 0117`; of a repro file without the case.
pub(crate) fn replay_command(place: &Path, case: Option<&str>) -> String {
    of_case("replay", place, case)
}

/// `hairpin report OUT`, which writes the page of the judgement that is in the folder.
pub fn report_command(folder: &Path) -> String {
    format!("hairpin report {}", quoted(folder))
}

/// What to do next about the judged campaign `work`, a line for each thing.
pub fn next_commands(work: &Work, results: &[CaseResult]) -> Vec<String> {
    let (setup, folder) = (&work.setup, work.folder.path());
    let mut commands = Vec::new();
    let worst = worst_first(results).into_iter().find(|result| result.measures.is_some());
    if let Some(worst) = worst {
        let case = worst.case.to_string();
        // A recording is executed nowhere again.
        if setup.recordings().is_none() {
            commands.push(replay_command(folder, Some(&case)));
            if worst.status == Status::Fail {
                commands.push(of_case("shrink", folder, Some(&case)));
            }
        }
    }
    if work.folder.file("report.html").is_file() {
        commands.push(format!("{} --open", report_command(folder)));
    }
    if worst.is_some() {
        let to = if setup.has_programs() { "rapid" } else { "csv,mcap" };
        commands.push(format!("hairpin export {} --to {to} --worst 10", quoted(folder)));
    }
    commands
}

fn of_case(verb: &str, place: &Path, case: Option<&str>) -> String {
    let case = case.map_or(String::new(), |case| format!(" --case {case}"));
    format!("hairpin {verb} {}{case}", quoted(place))
}

fn quoted(path: &Path) -> String {
    shell_word(&path.display().to_string()).into_owned()
}
