//! `.hairpin`: what of a campaign's folder is hairpin's own. Nothing else in it is replaced or removed; so a folder of
//! the user's that merely has a `scenario.toml` keeps what is in it.
//!
//! A name a line, below the folder; `CASE` and `RUN` stand for numbers; `#` begins a comment. It is written when the
//! folder is still empty, so that whatever comes under these names later is hairpin's.

use std::collections::BTreeSet;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use super::error::FolderError;
use super::names::{
    EXPORT, GENERATION, LIST, OURS, RESULTS, SCENARIO, WAYPOINTS, earlier_exports, exports, stands_for,
};
use crate::atomic;
use crate::bounds::{self, MOST_TEXT_BYTES};
use crate::scenario::read_made_by;

/// No list that hairpin writes comes near it, bytes.
const LARGEST: u64 = 1 << 20;
/// What the copies of files that a scenario names are called, without their endings.
const COPIES: [&str; 5] = ["terrain", "cloud", "costs", "score", "baseline"];
/// What is written to be looked at, and never read again.
const SHOWN: [&str; 2] = ["junit.xml", "report.html"];
const HEAD: &str = "# What hairpin writes in this folder; whatever has another name it neither replaces nor removes.\n";

/// The names in a folder that are hairpin's own.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct List(BTreeSet<String>);

impl List {
    /// That of the folder at `path`; `None` where there is none.
    ///
    /// # Errors
    /// It cannot be read, or a name in it leads out of the folder.
    pub(super) fn read(path: &Path) -> Result<Option<Self>, FolderError> {
        let file = path.join(LIST);
        let refuse = |cause| FolderError::Unreadable { path: file.clone(), cause };
        let text = match bounds::read_text(&file, LARGEST) {
            Err(cause) if cause.kind() == io::ErrorKind::NotFound => return Ok(None),
            text => text.map_err(refuse)?,
        };
        let mut names = BTreeSet::new();
        for (line, name) in text.lines().enumerate() {
            if name.trim().is_empty() || name.starts_with('#') {
                continue;
            }
            if !is_below(name) {
                return Err(FolderError::Listed { path: file, line: line + 1, name: name.to_owned() });
            }
            names.insert(name.to_owned());
        }
        Ok(Some(Self(names)))
    }

    /// Whether `name`, relative to the folder, is one of its names.
    pub(super) fn names(&self, name: &str) -> bool {
        self.0.iter().any(|pattern| stands_for(pattern, name))
    }

    /// Whether `path` is what `export` wrote into a campaign's folder.
    pub(super) fn has_exported(path: &Path) -> bool {
        let folder = path.parent().filter(|folder| folder.file_name().is_some_and(|name| name == EXPORT));
        let name = path.file_name().map(|name| format!("{EXPORT}/{}", name.to_string_lossy()));
        let ours = folder.and_then(Path::parent).and_then(|campaign| Self::read(campaign).ok()).flatten();
        ours.zip(name).is_some_and(|(ours, name)| ours.names(&name))
    }

    /// Whether `path`, in a campaign's folder or in one of its folders, is what that campaign is read from.
    pub(super) fn is_read_from(path: &Path) -> bool {
        let path = std::path::absolute(path).unwrap_or_else(|_| path.into());
        let mut folders = path.ancestors().skip(1).take(2);
        folders.any(|folder| {
            let name =
                path.strip_prefix(folder).map(|name| name.to_string_lossy().replace('\\', "/")).unwrap_or_default();
            let is_shown = SHOWN.contains(&name.as_str());
            !is_shown && Self::read(folder).ok().flatten().is_some_and(|ours| name == LIST || ours.names(&name))
        })
    }

    /// Takes `more` names in, and writes the list of the folder at `path` where it then has more than before.
    ///
    /// # Errors
    /// Something stands there already under a name that is new: it is not hairpin's. The list cannot be written.
    pub(super) fn take_in(&mut self, path: &Path, more: &[impl AsRef<str>]) -> Result<(), FolderError> {
        let new: Vec<&str> = more.iter().map(AsRef::as_ref).filter(|name| !self.0.contains(*name)).collect();
        if new.is_empty() {
            return Ok(());
        }
        if let Some(found) = new.iter().find_map(|pattern| standing(path, pattern)) {
            return Err(FolderError::NotOurs { path: found });
        }
        self.0.extend(new.into_iter().map(str::to_owned));
        self.write(path)
    }

