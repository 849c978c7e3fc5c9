//! A file of queries under way: blocks are read, answered in parallel and written in their order.

use std::collections::HashMap;
use std::fs::File;
use std::io;
use std::path::Path;

use hairpin_formats::folder::refuse_own;
use hairpin_formats::steering::{
    self, Answer, Asked, Block, Blocks, Columns, Drive, Errors, Frame, KeptAnswer, Row, Status, Wrong,
};
use hairpin_formats::{atomic, bounds};
use rayon::prelude::*;

use super::answered::Answered;
use super::batch::Batch;
use super::question::{pieces, stretches};
use super::vehicle::Vehicle;
use crate::watch::Steps;
use crate::{Problem, Watch};

/// Bytes of a block of queries, about forty of them.
const BLOCK: usize = 4000;
/// Blocks for each thread between two looks at what is done.
const ROUND: usize = 16;

/// What takes rows of answers.
pub(super) type Sink<'a> = dyn FnMut(&[u8]) -> io::Result<()> + Send + 'a;

/// What all blocks of a file have in common.
#[derive(Clone, Copy)]
pub(super) struct Run<'a> {
    pub(super) vehicle: &'a Vehicle,
    pub(super) path: &'a Path,
    pub(super) columns: &'a Columns,
    /// Answers that are there already, in the queries' order.
    pub(super) kept: &'a [KeptAnswer],
    pub(super) most_drawn: usize,
    pub(super) steps: &'a Steps<'a>,
    pub(super) watch: &'a dyn Watch,
}

/// A block of queries, answered as far as nobody stopped it.
struct Done {
    batch: Batch,
    /// Ids, and the lines that they are on.
    ids: Vec<(Box<str>, u64)>,
    rows: Vec<u8>,
    whole: bool,
}

impl Run<'_> {
    /// Answers all of `blocks` into the file `out`, which appears when they are, or with those there were when it was
    /// stopped.
    pub(super) fn write_into(&self, blocks: Blocks<File>, out: &Path) -> Result<Batch, Problem> {
        refuse_own(out)?;
        let mut came = None;
        let written = atomic::write_with(out, |file| {
            if self.kept.is_empty() {
                file.write_all(steering::head().as_bytes())?;
            } else {
                io::copy(&mut bounds::open(out, u64::MAX)?, file)?;
            }
            let found = self.all(blocks, &mut |rows| file.write_all(rows));
            // Without an answer what was there before stays.
            let done = found.as_ref().is_ok_and(|batch| batch.queries > 0 || !self.watch.stopped());
            came = Some(found);
            if done { Ok(()) } else { Err(io::Error::other("nothing is answered")) }
        });
        match (came, written) {
            (Some(Ok(batch)), Err(_)) if batch.queries == 0 => Ok(batch),
            (Some(Err(problem)), Err(error)) if !error.is_lost() => Err(problem),
            (_, Err(error)) => Err(error.into()),
            (Some(found), Ok(())) => found,
            (None, Ok(())) => Ok(Batch::default()),
        }
    }

    /// Answers all of `blocks`, or as many as there is time for, and hands their rows to `sink` in their order.
    ///
    /// While some are answered those before are written and those behind are read.
    pub(super) fn all(&self, mut blocks: Blocks<File>, sink: &mut Sink<'_>) -> Result<Batch, Problem> {
        let unreadable = |cause: io::Error| Problem::of_file(self.path, format!("cannot read: {cause}"));
        let unwritten = |cause: io::Error| match atomic::is_lost(&cause) {
            true => Problem::Lost(format!("cannot write: {cause}")),
            false => Problem::input(format!("cannot write: {cause}")),
        };
        let mut batch = Batch::default();
        let round = ROUND * rayon::current_num_threads();
        let mut read =
            || -> io::Result<Vec<Block>> { (0..round).map_while(|_| blocks.take(BLOCK).transpose()).collect() };
        let (mut asked, mut done) = (read().map_err(unreadable)?, Vec::new());
        let mut met: HashMap<Box<str>, u64> = HashMap::new();
        let mut write = |done: Vec<Done>, batch: &mut Batch| -> io::Result<()> {
            for mut done in done {
                done.batch.note_ids(done.ids, &mut met);
                sink(&done.rows)?;
                batch.add(done.batch, self.most_drawn);
                // What is behind a block that was stopped is not kept: answers stand in the order of queries.
                if !done.whole {
                    break;
                }
            }
            Ok(())
        };
        while !asked.is_empty() {
            let before = std::mem::take(&mut done);
            let (filed, answered) = rayon::join(
                || {
                    write(before, &mut batch).map_err(unwritten)?;
                    read().map_err(unreadable)
                },
                || asked.par_iter().with_max_len(1).map(|block| self.block(block)).collect::<Result<Vec<Done>, _>>(),
            );
            let next = filed?;
            done = answered.map_err(|error| Problem::of_file(self.path, error))?;
            asked = if done.iter().all(|done| done.whole) { next } else { Vec::new() };
        }
        write(done, &mut batch).map_err(unwritten)?;
        Ok(batch)
    }

    fn block(&self, block: &Block) -> Result<Done, String> {
        let rows = self.columns.rows(block).map_err(|error| error.to_string())?;
        let (mut batch, mut answers, mut whole) = (Batch::default(), Vec::with_capacity(rows.len()), true);
        let mut ids = Vec::with_capacity(rows.len());
        // The head is the record before the first query.
        for (number, row) in (block.before - 1..).zip(rows) {
            let (drawn, kept) = (number < self.most_drawn, self.kept.get(number));
            let mut beyond = None;
            // What is kept is gone past in no time.
            if kept.is_none() && self.watch.stopped() {
                whole = false;
                break;
            }
            match kept {
                Some(kept) if *kept.id != *row.id => {
                    return Err(format!(
                        "line {}: id = {:?}: the answers there are go on with {:?}: --resume needs those of the same queries",
                        row.line, row.id, kept.id
                    ));
                }
                Some(kept) if !drawn || !kept.driven => {
                    if let (Status::Invalid, Ok(asked)) = (kept.status, &row.asked) {
                        beyond = wrong(asked, &self.vehicle.answer(asked));
                    }
                    batch.count(kept.status, kept.driven.then_some(kept.time_us));
                }
                kept => {
                    let answered = row.asked.as_ref().ok().map(|asked| self.vehicle.answer(asked));
                    if let (true, Some(answered), Ok(asked)) = (drawn, &answered, &row.asked)
                        && let Some((solution, _)) = &answered.drive
                    {
                        batch.drawn.push((stretches(solution, asked), asked.goal));
                    }
                    beyond =
                        answered.as_ref().and_then(|answered| row.asked.as_ref().ok().and_then(|q| wrong(q, answered)));
                    let answer = in_file(&row, answered.as_ref());
                    batch.count(answer.status, answer.drive.is_some().then_some(answer.time_us));
                    if kept.is_none() {
                        answers.push(answer);
                        self.steps.step();
                    }
                }
            }
            batch.wrong.extend(row.asked.err().or(beyond).map(|wrong| (row.line, wrong)));
            ids.push((row.id.into(), row.line));
        }
        Ok(Done { batch, ids, rows: steering::rows(&answers).into_bytes(), whole })
    }
}

