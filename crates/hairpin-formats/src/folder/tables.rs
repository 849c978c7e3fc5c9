//! Whole tables of a folder by their names, as whoever takes them elsewhere asks for them.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use super::{CampaignFolder, FolderError};
use crate::parquet::rows::{Only, Rows};

const ENDING: &str = "parquet";

impl CampaignFolder {
    /// The names of the tables that are there.
    ///
    /// # Errors
    /// The folder cannot be read.
    pub fn tables(&self) -> Result<Vec<String>, FolderError> {
        let entries = super::entries(&self.path)?;
        let is_one = |path: &PathBuf| if path.is_dir() { !files(path).is_empty() } else { is_table(path) };
        let name = |path: PathBuf| path.file_stem().map(|stem| stem.to_string_lossy().into_owned());
        Ok(entries.into_iter().filter(is_one).filter_map(name).collect::<BTreeSet<_>>().into_iter().collect())
    }

    /// The rows of the table `name`, as far as `only` wants them; `None` where there is no such table.
    ///
    /// # Errors
    /// The folder cannot be read; the table is none.
    pub fn rows(&self, name: &str, only: Only) -> Result<Option<Rows>, FolderError> {
        if !self.tables()?.iter().any(|known| known == name) {
            return Ok(None);
        }
        let single = self.file(&format!("{name}.{ENDING}"));
        let files = if single.is_file() { vec![single] } else { files(&self.file(name)) };
        Ok(Some(Rows::open(files, only)?))
    }
}

/// The tables in a folder, in order.
fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
    let mut files: Vec<PathBuf> = entries.filter(|path| is_table(path)).collect();
    files.sort();
    files
}

fn is_table(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending == ENDING) && path.is_file()
}
