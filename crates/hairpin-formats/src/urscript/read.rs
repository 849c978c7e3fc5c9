//! Programs read from URScript, line by line.

use hairpin::trajectory::program::{JointTarget, Motion, Move, NO_EXTERNAL, PoseTarget, Speed, Tool, WorkObject, Zone};
use nalgebra::{Matrix3, Rotation3, SymmetricEigen, UnitQuaternion, Vector3};
use thiserror::Error;

use super::CONVENTIONS;
use super::arguments::{Arguments, Value};
use crate::banner::NOTICE;
use crate::listing::{Class, Doubt, File, Module, Part, Reading, Unmodelled, calls, decode};

/// Why a file is no program.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum NoProgram {
    /// No `def name():` anywhere.
    #[error("no URScript program in it: no line says def and a name")]
    Absent,
}

/// Functions that neither move the arm nor change how it moves.
const HARMLESS: [&str; 14] = [
    "popup",
    "set_analog_out",
    "set_configurable_digital_out",
    "set_digital_out",
    "set_standard_analog_out",
    "set_standard_digital_out",
    "set_tool_digital_out",
    "sleep",
    "socket_close",
    "socket_open",
    "socket_send_string",
    "sync",
    "textmsg",
    "write_output_boolean_register",
];

/// Functions that give a value and do nothing, beside [`READING`], and words that may stand before brackets.
const VALUES: [&str; 41] = [
    "abs",
    "acos",
    "and",
    "asin",
    "atan",
    "atan2",
    "binary_list_to_integer",
    "ceil",
    "cos",
    "d2r",
    "floor",
    "force",
    "integer_to_binary_list",
    "interpolate_pose",
    "inv",
    "length",
    "log",
    "norm",
    "normalize",
    "not",
    "or",
    "point_dist",
    "pose_add",
    "pose_dist",
    "pose_inv",
    "pose_sub",
    "pose_trans",
    "pow",
    "r2d",
    "random",
    "rotvec2rpy",
    "rpy2rotvec",
    "sin",
    "size",
    "socket_get_var",
    "sqrt",
    "tan",
    "time",
    "transpose",
    "wrench_trans",
    "xor",
];

/// What the names of functions begin with that read.
const READING: [&str; 7] = ["get_", "is_", "modbus_get_", "read_", "socket_read_", "str_", "to_"];

/// Functions that change motion in ways that no model here has, by what their names begin with.
const CHANGES: [(Unmodelled, &[&str]); 8] = [
    (Unmodelled::Conveyors, &["track_conveyor", "stop_conveyor", "set_conveyor", "conveyor_"]),
    (Unmodelled::ForceControl, &["force_mode", "end_force_mode", "screw_driving", "tool_contact", "zero_ftsensor"]),
    (
        Unmodelled::Guidance,
        &["servo", "speed", "freedrive", "end_freedrive", "teach_mode", "end_teach_mode", "path_offset"],
    ),
    (Unmodelled::Interpolation, &["movep", "optimove"]),
    (Unmodelled::Payload, &["set_payload", "set_target_payload", "set_gravity"]),
    (Unmodelled::Restarts, &["stopj", "stopl", "undo"]),
    (Unmodelled::Displacements, &["set_tcp", "set_base", "pose_"]),
    (Unmodelled::ExternalAxes, &["axis_group"]),
];

/// Reads a program: the first function that the file defines.
///
/// # Errors
/// [`NoProgram`]; all else that is not followed is told by line, and the moves before it are certain.
pub fn read(file: File<'_>) -> Result<Module, NoProgram> {
    let text = decode(file.bytes);
    let mut reader = Reader::default();
    reader.reading.parts.push(Part { name: file.name.into(), first_line: 1 });
    reader.reading.program.work_objects.push(WorkObject::base());
    let mut defined: Option<(usize, String)> = None;
    let (mut depth, mut within) = (0_usize, false);
    for (index, line) in text.split('\n').enumerate() {
        let number = index + 1;
        if defined.is_none() && line.starts_with('#') {
            reader.head(line);
        }
        let statement = without_comment(line);
        let outside = depth == 0;
        if statement == "end" {
            depth = depth.saturating_sub(1);
            within &= depth > 0;
            continue;
        }
        depth += usize::from(begins_block(statement));
        match (name_of(statement), &defined) {
            _ if statement.is_empty() => {}
            (Some(name), None) if outside => {
                defined = Some((number, name));
                within = true;
            }
            _ if within => reader.statement(number, statement),
            _ if !outside || statement.starts_with("def ") => {
                reader.reading.mark(number, Class::Unreached, "another function");
            }
            // The call of the function that was read.
            (None, Some((_, name))) if statement.strip_suffix("()") == Some(name) => {
                reader.reading.mark(number, Class::Understood, "");
            }
            _ => reader.reading.doubt(number, not_followed(statement)),
        }
    }
    let (line, name) = defined.ok_or(NoProgram::Absent)?;
    if depth > 0 {
        reader.reading.cut_short(&text, "end");
    }
    reader.reading.program.name.clone_from(&name);
    reader.reading.program.procedure = name;
    Ok(reader.reading.done(line))
}

