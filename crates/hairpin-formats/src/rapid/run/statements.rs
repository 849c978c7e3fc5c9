//! Statements one after the other.

use super::{DEEPEST, Flow, Machine};
use crate::listing::{At, Class, Unmodelled};
use crate::rapid::instructions::{self, Effect};
use crate::rapid::syntax::{Argument, Expression, Statement, What};
use crate::rapid::value::{Value, single};

type Blocks<'b> = Vec<&'b [Statement]>;

impl Machine<'_> {
    pub(super) fn block(&mut self, statements: &[Statement]) -> Flow {
        if self.depth >= DEEPEST {
            if let Some(first) = statements.first() {
                self.mark(first.at, Class::ChangesMotion, format!("nested more than {DEEPEST} deep"));
            }
            return Flow::End;
        }
        self.depth += 1;
        let mut flow = Flow::Next;
        for statement in statements {
            if !self.step(statement.at, 1) {
                flow = Flow::End;
            } else {
                flow = self.statement(statement);
            }
            if !matches!(flow, Flow::Next) {
                break;
            }
        }
        self.depth -= 1;
        flow
    }

    fn statement(&mut self, statement: &Statement) -> Flow {
        let at = statement.at;
        match &statement.what {
            What::Assign { to, value } => {
                let value = self.evaluate(value, at);
                match self.assign(to, value, at) {
                    Ok(()) => self.mark(at, Class::Understood, ""),
                    // No controller loads, or goes on with, what cannot be assigned.
                    Err(what) => self.mark(at, Class::ChangesMotion, what),
                }
            }
            What::Call { name, arguments } => return self.instruction(name, arguments, at),
            What::LateCall { name, arguments } => return self.late(name, arguments, at),
            What::If { branches, otherwise } => return self.branches(branches, otherwise, at),
            What::While { condition, body } => return self.repeat(condition, body, at),
            What::For { variable, bounds, step, body } => {
                return self.count(variable, &[&bounds[0], &bounds[1]], step.as_ref(), body, at);
            }
            What::Test { of, cases, otherwise } => return self.test(of, cases, otherwise, at),
            What::Return(value) => {
                let value = value.as_ref().map(|value| self.evaluate(value, at));
                self.mark(at, Class::Understood, "");
                return Flow::Return(value);
            }
            What::Exit => {
                self.mark(at, Class::Understood, "ends the program");
                return Flow::End;
            }
            What::Label => self.mark(at, Class::Harmless, ""),
            What::Goto(label) => {
                self.mark(at, Class::ChangesMotion, format!("GOTO {label} is not followed"));
                return Flow::End;
            }
            What::Connect(trap) => self.connect(trap, at),
            What::Harmless("RAISE") => {
                self.mark(at, Class::ChangesMotion, "RAISE goes on in an error handler, and none is followed");
            }
            What::Harmless(keyword) => self.mark(at, Class::Harmless, *keyword),
            What::Broken(what) => self.mark(at, Class::ChangesMotion, what.clone()),
        }
        Flow::Next
    }

    fn instruction(&mut self, name: &str, arguments: &[Argument], at: At) -> Flow {
        let lower = name.to_ascii_lowercase();
        if self.routine(&lower).is_some() {
            self.mark(at, Class::Understood, "");
            let (on, _) = self.call(&lower, arguments, at);
            return if on { Flow::Next } else { Flow::End };
        }
        match instructions::effect(&lower) {
            Some(Effect::Move(kind)) => self.go(kind, &lower, arguments, at),
            Some(Effect::Followed) => self.follow(&lower, arguments, at),
            Some(Effect::Harmless) => {
                self.mark(at, Class::Harmless, "");
                self.heed(arguments, at);
                for path in super::effects::outputs(arguments) {
                    self.forget(&path.name);
                }
            }
            Some(Effect::Writes) => {
                self.mark(at, Class::Harmless, "");
                if lower == "waituntil" {
                    self.poll(arguments, at);
                } else {
                    self.heed(arguments, at);
                }
                for path in super::effects::paths(arguments) {
                    self.forget(&path.name);
                    if lower == "ivarvalue" {
                        // The sensor writes on, whenever it likes.
                        self.make_volatile(self.module, &path.name);
                    }
                }
            }
            Some(Effect::Changes(unmodelled)) => {
                self.soft |= unmodelled == Unmodelled::SoftServos;
                self.mark_unmodelled(at, unmodelled, format!("{name} is not followed"));
            }
            None => self.mark(at, Class::ChangesMotion, format!("`{name}` is not in this file")),
        }
        Flow::Next
    }

    /// From here on the trap may be executed at any time.
    fn connect(&mut self, name: &str, at: At) {
        let Some(trap) = self.traps.get(self.module, &name.to_ascii_lowercase()).copied() else {
            let what = format!("trap `{name}` is not in this file: what it does is not known");
            return self.mark_unmodelled(at, Unmodelled::Interrupts, what);
        };
        let effects = self.effects_of(trap);
        for (module, name) in effects.assigned {
            self.make_volatile(module, &name);
        }
        if effects.moves {
            let what = format!("trap `{}` may change motion whenever its interrupt comes", trap.name);
            self.mark_unmodelled(at, Unmodelled::Interrupts, what);
        } else {
            self.mark(at, Class::Harmless, "CONNECT");
        }
    }

    /// `%"name"%`: followed where the name is known.
    fn late(&mut self, name: &Expression, arguments: &[Argument], at: At) -> Flow {
        if let Value::Text(name) = self.evaluate(name, at) {
            let name = name.rsplit(':').next().unwrap_or_default().to_owned();
            return self.instruction(&name, arguments, at);
        }
        self.mark(at, Class::ChangesMotion, "which procedure is called depends on the cell");
        Flow::Next
    }

    fn branches(&mut self, branches: &[(Expression, Vec<Statement>)], otherwise: &[Statement], at: At) -> Flow {
        for (index, (condition, body)) in branches.iter().enumerate() {
            match self.evaluate(condition, at).truth() {
                Some(true) => {
                    self.mark(at, Class::Understood, "");
                    return self.block(body);
                }
                Some(false) => {}
                None => {
                    let rest = branches[index..].iter().map(|(_, body)| body.as_slice()).chain([otherwise]);
                    let later: Vec<_> = branches[index + 1..].iter().map(|(condition, _)| condition).collect();
                    self.depends(&rest.collect::<Blocks<'_>>(), &later, at);
                    return Flow::Next;
                }
            }
        }
        self.mark(at, Class::Understood, "");
        self.block(otherwise)
    }

    fn test(
        &mut self,
        of: &Expression,
        cases: &[(Vec<Expression>, Vec<Statement>)],
        otherwise: &[Statement],
        at: At,
    ) -> Flow {
        let of = self.evaluate(of, at);
        for (index, (values, body)) in cases.iter().enumerate() {
            for value in values {
                let Some(same) = of.same(&self.evaluate(value, at)) else {
                    let rest = cases[index..].iter().map(|(_, body)| body.as_slice()).chain([otherwise]);
                    let later: Vec<_> = cases[index..].iter().flat_map(|(values, _)| values).collect();
                    self.depends(&rest.collect::<Blocks<'_>>(), &later, at);
                    return Flow::Next;
                };
                if same {
                    self.mark(at, Class::Understood, "");
                    return self.block(body);
                }
            }
        }
        self.mark(at, Class::Understood, "");
        self.block(otherwise)
    }

    fn repeat(&mut self, condition: &Expression, body: &[Statement], at: At) -> Flow {
        let (mut begun, mut before) = (None, Vec::new());
        for round in 1.. {
            self.begins(round, &mut begun);
            before.push(self.moves.len());
            match self.evaluate(condition, at).truth() {
                Some(true) => {}
                Some(false) => {
                    self.mark(at, Class::Understood, "");
                    return Flow::Next;
                }
                None => {
                    // It is evaluated again after each round.
                    self.depends(&[body], &[condition], at);
                    return Flow::Next;
                }
            }
            self.mark(at, Class::Understood, "");
            match self.block(body) {
                Flow::Next if !self.step(at, 1) => return Flow::End,
                // Production programs go round for ever.
                Flow::Next if self.comes_again(begun.as_ref()) => {
                    self.tell_once(begun.as_ref(), &before);
                    let rounds = if round == 1 { "one round is".into() } else { format!("{round} rounds are") };
                    let what = format!("no end is seen, all further rounds are as before: {rounds} followed");
                    self.mark(at, Class::Understood, what);
                    return Flow::End;
                }
                Flow::Next => {}
                other => return other,
            }
        }
        Flow::End
    }

    fn count(
        &mut self,
        variable: &str,
        bounds: &[&Expression; 2],
        step: Option<&Expression>,
        body: &[Statement],
        at: At,
    ) -> Flow {
        let [from, to] = bounds.map(|bound| self.evaluate(bound, at).number().map(single));
        let by = match step {
            Some(step) => self.evaluate(step, at).number().map(single),
            None => from.zip(to).map(|(from, to)| if from <= to { 1.0 } else { -1.0 }),
        };
        let (Some(from), Some(to), Some(by)) = (from, to, by.filter(|by| *by != 0.0)) else {
            self.depends(&[body], &[], at);
            return Flow::Next;
        };
        self.mark(at, Class::Understood, "");
        let hidden = self.hide(variable);
        let mut value = from;
        let mut flow = Flow::Next;
        while if by > 0.0 { value <= to } else { value >= to } {
            self.hold(variable, value);
            flow = self.block(body);
            if !matches!(flow, Flow::Next) {
                break;
            }
            if !self.step(at, 1) {
                flow = Flow::End;
                break;
            }
            value = single(value + by);
        }
        self.unhide(variable, hidden);
        flow
    }

    /// What comes next depends on the cell: told where it matters to motion, and whatever it assigns is unknown.
    pub(super) fn depends(&mut self, blocks: &[&[Statement]], values: &[&Expression], at: At) {
        let effects = self.effects(blocks, values);
        if effects.moves || effects.leaves {
            self.mark(at, Class::ChangesMotion, "whether this moves the arm depends on the cell");
        } else {
            self.mark(at, Class::Harmless, "depends on the cell");
        }
        for (module, name) in effects.assigned {
            self.forget_all(module, &name);
        }
    }
}
