//! `hairpin import`: a program from elsewhere, line by line, and what an arm can do of it; the log of a clocking
//! module; or the log of a robot or a mission, and what would be judged of it.

mod elsewhere;

use hairpin_formats::listing::{Module, Procedure, Unmodelled};
use hairpin_formats::quote::shortened;
use hairpin_jobs::Problem;
use hairpin_jobs::import::{Follow, Follower, ImportSettings, Imported, MoveFinding, Read, import};
use hairpin_jobs::sets::Set;
use serde_json::{Value, json};

use crate::args::Import;
use crate::exit::{DONE, FINDING, INCONCLUSIVE};
use crate::{console, settings};

/// Runs the command: 1 for findings, 5 where not all of what moves is understood.
pub(crate) fn run(asked: &Import) -> Result<u8, Problem> {
    let follower = || asked.cell.clone().map_or_else(|| Follower::Robot(asked.robot.clone()), Follower::Cell);
    let imported = import(&ImportSettings {
        files: asked.files.clone(),
        check: asked.check.then(follower),
        procedure: asked.procedure.clone(),
        sets: sets(asked)?,
        out: asked.out.clone(),
    })?;
    let read = match imported {
        Imported::Program(read) => read,
        Imported::Clocked { .. } => {
            clocked(&imported, asked.json);
            return Ok(DONE);
        }
        Imported::Log(log) => return Ok(elsewhere::tell_log(&asked.files[0], &log, asked.json)),
        Imported::Mission(mission) => return Ok(elsewhere::tell_mission(&mission, asked.json)),
    };
    // A line that changes motion is not understood: what comes after it is not known.
    let open = read.findings.iter().any(|finding| finding.open) || unfollowed(asked, &read.module).is_some();
    let code = match (read.findings.iter().all(|finding| finding.open), read.module.unclear_line) {
        (false, _) => FINDING,
        (true, Some(_)) => INCONCLUSIVE,
        (true, None) if open => INCONCLUSIVE,
        (true, None) => DONE,
    };
    if asked.json {
        console::say(&object(asked, &read, code).to_string());
    } else {
        in_words(asked, &read);
    }
    Ok(code)
}

/// Why a program that was to be checked was not, although every line that was executed is understood.
fn unfollowed(asked: &Import, module: &Module) -> Option<String> {
    if !asked.check {
        return None;
    }
    if module.program.moves.is_empty() {
        return Some("no move was found in it".into());
    }
    let is_main = |name: &str| name.eq_ignore_ascii_case("main");
    let left: Vec<&str> = not_executed(module).map(|procedure| procedure.name.as_str()).collect();
    let is_said = asked.procedure.is_some() || module.procedures.iter().any(|procedure| is_main(&procedure.name));
    let named = left.iter().take(5).copied().collect::<Vec<_>>().join(", ");
    (!is_said && !left.is_empty())
        .then(|| format!("no main says whether {named} is executed: --procedure NAME follows one"))
}

fn not_executed(module: &Module) -> impl Iterator<Item = &Procedure> {
    module.procedures.iter().filter(|procedure| !procedure.executed)
}

/// The flags as keys of the arm, and what else is set.
fn sets(asked: &Import) -> Result<Vec<Set>, Problem> {
    let mut all = settings::split(&asked.sets)?;
    let mut set = |key: &str, value: Value| all.push((format!("robot.{key}"), value.to_string()));
    asked.tip.iter().for_each(|link| set("tip", json!(link)));
    asked.srdf.iter().for_each(|file| set("srdf", json!(file)));
    if !asked.packages.is_empty() {
        set("packages", json!(asked.packages));
    }
    Ok(all)
}

/// Tells of the table of costs that was made of a log.
fn clocked(imported: &Imported, json: bool) {
    let Imported::Clocked { out, points, moves, readings } = imported else { return };
    if json {
        let object = json!({
            "kind": "arc clock", "points": points, "arcs": moves, "readings": readings, "table": out, "exit_code": DONE,
        });
        console::say(&object.to_string());
    } else {
        console::say(&format!(
            "{}: {moves} moves between {points} points, {readings} readings: generate.cost = {{ table = {:?} }}",
            out.display(),
            out.display().to_string()
        ));
    }
}

