//! Data while a program is executed.

use super::{Machine, TWICE};
use crate::listing::{At, Class};
use crate::rapid::kinds::DataKind;
use crate::rapid::predefined;
use crate::rapid::syntax::{Declaration, Path, Step};
use crate::rapid::value::{Value, Variable};

/// Data of all declarations together, in values.
const MOST_VALUES: usize = 1_000_000;

impl Machine<'_> {
    /// The variable of the innermost routine, or of the modules.
    pub(super) fn find(&self, name: &str) -> Option<&Variable> {
        let name = name.to_ascii_lowercase();
        let local = self.frames.last().and_then(|frame| frame.variables.get(&name));
        local.or_else(|| self.globals.get(self.module, &name))
    }

    fn find_mut(&mut self, name: &str) -> Option<&mut Variable> {
        let name = name.to_ascii_lowercase();
        let local = self.frames.last_mut().and_then(|frame| frame.variables.get_mut(&name));
        local.or_else(|| self.globals.get_mut(self.module, &name))
    }

    /// The declaration of the modules itself, if it is what `name` means and still holds what it was declared with.
    pub(super) fn declared(&self, name: &str) -> Option<&Variable> {
        let lower = name.to_ascii_lowercase();
        let hidden = self.frames.last().is_some_and(|frame| frame.variables.contains_key(&lower));
        self.globals.get(self.module, &lower).filter(|variable| !hidden && variable.untouched)
    }

    /// Declares into the innermost routine, or into the modules where there is none.
    pub(super) fn declare(&mut self, declaration: &Declaration) {
        let kind = DataKind::of(&declaration.kind);
        let value = match kind {
            Some(_) if self.frames.is_empty() && self.twice.contains(&declaration.at) => Err(TWICE.into()),
            Some(kind) => self.declared_value(declaration, kind),
            None => Ok(Value::Unknown),
        };
        let value = match value {
            Ok(value) => {
                let class = if kind.is_some() { Class::Understood } else { Class::Harmless };
                self.mark(declaration.at, class, "");
                value
            }
            Err(what) => {
                // It matters where it is used.
                self.mark(declaration.at, Class::Harmless, format!("`{}` {what}", declaration.name));
                Value::Unknown
            }
        };
        let fixed = declaration.constant.then_some("is CONST");
        let variable = Variable { value, untouched: true, fixed, ..Variable::unknown(&declaration.name, kind) };
        let name = declaration.name.to_ascii_lowercase();
        match self.frames.last_mut() {
            Some(frame) => drop(frame.variables.insert(name, variable)),
            None => self.globals.insert(declaration.home, name, variable),
        }
    }

    fn declared_value(&mut self, declaration: &Declaration, kind: DataKind) -> Result<Value, String> {
        let mut extents = Vec::new();
        for extent in &declaration.extents {
            let count = self.evaluate(extent, declaration.at).number().filter(|n| (1.0..=1e6).contains(n));
            extents.push(count.ok_or("has an extent that is not known, or none from 1 to 1000000")? as usize);
        }
        let count = extents.iter().try_fold(1_usize, |all, extent| all.checked_mul(*extent));
        let initial = Value::initial(kind);
        let size = count.and_then(|count| count.checked_mul(initial.size()));
        let size = size.filter(|size| self.size + size <= MOST_VALUES);
        let size = size.ok_or_else(|| format!("is too large: more than {MOST_VALUES} values at a time"))?;
        self.size += size;
        self.steps = self.steps.saturating_add(size);
        if let Some(frame) = self.frames.last_mut() {
            frame.size += size;
        }
        match &declaration.value {
            Some(value) => self.evaluate(value, declaration.at).into_declared(kind, &extents),
            None => {
                let of = |inner: Value, extent: &usize| Value::Array(vec![inner; *extent]);
                Ok(extents.iter().rev().fold(initial, of))
            }
        }
    }

    /// What a path holds; `Unknown` where there is no such thing.
    pub(super) fn look(&mut self, path: &Path, at: At) -> Value {
        let Some(steps) = self.resolve(path, at) else { return Value::Unknown };
        let Some(variable) = self.find_mut(&path.name) else {
            let Some(mut value) = predefined::value(&path.name.to_ascii_lowercase()) else { return Value::Unknown };
            return walk(&mut value, &steps).map_or(Value::Unknown, |value| value.clone());
        };
        let beyond = beyond(&variable.value, &steps);
        if variable.volatile {
            return Value::Unknown;
        }
        if let Some(what) = beyond {
            self.beyond(path, &what, at);
            return Value::Unknown;
        }
        let Some(variable) = self.find_mut(&path.name) else { return Value::Unknown };
        let value = walk(&mut variable.value, &steps).map_or(Value::Unknown, |value| value.clone());
        self.steps = self.steps.saturating_add(value.size());
        value
    }

    /// Puts a value where a path leads. What cannot be told from what makes the whole variable unknown.
    pub(super) fn put(&mut self, path: &Path, value: Value, at: At) -> Result<(), String> {
        let steps = self.resolve(path, at);
        let Some(variable) = self.find_mut(&path.name) else {
            return Err(format!("`{}` is not declared in this file", path.name));
        };
        if let Some(why) = variable.fixed {
            variable.value = Value::Unknown;
            return Err(format!("`{}` {why}, and is not assigned to", path.name));
        }
        variable.untouched = false;
        let beyond = steps.as_ref().and_then(|steps| beyond(&variable.value, steps));
        if let Some(what) = beyond {
            variable.value = Value::Unknown;
            self.beyond(path, &what, at);
            return Ok(());
        }
        let (kind, whole) = (variable.kind, path.steps.is_empty());
        let place = match &steps {
            Some(steps) => walk(&mut variable.value, steps),
            None => None,
        };
        let Some(place) = place else {
            let known = variable.value != Value::Unknown;
            variable.value = Value::Unknown;
            return if steps.is_some() && known { Err(format!("`{}` has no such part", path.name)) } else { Ok(()) };
        };
        let fitted = match (&*place, kind) {
            _ if value == Value::Unknown => Ok(Value::Unknown),
            (_, None) => Ok(Value::Unknown),
            (Value::Record { kind: Some(part), .. }, _) => value.into_kind(*part),
            (Value::Array(_), Some(kind)) => {
                let extents = extents(place);
                value.into_declared(kind, &extents)
            }
            (_, Some(kind)) if whole || kind == DataKind::Dnum => value.into_kind(kind),
            _ => Ok(value),
        };
        match fitted {
            Ok(value) => *place = value,
            Err(what) => {
                *place = Value::Unknown;
                return Err(format!("the value for `{}` {what}", path.name));
            }
        }
        Ok(())
    }

    /// Puts the counter of a loop before whatever has its name; what it hides comes back by [`Self::unhide`].
    pub(super) fn hide(&mut self, name: &str) -> Option<Variable> {
        self.frames.last_mut()?.variables.remove(&name.to_ascii_lowercase())
    }

    /// Sets the counter of a loop.
    pub(super) fn hold(&mut self, name: &str, value: f64) {
        let (value, fixed) = (Value::Num(value), Some("counts a loop"));
        let variable = Variable { value, fixed, ..Variable::unknown(name, Some(DataKind::Num)) };
        if let Some(frame) = self.frames.last_mut() {
            frame.variables.insert(name.to_ascii_lowercase(), variable);
        }
    }

    /// Takes the counter of a loop away.
    pub(super) fn unhide(&mut self, name: &str, hidden: Option<Variable>) {
        if let Some(frame) = self.frames.last_mut() {
            frame.variables.remove(&name.to_ascii_lowercase());
            frame.variables.extend(hidden.map(|variable| (name.to_ascii_lowercase(), variable)));
        }
    }

    /// The variable is no longer known.
    pub(super) fn forget(&mut self, name: &str) {
        if let Some(variable) = self.find_mut(name) {
            variable.value = Value::Unknown;
            variable.untouched = false;
        }
    }

    /// Whatever the name may mean here or in that module is no longer known.
    pub(super) fn forget_all(&mut self, module: usize, name: &str) {
        let name = name.to_ascii_lowercase();
        let framed = self.frames.last_mut().and_then(|frame| frame.variables.get_mut(&name));
        for variable in framed.into_iter().chain(self.globals.get_mut(module, &name)) {
            variable.value = Value::Unknown;
            variable.untouched = false;
        }
    }

    /// What the name means in that module is never known again.
    pub(super) fn make_volatile(&mut self, module: usize, name: &str) {
        if let Some(variable) = self.globals.get_mut(module, &name.to_ascii_lowercase()) {
            variable.volatile = true;
            variable.untouched = false;
        }
    }

    /// Tells of an index that no element has, which stops a controller. Behind an operand that has decided already
    /// nobody looks.
    fn beyond(&mut self, path: &Path, what: &str, at: At) {
        if self.decided == 0 {
            self.mark(at, Class::ChangesMotion, format!("`{}` {what}", path.name));
        }
    }

    /// The steps of a path with their indices evaluated, as written; `None` where one is unknown.
    fn resolve(&mut self, path: &Path, at: At) -> Option<Vec<Resolved>> {
        let mut resolved = Vec::new();
        for step in &path.steps {
            match step {
                Step::Component(name) => resolved.push(Resolved::Component(name.clone())),
                Step::Element(indices) => {
                    for index in indices {
                        let index = self.evaluate(index, at).number().filter(|index| index.abs() < 1e7)?;
                        resolved.push(Resolved::Element(index as i64));
                    }
                }
            }
        }
        Some(resolved)
    }
}

