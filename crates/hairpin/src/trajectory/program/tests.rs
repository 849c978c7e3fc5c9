//! Predefined data against the manual's table, arcs against closed forms, and programs that controllers refuse.

use std::f64::consts::PI;

use nalgebra::{Isometry3, Point3, Translation3, UnitQuaternion};

use super::{
    Arc, JointTarget, Motion, Move, NO_EXTERNAL, PoseTarget, Program, ProgramError, Speed, Tool, WorkObject, Zone,
    unit_quaternion,
};

#[test]
fn predefined_data_is_that_of_the_manual() {
    let v = Speed::predefined("V1500").unwrap();
    assert_eq!((v.name.as_deref(), v.tcp, v.linear_external), (Some("v1500"), 1.5, 5.0));
    assert!(
        (v.orientation.to_degrees() - 500.0).abs() < 1e-12 && (v.rotating_external.to_degrees() - 1000.0).abs() < 1e-12
    );
    assert!(Speed::predefined("vmax").unwrap().tcp.is_infinite());
    for none in ["v55", "v", "1000", "v0100", "fine", "vrot"] {
        assert_eq!(Speed::predefined(none), None, "{none}");
    }
    assert_eq!(Speed::predefined_names().count(), 26);
    let z = Zone::predefined("z5").unwrap();
    assert_eq!(
        (z.fine, z.tcp, z.path_orientation, z.path_external, z.linear_external),
        (false, 0.005, 0.008, 0.008, 0.008)
    );
    assert!((z.orientation.to_degrees() - 0.8).abs() < 1e-12);
    assert_eq!(Zone::predefined("FINE"), Some(Zone::stop()));
    assert_eq!((Zone::predefined("z2"), Zone::predefined_names().count()), (None, 15));
}

#[test]
fn quaternions_are_taken_as_controllers_take_them() {
    assert_eq!(unit_quaternion([0.6, 0.0, 0.8, 0.0]).unwrap().into_inner().norm(), 1.0);
    let scaled = unit_quaternion([1.000_004, 0.0, 0.0, 0.0]).unwrap();
    assert_eq!(scaled.w, 1.0);
    for (wrong, square) in [([1.0, 0.0, 0.0, 0.01], 1.0001), ([0.0; 4], 0.0)] {
        assert!((unit_quaternion(wrong).unwrap_err() - square).abs() < 1e-12);
    }
    assert!(unit_quaternion([f64::NAN, 0.0, 0.0, 1.0]).is_err());
}

#[test]
fn arcs_are_those_through_three_points() {
    let (centre, radius) = (Point3::new(0.3, -0.2, 0.5), 0.1);
    let turn = UnitQuaternion::from_euler_angles(0.4, -0.8, 1.1);
    let at = |angle: f64| centre + turn * nalgebra::Vector3::new(angle.cos(), angle.sin(), 0.0) * radius;
    for angle in [0.1, 1.0, PI, 4.0, 6.0] {
        let arc = Arc::through(&at(0.7), &at(0.7 + 0.3 * angle), &at(0.7 + angle)).unwrap();
        assert!((arc.angle - angle).abs() < 1e-9 && (arc.radius() - radius).abs() < 1e-9, "{angle}: {arc:?}");
        assert!((arc.centre - centre).norm() < 1e-9 && (arc.length() - angle * radius).abs() < 1e-9);
        for s in [0.0, 0.25, 0.5, 1.0] {
            assert!((arc.point(s) - at(0.7 + s * angle)).norm() < 1e-9, "{angle} {s}");
        }
    }
    let [a, b] = [at(0.0), at(1.0)];
    assert_eq!(Arc::through(&a, &nalgebra::center(&a, &b), &b), None);
    assert_eq!(Arc::through(&a, &a, &b), None);
}

fn target(x_mm: f64, y_mm: f64) -> PoseTarget {
    PoseTarget::unnamed(Isometry3::translation(x_mm / 1e3, y_mm / 1e3, 0.4))
}

fn program(motions: Vec<Motion>) -> Program {
    let mut program = Program::new("M", "main", Tool::flange(), WorkObject::base());
    let speed = Speed::predefined("v100").unwrap();
    program.moves = motions.into_iter().map(|motion| Move::new(motion, speed.clone(), Zone::stop())).collect();
    program
}

fn arc(via: (f64, f64), to: (f64, f64)) -> Program {
    let circular = Motion::Circular { via: target(via.0, via.1), to: target(to.0, to.1) };
    program(vec![Motion::Joint(target(0.0, 0.0)), circular])
}

