//! What comes from elsewhere, and what it is: a program, line by line, and what an arm can do of it; the log of a
//! clocking module; the log of a robot that moved; a mission.

mod files;
mod findings;
mod follow;
mod kind;
mod log;

use std::path::{Path, PathBuf};

use hairpin_formats::folder::refuse_own;
use hairpin_formats::listing::Module;
use hairpin_formats::missions::Mission;
use hairpin_formats::rapid::Frames;
use hairpin_formats::{atomic, rapid};

use crate::Problem;
use crate::check::read_anywhere;
use crate::sets::Set;
use follow::{Doer, Told};
use kind::Kind;

pub use findings::MoveFinding;
pub use follow::{Follow, Follower};
pub use log::{ReadLog, ReadMotion};

/// What is read, and what it is held against.
#[derive(Debug, Clone, Default)]
pub struct ImportSettings {
    /// RAPID modules that are one program, a program file that names them, a program in KRL or URScript; or one log or
    /// mission.
    pub files: Vec<PathBuf>,
    /// Who is to do what the program says; nobody if not given.
    pub check: Option<Follower>,
    /// The procedure to execute; `main` if there is one, else the first that no other calls.
    pub procedure: Option<String>,
    /// Keys with other values: of a cell the scenario's, of an arm alone `robot.KEY`.
    pub sets: Vec<Set>,
    /// Of an arc clock's log: where the table of costs goes; arc_ms.csv beside the log if not given.
    pub out: Option<PathBuf>,
}

/// What a file turned out to be.
pub enum Imported {
    /// A program, and what is found in it.
    Program(Box<Read>),
    /// The log of a robot that moved.
    Log(Box<ReadLog>),
    /// A mission; on Earth, about its own home.
    Mission(Box<Mission>),
    /// The log of a clocking module, of which a table of costs was made.
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

/// Reads what comes from elsewhere: follows a program, tables a clocking module's log.
///
/// # Errors
/// A file that cannot be read at all; no such arm; what is asked of programs alone, of something else.
pub fn import(settings: &ImportSettings) -> Result<Imported, Problem> {
    if let [file] = &settings.files[..] {
        match Kind::of(file)? {
            Kind::Program => {}
            Kind::ArcClock => return clocked(settings, file, &files::load(file)?),
            Kind::Log => {
                of_programs_alone(settings, file, "a log; hairpin judge holds it against a mission or a campaign")?;
                return Ok(Imported::Log(Box::new(ReadLog::of(file)?)));
            }
            Kind::Own(what) => return Err(Problem::of_file(file, format!("it is {what}"))),
            Kind::Mission => {
                of_programs_alone(settings, file, "a mission; hairpin check says whether a robot can do it")?;
                return Ok(Imported::Mission(Box::new(read_anywhere(file)?)));
            }
        }
    }
    let doer = settings.check.as_ref().map(|follower| Doer::of(follower, &settings.sets)).transpose()?;
    let is_in_base = files::is_in_base(&settings.files);
    let stands = doer.as_ref().and_then(|doer| doer.stands(is_in_base));
    let cell = doer.as_ref().and_then(Doer::cell);
    let frames = cell.map_or_else(Frames::default, |setup| Frames::of_cell(&setup.scenario));
    let frames = stands.iter().filter(|_| !is_in_base).fold(frames, Frames::in_world);
    let module = files::read(&settings.files, settings.procedure.as_deref(), &frames)?;
    let program = match stands {
        Some(stands) => follow::in_base(&module.program, &stands),
        None => module.program.clone(),
    };
    let told = Told { program: &program, certain: module.certain, is_rapid: files::are_rapid(&settings.files) };
    let follow = |(doer, follower)| follow::follow(doer, follower, &told);
    let followed = doer.zip(settings.check.as_ref()).map(follow).transpose()?;
    let findings = findings::findings(&module, followed.as_ref());
    Ok(Imported::Program(Box::new(Read { module, followed, findings })))
}

/// # Errors
/// Something is asked that `file`, which is `what`, has no answer to.
fn of_programs_alone(settings: &ImportSettings, file: &Path, what: &str) -> Result<(), Problem> {
    let asked = [
        ("--check", settings.check.is_some()),
        ("--procedure", settings.procedure.is_some()),
        ("--out", settings.out.is_some()),
    ];
    match asked.iter().find(|(_, is)| *is) {
        Some((flag, _)) => Err(Problem::of_file(file, format!("{flag}: it is {what}"))),
        None => Ok(()),
    }
}

/// Makes the table of costs of what a clocking module logged.
fn clocked(settings: &ImportSettings, file: &Path, bytes: &[u8]) -> Result<Imported, Problem> {
    let times = rapid::read_log(bytes).map_err(|error| Problem::of_file(file, error))?;
    let out = settings.out.clone().unwrap_or_else(|| file.with_file_name("arc_ms.csv"));
    refuse_own(&out)?;
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

    /// Frames of a module stand in the world, as a controller has them.
    #[test]
    fn a_base_that_stands_aside_is_seen_from_the_world() {
        let place = tempfile::tempdir().unwrap();
        let (file, cell) = (place.path().join("m.mod"), place.path().join("cell.toml"));
        let scenario = "hairpin = 1\nrobot = \"irb120\"\n[world]\nbase_frame = { mm = [1000, 0, 0], q1_q4 = [1, 0, 0, 0] }\n\
            [task]\npoints = [[350, 0, 400]]\n[spec]\npath = { max_mm = 5 }\n";
        fs::write(&cell, scenario).unwrap();
        let reaches = |x: f64, object: &str| {
            let text = format!(
                "MODULE m\nTASK PERS wobjdata wT := [FALSE,TRUE,\"\",[[1000,0,0],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];\n\
                CONST robtarget p1 := [[{x},0,300],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n\
                PROC main()\n  ConfJ \\Off;\n  MoveJ p1, v100, fine, tool0 \\WObj:={object};\nENDPROC\nENDMODULE\n"
            );
            fs::write(&file, text).unwrap();
            let check = Some(Follower::Cell(cell.display().to_string()));
            let settings = ImportSettings { files: vec![file.clone()], check, ..ImportSettings::default() };
            let Imported::Program(read) = import(&settings).unwrap() else { panic!("it is a program") };
            read.findings.iter().all(|finding| finding.kind != "reach")
        };
        assert!(reaches(300.0, "wT") && reaches(1300.0, "wobj0"));
        assert!(!reaches(1300.0, "wT") && !reaches(300.0, "wobj0"));
    }

    #[test]
    fn what_an_arm_cannot_do_is_found_by_line() {
        let place = tempfile::tempdir().unwrap();
        let file = place.path().join("m.mod");
        fs::write(&file, MODULE).unwrap();
        let read = |check| {
            let settings = ImportSettings { files: vec![file.clone()], check, ..ImportSettings::default() };
            match import(&settings).unwrap() {
                Imported::Program(read) => read,
                _ => panic!("it is a program"),
            }
        };
        let alone = read(None);
        assert_eq!((alone.module.program.moves.len(), alone.findings.len()), (2, 0));
        let followed = read(Some(Follower::Robot("irb120".into())));
        assert!(followed.findings.iter().any(|finding| finding.line == Some(6)), "{:?}", followed.findings);
    }
}
