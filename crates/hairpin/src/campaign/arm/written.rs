//! An arm and a program as it was written, as the plain numbers that the verification room takes.

#[cfg(feature = "unit-tests")]
mod tests;

use nalgebra::Isometry3;

use crate::robot::arm::{AXES, Arm, Configuration, Joints, Kinematics};
use crate::trajectory::program::{Motion, Move, PoseTarget, Program};
use crate::verification::{ArmBuild, ArmJointClaim, ArmMotion, ArmProgramMove, ArmTarget};

/// The joints of an arm.
pub(super) fn joints_of(arm: &Arm) -> [ArmJointClaim; AXES] {
    std::array::from_fn(|k| ArmJointClaim {
        parent_from_joint: arm.chain.joints[k].origin,
        axis: arm.chain.joints[k].axis,
        bounds: [arm.limits[k].lower, arm.limits[k].upper],
    })
}

/// How an arm is built.
pub(super) fn build_of(arm: &Arm) -> ArmBuild {
    match &arm.kinematics {
        Kinematics::Opw(opw) => ArmBuild::SphericalWrist(opw.signs),
        Kinematics::Chain => ArmBuild::Chain,
    }
}

/// The moves of a program whose tools and work objects are all there. `told` says what is claimed of the joint angles
/// with the tool at a pose in a configuration, if anything is.
///
/// Poses are in the frame of the move's work object, m; zones in m, a fine point being 0. A configuration that the
/// program does not demand is left out.
pub(super) fn moves_of(
    program: &Program,
    told: impl Fn(&Isometry3<f64>, &Configuration) -> Option<Joints>,
) -> Vec<ArmProgramMove> {
    program.moves.iter().map(|one| move_of(program, one, &told)).collect()
}

/// A configuration is told on only where the move demands one; `angles` (rad) only of joint moves whose target demands
/// one and for which `told` knows them. Targets stay in the work object's frame, of which `object` has both parts:
/// base_from_object = user · object.
fn move_of(
    program: &Program,
    one: &Move,
    told: &impl Fn(&Isometry3<f64>, &Configuration) -> Option<Joints>,
) -> ArmProgramMove {
    let (tool, object) = (&program.tools[one.tool], &program.work_objects[one.work_object]);
    let demanded = |to: &PoseTarget| to.configuration.filter(|_| one.configuration_demanded);
    let target = |to: &PoseTarget| ArmTarget { pose: to.pose, configuration: demanded(to), angles: None };
    let angles = |to: &PoseTarget| {
        let [cf1, cf4, cf6, cfx] = demanded(to)?;
        let cfx = u8::try_from(cfx).ok()?;
        told(&(object.base_from_object() * to.pose), &Configuration { cf1, cf4, cf6, cfx })
    };
    let motion = match &one.motion {
        Motion::AbsoluteJoint(to) => ArmMotion::Posture(to.joints),
        Motion::Joint(to) => ArmMotion::Joints(ArmTarget { angles: angles(to), ..target(to) }),
        Motion::Linear(to) => ArmMotion::Straight(target(to)),
        Motion::Circular { via, to } => ArmMotion::Arc(via.pose.translation.vector.into(), target(to)),
    };
    let zone = if one.zone.fine { 0.0 } else { one.zone.tcp };
    ArmProgramMove { motion, tool: tool.tcp, object: [object.user, object.object], zone }
}
