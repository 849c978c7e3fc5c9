//! A module from a cell as a program, with what every line of it means for motion.

use std::collections::BTreeSet;

use hairpin::campaign::Scenario;
use hairpin::trajectory::program::{Program, Tool, WorkObject};
use nalgebra::Isometry3;
use thiserror::Error;

use super::kinds::DataKind;
use super::lex::Comment;
use super::parse::{Mistake, parse};
use super::run::{Known, Machine};
use super::syntax::{Routine, RoutineKind, Source, What};
use super::value;
use super::walk::each;
use crate::listing::{Declared, File, Found, Line, Module, Part, Procedure, decode};

/// What the reader does not find in the file.
#[derive(Debug, Clone, Copy, Default)]
pub struct Options<'a> {
    /// The procedure to execute; `main` if not given, or the first one that no other calls.
    pub procedure: Option<&'a str>,
    /// Tools on the controller beside `tool0`.
    pub tools: &'a [Tool],
    /// Work objects on the controller beside `wobj0`.
    pub work_objects: &'a [WorkObject],
}

/// What programs find on a controller: a tool and a work object that they need not declare.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Frames {
    tools: Vec<Tool>,
    work_objects: Vec<WorkObject>,
}

impl Frames {
    /// Those of a scenario's arm; none of any other robot.
    pub fn of(scenario: &Scenario) -> Self {
        let (tools, work_objects) = scenario.frames().into_iter().unzip();
        Self { tools, work_objects }
    }

    /// The same for modules from elsewhere, to which `tool0` is the flange and `wobj0` the base whatever a scenario
    /// has.
    pub fn of_cell(scenario: &Scenario) -> Self {
        let mut frames = Self::of(scenario);
        frames.tools.retain(|tool| !tool.name.eq_ignore_ascii_case("tool0"));
        frames.work_objects.retain(|object| !object.name.eq_ignore_ascii_case("wobj0"));
        frames
    }

    /// The same with user frames as controllers have them, in the world in which the base stands at `world_from_base`,
    /// m.
    pub fn in_world(mut self, world_from_base: &Isometry3<f64>) -> Self {
        self.work_objects.iter_mut().for_each(|object| object.user = world_from_base * object.user);
        self
    }

    /// How modules are read that find them.
    pub fn options(&self) -> Options<'_> {
        Options { tools: &self.tools, work_objects: &self.work_objects, ..Options::default() }
    }
}

/// A file without any module in it, or without the procedure asked for.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum NoModule {
    /// No `MODULE name` anywhere.
    #[error("no RAPID module in it: no line says MODULE and a name")]
    Absent,
    /// The procedure asked for is not there.
    #[error("no procedure `{asked}` in it; there is {}", if there.is_empty() { "none".into() } else { there.join(", ") })]
    Procedure {
        /// What was asked for.
        asked: String,
        /// The procedures without parameters.
        there: Vec<String>,
    },
}

/// What is nested is read and executed by recursion, as deep as the limits allow; the caller's stack may be small.
const STACK: usize = 64 << 20;

/// Reads a file. Nothing in it is refused but a file without a module: what is not understood is told, and the moves up
/// to there are certain.
///
/// # Errors
/// [`NoModule`].
pub fn read(bytes: &[u8], options: &Options<'_>) -> Result<Module, NoModule> {
    read_all(&[File { name: "", bytes }], options).map_err(|(_, why)| why)
}

/// Reads the files of one program: what one module declares all know, but for what is LOCAL. Lines are counted through
/// all of them ([`Module::place`]).
///
/// # Errors
/// [`NoModule`], with the index of the file.
pub fn read_all(files: &[File<'_>], options: &Options<'_>) -> Result<Module, (usize, NoModule)> {
    std::thread::scope(|scope| {
        let reader = std::thread::Builder::new().stack_size(STACK);
        match reader.spawn_scoped(scope, || read_here(files, options)) {
            Ok(reading) => reading.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)),
            // No thread to be had: this one's stack does for all but the deepest programs.
            Err(_) => read_here(files, options),
        }
    })
}

/// The text of all files.
#[derive(Default)]
struct Text {
    source: Source,
    parts: Vec<Part>,
    mistakes: Vec<Mistake>,
    /// Of the first file.
    header: Vec<String>,
}

