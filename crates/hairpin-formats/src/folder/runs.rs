//! The runs of a campaign folder: what is known of each, and its motion. Folders with a file per run are read as well.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use hairpin::campaign::{CaseNumber, Run};
use hairpin::trajectory::Track;

use super::parts::{EXECUTIONS, RERUN_FACTS, RERUNS, part_with, parts_of};
use super::{CampaignFolder, FolderError, RUNS};
use crate::executor::was_never_asked;
use crate::parquet::runs::{self, Facts, RunFacts};
use crate::parquet::track;

/// Time between samples where nothing says it any more, s.
const USUAL_PERIOD: f64 = 0.01;

fn cases_of(facts: &Facts) -> Option<(CaseNumber, CaseNumber)> {
    Some((facts.first_key_value()?.0.0, facts.last_key_value()?.0.0))
}

impl CampaignFolder {
    pub(super) fn forget_facts(&self, path: &Path) {
        self.facts.forget(path);
    }

    /// What is known of the runs of all cases around `case`; nothing where none landed.
    fn facts_around(&self, table: &str, case: CaseNumber) -> Result<Arc<Facts>, FolderError> {
        if let Some(facts) = self.facts.find(|path, facts| self.is_around(table, case, (path, cases_of(facts)))) {
            return Ok(facts);
        }
        let found = part_with(&parts_of(&self.path, table), case, |path| {
            let facts = self.facts.or_read(path, runs::read_facts)?;
            let cases = cases_of(&facts);
            Ok((facts, cases))
        })?;
        Ok(found.unwrap_or_default())
    }

    /// What is known of the runs of `case`, in their order.
    ///
    /// # Errors
    /// A file is broken.
    pub fn facts_of(&self, case: CaseNumber) -> Result<Vec<RunFacts>, FolderError> {
        let mut known = self.facts_in(RUNS, case)?;
        // A file per run says it of its own.
        let in_files = (0..).take_while(|run| self.run_path(case, *run).exists());
        for run in in_files.filter(|run| known.iter().all(|facts| facts.run != *run)).collect::<Vec<usize>>() {
            known.extend(runs::read_run(&self.run_path(case, run))?.1);
        }
        known.sort_by_key(|facts| facts.run);
        Ok(known)
    }

    /// The same of the runs of `case` that were flown again, by the number of the time.
    ///
    /// # Errors
    /// A file is broken.
    pub fn rerun_facts_of(&self, case: CaseNumber) -> Result<Vec<RunFacts>, FolderError> {
        self.facts_in(RERUN_FACTS, case)
    }

    fn facts_in(&self, table: &str, case: CaseNumber) -> Result<Vec<RunFacts>, FolderError> {
        let around = self.facts_around(table, case)?;
        Ok(around.range((case, 0)..=(case, usize::MAX)).map(|(_, facts)| facts.clone()).collect())
    }

    /// Whether any run is known.
    pub fn has_runs(&self) -> bool {
        !parts_of(&self.path, RUNS).is_empty()
    }

    /// Whether this run was executed and can be read: what `--resume` skips. One that no program was asked to fly was
    /// not.
    pub fn has_valid_run(&self, case: CaseNumber, run: usize) -> bool {
        let asked = |facts: &RunFacts| !facts.message.as_deref().is_some_and(was_never_asked);
        if let Ok(around) = self.facts_around(RUNS, case)
            && let Some(facts) = around.get(&(case, run))
            && !self.run_path(case, run).exists()
        {
            let moved =
                || self.part_with(EXECUTIONS, case).is_ok_and(|part| part.is_some_and(|part| part.has((case, run))));
            return asked(facts) && (!facts.has_motion() || moved());
        }
        let found = runs::read_run(&self.run_path(case, run));
        found.is_ok_and(|(_, facts)| facts.is_some_and(|facts| facts.case == case && facts.run == run && asked(&facts)))
    }

    /// Reads the runs of `case`, by number.
    ///
    /// # Errors
    /// As [`Self::read_run`]; a run that is known without its motion.
    pub fn read_runs(&self, case: CaseNumber) -> Result<Vec<Run>, FolderError> {
        let known = self.facts_of(case)?;
        let mut all = Vec::new();
        while let Some(run) = self.read_run(case, all.len())? {
            all.push(run);
        }
        match known.iter().any(|facts| facts.run >= all.len()) {
            true => Err(self.missing(case, all.len())),
            false => Ok(all),
        }
    }

    /// The runs of `case` with what was measured of them and without their motion; `None` where one of them was not
    /// measured.
    ///
    /// # Errors
    /// A file is broken.
    pub fn read_measured(&self, case: CaseNumber) -> Result<Option<Vec<Run>>, FolderError> {
        let known = self.facts_in(RUNS, case)?;
        let in_files = self.run_path(case, 0).exists() || self.run_path(case, known.len()).exists();
        if in_files { Ok(None) } else { self.measured(known) }
    }

    fn measured(&self, known: Vec<RunFacts>) -> Result<Option<Vec<Run>>, FolderError> {
        if known.is_empty() || !known.iter().all(RunFacts::is_measured) {
            return Ok(None);
        }
        let without_track = |facts: RunFacts| {
            let (case, run) = (facts.case, facts.run);
            facts.without_track().ok_or_else(|| self.contradiction(case, run, "ended for an unknown reason"))
        };
        known.into_iter().map(without_track).collect::<Result<_, _>>().map(Some)
    }

