//! Programs read from URScript: what the file calls, statement by statement.

use std::collections::{BTreeMap, BTreeSet};

use hairpin::trajectory::program::{Tool, WorkObject};
use thiserror::Error;

use super::CONVENTIONS;
use super::blocks::{Blocks, Part as Line, call};
use super::names::{HARMLESS, is_quiet, not_followed};
use crate::banner::NOTICE;
use crate::listing::{Class, File, Module, Part, Procedure, Reading, calls, decode};

/// Functions within functions at most.
const MOST_DEPTH: usize = 250;
/// Statements at most.
const MOST_STEPS: usize = 1_000_000;
/// Moves at most.
const MOST_MOVES: usize = 100_000;

/// Why a file is no program.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum NoProgram {
    /// No `def name():` anywhere.
    #[error("no URScript program in it: no line says def and a name")]
    Absent,
}

/// Reads a program: the functions that the file calls, as often as they are called; where it calls none, the first that
/// it defines.
///
/// Bounds: 250 functions within each other, 10⁶ statements, 10⁵ moves.
///
/// # Errors
/// [`NoProgram`]; all else that is not followed is told by line, and the moves before it are certain.
pub fn read(file: File<'_>) -> Result<Module, NoProgram> {
    let text = decode(file.bytes);
    let blocks = Blocks::of(&text);
    if blocks.functions.is_empty() {
        return Err(NoProgram::Absent);
    }
    let mut reader = Reader::of(&blocks);
    reader.reading.parts.push(Part { name: file.name.into(), first_line: 1 });
    reader.reading.program.work_objects.push(WorkObject::base());
    blocks.head.iter().for_each(|line| reader.head(line));
    for (line, what) in &blocks.mistakes {
        reader.reading.mistake(*line, what.clone());
    }
    let main = reader.run_all();
    if blocks.is_cut {
        reader.reading.cut_short(&text, "end");
    }
    reader.leave_out();
    let name = &blocks.functions[main].name;
    reader.reading.program.name.clone_from(name);
    reader.reading.program.procedure.clone_from(name);
    let executed = reader.executed.iter().chain([&main]).collect::<BTreeSet<_>>().into_iter();
    let procedures = executed.map(|index| {
        let function = &blocks.functions[*index];
        Procedure { name: function.name.clone(), line: function.line, executed: true }
    });
    let procedures = procedures.collect();
    Ok(reader.reading.done(procedures))
}

#[derive(Debug)]
pub(super) struct Reader<'b> {
    pub(super) reading: Reading,
    /// The tool that is set.
    pub(super) carried: Option<Tool>,
    /// Its index, where a move had it.
    pub(super) tool: Option<usize>,
    /// Whether the line before set it: what it weighs may follow.
    pub(super) fresh: bool,
    blocks: &'b Blocks,
    /// Functions by what they are defined in and by name: the first, and whether it is the only one.
    known: BTreeMap<Option<usize>, BTreeMap<&'b str, (usize, bool)>>,
    /// Functions whose definition was passed.
    declared: BTreeSet<usize>,
    executed: BTreeSet<usize>,
    depth: usize,
    steps: usize,
    /// Whether a bound was passed: nothing is followed any more.
    ended: bool,
}

impl<'b> Reader<'b> {
    fn of(blocks: &'b Blocks) -> Self {
        let mut known: BTreeMap<_, BTreeMap<&str, (usize, bool)>> = BTreeMap::new();
        for (index, function) in blocks.functions.iter().enumerate() {
            let there = known.entry(function.within).or_default();
            there.entry(&function.name).and_modify(|(_, is_one)| *is_one = false).or_insert((index, true));
        }
        Self {
            reading: Reading::default(),
            carried: None,
            tool: None,
            fresh: false,
            blocks,
            known,
            declared: BTreeSet::new(),
            executed: BTreeSet::new(),
            depth: 0,
            steps: 0,
            ended: false,
        }
    }

    fn head(&mut self, line: &str) {
        let comment = line.trim_start_matches('#');
        let comment = comment.strip_prefix(' ').unwrap_or(comment).trim_end();
        if comment != NOTICE && !CONVENTIONS.contains(&comment) {
            self.reading.header.push(comment.into());
        }
    }

