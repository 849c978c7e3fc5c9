//! Some cases of a campaign, copied into another folder.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use hairpin::campaign::CaseNumber;
use hairpin::campaign::learn::NAME;

use super::parts::{EXECUTIONS, RERUNS, TRAJECTORIES};
use super::run_writer::Landed;
use super::{ARCS, BEST_SO_FAR, CampaignFolder, FolderError, GRAPH, MISSIONS, OPTIMUM, REASONS};
use crate::parquet::runs::RunFacts;
use crate::parquet::track;

impl CampaignFolder {
    /// Copies planned motions and runs of `cases` into `there`, and what belongs to the campaign as a whole. Their
    /// tables are not copied: those of another campaign are its own.
    ///
    /// # Errors
    /// A file cannot be read or written.
    pub fn copy_cases(&self, cases: &[CaseNumber], there: &Self) -> Result<(), FolderError> {
        self.copy_plans(cases, there)?;
        self.copy_runs(cases, there)
    }

    /// The same without the runs.
    ///
    /// # Errors
    /// As [`Self::copy_cases`].
    pub fn copy_plans(&self, cases: &[CaseNumber], there: &Self) -> Result<(), FolderError> {
        let mut planned = Vec::new();
        for &case in cases {
            let known = self.part_with(TRAJECTORIES, case)?.map(|part| part.piece((case, 0))).transpose()?.flatten();
            let piece = match known {
                Some(piece) => piece,
                None => track::planned(case, &self.read_planned(case)?)
                    .map_err(|cause| there.no_room(TRAJECTORIES, cause))?,
            };
            planned.push((case, piece));
        }
        there.write_planned(planned)?;
        // What is told of missions is told by their numbers, which cases keep. What is proven of the first program is
        // of no use without it.
        let optimum = cases.contains(&CaseNumber(0)).then_some(OPTIMUM);
        for name in [NAME, BEST_SO_FAR, GRAPH, REASONS, ARCS, MISSIONS].into_iter().chain(optimum) {
            copy(&self.file(name), &there.file(name))?;
        }
        Ok(())
    }

    fn copy_runs(&self, cases: &[CaseNumber], there: &Self) -> Result<(), FolderError> {
        let known: Result<Vec<Vec<RunFacts>>, FolderError> = cases.iter().map(|case| self.facts_of(*case)).collect();
        let known: Vec<RunFacts> = known?.into_iter().flatten().collect();
        let repeat = known.iter().map(|facts| facts.run + 1).max().unwrap_or_default();
        let writer = there.write_runs(repeat, known.iter().map(|facts| (facts.case, facts.run)));
        for facts in known {
            let (case, run) = (facts.case, facts.run);
            let landed = if self.run_path(case, run).exists() {
                let Some(run) = self.read_run(case, run)? else { continue };
                Landed::of(&run, &BTreeSet::new()).map_err(|cause| writer.no_room(cause))?
            } else {
                self.landed(EXECUTIONS, facts)?
            };
            writer.land(landed)?;
        }
        writer.finish()?;
        self.copy_reruns(cases, there)
    }

    fn copy_reruns(&self, cases: &[CaseNumber], there: &Self) -> Result<(), FolderError> {
        let mut all = Vec::new();
        for &case in cases {
            let known = self.reruns_of(&[case])?;
            if known.is_empty() {
                for (again, run) in self.read_reruns(case)?.iter().enumerate() {
                    let landed = Landed::again(run, again, &BTreeSet::new());
                    all.push(((case, again), landed.map_err(|cause| there.no_room(RERUNS, cause))?));
                }
            }
            all.extend(known);
        }
        there.land_reruns(all)
    }

    /// A run that is known by `facts`, with its motion as it stands in `table`.
    pub(super) fn landed(&self, table: &str, facts: RunFacts) -> Result<Landed, FolderError> {
        let key = (facts.case, facts.run);
        let motion = self.part_with(table, facts.case)?.map(|part| part.piece(key)).transpose()?.flatten();
        Ok(Landed::known(facts, motion))
    }
}

/// Copies a file, if there is one.
fn copy(from: &Path, to: &Path) -> Result<(), FolderError> {
    let copied = if from.exists() { fs::copy(from, to).map(drop) } else { Ok(()) };
    copied.map_err(|cause| FolderError::Copy { from: from.into(), to: to.into(), cause })
}
