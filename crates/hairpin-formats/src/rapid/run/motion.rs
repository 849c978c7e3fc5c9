//! Moves, and what is followed of the instructions around them.

use std::collections::BTreeMap;

use hairpin::trajectory::program::{Motion, Move, Speed, Tool, WorkObject, Zone};

use super::Machine;
use crate::rapid::instructions::MoveKind;
use crate::rapid::kinds::DataKind;
use crate::rapid::lex::At;
use crate::rapid::lines::Class;
use crate::rapid::syntax::{Argument, Expression, Path};
use crate::rapid::value::{self, Unfit, Value, Variable};

/// Optional arguments that leave the path as it is.
const INERT: [&str; 5] = ["conc", "id", "inpos", "tload", "noeoffs"];
/// Optional arguments that are followed.
const HEEDED: [&str; 4] = ["v", "t", "z", "wobj"];

type Named<'b> = BTreeMap<&'b str, Option<&'b Expression>>;

impl Machine<'_> {
    /// Executes a move.
    pub(super) fn go(&mut self, kind: MoveKind, arguments: &[Argument], at: At) {
        let (placed, named) = self.sort(arguments);
        match self.movement(kind, &placed, &named, at) {
            Ok((m, doubts)) => {
                self.moves.push(m);
                match doubts.into_iter().next() {
                    None => self.mark(at, Class::Understood, ""),
                    Some(doubt) => {
                        // The move itself is not to be counted on either.
                        self.mark_before_last(at, doubt);
                    }
                }
            }
            Err(what) => self.mark(at, Class::ChangesMotion, what),
        }
    }

    fn mark_before_last(&mut self, at: At, what: String) {
        let first = self.unclear.is_none();
        self.mark(at, Class::ChangesMotion, what);
        if first {
            self.unclear = Some((self.moves.len() - 1, at.line));
        }
    }

    /// The move, and what about it is doubtful.
    fn movement(
        &mut self,
        kind: MoveKind,
        placed: &[&Expression],
        named: &Named<'_>,
        at: At,
    ) -> Result<(Move, Vec<String>), Unfit> {
        let mut doubts = Vec::new();
        let circular = usize::from(kind == MoveKind::Circular);
        let expected = 4 + circular;
        if placed.len() < expected {
            return Err(format!("a move needs {expected} arguments without a backslash, found {}", placed.len()));
        }
        let to = placed[circular];
        let motion = match kind {
            MoveKind::AbsoluteJoint => {
                let (value, name) = self.data(to, DataKind::JointTarget, at)?;
                Motion::AbsoluteJoint(
                    value::joint_target(&value, name.as_deref()).map_err(|what| self.about(to, what))?,
                )
            }
            MoveKind::Joint => Motion::Joint(self.pose_target(to, at)?),
            MoveKind::Linear => Motion::Linear(self.pose_target(to, at)?),
            MoveKind::Circular => {
                Motion::Circular { via: self.pose_target(placed[0], at)?, to: self.pose_target(to, at)? }
            }
        };
        let speed = self.speed(placed[1 + circular], named.get("v").copied().flatten(), at)?;
        let zone = self.zone(placed[2 + circular], named.get("z").copied().flatten(), at)?;
        let duration = match named.get("t").copied().flatten() {
            Some(duration) => Some(self.number(duration, at)?),
            None => None,
        };
        let tool = self.tool(placed[3 + circular], at, &mut doubts)?;
        let work_object = self.work_object(named.get("wobj").copied().flatten(), at, &mut doubts)?;
        for name in named.keys().filter(|name| !INERT.contains(*name) && !HEEDED.contains(*name)) {
            doubts.push(format!("\\{name} is not followed"));
        }
        let demanded = match kind {
            MoveKind::AbsoluteJoint => true,
            MoveKind::Joint => self.demanded.joint,
            MoveKind::Linear | MoveKind::Circular => self.demanded.linear,
        };
        let (tool, work_object) = (self.tool_index(tool), self.work_object_index(work_object));
        let m = Move {
            motion,
            speed,
            zone,
            duration,
            tool,
            work_object,
            configuration_demanded: demanded,
            line: Some(at.line),
        };
        Ok((m, doubts))
    }

    /// A value of the kind, with its name if it is data of the modules as it was declared.
    fn data(&mut self, expression: &Expression, kind: DataKind, at: At) -> Result<(Value, Option<String>), Unfit> {
        let name = match expression {
            Expression::Path(path) if path.steps.is_empty() => {
                if self.find(&path.name).is_none() {
                    return Err(format!("`{}` is not declared in this file", path.name));
                }
                self.declared(&path.name).map(|Variable { name, .. }| name.clone())
            }
            _ => None,
        };
        let value = self.evaluate(expression, at).into_kind(kind).map_err(|what| self.about(expression, what))?;
        if value == Value::Unknown {
            return Err(self.about(expression, "is not known from this file".into()));
        }
        Ok((value, name))
    }

    /// The reason with the name of what it is about.
    fn about(&self, expression: &Expression, what: Unfit) -> Unfit {
        match expression {
            Expression::Path(Path { name, .. }) | Expression::Call { name, .. } => format!("`{name}` {what}"),
            _ => format!("a value {what}"),
        }
    }

    fn pose_target(
        &mut self,
        expression: &Expression,
        at: At,
    ) -> Result<hairpin::trajectory::program::PoseTarget, Unfit> {
        let (value, name) = self.data(expression, DataKind::RobTarget, at)?;
        value::pose_target(&value, name.as_deref()).map_err(|what| self.about(expression, what))
    }

    fn number(&mut self, expression: &Expression, at: At) -> Result<f64, Unfit> {
        let number = self.evaluate(expression, at).number();
        number.ok_or_else(|| self.about(expression, "is not a number that is known".into()))
    }

    fn speed(&mut self, expression: &Expression, tcp: Option<&Expression>, at: At) -> Result<Speed, Unfit> {
        let predefined = self.undeclared(expression).and_then(Speed::predefined);
        let mut speed = match predefined {
            Some(speed) => speed,
            None => {
                let (value, name) = self.data(expression, DataKind::SpeedData, at)?;
                value::speed(&value, name.as_deref()).map_err(|what| self.about(expression, what))?
            }
        };
        if let Some(tcp) = tcp {
            speed = Speed { name: None, tcp: self.number(tcp, at)? / 1000.0, ..speed };
        }
        Ok(speed)
    }

    fn zone(&mut self, expression: &Expression, tcp: Option<&Expression>, at: At) -> Result<Zone, Unfit> {
        let predefined = self.undeclared(expression).and_then(Zone::predefined);
        let mut zone = match predefined {
            Some(zone) => zone,
            None => {
                let (value, name) = self.data(expression, DataKind::ZoneData, at)?;
                value::zone(&value, name.as_deref()).map_err(|what| self.about(expression, what))?
            }
        };
        if let Some(tcp) = tcp {
            zone = Zone { name: None, tcp: self.number(tcp, at)? / 1000.0, ..zone };
        }
        Ok(zone)
    }

    /// The name that the expression is, if the file does not declare it.
    fn undeclared<'b>(&self, expression: &'b Expression) -> Option<&'b str> {
        match expression {
            Expression::Path(Path { name, steps }) if steps.is_empty() && self.find(name).is_none() => Some(name),
            _ => None,
        }
    }

    fn tool(&mut self, expression: &Expression, at: At, doubts: &mut Vec<String>) -> Result<Tool, Unfit> {
        if let Some(name) = self.undeclared(expression) {
            let known = self.known.tools.iter().find(|tool| tool.name.eq_ignore_ascii_case(name));
            return Ok(match known {
                Some(tool) => Tool { declare: false, ..tool.clone() },
                None if name.eq_ignore_ascii_case("tool0") => Tool::flange(),
                None => {
                    doubts.push(format!("tool `{name}` is not declared in this file"));
                    Tool { name: name.into(), ..Tool::flange() }
                }
            });
        }
        let (value, name) = self.data(expression, DataKind::ToolData, at)?;
        let name = name.unwrap_or_else(|| "tChanged".into());
        let tool = value::tool(&value, &name).map_err(|what| self.about(expression, what))?;
        if !tool.held {
            doubts.push(format!("tool `{name}` stands in the cell"));
        }
        Ok(tool)
    }

    fn work_object(
        &mut self,
        expression: Option<&Expression>,
        at: At,
        doubts: &mut Vec<String>,
    ) -> Result<WorkObject, Unfit> {
        let Some(expression) = expression else { return Ok(WorkObject::base()) };
        if let Some(name) = self.undeclared(expression) {
            let known = self.known.work_objects.iter().find(|object| object.name.eq_ignore_ascii_case(name));
            return Ok(match known {
                Some(object) => WorkObject { declare: false, ..object.clone() },
                None if name.eq_ignore_ascii_case("wobj0") => WorkObject::base(),
                None => {
                    doubts.push(format!("work object `{name}` is not declared in this file"));
                    WorkObject { name: name.into(), ..WorkObject::base() }
                }
            });
        }
        let (value, name) = self.data(expression, DataKind::WobjData, at)?;
        let name = name.unwrap_or_else(|| "wChanged".into());
        let object = value::work_object(&value, &name).map_err(|what| self.about(expression, what))?;
        if object.held || object.moved_by.is_some() {
            doubts.push(format!("work object `{name}` moves"));
        }
        Ok(object)
    }

    /// Where the tool stands in the table; one that was changed on the way gets a name of its own.
    fn tool_index(&mut self, mut tool: Tool) -> usize {
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

    fn work_object_index(&mut self, mut object: WorkObject) -> usize {
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

    /// ConfL, ConfJ, SingArea, AccSet, VelSet; Incr, Decr, Add, Clear.
    pub(super) fn follow(&mut self, name: &str, arguments: &[Argument], at: At) {
        let (placed, named) = self.sort(arguments);
        let numbers: Vec<Option<f64>> = placed.iter().map(|value| self.evaluate(value, at).number()).collect();
        match name {
            "confl" | "confj" => {
                let on = !named.contains_key("off");
                *(if name == "confl" { &mut self.demanded.linear } else { &mut self.demanded.joint }) = on;
                self.mark(at, Class::Understood, "");
            }
            // What controllers start with changes nothing.
            "singarea" if named.contains_key("off") => self.mark(at, Class::Harmless, ""),
            "accset" if named.is_empty() && numbers == [Some(100.0); 2] => self.mark(at, Class::Harmless, ""),
            "velset" if numbers == [Some(100.0), Some(5000.0)] => self.mark(at, Class::Harmless, ""),
            "singarea" | "accset" | "velset" => self.mark(at, Class::ChangesMotion, format!("{name} is not followed")),
            _ => self.adjust(name, &placed, &numbers, at),
        }
    }

    fn adjust(&mut self, name: &str, placed: &[&Expression], numbers: &[Option<f64>], at: At) {
        let Some(Expression::Path(path)) = placed.first() else {
            return self.mark(at, Class::Harmless, "no variable");
        };
        let by = match name {
            "incr" => Some(1.0),
            "decr" => Some(-1.0),
            "add" => numbers.get(1).copied().flatten(),
            _ => None,
        };
        let value = match (name, numbers[0].zip(by)) {
            ("clear", _) => Value::Num(0.0),
            (_, Some((value, by))) => Value::Num(value + by),
            _ => Value::Unknown,
        };
        match self.assign(path, value, at) {
            Ok(()) => self.mark(at, Class::Understood, ""),
            Err(what) => self.mark(at, Class::Harmless, what),
        }
    }

    /// Arguments by place and by name; conditional ones if their condition holds.
    fn sort<'b>(&self, arguments: &'b [Argument]) -> (Vec<&'b Expression>, Named<'b>) {
        let (mut placed, mut named) = (Vec::new(), BTreeMap::new());
        for argument in arguments {
            match argument {
                Argument::Placed(value) => placed.push(value),
                Argument::Named { name, value } => {
                    named.insert(name.as_str(), value.as_ref());
                }
                Argument::IfGiven { name, parameter } => {
                    if self.is_given(parameter) {
                        named.insert(name.as_str(), Some(parameter));
                    }
                }
            }
        }
        (placed, named)
    }
}
