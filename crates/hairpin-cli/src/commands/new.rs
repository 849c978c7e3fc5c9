//! `hairpin new`: a commented scenario file that runs as it is.

use std::path::Path;

use hairpin_formats::{atomic, template};
use hairpin_jobs::Problem;
use serde_json::json;

use crate::args::New;
use crate::console;
use crate::exit::DONE;

/// Runs the command.
pub(crate) fn run(new: &New) -> Result<u8, Problem> {
    let name = &new.kind;
    let text = template::template(name).map(str::to_owned).or_else(|| template::of_robot(name));
    let text = text.ok_or_else(|| Problem::input(format!("no scenario of {name} is shipped")))?;
    let file = format!("{name}.toml");
    let path = Path::new(&file);
    if path.exists() && !new.force {
        return Err(Problem::input(format!("{file} exists already: --force overwrites it")));
    }
    atomic::write(path, text.as_bytes())?;
    if new.json {
        console::say(&json!({ "exit_code": DONE, "file": file }).to_string());
    } else {
        console::say(&format!("{file} written; now: hairpin stress {file}"));
    }
    Ok(DONE)
}
