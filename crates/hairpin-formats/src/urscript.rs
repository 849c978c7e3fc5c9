//! Programs as URScript of Universal Robots: metres, radians, rotation vectors, poses in the base.

use hairpin::math::rotation::rotation_vector;
use hairpin::trajectory::program::{Motion, Move, PoseTarget, Program, ProgramError};
use nalgebra::Isometry3;
use thiserror::Error;

use crate::banner::comments;
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
    #[error("`{name}` must begin with a letter, consist of ASCII letters, digits and underscores, and be no keyword")]
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

/// The program as a function and its call. Corners are cut to half of the shorter neighbouring segment, and to none
/// where a segment's length takes the arm's kinematics: blends that overlap stop the robot.
///
/// # Errors
/// [`UrscriptError`].
pub fn text(program: &Program, settings: &Settings, header: &[String]) -> Result<String, UrscriptError> {
    if let Some(problem) = program.problems().into_iter().next() {
        return Err(problem.into());
    }
    let name = &program.procedure;
    let spelt = name.starts_with(|c: char| c.is_ascii_alphabetic())
        && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
        && !KEYWORDS.contains(&name.as_str());
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
    lines.push("# Poses p[x,y,z,rx,ry,rz] in the robot's base, m and rad (rotation vector); joints in rad.".into());
    lines.push(
        "# Joint moves take the speed of the leading axis below, not the programmed one of the tool's centre point;"
            .into(),
    );
    lines.push("# to a pose they go by the inverse kinematics nearest to where the arm is.".into());
    lines.push(format!("def {name}():"));
    let mut tool = None;
    for (index, m) in program.moves.iter().enumerate() {
        if tool.replace(m.tool) != Some(m.tool) {
            let carried = &program.tools[m.tool];
            lines.push(format!("  set_tcp({})", pose(&carried.tcp)));
            let centre = carried.centre_of_gravity;
            let centre = [centre.x, centre.y, centre.z].map(metres).join(",");
            lines.push(format!("  set_target_payload({}, [{centre}])", decimal(carried.mass, 6)));
        }
        lines.push(format!("  {}", go(program, index, m, settings)));
    }
    lines.extend(["end".into(), format!("{name}()"), String::new()]);
    Ok(lines.join("\n"))
}

