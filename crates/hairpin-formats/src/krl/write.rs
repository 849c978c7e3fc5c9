//! Programs written as KRL.

use std::collections::BTreeMap;

use hairpin::math::rotation::euler_from_quaternion;
use hairpin::trajectory::program::{External, Motion, PoseTarget, Program, ProgramError, Tool};
use nalgebra::Isometry3;
use thiserror::Error;

use super::{CONVENTIONS, JOINT_MOVES, PREFIX, UNNAMED};
use crate::banner::comments;
use crate::capped;
use crate::decimal::decimal;

/// Longest name.
pub const LONGEST_NAME: usize = 24;

/// What KRL wants to know and a program does not say.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Speed of joint moves, percent of the axes' own.
    pub joint_percent: f64,
    /// No move is faster, m/s: what `vmax` becomes.
    pub most_speed: f64,
}

impl Default for Settings {
    /// 30 % and 2 m/s.
    fn default() -> Self {
        Self { joint_percent: 30.0, most_speed: 2.0 }
    }
}

/// The two files of a program; both are named after it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Files {
    /// Statements.
    pub src: String,
    /// Positions.
    pub dat: String,
}

/// Why a program cannot be written.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum KrlError {
    /// A controller would not execute it.
    #[error(transparent)]
    Program(#[from] ProgramError),
    /// Not a name of KRL's.
    #[error("`{name}` must have {LONGEST_NAME} ASCII letters, digits and underscores at most, and begin with a letter")]
    Name {
        /// The name.
        name: String,
    },
    /// Two different targets of one name.
    #[error("`{name}` names two different targets")]
    Twice {
        /// The name.
        name: String,
    },
    /// A setting out of its bound.
    #[error("{field} = {value}: must be {bound}")]
    Setting {
        /// Which.
        field: &'static str,
        /// The value.
        value: f64,
        /// What it must be.
        bound: &'static str,
    },
    /// The first move of a program must say where every axis goes.
    #[error("the first move goes to a pose: KRL takes a posture there, since status and turn are not known")]
    FirstPose,
}

/// Straight moves and arcs of `program` that are written slower than they are programmed: the names of their speeds.
pub fn slower(program: &Program, settings: &Settings) -> Vec<String> {
    capped::names(program, settings.most_speed)
}

/// The program's files. Straight moves and arcs fly by at the zone's distance; joint moves stop.
///
/// # Errors
/// [`KrlError`].
pub fn files(program: &Program, settings: &Settings, header: &[String]) -> Result<Files, KrlError> {
    if let Some(problem) = program.problems().into_iter().next() {
        return Err(problem.into());
    }
    let hold =
        |good: bool, field, value, bound| if good { Ok(()) } else { Err(KrlError::Setting { field, value, bound }) };
    let Settings { joint_percent, most_speed } = *settings;
    hold(joint_percent > 0.0 && joint_percent <= 100.0, "joint_percent", joint_percent, "more than 0 and at most 100")?;
    hold(most_speed > 0.0 && most_speed <= 3.0, "most_speed", most_speed, "more than 0 m/s and at most 3")?;
    if program.moves.first().is_some_and(|m| m.motion.end().is_some()) {
        return Err(KrlError::FirstPose);
    }
    let mut writer =
        Writer { program, settings, data: Vec::new(), lines: Vec::new(), names: BTreeMap::new(), unnamed: 0 };
    let name = writer.named(&program.name)?;
    writer.moves()?;
    let comments: Vec<String> = comments(";", header)
        .chain([
            format!("; {}", CONVENTIONS[0]),
            format!("; {}", CONVENTIONS[1]),
            format!("; {JOINT_MOVES} {} % of the axes' speeds and stop.", decimal(joint_percent, 3)),
        ])
        .collect();
    let src = ["&ACCESS RVP".into(), "&REL 1".into(), format!("DEF {name} ( )")]
        .into_iter()
        .chain(comments)
        .chain(["BAS (#INITMOV,0)".into(), format!("BAS (#VEL_PTP,{})", decimal(joint_percent, 3))])
        .chain(writer.lines)
        .chain(["END".into(), String::new()]);
    let dat = ["&ACCESS RVP".into(), "&REL 1".into(), format!("DEFDAT {name}")]
        .into_iter()
        .chain(writer.data)
        .chain(["ENDDAT".into(), String::new()]);
    let join = |lines: &mut dyn Iterator<Item = String>| lines.collect::<Vec<_>>().join("\r\n");
    Ok(Files { src: join(&mut src.into_iter()), dat: join(&mut dat.into_iter()) })
}

struct Writer<'a> {
    program: &'a Program,
    settings: &'a Settings,
    data: Vec<String>,
    lines: Vec<String>,
    /// Names in lower case with what they stand for.
    names: BTreeMap<String, String>,
    unnamed: usize,
}

