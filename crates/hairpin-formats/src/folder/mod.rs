//! The campaign folder: where everything stands, and that it is whole. What `generate` leaves in it is enough for
//! `execute`, `judge`, `verify`, `replay` and `export`:
//!
//! | file | what |
//! | --- | --- |
//! | `scenario.toml` | the resolved scenario |
//! | `generation.json` | what the search did, in numbers |
//! | `results.parquet` | one row per case: seed, score, evidence; once judged, its worst run |
//! | `waypoints.parquet` | one row per waypoint of every case, with the planned leg times |
//! | `profiles/` | the control witness, polynomials or a drive's segments |
//! | `programs/` | what an arm runs, as RAPID |
//! | `trajectories/` | the planned motion, the rows where it bends |
//! | `executions/` | flights: poses, velocities, rotor speeds, the rows where they bend |
//! | `runs/` | one row per flight: why it ended, when waypoints were reached, what was measured, drawn values |
//! | `best-so-far.tsv` | of searches that execute: where the largest stress of a graph rose as executions went on |
//! | `executed.tsv` | of a search that was stopped: what it executed, so that going on does not do it again |
//! | `score-model.json` | the model of a learned score; of an adaptive campaign what it learned itself |
//! | `searched.parquet` | beside missions made elsewhere: what a search found, likewise; not judged |
//! | `missions.json` | of missions made elsewhere: file, frame, what their check said |
//! | `baseline.parquet` | random feasible cases that were run alike, as `results.parquet`; not judged |
//! | `reruns/`, `rerun-runs/` | the same of violations run again with other noise, `run` numbering the times |
//! | `coverage.json`, `coverage.tsv` | once judged, which cells of the grid of motion were met, and by how many cases |
//! | `influence.json` | once judged, where `[vary]` was drawn: rank correlations, the strongest first |
//! | `moves.json` | of arms, once judged: what every run did on every move; `baseline.json`: of earlier releases |
//! | `optimum.json` | of arms: the proof that the first program is the heaviest |
//! | `graph.csv`, `reasons.csv`, `arcs.csv` | of arms: the graph, why moves are not in it, its arcs where it has any |
//! | `repro/`, `junit.xml`, `report.html` | see the README |
//! | `plan.json`, `parts/` | of a campaign for several machines: how it is divided, and what each of them made |
//! | `export/` | what was exported; of earlier versions `missions/` and files in the folder itself |
//! | `.hairpin` | the names in the folder that are hairpin's own: nothing else in it is replaced or removed |
//!
//! Folders of tables hold parts, `part-00000.parquet` and so on: blocks of whole cases, a row group for each case or
//! run (of `runs/` one in all). A table may also be one file, `NAME.parquet`; folders of earlier versions have a file
//! for each case or run, `NAME/CASE.parquet`, `programs/CASE.mod` and `NAME/CASE-RUN.parquet`, and are read, not
//! written.
//!
//! Files are written one by one and each at once, in an order in which each says no more than those before it: the
//! cases' own files, `waypoints.parquet`, `results.parquet`, `generation.json`.
//!
//! A folder may come from a stranger. Nothing in it is followed out of it: it is refused if it holds a link.

mod cases;
mod content;
mod copy;
mod division;
mod error;
mod executed;
mod executor;
mod forget;
mod graph;
mod inside;
mod json;
mod judged;
mod keep;
mod list;
mod names;
mod parts;
mod recent;
mod rounds;
mod run_writer;
mod runs;
mod scenario;
mod tables;

use std::fs::{self, File, TryLockError};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, OnceLock};

use hairpin::campaign::{Curve, Tally};

use crate::atomic::{self, WriteError};
use crate::bounds::{self, MOST_TEXT_BYTES};
use crate::executor::Greeting;
use crate::parquet::part::Part;
use crate::parquet::runs::Facts;
use crate::rapid::Frames;

pub use error::FolderError;
pub use graph::graph_decimals;
pub use inside::inside;
use inside::refuse_links;
use list::{List, all, is_of_an_earlier_version};
pub use names::{
    ARCS, BASELINE, BEST_SO_FAR, BY_CHANCE, GRAPH, MISSIONS, MOVES, OPTIMUM, PART, PLAN, REASONS, SEARCHED,
};
use names::{
    COVERAGE, EXECUTED, EXECUTOR, EXPORT, GENERATION, INFLUENCE, LIST, LOG, RESULTS, RUNS, WAYPOINTS, earlier_exports,
    exports, exports_of_runs, stands_for,
};
pub(crate) use names::{SCENARIO, is_of_a_motion, is_written_to};

