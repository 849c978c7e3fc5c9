//! `hairpin import`: a program from elsewhere, line by line, and what an arm can do of it; or the log of a clocking module.

use std::fs;

use hairpin::feasibility::program::{Checked, Surroundings, check};
use hairpin::feasibility::reachability::joint::FollowSettings;
use hairpin::robot::arm::Arm;
use hairpin_formats::atomic;
use hairpin_formats::rapid::{self, Module, Options};
use hairpin_formats::scenario::{arm_for, setup_for};
use serde_json::{Value, json};

use crate::args::Import;
use crate::console;
use crate::problem::Problem;

/// A move that cannot be executed, or an arc that no controller takes.
const FINDINGS: u8 = 1;
/// A line that changes motion is not understood: what comes after it is not known.
const INCONCLUSIVE: u8 = 5;

/// What is said of one move.
struct Told {
    line: Option<usize>,
    kind: &'static str,
    from: Option<String>,
    to: Option<String>,
    reason: String,
    sentence: String,
}

/// Runs the command: 1 for findings, 5 where not all of the program is understood.
pub(crate) fn run(import: &Import) -> Result<u8, Problem> {
    let refuse = |why: String| Problem::input(format!("{}: {why}", import.file.display()));
    let bytes = fs::read(&import.file).map_err(|error| refuse(error.to_string()))?;
    if rapid::is_log(&bytes) {
        return clocked(import, &bytes);
    }
    let options = Options { procedure: import.procedure.as_deref(), ..Options::default() };
    let module = rapid::read(&bytes, &options).map_err(|error| refuse(error.to_string()))?;
    let followed = if import.check { Some(follow(import, &module)?) } else { None };
    let followed = followed.as_ref();
    let told = findings(&module, followed);
    let code = match (told.is_empty(), module.unclear_line) {
        (false, _) => FINDINGS,
        (true, Some(_)) => INCONCLUSIVE,
        (true, None) => 0,
    };
    if import.json {
        console::say(&object(import, &module, followed, &told, code).to_string());
    } else {
        in_words(import, &module, followed, &told);
    }
    Ok(code)
}

/// Makes the table of costs of what a clocking module logged: `arc_ms.csv` beside the log, or `--out`.
fn clocked(import: &Import, bytes: &[u8]) -> Result<u8, Problem> {
    let times = rapid::read_log(bytes);
    let times = times.map_err(|error| Problem::input(format!("{}: {error}", import.file.display())))?;
    let out = import.out.clone().unwrap_or_else(|| import.file.with_file_name("arc_ms.csv"));
    atomic::write(&out, times.csv().as_bytes())?;
    let (arcs, readings) = (times.arcs.len(), times.arcs.values().map(|(_, count)| count).sum::<usize>());
    if import.json {
        let object = json!({
            "points": times.points, "arcs": arcs, "readings": readings, "table": out, "exit_code": 0,
        });
        console::say(&object.to_string());
    } else {
        console::say(&format!(
            "{}: {arcs} moves between {} points, {readings} readings: generate.cost = {{ table = {:?} }}",
            out.display(),
            times.points,
            out.display().to_string()
        ));
    }
    Ok(0)
}

/// What an arm makes of the program.
struct Follow {
    arm: Arm,
    /// Of the cell, where one was given.
    parts: Option<Vec<String>>,
    checked: Checked,
}

/// Follows the moves that are certain, in the cell if one is given.
fn follow(import: &Import, module: &Module) -> Result<Follow, Problem> {
    let settings = FollowSettings { locate: true, ..FollowSettings::default() };
    let Some(cell) = &import.cell else {
        let arm = arm_for(&import.robot)?;
        let checked = check(&arm, &module.program, module.certain, &Surroundings::default(), &settings);
        return Ok(Follow { arm, parts: None, checked });
    };
    let setup = setup_for(cell, &[])?;
    let Some(arm) = setup.arm() else { return Err(Problem::input(format!("--cell {cell}: is no arm's"))) };
    let around = Surroundings {
        cell: Some(&arm.station.cell),
        tool_radius: arm.station.tool.radius,
        clearance: arm.scenario.generate.moves.clearance_mm * 1e-3,
    };
    let checked = check(&arm.station.arm, &module.program, module.certain, &around, &settings);
    Ok(Follow { arm: arm.station.arm.clone(), parts: Some(arm.part_names()), checked })
}

