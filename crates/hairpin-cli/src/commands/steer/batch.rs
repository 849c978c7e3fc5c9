//! Many queries from a file: answered in parallel, written in their order.

use std::path::Path;

use hairpin_formats::atomic;
use hairpin_formats::steering::{self, Answer, Drive, Errors, Frame, Queries, Row, Status};
use rayon::prelude::*;
use serde_json::json;

use super::answered::Answered;
use super::question::{pieces, stretches};
use super::vehicle::Vehicle;
use crate::args::Steer;
use crate::problem::Problem;
use crate::{console, interrupt};

/// A row and its answer; none for rows that are no queries.
type Done<'q> = (&'q Row, Option<Answered>);

/// Drives of a file that are drawn at most.
const MOST_DRAWN: usize = 500;
/// Wrong rows that are told one by one.
const MOST_TOLD: usize = 10;

pub(super) fn run(steer: &Steer, vehicle: &Vehicle, path: &Path) -> Result<u8, Problem> {
    let queries = steering::read(path).map_err(|error| Problem::input(format!("{}: {error}", path.display())))?;
    if !queries.ignored.is_empty() {
        console::warn(&format!(
            "Warning: {}: columns without meaning here: {}",
            path.display(),
            queries.ignored.join(", ")
        ));
    }
    let progress = console::progress("queries", queries.rows.len());
    let done: Vec<Done<'_>> = queries
        .rows
        .par_iter()
        .filter(|_| !interrupt::asked())
        .map(|row| {
            let answered = row.asked.as_ref().ok().map(|asked| vehicle.answer(asked));
            progress.inc(1);
            (row, answered)
        })
        .collect();
    progress.finish_and_clear();
    if done.len() < queries.rows.len() {
        return Err(Problem::Interrupted(format!(
            "{} of {} queries answered; nothing is written",
            done.len(),
            queries.rows.len()
        )));
    }
    let answers: Vec<Answer> = done.iter().map(|(row, answered)| in_file(row, answered.as_ref())).collect();
    let table = steering::table(&answers).map_err(Problem::input)?;
    match &steer.out {
        Some(out) => atomic::write(out, &table)?,
        // One object on stdout is all that --json says.
        None if steer.json => {}
        None => console::say_text(&String::from_utf8_lossy(&table)),
    }
    if let Some(plot) = &steer.plot {
        draw(plot, &done)?;
    }
    tell(steer, path, &queries, &answers);
    Ok(0)
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
    let drive = answered.drive.as_ref().map(|(solution, replay)| {
        let [x_m, y_m, yaw_rad] = replay.error;
        let errors = Errors { x_m, y_m, yaw_rad, curvature_1_m: replay.error_curvature };
        Drive { pieces: pieces(solution), errors, max_curvature_1_m: replay.max_curvature }
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

fn draw(plot: &Path, done: &[Done<'_>]) -> Result<(), Problem> {
    let mut lines = Vec::new();
    let mut goals = vec![[0.0; 3]];
    for (row, answered) in done.iter().take(MOST_DRAWN) {
        let (Ok(asked), Some(answered)) = (&row.asked, answered) else { continue };
        let Some((solution, _)) = &answered.drive else { continue };
        lines.extend(stretches(solution, asked));
        goals.push(asked.goal);
    }
    if done.len() > MOST_DRAWN {
        console::warn(&format!("--plot draws the first {MOST_DRAWN} queries"));
    }
    let picture = steering::svg(&lines, &goals).map_err(Problem::input)?;
    Ok(atomic::write(plot, picture.as_bytes())?)
}

/// Counts on stdout if the table is in a file; wrong rows on stderr.
fn tell(steer: &Steer, path: &Path, queries: &Queries, answers: &[Answer]) {
    let wrong: Vec<String> = queries
        .rows
        .iter()
        .filter_map(|row| Some(format!("{}, line {}: {}", path.display(), row.line, row.asked.as_ref().err()?)))
        .collect();
    wrong.iter().take(MOST_TOLD).for_each(|line| console::warn(line));
    if wrong.len() > MOST_TOLD {
        console::warn(&format!("… and {} more wrong rows", wrong.len() - MOST_TOLD));
    }
    let count = |status: Status| answers.iter().filter(|answer| answer.status == status).count();
    let all = [Status::Ok, Status::Infeasible, Status::NotConverged, Status::TimeLimit, Status::Invalid];
    let solved: Vec<f64> = answers.iter().filter(|a| a.drive.is_some()).map(|a| a.time_us).collect();
    let mean = solved.iter().sum::<f64>() / solved.len().max(1) as f64;
    let worst = solved.iter().copied().fold(0.0, f64::max);
    if steer.json {
        let mut object =
            json!({ "queries": answers.len(), "mean_time_us": mean, "max_time_us": worst, "exit_code": 0 });
        for status in all {
            object[status.to_string()] = count(status).into();
        }
        object["wrong"] = wrong.into();
        console::say(&object.to_string());
    } else if steer.out.is_some() {
        let counts: Vec<String> = all
            .iter()
            .filter(|status| **status == Status::Ok || count(**status) > 0)
            .map(|status| format!("{} {status}", count(*status)))
            .collect();
        let counts = counts.join(", ");
        console::say(&format!(
            "{} queries: {counts}; solving {mean:.1} µs in the mean, {worst:.0} µs at most",
            answers.len()
        ));
    }
}
