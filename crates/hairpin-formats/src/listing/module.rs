//! A program's text, read.

use std::collections::BTreeMap;

use hairpin::trajectory::program::{PoseTarget, Program, ProgramError};

use super::line::{At, Class, Line};

/// Something that is not the language as it is known here.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Found {
    /// Where.
    pub at: At,
    /// What.
    pub what: String,
}

/// A procedure of the file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Procedure {
    /// Its name.
    pub name: String,
    /// Its line.
    pub line: usize,
    /// Whether it was executed.
    pub executed: bool,
}

/// A target that the text declares.
#[derive(Debug, Clone, PartialEq)]
pub struct Declared {
    /// Its line.
    pub line: usize,
    /// Its name; of an element of an array with its number: `p_3`.
    pub name: String,
    /// The target, or why it is none.
    pub target: Result<PoseTarget, String>,
}

/// A file that is a program, or a part of one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct File<'a> {
    /// Its name, as it is told.
    pub name: &'a str,
    /// What it holds.
    pub bytes: &'a [u8],
}

/// One of several files that are one program.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Part {
    /// Its name.
    pub name: String,
    /// What its first line counts as.
    pub first_line: usize,
}

/// A program, read.
#[derive(Debug, Clone, PartialEq)]
pub struct Module {
    /// The moves of the procedure, in the order of their execution.
    pub program: Program,
    /// Moves before the first line that changes motion and is not understood; all of them where there is none.
    pub certain: usize,
    /// The line (from 1) up to which moves are certain.
    pub unclear_line: Option<usize>,
    /// Comments at the head, without the notice of written programs.
    pub header: Vec<String>,
    /// Every line that says something, from 1.
    pub lines: BTreeMap<usize, Line>,
    /// What could not be understood.
    pub mistakes: Vec<Found>,
    /// Numbers that no move carries and no controller takes, on the way that is certain; of lines counted through.
    pub refused: Vec<ProgramError>,
    /// All procedures.
    pub procedures: Vec<Procedure>,
    /// All targets that are declared.
    pub targets: Vec<Declared>,
    /// The files, in the order in which their lines are counted through.
    pub parts: Vec<Part>,
}

impl Module {
    /// Lines that change motion and are not understood.
    pub fn unclear(&self) -> impl Iterator<Item = (usize, &Line)> {
        self.lines.iter().filter(|(_, line)| line.class == Class::ChangesMotion).map(|(number, line)| (*number, line))
    }

    /// The class of a line; one that says nothing is harmless.
    pub fn class(&self, line: usize) -> Class {
        self.lines.get(&line).map_or(Class::Harmless, |line| line.class)
    }

    /// The file that a line is of, and which of its lines it is.
    pub fn place(&self, line: usize) -> (Option<&Part>, usize) {
        let part = self.parts.iter().rev().find(|part| part.first_line <= line);
        (part, line - part.map_or(0, |part| part.first_line - 1))
    }

    /// The line in words, with its file's name where there are several.
    pub fn told(&self, line: usize) -> String {
        match self.place(line) {
            (Some(part), line) if self.parts.len() > 1 => format!("{} line {line}", part.name),
            (_, line) => format!("line {line}"),
        }
    }

    /// The program, if all of it is certain.
    ///
    /// # Errors
    /// The first line that is not, or that no controller takes.
    pub fn whole(self) -> Result<Program, String> {
        let unclear = self.unclear_line.map(|line| {
            let why = self.lines.get(&line).map(|line| line.what.as_str()).filter(|what| !what.is_empty());
            format!("{} is not understood: {}", self.told(line), why.unwrap_or("it changes motion"))
        });
        let mistake = self.mistakes.first().map(|found| format!("{}: {}", self.told(found.at.line), found.what));
        let refused = self.refused.first().map(ToString::to_string);
        unclear.or(mistake).or(refused).map_or(Ok(self.program), Err)
    }
}
