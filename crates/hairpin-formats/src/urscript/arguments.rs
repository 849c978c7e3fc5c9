//! What is handed to functions of URScript.

use std::collections::BTreeMap;

use hairpin::math::rotation::from_rotation_vector;
use nalgebra::{Isometry3, Translation3, Vector3};

/// Numbers of a list at most.
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

/// Arguments of a call by their names, however they were given.
#[derive(Debug, Default)]
pub(super) struct Arguments<'n>(BTreeMap<&'n str, Value>);

impl<'n> Arguments<'n> {
    /// What stands between the brackets of a call that takes arguments of these `names`, in their order.
    ///
    /// # Errors
    /// One that is not among them, that is given twice or is empty; one without a name behind one that has.
    pub(super) fn of(text: &str, names: &[&'n str]) -> Result<Self, String> {
        let mut all = Self::default();
        if text.trim().is_empty() {
            return Ok(all);
        }
        let mut by_name = false;
        for (place, part) in split(text).into_iter().enumerate() {
            let (name, written) = match part.split_once('=').filter(|(name, _)| is_name(name.trim())) {
                Some((name, written)) => {
                    by_name = true;
                    let known = names.iter().find(|known| **known == name.trim());
                    (known.ok_or_else(|| format!("{} is not followed", name.trim()))?, written)
                }
                None if by_name => return Err(format!("argument {} has no name, and one before it has", place + 1)),
                None => (names.get(place).ok_or_else(|| format!("argument {} is not followed", place + 1))?, part),
            };
            if written.trim().is_empty() {
                return Err(format!("{name} is empty"));
            }
            if all.0.insert(name, value(written.trim())?).is_some() {
                return Err(format!("{name} is given twice"));
            }
        }
        Ok(all)
    }

    /// The argument of that name.
    pub(super) fn get(&self, name: &str) -> Option<&Value> {
        self.0.get(name)
    }

    /// A number; `None` where it is not given.
    pub(super) fn number(&self, name: &str) -> Result<Option<f64>, String> {
        match self.get(name) {
            None => Ok(None),
            Some(Value::Number(number)) => Ok(Some(*number)),
            Some(_) => Err(format!("{name} is no number that is known")),
        }
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
