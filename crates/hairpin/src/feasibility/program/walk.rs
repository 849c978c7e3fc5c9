//! A program followed move by move in the joints of an arm.

use nalgebra::Isometry3;

use super::finding::{Fault, Finding, Fit};
use super::follow::{FollowSettings, Way, beyond, follow};
use super::posture;
use crate::robot::arm::{AXES, Arm, Joints};
use crate::trajectory::program::{Motion, Move, PoseTarget, Program};

/// What came of a program.
#[derive(Debug, Clone, PartialEq)]
pub struct Checked {
    /// Moves that were looked at as a whole.
    pub followed: usize,
    /// Moves of which only the end was looked at, since where they begin is not known.
    pub ends_only: usize,
    /// What the arm cannot do, in the program's order.
    pub findings: Vec<Finding>,
}

/// Findings for which another configuration is looked for; beyond, a program has other worries.
const MOST_REMEDIES: usize = 50;

/// Follows the first `count` moves of a program whose tools and work objects are all there, from the posture `start` (rad), or
/// from wherever its first posture or configuration puts the arm.
///
/// Straight and circular moves keep one branch of the inverse kinematics and are looked at in samples; of joint moves the ends
/// are enough, since limits are a box. After a move that is refused the arm is taken to stand at its target.
pub fn check(arm: &Arm, program: &Program, count: usize, start: Option<Joints>, settings: &FollowSettings) -> Checked {
    let checked = Checked { followed: 0, ends_only: 0, findings: Vec::new() };
    let mut walk = Walk { arm, program, settings, at: start, from: None, checked };
    for (index, m) in program.moves.iter().take(count).enumerate() {
        walk.step(index, m);
        walk.from = m.motion.name().map(Into::into);
    }
    walk.checked
}

struct Walk<'a> {
    arm: &'a Arm,
    program: &'a Program,
    settings: &'a FollowSettings,
    /// Where the arm stands, if that is known.
    at: Option<Joints>,
    /// Name of where it stands.
    from: Option<String>,
    checked: Checked,
}

impl Walk<'_> {
    fn step(&mut self, index: usize, m: &Move) {
        let whole = self.at.is_some() || matches!(m.motion, Motion::AbsoluteJoint(_) | Motion::Joint(_));
        *(if whole { &mut self.checked.followed } else { &mut self.checked.ends_only }) += 1;
        let tcp = &self.program.tools[m.tool].tcp;
        match (&m.motion, self.at) {
            (Motion::AbsoluteJoint(to), _) => match beyond(self.arm, &to.joints, 1.0) {
                Some(fault) => self.refuse(index, m, fault, None, None),
                None => self.at = Some(to.joints),
            },
            (Motion::Joint(to), _) => self.arrive(index, m, to, to.configuration.filter(|_| m.configuration_demanded)),
            (Motion::Linear(to) | Motion::Circular { to, .. }, None) => self.arrive(index, m, to, to.configuration),
            (Motion::Linear(to), Some(q)) => {
                let way = Way::straight(&(self.arm.forward(&q) * tcp), &self.base_from_tcp(m, to));
                self.follow(index, m, to, &way, &q);
            }
            (Motion::Circular { via, to }, Some(q)) => {
                let (via, end) = (self.base_from_tcp(m, via), self.base_from_tcp(m, to));
                match Way::circular(&(self.arm.forward(&q) * tcp), &via, &end) {
                    Some(way) => self.follow(index, m, to, &way, &q),
                    None => self.refuse(index, m, Fault::NoArc, to.configuration, None),
                }
            }
        }
    }

    /// Where a posture is not known, the first turns of all axes.
    fn near(&self) -> Joints {
        self.at.unwrap_or([0.0; AXES])
    }

    fn base_from_tcp(&self, m: &Move, target: &PoseTarget) -> Isometry3<f64> {
        self.program.work_objects[m.work_object].base_from_object() * target.pose
    }

    fn flange(&self, m: &Move, target: &PoseTarget) -> Isometry3<f64> {
        self.base_from_tcp(m, target) * self.program.tools[m.tool].tcp.inverse()
    }

    /// Takes the arm to the target at once.
    fn arrive(&mut self, index: usize, m: &Move, to: &PoseTarget, demanded: Option<[i32; 4]>) {
        match posture::choose(self.arm, &self.flange(m, to), demanded, &self.near()) {
            Ok(q) => self.at = Some(q),
            Err((fault, fit)) => self.refuse(index, m, fault, to.configuration, fit),
        }
    }

    fn follow(&mut self, index: usize, m: &Move, to: &PoseTarget, way: &Way, start: &Joints) {
        let tcp = self.program.tools[m.tool].tcp;
        match follow(self.arm, &tcp, way, start, self.settings) {
            Ok(followed) => {
                self.at = Some(followed.end);
                let demanded = to.configuration.filter(|_| m.configuration_demanded);
                if let Some(demanded) = demanded.filter(|cf| !posture::has(self.arm, &followed.end, cf)) {
                    let arrives = self.arm.configuration(&followed.end).numbers();
                    self.refuse(index, m, Fault::ArrivesOtherwise { demanded, arrives }, Some(demanded), None);
                }
            }
            Err(fault) => {
                let tried = to.configuration.unwrap_or(self.arm.configuration(start).numbers());
                let fit = self.remedy(&tcp, way, start);
                self.refuse(index, m, fault, Some(tried), fit);
            }
        }
    }

    /// The posture at the move's start from which it fits with the most room.
    fn remedy(&self, tcp: &Isometry3<f64>, way: &Way, start: &Joints) -> Option<Fit> {
        if self.checked.findings.len() >= MOST_REMEDIES {
            return None;
        }
        let others = posture::within_limits(self.arm, &self.arm.forward(start), start);
        let fits = others.iter().filter_map(|other| follow(self.arm, tcp, way, other, self.settings).ok());
        let best = fits.max_by(|a, b| a.room.total_cmp(&b.room))?;
        Some(Fit { configuration: self.arm.configuration(&best.end).numbers(), margin: best.room })
    }

    /// Writes a finding down and moves on to the target, in its configuration if there is such a posture.
    fn refuse(&mut self, index: usize, m: &Move, fault: Fault, tried: Option<[i32; 4]>, fit: Option<Fit>) {
        let to = m.motion.name().map(Into::into);
        self.checked.findings.push(Finding { index, line: m.line, from: self.from.clone(), to, fault, tried, fit });
        self.at = m.motion.end().and_then(|to| {
            let flange = self.flange(m, to);
            let asked = posture::choose(self.arm, &flange, to.configuration, &self.near());
            asked.or_else(|_| posture::choose(self.arm, &flange, None, &self.near())).ok()
        });
    }
}
