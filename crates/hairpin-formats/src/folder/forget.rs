//! What goes when a part of a campaign is done again: nothing may stay that was made of what is no longer there.

use std::fs;
use std::io;
use std::path::PathBuf;

use hairpin::campaign::learn::NAME;

use super::{
    ARCS, BEST_SO_FAR, COVERAGE, CampaignFolder, FOLDERS, FolderError, GENERATION, INFLUENCE, MOVES, OPTIMUM, RESULTS,
    RUNS, WAYPOINTS, entries,
};
use crate::atomic::{self, WriteError};

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
        self.remove(&[RUNS, INFLUENCE, MOVES, coverage, table, "junit.xml", "report.html"], &["executions", "reruns"])
    }

    /// Removes the campaign's products, the ones first whose presence says that others are complete.
    ///
    /// # Errors
    /// A file cannot be removed.
    pub fn forget_cases(&self) -> Result<(), FolderError> {
        let [coverage, table] = COVERAGE;
        let names = [
            RESULTS,
            RUNS,
            INFLUENCE,
            MOVES,
            OPTIMUM,
            ARCS,
            coverage,
            table,
            WAYPOINTS,
            GENERATION,
            BEST_SO_FAR,
            "junit.xml",
            "report.html",
        ];
        self.remove(&names, &["trajectories", "profiles", "programs", "executions", "reruns"])
    }

    /// Removes a model of legs: another campaign's is none of this one's.
    pub(super) fn forget_model(&self) -> Result<(), FolderError> {
        self.remove(&[NAME], &[])
    }

    /// Removes `names`, the tables in `folders`, what was exported, and the executors' logs, which are of runs that go.
    fn remove(&self, names: &[&str], folders: &[&str]) -> Result<(), FolderError> {
        let remove = |path: PathBuf| match fs::remove_file(&path) {
            Err(cause) if cause.kind() != io::ErrorKind::NotFound => Err(WriteError { path, cause }),
            _ => Ok(()),
        };
        for name in names {
            remove(self.file(name))?;
        }
        let made_of_runs = |path: &PathBuf| {
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            is_export(&name) || (name.starts_with("executor-") && name.ends_with(".log"))
        };
        for path in entries(&self.path)?.into_iter().filter(made_of_runs) {
            remove(path)?;
        }
        for name in folders {
            for path in entries(&self.path.join(name))? {
                if path.extension().is_some_and(|extension| extension == "parquet" || extension == "mod") {
                    remove(path)?;
                }
            }
        }
        Ok(())
    }
}

/// Whether a file's name is one that [`CampaignFolder::planned_csv_path`], [`CampaignFolder::run_csv_path`] or
/// [`crate::tum::write_pair`] gives: other people's files beside them stay.
fn is_export(name: &str) -> bool {
    let number = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    let case = |text: &str| text.len() >= 4 && number(text);
    match name.split_once('.') {
        Some((
            stem,
            "ref.tum" | "exec.tum" | "planned.csv" | "joint_trajectory.json" | "pgf" | "script" | "src" | "dat",
        )) => case(stem),
        Some((stem, "mod")) => case(stem.strip_suffix("_slow").unwrap_or(stem)),
        Some((stem, "csv")) => stem.split_once('-').is_some_and(|(name, run)| case(name) && number(run)),
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::is_export;

    #[test]
    fn only_our_own_exports_go() {
        for name in [
            "0000.ref.tum",
            "0012.exec.tum",
            "10000.planned.csv",
            "0000-0.csv",
            "0117-12.csv",
            "0003.mod",
            "0003_slow.mod",
        ] {
            assert!(is_export(name), "{name}");
        }
        for name in ["mine.csv", "0000.csv", "000-0.csv", "0000-.csv", "0000-a.csv", "a0000.ref.tum", "0000.tum", ""] {
            assert!(!is_export(name), "{name}");
        }
    }
}
