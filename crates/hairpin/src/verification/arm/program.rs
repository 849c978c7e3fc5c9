//! A program as it was written: its frames multiplied out, its postures chosen, every move and every corner that is cut
//! looked at.

use nalgebra::{Isometry3, Point3, Vector3};

use super::claim::{ArmClaim, ArmMotion, ArmMoveFinding, ArmProgramClaim, ArmProgramMove, ArmTarget};
use super::corner::corner;
use super::course::{Course, ToolCourse, apart};
use super::follow::Leg;
use super::path::{ArmPath, ArmPiece};
use super::posture::Asked;
use super::solids::to_all_sides;
use super::{Arm, NO_ARC, ROUNDING, Wrong};

/// Samples of a corner that is cut are this near in the path's parameter, m, and no fewer than so many.
const CORNER_STEP: f64 = 2e-3;
const LEAST_SAMPLES: f64 = 16.0;

/// What came of a program.
#[derive(Debug, Clone, PartialEq)]
pub struct ArmProgramReplay {
    /// Of each move that was followed how far (m) from its waypoint what the flange carries ends.
    pub misses: Vec<f64>,
    /// The first thing on each move, and on the corner at its end, that does not hold. Moves after one that cannot be
    /// followed are not looked at.
    pub findings: Vec<ArmMoveFinding>,
}

/// Follows a program from where the arm stands before it.
///
/// Targets are multiplied out as base_from_user · user_from_object · object_from_tcp, with the tool that each move
/// names. A move must keep bounds, margin and (if `clear`) distances at every sample, end within rounding at its
/// target, in its configuration; corners are looked at twice, as the path about them and as the triangle that a zone
/// stays in.
///
/// Nothing panics on a program that cannot be followed: moves from there on are left out of `misses` and `findings`.
pub fn verify_arm_program(claim: &ArmClaim, program: &ArmProgramClaim) -> ArmProgramReplay {
    let path = ArmPath::of(claim, program);
    let own_tool = claim.flange * claim.tool;
    let ends = path.legs.iter().map(|leg| Point3::from(path.arm.place(&own_tool, leg.end()).translation.vector));
    let ends: Vec<Point3<f64>> = ends.collect();
    let misses = ends.iter().zip(program.waypoints).map(|(end, waypoint)| (end - waypoint).norm()).collect();
    let mut findings = path.findings.clone();
    if program.moves.len() != program.waypoints.len() {
        let (moves, waypoints) = (program.moves.len(), program.waypoints.len());
        findings.push(ArmMoveFinding {
            index: 0,
            at: 0.0,
            what: format!("{moves} moves lead to {waypoints} waypoints"),
        });
    }
    findings.extend(wrong_corners(&path, program, &ends));
    findings.sort_by_key(|finding| finding.index);
    ArmProgramReplay { misses, findings }
}

/// What does not hold where corners are cut; `ends` is where the tool's point is at the end of each move that was
/// followed.
fn wrong_corners(path: &ArmPath, program: &ArmProgramClaim, ends: &[Point3<f64>]) -> Vec<ArmMoveFinding> {
    let mut findings = Vec::new();
    let mut add = |index: usize, what: String| findings.push(ArmMoveFinding { index, at: 1.0, what });
    if program.clear {
        for (index, _) in path.legs.iter().enumerate().filter(|(index, _)| program.moves[*index].zone > 0.0) {
            if !(straight(program, index) && straight(program, index + 1)) {
                add(index, "a corner is cut that is not between two straight moves".into());
            } else if let Some(after) = ends.get(index + 1) {
                let before = index.checked_sub(1).map_or_else(|| begin(path), |before| ends[before]);
                let wrong = corner(path.arm.claim, &[before, ends[index], *after], program.moves[index].zone);
                wrong.into_iter().for_each(|what| add(index, what));
            }
        }
    }
    let around = to_all_sides();
    for piece in path.pieces() {
        if let ArmPiece::Corner(index) = piece {
            let wrong = wrong_corner(path, program, index, &around);
            wrong.into_iter().for_each(|what| add(index, format!("where its corner is cut, {what}")));
        }
    }
    findings
}

/// Where the tool's point is before the first move.
fn begin(path: &ArmPath) -> Point3<f64> {
    let (arm, first) = (&path.arm, &path.legs[0]);
    arm.place(&(arm.claim.flange * arm.claim.tool), first.begin()).translation.vector.into()
}

/// Whether move `index` is there and is one along a line.
fn straight(program: &ArmProgramClaim, index: usize) -> bool {
    program.moves.get(index).is_some_and(|one| matches!(one.motion, ArmMotion::Straight(_)))
}

/// The first thing that does not hold on the way about a corner: links may come as near to the cell as they can without
/// touching it.
///
/// Samples every 2 mm of the path's parameter over its length 2r, 16 at least. Singularities are asked for only where
/// the tool is led about the corner.
fn wrong_corner(path: &ArmPath, program: &ArmProgramClaim, index: usize, around: &[Vector3<f64>]) -> Option<String> {
    let singularity = if path.leads(index) { program.singularity } else { 0.0 };
    let asked = Asked { clearance: program.clear.then_some(0.0), around, singularity };
    let count = (2.0 * path.cut(index) / CORNER_STEP).ceil().max(LEAST_SAMPLES);
    (0..=count as usize).find_map(|i| match path.at(ArmPiece::Corner(index), i as f64 / count) {
        Some((joints, _)) => path.arm.wrong_at(&asked, &joints),
        None => Some("the tool cannot be led on".into()),
    })
}