    /// Makes the list of a campaign that an earlier version began, where every such name is its own.
    ///
    /// # Errors
    /// The list cannot be written.
    pub(super) fn adopt(path: &Path) -> Result<(), FolderError> {
        Self(all().into_iter().chain(copies(path)).collect()).write(path)
    }

    fn write(&self, path: &Path) -> Result<(), FolderError> {
        let names: String = self.0.iter().map(|name| format!("{name}\n")).collect();
        Ok(atomic::write(&path.join(LIST), (HEAD.to_owned() + &names).as_bytes())?)
    }
}

/// Every name that hairpin gives, but for the copies of files that a scenario names.
pub(super) fn all() -> Vec<String> {
    OURS.iter().map(|name| (*name).to_owned()).chain(earlier_exports()).chain(exports()).collect()
}

/// Whether a campaign without a list is one that an earlier version made: that left its name and version in the
/// scenario, and its lock or its cases.
pub(super) fn is_of_an_earlier_version(path: &Path, lock: &str) -> bool {
    let there = |name: &str| path.join(name).is_file();
    let made = bounds::read_text(&path.join(SCENARIO), MOST_TEXT_BYTES).is_ok_and(|text| read_made_by(&text).is_some());
    made && (there(lock) || [GENERATION, RESULTS, WAYPOINTS].into_iter().all(there))
}

/// The copies of files that a scenario names, as they lie in the folder of an earlier version.
fn copies(path: &Path) -> Vec<String> {
    let names = fs::read_dir(path).into_iter().flatten().flatten().map(|entry| entry.file_name());
    let names = names.filter_map(|name| name.into_string().ok());
    let is_copy = |name: &String| name.split_once('.').is_some_and(|(stem, _)| COPIES.contains(&stem));
    names.filter(|name| is_copy(name) && is_below(name)).collect()
}

/// The first that stands in the folder at `path` under a name that `pattern` stands for.
fn standing(path: &Path, pattern: &str) -> Option<PathBuf> {
    let (folder, last) =
        pattern.rsplit_once('/').map_or((path.to_owned(), pattern), |(up, last)| (path.join(up), last));
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    entries.map(|entry| entry.path()).find(|found| {
        let name = found.file_name().unwrap_or_default();
        name.to_str().is_some_and(|name| stands_for(last, name))
    })
}

/// Whether a name stays below the folder that it is relative to, and has one way to be written.
fn is_below(name: &str) -> bool {
    let plain = |part: &str| !part.is_empty() && part != "." && part != ".." && part.trim() == part;
    !name.contains(['\\', ':', '\0']) && name.split('/').all(plain)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_campaign_is_read_from_is_no_place_for_other_files() {
        let place = tempfile::tempdir().unwrap();
        List::default().take_in(place.path(), &all()).unwrap();
        for name in ["results.parquet", "scenario.toml", "runs/part-00000.parquet", "repro/0003.json", ".hairpin"] {
            assert!(List::is_read_from(&place.path().join(name)), "{name}");
        }
        for name in ["junit.xml", "report.html", "mine.html", "mine/results.parquet", "runs/mine.xml"] {
            assert!(!List::is_read_from(&place.path().join(name)), "{name}");
        }
        assert!(!List::is_read_from(Path::new("results.parquet")));
    }

    #[test]
    fn names_lie_below_the_folder() {
        let place = tempfile::tempdir().unwrap();
        assert_eq!(List::read(place.path()).unwrap(), None);
        for name in ["../x", "/etc/passwd", "a/../../x", "./x", "a//b", "a/", "..", r"..\x", "c:x", " x"] {
            fs::write(place.path().join(LIST), format!("# ours\nresults.parquet\n{name}\n")).unwrap();
            let refused = List::read(place.path()).unwrap_err().to_string();
            assert!(refused.contains("line 3") && refused.contains("below the folder"), "{name}: {refused}");
        }
    }

    #[test]
    fn what_stands_there_before_is_not_ours() {
        let place = tempfile::tempdir().unwrap();
        let path = place.path();
        let mut list = List::default();
        list.take_in(path, &["results.parquet", "executions/CASE-RUN.parquet"]).unwrap();
        assert_eq!(List::read(path).unwrap().as_ref(), Some(&list));
        assert!(list.names("executions/0003-1.parquet") && !list.names("executions/notes.parquet"));
        fs::write(path.join("0001-2.csv"), "mine").unwrap();
        let refused = list.take_in(path, &["CASE-RUN.csv"]).unwrap_err().to_string();
        assert!(refused.contains("0001-2.csv"), "{refused}");
        assert!(!list.names("0001-2.csv"));
    }
}
