//! Calls of the file's own routines.

use super::motion::repeated;
use super::{DEEPEST, Flow, Frame, Machine, twice};
use crate::listing::{At, Class};
use crate::rapid::kinds::DataKind;
use crate::rapid::predefined;
use crate::rapid::syntax::{Argument, Expression, Path, Routine};
use crate::rapid::value::{Value, Variable};

/// A routine about to be executed: its variables, and which of the caller's come back.
struct Bound<'a> {
    frame: Frame,
    back: Vec<(String, &'a Path)>,
}

impl<'a> Machine<'a> {
    /// Calls the routine of that name (lower case, one of the file's): whether execution goes on behind it, and its
    /// value.
    pub(super) fn call(&mut self, name: &str, arguments: &[Argument], at: At) -> (bool, Option<Value>) {
        let Some(routine) = self.routine(name) else { return (true, None) };
        if self.is_twice(routine) {
            self.mark(at, Class::ChangesMotion, twice(&routine.name));
            return (true, None);
        }
        if self.depth >= DEEPEST {
            let what =
                format!("`{}` is called in itself, or blocks are nested, more than {DEEPEST} deep", routine.name);
            self.mark(at, Class::ChangesMotion, what);
            return (false, None);
        }
        let bound = match self.bind(routine, arguments, at) {
            Ok(bound) => bound,
            Err(what) => {
                self.mark(at, Class::ChangesMotion, what);
                return (true, None);
            }
        };
        self.frames.push(bound.frame);
        let caller = std::mem::replace(&mut self.module, routine.home.module);
        let flow = self.enter(routine);
        self.module = caller;
        let frame = self.frames.pop().unwrap_or_default();
        self.size -= frame.size.min(self.size);
        for (parameter, path) in bound.back {
            if let Some(variable) = frame.variables.get(&parameter)
                && !variable.untouched
            {
                let value = variable.value.clone();
                // Its kind was checked on the way in; what does not fit any more is unknown now.
                if self.assign(path, value, at).is_err() {
                    self.forget(&path.name);
                }
            }
        }
        match flow {
            Flow::Next => (true, None),
            Flow::Return(value) => {
                // An aggregate gets its kind here, and a literal its precision.
                let kind = routine.gives.as_deref().and_then(DataKind::of);
                let of_kind = |value: Value| kind.map_or(Ok(value.clone()), |kind| value.into_kind(kind));
                (true, value.map(|value| of_kind(value).unwrap_or(Value::Unknown)))
            }
            Flow::End => (false, None),
        }
    }

    /// Executes the routine in the innermost frame.
    pub(super) fn enter(&mut self, routine: &'a Routine) -> Flow {
        self.ran.insert(routine.at);
        self.mark(routine.at, Class::Understood, "");
        for declaration in &routine.data {
            self.declare(declaration);
        }
        self.depth += 1;
        let flow = self.block(&routine.body);
        self.depth -= 1;
        flow
    }

    fn bind<'b>(&mut self, routine: &Routine, arguments: &'b [Argument], at: At) -> Result<Bound<'b>, String> {
        if let Some(name) = repeated(arguments) {
            return Err(format!("`\\{name}` of `{}` is given twice", routine.name));
        }
        let optional = |name: &str| routine.parameters.iter().any(|known| known.optional && known.name == name);
        let unknown = arguments.iter().find_map(|argument| match argument {
            Argument::Named { name, .. } | Argument::IfGiven { name, .. } if !optional(name) => Some(name),
            _ => None,
        });
        if let Some(unknown) = unknown {
            return Err(format!("`{}` has no `\\{unknown}`", routine.name));
        }
        let mut bound = Bound { frame: Frame::default(), back: Vec::new() };
        let mut placed = arguments.iter().filter_map(|argument| match argument {
            Argument::Placed(value) => Some(value),
            _ => None,
        });
        for parameter in &routine.parameters {
            let value: Option<Option<&Expression>> = if parameter.optional {
                self.optional(arguments, &parameter.name)
            } else {
                let value = placed.next();
                Some(Some(value.ok_or_else(|| format!("`{}` needs `{}`", routine.name, parameter.name))?))
            };
            let kind = DataKind::of(&parameter.kind);
            let mut known = Value::Unknown;
            if let Some(given) = value {
                bound.frame.given.insert(parameter.name.clone());
                if let Some(expression) = given {
                    let evaluated = self.evaluate(expression, at);
                    known = match (&evaluated, kind) {
                        (Value::Array(_), _) => evaluated,
                        (_, Some(kind)) => {
                            let named = |what| format!("`{}` of `{}` {what}", parameter.name, routine.name);
                            evaluated.into_kind(kind).map_err(named)?
                        }
                        (_, None) => evaluated,
                    };
                    if parameter.returned {
                        let path = self.returns_to(expression, kind);
                        let path = path.map_err(|why| format!("`{}` of `{}` {why}", parameter.name, routine.name))?;
                        bound.back.push((parameter.name.clone(), path));
                    }
                }
            }
            let variable = Variable { value: known, untouched: true, ..Variable::unknown(&parameter.name, kind) };
            bound.frame.variables.insert(parameter.name.clone(), variable);
        }
        match placed.next() {
            Some(_) => Err(format!("`{}` takes fewer arguments", routine.name)),
            None => Ok(bound),
        }
    }

    /// Where what a parameter that gives back holds in the end goes; or why no controller loads such a call, in words
    /// that follow the parameter.
    fn returns_to<'b>(&self, given: &'b Expression, kind: Option<DataKind>) -> Result<&'b Path, String> {
        let Expression::Path(path) = given else { return Err("gives back, and is no data".into()) };
        match self.find(&path.name) {
            Some(Variable { fixed: Some(why), .. }) => Err(format!("gives back, and `{}` {why}", path.name)),
            // Signals, mechanical units and their like stand in no module.
            None if kind.is_some() && !self.is_of_controller(&path.name) => {
                Err(format!("gives back, and `{}` is not declared in this file", path.name))
            }
            _ => Ok(path),
        }
    }

    /// Whether a name that no module declares is data all the same.
    fn is_of_controller(&self, name: &str) -> bool {
        let lower = name.to_ascii_lowercase();
        let tools = self.known.tools.iter().map(|tool| &tool.name);
        let objects = self.known.work_objects.iter().map(|object| &object.name);
        predefined::value(&lower).is_some()
            || ["errno", "intno"].contains(&lower.as_str())
            || tools.chain(objects).any(|known| known.eq_ignore_ascii_case(name))
    }

    /// Whether the caller gave this optional parameter of the routine that is being executed.
    pub(super) fn is_given(&self, parameter: &Expression) -> bool {
        match (parameter, self.frames.last()) {
            (Expression::Path(path), Some(frame)) => frame.given.contains(&path.name.to_ascii_lowercase()),
            _ => false,
        }
    }

    /// The optional argument of that name: not given, given as a switch, or given with a value.
    fn optional<'b>(&self, arguments: &'b [Argument], wanted: &str) -> Option<Option<&'b Expression>> {
        arguments.iter().find_map(|argument| match argument {
            Argument::Named { name, value } if name == wanted => Some(value.as_ref()),
            Argument::IfGiven { name, parameter } if name == wanted => {
                self.is_given(parameter).then_some(Some(parameter))
            }
            _ => None,
        })
    }
}