fn go(program: &Program, index: usize, m: &Move, settings: &Settings) -> String {
    let base = program.work_objects[m.work_object].base_from_object();
    let at = |target: &PoseTarget| pose(&(base * target.pose));
    let duration = m.duration.map_or(String::new(), |t| format!(", t={}", decimal(t, 6)));
    let radius = metres(blend(program, index, m));
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

/// The corner's radius, m.
fn blend(program: &Program, index: usize, m: &Move) -> f64 {
    if m.zone.fine {
        return 0.0;
    }
    let place = |index: Option<usize>| {
        let m = index.and_then(|index| program.moves.get(index))?;
        let base = program.work_objects[m.work_object].base_from_object();
        m.motion.end().map(|end| (base * end.pose).translation.vector)
    };
    match (place(index.checked_sub(1)), place(Some(index)), place(Some(index + 1))) {
        (Some(before), Some(here), Some(after)) => {
            m.zone.tcp.min(0.5 * (here - before).norm()).min(0.5 * (after - here).norm())
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

#[cfg(test)]
mod tests {
    use hairpin::math::rotation::from_rotation_vector;
    use hairpin::trajectory::program::{JointTarget, NO_EXTERNAL, Speed, Tool, WorkObject, Zone};
    use nalgebra::{Translation3, UnitQuaternion, Vector3};

    use super::*;

    fn turned(roll: f64, pitch: f64, yaw: f64) -> UnitQuaternion<f64> {
        UnitQuaternion::from_euler_angles(roll, pitch, yaw)
    }

    fn program() -> Program {
        let tool = Tool { tcp: Isometry3::translation(0.0, 0.0, 0.12), mass: 0.8, ..Tool::flange() };
        let object = WorkObject {
            user: Isometry3::from_parts(Translation3::new(0.1, -0.2, 0.3), turned(0.0, 0.0, 0.5)),
            ..WorkObject::base()
        };
        let mut program = Program::new("M", "heavy_run", tool, object);
        let at = |x: f64, y: f64| {
            let turn = turned(3.0, -0.2, 0.4 + x);
            PoseTarget::unnamed(Isometry3::from_parts(Translation3::new(x, y, 0.4), turn))
        };
        let joints = [0.1, -1.5, 2.0, -0.5, 1.5, 6.0];
        let home = JointTarget { name: None, joints, external: NO_EXTERNAL };
        let (v, z) = (|name| Speed::predefined(name).unwrap(), |name| Zone::predefined(name).unwrap());
        program.moves = vec![
            Move::new(Motion::AbsoluteJoint(home), v("v200"), Zone::stop()),
            Move::new(Motion::Joint(at(0.3, 0.0)), v("v200"), z("z10")),
            Move { duration: Some(2.5), ..Move::new(Motion::Linear(at(0.3, 0.1)), v("v150"), z("z10")) },
            Move::new(Motion::Circular { via: at(0.305, 0.108), to: at(0.312, 0.11) }, v("vmax"), z("z100")),
            Move::new(Motion::Linear(at(0.4, 0.11)), v("v2000"), Zone::stop()),
        ];
        program
    }

    type Call = (String, Vec<Vec<f64>>, Vec<(String, f64)>);

    /// A reader of its own: function name, and each call with its numbers in brackets and its named arguments.
    fn calls(text: &str) -> Vec<Call> {
        let lines = text.lines().filter(|line| line.starts_with("  "));
        lines
            .map(|line| {
                let (name, rest) = line.trim().split_once('(').unwrap();
                let rest = rest.strip_suffix(')').unwrap();
                let lists = rest.split('[').skip(1).map(|list| {
                    list.split(']').next().unwrap().split(',').map(|x| x.trim().parse().unwrap()).collect()
                });
                let named = rest.split(", ").filter_map(|part| part.split_once('='));
                let named = named.map(|(name, value)| (name.to_owned(), value.parse().unwrap()));
                (name.to_owned(), lists.collect(), named.collect())
            })
            .collect()
    }

    #[test]
    fn poses_speeds_and_corners_are_those_of_the_program() {
        let program = program();
        let text = text(&program, &Settings::default(), &["gap 0.3 %".into()]).unwrap();
        assert!(text.starts_with("# gap 0.3 %\n# This is a test program") && text.ends_with("\nend\nheavy_run()\n"));
        let calls = calls(&text);
        let names: Vec<_> = calls.iter().map(|(name, ..)| name.as_str()).collect();
        assert_eq!(names, ["set_tcp", "set_target_payload", "movej", "movej", "movel", "movec", "movel"]);
        assert_eq!(calls[0].1, [[0.0, 0.0, 0.12, 0.0, 0.0, 0.0]]);
        assert_eq!(calls[2].1, [[0.1, -1.5, 2.0, -0.5, 1.5, 6.0]]);
        let base = program.work_objects[0].base_from_object();
        for (call, m) in calls[3..].iter().zip(&program.moves[1..]) {
            for (numbers, target) in call.1.iter().zip(m.motion.poses()) {
                let expected = base * target.pose;
                let turn = from_rotation_vector(&Vector3::new(numbers[3], numbers[4], numbers[5]));
                assert!((Vector3::new(numbers[0], numbers[1], numbers[2]) - expected.translation.vector).norm() < 1e-8);
                assert!(turn.angle_to(&expected.rotation) < 1e-7, "{turn} {expected}");
            }
        }
        let named = |call: usize, name: &str| calls[call].2.iter().find(|(n, _)| n == name).map(|(_, v)| *v);
        assert_eq!(
            (named(4, "v"), named(4, "t"), named(5, "v"), named(6, "v")),
            (Some(0.15), Some(2.5), Some(1.0), Some(1.0))
        );
        // The first corner comes from a posture, the third is cut to half of 12.2 mm.
        assert_eq!((named(3, "r"), named(6, "r")), (Some(0.0), Some(0.0)));
        let half = 0.5 * (0.012_f64.powi(2) + 0.01_f64.powi(2)).sqrt();
        assert!((named(4, "r").unwrap() - half).abs() < 1e-9 && (named(5, "r").unwrap() - half).abs() < 1e-9);
    }

    #[test]
    fn what_controllers_refuse_is_not_written() {
        let named = Program { procedure: "end".into(), ..program() };
        assert!(matches!(text(&named, &Settings::default(), &[]), Err(UrscriptError::Name { .. })));
        let settings = Settings { acceleration: 0.0, ..Settings::default() };
        assert!(matches!(text(&program(), &settings, &[]), Err(UrscriptError::Setting { field: "acceleration", .. })));
        let mut broken = program();
        broken.moves.remove(2);
        broken.moves.remove(0);
        broken.moves.remove(0);
        assert!(matches!(text(&broken, &Settings::default(), &[]), Err(UrscriptError::Program(_))));
    }
}
