//! `hairpin init ci`: a build server's workflow.

use std::path::Path;

use hairpin_formats::{atomic, ci};
use hairpin_jobs::Problem;
use serde_json::json;

use crate::args::{Ci, Init, Initial, Server};
use crate::console;
use crate::exit::DONE;

/// Runs the command.
pub(crate) fn run(asked: &Init) -> Result<u8, Problem> {
    let Initial::Ci(asked) = &asked.what;
    write(asked)
}

fn write(asked: &Ci) -> Result<u8, Problem> {
    let server = match asked.server {
        Server::Github => ci::Server::Github,
        Server::Gitlab => ci::Server::Gitlab,
        Server::Jenkins => ci::Server::Jenkins,
    };
    let path = asked.out.as_deref().unwrap_or(Path::new(server.place()));
    let source = asked.source.as_deref().unwrap_or_default();
    let text = server.text(&asked.scenario, source).map_err(|error| Problem::input(error.to_string()))?;
    if path.exists() && !asked.force {
        return Err(Problem::input(format!(
            "{} exists already: --force overwrites it, --out FILE writes another",
            path.display()
        )));
    }
    if let Some(folder) = path.parent().filter(|folder| !folder.as_os_str().is_empty()) {
        atomic::make_folder(folder)?;
    }
    atomic::write(path, text.as_bytes())?;
    if asked.json {
        console::say(&json!({ "exit_code": DONE, "file": path }).to_string());
        return Ok(DONE);
    }
    console::say(&format!("{} written: it stresses {}, within 5 minutes", path.display(), asked.scenario));
    if !Path::new(&asked.scenario).is_file() {
        console::warn(&format!(
            "{} is not there yet: hairpin new quadrotor writes one, --scenario names another",
            asked.scenario
        ));
    }
    if source.is_empty() {
        console::warn(
            "HAIRPIN_SOURCE in it is empty: set it (or --source URL) unless the server has hairpin on its path",
        );
    }
    Ok(DONE)
}
