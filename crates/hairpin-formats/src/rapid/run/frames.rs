//! Tools and work objects of moves.

use hairpin::trajectory::program::{Tool, WorkObject};

use super::Machine;
use super::motion::Doubts;
use crate::listing::{At, Unmodelled};
use crate::rapid::kinds::DataKind;
use crate::rapid::syntax::{Expression, Path};
use crate::rapid::value::{self, Unfit};

impl Machine<'_> {
    /// The name that the expression is, if the file does not declare it.
    pub(super) fn undeclared<'b>(&self, expression: &'b Expression) -> Option<&'b str> {
        match expression {
            Expression::Path(Path { name, steps }) if steps.is_empty() && self.find(name).is_none() => Some(name),
            _ => None,
        }
    }

    pub(super) fn tool(&mut self, expression: &Expression, at: At, doubts: &mut Doubts) -> Result<Tool, Unfit> {
        if let Some(name) = self.undeclared(expression) {
            let known = self.known.tools.iter().find(|tool| tool.name.eq_ignore_ascii_case(name));
            return Ok(match known {
                Some(tool) => Tool { declare: false, ..tool.clone() },
                None if name.eq_ignore_ascii_case("tool0") => Tool::flange(),
                None => {
                    doubts.push(None, format!("tool `{name}` is not declared in this file"));
                    Tool { name: name.into(), ..Tool::flange() }
                }
            });
        }
        let (value, name) = self.data(expression, DataKind::ToolData, at)?;
        if let Expression::Path(path) = expression {
            self.carried.insert(path.name.to_ascii_lowercase());
        }
        let name = name.unwrap_or_else(|| "tChanged".into());
        let tool = value::tool(&value, &name).map_err(|what| self.about(expression, what))?;
        if !tool.held {
            doubts.push(Some(Unmodelled::StandingTools), format!("tool `{name}` stands in the cell"));
        }
        Ok(tool)
    }

    pub(super) fn work_object(
        &mut self,
        expression: Option<&Expression>,
        at: At,
        doubts: &mut Doubts,
    ) -> Result<WorkObject, Unfit> {
        let Some(expression) = expression else { return Ok(WorkObject::base()) };
        if let Some(name) = self.undeclared(expression) {
            let known = self.known.work_objects.iter().find(|object| object.name.eq_ignore_ascii_case(name));
            return Ok(match known {
                Some(object) => WorkObject { declare: false, ..object.clone() },
                None if name.eq_ignore_ascii_case("wobj0") => WorkObject::base(),
                None => {
                    doubts.push(None, format!("work object `{name}` is not declared in this file"));
                    WorkObject { name: name.into(), ..WorkObject::base() }
                }
            });
        }
        let (value, name) = self.data(expression, DataKind::WobjData, at)?;
        let name = name.unwrap_or_else(|| "wChanged".into());
        let object = value::work_object(&value, &name).map_err(|what| self.about(expression, what))?;
        if object.held {
            doubts.push(Some(Unmodelled::StandingTools), format!("work object `{name}` is held"));
        }
        if let Some(unit) = &object.moved_by {
            let unit = unit.escape_default();
            doubts.push(Some(Unmodelled::Conveyors), format!("work object `{name}` moves with `{unit}`"));
        }
        Ok(object)
    }

    /// Where the tool stands in the table; one that was changed on the way gets a name of its own.
    pub(super) fn tool_index(&mut self, mut tool: Tool) -> usize {
        let base = tool.name.clone();
        let mut count = 1;
        while let Some(index) = self.tools.iter().position(|known| known.name.eq_ignore_ascii_case(&tool.name)) {
            if self.tools[index] == tool {
                return index;
            }
            count += 1;
            tool.name = format!("{}_{count}", base.chars().take(26).collect::<String>());
        }
        self.tools.push(tool);
        self.tools.len() - 1
    }

    pub(super) fn work_object_index(&mut self, mut object: WorkObject) -> usize {
        let base = object.name.clone();
        let mut count = 1;
        while let Some(index) = self.work_objects.iter().position(|known| known.name.eq_ignore_ascii_case(&object.name))
        {
            if self.work_objects[index] == object {
                return index;
            }
            count += 1;
            object.name = format!("{}_{count}", base.chars().take(26).collect::<String>());
        }
        self.work_objects.push(object);
        self.work_objects.len() - 1
    }
}