fn object(import: &Import, read: &Read, code: u8) -> Value {
    let Read { module, followed, findings } = read;
    let followed = followed.as_ref();
    let findings = findings.iter().map(|finding| {
        json!({
            "file": finding.file, "line": finding.line, "kind": finding.kind, "from": finding.from, "to": finding.to,
            "reason": shortened(&finding.reason), "estimated": finding.estimated, "open": finding.open,
            "count": finding.count, "moves": finding.moves, "last": finding.last.as_deref().map(shortened),
        })
    });
    let unclear = module.unclear().map(|(line, why)| {
        let (file, line) = place(module, line);
        json!({ "file": file, "line": line, "kind": why.unmodelled.map(Unmodelled::word), "why": shortened(&why.what) })
    });
    let mistakes = module.mistakes.iter().map(|found| {
        let (file, line) = place(module, found.at.line);
        json!({ "file": file, "line": line, "column": found.at.column, "what": shortened(&found.what) })
    });
    let left = not_executed(module).map(|procedure| {
        let (file, line) = place(module, procedure.line);
        json!({ "file": file, "line": line, "procedure": procedure.name })
    });
    let unclear_place = module.unclear_line.map(|line| place(module, line));
    let mut object = json!({
        "kind": "program",
        "module": module.program.name,
        "procedure": module.program.procedure,
        "moves": module.program.moves.len(),
        "certain_moves": module.certain,
        "certain_up_to_line": unclear_place.map(|(_, line)| line),
        "certain_up_to_file": unclear_place.and_then(|(file, _)| file),
        "files": module.parts.iter().map(|part| &part.name).collect::<Vec<_>>(),
        "robot": followed.map(|followed| &followed.arm.name),
        "obstacles": followed.and_then(|followed| followed.parts.as_ref()),
        "checked": followed.map(|followed| followed.checked.followed),
        "ends_only": followed.map(|followed| followed.checked.ends_only),
        "estimated": followed.map(|followed| &followed.arm.estimated),
        "findings": findings.collect::<Vec<_>>(),
        "not_understood": unclear.collect::<Vec<_>>(),
        "mistakes": mistakes.collect::<Vec<_>>(),
        "not_executed": left.collect::<Vec<_>>(),
        "not_followed": unfollowed(import, module),
        "exit_code": code,
    });
    if import.lines {
        let lines = module.lines.iter().map(|(line, said)| {
            let (file, line) = place(module, *line);
            json!({ "file": file, "line": line, "class": said.class.words(), "why": shortened(&said.what) })
        });
        object["lines"] = lines.collect();
    }
    object
}

/// Name of a line's file, and which of its lines it is.
fn place(module: &Module, line: usize) -> (Option<&str>, usize) {
    let (part, line) = module.place(line);
    (part.map(|part| part.name.as_str()), line)
}