enum Resolved {
    /// Counted from 1.
    Element(i64),
    Component(String),
}

/// Where an element stands in its array.
fn place(index: i64) -> Option<usize> {
    usize::try_from(index.checked_sub(1)?).ok()
}

/// The first index that its array has not, in words.
fn beyond(value: &Value, steps: &[Resolved]) -> Option<String> {
    // Components come behind all indices of data: no kind of record holds an array.
    let mut value = value;
    for step in steps {
        let (Resolved::Element(index), Value::Array(parts)) = (step, value) else { return None };
        match place(*index).and_then(|place| parts.get(place)) {
            Some(part) => value = part,
            None => return Some(format!("has the index {index}: must be from 1 to {}", parts.len())),
        }
    }
    None
}

fn walk<'v>(mut value: &'v mut Value, steps: &[Resolved]) -> Option<&'v mut Value> {
    for step in steps {
        value = match (step, value) {
            (Resolved::Element(index), Value::Array(parts)) => parts.get_mut(place(*index)?)?,
            (Resolved::Component(name), record) => record.component(name)?,
            _ => return None,
        };
    }
    Some(value)
}

fn extents(value: &Value) -> Vec<usize> {
    match value {
        Value::Array(parts) => {
            std::iter::once(parts.len()).chain(parts.first().map(extents).unwrap_or_default()).collect()
        }
        _ => Vec::new(),
    }
}
