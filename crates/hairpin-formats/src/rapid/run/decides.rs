//! Which data may decide where a program goes and how it moves: all but what it only counts and tells.
//!
//! By names alone, wherever they are declared: data of one name decide if any of them does. A name decides that stands
//! in a condition, an index, a move or what is handed over, and what is assigned to one that decides.

use std::collections::{BTreeMap, BTreeSet};

use crate::rapid::instructions::{self, Effect};
use crate::rapid::syntax::{Argument, Expression, Path, Source, Statement, Step, What, each};

/// Names, in lower case, of what may decide anything.
pub(super) fn deciding(source: &Source) -> BTreeSet<String> {
    let mut read = Read::default();
    for declared in source.data.iter().chain(source.routines.iter().flat_map(|routine| &routine.data)) {
        let into = Some(declared.name.to_ascii_lowercase());
        declared.value.iter().for_each(|value| read.expression(value, into.as_deref()));
        declared.extents.iter().for_each(|extent| read.expression(extent, None));
    }
    let own = |name: &str| source.routines.iter().any(|routine| routine.name.eq_ignore_ascii_case(name));
    for routine in &source.routines {
        each(&routine.body, &mut |statement| read.statement(statement, &own));
        for handler in &routine.handlers {
            each(&handler.body, &mut |statement| read.statement(statement, &own));
        }
    }
    read.closed()
}

#[derive(Default)]
struct Read {
    decide: BTreeSet<String>,
    /// Of each name those that its value is made of.
    made_of: BTreeMap<String, BTreeSet<String>>,
}

impl Read {
    fn statement(&mut self, statement: &Statement, own: &dyn Fn(&str) -> bool) {
        match &statement.what {
            What::Assign { to, value } => {
                self.indices(to);
                self.expression(value, Some(&to.name.to_ascii_lowercase()));
            }
            What::Call { name, arguments } => {
                let name = name.to_ascii_lowercase();
                match (instructions::effect(&name), arguments.as_slice()) {
                    (Some(Effect::Harmless), _) if !own(&name) => {}
                    // Counts on what it counts.
                    (Some(Effect::Followed), [Argument::Placed(Expression::Path(to)), more @ ..])
                        if !own(&name) && ["incr", "decr", "add", "clear"].contains(&name.as_str()) =>
                    {
                        self.indices(to);
                        self.arguments(more, Some(&to.name.to_ascii_lowercase()));
                    }
                    _ => self.arguments(arguments, None),
                }
            }
            What::LateCall { name, arguments } => {
                self.expression(name, None);
                self.arguments(arguments, None);
            }
            What::If { branches, .. } => branches.iter().for_each(|(condition, _)| self.expression(condition, None)),
            What::While { condition, .. } => self.expression(condition, None),
            What::For { bounds, step, .. } => bounds.iter().chain(step).for_each(|bound| self.expression(bound, None)),
            What::Test { of, cases, .. } => {
                let values = cases.iter().flat_map(|(values, _)| values);
                std::iter::once(of).chain(values).for_each(|value| self.expression(value, None));
            }
            What::Return(value) => value.iter().for_each(|value| self.expression(value, None)),
            What::Exit | What::Label | What::Goto(_) | What::Connect(_) | What::Harmless(_) | What::Broken(_) => {}
        }
    }

    fn arguments(&mut self, arguments: &[Argument], into: Option<&str>) {
        for argument in arguments {
            match argument {
                Argument::Placed(value)
                | Argument::Named { value: Some(value), .. }
                | Argument::IfGiven { parameter: value, .. } => self.expression(value, into),
                Argument::Named { value: None, .. } => {}
            }
        }
    }

    /// What goes `into` a name decides if that does; else it does.
    fn expression(&mut self, expression: &Expression, into: Option<&str>) {
        match expression {
            Expression::Number(_) | Expression::Bool(_) | Expression::Text(_) => {}
            Expression::Aggregate(parts) => parts.iter().for_each(|part| self.expression(part, into)),
            Expression::Path(path) => {
                let name = path.name.to_ascii_lowercase();
                match into {
                    Some(into) => self.made_of.entry(into.to_owned()).or_default().insert(name),
                    None => self.decide.insert(name),
                };
                self.indices(path);
            }
            // What a function of the file does with them is not followed here.
            Expression::Call { arguments, .. } => self.arguments(arguments, None),
            Expression::Unary { of, .. } => self.expression(of, into),
            Expression::Chain { first, rest } => {
                self.expression(first, into);
                rest.iter().for_each(|(_, part)| self.expression(part, into));
            }
        }
    }

    fn indices(&mut self, path: &Path) {
        for step in &path.steps {
            if let Step::Element(indices) = step {
                indices.iter().for_each(|index| self.expression(index, None));
            }
        }
    }

    /// With all that those are made of that decide.
    fn closed(mut self) -> BTreeSet<String> {
        let mut left: Vec<String> = self.decide.iter().cloned().collect();
        while let Some(name) = left.pop() {
            for part in self.made_of.remove(&name).into_iter().flatten() {
                if self.decide.insert(part.clone()) {
                    left.push(part);
                }
            }
        }
        self.decide
    }
}