/// Refuses a place that the user chose for a file where a campaign keeps what it is read from.
///
/// # Errors
/// [`FolderError::Own`].
pub fn refuse_own(path: &Path) -> Result<(), FolderError> {
    if List::is_read_from(path) { Err(FolderError::Own { path: path.into() }) } else { Ok(()) }
}

/// Whether `path` is what `export` wrote into a campaign's folder.
pub(crate) fn is_exported(path: &Path) -> bool {
    List::has_exported(path)
}
use recent::Recent;
pub use rounds::{ALIVE, Piece, executor_of_rounds, first_executor_of_rounds};
pub use run_writer::{Landed, RunWriter};

const LOCK: &str = ".lock";
const FOLDERS: [&str; 10] =
    ["trajectories", "profiles", "programs", "executions", "runs", "reruns", "rerun-runs", "missions", "repro", EXPORT];

/// What [`CampaignFolder::create`] does about a campaign that already stands there.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Existing {
    /// Its cases, runs, results and exports go; `missions/` and `repro/` stay.
    Replace,
    /// It goes on (`--resume`).
    Resume,
}

/// A campaign folder. One that was created or opened for writing holds a lock until it is dropped.
#[derive(Debug)]
pub struct CampaignFolder {
    path: PathBuf,
    _lock: Option<Lock>,
    /// What its programs find on the controller, once somebody asked.
    frames: OnceLock<Frames>,
    open_parts: Recent<Part>,
    facts: Recent<Facts>,
    /// Who executed what stood there before this process, once somebody asked.
    executor_before: Mutex<Option<Option<Greeting>>>,
}

impl CampaignFolder {
    /// Makes `path` a campaign folder to write to, and clears what a killed process left half-written.
    ///
    /// # Errors
    /// A folder with other things in it, or that hairpin has not made; one that another process writes to; one that
    /// cannot be made.
    pub fn create(path: &Path, existing: Existing) -> Result<Self, FolderError> {
        atomic::make_folder(path)?;
        if !is_campaign(path) && !is_vacant(path)? {
            return Err(FolderError::Foreign { path: path.into() });
        }
        refuse_links(path, &FOLDERS)?;
        Self::refuse_anothers(path)?;
        let list = List::read(path)?;
        let folder = Self::at(path, lock(path)?);
        match list {
            None if is_campaign(path) => List::adopt(path)?,
            list => list.unwrap_or_default().take_in(path, &all())?,
        }
        folder.remove_leftovers();
        if existing == Existing::Replace {
            folder.forget_cases()?;
            folder.forget_exports()?;
            folder.forget_model()?;
            folder.forget_parts()?;
        }
        Ok(folder)
    }

    /// Refuses a folder that has a scenario and was not made by hairpin: whatever is in it is the user's.
    ///
    /// # Errors
    /// It is one.
    pub fn refuse_anothers(path: &Path) -> Result<(), FolderError> {
        if is_campaign(path) && !path.join(LIST).exists() && !is_of_an_earlier_version(path, LOCK) {
            return Err(FolderError::Unlisted { path: path.into() });
        }
        Ok(())
    }

    /// Opens a campaign to read it.
    ///
    /// # Errors
    /// `path` holds no campaign, or one with links in it.
    pub fn open(path: &Path) -> Result<Self, FolderError> {
        if !is_campaign(path) {
            return Err(FolderError::NoCampaign { path: path.into() });
        }
        refuse_links(path, &FOLDERS)?;
        List::read(path)?;
        Ok(Self::at(path, None))
    }

    fn at(path: &Path, lock: Option<Lock>) -> Self {
        let (open_parts, facts) = (Recent::default(), Recent::default());
        let executor_before = Mutex::default();
        Self { path: path.into(), _lock: lock, frames: OnceLock::new(), open_parts, facts, executor_before }
    }

    /// Opens a campaign to read it and to add to it.
    ///
    /// # Errors
    /// `path` holds no campaign; another process writes to it.
    pub fn open_to_write(path: &Path) -> Result<Self, FolderError> {
        Self::open(path)?;
        Self::create(path, Existing::Resume)
    }

    /// Where it stands.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Where exports go, made where it is not there yet. What stands there under a name of theirs is hairpin's own.
    ///
    /// # Errors
    /// The folder cannot be made; something of that name stands there that is not hairpin's.
    pub fn export_folder(&self) -> Result<PathBuf, FolderError> {
        if let Some(mut list) = List::read(&self.path)? {
            list.take_in(&self.path, &exports().collect::<Vec<_>>())?;
        }
        let place = self.file(EXPORT);
        atomic::make_folder(&place)?;
        Ok(place)
    }

