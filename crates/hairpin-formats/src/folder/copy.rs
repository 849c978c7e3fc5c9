//! Some cases of a campaign, copied into another folder.

use std::fs;
use std::path::Path;

use hairpin::campaign::CaseNumber;
use hairpin::campaign::learn::NAME;

use super::{ARCS, BEST_SO_FAR, CampaignFolder, FolderError, GRAPH, OPTIMUM, REASONS};

impl CampaignFolder {
    /// Copies planned motions and runs of `cases` into `there`, and what belongs to the campaign as a whole. Their
    /// tables are not copied: those of another campaign are its own.
    ///
    /// # Errors
    /// A file cannot be read or written.
    pub fn copy_cases(&self, cases: &[CaseNumber], there: &Self) -> Result<(), FolderError> {
        for &case in cases {
            copy(&self.trajectory_path(case), &there.trajectory_path(case))?;
            for run in (0..).take_while(|run| self.run_path(case, *run).exists()) {
                copy(&self.run_path(case, run), &there.run_path(case, run))?;
            }
            for again in 0..self.read_reruns(case)?.len() {
                copy(&self.rerun_path(case, again), &there.rerun_path(case, again))?;
            }
        }
        // What is proven of the first program is of no use without it.
        let optimum = cases.contains(&CaseNumber(0)).then_some(OPTIMUM);
        for name in [NAME, BEST_SO_FAR, GRAPH, REASONS, ARCS].into_iter().chain(optimum) {
            copy(&self.file(name), &there.file(name))?;
        }
        Ok(())
    }
}

/// Copies a file, if there is one.
fn copy(from: &Path, to: &Path) -> Result<(), FolderError> {
    let copied = if from.exists() { fs::copy(from, to).map(drop) } else { Ok(()) };
    copied.map_err(|cause| FolderError::Copy { from: from.into(), to: to.into(), cause })
}