fn in_words(import: &Import, Read { module, followed, findings }: &Read) {
    let program = &module.program;
    let moves = program.moves.len();
    console::say(&format!(
        "{}: module {}, procedure {}, {moves} moves",
        import.files.iter().map(|file| file.display().to_string()).collect::<Vec<_>>().join(", "),
        program.name,
        if program.procedure.is_empty() { "none" } else { &program.procedure }
    ));
    if let Some(Follow { arm, parts, words, checked, .. }) = followed {
        let caveat = if arm.caveat.is_empty() { String::new() } else { format!(" ({})", arm.caveat) };
        let around = match parts {
            Some(parts) if *words > 0 => format!(
                "held against {} obstacles and keep-outs, of which the {words} in words hold for the tool alone",
                parts.len()
            ),
            Some(parts) => format!("held against {} obstacles and keep-outs", parts.len()),
            None => "obstacles are not looked at (--cell)".into(),
        };
        console::say(&format!(
            "{}{caveat}: {} moves followed, proven between samples, of {} only the end; {around}",
            arm.name, checked.followed, checked.ends_only
        ));
        arm.estimated.iter().for_each(|what| console::say(&format!("estimated: {what}")));
    }
    if import.lines {
        for (line, said) in &module.lines {
            let why = if said.what.is_empty() { String::new() } else { format!(": {}", said.what) };
            console::say(&shortened(&format!("{}: {}{why}", module.told(*line), said.class.words())));
        }
    }
    for finding in findings {
        console::say(&shortened(&finding.in_words()));
    }
    for (line, why) in module.unclear() {
        let line = module.told(line);
        console::say(&shortened(&match why.unmodelled {
            Some(kind) => format!("{line}: NOT MODELLED {}: {}", kind.words(), why.what),
            None => format!("{line}: NOT UNDERSTOOD {}", why.what),
        }));
    }
    for found in &module.mistakes {
        console::warn(&format!("{}, column {}: {}", module.told(found.at.line), found.at.column, found.what));
    }
    for procedure in not_executed(module) {
        console::warn(&format!("{}: procedure {} is not executed", module.told(procedure.line), procedure.name));
    }
    console::say(&verdict(module, followed.as_ref(), findings, unfollowed(import, module)));
}

/// The last line: the outcome, and whether it rests on bodies that are estimated.
fn verdict(module: &Module, followed: Option<&Follow>, all: &[MoveFinding], unfollowed: Option<String>) -> String {
    let moves = module.program.moves.len();
    let (open, findings): (Vec<&MoveFinding>, Vec<&MoveFinding>) = all.iter().partition(|finding| finding.open);
    let count = |of: &[&MoveFinding]| of.iter().map(|finding| finding.count).sum::<usize>();
    let found = match (count(&findings), findings.len()) {
        (1, _) => "1 finding".to_owned(),
        (all, different) if all == different => format!("{all} findings"),
        (all, different) => format!("{all} findings, {different} of them different,"),
    };
    let what = if followed.is_some() { found.clone() } else { "read".to_owned() };
    let rests = match followed {
        // What is found is worth as much as what it rests on, and so is that there is nothing else.
        Some(_) if !findings.is_empty() => findings.iter().any(|finding| finding.estimated),
        Some(followed) => followed.estimated,
        None => false,
    };
    let estimated = if rests { ", estimated: not all links' shapes are known" } else { "" };
    let not_found_out = match (count(&open), open.iter().all(|finding| finding.estimated)) {
        (0, _) => String::new(),
        (1, true) => ", 1 meeting of estimated shapes alone not found out".into(),
        (count, true) => format!(", {count} meetings of estimated shapes alone not found out"),
        (count, false) => format!(", {count} not found out"),
    };
    let is_open = !open.is_empty() || unfollowed.is_some();
    let not_found_out = unfollowed.map_or(String::new(), |why| format!(", {why}")) + &not_found_out;
    match module.unclear_line {
        Some(line) => {
            let verdict = if findings.is_empty() { "INCONCLUSIVE" } else { "FAIL" };
            let is_handler = module.lines.get(&line).is_some_and(|line| line.unmodelled == Some(Unmodelled::Handlers));
            if is_handler {
                // The way without what it handles is certain to its end.
                let handler = module.told(line);
                return format!(
                    "{verdict}: {what} in {moves} moves, but {handler} is in a handler, and none is followed{not_found_out}{estimated}"
                );
            }
            let before = module.told(line);
            let certain = module.certain;
            format!("{verdict}: {what} in the {certain} of {moves} moves before {before}{not_found_out}{estimated}")
        }
        None if findings.is_empty() && !is_open => format!("PASS: {what} in {moves} moves{estimated}"),
        None if findings.is_empty() => format!("INCONCLUSIVE: {what} in {moves} moves{not_found_out}{estimated}"),
        None => format!("FAIL: {found} in {moves} moves{not_found_out}{estimated}"),
    }
}