#[test]
fn arcs_that_controllers_refuse_are_found() {
    assert_eq!(arc((50.0, 50.0), (100.0, 0.0)).problems(), []);
    let short = arc((0.05, 0.0), (100.0, 0.0)).problems();
    assert!(matches!(short[..], [ProgramError::ArcShort { which: "start and point on the way", .. }]), "{short:?}");
    let short = arc((100.0, 0.05), (100.0, 0.0)).problems();
    assert!(matches!(short[..], [ProgramError::ArcShort { which: "point on the way and end", .. }]), "{short:?}");
    for (y, flat) in [(0.4, true), (0.5, true), (0.9, false)] {
        let found = arc((50.0, y), (100.0, 0.0)).problems();
        let is_flat = matches!(found[..], [ProgramError::ArcFlat { angle_deg, .. }] if (angle_deg - y.atan2(50.0).to_degrees()).abs() < 1e-9);
        assert_eq!((is_flat, found.is_empty()), (flat, !flat), "{y}: {found:?}");
    }
    // A circle of radius 100 about (100, 0), from (0, 0): the end at 239° passes, at 241° not.
    let on = |degrees: f64| {
        let (sin, cos) = (180.0 - degrees).to_radians().sin_cos();
        (100.0 + 100.0 * cos, 100.0 * sin)
    };
    assert_eq!(arc(on(100.0), on(239.0)).problems(), []);
    let long = arc(on(100.0), on(241.0)).problems();
    assert!(
        matches!(long[..], [ProgramError::ArcLong { angle_deg, .. }] if (angle_deg - 241.0).abs() < 1e-9),
        "{long:?}"
    );
    // Straight back: the point on the way lies behind the start.
    assert!(matches!(arc((-50.0, 0.0), (100.0, 0.0)).problems()[..], [ProgramError::ArcLong { .. }]));
    let first = program(vec![Motion::Circular { via: target(1.0, 1.0), to: target(2.0, 0.0) }]);
    assert!(matches!(first.problems()[..], [ProgramError::ArcFirst { .. }]));
}

/// The start of an arc is where the move before ended, whatever work object that was told in.
#[test]
fn arcs_start_where_the_move_before_ended() {
    let mut moved = arc((50.0, 50.0), (100.0, 0.0));
    let shifted = WorkObject {
        name: "w".into(),
        user: Isometry3::translation(0.0, 0.05, 0.0),
        object: Isometry3::translation(0.05, 0.0, 0.0),
        ..WorkObject::base()
    };
    moved.work_objects.push(shifted);
    moved.moves[0].work_object = 1;
    let found = moved.problems();
    assert!(matches!(found[..], [ProgramError::ArcShort { which: "start and point on the way", .. }]), "{found:?}");
    // After a posture, or with another tool, only the arm's kinematics know.
    moved.tools.push(Tool::flange());
    moved.moves[0].tool = 1;
    assert_eq!(moved.problems(), []);
}

#[test]
fn numbers_that_are_none_are_found() {
    let good = || program(vec![Motion::Linear(target(1.0, 2.0).named("p1"))]);
    assert!(good().checked().is_ok());
    type Change<'a> = (&'a dyn Fn(&mut Program), &'static str);
    let changes: [Change<'_>; 9] = [
        (&|p| p.moves[0].speed.tcp = 0.0, "tcp speed = 0: must be a number, more than 0 m/s"),
        (
            &|p| p.moves[0].speed.tcp = 90.0,
            "tcp speed = 90: must be a number, more than 0 m/s and at most 20 m/s, or vmax",
        ),
        (&|p| p.moves[0].speed.tcp = f64::NAN, "move 0 (to p1): tcp speed = NaN"),
        (&|p| p.moves[0].speed.orientation = -1.0, "orientation speed = -1"),
        (&|p| p.moves[0].duration = Some(0.0), "duration = 0"),
        (&|p| p.moves[0].motion = Motion::Linear(target(f64::NAN, 0.0)), "position = NaN"),
        (&|p| p.moves[0].work_object = 1, "work object 1 of 1"),
        (&|p| p.tools[0].mass = f64::INFINITY, "tool0: mass = inf"),
        (
            &|p| {
                let joints = JointTarget { name: None, joints: [f64::NAN; 6], external: NO_EXTERNAL };
                p.moves[0].motion = Motion::AbsoluteJoint(joints);
            },
            "joint = NaN",
        ),
    ];
    for (change, words) in changes {
        let mut wrong = good();
        change(&mut wrong);
        let error = wrong.checked().unwrap_err().to_string();
        assert!(error.contains(words), "{error}");
    }
    let mut stretched = good();
    let turn = UnitQuaternion::new_unchecked(nalgebra::Quaternion::new(1.1, 0.0, 0.0, 0.0));
    let pose = Isometry3::from_parts(Translation3::new(0.1, 0.0, 0.0), turn);
    stretched.moves[0].motion = Motion::Joint(PoseTarget::unnamed(pose));
    assert!(stretched.checked().unwrap_err().to_string().contains("|q|² = 1.21"));
}

#[test]
fn speeds_are_capped_component_by_component() {
    let named = |name: &str| Speed::predefined(name).unwrap();
    assert_eq!(named("v1000").capped(&named("v50")), named("v50"));
    assert_eq!(named("vmax").capped(&named("v50")), named("v50"));
    assert_eq!(named("v10").capped(&named("v50")), named("v10"));
    let gentle = Speed { name: Some("vGentle".into()), tcp: 0.25, orientation: 0.5, ..named("v5") };
    assert_eq!(named("v1000").capped(&gentle), gentle);
    let both = named("v50").capped(&gentle);
    assert_eq!((both.name, both.tcp, both.orientation), (None, 0.05, 0.5));
}
