//! What expressions come to. Whatever depends on the cell is unknown; nothing here fails.

use super::{DEEPEST, Machine};
use crate::listing::{At, Class};
use crate::rapid::builtin::{self, Arguments};
use crate::rapid::syntax::{Argument, Expression};
use crate::rapid::value::{Value, single};

/// Longest string.
const LONGEST_TEXT: usize = 80;

impl Machine<'_> {
    /// What it comes to; unknown as well where functions within functions go too deep.
    pub(super) fn evaluate(&mut self, expression: &Expression, at: At) -> Value {
        self.steps = self.steps.saturating_add(1);
        if self.depth >= DEEPEST {
            return Value::Unknown;
        }
        self.depth += 1;
        let value = self.value_of(expression, at);
        self.depth -= 1;
        value
    }

    fn value_of(&mut self, expression: &Expression, at: At) -> Value {
        match expression {
            Expression::Number(value) => Value::Num(*value),
            Expression::Bool(value) => Value::Bool(*value),
            Expression::Text(text) if text.chars().count() > LONGEST_TEXT => Value::Unknown,
            Expression::Text(text) => Value::Text(text.clone()),
            Expression::Aggregate(parts) => {
                let parts = parts.iter().map(|part| self.evaluate(part, at)).collect();
                Value::Record { kind: None, parts }
            }
            Expression::Path(path) => self.look(path, at),
            Expression::Call { name, arguments } => self.function(name, arguments, at),
            Expression::Unary { sign, of } => match (*sign, self.evaluate(of, at)) {
                ("-", Value::Num(value)) => Value::Num(-value),
                ("-", Value::Double(value)) => Value::Double(-value),
                ("NOT", Value::Bool(value)) => Value::Bool(!value),
                _ => Value::Unknown,
            },
            Expression::Chain { first, rest } => {
                let first = self.evaluate(first, at);
                rest.iter().fold(first, |left, (sign, right)| {
                    let decided = matches!((*sign, &left), ("AND", Value::Bool(false)) | ("OR", Value::Bool(true)));
                    self.decided += usize::from(decided);
                    let right = self.evaluate(right, at);
                    self.decided -= usize::from(decided);
                    if matches!(*sign, "/" | "DIV" | "MOD") && right.number() == Some(0.0) && self.decided == 0 {
                        self.mark(at, Class::ChangesMotion, format!("`{sign}` by zero stops a controller"));
                    }
                    combine(sign, &left, &right)
                })
            }
        }
    }

    fn function(&mut self, name: &str, arguments: &[Argument], at: At) -> Value {
        let lower = name.to_ascii_lowercase();
        if self.routine(&lower).is_some() {
            return self.call(&lower, arguments, at).1.unwrap_or(Value::Unknown);
        }
        if lower == "present" {
            return self.present(arguments);
        }
        let mut passed_on = false;
        let mut evaluated = Arguments { placed: Vec::new(), named: Vec::new() };
        for argument in arguments {
            match argument {
                Argument::Placed(value) => evaluated.placed.push(self.evaluate(value, at)),
                Argument::Named { name, value } => {
                    let value = value.as_ref().map_or(Value::Bool(true), |value| self.evaluate(value, at));
                    evaluated.named.push((name.clone(), value));
                }
                // What stands behind it is evaluated all the same.
                Argument::IfGiven { .. } => passed_on = true,
            }
        }
        for path in super::effects::written(&lower, arguments) {
            // What is CONST no controller lets a function write into.
            if self.find(&path.name).is_some_and(|variable| variable.fixed.is_none()) {
                self.forget(&path.name);
            }
        }
        if passed_on { Value::Unknown } else { builtin::call(&lower, &evaluated) }
    }

    /// Evaluates what is handed to an instruction that needs no values, for what is called there.
    pub(super) fn heed(&mut self, arguments: &[Argument], at: At) {
        for argument in arguments {
            match argument {
                // Nothing happens where a variable is looked at; outputs are such.
                Argument::Placed(Expression::Path(path))
                | Argument::Named { value: Some(Expression::Path(path)), .. }
                    if path.steps.is_empty() => {}
                Argument::Placed(value) | Argument::Named { value: Some(value), .. } => drop(self.evaluate(value, at)),
                Argument::Named { value: None, .. } | Argument::IfGiven { .. } => {}
            }
        }
    }

    /// `WaitUntil`: its condition is evaluated until it holds.
    pub(super) fn poll(&mut self, arguments: &[Argument], at: At) {
        let mut condition = None;
        for argument in arguments {
            match argument {
                Argument::Placed(value) if condition.is_none() => condition = Some((value, self.evaluate(value, at))),
                _ => self.heed(std::slice::from_ref(argument), at),
            }
        }
        if let Some((condition, value)) = condition
            && value.truth() != Some(true)
        {
            self.depends(&[], &[condition], at);
        }
    }

    /// `Present(parameter)`.
    fn present(&self, arguments: &[Argument]) -> Value {
        match arguments {
            [Argument::Placed(parameter)] => Value::Bool(self.is_given(parameter)),
            _ => Value::Unknown,
        }
    }
}

