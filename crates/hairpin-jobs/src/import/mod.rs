//! A program from elsewhere, line by line, and what an arm can do of it; or the log of a clocking module.

mod files;
mod findings;
mod follow;

use std::path::{Path, PathBuf};

use hairpin_formats::listing::Module;
use hairpin_formats::rapid::Frames;
use hairpin_formats::scenario::setup_for;
use hairpin_formats::{atomic, rapid};

use crate::Problem;
use crate::sets::Set;

pub use findings::MoveFinding;
pub use follow::{Follow, Follower};

/// What is read, and what it is held against.
#[derive(Debug, Clone, Default)]
pub struct ImportSettings {
    /// RAPID modules that are one program, a program file that names them, a program in KRL or URScript, or the log
    /// that arc_clock.mod wrote.
    pub files: Vec<PathBuf>,
    /// Who is to do what the program says; nobody if not given.
    pub check: Option<Follower>,
    /// The procedure to execute; `main` if there is one, else the first that no other calls.
    pub procedure: Option<String>,
    /// Keys with other values: of a cell the scenario's, of an arm alone `robot.KEY`.
    pub sets: Vec<Set>,
    /// Of a log: where the table of costs goes; arc_ms.csv beside the log if not given.
    pub out: Option<PathBuf>,
}

/// What a file turned out to be.
pub enum Imported {
    /// A program, and what is found in it.
    Program(Box<Read>),
    /// A log, of which a table of costs was made.
    Clocked {
        /// The table.
        out: PathBuf,
        /// Points of the log.
        points: usize,
        /// Moves between them.
        moves: usize,
        /// Readings of the clock.
        readings: usize,
    },
}

/// A program that was read.
pub struct Read {
    /// Its module.
    pub module: Module,
    /// What an arm makes of it, if one was to.
    pub followed: Option<Follow>,
    /// What a controller would stop at, and what the arm cannot do, of the moves that are certain, in their order.
    pub findings: Vec<MoveFinding>,
}

/// Reads a program or a log, and follows the one or tables the other.
///
/// # Errors
/// A file that cannot be read at all; no such arm.
pub fn import(settings: &ImportSettings) -> Result<Imported, Problem> {
    if let [file] = &settings.files[..] {
        let bytes = files::load(file)?;
        if rapid::is_log(&bytes) {
            return clocked(settings, file, &bytes);
        }
    }
    let cell = match &settings.check {
        Some(Follower::Cell(cell)) => Some(setup_for(cell, &settings.sets)?),
        _ => None,
    };
    let frames = cell.as_ref().map_or_else(Frames::default, |setup| Frames::of_cell(&setup.scenario));
    let module = files::read(&settings.files, settings.procedure.as_deref(), &frames)?;
    let follow = |follower| follow::follow(follower, cell.as_ref(), &settings.sets, &module);
    let followed = settings.check.as_ref().map(follow).transpose()?;
    let findings = findings::findings(&module, followed.as_ref());
    Ok(Imported::Program(Box::new(Read { module, followed, findings })))
}

/// Makes the table of costs of what a clocking module logged.
fn clocked(settings: &ImportSettings, file: &Path, bytes: &[u8]) -> Result<Imported, Problem> {
    let times = rapid::read_log(bytes).map_err(|error| Problem::of_file(file, error))?;
    let out = settings.out.clone().unwrap_or_else(|| file.with_file_name("arc_ms.csv"));
    atomic::write(&out, times.csv().as_bytes())?;
    let readings = times.arcs.values().map(|(_, count)| count).sum::<usize>();
    Ok(Imported::Clocked { out, points: times.points, moves: times.arcs.len(), readings })
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    const MODULE: &str = "MODULE m\n\
        CONST robtarget p1 := [[300,0,300],[0.70710678,0,0.70710678,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n\
        CONST robtarget far := [[3000,0,300],[0.70710678,0,0.70710678,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n\
        PROC main()\n  MoveJ p1, v100, fine, tool0;\n  MoveL far, v100, fine, tool0;\nENDPROC\nENDMODULE\n";

    #[test]
    fn what_an_arm_cannot_do_is_found_by_line() {
        let place = tempfile::tempdir().unwrap();
        let file = place.path().join("m.mod");
        fs::write(&file, MODULE).unwrap();
        let read = |check| {
            let settings = ImportSettings { files: vec![file.clone()], check, ..ImportSettings::default() };
            match import(&settings).unwrap() {
                Imported::Program(read) => read,
                Imported::Clocked { .. } => panic!("it is no log"),
            }
        };
        let alone = read(None);
        assert_eq!((alone.module.program.moves.len(), alone.findings.len()), (2, 0));
        let followed = read(Some(Follower::Robot("irb120".into())));
        assert!(followed.findings.iter().any(|finding| finding.line == Some(6)), "{:?}", followed.findings);
    }
}
