//! The campaign folder: where everything stands, and that it is whole. What `generate` leaves in it is enough for
//! `execute`, `judge`, `verify`, `replay` and `export`:
//!
//! | file | what |
//! | --- | --- |
//! | `scenario.toml` | the resolved scenario |
//! | `generation.json` | what the search did, in numbers |
//! | `results.parquet` | one row per case: seed, score, evidence; once judged, its worst run |
//! | `waypoints.parquet` | one row per waypoint of every case, with the planned leg times |
//! | `profiles/CASE.parquet` | the control witness, polynomials |
//! | `trajectories/CASE.parquet` | the planned motion, sampled |
//! | `executions/CASE-RUN.parquet` | one flight: poses, velocities, rotor speeds |
//! | `runs.parquet` | one row per flight: why it ended, when waypoints were reached, drawn values |
//! | `influence.json` | once judged, where `[vary]` was drawn: rank correlations, the strongest first |
//! | `missions/`, `repro/`, `junit.xml`, `report.html` | see the README |
//!
//! Files are written one by one and each at once, in an order in which each says no more than those before it: the cases'
//! own files, `waypoints.parquet`, `results.parquet`, `generation.json`.

use std::collections::BTreeMap;
use std::fs::{self, File, TryLockError};
use std::io;
use std::path::{Path, PathBuf};

use hairpin::campaign::{Case, CaseResult, Influence, Run, Tally};
use hairpin::trajectory::Track;
use thiserror::Error;

use crate::atomic::{self, WriteError};
use crate::parquet::results::Row;
use crate::parquet::runs::RunFacts;
use crate::parquet::{TableError, cases, profile, results, runs, track};

const SCENARIO: &str = "scenario.toml";
const GENERATION: &str = "generation.json";
const RESULTS: &str = "results.parquet";
const WAYPOINTS: &str = "waypoints.parquet";
const RUNS: &str = "runs.parquet";
const INFLUENCE: &str = "influence.json";
const LOCK: &str = ".lock";
const FOLDERS: [&str; 5] = ["trajectories", "profiles", "executions", "missions", "repro"];

/// Why a campaign folder cannot be used.
#[derive(Debug, Error)]
pub enum FolderError {
    /// A file cannot be written.
    #[error(transparent)]
    Write(#[from] WriteError),
    /// A table cannot be read.
    #[error(transparent)]
    Table(#[from] TableError),
    /// A file cannot be read.
    #[error("cannot read {}: {cause}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// The system's answer.
        cause: io::Error,
    },
    /// Not ours: writing into it could destroy something.
    #[error("{} is not empty and not a campaign folder (no {SCENARIO} in it): choose another --out", path.display())]
    Foreign {
        /// The folder.
        path: PathBuf,
    },
    /// No campaign stands here.
    #[error("{} is not a campaign folder: no {SCENARIO} in it", path.display())]
    NoCampaign {
        /// The folder.
        path: PathBuf,
    },
    /// Another process writes here.
    #[error("another hairpin is writing to {}", path.display())]
    Locked {
        /// The folder.
        path: PathBuf,
    },
    /// Files of one folder contradict each other.
    #[error("{}: case {case:04} {what}", path.display())]
    Contradiction {
        /// The file.
        path: PathBuf,
        /// Number of the case.
        case: usize,
        /// What is wrong with it.
        what: &'static str,
    },
}

/// What [`CampaignFolder::create`] does about a campaign that already stands there.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Existing {
    /// Its cases, runs and results go; `missions/` and `repro/` stay.
    Replace,
    /// It goes on (`--resume`).
    Resume,
}

/// A campaign folder. One that was created or opened for writing holds a lock until it is dropped.
#[derive(Debug)]
pub struct CampaignFolder {
    path: PathBuf,
    _lock: Option<File>,
}