/// What is wrong with a question that is none: of its numbers the one that is beyond what can be planned, or speeds.
fn wrong(asked: &Asked, answered: &Answered) -> Option<Wrong> {
    let (column, _) = answered.limit.filter(|_| answered.status == Status::Invalid)?;
    let [x, y, yaw] = asked.goal;
    let left = asked.frame.left();
    let (value, bound) = match column {
        "x" => (Some(x), "finite and within ±1e6 m"),
        "y" => (Some(left * y), "finite and within ±1e6 m"),
        "yaw" => (Some(left * yaw), "finite and within ±1e6 rad"),
        "v0" => (asked.v0, SPEEDS),
        "vf" => (asked.vf, SPEEDS),
        _ => (None, SPEEDS),
    };
    let value = value.map_or_else(String::new, |value| value.to_string());
    Some(Wrong { column: column.to_owned(), value, bound })
}

/// What speeds must be to make a drive.
const SPEEDS: &str = "speeds up to the cruising speed, one of both ends more than 0";

/// The answer as a file has it.
fn in_file(row: &Row, answered: Option<&Answered>) -> Answer {
    let frame = row.asked.as_ref().map_or(Frame::Enu, |asked| asked.frame);
    let answer = Answer {
        id: row.id.clone(),
        frame,
        status: Status::Invalid,
        iterations: 0,
        time_us: 0.0,
        drive: None,
        limit: row.asked.as_ref().err().map(|wrong| (wrong.column.clone(), None)),
    };
    let Some(answered) = answered else { return answer };
    let k0 = row.asked.as_ref().map_or(0.0, |asked| asked.k0);
    let drive = answered.drive.as_ref().map(|(solution, replay)| {
        let [x_m, y_m, yaw_rad] = replay.error;
        let errors = Errors { x_m, y_m, yaw_rad, curvature_1_m: replay.error_curvature };
        Drive { pieces: pieces(solution, k0), errors, max_curvature_1_m: replay.max_curvature }
    });
    Answer {
        status: answered.status,
        iterations: answered.drive.as_ref().map_or(0, |(solution, _)| solution.iterations),
        time_us: answered.solving.as_secs_f64() * 1e6,
        drive,
        limit: answered.limit.map(|(limit, excess)| (limit.to_owned(), excess)),
        ..answer
    }
}
