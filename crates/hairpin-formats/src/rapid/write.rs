//! A program as a module that RobotStudio and controllers load: ASCII, CR LF, every name checked.

use std::collections::BTreeMap;

use hairpin::trajectory::program::{JointTarget, Motion, Move, PoseTarget, Program, ProgramError, Speed, Zone};
use thiserror::Error;

use super::names::{LONGEST_NAME, NameError, check_name};
use super::text;
use crate::banner::{comments, plain};

/// The speed of the first run.
pub const FIRST_RUN: &str = "v50";

/// Why a program cannot be written.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum RapidError {
    /// A controller would not execute it.
    #[error(transparent)]
    Program(#[from] ProgramError),
    /// A name that cannot be declared.
    #[error("{what}: {cause}")]
    Name {
        /// What is to have the name.
        what: &'static str,
        /// Why it cannot.
        cause: NameError,
    },
    /// An arc or a start that refers to a point that is not there.
    #[error("point {index} of {count}")]
    Point {
        /// The point.
        index: usize,
        /// How many there are.
        count: usize,
    },
    /// Two different things of one name.
    #[error("`{name}` names two different things")]
    Twice {
        /// The name.
        name: String,
    },
    /// A speed without end can only be `vmax`.
    #[error("move {index}: only the predefined vmax is without end; the speed `{name}` must be a number")]
    Endless {
        /// Index of the move.
        index: usize,
        /// Name of the speed.
        name: String,
    },
}

/// The module. `header` becomes comments (evidence, where it comes from), before the notice that it is a test program.
///
/// # Errors
/// [`RapidError`]: nothing is written that a controller would stop at, as far as can be told without the arm.
pub fn module(program: &Program, header: &[String]) -> Result<String, RapidError> {
    if let Some(problem) = program.problems().into_iter().next() {
        return Err(problem.into());
    }
    Ok(written(program)?.assemble(&program.name, &program.procedure, header, &[]))
}

/// Whether a module can have the names that a program has: all that it declares, and what it finds on the controller.
///
/// # Errors
/// As of [`module`], where that is about a name.
///
/// # Panics
/// Where a move has a tool or a work object that the program has not.
pub fn check_names(program: &Program) -> Result<(), RapidError> {
    written(program).map(drop)
}

fn written(program: &Program) -> Result<Writer, RapidError> {
    let mut writer = Writer::new(&program.name, &program.procedure)?;
    let mut demanded = (true, true);
    for (index, m) in program.moves.iter().enumerate() {
        writer.configuration(m, &mut demanded);
        writer.go(program, index, m)?;
    }
    Ok(writer)
}

/// The same program for its first run: no speed above `cap` ([`FIRST_RUN`] where nothing else is asked for).
pub fn slow(program: &Program, cap: &Speed) -> Program {
    program.slowed(cap, LONGEST_NAME)
}

/// A program file that names the module's file, as controllers load them.
pub fn program_file(module_file: &str) -> String {
    let escaped = plain(module_file).replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;");
    let lines = [
        "<?xml version=\"1.0\" encoding=\"ISO-8859-1\" ?>",
        "<Program>",
        &format!("\t<Module>{escaped}</Module>"),
        "</Program>",
        "",
    ];
    lines.join("\r\n")
}

/// A module in the making.
pub(super) struct Writer {
    /// Names in lower case, and what they were declared as.
    declared: BTreeMap<String, String>,
    /// Statements of the procedure.
    pub(super) lines: Vec<String>,
    /// Declarations, in the order of their first use.
    pub(super) data: Vec<String>,
}

impl Writer {
    pub(super) fn new(module: &str, procedure: &str) -> Result<Self, RapidError> {
        let mut writer = Self { declared: BTreeMap::new(), lines: Vec::new(), data: Vec::new() };
        writer.reserve("module", module)?;
        writer.reserve("procedure", procedure)?;
        Ok(writer)
    }

    /// The module's text; `routines` follow the procedure.
    pub(super) fn assemble(self, module: &str, procedure: &str, header: &[String], routines: &[String]) -> String {
        let mut lines = vec![format!("MODULE {module}")];
        lines.extend(comments("  !", header));
        lines.extend(self.data.iter().map(|line| format!("  {line}")));
        lines.push(String::new());
        lines.push(format!("  PROC {procedure}()"));
        lines.extend(self.lines.iter().map(|line| format!("    {line}")));
        lines.push("  ENDPROC".into());
        lines.extend(routines.iter().map(|line| format!("  {line}")));
        lines.extend(["ENDMODULE".into(), String::new()]);
        lines.join("\r\n")
    }

    pub(super) fn reserve(&mut self, what: &'static str, name: &str) -> Result<(), RapidError> {
        check_name(name).map_err(|cause| RapidError::Name { what, cause })?;
        match self.declared.insert(name.to_ascii_lowercase(), String::new()) {
            None => Ok(()),
            Some(_) => Err(RapidError::Twice { name: name.into() }),
        }
    }