impl CampaignFolder {
    /// Makes `path` a campaign folder to write to, and clears what a killed process left half-written.
    ///
    /// # Errors
    /// A folder with other things in it, one that another process writes to, one that cannot be made.
    pub fn create(path: &Path, existing: Existing) -> Result<Self, FolderError> {
        atomic::make_folder(path)?;
        if !is_campaign(path) && !is_vacant(path)? {
            return Err(FolderError::Foreign { path: path.into() });
        }
        let folder = Self { path: path.into(), _lock: lock(path)? };
        for name in FOLDERS {
            atomic::make_folder(&path.join(name))?;
        }
        folder.remove_leftovers();
        if existing == Existing::Replace {
            folder.forget_cases()?;
        }
        Ok(folder)
    }

    /// Opens a campaign to read it.
    ///
    /// # Errors
    /// `path` holds no campaign.
    pub fn open(path: &Path) -> Result<Self, FolderError> {
        if !is_campaign(path) {
            return Err(FolderError::NoCampaign { path: path.into() });
        }
        Ok(Self { path: path.into(), _lock: None })
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

    /// `NAME` in the folder, for files that others write (`junit.xml`, `missions/0007.plan`).
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
        fs::read_to_string(&path).map_err(|cause| FolderError::Unreadable { path, cause })
    }