impl Writer<'_> {
    fn named(&self, name: &str) -> Result<String, KrlError> {
        let spelt = name.starts_with(|c: char| c.is_ascii_alphabetic())
            && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
            && name.len() <= LONGEST_NAME;
        if spelt { Ok(name.into()) } else { Err(KrlError::Name { name: name.into() }) }
    }

    fn declare(&mut self, kind: &str, name: Option<&str>, value: String) -> Result<String, KrlError> {
        let name = match name {
            // The X keeps it clear of keywords, as the controller's own editor does.
            Some(name) => self.named(&format!("{PREFIX}{name}"))?,
            None => {
                self.unnamed += 1;
                format!("{UNNAMED}{}", self.unnamed)
            }
        };
        match self.names.get(&name.to_ascii_lowercase()) {
            Some(before) if *before == value => {}
            Some(_) => return Err(KrlError::Twice { name }),
            None => {
                self.data.push(format!("DECL {kind} {name}={value}"));
                self.names.insert(name.to_ascii_lowercase(), value);
            }
        }
        Ok(name)
    }

    fn pose(&mut self, target: &PoseTarget) -> Result<String, KrlError> {
        let value = format!("{{{},{}}}", frame(&target.pose), external(&target.external));
        self.declare("E6POS", target.name.as_deref(), value)
    }

    fn moves(&mut self) -> Result<(), KrlError> {
        let mut state: BTreeMap<&str, String> = BTreeMap::new();
        let program = self.program;
        for m in &program.moves {
            let fly = if m.zone.fine { "" } else { " C_DIS" };
            let tool = &program.tools[m.tool];
            let mut settings = Vec::new();
            // What has no load says none, unless another one was said before.
            if is_loaded(tool) || state.contains_key("$LOAD") {
                settings.push(("$LOAD", load(tool)));
            }
            settings.extend([
                ("$TOOL", format!("{{{}}}", frame(&tool.tcp))),
                ("$BASE", format!("{{{}}}", frame(&program.work_objects[m.work_object].base_from_object()))),
            ]);
            if matches!(m.motion, Motion::Linear(_) | Motion::Circular { .. }) {
                settings.push(("$VEL.CP", decimal(m.speed.tcp.min(self.settings.most_speed), 6)));
                settings.push(("$VEL.ORI1", decimal(m.speed.orientation.to_degrees(), 6)));
                settings.push(("$VEL.ORI2", decimal(m.speed.orientation.to_degrees(), 6)));
                if !m.zone.fine {
                    settings.push(("$APO.CDIS", decimal(m.zone.tcp * 1000.0, 6)));
                }
            }
            for (name, value) in settings {
                if state.get(name) != Some(&value) {
                    self.lines.push(format!("{name}={value}"));
                    state.insert(name, value);
                }
            }
            let line = match &m.motion {
                Motion::AbsoluteJoint(to) => {
                    let axes: Vec<_> = to
                        .joints
                        .iter()
                        .enumerate()
                        .map(|(i, q)| format!("A{} {}", i + 1, decimal(q.to_degrees(), 6)))
                        .collect();
                    let value = format!("{{{},{}}}", axes.join(","), external(&to.external));
                    format!("PTP {}", self.declare("E6AXIS", to.name.as_deref(), value)?)
                }
                Motion::Joint(to) => format!("PTP {}", self.pose(to)?),
                Motion::Linear(to) => format!("LIN {}{fly}", self.pose(to)?),
                Motion::Circular { via, to } => format!("CIRC {},{}{fly}", self.pose(via)?, self.pose(to)?),
            };
            self.lines.push(line);
        }
        Ok(())
    }
}

/// Whether more is known of a tool's load than that controllers want one.
fn is_loaded(tool: &Tool) -> bool {
    let flange = Tool::flange();
    (tool.mass, tool.centre_of_gravity, tool.inertia) != (flange.mass, flange.centre_of_gravity, flange.inertia)
}

/// Mass in kg, centre of gravity on the flange in mm with the axes of inertia, moments about it in kg m².
fn load(tool: &Tool) -> String {
    let centre = Isometry3::from_parts(tool.centre_of_gravity.into(), tool.axes_of_inertia);
    let [x, y, z] = tool.inertia.map(|moment| decimal(moment, 6));
    format!("{{M {},CM {{{}}},J {{X {x},Y {y},Z {z}}}}}", decimal(tool.mass, 6), frame(&centre))
}

fn frame(pose: &Isometry3<f64>) -> String {
    let (p, q) = (pose.translation.vector * 1000.0, pose.rotation);
    let [c, b, a] = euler_from_quaternion(&[q.w, q.i, q.j, q.k]).map(f64::to_degrees);
    let numbers = [("X", p.x), ("Y", p.y), ("Z", p.z), ("A", a), ("B", b), ("C", c)];
    numbers.map(|(name, value)| format!("{name} {}", decimal(value, 6))).join(",")
}

/// External axes; one that is not in use is 0.
fn external(axes: &External) -> String {
    let one = |(index, axis): (usize, &Option<f64>)| format!("E{} {}", index + 1, decimal(axis.unwrap_or(0.0), 6));
    axes.iter().enumerate().map(one).collect::<Vec<_>>().join(",")
}
