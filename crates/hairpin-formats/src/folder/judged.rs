//! The judgement in a campaign folder: results, and which parameter did it.

use std::fs;
use std::io;

use hairpin::campaign::baseline::Moves;
use hairpin::campaign::coverage::Coverage;
use hairpin::campaign::kind::Axis;
use hairpin::campaign::{Case, CaseResult, Influence};
use serde::Serialize;
use serde::de::DeserializeOwned;

use super::{BY_CHANCE, COVERAGE, CampaignFolder, FolderError, INFLUENCE, MISSIONS, MOVES, RESULTS, SEARCHED};
use crate::atomic::{self, WriteError};
use crate::parquet::results::{self, Row};

impl CampaignFolder {
    /// Writes `results.parquet`: every case, with its result where it has one.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write_results(&self, all: &[Case], judged: &[CaseResult]) -> Result<(), FolderError> {
        Ok(results::write(&self.file(RESULTS), all, judged)?)
    }

    /// Reads `results.parquet` as it is, without waypoints and profiles.
    ///
    /// # Errors
    /// The file is missing or broken.
    pub fn read_rows(&self) -> Result<Vec<Row>, FolderError> {
        Ok(results::read(&self.file(RESULTS))?)
    }

    /// Reads the results of all judged cases.
    ///
    /// # Errors
    /// The file is missing or broken.
    pub fn read_results(&self) -> Result<Vec<CaseResult>, FolderError> {
        Ok(self.read_rows()?.into_iter().filter_map(|row| row.result).collect())
    }

    /// Writes `baseline.parquet`: random feasible cases, what their runs measured, and nothing of the spec.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write_baseline(&self, cases: &[Case], measured: &[CaseResult]) -> Result<(), FolderError> {
        Ok(results::write_counted(&self.file(BY_CHANCE), cases, measured)?)
    }

    /// Reads what they measured; `None` where there is no such file.
    ///
    /// # Errors
    /// The file is broken, or has other rows than were written.
    pub fn read_baseline(&self) -> Result<Option<Vec<CaseResult>>, FolderError> {
        self.read_measured_of(BY_CHANCE)
    }

    /// Writes `searched.parquet`: what a search found beside missions made elsewhere, likewise.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write_searched(&self, cases: &[Case], measured: &[CaseResult]) -> Result<(), FolderError> {
        Ok(results::write_counted(&self.file(SEARCHED), cases, measured)?)
    }

    /// Reads what they measured, likewise.
    ///
    /// # Errors
    /// The file is broken.
    pub fn read_searched(&self) -> Result<Option<Vec<CaseResult>>, FolderError> {
        self.read_measured_of(SEARCHED)
    }

    /// Writes `missions.json`: what is told of missions made elsewhere.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write_missions(&self, told: &impl Serialize) -> Result<(), FolderError> {
        self.write_json(MISSIONS, told)
    }

    /// Reads it; `None` where the cases are none.
    ///
    /// # Errors
    /// The file is broken.
    pub fn read_missions<T: DeserializeOwned>(&self) -> Result<Option<T>, FolderError> {
        self.read_json_if_there(MISSIONS)
    }

    fn read_measured_of(&self, name: &str) -> Result<Option<Vec<CaseResult>>, FolderError> {
        let path = self.file(name);
        if !path.exists() {
            return Ok(None);
        }
        Ok(Some(results::read_counted(&path)?.into_iter().filter_map(|row| row.result).collect()))
    }

    /// Writes which cells of the grid of motion were met: `coverage.json`, and as a table `coverage.tsv`, a row per
    /// cell: with tabs, for every CSV of a campaign is a motion in time.
    ///
    /// # Errors
    /// A file cannot be written.
    pub fn write_coverage(&self, coverage: &Coverage) -> Result<(), FolderError> {
        let [json, tabs] = COVERAGE;
        self.write_json(json, coverage)?;
        let axes = &coverage.grid.axes;
        let mut table = axes.iter().flat_map(columns).chain(["cases".into()]).collect::<Vec<_>>().join("\t") + "\n";
        for cell in 0..coverage.cells {
            let places = coverage.grid.places(cell);
            let cells = axes.iter().zip(places).flat_map(|(axis, place)| match axis.words.get(place) {
                Some(word) => vec![word.clone()],
                None => vec![axis.edges[place].to_string(), axis.edges[place + 1].to_string()],
            });
            let cases = coverage.cases.get(&cell).copied().unwrap_or(0).to_string();
            table += &(cells.chain([cases]).collect::<Vec<_>>().join("\t") + "\n");
        }
        Ok(atomic::write(&self.file(tabs), table.as_bytes())?)
    }

    /// Which cells of the grid of motion were met; `None` before anything was judged.
    ///
    /// # Errors
    /// The file is broken.
    pub fn read_coverage(&self) -> Result<Option<Coverage>, FolderError> {
        let found: Option<Coverage> = self.read_json_if_there(COVERAGE[0])?;
        if found.as_ref().is_some_and(|found| !found.fits()) {
            let cause = io::Error::new(io::ErrorKind::InvalidData, "its grid and its cells do not fit together");
            return Err(FolderError::Unreadable { path: self.file(COVERAGE[0]), cause });
        }
        Ok(found)
    }

    /// Writes which parameter did it; nothing to say leaves no file.
    ///
    /// # Errors
    /// The file cannot be written, or an older one not be removed.
    pub fn write_influences(&self, found: &[Influence]) -> Result<(), FolderError> {
        if found.is_empty() {
            let path = self.file(INFLUENCE);
            return match fs::remove_file(&path) {
                Err(cause) if cause.kind() != io::ErrorKind::NotFound => Err(WriteError { path, cause }.into()),
                _ => Ok(()),
            };
        }
        self.write_json(INFLUENCE, &found)
    }

    /// Writes what every run of an arm did on every move.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write_moves(&self, moves: &Moves) -> Result<(), FolderError> {
        self.write_json(MOVES, moves)
    }

    /// Reads it; nothing where no arm was judged.
    ///
    /// # Errors
    /// The file is broken.
    pub fn read_moves(&self) -> Result<Moves, FolderError> {
        Ok(self.read_json_if_there(MOVES)?.unwrap_or_default())
    }

    /// Which parameter did it; nothing where nothing was varied or judged.
    ///
    /// # Errors
    /// The file is broken.
    pub fn read_influences(&self) -> Result<Vec<Influence>, FolderError> {
        Ok(self.read_json_if_there(INFLUENCE)?.unwrap_or_default())
    }
}

/// The columns of an axis in `coverage.tsv`: `speed_from_m_s` and `speed_to_m_s`, or its name where its cells have
/// words.
fn columns(axis: &Axis) -> Vec<String> {
    let snake = |text: &str| text.replace('°', "deg").replace('%', "percent").replace(['/', ' '], "_");
    let unit = if axis.unit.is_empty() { String::new() } else { format!("_{}", snake(&axis.unit)) };
    let name = snake(&axis.name);
    match axis.words.is_empty() {
        true => vec![format!("{name}_from{unit}"), format!("{name}_to{unit}")],
        false => vec![name],
    }
}
