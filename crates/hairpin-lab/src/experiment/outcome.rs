//! What an experiment found: written as files, told in words and as an object.

use std::path::{Path, PathBuf};

use hairpin_formats::atomic::{self, make_folder};
use hairpin_formats::figure::{Figure, Table};
use hairpin_jobs::Problem;
use serde_json::{Map, Value};

use crate::findings::Words;

/// What an experiment found. Names are those of files, without ending.
pub(super) struct Outcome {
    /// Written as NAME.csv, the first one told in words as well.
    pub(super) tables: Vec<(&'static str, Table)>,
    /// Written as NAME.svg.
    pub(super) figures: Vec<(String, Figure)>,
    /// Sentences below the table: conditions, and what was left out.
    pub(super) notes: Vec<String>,
}

impl Outcome {
    /// Writes everything; the paths.
    pub(super) fn write(&self, folder: &Path) -> Result<Vec<PathBuf>, Problem> {
        make_folder(folder)?;
        let tables = self.tables.iter().map(|(name, table)| Ok((format!("{name}.csv"), table.csv())));
        let figures = self.figures.iter().map(|(name, figure)| {
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

    /// The first table, the notes, and the paths of `files`.
    pub(super) fn words(&self, files: &[PathBuf]) -> Vec<Words> {
        let table = self.tables.first().map(|(_, table)| Words::Table(table.shown()));
        let files = files.iter().map(|file| file.display().to_string());
        table.into_iter().chain(Words::lines(self.notes.iter().cloned().chain(files))).collect()
    }

    /// All tables by name, for machines.
    pub(super) fn objects(&self) -> Map<String, Value> {
        self.tables.iter().map(|(name, table)| ((*name).to_owned(), table.objects())).collect()
    }
}
