//! A program that is read line by line, in languages whose lines are statements.

use std::collections::BTreeMap;

use hairpin::trajectory::program::{Bound, External, Move, Place, Program, ProgramError};

use super::line::{At, Class, Line};
use super::module::{Declared, Found, Module, Part, Procedure};
use super::unmodelled::Unmodelled;

/// Why a move is not to be counted on: what is not modelled, where that is known, and words.
pub(crate) type Doubt = (Option<Unmodelled>, String);

/// What was read so far.
#[derive(Debug, Default)]
pub(crate) struct Reading {
    pub(crate) program: Program,
    pub(crate) header: Vec<String>,
    pub(crate) targets: Vec<Declared>,
    pub(crate) parts: Vec<Part>,
    lines: BTreeMap<usize, Line>,
    unclear: Option<(usize, usize)>,
    mistakes: Vec<Found>,
    refused: Vec<ProgramError>,
}

impl Reading {
    /// What the line means; the worst it ever meant stays.
    pub(crate) fn mark(&mut self, line: usize, class: Class, what: impl Into<String>) {
        self.mark_as(line, class, None, what.into());
    }

    /// The line changes motion in a way that is not followed.
    pub(crate) fn doubt(&mut self, line: usize, (unmodelled, what): Doubt) {
        self.mark_as(line, Class::ChangesMotion, unmodelled, what);
    }

    fn mark_as(&mut self, number: usize, class: Class, unmodelled: Option<Unmodelled>, what: String) {
        let line = self.lines.entry(number).or_insert_with(Line::unreached);
        if class > line.class || (class == line.class && line.what.is_empty()) {
            *line = Line { class, what, unmodelled };
        }
        if class == Class::ChangesMotion && self.unclear.is_none() {
            self.unclear = Some((self.program.moves.len(), number));
        }
    }

    /// Holds a number that no move carries against what controllers take, where it is certain that they come to it.
    pub(crate) fn hold(&mut self, line: usize, field: &'static str, value: f64, bound: Bound) {
        if self.unclear.is_none() {
            let at = Place { index: self.program.moves.len(), line: Some(line), name: None };
            self.refused.extend(bound.refuse(at, field, value));
        }
    }

    /// The file ends before the `word` that ends what was read: what was cut off nobody knows.
    pub(crate) fn cut_short(&mut self, text: &str, word: &str) {
        let written = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
        let last = written.last().map_or(1, |(index, _)| index + 1);
        self.mistake(last, format!("the file ends before {word}: it was cut short"));
    }

    /// The line cannot be read: from here on nothing is certain.
    pub(crate) fn mistake(&mut self, line: usize, what: String) {
        self.mistakes.push(Found { at: At { line, column: 1 }, what: what.clone() });
        self.doubt(line, (None, what));
    }

    /// Adds a move; one in doubt is not certain itself.
    pub(crate) fn go(&mut self, line: usize, m: Move, doubts: Vec<Doubt>) {
        if doubts.is_empty() {
            self.mark(line, Class::Understood, "");
        } else {
            let named = doubts.iter().find_map(|(unmodelled, _)| *unmodelled);
            let words: Vec<String> = doubts.into_iter().map(|(_, what)| what).collect();
            self.doubt(line, (named, words.join("; ")));
        }
        self.program.moves.push(Move { line: Some(line), ..m });
    }

    /// All of it, read.
    pub(crate) fn done(self, procedures: Vec<Procedure>) -> Module {
        let (certain, unclear_line) = match self.unclear {
            Some((moves, line)) => (moves, Some(line)),
            None => (self.program.moves.len(), None),
        };
        Module {
            certain,
            unclear_line,
            header: self.header,
            lines: self.lines,
            mistakes: self.mistakes,
            refused: self.refused,
            procedures,
            targets: self.targets,
            parts: self.parts,
            program: self.program,
        }
    }
}

/// The external axes in use, in words.
pub(crate) fn beside(external: &External, names: [&str; 6]) -> Option<Doubt> {
    let axes = external.iter().zip(names);
    let told: Vec<String> = axes.filter_map(|(value, name)| value.map(|value| format!("{name} = {value}"))).collect();
    (!told.is_empty()).then(|| (Some(Unmodelled::ExternalAxes), format!("{} in use", told.join(", "))))
}
