//! Many queries from a file: answered in parallel, written in their order.

use std::path::Path;

use hairpin_formats::atomic;
use hairpin_formats::steering::{self, Answer, Drive, Errors, Frame, Queries, Row, Status};
use rayon::prelude::*;

use super::answered::Answered;
use super::question::{pieces, stretches};
use super::vehicle::Vehicle;
use crate::watch::Steps;
use crate::{Problem, Watch};

/// Drives of a file that are drawn at most.
const MOST_DRAWN: usize = 500;

/// A file of queries, answered.
pub struct Batch {
    /// The queries.
    pub queries: Queries,
    /// Their answers in their order, as files have them.
    pub answers: Vec<Answer>,
    /// The same with all that is known of them; none for rows that are no queries.
    answered: Vec<Option<Answered>>,
}

impl Vehicle {
    /// Answers the queries of the file at `path`.
    ///
    /// # Errors
    /// The file cannot be read; it was asked to stop.
    pub fn answer_file(&self, path: &Path, watch: &dyn Watch) -> Result<Batch, Problem> {
        let queries = steering::read(path).map_err(|error| Problem::of_file(path, error))?;
        if !queries.ignored.is_empty() {
            watch.warn(&format!(
                "Warning: {}: columns without meaning here: {}",
                path.display(),
                queries.ignored.join(", ")
            ));
        }
        let steps = Steps::new(watch, "queries", 0, queries.rows.len());
        let one = |row: &Row| {
            let answered = row.asked.as_ref().ok().map(|asked| self.answer(asked));
            steps.step();
            answered
        };
        let rows = queries.rows.par_iter().filter(|_| !watch.stopped());
        let answered: Vec<Option<Answered>> = rows.map(one).collect();
        drop(steps);
        if answered.len() < queries.rows.len() {
            return Err(Problem::Interrupted(format!(
                "{} of {} queries answered; nothing is written",
                answered.len(),
                queries.rows.len()
            )));
        }
        let answers = queries.rows.iter().zip(&answered).map(|(row, answered)| in_file(row, answered.as_ref()));
        Ok(Batch { answers: answers.collect(), answered, queries })
    }
}

impl Batch {
    /// Whether there are rows and none of them is a query.
    pub fn nothing_asked(&self) -> bool {
        let rows = &self.queries.rows;
        !rows.is_empty() && rows.iter().all(|row| row.asked.is_err())
    }

    /// The answers as a table.
    ///
    /// # Errors
    /// The writer gives up.
    pub fn table(&self) -> Result<Vec<u8>, Problem> {
        steering::table(&self.answers).map_err(Problem::input)
    }

    /// Draws the first drives, seen from above, each from its start.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn draw(&self, plot: &Path, watch: &dyn Watch) -> Result<(), Problem> {
        let (mut lines, mut goals) = (Vec::new(), vec![[0.0; 3]]);
        for (row, answered) in self.queries.rows.iter().zip(&self.answered).take(MOST_DRAWN) {
            let (Ok(asked), Some(answered)) = (&row.asked, answered) else { continue };
            let Some((solution, _)) = &answered.drive else { continue };
            lines.extend(stretches(solution, asked));
            goals.push(asked.goal);
        }
        if self.queries.rows.len() > MOST_DRAWN {
            watch.warn(&format!("--plot draws the first {MOST_DRAWN} queries"));
        }
        let picture = steering::svg(&lines, &goals).map_err(Problem::input)?;
        Ok(atomic::write(plot, picture.as_bytes())?)
    }

    /// How many queries ended so.
    pub fn count(&self, status: Status) -> usize {
        self.answers.iter().filter(|answer| answer.status == status).count()
    }

    /// What solving those took that have a drive, µs: in the mean, and at most.
    pub fn solving_us(&self) -> [f64; 2] {
        let solved: Vec<f64> = self.answers.iter().filter(|a| a.drive.is_some()).map(|a| a.time_us).collect();
        [solved.iter().sum::<f64>() / solved.len().max(1) as f64, solved.iter().copied().fold(0.0, f64::max)]
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
