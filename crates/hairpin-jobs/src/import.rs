//! A program from elsewhere, line by line, and what an arm can do of it; or the log of a clocking module.

use std::path::{Path, PathBuf};

use hairpin::campaign::Setup;
use hairpin::campaign::arm::ArmSetup;
use hairpin::feasibility::program::{Checked, Surroundings, check};
use hairpin::feasibility::reachability::joint::FollowSettings;
use hairpin::robot::arm::Arm;
use hairpin_formats::atomic;
use hairpin_formats::bounds::{self, MOST_TEXT_BYTES};
use hairpin_formats::rapid::{self, Frames, Module, Options};
use hairpin_formats::scenario::{arm_with, setup_for};

use crate::Problem;
use crate::sets::Set;

/// What is read, and what it is held against.
#[derive(Debug, Clone, Default)]
pub struct ImportSettings {
    /// RAPID module, or the log that arc_clock.mod wrote.
    pub file: PathBuf,
    /// Who is to do what the program says; nobody if not given.
    pub check: Option<Follower>,
    /// The procedure to execute; `main` if there is one, else the first that no other calls.
    pub procedure: Option<String>,
    /// Keys with other values: of a cell the scenario's, of an arm alone `robot.KEY`.
    pub sets: Vec<Set>,
    /// Of a log: where the table of costs goes; arc_ms.csv beside the log if not given.
    pub out: Option<PathBuf>,
}

/// An arm that follows a program.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Follower {
    /// Alone: a shipped name, an arm's file or a URDF.
    Robot(String),
    /// In its cell: a scenario of an arm, by file or name.
    Cell(String),
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

/// What is said of one move.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MoveFinding {
    /// Its line.
    pub line: Option<usize>,
    /// What kind of finding.
    pub kind: &'static str,
    /// Target before.
    pub from: Option<String>,
    /// Its target.
    pub to: Option<String>,
    /// Why it cannot be executed.
    pub reason: String,
    /// All of it in words.
    pub sentence: String,
    /// Whether it rests on bodies that are estimated.
    pub estimated: bool,
    /// Whether on nothing else, so that it is no finding but was not found out.
    pub open: bool,
}

/// Reads a program or a log, and follows the one or tables the other.
///
/// # Errors
/// A file that cannot be read at all; no such arm.
pub fn import(settings: &ImportSettings) -> Result<Imported, Problem> {
    let bytes =
        bounds::read(&settings.file, MOST_TEXT_BYTES).map_err(|error| Problem::of_file(&settings.file, error))?;
    if rapid::is_log(&bytes) {
        return clocked(settings, &bytes);
    }
    let cell = match &settings.check {
        Some(Follower::Cell(cell)) => Some(setup_for(cell, &settings.sets)?),
        _ => None,
    };
    let frames = cell.as_ref().map_or_else(Frames::default, |setup| Frames::of_cell(&setup.scenario));
    let options = Options { procedure: settings.procedure.as_deref(), ..frames.options() };
    let module = rapid::read(&bytes, &options).map_err(|error| match is_rapid_by_name(&settings.file) {
        true => Problem::of_file(&settings.file, error),
        false => Problem::of_file(&settings.file, format!("{error}; {READS}")),
    })?;
    let followed =
        settings.check.as_ref().map(|follower| follow(follower, cell.as_ref(), &settings.sets, &module)).transpose()?;
    let findings = findings(&module, followed.as_ref());
    Ok(Imported::Program(Box::new(Read { module, followed, findings })))
}

/// What `import` reads, for whoever brings something else.
const READS: &str = "import reads RAPID modules (.mod, .sys, .prg) and logs that arc_clock.mod wrote";

/// Whether a file is called as RAPID's are.
fn is_rapid_by_name(file: &Path) -> bool {
    let ending = file.extension().unwrap_or_default().to_ascii_lowercase();
    ["mod", "sys", "prg"].iter().any(|rapid| ending == *rapid)
}

