//! Which data may decide where a program goes and how it moves: all but what it only counts and tells.
//!
//! By names alone, wherever they are declared: data of one name decide if any of them does. A name decides that stands
//! in a condition, an index, a move or what is handed over, and what is assigned to one that decides.

use std::collections::{BTreeMap, BTreeSet};

use crate::rapid::instructions::{self, Effect};
use crate::rapid::syntax::{Argument, Expression, Path, Source, Statement, What};
use crate::rapid::walk::each;

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
        let mut into = None;
        match &statement.what {
            What::Assign { to, .. } => into = Some(self.written(to)),
            What::Call { name, arguments } => self.call(&name.to_ascii_lowercase(), arguments, own),
            What::LateCall { arguments, .. } => self.arguments(arguments, None),
            _ => {}
        }
        for value in statement.values() {
            self.expression(value, into.as_deref());
        }
    }

    fn call(&mut self, name: &str, arguments: &[Argument], own: &dyn Fn(&str) -> bool) {
        match (instructions::effect(name), arguments) {
            (Some(Effect::Harmless), _) if !own(name) => {}
            // Counts on what it counts.
            (Some(Effect::Followed), [Argument::Placed(Expression::Path(to)), more @ ..])
                if !own(name) && ["incr", "decr", "add", "clear"].contains(&name) =>
            {
                let to = self.written(to);
                self.arguments(more, Some(&to));
            }
            _ => self.arguments(arguments, None),
        }
    }

    /// The name of what is written into, of which the indices decide.
    fn written(&mut self, to: &Path) -> String {
        to.indices().for_each(|index| self.expression(index, None));
        to.name.to_ascii_lowercase()
    }

    fn arguments(&mut self, arguments: &[Argument], into: Option<&str>) {
        arguments.iter().filter_map(Argument::value).for_each(|value| self.expression(value, into));
    }

    /// What goes `into` a name decides if that does; else it does.
    fn expression(&mut self, expression: &Expression, into: Option<&str>) {
        let parts_into = match expression {
            Expression::Path(path) => {
                let name = path.name.to_ascii_lowercase();
                match into {
                    Some(into) => self.made_of.entry(into.to_owned()).or_default().insert(name),
                    None => self.decide.insert(name),
                };
                None
            }
            // What a function of the file does with them is not followed here.
            Expression::Call { .. } => None,
            _ => into,
        };
        expression.parts().into_iter().for_each(|part| self.expression(part, parts_into));
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