    /// The name, declared at its first use.
    fn declare(&mut self, what: &'static str, kind: &str, name: &str, value: &str) -> Result<String, RapidError> {
        check_name(name).map_err(|cause| RapidError::Name { what, cause })?;
        // Tools and work objects must be PERS; LOCAL would hide them from jogging.
        let storage = if ["tooldata", "wobjdata"].contains(&kind) { "TASK PERS" } else { "LOCAL CONST" };
        let line = format!("{storage} {kind} {name} := {value};");
        match self.declared.get(&name.to_ascii_lowercase()) {
            Some(before) if *before == line => {}
            Some(_) => return Err(RapidError::Twice { name: name.into() }),
            None => {
                self.declared.insert(name.to_ascii_lowercase(), line.clone());
                self.data.push(line);
            }
        }
        Ok(name.into())
    }

    /// A name that is found on the controller: what nothing can be declared as there has no such name either, but for
    /// its `own`. The module declares nothing else under it.
    fn on_controller(&mut self, what: &'static str, name: &str, own: &str) -> Result<String, RapidError> {
        if !name.eq_ignore_ascii_case(own) {
            check_name(name).map_err(|cause| RapidError::Name { what, cause })?;
        }
        let line = format!("the controller's {what}");
        match self.declared.insert(name.to_ascii_lowercase(), line.clone()) {
            Some(before) if before != line => Err(RapidError::Twice { name: name.into() }),
            _ => Ok(name.into()),
        }
    }

    pub(super) fn pose(&mut self, target: &PoseTarget) -> Result<String, RapidError> {
        let value = text::robtarget(target);
        match &target.name {
            Some(name) => self.declare("target", "robtarget", name, &value),
            None => Ok(value),
        }
    }

    fn joints(&mut self, target: &JointTarget) -> Result<String, RapidError> {
        let value = text::jointtarget(target);
        match &target.name {
            Some(name) => self.declare("target", "jointtarget", name, &value),
            None => Ok(value),
        }
    }

    fn speed(&mut self, index: usize, speed: &Speed) -> Result<String, RapidError> {
        let name = speed.name.as_deref();
        if let Some(known) = name.and_then(Speed::predefined).filter(|known| known.same_as(speed)) {
            return Ok(known.name.unwrap_or_default());
        }
        if !speed.tcp.is_finite() {
            return Err(RapidError::Endless { index, name: name.unwrap_or_default().into() });
        }
        let value = text::speeddata(speed);
        match name {
            Some(name) => self.declare("speed", "speeddata", name, &value),
            None => Ok(value),
        }
    }

    fn zone(&mut self, zone: &Zone) -> Result<String, RapidError> {
        let name = zone.name.as_deref();
        if let Some(known) = name.and_then(Zone::predefined).filter(|known| known.same_as(zone)) {
            return Ok(known.name.unwrap_or_default());
        }
        let value = text::zonedata(zone);
        match name {
            Some(name) => self.declare("zone", "zonedata", name, &value),
            None => Ok(value),
        }
    }

    /// ConfL and ConfJ where the move wants them other than they are.
    fn configuration(&mut self, m: &Move, (linear, joint): &mut (bool, bool)) {
        let (name, state) = match m.motion {
            Motion::AbsoluteJoint(_) => return,
            Motion::Joint(_) => ("ConfJ", joint),
            Motion::Linear(_) | Motion::Circular { .. } => ("ConfL", linear),
        };
        if *state != m.configuration_demanded {
            *state = m.configuration_demanded;
            self.lines.push(format!("{name} \\{};", if *state { "On" } else { "Off" }));
        }
    }

    pub(super) fn go(&mut self, program: &Program, index: usize, m: &Move) -> Result<(), RapidError> {
        let target = match &m.motion {
            Motion::AbsoluteJoint(to) => format!("MoveAbsJ {}", self.joints(to)?),
            Motion::Joint(to) => format!("MoveJ {}", self.pose(to)?),
            Motion::Linear(to) => format!("MoveL {}", self.pose(to)?),
            Motion::Circular { via, to } => format!("MoveC {}, {}", self.pose(via)?, self.pose(to)?),
        };
        let speed = self.speed(index, &m.speed)?;
        let duration = m.duration.map_or(String::new(), |duration| format!(" \\T:={}", text::seconds(duration)));
        let zone = self.zone(&m.zone)?;
        let (tool, object) = (&program.tools[m.tool], &program.work_objects[m.work_object]);
        let tool_name = if tool.declare {
            self.declare("tool", "tooldata", &tool.name, &text::tooldata(tool))?
        } else {
            self.on_controller("tool", &tool.name, "tool0")?
        };
        let object_name = if object.declare {
            self.declare("work object", "wobjdata", &object.name, &text::wobjdata(object))?
        } else {
            self.on_controller("work object", &object.name, "wobj0")?
        };
        self.lines.push(format!("{target}, {speed}{duration}, {zone}, {tool_name} \\WObj:={object_name};"));
        Ok(())
    }
}
