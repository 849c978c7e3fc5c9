//! `hairpin completions`: a script for the user's shell.

use hairpin_jobs::Problem;

use crate::args::Completions;
use crate::console;
use crate::exit::DONE;
use crate::help::command;

/// Runs the command.
pub(crate) fn run(completions: &Completions) -> Result<u8, Problem> {
    let mut script = Vec::new();
    clap_complete::generate(completions.shell, &mut command(), "hairpin", &mut script);
    console::say_text(&String::from_utf8_lossy(&script));
    Ok(DONE)
}
