//! The verdict on logs of robots that really moved: each against the mission that it flew. Nothing is aligned, neither
//! in space nor in time: what is done to a log's frame its user names, and what is not done is told.
//!
//! ```text
//! file ─ logs::read ─▶ Logged ─ source, frame ─▶ samples in the world's frame ─ matching ─▶ case
//!        ─ span, legs, cut ─▶ Log ─ campaign::judge_flown ─▶ Flown ─ told ─▶ one sentence
//! ```
//!
//! Logs of arms go their own way, by their programs: `arm`.

mod accuracy;
mod again;
mod against;
mod arm;
mod aside;
mod asked;
mod asks;
mod begin;
mod cut;
mod due;
mod files;
mod found;
mod frame;
mod heights;
mod left_out;
mod legs;
mod matching;
mod one;
mod over;
mod page;
mod reached;
mod remedy;
mod settings;
mod sheet;
mod source;
mod told;

#[cfg(test)]
mod tests;

use std::path::Path;

use hairpin_formats::folder::refuse_own;

use crate::copies::copies;
use crate::{Problem, Watch};
use files::{Files, files_in};
use told::name_in;

pub(crate) use accuracy::resolution;
pub use arm::{FoundProgram, JointsTold};
pub(crate) use arm::{arm_of, ran};
pub(crate) use asks::Asks;
pub use cut::Cut;
pub(crate) use cut::{Unsound, cut};
pub(crate) use due::due_alone;
pub use found::{Found, JudgedLog, JudgedLogs, Outcome};
pub(crate) use frame::IntoWorld;
pub use frame::{Altitude, FrameSettings, FrameTold};
pub(crate) use heights::Heights;
pub use left_out::LeftOut;
pub use legs::LegsBy;
pub(crate) use legs::course;
pub use matching::Matched;
pub(crate) use matching::matched;
pub use settings::{Against, LogSettings};
pub use sheet::Sheet;
pub use source::SourceTold;
pub(crate) use source::{best, clock_words};

/// Judges a log, or all that are in a folder and its subfolders. In a folder one that cannot be judged is told, and the
/// others are judged.
///
/// # Errors
/// A part of logs that ends before it begins; a campaign, mission, world or robot that cannot be read; keys of other
/// tables than `spec`; a mission nothing is asked of; a single log that cannot be read, fits no case, or does not lie
/// where its mission begins; a folder without a file; a page that cannot be written.
pub fn judge_log(settings: &LogSettings, watch: &dyn Watch) -> Result<JudgedLogs, Problem> {
    if let Some(page) = &settings.page {
        refuse_own(page)?;
    }
    if settings.path.join("scenario.toml").is_file() {
        return Err(Problem::of_file(
            &settings.path,
            "a campaign's folder, whose own flights `hairpin judge` judges without --campaign and --mission; logs lie in \
             another",
        ));
    }
    settings.in_bounds()?;
    if let Some((from, to)) = settings.from_s.zip(settings.to_s).filter(|(from, to)| from >= to) {
        return Err(Problem::input(format!("--from {from} --to {to}: --from must be before --to")));
    }
    let against = against::Ready::of(settings)?;
    against.notes.iter().for_each(|note| watch.warn(note));
    let programs = arm::Programs::of(&against)?;
    let judge = |file: &Path| match &programs {
        Some(programs) => programs.judge_file(file, &against, settings),
        None => one::judge_file(file, &against, settings),
    };
    let judged = if settings.path.is_dir() {
        judge_folder(&settings.path, &judge, watch)?
    } else {
        JudgedLogs { logs: vec![judge(&settings.path)?], count: None, left_out: Vec::new(), copies: Vec::new() }
    };
    if let Some(file) = &settings.page {
        page::write(file, &judged, &against)?;
    }
    Ok(judged)
}

fn judge_folder(
    folder: &Path,
    judge: &dyn Fn(&Path) -> Result<JudgedLog, Problem>,
    watch: &dyn Watch,
) -> Result<JudgedLogs, Problem> {
    let mut logs = Vec::new();
    let Files { logs: files, left_out } = files_in(folder)?;
    for file in files {
        if watch.stopped() {
            return Err(Problem::Interrupted(format!("stopped after {} logs", logs.len())));
        }
        logs.push(match judge(&file) {
            Ok(judged) => judged,
            Err(problem) => told::unreadable((&file, &name_in(folder, &file)), &problem),
        });
    }
    // What was not read is no recording.
    let copies = copies(logs.iter().filter(|log| log.found.is_some() || log.program.is_some()).map(|log| &log.file));
    let count = told::count(folder, &logs, &left_out, &copies);
    Ok(JudgedLogs { logs, count: Some(count), left_out, copies })
}
