//! Who is to do what a program says, and what that arm makes of it.

use hairpin::campaign::Setup;
use hairpin::campaign::arm::ArmSetup;
use hairpin::feasibility::program::{Checked, Surroundings, check};
use hairpin::feasibility::reachability::joint::FollowSettings;
use hairpin::robot::arm::{Arm, Coupling};
use hairpin::trajectory::program::{Motion, Move, Program};
use hairpin_formats::scenario::{arm_with, setup_for};
use nalgebra::Isometry3;

use crate::Problem;
use crate::sets::Set;

/// An arm that follows a program.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Follower {
    /// Alone: a shipped name, an arm's file or a URDF.
    Robot(String),
    /// In its cell: a scenario of an arm, by file or name.
    Cell(String),
}

/// What an arm makes of the program.
pub struct Follow {
    /// The arm.
    pub arm: Arm,
    /// Names of the cell's parts, where one was given.
    pub parts: Option<Vec<String>>,
    /// How many of them are words, which the tool alone is held against.
    pub words: usize,
    /// What it made of the moves that are certain.
    pub checked: Checked,
    /// Whether bodies of it are estimated: what is clear of them is as well.
    pub estimated: bool,
    /// The first move to joint angles of which it is not said whether the controller tells axis 3 against the base:
    /// from there on nothing was followed.
    pub unsaid: Option<usize>,
}

/// A program as its controller has it.
pub(super) struct Told<'a> {
    /// With work objects as the base sees them.
    pub(super) program: &'a Program,
    /// So many of its moves are certain.
    pub(super) certain: usize,
    /// Whether its joint targets are RAPID's.
    pub(super) is_rapid: bool,
}

impl Told<'_> {
    /// The program in the joints of `arm`, how many of its moves are certain, and the first joint target that is not.
    fn for_arm(&self, arm: &Arm) -> (Program, usize, Option<usize>) {
        let coupling = if self.is_rapid { arm.coupling } else { Coupling::Serial };
        let own = self.program.with_joints(|told| coupling.own(told));
        let joined = |m: &Move| matches!(m.motion, Motion::AbsoluteJoint(_));
        let first = self.program.moves.iter().take(self.certain).position(joined);
        let unsaid = first.filter(|_| coupling == Coupling::Unsaid);
        (own, unsaid.unwrap_or(self.certain), unsaid)
    }
}

fn arm_of(setup: &Setup) -> Option<&ArmSetup> {
    setup.own::<ArmSetup>()
}

/// Who follows a program.
pub(super) enum Doer {
    Alone(Box<Arm>),
    InCell(Box<Setup>),
}

impl Doer {
    /// # Errors
    /// No such arm, or a cell that is none of an arm.
    pub(super) fn of(follower: &Follower, sets: &[Set]) -> Result<Self, Problem> {
        match follower {
            Follower::Robot(robot) => Ok(Self::Alone(Box::new(arm_with(robot, sets)?))),
            Follower::Cell(cell) => Ok(Self::InCell(Box::new(setup_for(cell, sets)?))),
        }
    }

    pub(super) fn cell(&self) -> Option<&Setup> {
        match self {
            Self::Alone(_) => None,
            Self::InCell(setup) => Some(setup),
        }
    }

    /// Where the arm's base stands in what frames of a program stand in, where that is not at its origin: the base of
    /// the controller, or the world that it was told of.
    pub(super) fn stands(&self, is_in_base: bool) -> Option<Isometry3<f64>> {
        let stands = match self {
            Self::Alone(arm) => arm.base_from_controller.inverse(),
            Self::InCell(setup) => {
                let arm = arm_of(setup)?;
                if is_in_base { arm.station.arm.base_from_controller.inverse() } else { arm.world_from_base() }
            }
        };
        (stands != Isometry3::identity()).then_some(stands)
    }
}

/// The program with work objects as the base sees them: wobj0, and all user frames, stand in the world.
pub(super) fn in_base(program: &Program, world_from_base: &Isometry3<f64>) -> Program {
    let mut seen = program.clone();
    seen.work_objects.iter_mut().for_each(|object| object.user = world_from_base.inverse() * object.user);
    seen
}

/// Follows the moves that are certain; `follower` is what was asked for.
pub(super) fn follow(doer: Doer, follower: &Follower, told: &Told<'_>) -> Result<Follow, Problem> {
    let settings = FollowSettings { locate: true, ..FollowSettings::default() };
    let setup = match doer {
        Doer::Alone(arm) => {
            let (program, certain, unsaid) = told.for_arm(&arm);
            let checked = check(&arm, &program, certain, &Surroundings::default(), &settings);
            let estimated = arm.has_stand_ins();
            return Ok(Follow { arm: *arm, parts: None, words: 0, checked, estimated, unsaid });
        }
        Doer::InCell(setup) => setup,
    };
    let Some(arm) = arm_of(&setup) else {
        let (Follower::Robot(named) | Follower::Cell(named)) = follower;
        return Err(Problem::input(format!("--cell {named}: is no arm's")));
    };
    let around = Surroundings {
        cell: Some(&arm.station.cell),
        tool_radius: arm.station.tool.radius,
        clearance: arm.scenario.generate.moves.clearance_mm * 1e-3,
    };
    let (program, certain, unsaid) = told.for_arm(&arm.station.arm);
    let checked = check(&arm.station.arm, &program, certain, &around, &settings);
    let words = arm.scenario.world.keep_out_mm.len();
    let (parts, arm) = (Some(arm.part_names()), arm.station.arm.clone());
    let estimated = arm.has_stand_ins();
    Ok(Follow { arm, parts, words, checked, estimated, unsaid })
}