    /// Follows what stands in no function, or the first function where nothing is called there: the function that the
    /// program is called by.
    fn run_all(&mut self) -> usize {
        let blocks = self.blocks;
        let mut main = None;
        for part in &blocks.top {
            match part {
                _ if self.ended => break,
                Line::Function(index) => {
                    self.declared.insert(*index);
                }
                Line::Statement { line, inside: true, .. } => {
                    self.reading.mark(*line, Class::Unreached, "in a block that is not followed");
                }
                Line::Statement { line, text, .. } => match call(text).and_then(|(name, _)| self.find(name, None)) {
                    Some((found, _)) => {
                        main = main.or(Some(found));
                        self.statement(*line, text, None);
                    }
                    // What is set here is set for whom nobody knows.
                    None => self.reading.doubt(*line, not_followed(text)),
                },
            }
        }
        main.unwrap_or_else(|| {
            self.executed.insert(0);
            self.run(&blocks.functions[0].body, Some(0));
            let other = blocks.functions.iter().skip(1).find(|function| function.within.is_none());
            if let Some(other) = other {
                let what = format!("nothing says whether `{}` is called", other.name.escape_default());
                self.reading.doubt(other.line, (None, what));
            }
            0
        })
    }

    /// The function that `name` is in the function `of`, and whether it is the only one there.
    fn find(&self, name: &str, of: Option<usize>) -> Option<(usize, bool)> {
        let mut scope = of;
        loop {
            let found = self.known.get(&scope).and_then(|there| there.get(name));
            if found.is_some() || scope.is_none() {
                return found.copied();
            }
            scope = scope.and_then(|index| self.blocks.functions[index].within);
        }
    }

    fn run(&mut self, body: &'b [Line], of: Option<usize>) {
        for part in body {
            match part {
                _ if self.ended => return,
                Line::Function(index) => {
                    self.declared.insert(*index);
                }
                Line::Statement { line, text, .. } => self.statement(*line, text, of),
            }
        }
    }

    fn statement(&mut self, line: usize, statement: &str, of: Option<usize>) {
        let fresh = std::mem::take(&mut self.fresh);
        self.steps += 1;
        if self.steps > MOST_STEPS || self.reading.program.moves.len() >= MOST_MOVES {
            return self.end(line, format!("more than {MOST_STEPS} statements or {MOST_MOVES} moves"));
        }
        let Some((name, inside)) = call(statement) else { return self.reading.doubt(line, not_followed(statement)) };
        let is_followed = |within: &&str| !is_quiet(within) || self.find(within, of).is_some();
        if let Some(within) = calls(inside).into_iter().find(is_followed) {
            return self.reading.doubt(line, not_followed(within));
        }
        if let Some((index, is_one)) = self.find(name, of) {
            return self.call(line, index, is_one, inside);
        }
        let done = match name {
            "set_tcp" => self.set_tcp(line, inside),
            "set_target_payload" if fresh => self.weigh(line, inside),
            "movej" | "movel" | "movec" => self.go(line, name, inside),
            _ if HARMLESS.contains(&name) => {
                self.reading.mark(line, Class::Harmless, "");
                Ok(())
            }
            _ => {
                self.reading.doubt(line, not_followed(statement));
                Ok(())
            }
        };
        if let Err(what) = done {
            self.reading.mistake(line, format!("{name}: {what}"));
        }
    }

    /// Follows a function of the file's own.
    fn call(&mut self, line: usize, index: usize, is_one: bool, inside: &str) {
        let blocks = self.blocks;
        let function = &blocks.functions[index];
        let name = function.name.escape_default();
        let why = match () {
            () if !is_one => Some(format!("`{name}` is defined twice")),
            () if !self.declared.contains(&index) => Some(format!("`{name}` is called before it is defined")),
            () if function.takes || !inside.trim().is_empty() => {
                Some(format!("`{name}` is not followed: it has arguments"))
            }
            () if self.depth >= MOST_DEPTH => {
                return self.end(line, format!("`{name}` is called in more than {MOST_DEPTH} others"));
            }
            () => None,
        };
        if let Some(why) = why {
            return self.reading.doubt(line, (None, why));
        }
        self.reading.mark(line, Class::Understood, "");
        self.executed.insert(index);
        self.depth += 1;
        self.run(&function.body, Some(index));
        self.depth -= 1;
    }

    /// Nothing is followed from here on.
    fn end(&mut self, line: usize, what: String) {
        self.ended = true;
        self.reading.doubt(line, (None, what));
    }

    /// Marks the lines of functions that nothing called.
    fn leave_out(&mut self) {
        for (index, function) in self.blocks.functions.iter().enumerate() {
            if self.executed.contains(&index) {
                continue;
            }
            for part in &function.body {
                if let Line::Statement { line, .. } = part {
                    self.reading.mark(*line, Class::Unreached, "another function");
                }
            }
        }
    }
}
