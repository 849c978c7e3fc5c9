//! The logs of a folder: those in its subfolders too, for recorders write a folder a log (`ros2 bag record`) or a day
//! (PX4).

use std::collections::BTreeSet;
use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};

use hairpin_formats::logs::is_planned;

use super::told;
use crate::Problem;

/// Endings of what lies beside logs and is none: missions, programs of arms, documents.
const NO_LOGS: &[&str] = &[
    "md",
    "json",
    "toml",
    "html",
    "xml",
    "plan",
    "waypoints",
    "params",
    "mod",
    "pgf",
    "script",
    "src",
    "png",
    "svg",
    "pdf",
    "zip",
];
/// Endings of the recordings that a bag's folder holds.
const OF_BAGS: [&str; 4] = ["mcap", "db3", "zstd", "lz4"];
/// What ArduPilot writes beside its logs: the number of the last one.
const LAST_LOG: &str = "lastlog.txt";

/// What a folder holds.
#[derive(Debug, Default)]
pub(super) struct Files {
    /// Logs, by their paths within the folder.
    pub(super) logs: Vec<PathBuf>,
    /// What is none: files that by their names were planned and did not move, and folders of campaigns.
    pub(super) left_out: Vec<PathBuf>,
}

/// The files of a folder and of its subfolders, but for hidden ones, what is no log by its ending, and what belongs to
/// a recording: a bag's `metadata.yaml`, what SQLite keeps beside a database. Ordered by their paths, name by name.
///
/// A link to a folder is followed where it leads out of this one, and once; one that leads nowhere is a log that cannot
/// be read, as whatever lay there is not judged.
///
/// # Errors
/// A folder that cannot be read; none of them has a log.
pub(super) fn files_in(folder: &Path) -> Result<Files, Problem> {
    let root = folder.canonicalize().map_err(|cause| Problem::of_file(folder, cause))?;
    let mut walk = Walk { root, linked: BTreeSet::new(), found: Files::default() };
    walk.folder(folder)?;
    let Walk { mut found, .. } = walk;
    found.logs.sort();
    found.left_out.sort();
    if found.logs.is_empty() {
        let words = told::left_out(folder, &found.left_out).map_or(String::new(), |words| format!("; {words}"));
        return Err(Problem::of_file(folder, format!("no log in it{words}")));
    }
    Ok(found)
}

struct Walk {
    root: PathBuf,
    /// Folders that links led to, which are looked into once.
    linked: BTreeSet<PathBuf>,
    found: Files,
}

impl Walk {
    fn folder(&mut self, folder: &Path) -> Result<(), Problem> {
        let refuse = |cause| Problem::of_file(folder, cause);
        let entries = fs::read_dir(folder).map_err(refuse)?;
        let mut paths = entries.map(|entry| entry.map(|e| e.path())).collect::<Result<Vec<_>, _>>().map_err(refuse)?;
        paths.sort();
        let names: BTreeSet<String> = paths.iter().map(|path| small(path.file_name())).collect();
        for path in paths.iter().filter(|path| !small(path.file_name()).starts_with('.')) {
            if path.is_dir() {
                self.subfolder(path)?;
            } else if is_log(path, &names) {
                // A link that leads nowhere, or a pipe, is a log that cannot be read.
                let is_planned = is_planned(&told::file_name(path));
                let of = if is_planned { &mut self.found.left_out } else { &mut self.found.logs };
                of.push(path.clone());
            }
        }
        Ok(())
    }

    fn subfolder(&mut self, path: &Path) -> Result<(), Problem> {
        if path.join("scenario.toml").is_file() {
            self.found.left_out.push(path.into());
            return Ok(());
        }
        if path.is_symlink() {
            let to = path.canonicalize().map_err(|cause| Problem::of_file(path, cause))?;
            // What is in this folder is looked at under its own name, and what holds it would lead back to it.
            let is_known = to.starts_with(&self.root) || self.root.starts_with(&to);
            if is_known || self.linked.iter().any(|before| to.starts_with(before) || before.starts_with(&to)) {
                return Ok(());
            }
            self.linked.insert(to);
        }
        self.folder(path)
    }
}

fn small(part: Option<&OsStr>) -> String {
    part.unwrap_or_default().to_string_lossy().to_lowercase()
}