    /// `NAME` in the folder, for files that others write (`junit.xml`).
    pub fn file(&self, name: &str) -> PathBuf {
        self.path.join(name)
    }

    /// Writes the resolved scenario's text.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write_scenario(&self, text: &str) -> Result<(), FolderError> {
        Ok(atomic::write(&self.file(SCENARIO), text.as_bytes())?)
    }

    /// The resolved scenario's text.
    ///
    /// # Errors
    /// The file cannot be read.
    pub fn read_scenario(&self) -> Result<String, FolderError> {
        let path = self.file(SCENARIO);
        bounds::read_text(&path, MOST_TEXT_BYTES).map_err(|cause| FolderError::Unreadable { path, cause })
    }

    /// Writes what the search did.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write_tally(&self, tally: &Tally) -> Result<(), FolderError> {
        self.write_json(GENERATION, tally)
    }

    /// What the search did.
    ///
    /// # Errors
    /// The file is missing or broken.
    pub fn read_tally(&self) -> Result<Tally, FolderError> {
        Ok(Tally { clear_within_mm: self.clear_within_mm()?, ..self.read_json(GENERATION)? })
    }

    /// Writes where the largest stress executed in a graph rose, a row each, and where it stood at the end; nothing to
    /// say leaves no file.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write_curves(&self, column: &str, curves: &[Curve]) -> Result<(), FolderError> {
        if curves.is_empty() {
            return Ok(());
        }
        let mut table = format!("graph\texecutions\t{column}\n");
        for Curve { graph, executions, rises } in curves {
            let end = rises.last().filter(|(at, _)| at < executions).map(|(_, most)| (*executions, *most));
            for (at, most) in rises.iter().copied().chain(end) {
                table += &format!("{graph}\t{at}\t{most}\n");
            }
        }
        Ok(atomic::write(&self.file(BEST_SO_FAR), table.as_bytes())?)
    }

    /// Whether it is known what the search did.
    pub fn has_tally(&self) -> bool {
        self.file(GENERATION).is_file()
    }
}

fn is_campaign(path: &Path) -> bool {
    path.join(SCENARIO).is_file()
}

/// Whether there is nothing in a folder but what a killed `create` may have left.
fn is_vacant(path: &Path) -> Result<bool, FolderError> {
    let ours = |path: &PathBuf| {
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let empty = || entries(path).is_ok_and(|inside| inside.is_empty());
        name == LOCK || name == LIST || atomic::is_temporary(&name) || (FOLDERS.contains(&name.as_str()) && empty())
    };
    Ok(entries(path)?.iter().all(ours))
}

fn entries(path: &Path) -> Result<Vec<PathBuf>, FolderError> {
    let refuse = |cause| FolderError::Unreadable { path: path.into(), cause };
    let entries = fs::read_dir(path).map_err(refuse)?;
    entries.map(|entry| entry.map(|entry| entry.path()).map_err(refuse)).collect()
}

/// A folder's lock. It is let go by name: a child that another thread starts holds the same open file until it is
/// the child's own program, or for good where it only forks.
#[derive(Debug)]
struct Lock(File);

impl Drop for Lock {
    fn drop(&mut self) {
        let _ = self.0.unlock(); // then it goes with the last that has the file open
    }
}

/// The folder's lock. Where the file system knows no locks there is none.
fn lock(path: &Path) -> Result<Option<Lock>, FolderError> {
    let file = path.join(LOCK);
    let open = File::options().create(true).append(true).open(&file);
    let opened = open.map_err(|cause| FolderError::Write(WriteError { path: file, cause }))?;
    match opened.try_lock() {
        Ok(()) => Ok(Some(Lock(opened))),
        Err(TryLockError::WouldBlock) => Err(FolderError::Locked { path: path.into() }),
        Err(TryLockError::Error(_)) => Ok(None),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// As in a process whose other threads start programs just then.
    #[test]
    fn a_lock_is_let_go_though_a_child_has_the_file_open() {
        let place = tempfile::tempdir().unwrap();
        let first = CampaignFolder::create(place.path(), Existing::Replace).unwrap();
        let childs = first._lock.as_ref().map(|Lock(file)| file.try_clone().unwrap());
        assert!(matches!(CampaignFolder::create(place.path(), Existing::Replace), Err(FolderError::Locked { .. })));
        drop(first);
        CampaignFolder::create(place.path(), Existing::Replace).unwrap();
        drop(childs);
    }
}
