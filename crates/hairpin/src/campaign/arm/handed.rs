//! Programs as controllers are handed them, who know neither the postures of this arm nor what its base is to the cell.
//!
//! Inside, a program is in the base frame, and a target's configuration tells this arm's postures apart. A controller
//! takes user frames as seen from the world, and counts cfx from wrist, elbow and shoulder.

use std::collections::BTreeMap;

use nalgebra::Isometry3;

use super::ArmSetup;
use super::graph::configuration;
use crate::campaign::scenario::ArmMode;
use crate::robot::arm::{AXES, Joints};
use crate::trajectory::program::{JointTarget, Motion, Move, PoseTarget, Program, WorkObject};

/// Whether a module would have the controller's own `wobj0` for it, which is its world whatever stands here.
pub(super) fn is_wobj0(object: &WorkObject) -> bool {
    !object.declare && object.name.eq_ignore_ascii_case("wobj0")
}

/// `target` as seen from the world that its object stands in.
pub(super) fn moved(world_from_object: &Isometry3<f64>, target: &mut PoseTarget) {
    // A frame that came back to where it was is off by rounding, which is to change nothing.
    let (shift, turn) = (world_from_object.translation.vector.norm(), world_from_object.rotation.vector().norm());
    if shift > 1e-9 || turn > 1e-9 {
        target.pose = world_from_object * target.pose;
    }
}

/// An object whose targets count from the world.
pub(super) fn as_the_world(object: &mut WorkObject) {
    (object.user, object.object) = (Isometry3::identity(), Isometry3::identity());
}

/// Angles that are nearer than this on every axis are one posture, rad.
const SAME: f64 = 1e-3;

impl ArmSetup {
    /// `world_from_base`, m: of the world that its controller's work objects stand in.
    ///
    /// The cell's, where `world.base_frame` puts the arm in one; else that of a controller which was told nothing, and
    /// counts from what it takes for its base ([`crate::robot::arm::Arm::base_from_controller`]).
    pub fn world_from_base(&self) -> Isometry3<f64> {
        match self.stands_aside() {
            Some(world_from_base) => world_from_base,
            None => self.station.arm.base_from_controller.inverse(),
        }
    }

