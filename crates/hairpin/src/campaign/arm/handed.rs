//! Programs as controllers are handed them, who know neither the postures of this arm nor what its base is to the cell.
//!
//! Inside, a program is in the base frame, and a target's configuration tells this arm's postures apart. A controller
//! takes user frames as seen from the world, and counts cfx from wrist, elbow and shoulder.

use nalgebra::Isometry3;

use super::ArmSetup;
use super::graph::configuration;
use crate::trajectory::program::{JointTarget, Motion, Move, PoseTarget, Program, WorkObject};

impl ArmSetup {
    /// `world_from_base`, m.
    pub fn world_from_base(&self) -> Isometry3<f64> {
        // A station was built with it.
        self.scenario.world_from_base().unwrap_or_else(|_| Isometry3::identity())
    }

    /// Whether configurations of this arm's programs mean something to a controller.
    pub fn tells_configurations(&self) -> bool {
        self.station.arm.knows_configurations()
    }

    /// `program` with user frames in the world, and without configurations where a controller's are not known: then
    /// moves in joints go to joint angles, and straight moves and arcs keep the posture that they begin in.
    ///
    /// world_from_user = world_from_base · base_from_user. A move in joints whose angles are not known (in a cloud that
    /// tells a configuration which the arm has not) stays one to a pose.
    pub fn for_controller(&self, program: &Program) -> Program {
        let mut handed = program.clone();
        if !self.tells_configurations() {
            handed.moves.iter_mut().for_each(|one| self.without_configurations(program, one));
        }
        handed.work_objects.iter_mut().for_each(|object| self.in_world(object));
        handed
    }

    /// The same of a work object alone.
    pub(super) fn in_world(&self, object: &mut WorkObject) {
        let world_from_base = self.world_from_base();
        // Rounding would change the signs of zeros.
        if world_from_base != Isometry3::identity() {
            object.user = world_from_base * object.user;
        }
    }

    /// The joint angles at a target, under the name that its pose has with another first letter.
    ///
    /// rad, the first turn of all axes within the bounds whose configuration is the target's; `None` where the target
    /// tells none or the arm has no such posture.
    pub(super) fn joints_at(&self, object: &WorkObject, to: &PoseTarget) -> Option<JointTarget> {
        let wanted = to.configuration.and_then(configuration)?;
        let joints = self.posture(&(object.base_from_object() * to.pose), &wanted)?;
        let name = to.name.as_ref().map(|name| name.replacen('p', "j", 1));
        Some(JointTarget { name, joints, external: to.external })
    }

    fn without_configurations(&self, program: &Program, one: &mut Move) {
        let object = &program.work_objects[one.work_object];
        let joints = match &one.motion {
            Motion::Joint(to) => self.joints_at(object, to),
            _ => None,
        };
        match (&mut one.motion, joints) {
            (motion, Some(joints)) => *motion = Motion::AbsoluteJoint(joints),
            (Motion::Joint(to) | Motion::Linear(to), None) => to.configuration = None,
            (Motion::Circular { via, to }, None) => (via.configuration, to.configuration) = (None, None),
            (Motion::AbsoluteJoint(_), None) => {}
        }
        one.configuration_demanded = false;
    }
}

#[cfg(test)]
mod tests {
    use serde_json::{Value, json};

    use super::*;
    use crate::campaign::arm::program::Met;
    use crate::campaign::{Scenario, Setup};
    use crate::trajectory::program::{Speed, Zone};

    /// The IRB 120's joints one after the other, its base a metre aside and turned by a quarter.
    fn aside() -> Setup {
        let (x, y, z) = ([1, 0, 0], [0, 1, 0], [0, 0, 1]);
        let joint = |(xyz, axis): ([i32; 3], [i32; 3])| json!({ "xyz_mm": xyz, "axis": axis });
        let joints = [([0, 0, 290], z), ([0; 3], y), ([0, 0, 270], y), ([0, 0, 70], x), ([302, 0, 0], y), ([0; 3], x)];
        let joints: Vec<Value> = joints.map(joint).into();
        let scenario: Scenario = serde_json::from_value(json!({
            "hairpin": 1,
            "robot": {
                "kind": "arm", "name": "six",
                "chain": { "joints": joints, "flange_mm": [72, 0, 0], "flange_rpy_deg": [0, 90, 0] },
                "joints": {
                    "lower_deg": [-165, -110, -110, -160, -120, -400], "upper_deg": [165, 110, 70, 160, 120, 400],
                    "speed_deg_s": [250, 250, 250, 320, 320, 420],
                },
            },
            "world": {
                "base_frame": { "mm": [1000, 500, 0], "q1_q4": [0.5_f64.sqrt(), 0, 0, 0.5_f64.sqrt()] },
                "wobj": { "name": "wTest", "declare": true, "uframe_mm": [1000, 500, 0] },
            },
            "task": { "points": [[350, 0, 400]] },
            "spec": { "path": { "max_mm": 5 } },
        }))
        .unwrap();
        Setup::build(scenario.into()).unwrap()
    }

    #[test]
    fn a_chain_is_handed_over_by_angles_and_frames_in_the_world() {
        let setup = aside();
        let arm: &ArmSetup = setup.own().unwrap();
        let pose = arm.station.points[0].pose;
        let q = arm.station.arm.inverse(&arm.station.flange(&pose), &arm.station.home)[0];
        let (configuration, speed) = (Some(arm.station.arm.configuration(&q)), Speed::predefined("v200").unwrap());
        let met = Met { row: 0, configuration, speed, zone: Zone::stop(), passed: false };
        let program = arm.program(&[met], 0, |_, _| false);
        let handed = arm.for_controller(&program);
        let Motion::AbsoluteJoint(to) = &handed.moves[1].motion else { panic!("{:?}", handed.moves[1]) };
        assert_eq!(
            (to.name.as_deref(), handed.moves.iter().any(|one| one.configuration_demanded)),
            (Some("j00"), false)
        );
        let off = arm.station.tool_at(&to.joints).translation.vector - pose.translation.vector;
        assert!(off.norm() < 1e-9, "{off}");
        // Its user frame stands where the scenario puts it in the world, and inside where the base sees it.
        let user = |program: &Program| program.work_objects[0].user;
        let (inside, outside) = (user(&program), user(&handed));
        assert!((outside.translation.vector.x - 1.0).abs() < 1e-12 && outside.rotation.angle() < 1e-7, "{outside}");
        assert!(inside.translation.vector.norm() < 1e-12 && inside.rotation.angle() > 1.57, "{inside}");
    }
}
