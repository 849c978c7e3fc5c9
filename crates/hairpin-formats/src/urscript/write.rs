//! Programs written as URScript.

use hairpin::math::rotation::rotation_vector;
use hairpin::robot::arm::Arm;
use hairpin::trajectory::program::{Motion, Move, PoseTarget, Program, ProgramError, Tool};
use nalgebra::Isometry3;
use thiserror::Error;

use super::CONVENTIONS;
use crate::banner::comments;
use crate::capped;
use crate::decimal::decimal;

/// What URScript wants to know and a program does not say.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Speed of the leading axis in joint moves, rad/s.
    pub joint_speed: f64,
    /// Its acceleration, rad/s².
    pub joint_acceleration: f64,
    /// Acceleration of the tool's centre point, m/s².
    pub acceleration: f64,
    /// No move is faster, m/s: what `vmax` becomes.
    pub most_speed: f64,
}

impl Default for Settings {
    /// As PolyScope has them: 60 °/s, 80 °/s², 1.2 m/s², and 1 m/s.
    fn default() -> Self {
        Self {
            joint_speed: 60_f64.to_radians(),
            joint_acceleration: 80_f64.to_radians(),
            acceleration: 1.2,
            most_speed: 1.0,
        }
    }
}

/// Why a program cannot be written.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum UrscriptError {
    /// A controller would not execute it.
    #[error(transparent)]
    Program(#[from] ProgramError),
    /// The procedure's name cannot be a function's.
    #[error(
        "`{name}` must begin with a letter, consist of ASCII letters, digits and underscores, and be no keyword \
             and no function of URScript"
    )]
    Name {
        /// The name.
        name: String,
    },
    /// A setting out of its bound.
    #[error("{field} = {value}: must be a finite number above 0")]
    Setting {
        /// Which.
        field: &'static str,
        /// The value.
        value: f64,
    },
}

const KEYWORDS: [&str; 22] = [
    "and", "break", "continue", "def", "elif", "else", "end", "False", "for", "global", "halt", "if", "in", "local",
    "not", "or", "return", "sec", "thread", "True", "while", "xor",
];

/// Functions of URScript that programs call, or that a controller runs on its own: a program of that name would call
/// itself.
const FUNCTIONS: [&str; 16] = [
    "get_forward_kin",
    "get_inverse_kin",
    "movec",
    "movej",
    "movel",
    "movep",
    "pose_inv",
    "pose_trans",
    "set_payload",
    "set_tcp",
    "sleep",
    "stopj",
    "stopl",
    "sync",
    "textmsg",
    "norm",
];

/// Straight moves and arcs of `program` that are written slower than they are programmed: the names of their speeds.
pub fn slower(program: &Program, settings: &Settings) -> Vec<String> {
    capped::names(program, settings.most_speed)
}

/// The program as a function and its call. Corners are cut to half of the shorter neighbouring segment, as blends that
/// overlap stop the robot: where one leads from or to a posture its length takes the `arm`, without which there is no
/// corner.
///
/// # Errors
/// [`UrscriptError`].
pub fn text(
    program: &Program,
    settings: &Settings,
    arm: Option<&Arm>,
    header: &[String],
) -> Result<String, UrscriptError> {
    if let Some(problem) = program.problems().into_iter().next() {
        return Err(problem.into());
    }
    let name = &program.procedure;
    let spelt = name.starts_with(|c: char| c.is_ascii_alphabetic())
        && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
        && !KEYWORDS.contains(&name.as_str())
        && !FUNCTIONS.contains(&name.as_str());
    if !spelt {
        return Err(UrscriptError::Name { name: name.clone() });
    }
    for (field, value) in [
        ("joint_speed", settings.joint_speed),
        ("joint_acceleration", settings.joint_acceleration),
        ("acceleration", settings.acceleration),
        ("most_speed", settings.most_speed),
    ] {
        if !(value > 0.0 && value.is_finite()) {
            return Err(UrscriptError::Setting { field, value });
        }
    }
    let mut lines: Vec<String> = comments("#", header).collect();
    lines.extend(CONVENTIONS.map(|line| format!("# {line}")));
    lines.push(format!("def {name}():"));
    let mut tool = None;
    for (index, m) in program.moves.iter().enumerate() {
        if tool.replace(m.tool) != Some(m.tool) {
            let carried = &program.tools[m.tool];
            lines.push(format!("  set_tcp({})", pose(&carried.tcp)));
            let centre = carried.centre_of_gravity;
            let centre = [centre.x, centre.y, centre.z].map(metres).join(",");
            lines.push(format!("  set_target_payload({}, [{centre}]{})", decimal(carried.mass, 6), moments(carried)));
        }
        lines.push(format!("  {}", go((program, arm), index, m, settings)));
    }
    lines.extend(["end".into(), format!("{name}()"), String::new()]);
    Ok(lines.join("\n"))
}

