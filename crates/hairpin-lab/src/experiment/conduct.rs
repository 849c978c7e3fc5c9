//! An experiment by its name: conducted at the size that its sheet says, written, and told.

use std::path::PathBuf;

use hairpin_jobs::{Problem, Watch};
use serde_json::json;

use super::outcome::Outcome;
use super::sheet::{Sheet, SheetError};
use super::{robtest, rover, stressful};
use crate::findings::Findings;

/// Which experiment, how large, and where its files go.
#[derive(Debug, Clone, PartialEq)]
pub struct ExperimentSettings {
    /// One of [`names`].
    pub name: String,
    /// At full size instead of in minutes.
    pub full: bool,
    /// KEY=VALUE over the sizes of its sheet.
    pub sets: Vec<String>,
    /// Where tables and figures go. What is there under their names is replaced.
    pub out: PathBuf,
}

/// Measures what a sheet asks for.
type Measure = fn(&Sheet, &dyn Watch) -> Result<Outcome, Problem>;

/// All experiments by the names of their sheets.
const EXPERIMENTS: [(&str, Measure); 11] = [
    ("yields", stressful::yields),
    ("metrics", stressful::metrics),
    ("scores", stressful::scores),
    ("follow-up", stressful::follow_up),
    ("transfer", stressful::transfer),
    ("robtest-table-1", robtest::table_1),
    ("robtest-figure-7", robtest::figure_7),
    ("robtest-obstacles", robtest::obstacles),
    ("robtest-clusters", robtest::clusters),
    ("robtest-costs", robtest::costs),
    ("rover-requirements", |sheet, _| rover::requirements(sheet)),
];

/// The names of all experiments.
pub fn names() -> impl Iterator<Item = &'static str> {
    EXPERIMENTS.iter().map(|(name, _)| *name)
}

/// Conducts an experiment and writes its tables and figures. Whatever comes out is no violation.
///
/// # Errors
/// No experiment has the name; sizes that are none; a question without an answer; a folder that cannot be written;
/// [`Problem::Interrupted`] where `watch` stops it, with nothing written.
pub fn conduct(settings: &ExperimentSettings, watch: &dyn Watch) -> Result<Findings, Problem> {
    let ExperimentSettings { name, full, sets, out } = settings;
    let sheet = Sheet::shipped(name, *full, sets)?;
    let Some((_, measure)) = EXPERIMENTS.iter().find(|(own, _)| own == name) else {
        return Err(SheetError::unknown(name).into());
    };
    if cfg!(debug_assertions) {
        watch.warn("Warning: this is no release build; its times mean nothing");
    }
    let outcome = measure(&sheet, watch)?;
    let files = outcome.write(out)?;
    let object = json!({
        "experiment": name, "full": full, "tables": outcome.objects(), "notes": outcome.notes, "files": files, "exit_code": 0,
    });
    Ok(Findings::new(outcome.words(&files), object))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_sheet_has_its_experiment() {
        let mut sheets: Vec<&str> = hairpin_formats::library::experiments().map(|sheet| sheet.name).collect();
        let mut own: Vec<&str> = names().collect();
        sheets.sort_unstable();
        own.sort_unstable();
        assert_eq!(own, sheets);
    }
}
