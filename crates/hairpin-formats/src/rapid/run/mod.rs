//! Executes a module without its cell: what depends on the cell is unknown, and where it would change motion, that is
//! told.

mod calls;
mod effects;
mod expressions;
mod motion;
mod statements;
mod variables;

use std::collections::{BTreeMap, BTreeSet};

use hairpin::trajectory::program::{Move, Tool, WorkObject};

use super::kinds::DataKind;
use super::lex::At;
use super::lines::{Class, Line};
use super::syntax::{Routine, RoutineKind, Source, each};
use super::value::{Value, Variable};

/// Statements and values at most; a program that takes more is told to be endless.
const MOST_STEPS: usize = 1_000_000;
/// Moves at most.
const MOST_MOVES: usize = 100_000;
/// Routines that call each other, blocks in blocks and values in values, this deep at most.
const DEEPEST: usize = 250;

/// What execution gave.
pub(super) struct Machine<'a> {
    routines: BTreeMap<String, &'a Routine>,
    globals: BTreeMap<String, Variable>,
    frames: Vec<Frame>,
    known: Known<'a>,
    /// State of ConfL and ConfJ.
    demanded: Demanded,
    steps: usize,
    depth: usize,
    /// Data that is declared, in values.
    size: usize,
    pub(super) tools: Vec<Tool>,
    pub(super) work_objects: Vec<WorkObject>,
    pub(super) moves: Vec<Move>,
    pub(super) lines: BTreeMap<usize, Line>,
    /// How many moves come before the first line that changes motion and is not understood, and that line.
    pub(super) unclear: Option<(usize, usize)>,
    pub(super) ran: BTreeSet<String>,
}

/// What the controller has beside the file.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Known<'a> {
    pub(super) tools: &'a [Tool],
    pub(super) work_objects: &'a [WorkObject],
}

struct Demanded {
    linear: bool,
    joint: bool,
}

/// A routine that is being executed.
#[derive(Default)]
struct Frame {
    variables: BTreeMap<String, Variable>,
    /// Optional parameters that were given.
    given: BTreeSet<String>,
    /// Data it declared, in values.
    size: usize,
}

/// Where execution goes on.
enum Flow {
    Next,
    Return(Option<Value>),
    /// Nowhere.
    End,
}

impl<'a> Machine<'a> {
    /// Declares all data of the modules.
    pub(super) fn new(source: &'a Source, known: Known<'a>) -> Self {
        let named = |routine: &'a Routine| (routine.name.to_ascii_lowercase(), routine);
        let callable = source.routines.iter().filter(|routine| routine.kind != RoutineKind::Trap);
        let mut machine = Self {
            routines: callable.map(named).collect(),
            globals: BTreeMap::new(),
            frames: Vec::new(),
            known,
            demanded: Demanded { linear: true, joint: true },
            steps: 0,
            depth: 0,
            size: 0,
            tools: Vec::new(),
            work_objects: Vec::new(),
            moves: Vec::new(),
            lines: BTreeMap::new(),
            unclear: None,
            ran: BTreeSet::new(),
        };
        machine.register(source);
        // Every controller has them; what they hold is anyone's.
        for name in ["reg1", "reg2", "reg3", "reg4", "reg5"] {
            let variable =
                Variable { name: name.into(), kind: Some(DataKind::Num), value: Value::Unknown, untouched: false };
            machine.globals.insert(name.into(), variable);
        }
        // Data may refer to data that is declared below it.
        for _ in 0..3 {
            machine.size = 0;
            for declaration in &source.data {
                machine.declare(declaration);
            }
        }
        machine
    }

    /// All statements are unreached at first.
    fn register(&mut self, source: &Source) {
        for routine in &source.routines {
            self.lines.entry(routine.at.line).or_insert_with(Line::unreached);
            for block in [&routine.body, &routine.handlers] {
                each(block, &mut |statement| {
                    self.lines.entry(statement.at.line).or_insert_with(Line::unreached);
                });
            }
        }
    }

    /// Data of the modules, as it is now.
    pub(super) fn global(&self, name: &str) -> Option<&Value> {
        self.globals.get(&name.to_ascii_lowercase()).map(|variable| &variable.value)
    }

    /// Executes the procedure; it must be one of the file's.
    pub(super) fn run(&mut self, procedure: &str) {
        if let Some(routine) = self.routines.get(&procedure.to_ascii_lowercase()).copied() {
            self.frames.push(Frame::default());
            self.enter(routine);
            self.frames.pop();
        }
    }

    /// Marks the line of `at`. The worst class that a line ever had stays.
    fn mark(&mut self, at: At, class: Class, what: impl Into<String>) {
        let line = self.lines.entry(at.line).or_insert_with(Line::unreached);
        if class > line.class || (class == line.class && line.what.is_empty()) {
            *line = Line { class, what: what.into() };
        }
        if class == Class::ChangesMotion && self.unclear.is_none() {
            self.unclear = Some((self.moves.len(), at.line));
        }
    }

    /// Counts work; `false` once there was too much.
    fn step(&mut self, at: At, by: usize) -> bool {
        self.steps = self.steps.saturating_add(by);
        let enough = self.steps > MOST_STEPS || self.moves.len() >= MOST_MOVES;
        if enough {
            let what = format!("more than {MOST_STEPS} steps or {MOST_MOVES} moves: the rest is not followed");
            self.mark(at, Class::ChangesMotion, what);
        }
        !enough
    }
}
