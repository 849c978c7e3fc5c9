//! Executes a module without its cell: what depends on the cell is unknown, and where it would change motion, that is
//! told.

mod calls;
mod decides;
mod effects;
mod expressions;
mod follow;
mod frames;
mod handlers;
mod load;
mod motion;
mod round;
mod scope;
mod statements;
mod variables;

use std::cell::OnceCell;
use std::collections::{BTreeMap, BTreeSet};

use hairpin::trajectory::program::{Move, Tool, WorkObject};

use self::scope::Scope;
use super::kinds::DataKind;
use super::syntax::{Declaration, Home, Routine, RoutineKind, Source};
use super::value::{Value, Variable};
use super::walk::each;
use crate::listing::{At, Class, Line, Unmodelled};

/// Statements and values at most; a program that takes more is told to be endless.
const MOST_STEPS: usize = 1_000_000;
/// Moves at most.
const MOST_MOVES: usize = 100_000;
/// Routines that call each other, blocks in blocks and values in values, this deep at most.
const DEEPEST: usize = 250;

/// What execution gave.
pub(super) struct Machine<'a> {
    routines: Scope<&'a Routine>,
    traps: Scope<&'a Routine>,
    globals: Scope<Variable>,
    /// Where names are declared that the program declares more than once: no controller loads that.
    twice: BTreeSet<At>,
    frames: Vec<Frame>,
    /// The module of what is executed just now.
    module: usize,
    known: Known<'a>,
    /// State of ConfL and ConfJ.
    demanded: Demanded,
    /// Which of them a cycle has said itself, and which it found said when it moved.
    said: Demanded,
    found: Demanded,
    /// Whether GripLoad named another load than load0.
    gripped: bool,
    /// Whether SoftAct came before.
    soft: bool,
    /// Names, in lower case, of the tools that moves have used.
    carried: BTreeSet<String>,
    source: &'a Source,
    /// Names, in lower case, of what may decide anything, once a loop asks.
    deciding: OnceCell<BTreeSet<String>>,
    steps: usize,
    /// Values that were held beside others, to see whether a loop comes to an end.
    held: usize,
    depth: usize,
    /// How many conditions are decided whatever the operand comes to that is evaluated just now.
    decided: usize,
    /// Data that is declared, in values.
    size: usize,
    pub(super) tools: Vec<Tool>,
    pub(super) work_objects: Vec<WorkObject>,
    pub(super) moves: Vec<Move>,
    pub(super) lines: BTreeMap<usize, Line>,
    /// How many moves come before the first line that changes motion and is not understood, and that line.
    pub(super) unclear: Option<(usize, usize)>,
    /// Where the routines stand that were executed.
    pub(super) ran: BTreeSet<At>,
    /// Where those stand that were looked at, as they may be executed.
    looked_at: BTreeSet<At>,
}

/// What the controller has beside the file.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Known<'a> {
    pub(super) tools: &'a [Tool],
    pub(super) work_objects: &'a [WorkObject],
}

