//! Moves read from KRL.

use hairpin::trajectory::program::{JointTarget, Motion, Move, PoseTarget, Speed, Zone};
use nalgebra::Isometry3;

use super::data::{Position, position};
use super::lines::{flight, split};
use super::state::{Reader, named};
use crate::listing::{Doubt, Unmodelled, beside};

impl Reader {
    /// `LIN Xp0 C_DIS`, `CIRC Xp0,Xp1`.
    pub(super) fn go(&mut self, line: usize, word: &str, rest: &str) -> Result<(), String> {
        let (targets, flies) = flight(rest);
        let mut doubts: Vec<Doubt> = Vec::new();
        let mut positions = Vec::new();
        for name in split(targets) {
            positions.push((named(name), self.find(name)?));
        }
        let unset = |set: Option<usize>| set.is_none();
        if unset(self.tool) || unset(self.base) {
            doubts.push((None, "$TOOL and $BASE are not both set in this file".into()));
        }
        let tool = self.tool.unwrap_or_else(|| self.add_tool(Isometry3::identity()));
        let work_object = self.base.unwrap_or_else(|| self.add_base(Isometry3::identity()));
        let joint = word == "PTP";
        let motion = match (&mut positions[..], word) {
            ([(name, Position::Axes { joints, external })], "PTP") => {
                Motion::AbsoluteJoint(JointTarget { name: name.take(), joints: *joints, external: *external })
            }
            ([(name, position)], "PTP") => Motion::Joint(target(name.take(), position, joint, &mut doubts)?),
            ([(name, position)], "LIN") => Motion::Linear(target(name.take(), position, joint, &mut doubts)?),
            ([(via, middle), (name, end)], "CIRC") => Motion::Circular {
                via: target(via.take(), middle, joint, &mut Vec::new())?,
                to: target(name.take(), end, joint, &mut doubts)?,
            },
            _ => return Err(format!("{word}: expected {} positions", if word == "CIRC" { 2 } else { 1 })),
        };
        if let Motion::AbsoluteJoint(to) = &motion {
            doubts.extend(beside(&to.external, EXTERNAL));
        }
        let zone = match (flies, joint) {
            (None, _) => Zone::stop(),
            (Some(how), false) if how.eq_ignore_ascii_case("C_DIS") => match self.near {
                Some(near) => flown_by(near),
                None => {
                    doubts.push((None, "$APO.CDIS is not set in this file".into()));
                    Zone::stop()
                }
            },
            (Some(how), _) => {
                doubts.push((Some(Unmodelled::Interpolation), format!("{how} is not followed")));
                Zone::stop()
            }
        };
        let speed = self.speed(joint, &mut doubts);
        let m = Move { tool, work_object, configuration_demanded: false, ..Move::new(motion, speed, zone) };
        self.reading.go(line, m, doubts);
        Ok(())
    }

    fn find(&self, name: &str) -> Result<Position, String> {
        if name.starts_with('{') {
            return position(name);
        }
        let told = || format!("`{}`", name.escape_default());
        match self.positions.get(&name.to_ascii_uppercase()) {
            Some(found) => found.clone().map_err(|what| format!("{} {what}", told())),
            None => Err(format!("{} is not declared in this program", told())),
        }
    }

    /// Joint moves run at a share of the axes' speeds, which is no speed of the tool's.
    fn speed(&self, joint: bool, doubts: &mut Vec<Doubt>) -> Speed {
        let fast = Speed { name: None, ..Speed::predefined("vmax").unwrap_or(NO_SPEED) };
        if joint {
            return Speed::predefined("vmax").unwrap_or(fast);
        }
        match (self.speed, self.turning) {
            (Some(tcp), turning) => {
                Speed { tcp, orientation: turning.map_or(fast.orientation, f64::to_radians), ..fast }
            }
            (None, _) => {
                doubts.push((Some(Unmodelled::Speeds), "$VEL.CP is not set in this file".into()));
                fast
            }
        }
    }
}

const NO_SPEED: Speed =
    Speed { name: None, tcp: f64::INFINITY, orientation: 0.0, linear_external: 0.0, rotating_external: 0.0 };
const EXTERNAL: [&str; 6] = ["E1", "E2", "E3", "E4", "E5", "E6"];

fn target(
    name: Option<String>,
    position: &Position,
    joint: bool,
    doubts: &mut Vec<Doubt>,
) -> Result<PoseTarget, String> {
    let Position::Pose { pose, external, posture } = position else {
        return Err("expected a pose, found angles of axes".into());
    };
    // Straight moves and arcs keep the posture that they begin in, whatever S and T say.
    if *posture && joint {
        doubts.push((Some(Unmodelled::Interpolation), "status and turn (S, T) are not followed".into()));
    }
    doubts.extend(beside(external, EXTERNAL));
    Ok(PoseTarget { name, external: *external, ..PoseTarget::unnamed(*pose) })
}

/// A corner of that radius, by its predefined name where there is one.
fn flown_by(tcp: f64) -> Zone {
    let known = Zone::predefined_names().filter_map(Zone::predefined).find(|zone| !zone.fine && zone.tcp == tcp);
    let lengths = Zone { name: None, fine: false, tcp, path_orientation: tcp, path_external: tcp, ..Zone::stop() };
    known.unwrap_or(lengths)
}
