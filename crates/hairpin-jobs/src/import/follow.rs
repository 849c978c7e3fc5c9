//! Who is to do what a program says, and what that arm makes of it.

use hairpin::campaign::Setup;
use hairpin::campaign::arm::ArmSetup;
use hairpin::feasibility::program::{Checked, Surroundings, check};
use hairpin::feasibility::reachability::joint::FollowSettings;
use hairpin::robot::arm::Arm;
use hairpin_formats::listing::Module;
use hairpin_formats::scenario::arm_with;

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
    /// What it made of the moves that are certain.
    pub checked: Checked,
    /// Whether bodies of it are estimated: what is clear of them is as well.
    pub estimated: bool,
}

/// Follows the moves that are certain, in the cell if one is given, which is `setup`.
pub(super) fn follow(
    follower: &Follower,
    setup: Option<&Setup>,
    sets: &[Set],
    module: &Module,
) -> Result<Follow, Problem> {
    let settings = FollowSettings { locate: true, ..FollowSettings::default() };
    let cell = match follower {
        Follower::Robot(robot) => {
            let arm = arm_with(robot, sets)?;
            let checked = check(&arm, &module.program, module.certain, &Surroundings::default(), &settings);
            let estimated = arm.has_stand_ins();
            return Ok(Follow { arm, parts: None, checked, estimated });
        }
        Follower::Cell(cell) => cell,
    };
    let Some(arm) = setup.and_then(|setup| setup.own::<ArmSetup>()) else {
        return Err(Problem::input(format!("--cell {cell}: is no arm's")));
    };
    let around = Surroundings {
        cell: Some(&arm.station.cell),
        tool_radius: arm.station.tool.radius,
        clearance: arm.scenario.generate.moves.clearance_mm * 1e-3,
    };
    let checked = check(&arm.station.arm, &module.program, module.certain, &around, &settings);
    let (parts, arm) = (Some(arm.part_names()), arm.station.arm.clone());
    let estimated = arm.has_stand_ins();
    Ok(Follow { arm, parts, checked, estimated })
}
