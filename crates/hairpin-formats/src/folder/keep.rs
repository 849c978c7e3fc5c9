//! Of which runs the motion stays once all have landed.

use std::collections::BTreeSet;
use std::fs;
use std::io;
use std::path::Path;

use hairpin::campaign::CaseNumber;

use super::parts::{EXECUTIONS, part_number, parts_of};
use super::{CampaignFolder, FolderError, RUNS};
use crate::atomic::WriteError;
use crate::parquet::part::Part;
use crate::parquet::runs::{self, RunFacts};

impl CampaignFolder {
    /// Leaves out the motion of all runs but of those that `stay`; what is known and was measured of them remains. Runs
    /// in files of their own, as earlier versions wrote them, stay as they are.
    ///
    /// # Errors
    /// A part cannot be read or written.
    pub fn keep_motion_of(&self, stay: &dyn Fn(&RunFacts) -> bool) -> Result<(), FolderError> {
        for path in parts_of(&self.path, RUNS) {
            let Some(number) = part_number(&path) else { continue };
            let mut known = runs::read_facts(&path)?;
            let go = |facts: &&mut RunFacts| facts.recorded && facts.message.is_none() && !stay(facts);
            let left_out = known.values_mut().filter(go).map(|facts| facts.recorded = false).count();
            if left_out > 0 {
                // First what is known of them: nothing is said of motions that are not there.
                self.forget_facts(&path);
                runs::write_facts(&path, &known.values().cloned().collect::<Vec<_>>())?;
            }
            let there = known.into_iter().filter(|(_, facts)| facts.has_motion()).map(|(key, _)| key).collect();
            self.keep_pieces(number, &there)?;
        }
        // One with other things in it stays.
        let _ = fs::remove_dir(self.path.join(EXECUTIONS));
        Ok(())
    }

    /// Leaves what is not `there` out of a part of the executions; one that would be empty goes.
    fn keep_pieces(&self, number: usize, there: &BTreeSet<(CaseNumber, usize)>) -> Result<(), FolderError> {
        let path = self.part_path(EXECUTIONS, number);
        if !path.is_file() {
            return Ok(());
        }
        let old = self.open_parts.or_read(&path, Part::open)?;
        if old.keys().all(|key| there.contains(&key)) {
            return Ok(());
        }
        let mut part = self.begun_part(EXECUTIONS, number, &|case, run| there.contains(&(case, run)))?;
        let is_empty = part.keys().next().is_none();
        if is_empty { self.remove_part(&path) } else { self.save_part(EXECUTIONS, number, &mut part) }
    }

    fn remove_part(&self, path: &Path) -> Result<(), FolderError> {
        self.open_parts.forget(path);
        match fs::remove_file(path) {
            Err(cause) if cause.kind() != io::ErrorKind::NotFound => {
                Err(WriteError { path: path.into(), cause }.into())
            }
            _ => Ok(()),
        }
    }
}
