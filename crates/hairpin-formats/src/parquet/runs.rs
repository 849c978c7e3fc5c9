//! Runs: `executions/CASE-RUN.parquet` holds one flight and what is known about it; `runs.parquet` holds the latter of
//! all runs in columns, for those who rewrite the former and lose its metadata.

use std::path::Path;
use std::sync::Arc;

use arrow_array::builder::{Float64Builder, ListBuilder};
use arrow_array::{Float64Array, Int64Array, ListArray, StringArray};
use hairpin::campaign::{CaseNumber, Run};
use hairpin::trajectory::{Ended, Flight, Track};
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::drawn;
use super::table::{Columns, Table, TableError};
use super::track;
use crate::atomic::WriteError;

const FACTS_KEY: &str = "hairpin.run";
/// The word in `ended` for a run whose executor failed.
pub const EXECUTOR_FAILED: &str = "executor-failed";

/// What is known about a run beside its track.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RunFacts {
    /// Number of the case.
    pub case: CaseNumber,
    /// 0: nominal.
    pub run: usize,
    /// Why it ended, in the words of [`Ended::word`], or [`EXECUTOR_FAILED`].
    pub ended: String,
    /// Why the executor failed.
    pub message: Option<String>,
    /// First time outside the world, s.
    pub left_world_s: Option<f64>,
    /// Time at which each waypoint was reached, s.
    pub reached_s: Vec<Option<f64>>,
    /// Values drawn for `[vary]`.
    pub drawn: Vec<(String, Value)>,
}

impl RunFacts {
    /// The facts of `run`.
    pub fn of(run: &Run) -> Self {
        let flight = run.outcome.as_ref().ok();
        Self {
            case: run.case,
            run: run.run,
            ended: flight.map_or(EXECUTOR_FAILED, |flight| flight.ended.word()).into(),
            message: run.outcome.as_ref().err().cloned(),
            left_world_s: flight.and_then(|flight| flight.left_world),
            reached_s: flight.map_or_else(Vec::new, |flight| flight.reached.clone()),
            drawn: run.drawn.clone(),
        }
    }

    /// The run again, with its `track`; `None` where `ended` is no known word.
    pub fn with_track(self, track: Track) -> Option<Run> {
        let outcome = if self.ended == EXECUTOR_FAILED {
            Err(self.message.unwrap_or_default())
        } else {
            let ended = Ended::from_word(&self.ended)?;
            Ok(Flight { track, ended, left_world: self.left_world_s, reached: self.reached_s })
        };
        Some(Run { case: self.case, run: self.run, drawn: self.drawn, outcome })
    }
}

/// Writes one run; a failed executor leaves a table without rows.
///
/// # Errors
/// The file cannot be written.
pub fn write_run(path: &Path, run: &Run) -> Result<(), WriteError> {
    let nothing = Track::default();
    let mut columns = track::columns(run.outcome.as_ref().map_or(&nothing, |flight| &flight.track));
    let facts = serde_json::to_string(&RunFacts::of(run)).expect("facts are plain data with text keys");
    columns.note(FACTS_KEY, facts);
    columns.write(path, "execution")
}

/// Reads the track of one run, and its facts if the last writer of the file kept the metadata.
///
/// # Errors
/// As [`track::read`].
pub fn read_run(path: &Path) -> Result<(Track, Option<RunFacts>), TableError> {
    let table = Table::read(path)?;
    let facts = table.note(FACTS_KEY).and_then(|text| serde_json::from_str(text).ok());
    Ok((track::from_table(&table)?, facts))
}

/// Writes `runs.parquet`: `case,run,ended,message,left_world_s,reached_s,vary:…`.
///
/// # Errors
/// The file cannot be written.
pub fn write_facts(path: &Path, runs: &[RunFacts]) -> Result<(), WriteError> {
    let mut columns = Columns::default();
    let ids = runs.iter().map(|run| Some(run.case.to_string()));
    columns.push("case", Arc::new(ids.collect::<StringArray>()));
    columns.push("run", Arc::new(runs.iter().map(|run| run.run as i64).collect::<Int64Array>()));
    columns.push("ended", Arc::new(runs.iter().map(|run| Some(run.ended.as_str())).collect::<StringArray>()));
    columns.push("message", Arc::new(runs.iter().map(|run| run.message.as_deref()).collect::<StringArray>()));
    columns.push("left_world_s", Arc::new(runs.iter().map(|run| run.left_world_s).collect::<Float64Array>()));
    columns.push("reached_s", Arc::new(reached(runs)));
    drawn::push(&mut columns, &runs.iter().map(|run| run.drawn.as_slice()).collect::<Vec<_>>());
    columns.write(path, "runs")
}

/// Reads `runs.parquet`.
///
/// # Errors
/// Missing columns, values of another type.
pub fn read_facts(path: &Path) -> Result<Vec<RunFacts>, TableError> {
    let table = Table::read(path)?;
    let cases = table.cases()?;
    let runs = table.counts("run")?;
    let ended = table.texts("ended")?;
    let messages = table.optional_texts("message")?;
    let left = table.optional_numbers("left_world_s")?;
    let reached = table.number_lists("reached_s")?;
    let drawn = drawn::read(&table)?;
    let rows = ended.into_iter().zip(messages).zip(reached).zip(drawn).enumerate();
    rows.map(|(row, (((ended, message), reached), drawn))| {
        if ended != EXECUTOR_FAILED && Ended::from_word(&ended).is_none() {
            return Err(table.refuse("ended", row, format!("`{ended}`"), "done, time, ground, obstacle, wall, …"));
        }
        Ok(RunFacts {
            case: cases[row],
            run: runs[row],
            ended,
            message,
            left_world_s: left[row],
            reached_s: reached.unwrap_or_default(),
            drawn,
        })
    })
    .collect()
}

fn reached(runs: &[RunFacts]) -> ListArray {
    let mut lists = ListBuilder::new(Float64Builder::new());
    for run in runs {
        lists.append_value(run.reached_s.iter().copied());
    }
    lists.finish()
}