impl Text {
    fn of(files: &[File<'_>]) -> Result<Self, (usize, NoModule)> {
        let mut text = Self::default();
        let mut first_line = 1;
        for (index, file) in files.iter().enumerate() {
            let decoded = decode(file.bytes);
            let before = text.source.modules.len();
            let (mistakes, comments) = parse(&decoded, first_line, &mut text.source);
            let Some((_, line)) = text.source.modules.get(before) else { return Err((index, NoModule::Absent)) };
            if index == 0 {
                text.header = header(&comments, *line);
            }
            text.mistakes.extend(mistakes);
            text.parts.push(Part { name: file.name.into(), first_line });
            first_line += decoded.matches('\n').count() + 1;
        }
        if text.source.modules.is_empty() { Err((0, NoModule::Absent)) } else { Ok(text) }
    }
}

/// Comments right below the line of MODULE, without the notice of written programs.
fn header(comments: &[Comment], module: usize) -> Vec<String> {
    let mut header = Vec::new();
    for comment in comments.iter().skip_while(|comment| comment.line <= module) {
        if comment.line != module + 1 + header.len() {
            break;
        }
        header.push(comment.text.strip_prefix(' ').unwrap_or(&comment.text).to_owned());
    }
    header.retain(|line| line != crate::banner::NOTICE);
    header
}

fn read_here(files: &[File<'_>], options: &Options<'_>) -> Result<Module, (usize, NoModule)> {
    let Text { source, parts, mistakes, header } = Text::of(files)?;
    let entry = entry(&source, options.procedure).map_err(|why| (0, why))?;
    let known = Known { tools: options.tools, work_objects: options.work_objects };
    let mut machine = Machine::new(&source, known);
    let targets = targets(&source, &machine);
    if let Some(entry) = entry {
        machine.run(entry);
        machine.name_handlers(&source);
    }
    // Statements are told where they are executed. Anything else, a module that is cut short above all, leaves open
    // what the program would have been: no controller loads it.
    for mistake in mistakes.iter().filter(|mistake| !mistake.in_routine) {
        machine.leave_open(mistake.at, &mistake.what);
    }
    let mut lines = machine.lines;
    for mistake in &mistakes {
        lines.entry(mistake.at.line).or_insert_with(|| Line::harmless(mistake.what.clone()));
    }
    let (certain, unclear_line) = match machine.unclear {
        Some((moves, line)) => (moves, Some(line)),
        None => (machine.moves.len(), None),
    };
    let procedures = source.routines.iter().filter(|routine| routine.kind == RoutineKind::Procedure);
    let procedures = procedures.map(|routine| Procedure {
        name: routine.name.clone(),
        line: routine.at.line,
        executed: machine.ran.contains(&routine.at),
    });
    let home = entry.map_or(0, |entry| entry.home.module);
    Ok(Module {
        procedures: procedures.collect(),
        program: Program {
            name: source.modules.get(home).map(|(name, _)| name.clone()).unwrap_or_default(),
            procedure: entry.map(|entry| entry.name.clone()).unwrap_or_default(),
            tools: machine.tools,
            work_objects: machine.work_objects,
            moves: machine.moves,
        },
        certain,
        unclear_line,
        header,
        lines,
        refused: Vec::new(),
        mistakes: mistakes.into_iter().map(|mistake| Found { at: mistake.at, what: mistake.what }).collect(),
        targets,
        parts,
    })
}

/// The procedure to execute; `None` where there is none without parameters.
fn entry<'a>(source: &'a Source, asked: Option<&str>) -> Result<Option<&'a Routine>, NoModule> {
    let procedures = source.routines.iter().filter(|routine| routine.kind == RoutineKind::Procedure);
    let callable: Vec<_> = procedures.filter(|routine| routine.parameters.iter().all(|p| p.optional)).collect();
    let named = |name: &str| callable.iter().find(|routine| routine.name.eq_ignore_ascii_case(name)).copied();
    if let Some(asked) = asked {
        return match named(asked) {
            Some(routine) => Ok(Some(routine)),
            None => Err(NoModule::Procedure {
                asked: asked.into(),
                there: callable.iter().map(|routine| routine.name.clone()).collect(),
            }),
        };
    }
    let mut called = BTreeSet::new();
    for routine in &source.routines {
        each(&routine.body, &mut |statement| {
            if let What::Call { name, .. } = &statement.what
                && !name.eq_ignore_ascii_case(&routine.name)
            {
                called.insert(name.to_ascii_lowercase());
            }
        });
    }
    let root = callable.iter().find(|routine| !called.contains(&routine.name.to_ascii_lowercase()));
    Ok(named("main").or(root.copied()).or(callable.first().copied()))
}

/// Robtargets as they are declared, arrays element by element.
fn targets(source: &Source, machine: &Machine<'_>) -> Vec<Declared> {
    let mut found = Vec::new();
    let robtargets =
        source.data.iter().filter(|declaration| DataKind::of(&declaration.kind) == Some(DataKind::RobTarget));
    for declaration in robtargets {
        let Some(variable) = machine.global(declaration) else { continue };
        let mut leaves = Vec::new();
        collect(variable, declaration.name.clone(), &mut leaves);
        for (name, value) in leaves {
            let target = value::pose_target(value, Some(&name));
            found.push(Declared { line: declaration.at.line, name, target });
        }
    }
    found
}

fn collect<'v>(value: &'v value::Value, name: String, found: &mut Vec<(String, &'v value::Value)>) {
    match value {
        value::Value::Array(parts) => {
            for (index, part) in parts.iter().enumerate() {
                collect(part, format!("{name}_{}", index + 1), found);
            }
        }
        _ => found.push((name, value)),
    }
}
