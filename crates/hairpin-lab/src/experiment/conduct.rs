//! An experiment by its name: conducted at the size that its sheet says, written, and told.

use std::path::{Path, PathBuf};

use hairpin_jobs::{Problem, Watch};
use serde_json::json;

use super::outcome::Outcome;
use super::sheet::{Sheet, SheetError};
use super::{defaults, robtest, rover, stressful};
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

/// Measures what a sheet asks for; what it keeps on the way lies in the folder.
type Measure = fn(&Sheet, &Path, &dyn Watch) -> Result<Outcome, Problem>;

/// All experiments by the names of their sheets.
const EXPERIMENTS: [(&str, Measure); 12] = [
    ("yields", |sheet, _, watch| stressful::yields(sheet, watch)),
    ("metrics", |sheet, _, watch| stressful::metrics(sheet, watch)),
    ("scores", |sheet, _, watch| stressful::scores(sheet, watch)),
    ("follow-up", |sheet, _, watch| stressful::follow_up(sheet, watch)),
    ("transfer", |sheet, _, watch| stressful::transfer(sheet, watch)),
    ("robtest-table-1", |sheet, _, watch| robtest::table_1(sheet, watch)),
    ("robtest-figure-7", |sheet, _, watch| robtest::figure_7(sheet, watch)),
    ("robtest-obstacles", |sheet, _, watch| robtest::obstacles(sheet, watch)),
    ("robtest-clusters", |sheet, _, watch| robtest::clusters(sheet, watch)),
    ("robtest-costs", |sheet, _, watch| robtest::costs(sheet, watch)),
    ("rover-requirements", |sheet, _, _| rover::requirements(sheet)),
    ("defaults", defaults::defaults),
];

/// The names of all experiments.
pub fn names() -> impl Iterator<Item = &'static str> {
    EXPERIMENTS.iter().map(|(name, _)| *name)
}

/// Conducts an experiment and writes its tables and figures. Whatever comes out is no violation.
///
/// # Errors
/// No experiment has the name; sizes that are none; a question without an answer; a folder that cannot be written;
/// [`Problem::Interrupted`] where `watch` stops it, with nothing written but the cells of `defaults` that are done.
pub fn conduct(settings: &ExperimentSettings, watch: &dyn Watch) -> Result<Findings, Problem> {
    let ExperimentSettings { name, full, sets, out } = settings;
    let sheet = Sheet::shipped(name, *full, sets)?;
    let Some((_, measure)) = EXPERIMENTS.iter().find(|(own, _)| own == name) else {
        return Err(SheetError::unknown(name).into());
    };
    if cfg!(debug_assertions) {
        watch.warn("Warning: this is no release build; its times mean nothing");
    }
    let outcome = measure(&sheet, out, watch)?;
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
