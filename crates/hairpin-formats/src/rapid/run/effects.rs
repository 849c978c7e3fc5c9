//! What statements might do, without executing them.

use std::collections::BTreeSet;

use super::{DEEPEST, Machine};
use crate::listing::At;
use crate::rapid::instructions::{self, Effect};
use crate::rapid::outputs;
use crate::rapid::syntax::{Argument, Expression, Path, Routine, Statement, What};
use crate::rapid::walk::inner;

/// What a block might do.
#[derive(Debug, Default)]
pub(super) struct Effects {
    /// It may move the arm or change how it moves.
    pub(super) moves: bool,
    /// It may end a routine or the program.
    pub(super) leaves: bool,
    /// What it may assign to, each with the module that says so.
    pub(super) assigned: BTreeSet<(usize, String)>,
    /// Where the routines stand that were looked at.
    seen: BTreeSet<At>,
    /// How many of them call each other just now.
    depth: usize,
}

/// Variables handed over as they are.
pub(super) fn paths(arguments: &[Argument]) -> impl Iterator<Item = &Path> {
    arguments.iter().filter_map(path)
}

fn path(argument: &Argument) -> Option<&Path> {
    match argument.value()? {
        Expression::Path(path) => Some(path),
        _ => None,
    }
}

/// Those of them that are outputs wherever ABB's instructions and functions have them.
pub(super) fn outputs(arguments: &[Argument]) -> impl Iterator<Item = &Path> {
    let is_output = |argument: &&Argument| match argument {
        Argument::Named { name, .. } | Argument::IfGiven { name, .. } => outputs::is_output(name),
        Argument::Placed(_) => false,
    };
    arguments.iter().filter(is_output).filter_map(path)
}

/// What a function of ABB's (lower case) may write into; one that is not known to read may write into whatever it gets.
pub(super) fn written<'b>(function: &str, arguments: &'b [Argument]) -> Vec<&'b Path> {
    if outputs::only_reads(function) { outputs(arguments).collect() } else { paths(arguments).collect() }
}

impl Machine<'_> {
    /// What the routine might do, whenever it is executed.
    pub(super) fn effects_of(&mut self, routine: &Routine) -> Effects {
        self.looked_at.insert(routine.at);
        let here = std::mem::replace(&mut self.module, routine.home.module);
        let effects = self.effects(&[&routine.body], &[]);
        self.module = here;
        effects
    }

    /// What any of the blocks might do, and evaluating any of the values, with all that they call.
    pub(super) fn effects(&mut self, blocks: &[&[Statement]], values: &[&Expression]) -> Effects {
        let mut effects = Effects::default();
        for value in values {
            self.in_expression(value, &mut effects);
        }
        for block in blocks {
            self.collect(block, &mut effects);
        }
        self.looked_at.extend(&effects.seen);
        effects
    }

    /// Whether a statement by itself, without the blocks within, may move the arm or change how it moves.
    pub(super) fn may_move(&mut self, statement: &Statement) -> bool {
        let mut effects = Effects::default();
        self.in_statement(statement, &mut effects);
        effects.moves
    }

    fn collect(&mut self, block: &[Statement], effects: &mut Effects) {
        // Looking is work as well, or loops around unknown conditions would not end.
        self.steps = self.steps.saturating_add(block.len());
        for statement in block {
            self.in_statement(statement, effects);
            for block in inner(statement) {
                self.collect(block, effects);
            }
        }
    }

    fn in_statement(&mut self, statement: &Statement, effects: &mut Effects) {
        match &statement.what {
            What::Assign { to, .. } => {
                effects.assigned.insert((self.module, to.name.clone()));
                to.indices().for_each(|index| self.in_expression(index, effects));
            }
            What::Call { name, arguments } => self.in_call(name, arguments, effects),
            What::LateCall { .. } | What::Broken(_) => effects.moves = true,
            What::Return(_) | What::Exit | What::Goto(_) => effects.leaves = true,
            _ => {}
        }
        for value in statement.values() {
            self.in_expression(value, effects);
        }
    }

    fn in_call(&mut self, name: &str, arguments: &[Argument], effects: &mut Effects) {
        arguments.iter().filter_map(Argument::value).for_each(|value| self.in_expression(value, effects));
        let lower = name.to_ascii_lowercase();
        let module = self.module;
        let given = || paths(arguments).map(|path| (module, path.name.clone()));
        if let Some(routine) = self.routine(&lower) {
            if routine.parameters.iter().any(|parameter| parameter.returned) {
                effects.assigned.extend(given());
            }
            if effects.depth >= DEEPEST {
                // Too far to look: anything may happen there.
                effects.moves = true;
                return;
            }
            if effects.seen.insert(routine.at) {
                let leaves = effects.leaves;
                effects.depth += 1;
                self.module = routine.home.module;
                self.collect(&routine.body, effects);
                self.module = module;
                effects.depth -= 1;
                // Its RETURN ends only itself.
                effects.leaves = leaves || ends(&routine.body);
            }
            return;
        }
        match instructions::effect(&lower) {
            Some(Effect::Harmless) => {
                effects.assigned.extend(outputs(arguments).map(|path| (module, path.name.clone())));
            }
            Some(Effect::Writes) => effects.assigned.extend(given()),
            Some(Effect::Followed) if ["incr", "decr", "add", "clear"].contains(&lower.as_str()) => {
                effects.assigned.extend(given());
            }
            Some(Effect::Followed) if self.changes_no_load(&lower, arguments) => {}
            Some(Effect::Move(_) | Effect::Followed | Effect::Changes(_)) | None => effects.moves = true,
        }
    }

    /// Whether the modules have nothing under that name that could be written into.
    fn is_fixed(&self, name: &str) -> bool {
        let data = self.globals.get(self.module, &name.to_ascii_lowercase());
        data.is_some_and(|variable| variable.fixed.is_some())
    }

    /// Functions of the file may do what procedures do.
    fn in_expression(&mut self, expression: &Expression, effects: &mut Effects) {
        if let Expression::Call { name, arguments } = expression {
            let lower = name.to_ascii_lowercase();
            if self.routine(&lower).is_some() {
                return self.in_call(name, arguments, effects);
            }
            let written = written(&lower, arguments).into_iter().filter(|path| !self.is_fixed(&path.name));
            effects.assigned.extend(written.map(|path| (self.module, path.name.clone())));
        }
        expression.parts().into_iter().for_each(|part| self.in_expression(part, effects));
    }
}

/// Whether a routine may end the program.
pub(super) fn ends(block: &[Statement]) -> bool {
    block
        .iter()
        .any(|statement| matches!(statement.what, What::Exit | What::Goto(_)) || inner(statement).into_iter().any(ends))
}