pub(super) fn combine(sign: &str, left: &Value, right: &Value) -> Value {
    match (left, right) {
        (Value::Num(a), Value::Num(b)) => match numbers(sign, single(*a), single(*b)) {
            Value::Double(value) if single(value).is_finite() => Value::Num(single(value)),
            Value::Double(_) => Value::Unknown,
            truth => truth,
        },
        (Value::Num(a) | Value::Double(a), Value::Num(b) | Value::Double(b)) => numbers(sign, *a, *b),
        (Value::Bool(a), Value::Bool(b)) => Value::Bool(match sign {
            "AND" => *a && *b,
            "OR" => *a || *b,
            "XOR" | "<>" => a != b,
            "=" => a == b,
            _ => return Value::Unknown,
        }),
        // One side may decide alone.
        (Value::Bool(false), Value::Unknown) | (Value::Unknown, Value::Bool(false)) if sign == "AND" => {
            Value::Bool(false)
        }
        (Value::Bool(true), Value::Unknown) | (Value::Unknown, Value::Bool(true)) if sign == "OR" => Value::Bool(true),
        (Value::Text(a), Value::Text(b)) => match sign {
            "+" if a.chars().count() + b.chars().count() <= LONGEST_TEXT => Value::Text(format!("{a}{b}")),
            "=" => Value::Bool(a == b),
            "<>" => Value::Bool(a != b),
            _ => Value::Unknown,
        },
        (Value::Record { kind, parts: a }, Value::Record { parts: b, .. }) if a.len() == b.len() => {
            records(sign, left.same(right), *kind, a, b)
        }
        // pos * num
        (Value::Record { kind, parts }, Value::Num(_)) if sign == "*" && parts.len() == 3 => {
            let parts = parts.iter().map(|part| combine("*", part, right)).collect();
            Value::Record { kind: *kind, parts }
        }
        (Value::Num(_), Value::Record { .. }) if sign == "*" => combine(sign, right, left),
        _ => Value::Unknown,
    }
}

/// In double precision. Of two singles it is the same as in single, once it is rounded.
fn numbers(sign: &str, a: f64, b: f64) -> Value {
    let value = match sign {
        "+" => a + b,
        "-" => a - b,
        "*" => a * b,
        "/" => a / b,
        "DIV" => (a / b).trunc(),
        "MOD" => a % b,
        "=" => return Value::Bool(a == b),
        "<>" => return Value::Bool(a != b),
        "<" => return Value::Bool(a < b),
        ">" => return Value::Bool(a > b),
        "<=" => return Value::Bool(a <= b),
        ">=" => return Value::Bool(a >= b),
        _ => return Value::Unknown,
    };
    if value.is_finite() { Value::Double(value) } else { Value::Unknown }
}

/// pos + pos, pos − pos, and comparisons of records.
fn records(
    sign: &str,
    equal: Option<bool>,
    kind: Option<crate::rapid::kinds::DataKind>,
    a: &[Value],
    b: &[Value],
) -> Value {
    match sign {
        "+" | "-" if a.len() == 3 => {
            let parts = a.iter().zip(b).map(|(a, b)| combine(sign, a, b)).collect();
            Value::Record { kind, parts }
        }
        "=" | "<>" => equal.map_or(Value::Unknown, |equal| Value::Bool(equal == (sign == "="))),
        _ => Value::Unknown,
    }
}