#[derive(Debug, Default)]
struct Reader {
    reading: Reading,
    /// Index of the tool that is set.
    tool: Option<usize>,
    /// Whether the line before set it: what it weighs may follow.
    fresh: bool,
}

impl Reader {
    fn head(&mut self, line: &str) {
        let comment = line.trim_start_matches('#');
        let comment = comment.strip_prefix(' ').unwrap_or(comment).trim_end();
        if comment != NOTICE && !CONVENTIONS.contains(&comment) {
            self.reading.header.push(comment.into());
        }
    }

    fn statement(&mut self, line: usize, statement: &str) {
        let fresh = std::mem::take(&mut self.fresh);
        let call = statement.split_once('(').and_then(|(name, rest)| Some((name.trim(), rest.strip_suffix(')')?)));
        let Some((name, inside)) = call else { return self.reading.doubt(line, not_followed(statement)) };
        if let Some(within) = calls(inside).into_iter().find(|within| !is_quiet(within)) {
            return self.reading.doubt(line, not_followed(within));
        }
        let done = match name {
            "set_tcp" => self.set_tcp(line, inside),
            "set_target_payload" if fresh => self.weigh(line, inside),
            "movej" | "movel" | "movec" => self.go(line, name, inside),
            _ if HARMLESS.contains(&name) => {
                self.reading.mark(line, Class::Harmless, "");
                Ok(())
            }
            _ => {
                self.reading.doubt(line, not_followed(statement));
                Ok(())
            }
        };
        if let Err(what) = done {
            self.reading.mistake(line, format!("{name}: {what}"));
        }
    }

    fn set_tcp(&mut self, line: usize, inside: &str) -> Result<(), String> {
        let arguments = Arguments::of(inside)?;
        let Some(Value::Pose(tcp)) = arguments.get(0, "pose") else { return Err("expected a pose, p[…]".into()) };
        if let Some(unknown) = arguments.unknown(&["pose", "tcp_name"]) {
            return Err(format!("{unknown} is not followed"));
        }
        let tools = &mut self.reading.program.tools;
        tools.push(Tool { name: format!("tool{}", tools.len() + 1), declare: true, tcp: *tcp, ..Tool::flange() });
        self.tool = Some(tools.len() - 1);
        self.fresh = true;
        self.reading.mark(line, Class::Understood, "");
        Ok(())
    }

    /// What the tool that was set just now weighs.
    fn weigh(&mut self, line: usize, inside: &str) -> Result<(), String> {
        let arguments = Arguments::of(inside)?;
        let mass = arguments.number(0, "m")?.ok_or("expected a mass")?;
        let centre = match arguments.get(1, "cog") {
            Some(Value::List(centre)) => <[f64; 3]>::try_from(centre.as_slice()).ok(),
            _ => None,
        };
        let centre = centre.ok_or("expected a centre of gravity, [x, y, z]")?;
        let (axes, moments) = match arguments.get(2, "inertia") {
            None => (UnitQuaternion::identity(), [0.0; 3]),
            Some(Value::List(six)) => principal(six)?,
            Some(_) => return Err("expected moments of inertia, [Ixx, Iyy, Izz, Ixy, Ixz, Iyz]".into()),
        };
        if let Some(unknown) = arguments.unknown(&["m", "cog", "inertia"]) {
            return Err(format!("{unknown} is not followed"));
        }
        if let Some(tool) = self.tool.and_then(|index| self.reading.program.tools.get_mut(index)) {
            (tool.mass, tool.centre_of_gravity) = (mass, Vector3::from(centre));
            (tool.axes_of_inertia, tool.inertia) = (axes, moments);
        }
        self.reading.mark(line, Class::Understood, "");
        Ok(())
    }