/// What a controller would stop at, and what the arm cannot do, of the moves that are certain, in their order.
fn findings(module: &Module, followed: Option<&Follow>) -> Vec<Told> {
    let mut certain = module.program.clone();
    certain.moves.truncate(module.certain);
    let mut told: Vec<(usize, Told)> = Vec::new();
    for problem in certain.problems() {
        let place = problem.place();
        let index = place.map_or(0, |place| place.index);
        let from = index.checked_sub(1).and_then(|before| certain.moves.get(before));
        let finding = Told {
            line: place.and_then(|place| place.line),
            kind: "program",
            from: from.and_then(|m| m.motion.name()).map(Into::into),
            to: place.and_then(|place| place.name.clone()),
            reason: problem.to_string(),
            sentence: format!("NOT EXECUTABLE {problem}"),
        };
        told.push((index, finding));
    }
    let refused: Vec<usize> = told.iter().map(|(index, _)| *index).collect();
    let parts = followed.and_then(|followed| followed.parts.as_deref()).unwrap_or_default();
    for finding in followed.iter().flat_map(|followed| &followed.checked.findings) {
        // What is no arc has been told.
        if finding.refusal.kind() == "arc" && refused.contains(&finding.index) {
            continue;
        }
        let new = Told {
            line: finding.line,
            kind: finding.refusal.kind(),
            from: finding.from.clone(),
            to: finding.to.clone(),
            reason: finding.reason(parts),
            sentence: finding.told(parts),
        };
        told.push((finding.index, new));
    }
    told.sort_by_key(|(index, _)| *index);
    told.into_iter().map(|(_, finding)| finding).collect()
}

fn object(import: &Import, module: &Module, followed: Option<&Follow>, told: &[Told], code: u8) -> Value {
    let findings = told.iter().map(|finding| {
        json!({ "line": finding.line, "kind": finding.kind, "from": finding.from, "to": finding.to, "reason": finding.reason })
    });
    let unclear = module.unclear().map(|(line, why)| json!({ "line": line, "why": why.what }));
    let mistakes = module
        .mistakes
        .iter()
        .map(|found| json!({ "line": found.at.line, "column": found.at.column, "what": found.what }));
    let mut object = json!({
        "module": module.program.name,
        "procedure": module.program.procedure,
        "moves": module.program.moves.len(),
        "certain_moves": module.certain,
        "certain_up_to_line": module.unclear_line,
        "robot": followed.map(|followed| &followed.arm.name),
        "obstacles": followed.and_then(|followed| followed.parts.as_ref()),
        "checked": followed.map(|followed| followed.checked.followed),
        "ends_only": followed.map(|followed| followed.checked.ends_only),
        "findings": findings.collect::<Vec<_>>(),
        "not_understood": unclear.collect::<Vec<_>>(),
        "mistakes": mistakes.collect::<Vec<_>>(),
        "exit_code": code,
    });
    if import.lines {
        let lines = module
            .lines
            .iter()
            .map(|(line, said)| json!({ "line": line, "class": said.class.words(), "why": said.what }));
        object["lines"] = lines.collect();
    }
    object
}

fn in_words(import: &Import, module: &Module, followed: Option<&Follow>, told: &[Told]) {
    let program = &module.program;
    let moves = program.moves.len();
    console::say(&format!(
        "{}: module {}, procedure {}, {moves} moves",
        import.file.display(),
        program.name,
        if program.procedure.is_empty() { "none" } else { &program.procedure }
    ));
    if let Some(Follow { arm, parts, checked }) = followed {
        let caveat = if arm.caveat.is_empty() { String::new() } else { format!(" ({})", arm.caveat) };
        let around = match parts {
            Some(parts) => format!("held against {} obstacles and keep-outs", parts.len()),
            None => "obstacles are not looked at (--cell)".into(),
        };
        console::say(&format!(
            "{}{caveat}: {} moves followed, proven between samples, of {} only the end; {around}",
            arm.name, checked.followed, checked.ends_only
        ));
    }
    if import.lines {
        for (line, said) in &module.lines {
            let why = if said.what.is_empty() { String::new() } else { format!(": {}", said.what) };
            console::say(&format!("line {line}: {}{why}", said.class.words()));
        }
    }
    for finding in told {
        console::say(&finding.sentence);
    }
    for (line, why) in module.unclear() {
        console::say(&format!("line {line}: NOT UNDERSTOOD {}", why.what));
    }
    for found in &module.mistakes {
        console::warn(&format!("{}: {}", found.at, found.what));
    }
    for procedure in module.procedures.iter().filter(|procedure| !procedure.executed) {
        console::warn(&format!("line {}: procedure {} is not executed", procedure.line, procedure.name));
    }
    let word = if told.len() == 1 { "finding" } else { "findings" };
    let what = if followed.is_some() { format!("{} {word}", told.len()) } else { "read".to_owned() };
    console::say(&match module.unclear_line {
        Some(line) => {
            let verdict = if told.is_empty() { "INCONCLUSIVE" } else { "FAIL" };
            format!("{verdict}: {what} in the {} of {moves} moves before line {line}", module.certain)
        }
        None if told.is_empty() => format!("PASS: {what} in {moves} moves"),
        None => format!("FAIL: {} {word} in {moves} moves", told.len()),
    });
}
