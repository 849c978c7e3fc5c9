//! Many queries from a file: read, answered in parallel and written in their order, block by block.

use std::fs::File;
use std::io::{self, BufReader};
use std::path::Path;

use hairpin_formats::steering::{
    self, Answer, Block, Blocks, Columns, Drive, Errors, Frame, KeptAnswer, QueryFile, Row, Status, Stretch, Wrong,
};
use hairpin_formats::{atomic, bounds};
use rayon::prelude::*;

use super::answered::Answered;
use super::question::{pieces, stretches};
use super::vehicle::Vehicle;
use crate::watch::Steps;
use crate::{Problem, Watch};

/// Drives of a file that are drawn at most.
const MOST_DRAWN: usize = 500;
/// Bytes of a block of queries, about forty of them.
const BLOCK: usize = 4000;
/// Blocks for each thread between two looks at what is done.
const ROUND: usize = 16;

/// Where the rows of answers go.
pub enum Answers<'a> {
    /// Into this file, which is there once all are, or as many as there were when it was stopped.
    File(&'a Path),
    /// Likewise, behind those that it has already.
    Resumed(&'a Path),
    /// To whoever shows them, as they come.
    Shown(&'a mut (dyn FnMut(&str) + Send)),
    /// Nowhere: they are counted.
    Counted,
}

/// What became of a file of queries.
#[derive(Debug, Default)]
pub struct Batch {
    /// Queries answered.
    pub queries: usize,
    /// Rows that are no queries: their lines, and why.
    pub wrong: Vec<(u64, Wrong)>,
    counts: [usize; Status::ALL.len()],
    /// What solving those took that have a drive: how many, all of it and the most, µs.
    solved: (usize, f64, f64),
    /// The first drives, and their goals.
    drawn: Vec<(Vec<Stretch>, [f64; 3])>,
}

impl Vehicle {
    /// Answers the queries of the file at `path`; the first drives are kept to be drawn, if `drawn`.
    ///
    /// # Errors
    /// A file cannot be read or written; it was asked to stop: what is done is kept then.
    pub fn answer_file(
        &self,
        path: &Path,
        answers: Answers<'_>,
        drawn: bool,
        watch: &dyn Watch,
    ) -> Result<Batch, Problem> {
        let QueryFile { columns, blocks, count } =
            QueryFile::open(path).map_err(|error| Problem::of_file(path, error))?;
        if !columns.ignored.is_empty() {
            watch.warn(&format!(
                "Warning: {}: columns without meaning here: {}",
                path.display(),
                columns.ignored.join(", ")
            ));
        }
        let (kept, out) = match &answers {
            Answers::Resumed(out) if out.exists() => (kept_in(out)?, Some(*out)),
            Answers::Resumed(out) | Answers::File(out) => (Vec::new(), Some(*out)),
            Answers::Shown(_) | Answers::Counted => (Vec::new(), None),
        };
        let steps = Steps::new(watch, "queries", kept.len().min(count), count);
        let most_drawn = if drawn { MOST_DRAWN } else { 0 };
        let run = Run { vehicle: self, path, columns: &columns, kept: &kept, most_drawn, steps: &steps, watch };
        let batch = match answers {
            Answers::File(out) | Answers::Resumed(out) => run.write_into(blocks, out),
            Answers::Shown(show) => {
                show(&steering::head());
                run.all(blocks, &mut |text| {
                    show(&String::from_utf8_lossy(text));
                    Ok(())
                })
            }
            Answers::Counted => run.all(blocks, &mut |_| Ok(())),
        }?;
        drop(steps);
        if batch.queries < count {
            let done = format!("{} of {count} queries answered", batch.queries);
            return Err(Problem::Interrupted(match out.filter(|_| batch.queries > 0) {
                Some(out) => format!("{done}, in {}; the same command with --resume goes on", out.display()),
                None => format!("{done}; nothing is written to go on from"),
            }));
        }
        if most_drawn > 0 && count > MOST_DRAWN {
            watch.warn(&format!("--plot draws the first {MOST_DRAWN} queries"));
        }
        Ok(batch)
    }
}

/// The answers that `out` has.
fn kept_in(out: &Path) -> Result<Vec<KeptAnswer>, Problem> {
    let kept = bounds::open(out, u64::MAX).and_then(|file| steering::kept_answers(BufReader::new(file)));
    kept.map_err(|error| Problem::of_file(out, error))
}

/// What takes rows of answers.
type Sink<'a> = dyn FnMut(&[u8]) -> io::Result<()> + Send + 'a;

/// What all blocks of a file have in common.
#[derive(Clone, Copy)]
struct Run<'a> {
    vehicle: &'a Vehicle,
    path: &'a Path,
    columns: &'a Columns,
    /// Answers that are there already, in the queries' order.
    kept: &'a [KeptAnswer],
    most_drawn: usize,
    steps: &'a Steps<'a>,
    watch: &'a dyn Watch,
}

/// A block of queries, answered as far as nobody stopped it.
struct Done {
    batch: Batch,
    rows: Vec<u8>,
    whole: bool,
}

impl Run<'_> {
    /// Answers all of `blocks` into the file `out`, which appears when they are, or with those there were when it was
    /// stopped.
    fn write_into(&self, blocks: Blocks<File>, out: &Path) -> Result<Batch, Problem> {
        let mut came = None;
        let written = atomic::write_with(out, |file| {
            if self.kept.is_empty() {
                file.write_all(steering::head().as_bytes())?;
            } else {
                io::copy(&mut File::open(out)?, file)?;
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
    fn all(&self, mut blocks: Blocks<File>, sink: &mut Sink<'_>) -> Result<Batch, Problem> {
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
        let mut write = |done: Vec<Done>, batch: &mut Batch| -> io::Result<bool> {
            for done in done {
                sink(&done.rows)?;
                batch.add(done.batch, self.most_drawn);
                if !done.whole {
                    return Ok(false);
                }
            }
            Ok(true)
        };
        while !asked.is_empty() {
            let before = std::mem::take(&mut done);
            let (filed, answered) = rayon::join(
                || {
                    let more = write(before, &mut batch).map_err(unwritten)?;
                    Ok::<_, Problem>((more, read().map_err(unreadable)?))
                },
                || asked.par_iter().with_max_len(1).map(|block| self.block(block)).collect::<Result<Vec<Done>, _>>(),
            );
            let (_, next) = filed?;
            done = answered.map_err(|error| Problem::of_file(self.path, error))?;
            // What is behind a block that was stopped is not kept: answers stand in the order of queries.
            asked = if done.iter().all(|done| done.whole) { next } else { Vec::new() };
        }
        write(done, &mut batch).map_err(unwritten)?;
        Ok(batch)
    }

    fn block(&self, block: &Block) -> Result<Done, String> {
        let rows = self.columns.rows(block).map_err(|error| error.to_string())?;
        let (mut batch, mut answers, mut whole) = (Batch::default(), Vec::with_capacity(rows.len()), true);
        // The head is the record before the first query.
        for (number, row) in (block.before - 1..).zip(rows) {
            if self.watch.stopped() {
                whole = false;
                break;
            }
            let drawn = number < self.most_drawn;
            match self.kept.get(number) {
                Some(kept) if *kept.id != *row.id => {
                    return Err(format!(
                        "line {}: id = {:?}: the answers there are go on with {:?}: --resume needs those of the same queries",
                        row.line, row.id, kept.id
                    ));
                }
                Some(kept) if !drawn || !kept.driven => {
                    batch.count(kept.status, kept.driven.then_some(kept.time_us));
                }
                kept => {
                    let answered = row.asked.as_ref().ok().map(|asked| self.vehicle.answer(asked));
                    if let (true, Some(answered), Ok(asked)) = (drawn, &answered, &row.asked)
                        && let Some((solution, _)) = &answered.drive
                    {
                        batch.drawn.push((stretches(solution, asked), asked.goal));
                    }
                    let answer = in_file(&row, answered.as_ref());
                    batch.count(answer.status, answer.drive.is_some().then_some(answer.time_us));
                    if kept.is_none() {
                        answers.push(answer);
                        self.steps.step();
                    }
                }
            }
            if let Err(wrong) = row.asked {
                batch.wrong.push((row.line, wrong));
            }
        }
        Ok(Done { batch, rows: steering::rows(&answers).into_bytes(), whole })
    }
}

impl Batch {
    /// Whether there are rows and none of them is a query.
    pub fn nothing_asked(&self) -> bool {
        self.queries > 0 && self.wrong.len() == self.queries
    }

    /// Draws the first drives, seen from above, each from its start.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn draw(&self, plot: &Path) -> Result<(), Problem> {
        let lines: Vec<Stretch> = self.drawn.iter().flat_map(|(lines, _)| lines.iter().cloned()).collect();
        let goals: Vec<[f64; 3]> = [[0.0; 3]].into_iter().chain(self.drawn.iter().map(|(_, goal)| *goal)).collect();
        let picture = steering::svg(&lines, &goals).map_err(Problem::input)?;
        Ok(atomic::write(plot, picture.as_bytes())?)
    }

    /// How many queries ended so.
    pub fn ended(&self, status: Status) -> usize {
        self.counts[status as usize]
    }

    /// What solving those took that have a drive, µs: in the mean, and at most.
    pub fn solving_us(&self) -> [f64; 2] {
        let (count, all, most) = self.solved;
        [all / count.max(1) as f64, most]
    }

    /// One more, which took `time_us` if it has a drive.
    fn count(&mut self, status: Status, time_us: Option<f64>) {
        self.queries += 1;
        self.counts[status as usize] += 1;
        if let Some(time) = time_us {
            let (count, all, most) = self.solved;
            self.solved = (count + 1, all + time, most.max(time));
        }
    }

    /// What follows, of which as many are drawn as there is room for.
    fn add(&mut self, more: Self, most_drawn: usize) {
        self.queries += more.queries;
        self.wrong.extend(more.wrong);
        self.counts.iter_mut().zip(more.counts).for_each(|(count, more)| *count += more);
        let ((count, all, most), (others, their, longest)) = (self.solved, more.solved);
        self.solved = (count + others, all + their, most.max(longest));
        self.drawn.extend(more.drawn);
        self.drawn.truncate(most_drawn);
    }
}

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
