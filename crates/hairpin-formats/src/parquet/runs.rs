//! Runs: `runs/` says what is known of each beside its motion, a row a run, and what was measured of all of its
//! samples; `executions/` has the motion, the rows where it bends.

use std::collections::{BTreeMap, BTreeSet};
use std::io;
use std::path::Path;
use std::sync::Arc;

use arrow_array::builder::{Float64Builder, Int64Builder, ListBuilder};
use arrow_array::{ArrayRef, BooleanArray, Float64Array, Int64Array, StringArray};
use hairpin::campaign::scenario::DeviationFrom;
use hairpin::campaign::{CaseNumber, FullRate, Run};
use hairpin::judgement::still_since;
use hairpin::trajectory::{ATTITUDE_UNKNOWN, Channel, END_UNSAID, Ended, Flight, HEIGHTS_BY_MAP, ROWS_LEFT_OUT, Track};
use nalgebra::Isometry3;
use serde::Deserialize;
use serde_json::Value;

use super::piece::Piece;
use super::table::{Columns, Table, TableError};
use super::{drawn, implausible, measures, possible, track};
use crate::atomic::WriteError;

const FACTS_KEY: &str = "hairpin.run";
/// The word in `ended` for a run whose executor failed.
pub const EXECUTOR_FAILED: &str = "executor-failed";

/// What is known of runs, by case and run.
pub(crate) type Facts = BTreeMap<(CaseNumber, usize), RunFacts>;

/// What is known about a run beside its track.
#[derive(Debug, Clone, PartialEq)]
pub struct RunFacts {
    /// Number of the case.
    pub case: CaseNumber,
    /// 0: nominal.
    pub run: usize,
    /// Why it ended, in the words of [`Ended::word`], or [`EXECUTOR_FAILED`].
    pub ended: String,
    /// Why the executor failed.
    pub message: Option<String>,
    /// First time outside the world's volume, s.
    pub left_world_s: Option<f64>,
    /// Time at which each waypoint was reached, s.
    pub reached_s: Vec<Option<f64>>,
    /// Values drawn for `[vary]`.
    pub drawn: Vec<(String, Value)>,
    /// The last stamp of its track, s.
    pub end_s: Option<f64>,
    /// Since when it had stood where it ended, s; not known of what earlier versions wrote.
    pub still_s: Option<f64>,
    /// The leg that the executor told last, and the one when it left the world.
    pub end_leg: Option<usize>,
    /// See `end_leg`.
    pub left_leg: Option<usize>,
    /// Whether the executor sent no attitudes.
    pub attitude_unknown: bool,
    /// Whether it did not say how the run ended.
    pub end_unsaid: bool,
    /// Whether it sent no heights, which are the map's.
    pub heights_by_map: bool,
    /// Whether its motion is kept.
    pub recorded: bool,
    /// What was measured of all of its samples.
    pub full_rate: Option<Box<FullRate>>,
}

impl RunFacts {
    /// Whether rows of it stand in the table of motions.
    pub(crate) fn has_motion(&self) -> bool {
        self.recorded && self.end_s.is_some()
    }

    /// Whether nothing of it was left out: its rows stand there, or there was no motion.
    pub fn is_kept(&self) -> bool {
        self.recorded || self.message.is_some()
    }

    /// Whether it is about `run` as it was carried out, to the bit.
    pub fn is_of(&self, run: &Run) -> bool {
        let now = Self::of(run);
        let how = |facts: &Self| (facts.ended.clone(), facts.message.clone(), facts.end_leg, facts.left_leg);
        let when = |facts: &Self| {
            let bits = |time: Option<f64>| time.map(f64::to_bits);
            let reached: Vec<Option<u64>> = facts.reached_s.iter().copied().map(bits).collect();
            (bits(facts.end_s), bits(facts.left_world_s), reached)
        };
        (how(self), when(self)) == (how(&now), when(&now))
    }

    /// Whether it can be judged without its motion: it was measured, or there was none.
    pub fn is_measured(&self) -> bool {
        self.full_rate.is_some() || self.message.is_some()
    }