#[derive(Clone, Copy, PartialEq, Default)]
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
        let count = source.modules.len();
        let mut machine = Self {
            routines: Scope::new(count),
            traps: Scope::new(count),
            globals: Scope::new(count),
            twice: declared_twice(source),
            frames: Vec::new(),
            module: 0,
            known,
            demanded: Demanded { linear: true, joint: true },
            said: Demanded::default(),
            found: Demanded::default(),
            gripped: false,
            soft: false,
            carried: BTreeSet::new(),
            source,
            deciding: OnceCell::new(),
            steps: 0,
            held: 0,
            depth: 0,
            decided: 0,
            size: 0,
            tools: Vec::new(),
            work_objects: Vec::new(),
            moves: Vec::new(),
            lines: BTreeMap::new(),
            unclear: None,
            ran: BTreeSet::new(),
            looked_at: BTreeSet::new(),
        };
        for routine in &source.routines {
            let trap = routine.kind == RoutineKind::Trap;
            let scope = if trap { &mut machine.traps } else { &mut machine.routines };
            scope.insert(routine.home, routine.name.to_ascii_lowercase(), routine);
        }
        machine.register(source);
        // Every controller has them; what they hold is anyone's.
        for name in ["reg1", "reg2", "reg3", "reg4", "reg5"] {
            let variable = Variable::unknown(name, Some(DataKind::Num));
            machine.globals.insert(Home::default(), name.into(), variable);
        }
        // Data may refer to data that is declared below it.
        for _ in 0..3 {
            machine.size = 0;
            for declaration in &source.data {
                machine.module = declaration.home.module;
                machine.declare(declaration);
            }
        }
        machine
    }

    /// All statements are unreached at first.
    fn register(&mut self, source: &Source) {
        for routine in &source.routines {
            self.lines.entry(routine.at.line).or_insert_with(Line::unreached);
            for block in routine.handlers.iter().map(|handler| &handler.body).chain([&routine.body]) {
                each(block, &mut |statement| {
                    self.lines.entry(statement.at.line).or_insert_with(Line::unreached);
                });
            }
        }
    }

    /// Data of the modules, as it is now.
    pub(super) fn global(&self, declaration: &Declaration) -> Option<&Value> {
        let name = declaration.name.to_ascii_lowercase();
        self.globals.get(declaration.home.module, &name).map(|variable| &variable.value)
    }

    /// Executes the procedure. Controllers begin `main` again where it ends, with the data of its modules as they are
    /// then: its cycles are followed as rounds of a loop without end are ([`round`]). Behind what is not certain, no
    /// further cycle is either.
    pub(super) fn run(&mut self, procedure: &'a Routine) {
        if self.is_twice(procedure) {
            return self.mark(procedure.at, Class::ChangesMotion, twice(&procedure.name));
        }
        let begins_again = procedure.name.eq_ignore_ascii_case("main");
        let (mut begun, mut before) = (None, Vec::new());
        for cycle in 1.. {
            if begins_again {
                self.begins_cycle(cycle, &mut begun);
                before.push(self.moves.len());
            }
            self.module = procedure.home.module;
            self.frames.push(Frame::default());
            let flow = self.enter(procedure);
            let frame = self.frames.pop().unwrap_or_default();
            self.size -= frame.size.min(self.size);
            let goes_on = begins_again && !matches!(flow, Flow::End) && self.unclear.is_none();
            if !goes_on || !self.step(procedure.at, 1) {
                return;
            }
            if self.begins_as(begun.as_mut()) {
                self.tell_once(begun.as_ref(), &before);
                if cycle > 1 {
                    let what = format!(
                        "begins again where it ends: {cycle} cycles are followed, all further ones are as before"
                    );
                    self.mark(procedure.at, Class::Understood, what);
                }
                return;
            }
        }
    }

    /// What the text leaves open at `at`: nothing behind what was executed is certain.
    pub(super) fn leave_open(&mut self, at: At, what: &str) {
        self.mark(at, Class::ChangesMotion, what);
    }

    /// The routine that the name (lower case) means here.
    fn routine(&self, name: &str) -> Option<&'a Routine> {
        self.routines.get(self.module, name).copied()
    }

    fn is_twice(&self, routine: &Routine) -> bool {
        self.twice.contains(&routine.at)
    }

    /// Marks the line of `at`. The worst class that a line ever had stays.
    fn mark(&mut self, at: At, class: Class, what: impl Into<String>) {
        self.mark_as(at, class, what, None);
    }

    /// Marks the line of `at` as one whose motion is known and not modelled.
    fn mark_unmodelled(&mut self, at: At, unmodelled: Unmodelled, what: impl Into<String>) {
        self.mark_as(at, Class::ChangesMotion, what, Some(unmodelled));
    }

    fn mark_as(&mut self, at: At, class: Class, what: impl Into<String>, unmodelled: Option<Unmodelled>) {
        let line = self.lines.entry(at.line).or_insert_with(Line::unreached);
        if class > line.class || (class == line.class && line.what.is_empty()) {
            *line = Line { class, what: what.into(), unmodelled };
        }
        if class == Class::ChangesMotion && self.unclear.is_none() {
            self.unclear = Some((self.moves.len(), at.line));
        }
    }

    /// Counts work; `false` once there was too much.
    fn step(&mut self, at: At, by: usize) -> bool {
        self.steps = self.steps.saturating_add(by);
        let most = match self.steps > MOST_STEPS {
            true => format!("{MOST_STEPS} steps"),
            false if self.moves.len() >= MOST_MOVES => format!("{MOST_MOVES} moves"),
            false => return true,
        };
        self.mark(at, Class::ChangesMotion, format!("more than {most} until here: the rest is not followed"));
        false
    }
}

/// Where names stand that are declared more than once for all modules, or within one.
fn declared_twice(source: &Source) -> BTreeSet<At> {
    let mut all: BTreeMap<(Option<usize>, String), Vec<At>> = BTreeMap::new();
    let data = source.data.iter().map(|data| (data.home, &data.name, data.at));
    let routines = source.routines.iter().map(|routine| (routine.home, &routine.name, routine.at));
    for (home, name, at) in data.chain(routines) {
        let of = home.local.then_some(home.module);
        all.entry((of, name.to_ascii_lowercase())).or_default().push(at);
    }
    all.into_values().filter(|places| places.len() > 1).flatten().collect()
}

/// Why a name cannot be followed.
fn twice(name: &str) -> String {
    format!("`{name}` {TWICE}")
}

const TWICE: &str = "is declared more than once: no controller loads that";
