//! A row of the table: what is typed, and what of it is promised.

use hairpin_jobs::Problem;

use super::super::row::Target;
use super::line::{Line, Measured};
use super::scratch::Scratch;

/// What of a row's commands is told.
type Tell = Box<dyn Fn(&Seen<'_>) -> Result<Vec<Figure>, Problem>>;

/// A command, or several that are one question.
pub(super) struct Row {
    pub(super) name: String,
    /// What it is, in a few words.
    pub(super) about: String,
    /// Whether it takes more than two minutes: then it is measured by its name alone.
    pub(super) long: bool,
    /// Cores that it needs.
    pub(super) cores: usize,
    /// What its commands read.
    pub(super) inputs: Vec<String>,
    /// Commands whose results it needs; run where what they make is not there, and not counted.
    pub(super) first: Vec<Line>,
    /// What is measured, one after the other.
    pub(super) lines: Vec<Line>,
    pub(super) tell: Tell,
}

impl Row {
    /// Of one core, measured whenever all are; without inputs.
    pub(super) fn new(
        name: impl Into<String>,
        about: impl Into<String>,
        lines: Vec<Line>,
        tell: impl Fn(&Seen<'_>) -> Result<Vec<Figure>, Problem> + 'static,
    ) -> Self {
        let (name, about, tell) = (name.into(), about.into(), Box::new(tell));
        Self { name, about, long: false, cores: 1, inputs: Vec::new(), first: Vec::new(), lines, tell }
    }

    pub(super) fn reading<const N: usize>(self, inputs: [&str; N]) -> Self {
        Self { inputs: inputs.map(str::to_owned).to_vec(), ..self }
    }

    pub(super) fn after(self, first: Line) -> Self {
        Self { first: vec![first], ..self }
    }

    pub(super) fn long(self) -> Self {
        Self { long: true, ..self }
    }
}

/// The commands of a row, run.
pub(super) struct Seen<'a> {
    /// In the order of the row's lines, each the median of its runs.
    pub(super) lines: &'a [Measured],
    pub(super) scratch: &'a Scratch,
}

impl Seen<'_> {
    /// A number that the first command tells, such as `/counts/cases`.
    pub(super) fn told(&self, pointer: &str) -> Result<f64, Problem> {
        let number = self.lines[0].told.pointer(pointer).and_then(serde_json::Value::as_f64);
        number.ok_or_else(|| Problem::input(format!("the command's object has no number at {pointer}")))
    }
}

/// A number that people ask for.
pub(super) struct Figure {
    pub(super) what: &'static str,
    pub(super) unit: &'static str,
    pub(super) value: f64,
    /// What the kernel alone takes, in the same unit.
    pub(super) kernel: Option<f64>,
    pub(super) target: Option<Target>,
}

impl Figure {
    pub(super) fn new(what: &'static str, unit: &'static str, value: f64) -> Self {
        Self { what, unit, value, kernel: None, target: None }
    }

    pub(super) fn at_most(self, bound: f64) -> Self {
        Self { target: Some(Target::AtMost(bound)), ..self }
    }

    pub(super) fn at_least(self, bound: f64) -> Self {
        Self { target: Some(Target::AtLeast(bound)), ..self }
    }

    pub(super) fn beside(self, kernel: f64) -> Self {
        Self { kernel: Some(kernel), ..self }
    }

    /// How many times the kernel's work the command takes.
    pub(super) fn ratio(&self) -> Option<f64> {
        let kernel = self.kernel?;
        // Of rates more is better.
        Some(if self.unit.ends_with("/s") { kernel / self.value } else { self.value / kernel })
    }
}
