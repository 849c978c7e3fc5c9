//! Programs as KUKA's KRL, a `.src` and a `.dat`: mm and degrees, A B C about z, y, x.

use std::collections::BTreeMap;

use hairpin::math::rotation::euler_from_quaternion;
use hairpin::trajectory::program::{External, Motion, PoseTarget, Program, ProgramError};
use nalgebra::Isometry3;
use thiserror::Error;

use crate::banner::comments;
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
    hold(most_speed > 0.0 && most_speed <= 100.0, "most_speed", most_speed, "more than 0 m/s and at most 100")?;
    if program.moves.first().is_some_and(|m| m.motion.end().is_some()) {
        return Err(KrlError::FirstPose);
    }
    let mut writer =
        Writer { program, settings, data: Vec::new(), lines: Vec::new(), names: BTreeMap::new(), unnamed: 0 };
    let name = writer.named(&program.name)?;
    writer.moves()?;
    let comments: Vec<String> = comments(";", header)
        .chain([
            "; Positions in $BASE, mm and degrees; A about z, B about the new y, C about the new x.".into(),
            "; Status and turn (S, T) are not known and not given: joint moves to a pose keep those of the move before.".into(),
            format!("; Joint moves run at {} % of the axes' speeds and stop.", decimal(joint_percent, 3)),
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
            Some(name) => self.named(&format!("X{name}"))?,
            None => {
                self.unnamed += 1;
                format!("XAT{}", self.unnamed)
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
            let mut settings = vec![
                ("$TOOL", format!("{{{}}}", frame(&program.tools[m.tool].tcp))),
                ("$BASE", format!("{{{}}}", frame(&program.work_objects[m.work_object].base_from_object()))),
            ];
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

#[cfg(test)]
mod tests {
    use hairpin::math::rotation::quaternion_from_euler;
    use hairpin::trajectory::program::{JointTarget, Move, NO_EXTERNAL, Speed, Tool, WorkObject, Zone};
    use nalgebra::{Quaternion, Translation3, UnitQuaternion, Vector3};

    use super::*;

    fn at(x: f64, y: f64) -> PoseTarget {
        let turn = UnitQuaternion::from_euler_angles(0.3, -0.2 - x, 2.4);
        PoseTarget::unnamed(Isometry3::from_parts(Translation3::new(x, y, 0.4), turn))
    }

    fn program() -> Program {
        let tool = Tool { tcp: at(0.0, 0.1).pose, ..Tool::flange() };
        let object = WorkObject { user: at(0.2, 0.1).pose, object: at(-0.1, 0.0).pose, ..WorkObject::base() };
        let mut program = Program::new("Heavy", "main", tool, object);
        let home =
            JointTarget { name: Some("home".into()), joints: [0.1, -0.2, 0.3, -0.4, 0.5, 0.6], external: NO_EXTERNAL };
        let (v, z) = (|name| Speed::predefined(name).unwrap(), |name| Zone::predefined(name).unwrap());
        program.moves = vec![
            Move::new(Motion::AbsoluteJoint(home.clone()), v("v200"), Zone::stop()),
            Move::new(Motion::Joint(at(0.3, 0.0).named("p0")), v("v200"), z("z10")),
            Move::new(Motion::Linear(at(0.3, 0.1)), v("v150"), z("z10")),
            Move::new(Motion::Circular { via: at(0.35, 0.15), to: at(0.4, 0.1).named("p2") }, v("vmax"), Zone::stop()),
            Move::new(Motion::AbsoluteJoint(home), v("v200"), Zone::stop()),
        ];
        program
    }

    /// A reader of its own: what each `{X 1,Y 2,…}` says by name.
    fn numbers(text: &str) -> BTreeMap<String, f64> {
        let inside = text.split('{').nth(1).unwrap().split('}').next().unwrap();
        let parts = inside.split(',').map(|part| part.trim().split_once(' ').unwrap());
        parts.map(|(name, value)| (name.to_owned(), value.parse().unwrap())).collect()
    }

    fn assert_frame(text: &str, pose: &Isometry3<f64>) {
        let n = numbers(text);
        let [a, b, c] = ["A", "B", "C"].map(|name| n[name].to_radians());
        let q = quaternion_from_euler(c, b, a);
        let turn = UnitQuaternion::new_normalize(Quaternion::new(q[0], q[1], q[2], q[3]));
        let place = Vector3::new(n["X"], n["Y"], n["Z"]) / 1000.0;
        assert!((place - pose.translation.vector).norm() < 2e-9 && turn.angle_to(&pose.rotation) < 1e-7, "{text}");
    }

    #[test]
    fn positions_frames_and_speeds_are_those_of_the_program() {
        let program = program();
        let Files { src, dat } = files(&program, &Settings::default(), &["optimal".into()]).unwrap();
        let statements: Vec<&str> = src.split("\r\n").filter(|line| !line.starts_with([';', '&'])).collect();
        let find = |name: &str| dat.split("\r\n").find(|line| line.contains(&format!(" {name}="))).unwrap();
        let home = numbers(find("Xhome"));
        for (index, q) in [0.1, -0.2, 0.3, -0.4, 0.5, 0.6_f64].iter().enumerate() {
            assert!((home[&format!("A{}", index + 1)] - q.to_degrees()).abs() < 1e-6);
        }
        for (name, pose) in
            [("Xp0", at(0.3, 0.0)), ("XAT1", at(0.3, 0.1)), ("XAT2", at(0.35, 0.15)), ("Xp2", at(0.4, 0.1))]
        {
            assert!(find(name).starts_with("DECL E6POS "));
            assert_frame(find(name), &pose.pose);
        }
        assert_frame(statements[3], &program.tools[0].tcp);
        assert_frame(statements[4], &program.work_objects[0].base_from_object());
        assert!(statements[3].starts_with("$TOOL=") && statements[4].starts_with("$BASE="));
        assert_eq!(statements[..3], ["DEF Heavy ( )", "BAS (#INITMOV,0)", "BAS (#VEL_PTP,30)"]);
        let rest = [
            "PTP Xhome",
            "PTP Xp0",
            "$VEL.CP=0.15",
            "$VEL.ORI1=500",
            "$VEL.ORI2=500",
            "$APO.CDIS=10",
            "LIN XAT1 C_DIS",
            "$VEL.CP=2",
            "CIRC XAT2,Xp2",
            "PTP Xhome",
            "END",
            "",
        ];
        assert_eq!(statements[5..], rest);
        assert!(src.contains("; optimal\r\n; This is a test program") && src.contains("(S, T) are not known"));
        assert!(dat.starts_with("&ACCESS RVP\r\n&REL 1\r\nDEFDAT Heavy\r\n") && dat.ends_with("ENDDAT\r\n"));
    }

    #[test]
    fn what_controllers_refuse_is_not_written() {
        let refused = |change: &dyn Fn(&mut Program)| {
            let mut program = program();
            change(&mut program);
            files(&program, &Settings::default(), &[]).unwrap_err()
        };
        assert_eq!(refused(&|p| drop(p.moves.remove(0))), KrlError::FirstPose);
        assert!(matches!(refused(&|p| p.name = "a".repeat(25)), KrlError::Name { .. }));
        assert!(matches!(
            refused(&|p| p.moves[2].motion = Motion::Linear(at(0.3, 0.1).named("P0"))),
            KrlError::Twice { .. }
        ));
        assert!(matches!(refused(&|p| p.moves[1].speed.tcp = f64::NAN), KrlError::Program(_)));
        let fast = Settings { joint_percent: 101.0, ..Settings::default() };
        assert!(matches!(files(&program(), &fast, &[]), Err(KrlError::Setting { field: "joint_percent", .. })));
    }
}