    /// Reads one run, its motion sampled as it was flown; `None` where it was not executed.
    ///
    /// # Errors
    /// The file is broken; nothing is known about the run; it says that it is another one; its motion is not kept.
    pub fn read_run(&self, case: CaseNumber, run: usize) -> Result<Option<Run>, FolderError> {
        let known = self.facts_around(RUNS, case)?.get(&(case, run)).cloned();
        let path = self.run_path(case, run);
        if path.exists() {
            return self.read_run_file(&path, (case, run), known).map(Some);
        }
        let Some(facts) = known else { return Ok(None) };
        self.with_motion(EXECUTIONS, facts).map(Some)
    }

    /// The run that is known by `facts`, with its motion in `table`.
    fn with_motion(&self, table: &str, facts: RunFacts) -> Result<Run, FolderError> {
        let (case, run) = (facts.case, facts.run);
        if !facts.is_kept() {
            return Err(self.contradiction(case, run, "has a run whose motion was not kept (`execute.record`)"));
        }
        let track = match (facts.message.is_none(), self.part_with(table, case)?) {
            (false, _) => Track::default(),
            (true, None) if facts.end_s.is_none() => Track::default(),
            (true, None) => return Err(self.missing(case, run)),
            (true, Some(part)) => match part.table((case, run))? {
                Some(rows) => {
                    if !track::ends_at(&rows, facts.end_s)? {
                        return Err(self.contradiction(
                            case,
                            run,
                            "has a run of whose motion the last rows are missing",
                        ));
                    }
                    // Of what was measured only the rows are there where it bends.
                    let period = facts.full_rate.as_ref().map(|_| part.period().unwrap_or(USUAL_PERIOD));
                    track::sampled(&rows, period)?
                }
                None if facts.end_s.is_none() => Track::default(),
                None => return Err(self.missing(case, run)),
            },
        };
        facts.with_track(track).ok_or_else(|| self.contradiction(case, run, "ended for an unknown reason"))
    }

    /// A run from a file of its own; `known` fills in for one that another program rewrote.
    fn read_run_file(
        &self,
        path: &Path,
        (case, run): (CaseNumber, usize),
        known: Option<RunFacts>,
    ) -> Result<Run, FolderError> {
        let (track, facts) = runs::read_run(path)?;
        let facts = facts.or(known);
        let refuse = |what| self.contradiction(case, run, what);
        let facts = facts.ok_or_else(|| refuse("has lost its metadata and is not in runs.parquet"))?;
        if (facts.case, facts.run) != (case, run) {
            return Err(refuse("holds another run than its name says"));
        }
        facts.with_track(track).ok_or_else(|| refuse("ended for an unknown reason"))
    }

    fn missing(&self, case: CaseNumber, run: usize) -> FolderError {
        self.contradiction(
            case,
            run,
            "has a run in the table of runs, and its motion is missing: hairpin execute --resume",
        )
    }

    fn contradiction(&self, case: CaseNumber, run: usize, what: &'static str) -> FolderError {
        let own = Some(self.run_path(case, run)).filter(|path| path.exists());
        FolderError::Contradiction { path: own.unwrap_or_else(|| self.path.join(EXECUTIONS)), case, what }
    }

    /// The runs of `case` that were flown again, in their order, as [`Self::read_measured`] has runs.
    ///
    /// # Errors
    /// A file is broken.
    pub fn read_measured_reruns(&self, case: CaseNumber) -> Result<Option<Vec<Run>>, FolderError> {
        self.measured(self.facts_in(RERUN_FACTS, case)?)
    }

    /// One of them with its motion; `None` where it was not flown again so often.
    ///
    /// # Errors
    /// As [`Self::read_run`].
    pub fn read_rerun(&self, case: CaseNumber, again: usize) -> Result<Option<Run>, FolderError> {
        let known = self.facts_in(RERUN_FACTS, case)?.into_iter().find(|facts| facts.run == again);
        known.map(|facts| self.with_motion(RERUNS, facts)).transpose()
    }

    /// Reads the runs of `case` that were flown again, in their order.
    ///
    /// # Errors
    /// A file is broken.
    pub fn read_reruns(&self, case: CaseNumber) -> Result<Vec<Run>, FolderError> {
        let known = self.facts_in(RERUN_FACTS, case)?;
        if !known.is_empty() {
            return known.into_iter().map(|facts| self.with_motion(RERUNS, facts)).collect();
        }
        let path = |again: usize| self.path.join(RERUNS).join(format!("{case}-{again}.parquet"));
        let mut all = Vec::new();
        while path(all.len()).exists() {
            let (track, facts) = runs::read_run(&path(all.len()))?;
            let refuse = |what| FolderError::Contradiction { path: path(all.len()), case, what };
            let facts = facts.filter(|facts| facts.case == case);
            let run = facts.ok_or_else(|| refuse("holds another run than its name says"))?.with_track(track);
            all.push(run.ok_or_else(|| refuse("ended for an unknown reason"))?);
        }
        Ok(all)
    }

    /// `executions/CASE-RUN.parquet`, where a run of earlier versions stands.
    pub(super) fn run_path(&self, case: CaseNumber, run: usize) -> PathBuf {
        self.path.join(EXECUTIONS).join(format!("{case}-{run}.parquet"))
    }
}
