//! A campaign in parts, each a folder of the same kind, as several machines make them: put in place, taken over and
//! removed.

use std::collections::BTreeSet;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use hairpin::campaign::CaseNumber;

use super::list::List;
use super::names::{LIST, LOG, PART, PLAN, SCENARIO, stands_for};
use super::run_writer::{Landed, RunWriter};
use super::{CampaignFolder, FOLDERS, FolderError, LOCK, entries};
use crate::atomic::{self, WriteError, is_temporary};

/// Which run of which case was run again, and what came of it.
type Rerun = ((CaseNumber, usize), Landed);

impl CampaignFolder {
    /// `parts/part-NNNNN`.
    pub fn part_folder(&self, part: u64) -> PathBuf {
        self.parts().join(format!("part-{part:05}"))
    }

    /// Removes how it was divided and what came of that; what others have put beside the parts stays.
    ///
    /// # Errors
    /// Something cannot be removed.
    pub fn forget_parts(&self) -> Result<(), FolderError> {
        let ours = List::read(&self.path)?.unwrap_or_default();
        if ours.names(PLAN) {
            remove_file(&self.file(PLAN))?;
        }
        self.forget_rounds()?;
        self.forget_parts_where(&|path| is_part(path) || is_cut_short(path))
    }

    /// Removes what killed processes left of parts that they were making.
    ///
    /// # Errors
    /// Something cannot be removed.
    pub fn forget_parts_cut_short(&self) -> Result<(), FolderError> {
        self.forget_parts_where(&is_cut_short)
    }

    fn forget_parts_where(&self, goes: &dyn Fn(&Path) -> bool) -> Result<(), FolderError> {
        let place = self.parts();
        if fs::symlink_metadata(&place).is_ok_and(|found| found.is_dir()) {
            for path in entries(&place)?.into_iter().filter(|path| goes(path)) {
                fs::remove_dir_all(&path).map_err(|cause| WriteError { path, cause })?;
            }
            // One with other things in it stays.
            let _ = fs::remove_dir(place);
        }
        Ok(())
    }

    /// Copies all files of the campaign into `there`, whose scenario stays, the one last that says that they are whole.
    ///
    /// # Errors
    /// A file cannot be copied.
    pub fn copy_all(&self, there: &Self, last: &str) -> Result<(), FolderError> {
        let own = [SCENARIO, LIST, LOCK, PART, last];
        let mut files = entries(&self.path)?;
        files.retain(|path| path.is_file() && !own.iter().any(|own| path.ends_with(own)));
        for folder in FOLDERS.iter().map(|name| self.path.join(name)).filter(|folder| folder.is_dir()) {
            files.extend(entries(&folder)?);
        }
        files.push(self.file(last));
        for from in files.into_iter().filter(|file| file.is_file()) {
            let to = there.path.join(from.strip_prefix(&self.path).unwrap_or(&from));
            if let Some(folder) = to.parent() {
                atomic::make_folder(folder)?;
            }
            fs::copy(&from, &to).map_err(|cause| FolderError::Copy { from, to, cause })?;
        }
        Ok(())
    }

    /// Hands the runs of `cases` to `writer` as they stand here, and the logs of those that failed to `there`.
    ///
    /// # Errors
    /// A file cannot be read or written.
    pub fn hand_runs(&self, cases: &[CaseNumber], writer: &RunWriter, there: &Self) -> Result<(), FolderError> {
        for &case in cases {
            for facts in self.facts_of(case)? {
                writer.land(self.landed(super::parts::EXECUTIONS, facts)?)?;
            }
        }
        let numbers: BTreeSet<String> = cases.iter().map(CaseNumber::to_string).collect();
        for from in entries(&self.path)? {
            let name = from.file_name().unwrap_or_default().to_string_lossy().into_owned();
            let of = name.split('-').nth(1).is_some_and(|case| numbers.contains(case));
            if of && stands_for(LOG, &name) {
                let to = there.file(&name);
                fs::copy(&from, &to).map_err(|cause| FolderError::Copy { from, to, cause })?;
            }
        }
        Ok(())
    }

    /// The violations of `cases` that were run again.
    ///
    /// # Errors
    /// A file cannot be read.
    pub fn reruns_of(&self, cases: &[CaseNumber]) -> Result<Vec<Rerun>, FolderError> {
        let mut all = Vec::new();
        for &case in cases {
            for facts in self.rerun_facts_of(case)? {
                all.push(((case, facts.run), self.landed(super::parts::RERUNS, facts)?));
            }
        }
        Ok(all)
    }

    /// Takes in all of them.
    ///
    /// # Errors
    /// A part cannot be written.
    pub fn land_reruns(&self, all: Vec<Rerun>) -> Result<(), FolderError> {
        let repeat = all.iter().map(|((_, again), _)| again + 1).max().unwrap_or_default();
        let writer = self.write_reruns(repeat, all.iter().map(|(key, _)| *key));
        all.into_iter().try_for_each(|(_, landed)| writer.land(landed))?;
        writer.finish()
    }
}

/// Whether a folder is a part that was put there whole.
fn is_part(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    stands_for("part-PART", &name) && path.join(LIST).is_file()
}

/// Whether it is one that a process was making.
fn is_cut_short(path: &Path) -> bool {
    is_temporary(&path.file_name().unwrap_or_default().to_string_lossy()) && path.is_dir()
}

fn remove_file(path: &Path) -> Result<(), WriteError> {
    match fs::remove_file(path) {
        Err(cause) if cause.kind() != io::ErrorKind::NotFound => Err(WriteError { path: path.into(), cause }),
        _ => Ok(()),
    }
}
