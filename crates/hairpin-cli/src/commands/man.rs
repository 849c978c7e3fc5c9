//! `hairpin man`: pages for `man`, one for each command.

use hairpin_formats::atomic;
use hairpin_jobs::Problem;
use serde_json::json;

use crate::args::Man;
use crate::console;
use crate::exit::DONE;
use crate::help::command;

/// Runs the command.
pub(crate) fn run(asked: &Man) -> Result<u8, Problem> {
    atomic::make_folder(&asked.out)?;
    // Every command gets its full name, such as hairpin-init-ci, and what all of them take.
    let mut whole = command().disable_help_subcommand(true);
    whole.build();
    let mut files = Vec::new();
    let mut left = vec![whole];
    while let Some(one) = left.pop() {
        left.extend(one.get_subcommands().cloned());
        let page = clap_mangen::Man::new(one);
        let path = asked.out.join(page.get_filename());
        let mut text = Vec::new();
        page.render(&mut text).map_err(|cause| Problem::of_file(&path, cause))?;
        atomic::write(&path, &text)?;
        files.push(path);
    }
    files.sort();
    if asked.json {
        console::say(&json!({ "exit_code": DONE, "files": files }).to_string());
    } else {
        console::say(&format!("{} pages in {}", files.len(), asked.out.display()));
    }
    Ok(DONE)
}