    /// Writes what the search did.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write_tally(&self, tally: &Tally) -> Result<(), FolderError> {
        let mut text = serde_json::to_string_pretty(tally).expect("a tally is plain data");
        text.push('\n');
        Ok(atomic::write(&self.file(GENERATION), text.as_bytes())?)
    }

    /// What the search did.
    ///
    /// # Errors
    /// The file is missing or broken.
    pub fn read_tally(&self) -> Result<Tally, FolderError> {
        let path = self.file(GENERATION);
        let text = fs::read_to_string(&path);
        let tally = text.and_then(|text| serde_json::from_str(&text).map_err(io::Error::from));
        tally.map_err(|cause| FolderError::Unreadable { path, cause })
    }

    /// Writes generated cases; `results.parquet` has them with status `generated`.
    ///
    /// # Errors
    /// A file cannot be written.
    pub fn write_cases(&self, all: &[Case]) -> Result<(), FolderError> {
        self.write_new_cases(all, 0)
    }

    /// As [`Self::write_cases`], where the profiles of the first `old` cases are in the folder already.
    ///
    /// # Errors
    /// A file cannot be written.
    pub fn write_new_cases(&self, all: &[Case], old: usize) -> Result<(), FolderError> {
        for case in &all[old..] {
            if let Some(witness) = &case.profile {
                profile::write(&self.profile_path(case.number), witness)?;
            }
        }
        cases::write(&self.file(WAYPOINTS), all)?;
        self.write_results(all, &[])
    }

    /// Whether it is known what the search did.
    pub fn has_tally(&self) -> bool {
        self.file(GENERATION).is_file()
    }

    /// Whether there are cases, those of a checkpoint at least.
    pub fn has_cases(&self) -> bool {
        self.file(RESULTS).is_file() && self.file(WAYPOINTS).is_file()
    }

    /// Reads all cases, with their profiles where they have one.
    ///
    /// # Errors
    /// A file is missing or broken, or two contradict each other.
    pub fn read_cases(&self) -> Result<Vec<Case>, FolderError> {
        let mut all = self.read_cases_without_profiles()?;
        for case in &mut all {
            case.profile = self.read_profile(case.number)?;
        }
        Ok(all)
    }

    /// Reads all cases and leaves `profile` empty: for `verify`, where a broken profile is a finding about its case.
    ///
    /// # Errors
    /// As [`Self::read_cases`].
    pub fn read_cases_without_profiles(&self) -> Result<Vec<Case>, FolderError> {
        let path = self.file(WAYPOINTS);
        let mut routes = cases::read(&path)?;
        let contradiction = |case, what| FolderError::Contradiction { path: path.clone(), case, what };
        let mut all = Vec::new();
        for Row { mut case, length, .. } in self.read_rows()? {
            let number = case.number;
            let route = routes.remove(&number).ok_or_else(|| contradiction(number, "has no waypoints"))?;
            if route.waypoints.len() != length {
                return Err(contradiction(number, "has another number of waypoints than in results.parquet"));
            }
            (case.waypoints, case.leg_times) = (route.waypoints, route.leg_times);
            all.push(case);
        }
        // Waypoints are written first: those of higher numbers are of a checkpoint that a kill cut short.
        let last = all.iter().map(|case| case.number).max();
        match routes.keys().next() {
            Some(&number) if last.is_some_and(|last| number < last) => {
                Err(contradiction(number, "is not in results.parquet"))
            }
            _ => Ok(all),
        }
    }

    /// Reads the control witness of a case; `None` where it has none.
    ///
    /// # Errors
    /// The file is broken.
    pub fn read_profile(&self, case: usize) -> Result<Option<hairpin::trajectory::Profile>, FolderError> {
        let path = self.profile_path(case);
        Ok(if path.exists() { Some(profile::read(&path)?) } else { None })
    }

    /// Writes the planned motion of a case, sampled.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write_planned(&self, case: usize, planned: &Track) -> Result<(), FolderError> {
        Ok(track::write(&self.trajectory_path(case), planned)?)
    }

    /// Reads the planned motion of a case.
    ///
    /// # Errors
    /// The file is missing or broken.
    pub fn read_planned(&self, case: usize) -> Result<Track, FolderError> {
        Ok(track::read(&self.trajectory_path(case))?)
    }

    /// Writes one run.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write_run(&self, run: &Run) -> Result<(), FolderError> {
        Ok(runs::write_run(&self.run_path(run.case, run.run), run)?)
    }

    /// Whether this run was executed and can be read: what `--resume` skips.
    pub fn has_valid_run(&self, case: usize, run: usize) -> bool {
        let found = runs::read_run(&self.run_path(case, run));
        found.is_ok_and(|(_, facts)| facts.is_some_and(|facts| facts.case == case && facts.run == run))
    }

    /// Writes `runs.parquet`, once all runs are executed.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write_runs_table(&self, facts: &[RunFacts]) -> Result<(), FolderError> {
        Ok(runs::write_facts(&self.file(RUNS), facts)?)
    }

    /// Reads the runs of `case`, by number, as many as there are files `executions/CASE-RUN.parquet` from run 0 on.
    /// `table` is [`Self::read_runs_table`]'s: it fills in for files that another program rewrote.
    ///
    /// # Errors
    /// As [`Self::read_run`].
    pub fn read_runs(&self, case: usize, table: &BTreeMap<(usize, usize), RunFacts>) -> Result<Vec<Run>, FolderError> {
        let mut all = Vec::new();
        while let Some(run) = self.read_run(case, all.len(), table)? {
            all.push(run);
        }
        Ok(all)
    }

    /// Reads one run; `None` where it was not executed.
    ///
    /// # Errors
    /// The file is broken; nothing is known about the run; it says that it is another one.
    pub fn read_run(
        &self,
        case: usize,
        run: usize,
        table: &BTreeMap<(usize, usize), RunFacts>,
    ) -> Result<Option<Run>, FolderError> {
        let path = self.run_path(case, run);
        if !path.exists() {
            return Ok(None);
        }
        let (track, facts) = runs::read_run(&path)?;
        let contradiction = |what| FolderError::Contradiction { path: path.clone(), case, what };
        let facts = facts.or_else(|| table.get(&(case, run)).cloned());
        let facts = facts.ok_or_else(|| contradiction("has lost its metadata and is not in runs.parquet"))?;
        if (facts.case, facts.run) != (case, run) {
            return Err(contradiction("holds another run than its name says"));
        }
        facts.with_track(track).map(Some).ok_or_else(|| contradiction("ended for an unknown reason"))
    }

    /// Reads `runs.parquet`; empty where there is none.
    ///
    /// # Errors
    /// The file is broken.
    pub fn read_runs_table(&self) -> Result<BTreeMap<(usize, usize), RunFacts>, FolderError> {
        let path = self.file(RUNS);
        if !path.exists() {
            return Ok(BTreeMap::new());
        }
        Ok(runs::read_facts(&path)?.into_iter().map(|facts| ((facts.case, facts.run), facts)).collect())
    }

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
        let mut text = serde_json::to_string_pretty(found).expect("influences are plain data");
        text.push('\n');
        Ok(atomic::write(&self.file(INFLUENCE), text.as_bytes())?)
    }

    /// Which parameter did it; nothing where nothing was varied or judged.
    ///
    /// # Errors
    /// The file is broken.
    pub fn read_influences(&self) -> Result<Vec<Influence>, FolderError> {
        let path = self.file(INFLUENCE);
        match fs::read_to_string(&path) {
            Err(cause) if cause.kind() == io::ErrorKind::NotFound => Ok(Vec::new()),
            text => {
                let found = text.and_then(|text| serde_json::from_str(&text).map_err(io::Error::from));
                found.map_err(|cause| FolderError::Unreadable { path, cause })
            }
        }
    }

    /// `profiles/CASE.parquet`.
    pub fn profile_path(&self, case: usize) -> PathBuf {
        self.path.join("profiles").join(format!("{case:04}.parquet"))
    }

    /// `trajectories/CASE.parquet`.
    pub fn trajectory_path(&self, case: usize) -> PathBuf {
        self.path.join("trajectories").join(format!("{case:04}.parquet"))
    }

    /// `executions/CASE-RUN.parquet`.
    pub fn run_path(&self, case: usize, run: usize) -> PathBuf {
        self.path.join("executions").join(format!("{case:04}-{run}.parquet"))
    }

    fn remove_leftovers(&self) {
        atomic::remove_leftovers(&self.path);
        for name in FOLDERS {
            atomic::remove_leftovers(&self.path.join(name));
        }
    }

    /// Removes all flights and what was made of them; the cases stay.
    ///
    /// # Errors
    /// A file cannot be removed.
    pub fn forget_runs(&self) -> Result<(), FolderError> {
        self.remove(&[RUNS, INFLUENCE, "junit.xml", "report.html"], &["executions"])
    }

    /// Removes the campaign's products, the ones first whose presence says that others are complete.
    ///
    /// # Errors
    /// A file cannot be removed.
    pub fn forget_cases(&self) -> Result<(), FolderError> {
        let names = [RESULTS, RUNS, INFLUENCE, WAYPOINTS, GENERATION, "junit.xml", "report.html"];
        self.remove(&names, &["trajectories", "profiles", "executions"])
    }

    /// Removes `names`, the tables in `folders`, and the executors' logs, which are of runs that go.
    fn remove(&self, names: &[&str], folders: &[&str]) -> Result<(), FolderError> {
        let remove = |path: PathBuf| match fs::remove_file(&path) {
            Err(cause) if cause.kind() != io::ErrorKind::NotFound => Err(WriteError { path, cause }),
            _ => Ok(()),
        };
        for name in names {
            remove(self.file(name))?;
        }
        let is_log = |path: &PathBuf| {
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            name.starts_with("executor-") && name.ends_with(".log")
        };
        for path in entries(&self.path)?.into_iter().filter(is_log) {
            remove(path)?;
        }
        for name in folders {
            for path in entries(&self.path.join(name))? {
                if path.extension().is_some_and(|extension| extension == "parquet") {
                    remove(path)?;
                }
            }
        }
        Ok(())
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
        name == LOCK || atomic::is_temporary(&name) || (FOLDERS.contains(&name.as_str()) && empty())
    };
    Ok(entries(path)?.iter().all(ours))
}

fn entries(path: &Path) -> Result<Vec<PathBuf>, FolderError> {
    let refuse = |cause| FolderError::Unreadable { path: path.into(), cause };
    let entries = fs::read_dir(path).map_err(refuse)?;
    entries.map(|entry| entry.map(|entry| entry.path()).map_err(refuse)).collect()
}

/// The folder's lock, held by the open file. Where the file system knows no locks there is none.
fn lock(path: &Path) -> Result<Option<File>, FolderError> {
    let file = path.join(LOCK);
    let open = File::options().create(true).append(true).open(&file);
    let opened = open.map_err(|cause| FolderError::Write(WriteError { path: file, cause }))?;
    match opened.try_lock() {
        Ok(()) => Ok(Some(opened)),
        Err(TryLockError::WouldBlock) => Err(FolderError::Locked { path: path.into() }),
        Err(TryLockError::Error(_)) => Ok(None),
    }
}