impl Arm<'_> {
    /// The moves of a program with sharp corners, as far as they can be followed, and what does not hold on them.
    pub(super) fn legs(&self, program: &ArmProgramClaim) -> (Vec<Leg>, Vec<ArmMoveFinding>) {
        let around = to_all_sides();
        let asked = Asked {
            clearance: program.clear.then_some(self.claim.clearance),
            around: &around,
            singularity: program.singularity,
        };
        let (mut legs, mut findings) = (Vec::<Leg>::with_capacity(program.moves.len()), Vec::new());
        for (index, one) in program.moves.iter().enumerate() {
            let found = |(at, what): Wrong| ArmMoveFinding { index, at, what };
            let (begun, pose) = self.begun(legs.last(), &program.start, &(self.claim.flange * one.tool));
            match self.leg(one, &begun, pose) {
                Ok(leg) => {
                    let wrong = self.first_wrong(&leg, &asked).or_else(|| self.wrong_end(&leg, one));
                    findings.extend(wrong.map(found));
                    legs.push(leg);
                }
                Err(lost) => {
                    findings.push(found(lost));
                    break;
                }
            }
        }
        (legs, findings)
    }

    /// Joint angles and pose that a move with `tool` (`link6_from_tcp`) begins at: the point that the one before was
    /// told, where it was told one.
    fn begun(&self, before: Option<&Leg>, start: &[f64; 6], tool: &Isometry3<f64>) -> ([f64; 6], Isometry3<f64>) {
        let joints = before.map_or(start, Leg::end);
        let told = before.filter(|leg| leg.tool() == tool).and_then(|leg| leg.pose(1.0));
        (*joints, told.unwrap_or_else(|| self.place(tool, joints)))
    }

    /// `start` is `base_from_tcp` with the move's own tool.
    fn leg(&self, one: &ArmProgramMove, begun: &[f64; 6], start: Isometry3<f64>) -> Result<Leg, Wrong> {
        let (tool, base_from_object) = (self.claim.flange * one.tool, one.object[0] * one.object[1]);
        let course = match &one.motion {
            ArmMotion::Posture(to) => Course::Joints([*begun, *to]),
            ArmMotion::Joints(target) => {
                Course::Joints([*begun, self.arrival(target, base_from_object, &tool, begun)?])
            }
            ArmMotion::Straight(target) => Course::Tool(ToolCourse::straight(start, base_from_object * target.pose)),
            ArmMotion::Arc(via, target) => {
                let arc = ToolCourse::arc(start, &(base_from_object * via), base_from_object * target.pose);
                Course::Tool(arc.ok_or((0.0, NO_ARC.to_owned()))?)
            }
        };
        self.follow(course, tool, begun)
    }

    /// Joint angles at the end of a move in joints. Where neither the program nor the claim tells them, those that the
    /// way straight there leads to.
    ///
    /// The straight way is only a guess of the branch: of a chain without angles claimed there is nothing better to
    /// hold the move to.
    fn arrival(
        &self,
        target: &ArmTarget,
        base_from_object: Isometry3<f64>,
        tool: &Isometry3<f64>,
        begun: &[f64; 6],
    ) -> Result<[f64; 6], Wrong> {
        let pose = base_from_object * target.pose;
        let chosen = self.chosen(target, &(pose * tool.inverse()), begun).map_err(|what| (0.0, what))?;
        match chosen {
            Some(angles) => Ok(angles),
            None => {
                let straight = Course::Tool(ToolCourse::straight(self.place(tool, begun), pose));
                self.follow(straight, *tool, begun).map(|leg| *leg.end()).map_err(|_| (0.0, "out of reach".into()))
            }
        }
    }

    /// What is wrong with where a move ends.
    ///
    /// The pose within 10⁻⁶ m and rad, then the configuration where the program demands one; a move to told angles
    /// ends at them by itself.
    fn wrong_end(&self, leg: &Leg, one: &ArmProgramMove) -> Option<Wrong> {
        let target = match &one.motion {
            ArmMotion::Posture(_) => return None,
            ArmMotion::Joints(target) | ArmMotion::Straight(target) | ArmMotion::Arc(_, target) => target,
        };
        let other = || {
            let wanted = target.configuration.as_ref()?;
            self.other_than(leg.end(), wanted).map(|what| (1.0, what))
        };
        self.off_target(leg, &(one.object[0] * one.object[1] * target.pose)).or_else(other)
    }

    /// What is wrong with a leg that is to end with its tool at `target`.
    pub(super) fn off_target(&self, leg: &Leg, target: &Isometry3<f64>) -> Option<Wrong> {
        let (off, turn) = apart(&self.place(leg.tool(), leg.end()), target);
        let on = off <= ROUNDING && turn <= ROUNDING;
        (!on).then(|| (1.0, format!("the tool arrives {off:.2e} m and {turn:.2e} rad off its target")))
    }
}
