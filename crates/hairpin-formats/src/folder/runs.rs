//! The flights of a campaign folder: what `execute` writes, one file a run, and the table of them all.

use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::PathBuf;

use hairpin::campaign::{CaseNumber, Run};

use super::{CampaignFolder, FolderError, RUNS};
use crate::atomic::{self, WriteError};
use crate::executor::{Failed, was_never_asked};
use crate::parquet::runs::{self, RunFacts};

impl CampaignFolder {
    /// Writes one run.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write_run(&self, run: &Run) -> Result<(), FolderError> {
        Ok(runs::write_run(&self.run_path(run.case, run.run), run)?)
    }

    /// Whether this run was executed and can be read: what `--resume` skips. One that no program was asked to fly was
    /// not.
    pub fn has_valid_run(&self, case: CaseNumber, run: usize) -> bool {
        let found = runs::read_run(&self.run_path(case, run));
        let asked = |facts: &RunFacts| !facts.message.as_deref().is_some_and(was_never_asked);
        found.is_ok_and(|(_, facts)| facts.is_some_and(|facts| facts.case == case && facts.run == run && asked(&facts)))
    }

    /// Writes a run that was flown again, for the time number `again`.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write_rerun(&self, run: &Run, again: usize) -> Result<(), FolderError> {
        Ok(runs::write_run(&self.rerun_path(run.case, again), run)?)
    }

    /// Reads the runs of `case` that were flown again, as many as there are from number 0 on.
    ///
    /// # Errors
    /// A file is broken.
    pub fn read_reruns(&self, case: CaseNumber) -> Result<Vec<Run>, FolderError> {
        let mut all = Vec::new();
        loop {
            let path = self.rerun_path(case, all.len());
            if !path.exists() {
                return Ok(all);
            }
            let contradiction = |what| FolderError::Contradiction { path: path.clone(), case, what };
            let (track, facts) = runs::read_run(&path)?;
            let facts = facts.filter(|facts| facts.case == case);
            let run = facts.ok_or_else(|| contradiction("holds another run than its name says"))?.with_track(track);
            all.push(run.ok_or_else(|| contradiction("ended for an unknown reason"))?);
        }
    }

    /// `reruns/CASE-K.parquet`.
    pub fn rerun_path(&self, case: CaseNumber, again: usize) -> PathBuf {
        self.path.join("reruns").join(format!("{case}-{again}.parquet"))
    }

    /// Writes `executor-CASE-RUN.log`: why a program of the user's failed to fly a run, and the end of its stderr.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write_executor_log(&self, case: CaseNumber, run: usize, failed: &Failed) -> Result<(), FolderError> {
        let Failed { failure, stderr } = failed;
        let text = format!("{failure}\n\n--- the end of its stderr ---\n{stderr}");
        Ok(atomic::write(&self.file(&format!("executor-{case}-{run}.log")), text.as_bytes())?)
    }

    /// Removes it, where there is one: the run was flown.
    ///
    /// # Errors
    /// It cannot be removed.
    pub fn remove_executor_log(&self, case: CaseNumber, run: usize) -> Result<(), FolderError> {
        let path = self.file(&format!("executor-{case}-{run}.log"));
        match fs::remove_file(&path) {
            Err(cause) if cause.kind() != io::ErrorKind::NotFound => Err(WriteError { path, cause }.into()),
            _ => Ok(()),
        }
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
    /// As [`Self::read_run`]; a run of the table without its file.
    pub fn read_runs(
        &self,
        case: CaseNumber,
        table: &BTreeMap<(CaseNumber, usize), RunFacts>,
    ) -> Result<Vec<Run>, FolderError> {
        let mut all = Vec::new();
        while let Some(run) = self.read_run(case, all.len(), table)? {
            all.push(run);
        }
        if table.range((case, all.len())..=(case, usize::MAX)).next().is_some() {
            let what = "is missing, and runs.parquet has it: hairpin execute --resume";
            return Err(FolderError::Contradiction { path: self.run_path(case, all.len()), case, what });
        }
        Ok(all)
    }

    /// Reads one run; `None` where it was not executed.
    ///
    /// # Errors
    /// The file is broken; nothing is known about the run; it says that it is another one.
    pub fn read_run(
        &self,
        case: CaseNumber,
        run: usize,
        table: &BTreeMap<(CaseNumber, usize), RunFacts>,
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
    pub fn read_runs_table(&self) -> Result<BTreeMap<(CaseNumber, usize), RunFacts>, FolderError> {
        let path = self.file(RUNS);
        if !path.exists() {
            return Ok(BTreeMap::new());
        }
        Ok(runs::read_facts(&path)?.into_iter().map(|facts| ((facts.case, facts.run), facts)).collect())
    }

    /// `executions/CASE-RUN.parquet`.
    pub fn run_path(&self, case: CaseNumber, run: usize) -> PathBuf {
        self.path.join("executions").join(format!("{case}-{run}.parquet"))
    }

    /// `CASE-RUN.csv`: the flight as text, exported.
    pub fn run_csv_path(&self, case: CaseNumber, run: usize) -> PathBuf {
        self.path.join(format!("{case}-{run}.csv"))
    }
}
