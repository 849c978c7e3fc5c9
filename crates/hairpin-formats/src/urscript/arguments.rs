//! What is handed to functions of URScript.

use hairpin::math::rotation::from_rotation_vector;
use nalgebra::{Isometry3, Translation3, Vector3};

/// Arguments of a call at most.
const MOST: usize = 64;

/// A value as it is written.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Value {
    Number(f64),
    /// `[…]`
    List(Vec<f64>),
    /// `p[…]`
    Pose(Isometry3<f64>),
    /// Anything else: names, expressions, strings.
    Other(String),
}

/// Arguments of a call: by place, then by name.
#[derive(Debug, Default)]
pub(super) struct Arguments {
    placed: Vec<Value>,
    named: Vec<(String, Value)>,
}

impl Arguments {
    /// What stands between the brackets of a call.
    pub(super) fn of(text: &str) -> Result<Self, String> {
        let mut all = Self::default();
        for part in split(text).into_iter().filter(|part| !part.is_empty()) {
            let name = part.split_once('=').filter(|(name, _)| is_name(name.trim()));
            match name {
                Some((name, written)) => all.named.push((name.trim().into(), value(written.trim())?)),
                None => all.placed.push(value(part)?),
            }
            if all.placed.len() + all.named.len() > MOST {
                return Err(format!("more than {MOST} arguments"));
            }
        }
        Ok(all)
    }

    /// The argument at that place, or of that name.
    pub(super) fn get(&self, place: usize, name: &str) -> Option<&Value> {
        let named = self.named.iter().find(|(known, _)| known == name).map(|(_, value)| value);
        named.or_else(|| self.placed.get(place))
    }

    /// A number; `None` where it is not given.
    pub(super) fn number(&self, place: usize, name: &str) -> Result<Option<f64>, String> {
        match self.get(place, name) {
            None => Ok(None),
            Some(Value::Number(number)) => Ok(Some(*number)),
            Some(_) => Err(format!("{name} is no number that is known")),
        }
    }

    /// The first argument that is none of these, by its name or beyond the last of them.
    pub(super) fn unknown(&self, known: &[&str]) -> Option<String> {
        let named = self.named.iter().map(|(name, _)| name).find(|name| !known.contains(&name.as_str()));
        let beyond = || (self.placed.len() > known.len()).then(|| format!("argument {}", known.len() + 1));
        named.cloned().or_else(beyond)
    }
}

fn value(text: &str) -> Result<Value, String> {
    if let Some(number) = number(text) {
        return Ok(Value::Number(number));
    }
    let (pose, list) = match text.strip_prefix('p') {
        Some(list) => (true, list.trim_start()),
        None => (false, text),
    };
    let Some(inside) = list.strip_prefix('[').and_then(|list| list.strip_suffix(']')) else {
        return Ok(Value::Other(text.into()));
    };
    let numbers: Option<Vec<f64>> = inside.split(',').take(MOST).map(|part| number(part.trim())).collect();
    match (numbers, pose) {
        (Some(numbers), false) => Ok(Value::List(numbers)),
        (Some(numbers), true) => match numbers[..] {
            [x, y, z, a, b, c] => {
                let turn = from_rotation_vector(&Vector3::new(a, b, c));
                Ok(Value::Pose(Isometry3::from_parts(Translation3::new(x, y, z), turn)))
            }
            _ => Err(format!("a pose has 6 numbers, found {}", numbers.len())),
        },
        (None, _) => Ok(Value::Other(text.into())),
    }
}

/// A decimal number as it is written; no expression.
fn number(text: &str) -> Option<f64> {
    // Rust would take `inf` and `nan`.
    let spelt = text.chars().all(|c| c.is_ascii_digit() || "+-.eE".contains(c));
    text.parse::<f64>().ok().filter(|value| spelt && value.is_finite())
}

fn is_name(text: &str) -> bool {
    text.starts_with(|c: char| c.is_alphabetic() || c == '_') && text.chars().all(|c| c.is_alphanumeric() || c == '_')
}

/// Parts between commas that are in no brackets and no quotes.
fn split(text: &str) -> Vec<&str> {
    let (mut parts, mut depth, mut quoted, mut from) = (Vec::new(), 0_usize, false, 0);
    for (at, c) in text.char_indices() {
        match c {
            '"' => quoted = !quoted,
            '[' | '(' if !quoted => depth += 1,
            ']' | ')' if !quoted => depth = depth.saturating_sub(1),
            ',' if depth == 0 && !quoted => {
                parts.push(text[from..at].trim());
                from = at + 1;
            }
            _ => {}
        }
    }
    parts.push(text[from..].trim());
    parts
}
