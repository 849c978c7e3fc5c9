//! What goes when a part of a campaign is done again: nothing may stay that was made of what is no longer there.

use std::fs;
use std::io;

use hairpin::campaign::learn::NAME;

use super::names::{ALL_RUNS, EXPORT};
use super::parts::{EXECUTIONS, PROFILES, PROGRAMS, RERUN_FACTS, RERUNS, TRAJECTORIES};
use super::{
    ARCS, BEST_SO_FAR, BY_CHANCE, COVERAGE, CampaignFolder, EXECUTED, EXECUTOR, FOLDERS, FolderError, GENERATION,
    INFLUENCE, LOG, List, MISSIONS, MOVES, OPTIMUM, RESULTS, RUNS, SEARCHED, WAYPOINTS, earlier_exports, entries,
    exports, exports_of_runs, stands_for,
};
use crate::atomic::{self, WriteError};

/// Folders of tables about runs.
const OF_RUNS: [&str; 4] = [RUNS, EXECUTIONS, RERUN_FACTS, RERUNS];

impl CampaignFolder {
    pub(super) fn remove_leftovers(&self) {
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
        let [coverage, table] = COVERAGE;
        let made =
            [ALL_RUNS, BY_CHANCE, SEARCHED, EXECUTOR, INFLUENCE, MOVES, coverage, table, "junit.xml", "report.html"];
        self.remove(&made, &OF_RUNS)
    }

    /// Removes the campaign's products, the ones first whose presence says that others are complete.
    ///
    /// # Errors
    /// A file cannot be removed.
    pub fn forget_cases(&self) -> Result<(), FolderError> {
        let [coverage, table] = COVERAGE;
        let names = [
            RESULTS,
            ALL_RUNS,
            BY_CHANCE,
            SEARCHED,
            MISSIONS,
            EXECUTOR,
            INFLUENCE,
            MOVES,
            OPTIMUM,
            ARCS,
            coverage,
            table,
            WAYPOINTS,
            GENERATION,
            BEST_SO_FAR,
            EXECUTED,
            "junit.xml",
            "report.html",
        ];
        self.remove(&names, &[&[TRAJECTORIES, PROFILES, PROGRAMS][..], &OF_RUNS[..]].concat())
    }

    /// Removes the cases by chance: they were measured otherwise than the campaign's now are.
    ///
    /// # Errors
    /// The file cannot be removed.
    pub fn forget_baseline(&self) -> Result<(), FolderError> {
        self.remove_one(BY_CHANCE)
    }

    /// Removes what a search found beside missions, likewise.
    ///
    /// # Errors
    /// The file cannot be removed.
    pub fn forget_searched(&self) -> Result<(), FolderError> {
        self.remove_one(SEARCHED)
    }

    pub(super) fn remove_one(&self, name: &str) -> Result<(), FolderError> {
        let ours = List::read(&self.path)?.unwrap_or_default();
        let path = self.file(name);
        match if ours.names(name) { fs::remove_file(&path) } else { Ok(()) } {
            Err(cause) if cause.kind() != io::ErrorKind::NotFound => Err(WriteError { path, cause }.into()),
            _ => Ok(()),
        }
    }

    /// Removes a model of legs: another campaign's is none of this one's.
    pub(super) fn forget_model(&self) -> Result<(), FolderError> {
        self.remove(&[NAME], &[])
    }

    /// Removes all that was exported: another campaign's files are none of this one's.
    pub(super) fn forget_exports(&self) -> Result<(), FolderError> {
        self.remove_exports(&exports().collect::<Vec<_>>())
    }

    /// Removes the exports that `patterns` stand for, and their folder where nothing else is in it.
    fn remove_exports(&self, patterns: &[String]) -> Result<(), FolderError> {
        let (ours, place) = (List::read(&self.path)?.unwrap_or_default(), self.file(EXPORT));
        for path in if place.is_dir() { entries(&place)? } else { Vec::new() } {
            let name = format!("{EXPORT}/{}", path.file_name().unwrap_or_default().to_string_lossy());
            if ours.names(&name) && patterns.iter().any(|pattern| stands_for(pattern, &name)) {
                fs::remove_file(&path).map_err(|cause| WriteError { path, cause })?;
            }
        }
        // One with other things in it stays.
        let _ = fs::remove_dir(place);
        Ok(())
    }

    /// Removes `names`, the tables in `folders`, what was exported, and the executors' logs, which are of runs that go:
    /// of all these, what the folder's list has.
    fn remove(&self, names: &[&str], folders: &[&str]) -> Result<(), FolderError> {
        let ours = List::read(&self.path)?.unwrap_or_default();
        let remove = |name: &str| {
            let path = self.file(name);
            match if ours.names(name) { fs::remove_file(&path) } else { Ok(()) } {
                Err(cause) if cause.kind() != io::ErrorKind::NotFound => Err(WriteError { path, cause }),
                _ => Ok(()),
            }
        };
        for name in names {
            remove(name)?;
        }
        self.remove_exports(&exports_of_runs().collect::<Vec<_>>())?;
        let exports: Vec<String> = earlier_exports().collect();
        for path in entries(&self.path)? {
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            if stands_for(LOG, &name) || exports.iter().any(|pattern| stands_for(pattern, &name)) {
                remove(&name)?;
            }
        }
        for folder in folders {
            let place = self.path.join(folder);
            let inside = if place.is_dir() { entries(&place)? } else { Vec::new() };
            for path in inside {
                if path.extension().is_some_and(|extension| extension == "parquet" || extension == "mod") {
                    remove(&format!("{folder}/{}", path.file_name().unwrap_or_default().to_string_lossy()))?;
                }
            }
            // One with other things in it stays.
            let _ = fs::remove_dir(place);
        }
        self.close_tables();
        if names.contains(&EXECUTOR) {
            self.set_executor_before(None);
        }
        Ok(())
    }
}