/// Whether `path` may be a log, in a folder of these `names`.
fn is_log(path: &Path, names: &BTreeSet<String>) -> bool {
    let (name, ending) = (small(path.file_name()), small(path.extension()));
    if NO_LOGS.contains(&ending.as_str()) || name == LAST_LOG {
        return false;
    }
    let is_bag = |name: &String| OF_BAGS.iter().any(|ending| name.ends_with(&format!(".{ending}")));
    // The data of a KRL module.
    let of_module = name.strip_suffix(".dat").is_some_and(|stem| names.contains(&format!("{stem}.src")));
    let of_bag = matches!(name.as_str(), "metadata.yaml" | "metadata.yml") && names.iter().any(is_bag);
    let of_database = ["-wal", "-shm", "-journal"].iter().any(|end| {
        name.strip_suffix(end).is_some_and(|database| database.ends_with(".db3") && names.contains(database))
    });
    !of_module && !of_bag && !of_database
}

#[cfg(test)]
mod tests {
    use tempfile::TempDir;

    use super::*;

    fn put(root: &Path, name: &str) {
        let path = root.join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, "x").unwrap();
    }

    fn within(root: &Path, paths: &[PathBuf]) -> Vec<String> {
        paths.iter().map(|path| path.strip_prefix(root).unwrap().to_string_lossy().into_owned()).collect()
    }

    #[test]
    fn a_folder_is_looked_into_as_deep_as_it_goes() {
        let place = TempDir::new().unwrap();
        let root = place.path();
        for name in [
            "b/b_0.mcap",
            "b/metadata.yaml",
            "b.csv",
            "a/log/2026-11-30/1.ulg",
            "c/d.db3",
            "c/d.db3-wal",
            "c/metadata.yaml",
            "metadata.yaml",
            "e/LASTLOG.TXT",
            "e/1.BIN",
            "f/0000.planned.csv",
            "out/scenario.toml",
            "out/runs.csv",
            ".hidden/1.ulg",
            "e/notes.md",
            "h/0000.mod",
            "h/0000.src",
            "h/0000.dat",
        ] {
            put(root, name);
        }
        let found = files_in(root).unwrap();
        // Beside no bag, nobody knows what it is.
        let logs = ["a/log/2026-11-30/1.ulg", "b/b_0.mcap", "b.csv", "c/d.db3", "e/1.BIN", "metadata.yaml"];
        assert_eq!(within(root, &found.logs), logs);
        assert_eq!(within(root, &found.left_out), ["f/0000.planned.csv", "out"]);
        let told = told::left_out(root, &found.left_out).unwrap();
        let words = "left out, by their names planned: f/0000.planned.csv; left out, folders of campaigns: out";
        assert_eq!(told, words);
        let own = files_in(&root.join("b")).unwrap();
        assert_eq!(within(root, &own.logs), ["b/b_0.mcap"]);
        let none = files_in(&root.join("out")).unwrap();
        assert_eq!(none.logs.len(), 1, "the folder itself is asked for by name");
        fs::create_dir_all(root.join("g/h")).unwrap();
        assert!(files_in(&root.join("g")).unwrap_err().to_string().contains("no log in it"));
    }

    #[cfg(unix)]
    #[test]
    fn links_do_not_lead_in_circles() {
        use std::os::unix::fs::symlink;
        let (place, away) = (TempDir::new().unwrap(), TempDir::new().unwrap());
        let root = place.path();
        put(root, "a/1.csv");
        put(away.path(), "2.csv");
        symlink(root, root.join("a/up")).unwrap();
        symlink(root.join("a"), root.join("0")).unwrap();
        symlink(away.path(), root.join("away")).unwrap();
        symlink(away.path(), root.join("once-more")).unwrap();
        symlink(away.path().join("2.csv"), root.join("3.csv")).unwrap();
        assert_eq!(within(root, &files_in(root).unwrap().logs), ["3.csv", "a/1.csv", "away/2.csv"]);
    }

    #[cfg(unix)]
    #[test]
    fn links_that_lead_nowhere_are_logs_that_cannot_be_read() {
        use std::os::unix::fs::symlink;
        let place = TempDir::new().unwrap();
        let root = place.path();
        put(root, "1.csv");
        for (to, link) in [("gone.ulg", "2.ulg"), ("gone", "2026-11-30"), ("5.csv", "5.csv"), ("gone.md", "notes.md")] {
            symlink(root.join(to), root.join(link)).unwrap();
        }
        assert_eq!(within(root, &files_in(root).unwrap().logs), ["1.csv", "2.ulg", "2026-11-30", "5.csv"]);
    }
}