    /// `world_from_base`, m, where the cell puts the arm elsewhere than at its origin.
    pub fn stands_aside(&self) -> Option<Isometry3<f64>> {
        // A station was built with it.
        self.scenario.world_from_base().ok().filter(|base| *base != Isometry3::identity())
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

    /// `program`, whose work objects are as [`Self::for_controller`] leaves them, for a language that says no frame of
    /// `wobj0`: targets that are met in it count from what a controller has under that name, its world.
    ///
    /// world_from_tcp = world_from_wobj0 · wobj0_from_tcp, and `wobj0` is the world then.
    pub fn in_wobj0(&self, program: &Program) -> Program {
        let mut handed = program.clone();
        for one in &mut handed.moves {
            let object = &program.work_objects[one.work_object];
            if is_wobj0(object) {
                let world_from_object = object.base_from_object();
                let poses: Vec<&mut PoseTarget> = match &mut one.motion {
                    Motion::Joint(to) | Motion::Linear(to) => vec![to],
                    Motion::Circular { via, to } => vec![via, to],
                    Motion::AbsoluteJoint(_) => Vec::new(),
                };
                poses.into_iter().for_each(|target| moved(&world_from_object, target));
            }
        }
        handed.work_objects.iter_mut().filter(|object| is_wobj0(object)).for_each(as_the_world);
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

    /// `program` for a language that knows no configurations: moves in joints whose posture is not the nearest one go
    /// to its joint angles.
    ///
    /// Nearest to where the move begins: by the largest turn of an axis and by the sum of all, over whole turns within
    /// the bounds. Of arms without a closed inverse others may be nearer that nobody knows, and all go to angles. Moves
    /// without a configuration are left.
    ///
    /// # Errors
    /// A target in a configuration that the arm has not, in a sentence's part, where joints are what is proven.
    pub fn with_angles(&self, program: &Program) -> Result<Program, String> {
        let mut handed = program.clone();
        let (mut here, mut named) = (None, BTreeMap::new());
        for one in &mut handed.moves {
            let object = &program.work_objects[one.work_object];
            let joined = matches!(one.motion, Motion::Joint(_));
            let to = match &one.motion {
                Motion::AbsoluteJoint(to) => {
                    here = Some(to.joints);
                    continue;
                }
                Motion::Joint(to) | Motion::Linear(to) | Motion::Circular { to, .. } => to,
            };
            let target = self.joints_at(object, to);
            let asked = to.configuration.filter(|_| joined);
            if let (Some(numbers), None, ArmMode::Joint) = (asked, &target, self.scenario.generate.mode) {
                let name = to.name.as_deref().unwrap_or("a target");
                return Err(format!(
                    "{name} is to be met in configuration {numbers:?}, which the arm does not have there"
                ));
            }
            if let (Some(_), Some(mut target)) = (asked, target.clone()) {
                let flange = self.station.flange(&(object.base_from_object() * to.pose));
                if !here.is_some_and(|here| self.is_nearest(&flange, &here, &target.joints)) {
                    // One name has one value: a point may be met in several postures.
                    let known = target.name.clone().map(|name| *named.entry(name).or_insert(target.joints));
                    target.name = target.name.filter(|_| known == Some(target.joints));
                    one.motion = Motion::AbsoluteJoint(target);
                }
            }
            here = target.map(|target| target.joints);
        }
        Ok(handed)
    }

    /// Whether no other posture with the flange at `flange` is as near to `here` as `joints`, all in rad.
    fn is_nearest(&self, flange: &Isometry3<f64>, here: &Joints, joints: &Joints) -> bool {
        let arm = &self.station.arm;
        let apart = |a: &Joints, b: &Joints| std::array::from_fn::<f64, AXES, _>(|axis| (a[axis] - b[axis]).abs());
        let largest = |q: &Joints| apart(here, q).into_iter().fold(0.0, f64::max);
        let sum = |q: &Joints| apart(here, q).into_iter().sum::<f64>();
        let all = arm.inverse(flange, here).into_iter().flat_map(|q| arm.turns_of(&q));
        let mut others = all.filter(|q| apart(joints, q).into_iter().any(|turn| turn > SAME));
        arm.has_closed_inverse() && others.all(|q| largest(joints) < largest(&q) && sum(joints) < sum(&q))
    }

    /// The joint angles at a target, under the name that its pose has with another first letter.
    ///
    /// rad, the turn of all axes nearest to home whose configuration is the target's, as in the graph; `None` where the
    /// target tells none or the arm has no such posture.
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

#[cfg(feature = "unit-tests")]
mod tests {
    use std::f64::consts::PI;
    use std::sync::Arc;

    use nalgebra::Vector3;
    use serde_json::{Value, json};

    use super::*;
    use crate::campaign::arm::Station;
    use crate::campaign::arm::program::Met;
    use crate::campaign::scenario::MoveName;
    use crate::campaign::{Scenario, Setup};
    use crate::simulation::arm::Target;
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

    /// A configuration does not tell the turns of axes 2, 3 and 5: they are those nearest to home, as in the graph.
    #[test]
    fn a_chain_is_handed_over_on_the_turns_of_its_graph() {
        let setup = aside();
        let mut arm: ArmSetup = setup.own::<ArmSetup>().unwrap().clone();
        let mut station = Station::clone(&arm.station);
        for axis in [1, 2, 4] {
            let limit = &mut station.arm.limits[axis];
            (limit.lower, limit.upper) = (-10.0, 10.0);
        }
        let (pose, home) = (station.points[0].pose, station.home);
        let q = station.arm.inverse(&station.flange(&pose), &home)[0];
        arm.station = Arc::new(station);
        Arc::make_mut(&mut arm.scenario).generate.moves.kind = MoveName::Joint;
        let (configuration, speed) = (Some(arm.station.arm.configuration(&q)), Speed::predefined("v200").unwrap());
        let met = Met { row: 0, configuration, speed, zone: Zone::stop(), passed: false };
        let program = arm.program(&[met], 0, |_, _| false);
        let handed = arm.for_controller(&program);
        let Motion::AbsoluteJoint(to) = &handed.moves[1].motion else { panic!("{:?}", handed.moves[1]) };
        for axis in [1, 2, 4] {
            let turned = (to.joints[axis] - home[axis]).abs();
            assert!(turned < PI + 1e-9, "axis {} turns by {turned}", axis + 1);
        }
        // And what is simulated goes there too.
        let simulated = arm.orders(&program).unwrap().remove(0).target;
        assert!(matches!(simulated, Target::Joints(joints) if joints == to.joints), "{simulated:?}");
    }

    /// A shipped arm, and a point before it.
    fn before() -> Setup {
        let path = format!("{}/../../data/robots/arm/irb120.toml", env!("CARGO_MANIFEST_DIR"));
        let robot: Value = toml::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
        let scenario: Scenario = serde_json::from_value(json!({
            "hairpin": 1, "robot": robot,
            "task": { "points": [[350, 40, 400]], "home_deg": [0, 0, 0, 0, 30, 0] },
            "spec": { "path": { "max_mm": 5 } },
        }))
        .unwrap();
        Setup::build(scenario.into()).unwrap()
    }

    /// Where a language tells no configuration, a posture that is not the nearest one is told by its angles.
    #[test]
    fn postures_that_are_not_the_nearest_are_handed_over_by_angles() {
        let setup = before();
        let arm: &ArmSetup = setup.own().unwrap();
        let (six, home) = (&arm.station.arm, arm.station.home);
        let flange = arm.station.flange(&arm.station.points[0].pose);
        let all: Vec<Joints> = six.inverse(&flange, &home).iter().flat_map(|q| six.turns_of(q)).collect();
        let speed = Speed::predefined("v200").unwrap();
        let by_angles = |arm: &ArmSetup, q: &Joints| {
            let configuration = Some(arm.station.arm.configuration(q));
            let met = Met { row: 0, configuration, speed: speed.clone(), zone: Zone::stop(), passed: false };
            let program = arm.program(&[met], 0, |_, _| false);
            let handed = arm.with_angles(&program).unwrap();
            assert_eq!(
                (handed.moves.len(), &handed.moves[0], &handed.moves[2]),
                (3, &program.moves[0], &program.moves[2])
            );
            match &handed.moves[1].motion {
                Motion::AbsoluteJoint(to) => {
                    assert!(to.joints.iter().zip(q).all(|(a, b)| (a - b).abs() < 1e-9), "{to:?}, not {q:?}");
                    true
                }
                motion => {
                    assert_eq!(motion, &program.moves[1].motion);
                    false
                }
            }
        };
        let largest = |q: &Joints| q.iter().zip(&home).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        let nearest = all.iter().min_by(|a, b| largest(a).total_cmp(&largest(b))).unwrap();
        let to_poses: Vec<&Joints> = all.iter().filter(|q| !by_angles(arm, q)).collect();
        assert!(all.len() > 1 && to_poses == [nearest], "{} of {}", to_poses.len(), all.len());
        // Of an arm without a closed inverse nobody knows the nearest.
        let setup = aside();
        let arm: &ArmSetup = setup.own().unwrap();
        let flange = arm.station.flange(&arm.station.points[0].pose);
        assert!(by_angles(arm, &arm.station.arm.inverse(&flange, &arm.station.home)[0]));
    }

    /// A controller's own `wobj0` is its base, wherever the arm's file has that: a module says no frame of it.
    #[test]
    fn targets_in_wobj0_count_from_the_controllers_base() {
        let setup = before();
        let mut arm: ArmSetup = setup.own::<ArmSetup>().unwrap().clone();
        let mut station = Station::clone(&arm.station);
        let controller_from_base = Isometry3::new(Vector3::new(0.1, -0.2, 0.05), Vector3::new(0.0, 0.0, PI)).inverse();
        station.arm.base_from_controller = controller_from_base.inverse();
        let pose = station.points[0].pose;
        arm.station = Arc::new(station);
        let met = |row| Met {
            row,
            configuration: None,
            speed: Speed::predefined("v200").unwrap(),
            zone: Zone::stop(),
            passed: false,
        };
        let program = arm.program(&[met(0)], 0, |_, _| false);
        let handed = arm.in_wobj0(&arm.for_controller(&program));
        assert_eq!((handed.work_objects[0].user, &handed.work_objects[0].name[..]), (Isometry3::identity(), "wobj0"));
        let target = |program: &Program| program.moves[1].motion.poses().next().unwrap().pose;
        let expected = controller_from_base * pose;
        let off = expected.inverse() * target(&handed);
        assert!(off.translation.vector.norm() < 1e-12 && off.rotation.angle() < 1e-7, "{off}");
        // As a frame that is declared in a module says it.
        let declared = arm.for_controller(&program);
        let off = declared.work_objects[0].base_from_object() * target(&declared) * target(&handed).inverse();
        assert!(off.translation.vector.norm() < 1e-12, "{off}");
        // Where both bases are one nothing changes, not the sign of a zero either.
        let arm: &ArmSetup = setup.own().unwrap();
        let program = arm.program(&[met(0)], 0, |_, _| false);
        assert_eq!(arm.in_wobj0(&arm.for_controller(&program)), arm.for_controller(&program));
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