    /// The facts of `run`, whose motion is kept.
    pub fn of(run: &Run) -> Self {
        let flight = run.outcome.as_ref().ok();
        let track = flight.map(|flight| &flight.track);
        let left = flight.and_then(|flight| flight.left_world);
        let leg_at = |time: f64| {
            let (track, legs) = (track?, track?.channel("leg")?);
            let row = track.times().partition_point(|stamp| *stamp < time).min(legs.len().checked_sub(1)?);
            Some(legs[row].max(0.0) as usize)
        };
        Self {
            case: run.case,
            run: run.run,
            ended: flight.map_or(EXECUTOR_FAILED, |flight| flight.ended.word()).into(),
            message: run.outcome.as_ref().err().cloned(),
            left_world_s: left,
            reached_s: flight.map_or_else(Vec::new, |flight| flight.reached.clone()),
            drawn: run.drawn.clone(),
            end_s: track.and_then(|track| track.times().last().copied()),
            still_s: track.and_then(still_since),
            end_leg: leg_at(f64::INFINITY),
            left_leg: left.and_then(leg_at),
            attitude_unknown: track.is_some_and(|track| track.channel(ATTITUDE_UNKNOWN).is_some()),
            end_unsaid: track.is_some_and(|track| track.channel(END_UNSAID).is_some()),
            heights_by_map: track.is_some_and(|track| track.channel(HEIGHTS_BY_MAP).is_some()),
            recorded: true,
            full_rate: run.full_rate.clone(),
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
        Some(Run { case: self.case, run: self.run, drawn: self.drawn, outcome, full_rate: self.full_rate })
    }

    /// The run with no more of its motion than a judge needs who takes what was measured: when and on what leg it left
    /// the world, stood still and ended, marked as such ([`ROWS_LEFT_OUT`]). `None` where `ended` is no known word.
    pub fn without_track(self) -> Option<Run> {
        let mut stamps: Vec<(f64, Option<usize>)> = Vec::new();
        let still = self.still_s.or(self.end_s).unwrap_or_default();
        if let Some(end) = self.end_s {
            let left = self.left_world_s.filter(|left| *left < end);
            stamps.extend(left.map(|left| (left, self.left_leg)));
            let between = still < end && left != Some(still);
            stamps.extend(between.then_some((still, self.end_leg)));
            stamps.push((end, self.end_leg));
            stamps.sort_by(|(a, _), (b, _)| a.total_cmp(b));
        }
        let leg = |leg: Option<usize>| leg.unwrap_or_default() as f64;
        let channel = |name: &str, values: Vec<f64>| Channel { name: name.into(), values };
        let legs = self.end_leg.map(|_| channel("leg", stamps.iter().map(|(_, told)| leg(*told)).collect()));
        let mark = |is: bool, name: &str| is.then(|| channel(name, vec![1.0; stamps.len()]));
        let (level, unsaid) = (mark(self.attitude_unknown, ATTITUDE_UNKNOWN), mark(self.end_unsaid, END_UNSAID));
        let by_map = mark(self.heights_by_map, HEIGHTS_BY_MAP);
        let left_out = mark(true, ROWS_LEFT_OUT);
        let times: Vec<f64> = stamps.iter().map(|(time, _)| *time).collect();
        // Where it was is not known, only since when it was there no longer: a kilometre away serves.
        let place = |time: &f64| Isometry3::translation(if *time < still { 1000.0 } else { 0.0 }, 0.0, 0.0);
        let poses = times.iter().map(place).collect();
        let channels = [legs, level, unsaid, by_map, left_out].into_iter().flatten().collect();
        self.with_track(Track::new(times, poses, channels).ok()?)
    }
}

/// The motion of a run: all rows or, once it was measured, those where it bends and those in `marked`. `None` where it
/// has none.
///
/// # Errors
/// There is no room for it.
pub fn piece(run: &Run, marked: &BTreeSet<usize>) -> io::Result<Option<Piece>> {
    motion(run, run.run, marked)
}

/// The same of a run that is kept under the number `kept`.
pub(crate) fn motion(run: &Run, kept: usize, marked: &BTreeSet<usize>) -> io::Result<Option<Piece>> {
    let Some(flight) = run.outcome.as_ref().ok().filter(|flight| !flight.track.is_empty()) else { return Ok(None) };
    let key = (run.case, Some(kept));
    match run.full_rate {
        Some(_) => track::thinned(key, &flight.track, marked),
        None => Piece::of(track::columns(key, &flight.track)),
    }
    .map(Some)
}

/// What the file of one run says of it in its metadata, as folders of a file per run have it.
#[derive(Deserialize)]
struct InOneFile {
    case: CaseNumber,
    run: usize,
    ended: String,
    message: Option<String>,
    left_world_s: Option<f64>,
    reached_s: Vec<Option<f64>>,
    drawn: Vec<(String, Value)>,
}

/// Reads the track of one run from a file of its own, and its facts if the last writer of the file kept the metadata.
///
/// # Errors
/// As [`track::read`].
pub fn read_run(path: &Path) -> Result<(Track, Option<RunFacts>), TableError> {
    let table = Table::read(path)?;
    let facts = table.note(FACTS_KEY).and_then(|text| serde_json::from_str(text).ok());
    let facts = facts.map(|InOneFile { case, run, ended, message, left_world_s, reached_s, drawn }| RunFacts {
        case,
        run,
        ended,
        message,
        left_world_s,
        reached_s,
        drawn,
        end_s: None,
        still_s: None,
        end_leg: None,
        left_leg: None,
        attitude_unknown: table.has(ATTITUDE_UNKNOWN),
        end_unsaid: table.has(END_UNSAID),
        heights_by_map: table.has(HEIGHTS_BY_MAP),
        recorded: true,
        full_rate: None,
    });
    Ok((track::from_table(&table)?, facts))
}

/// Writes the facts of runs: `case,run,ended,message,left_world_s,reached_s,…`, what was measured of them, `vary:…`.
///
/// # Errors
/// The file cannot be written.
pub fn write_facts(path: &Path, runs: &[RunFacts]) -> Result<(), WriteError> {
    let mut columns = Columns::default();
    let counts = |value: fn(&RunFacts) -> Option<usize>| -> ArrayRef {
        Arc::new(runs.iter().map(|run| value(run).map(|v| v as i64)).collect::<Int64Array>())
    };
    let numbers = |value: fn(&RunFacts) -> Option<f64>| -> ArrayRef {
        Arc::new(runs.iter().map(value).collect::<Float64Array>())
    };
    let flags = |value: fn(&RunFacts) -> bool| -> ArrayRef {
        Arc::new(runs.iter().map(|run| Some(value(run))).collect::<BooleanArray>())
    };
    let ids = runs.iter().map(|run| Some(run.case.to_string()));
    columns.push("case", Arc::new(ids.collect::<StringArray>()));
    columns.push("run", counts(|run| Some(run.run)));
    columns.push("ended", Arc::new(runs.iter().map(|run| Some(run.ended.as_str())).collect::<StringArray>()));
    columns.push("message", Arc::new(runs.iter().map(|run| run.message.as_deref()).collect::<StringArray>()));
    columns.push("left_world_s", numbers(|run| run.left_world_s));
    columns.push("reached_s", Arc::new(reached(runs)));
    columns.push("end_s", numbers(|run| run.end_s));
    columns.push("still_s", numbers(|run| run.still_s));
    columns.push("end_leg", counts(|run| run.end_leg));
    columns.push("left_leg", counts(|run| run.left_leg));
    columns.push("attitude_unknown", flags(|run| run.attitude_unknown));
    columns.push("recorded", flags(|run| run.recorded));
    if runs.iter().any(|run| run.end_unsaid) {
        columns.push(END_UNSAID, flags(|run| run.end_unsaid));
    }
    if runs.iter().any(|run| run.heights_by_map) {
        columns.push(HEIGHTS_BY_MAP, flags(|run| run.heights_by_map));
    }
    let measured: Vec<Option<&FullRate>> = runs.iter().map(|run| run.full_rate.as_deref()).collect();
    if measured.iter().any(Option::is_some) {
        let from = measured.iter().map(|found| found.map(|found| from_word(found.from)));
        columns.push("measured_from", Arc::new(from.collect::<StringArray>()));
        let corner = measured.iter().map(|found| found.map(|found| found.corner));
        columns.push("measured_corner_m", Arc::new(corner.collect::<Float64Array>()));
        let mut met = ListBuilder::new(Int64Builder::new());
        measured.iter().for_each(|found| met.append_option(found.map(|f| f.met.iter().map(|cell| Some(*cell as i64)))));
        columns.push("cells_met", Arc::new(met.finish()));
        let rows: Vec<_> = measured.iter().map(|found| found.map(|found| &found.measures)).collect();
        measures::columns(&rows).into_iter().for_each(|(name, column)| columns.push(name, column));
        let looked: Vec<_> = measured.iter().map(|found| found.and_then(|found| found.implausible)).collect();
        implausible::columns(&looked).into_iter().for_each(|(name, column)| columns.push(name, column));
    }
    drawn::push(&mut columns, &runs.iter().map(|run| run.drawn.as_slice()).collect::<Vec<_>>());
    columns.write(path, "runs")
}

/// Reads the facts of runs.
///
/// # Errors
/// Missing columns, values of another type, or that no run can have; a run twice: which of its rows is right nobody
/// knows.
pub fn read_facts(path: &Path) -> Result<BTreeMap<(CaseNumber, usize), RunFacts>, TableError> {
    let table = Table::read(path)?;
    let cases = table.cases()?;
    let runs = table.counts("run")?;
    let ended = table.texts("ended")?;
    let messages = table.optional_texts("message")?;
    let left = table.optional_numbers("left_world_s")?;
    let reached = table.number_lists("reached_s")?;
    let drawn = drawn::read(&table)?;
    // Older tables know none of these.
    let counts = |column: &str| match table.has(column) {
        true => table.optional_counts(column),
        false => Ok(vec![None; table.rows()]),
    };
    let flags = |column: &str, otherwise: bool| match table.has(column) {
        true => Ok(table.optional_integers(column)?.into_iter().map(|v| v.map_or(otherwise, |v| v != 0)).collect()),
        false => Ok::<_, TableError>(vec![otherwise; table.rows()]),
    };
    let (end, end_leg, left_leg) = (table.numbers_or_none("end_s")?, counts("end_leg")?, counts("left_leg")?);
    let still = table.numbers_or_none("still_s")?;
    let (unknown, recorded) = (flags("attitude_unknown", false)?, flags("recorded", true)?);
    let (unsaid, by_map) = (flags(END_UNSAID, false)?, flags(HEIGHTS_BY_MAP, false)?);
    let full_rate = read_full_rate(&table)?;
    let mut seen = BTreeSet::new();
    let rows = ended.into_iter().zip(messages).zip(reached).zip(drawn).zip(full_rate).enumerate();
    rows.map(|(row, ((((ended, message), reached), drawn), full_rate))| {
        if !seen.insert((cases[row], runs[row])) {
            return Err(table.refuse("run", row, runs[row], format!("there once in case {}", cases[row])));
        }
        if ended != EXECUTOR_FAILED && Ended::from_word(&ended).is_none() {
            return Err(table.refuse("ended", row, format!("`{ended}`"), "done, time, ground, obstacle, wall, …"));
        }
        if let Some(found) = &full_rate {
            possible::check_run(&table, row, (found, end[row]))?;
        }
        let facts = RunFacts {
            case: cases[row],
            run: runs[row],
            ended,
            message,
            left_world_s: left[row],
            reached_s: reached.unwrap_or_default(),
            drawn,
            end_s: end[row],
            still_s: still[row],
            end_leg: end_leg[row],
            left_leg: left_leg[row],
            attitude_unknown: unknown[row],
            end_unsaid: unsaid[row],
            heights_by_map: by_map[row],
            recorded: recorded[row],
            full_rate: full_rate.map(Box::new),
        };
        Ok(((facts.case, facts.run), facts))
    })
    .collect()
}

fn read_full_rate(table: &Table) -> Result<Vec<Option<FullRate>>, TableError> {
    if !table.has("measured_from") {
        return Ok(vec![None; table.rows()]);
    }
    let from = table.optional_texts("measured_from")?;
    let corner = table.optional_numbers("measured_corner_m")?;
    let met = table.number_lists("cells_met")?;
    let implausible = implausible::read(table)?;
    let rows = measures::read(table)?.into_iter().zip(from).zip(met).zip(implausible).enumerate();
    rows.map(|(row, (((measures, from), met), implausible))| {
        let (Some(measures), Some(from)) = (measures, from) else { return Ok(None) };
        let bound = "leg, nearest-leg or path";
        let from = WORDS.into_iter().find(|word| from_word(*word) == from);
        let from = from.ok_or_else(|| table.refuse("measured_from", row, "another word", bound))?;
        let met = met.unwrap_or_default().into_iter().flatten().map(|cell| cell.max(0.0) as usize).collect();
        let corner = corner[row].unwrap_or_default();
        Ok(Some(FullRate { from, corner, measures, met, implausible }))
    })
    .collect()
}

const WORDS: [DeviationFrom; 3] = [DeviationFrom::Leg, DeviationFrom::NearestLeg, DeviationFrom::Path];

fn from_word(from: DeviationFrom) -> &'static str {
    match from {
        DeviationFrom::Leg => "leg",
        DeviationFrom::NearestLeg => "nearest-leg",
        DeviationFrom::Path => "path",
    }
}

fn reached(runs: &[RunFacts]) -> arrow_array::ListArray {
    let mut lists = ListBuilder::new(Float64Builder::new());
    for run in runs {
        lists.append_value(run.reached_s.iter().copied());
    }
    lists.finish()
}

#[cfg(test)]
mod tests;