    fn go(&mut self, line: usize, name: &str, inside: &str) -> Result<(), String> {
        let arguments = Arguments::of(inside)?;
        let mut doubts: Vec<Doubt> = Vec::new();
        let known: &[&str] = match name {
            "movec" => &["pose_via", "pose_to", "a", "v", "r", "mode"],
            "movej" => &["q", "a", "v", "t", "r"],
            _ => &["pose", "a", "v", "t", "r"],
        };
        if let Some(unknown) = arguments.unknown(known) {
            doubts.push((None, format!("{unknown} is not followed")));
        }
        let pose = |place: usize, name: &str| match arguments.get(place, name) {
            Some(Value::Pose(pose)) => Ok(PoseTarget::unnamed(*pose)),
            _ => Err("expected a pose, p[…]".to_owned()),
        };
        let motion = match (name, arguments.get(0, "q")) {
            ("movej", Some(Value::List(joints))) => {
                let six = <[f64; 6]>::try_from(joints.as_slice());
                let joints = six.map_err(|_| format!("expected 6 angles, found {}", joints.len()))?;
                Motion::AbsoluteJoint(JointTarget { name: None, joints, external: NO_EXTERNAL })
            }
            ("movej", _) => Motion::Joint(pose(0, "q").map_err(|_| "expected [6 angles] or a pose, p[…]".to_owned())?),
            ("movec", _) => Motion::Circular { via: pose(0, "pose_via")?, to: pose(1, "pose_to")? },
            _ => Motion::Linear(pose(0, "pose")?),
        };
        let circular = name == "movec";
        let at = if circular { 2 } else { 1 };
        arguments.number(at, "a")?;
        let speed = arguments.number(at + 1, "v")?;
        let duration = if circular { None } else { arguments.number(3, "t")?.filter(|t| *t > 0.0) };
        let radius = arguments.number(4, "r")?.unwrap_or(0.0);
        if circular && arguments.number(5, "mode")?.is_some_and(|mode| mode != 0.0) {
            doubts.push((Some(Unmodelled::Interpolation), "mode 1: the orientation turns with the arc".into()));
        }
        if self.tool.is_none() {
            doubts.push((None, "the tool's centre point is not set in this file".into()));
        }
        let tool = self.tool.unwrap_or_else(|| {
            self.reading.program.tools.push(Tool::flange());
            self.reading.program.tools.len() - 1
        });
        self.tool = Some(tool);
        let zone = Zone {
            name: None,
            fine: false,
            tcp: radius,
            path_orientation: radius,
            path_external: radius,
            ..Zone::stop()
        };
        let zone = if radius > 0.0 { zone } else { Zone::stop() };
        // The speed of joint moves is the leading axis', none of the tool's.
        let speed = if name == "movej" { None } else { speed };
        let speed = speed_of(speed);
        let m = Move { tool, duration, configuration_demanded: false, ..Move::new(motion, speed, zone) };
        self.reading.go(line, m, doubts);
        Ok(())
    }
}

/// Whether a call amid others neither moves the arm nor changes how it moves.
fn is_quiet(name: &str) -> bool {
    VALUES.contains(&name) || HARMLESS.contains(&name) || READING.iter().any(|begin| name.starts_with(begin))
}

/// As fast as the arm can, but for the tool's centre point.
fn speed_of(tcp: Option<f64>) -> Speed {
    let fast = Speed::predefined("vmax").unwrap_or(Speed {
        name: None,
        tcp: f64::INFINITY,
        orientation: 1e3,
        linear_external: 0.0,
        rotating_external: 0.0,
    });
    match tcp {
        Some(tcp) => Speed { name: None, tcp, ..fast },
        None => fast,
    }
}

/// Why a statement is not followed.
fn not_followed(statement: &str) -> Doubt {
    let end = statement.find(|c: char| !(c.is_alphanumeric() || c == '_'));
    let name = &statement[..end.unwrap_or(statement.len())];
    let known = CHANGES.iter().find(|(_, begins)| begins.iter().any(|begin| name.starts_with(begin)));
    (known.map(|(what, _)| *what), format!("`{}` is not followed", name.escape_default()))
}

/// The line without its comment and blanks; a `#` between quotes begins none.
fn without_comment(line: &str) -> &str {
    let mut quoted = false;
    let end = line.char_indices().find(|(_, c)| {
        quoted ^= *c == '"';
        *c == '#' && !quoted
    });
    line[..end.map_or(line.len(), |(at, _)| at)].trim()
}

/// Whether an `end` belongs to it.
fn begins_block(statement: &str) -> bool {
    let word = statement.split(|c: char| !c.is_alphanumeric()).next().unwrap_or_default();
    statement.ends_with(':') && ["def", "for", "if", "sec", "thread", "while"].contains(&word)
}

/// `def name():`: its name.
fn name_of(statement: &str) -> Option<String> {
    let name = statement.strip_prefix("def ")?.split('(').next()?.trim();
    name.starts_with(char::is_alphabetic).then(|| name.to_owned())
}

/// What moments may be below 0 by, as a share of the largest: they are written with so many digits.
const WRITTEN: f64 = 1e-6;

/// `flange_from_axes` and the principal moments of inertia, of Ixx, Iyy, Izz, Ixy, Ixz, Iyz; kg m².
fn principal(six: &[f64]) -> Result<(UnitQuaternion<f64>, [f64; 3]), String> {
    let &[xx, yy, zz, xy, xz, yz] = six else {
        return Err(format!("expected six moments of inertia, found {}", six.len()));
    };
    let tensor = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
    let (axes, moments) = if [xy, xz, yz] == [0.0; 3] {
        (UnitQuaternion::identity(), Vector3::new(xx, yy, zz))
    } else {
        let SymmetricEigen { mut eigenvectors, eigenvalues } = SymmetricEigen::new(tensor);
        if eigenvectors.determinant() < 0.0 {
            eigenvectors.column_mut(2).neg_mut();
        }
        (UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(eigenvectors)), eigenvalues)
    };
    let least = moments.min();
    if least < -WRITTEN * moments.max() {
        return Err(format!("a moment of inertia is {least} kg m², and no body has one below 0"));
    }
    Ok((axes, moments.map(|moment| moment.max(0.0)).into()))
}