/// Ixx, Iyy, Izz, Ixy, Ixz and Iyz, kg m², about the centre of gravity in the flange's axes; nothing of a point, which
/// is what the controller takes without them.
fn moments(tool: &Tool) -> String {
    if tool.inertia == [0.0; 3] {
        return String::new();
    }
    let tensor = tool.tensor_of_inertia();
    let six = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)].map(|place| decimal(tensor[place], 9));
    format!(", [{}]", six.join(","))
}

fn go((program, arm): (&Program, Option<&Arm>), index: usize, m: &Move, settings: &Settings) -> String {
    let base = program.work_objects[m.work_object].base_from_object();
    // The controller's base need not be that of a URDF.
    let controller_from_base = arm.map_or_else(Isometry3::identity, |arm| arm.base_from_controller.inverse());
    let seen = |target: &PoseTarget| match controller_from_base == Isometry3::identity() {
        // Rounding would change the signs of zeros.
        true => base * target.pose,
        false => controller_from_base * base * target.pose,
    };
    let at = |target: &PoseTarget| pose(&seen(target));
    let duration = m.duration.map_or(String::new(), |t| format!(", t={}", decimal(t, 6)));
    let radius = metres(blend(program, arm, index));
    let line = (settings.acceleration, m.speed.tcp.min(settings.most_speed));
    let joint = (settings.joint_acceleration, settings.joint_speed);
    let rates = |(a, v): (f64, f64)| format!("a={}, v={}", decimal(a, 6), decimal(v, 6));
    match &m.motion {
        Motion::AbsoluteJoint(to) => {
            let joints = to.joints.map(|q| decimal(q, 9)).join(",");
            format!("movej([{joints}], {}{duration}, r={radius})", rates(joint))
        }
        Motion::Joint(to) => format!("movej({}, {}{duration}, r={radius})", at(to), rates(joint)),
        Motion::Linear(to) => format!("movel({}, {}{duration}, r={radius})", at(to), rates(line)),
        // Arcs take no duration; the orientation goes evenly from start to end.
        Motion::Circular { via, to } => format!("movec({}, {}, {}, r={radius}, mode=0)", at(via), at(to), rates(line)),
    }
}

/// The corner's radius at the end of move number `index`, m.
fn blend(program: &Program, arm: Option<&Arm>, index: usize) -> f64 {
    let zone = &program.moves[index].zone;
    if zone.fine {
        return 0.0;
    }
    let place = |index: Option<usize>| {
        let m = index.and_then(|index| program.moves.get(index))?;
        let base = program.work_objects[m.work_object].base_from_object();
        let pose = match &m.motion {
            Motion::AbsoluteJoint(to) => arm?.forward(&to.joints) * program.tools[m.tool].tcp,
            _ => base * m.motion.end()?.pose,
        };
        Some(pose.translation.vector)
    };
    match (place(index.checked_sub(1)), place(Some(index)), place(Some(index + 1))) {
        (Some(before), Some(here), Some(after)) => {
            zone.tcp.min(0.5 * (here - before).norm()).min(0.5 * (after - here).norm())
        }
        _ => 0.0,
    }
}

fn metres(value: f64) -> String {
    decimal(value, 9)
}

fn pose(pose: &Isometry3<f64>) -> String {
    let (p, r) = (pose.translation.vector, rotation_vector(&pose.rotation));
    format!("p[{}]", [p.x, p.y, p.z, r.x, r.y, r.z].map(metres).join(","))
}
