//! `hairpin experiment NAME`: the papers' experiments and those that they left open; tables as CSV, figures as SVG.
//!
//! One file per paper. Each takes the experiment's sheet (`experiments/NAME.toml`) and gives back an [`Outcome`]; what is
//! written and printed is decided here, once.

mod robtest;
mod rover;
mod stressful;

use std::path::{Path, PathBuf};

use clap::ValueEnum;
use hairpin_formats::atomic::{self, make_folder};
use hairpin_formats::experiment::Sheet;
use hairpin_formats::figure::{Figure, Table};
use serde_json::json;

use crate::args::{Experiment, ExperimentName};
use crate::console;
use crate::interrupt;
use crate::problem::Problem;

/// What an experiment found. Names are those of files, without ending.
struct Outcome {
    /// Written as NAME.csv, the first one printed as well.
    tables: Vec<(&'static str, Table)>,
    /// Written as NAME.svg.
    figures: Vec<(String, Figure)>,
    /// Sentences below the table: conditions, and what was left out.
    notes: Vec<String>,
}

/// Runs the command: 0 when it has measured, whatever came out.
pub(crate) fn run(asked: &Experiment) -> Result<u8, Problem> {
    let name = asked.name.to_possible_value().map_or(String::new(), |value| value.get_name().to_owned());
    let sheet = Sheet::shipped(&name, asked.full, &asked.sets)?;
    if cfg!(debug_assertions) {
        console::warn("Warning: this is no release build; its times mean nothing");
    }
    let outcome = match asked.name {
        ExperimentName::Yields => stressful::yields(&sheet),
        ExperimentName::Metrics => stressful::metrics(&sheet),
        ExperimentName::Scores => stressful::scores(&sheet),
        ExperimentName::FollowUp => stressful::follow_up(&sheet),
        ExperimentName::Transfer => stressful::transfer(&sheet),
        ExperimentName::RobtestTable1 => robtest::table_1(&sheet),
        ExperimentName::RobtestFigure7 => robtest::figure_7(&sheet),
        ExperimentName::RobtestObstacles => robtest::obstacles(&sheet),
        ExperimentName::RobtestClusters => robtest::clusters(&sheet),
        ExperimentName::RobtestCosts => robtest::costs(&sheet),
        ExperimentName::RoverRequirements => rover::requirements(&sheet),
    }?;
    let folder = asked.out.clone().unwrap_or_else(|| Path::new("out").join(&name));
    let files = write(&folder, &outcome)?;
    if asked.json {
        let tables = outcome.tables.iter().map(|(name, table)| ((*name).to_owned(), table.objects()));
        let tables: serde_json::Map<_, _> = tables.collect();
        let object = json!({
            "experiment": name, "full": asked.full, "tables": tables, "notes": outcome.notes, "files": files, "exit_code": 0,
        });
        console::say(&object.to_string());
    } else {
        if let Some((_, table)) = outcome.tables.first() {
            console::say(&console::table(&table.shown()));
        }
        outcome.notes.iter().for_each(|note| console::say(note));
        files.iter().for_each(|file| console::say(&file.display().to_string()));
    }
    Ok(0)
}

/// Writes everything; the paths.
fn write(folder: &Path, outcome: &Outcome) -> Result<Vec<PathBuf>, Problem> {
    make_folder(folder)?;
    let tables = outcome.tables.iter().map(|(name, table)| Ok((format!("{name}.csv"), table.csv())));
    let figures = outcome.figures.iter().map(|(name, figure)| {
        let svg = figure.svg().map_err(|error| Problem::input(format!("{name}.svg cannot be drawn: {error}")))?;
        Ok((format!("{name}.svg"), svg))
    });
    let write = |file: Result<(String, String), Problem>| {
        let (name, text) = file?;
        let path = folder.join(name);
        atomic::write(&path, text.as_bytes())?;
        Ok(path)
    };
    tables.chain(figures).map(write).collect()
}

/// Ctrl-C between two measurements ends an experiment: half of a table is none.
fn go_on() -> Result<(), Problem> {
    if interrupt::asked() { Err(Problem::Interrupted("interrupted: nothing was written".into())) } else { Ok(()) }
}
