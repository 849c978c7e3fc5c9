//! What the arm carries: a load that changes on the way changes motion, and no model here has it.

use super::Machine;
use crate::listing::{At, Class, Unmodelled};
use crate::rapid::kinds::DataKind;
use crate::rapid::predefined;
use crate::rapid::syntax::{Argument, Expression, Path};
use crate::rapid::value::Value;

impl Machine<'_> {
    /// `GripLoad`: harmless only while the arm carries nothing and is told so.
    pub(super) fn grip(&mut self, placed: &[&Expression], at: At) {
        let nothing = placed.first().is_some_and(|load| self.is_no_load(load, at));
        if nothing && !self.gripped {
            return self.mark(at, Class::Harmless, "");
        }
        self.gripped = !nothing;
        let what = if nothing { "GripLoad: the load is put down" } else { "GripLoad: a load is taken up" };
        self.mark_unmodelled(at, Unmodelled::Payload, what);
    }

    /// Whether the load is the controller's own for nothing, `load0`.
    pub(super) fn is_no_load(&mut self, load: &Expression, at: At) -> bool {
        predefined::value("load0").is_some_and(|nothing| self.evaluate(load, at) == nothing)
    }

    /// Whether an instruction that may change what is carried, or how stiff the servos are, changes nothing now.
    pub(super) fn changes_no_load(&self, name: &str, arguments: &[Argument]) -> bool {
        let load0 = |argument: &Argument| {
            matches!(argument, Argument::Placed(Expression::Path(Path { name, steps }))
                if steps.is_empty() && name.eq_ignore_ascii_case("load0") && self.find(name).is_none())
        };
        match name {
            "gripload" => !self.gripped && arguments.iter().all(load0),
            "softdeact" => !self.soft,
            _ => false,
        }
    }

    /// Puts a value where a path leads, and tells if the load of a tool that moved before is another one then.
    pub(super) fn assign(&mut self, path: &Path, value: Value, at: At) -> Result<(), String> {
        let before = self.loads_of(path);
        let put = self.put(path, value, at);
        if before.is_some() && self.loads_of(path) != before {
            let what = format!("the load of tool `{}` changes", path.name);
            self.mark_unmodelled(at, Unmodelled::Payload, what);
        }
        put
    }

    /// The loads of the tools under that name, if moves have used it.
    fn loads_of(&self, path: &Path) -> Option<Vec<Value>> {
        let variable = self.find(&path.name).filter(|variable| variable.kind == Some(DataKind::ToolData))?;
        if !self.carried.contains(&path.name.to_ascii_lowercase()) {
            return None;
        }
        let mut loads = Vec::new();
        collect(&variable.value, &mut loads);
        Some(loads)
    }
}

fn collect(value: &Value, loads: &mut Vec<Value>) {
    match value {
        Value::Array(parts) => parts.iter().for_each(|part| collect(part, loads)),
        tool => loads.push(tool.parts().get(2).cloned().unwrap_or(Value::Unknown)),
    }
}