/// Makes the table of costs of what a clocking module logged.
fn clocked(settings: &ImportSettings, bytes: &[u8]) -> Result<Imported, Problem> {
    let times = rapid::read_log(bytes).map_err(|error| Problem::of_file(&settings.file, error))?;
    let out = settings.out.clone().unwrap_or_else(|| settings.file.with_file_name("arc_ms.csv"));
    atomic::write(&out, times.csv().as_bytes())?;
    let readings = times.arcs.values().map(|(_, count)| count).sum::<usize>();
    Ok(Imported::Clocked { out, points: times.points, moves: times.arcs.len(), readings })
}

/// What an arm makes of the program.
pub struct Follow {
    /// The arm.
    pub arm: Arm,
    /// Names of the cell's parts, where one was given.
    pub parts: Option<Vec<String>>,
    /// What it made of the moves that are certain.
    pub checked: Checked,
    /// Whether bodies of it are estimated: what is clear of them is as well.
    pub estimated: bool,
}

/// Follows the moves that are certain, in the cell if one is given.
fn follow(follower: &Follower, setup: Option<&Setup>, sets: &[Set], module: &Module) -> Result<Follow, Problem> {
    let settings = FollowSettings { locate: true, ..FollowSettings::default() };
    let cell = match follower {
        Follower::Robot(robot) => {
            let arm = arm_with(robot, sets)?;
            let checked = check(&arm, &module.program, module.certain, &Surroundings::default(), &settings);
            let estimated = arm.has_stand_ins();
            return Ok(Follow { arm, parts: None, checked, estimated });
        }
        Follower::Cell(cell) => cell,
    };
    let Some(arm) = setup.and_then(|setup| setup.own::<ArmSetup>()) else {
        return Err(Problem::input(format!("--cell {cell}: is no arm's")));
    };
    let around = Surroundings {
        cell: Some(&arm.station.cell),
        tool_radius: arm.station.tool.radius,
        clearance: arm.scenario.generate.moves.clearance_mm * 1e-3,
    };
    let checked = check(&arm.station.arm, &module.program, module.certain, &around, &settings);
    let (parts, arm) = (Some(arm.part_names()), arm.station.arm.clone());
    let estimated = arm.has_stand_ins();
    Ok(Follow { arm, parts, checked, estimated })
}

/// What a controller would stop at, and what the arm cannot do, of the moves that are certain, in their order.
fn findings(module: &Module, followed: Option<&Follow>) -> Vec<MoveFinding> {
    let mut certain = module.program.clone();
    certain.moves.truncate(module.certain);
    let mut found: Vec<(usize, MoveFinding)> = Vec::new();
    for problem in certain.problems() {
        let place = problem.place();
        let index = place.map_or(0, |place| place.index);
        let from = index.checked_sub(1).and_then(|before| certain.moves.get(before));
        let finding = MoveFinding {
            line: place.and_then(|place| place.line),
            kind: "program",
            from: from.and_then(|m| m.motion.name()).map(Into::into),
            to: place.and_then(|place| place.name.clone()),
            reason: problem.to_string(),
            sentence: format!("NOT EXECUTABLE {problem}"),
            estimated: false,
            open: false,
        };
        found.push((index, finding));
    }
    let refused: Vec<usize> = found.iter().map(|(index, _)| *index).collect();
    let parts = followed.and_then(|followed| followed.parts.as_deref()).unwrap_or_default();
    for finding in followed.iter().flat_map(|followed| &followed.checked.findings) {
        // What is no arc has been told.
        if finding.refusal.kind() == "arc" && refused.contains(&finding.index) {
            continue;
        }
        let new = MoveFinding {
            line: finding.line,
            kind: finding.refusal.kind(),
            from: finding.from.clone(),
            to: finding.to.clone(),
            reason: finding.reason(parts),
            sentence: finding.in_words(parts),
            estimated: finding.estimated.is_some(),
            open: finding.open,
        };
        found.push((finding.index, new));
    }
    found.sort_by_key(|(index, _)| *index);
    found.into_iter().map(|(_, finding)| finding).collect()
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
            let settings = ImportSettings { file: file.clone(), check, ..ImportSettings::default() };
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
