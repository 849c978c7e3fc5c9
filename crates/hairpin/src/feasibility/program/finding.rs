//! A move of a program that an arm cannot execute, and the sentence that says so.

use crate::feasibility::reachability::Refusal;

/// What came of a program.
///
/// `followed` + `ends_only` is the number of moves looked at; a program is executable if `findings` is empty and all
/// moves were followed.
///
/// Nothing is executed: a program that passes is one that the arm can follow in its cell, blends aside.
#[derive(Debug, Clone, PartialEq)]
pub struct Checked {
    /// Moves that were looked at as a whole.
    pub followed: usize,
    /// Moves of which only the end was looked at, since where they begin is not known.
    pub ends_only: usize,
    /// What the arm cannot do, and what is not found out, in the program's order.
    pub findings: Vec<Finding>,
}

/// Another configuration in which the move fits.
///
/// \[cf1, cf4, cf6, cfx\].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fit {
    /// At the move's end.
    pub configuration: [i32; 4],
    /// Least distance of any axis from its bounds, rad.
    pub margin: f64,
}

/// A move that the arm cannot execute.
///
/// `line` is that of the program's own text, where it came from one.
#[derive(Debug, Clone, PartialEq)]
pub struct Finding {
    /// Index of the move.
    pub index: usize,
    /// Line of the file, from 1.
    pub line: Option<usize>,
    /// Name of where the move begins.
    pub from: Option<String>,
    /// Name of its end.
    pub to: Option<String>,
    /// Why.
    pub refusal: Refusal,
    /// The configuration that was tried.
    pub tried: Option<[i32; 4]>,
    /// A configuration that would do.
    pub fit: Option<Fit>,
    /// What it rests on that is estimated, in words.
    pub estimated: Option<String>,
    /// Whether it rests on nothing but what is estimated or assumed, or on a posture that was not found, so that it is
    /// no finding but not found out.
    pub open: bool,
}

impl Finding {
    /// The reason and what would help, without line and names; `parts` are the names of the cell's.
    pub fn reason(&self, parts: &[String]) -> String {
        let estimated = self.estimated.as_ref().map_or(String::new(), |words| format!(" ({words})"));
        let why = format!("{}{estimated}", self.refusal.in_words(parts));
        let Some(fit) = self.fit else { return why };
        let names = ["cf1", "cf4", "cf6", "cfx"];
        let other = |index: &usize| self.tried.is_none_or(|tried| tried[*index] != fit.configuration[*index]);
        let change = |index: usize| format!("{} = {}", names[index], fit.configuration[index]).replace('-', "−");
        let changes: Vec<_> = (0..4).filter(other).map(change).collect();
        let with = if changes.is_empty() {
            "on another turn of an axis".into()
        } else {
            format!("with {}", changes.join(", "))
        };
        format!("{why}; {with} it fits by {:.1}°", fit.margin.to_degrees())
    }

    /// `line 8: UNREACHABLE p10→p20: …`, of what meets something `line 8: COLLISION …`, of what rests on estimates
    /// alone, or on a posture that is assumed, `line 8: INCONCLUSIVE …`.
    pub fn in_words(&self, parts: &[String]) -> String {
        let line = self.line.map_or(String::new(), |line| format!("line {line}: "));
        let named = |name: &Option<String>, nameless: &str| name.clone().unwrap_or_else(|| nameless.into());
        let (from, to) = (named(&self.from, "(before)"), named(&self.to, "(in place)"));
        let word = match self.refusal.kind() {
            _ if self.open => "INCONCLUSIVE",
            "collision" => "COLLISION",
            "duration" => "NOT EXECUTABLE",
            _ => "UNREACHABLE",
        };
        format!("{line}{word} {from}→{to}: {}", self.reason(parts))
    }
}
