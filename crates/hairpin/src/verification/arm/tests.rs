//! Claims that hold, and the same with something in the way.

use nalgebra::{Isometry3, Point3, Vector3};

use super::solids::distance;
use super::*;

/// Three joints about z, y, y and three of a wrist about x, y, x, each 0.3 m up or out.
fn joints() -> [ArmJointClaim; 6] {
    let axes = [Vector3::z(), Vector3::y(), Vector3::y(), Vector3::x(), Vector3::y(), Vector3::x()];
    let shifts = [[0.0, 0.0, 0.3], [0.0; 3], [0.0, 0.0, 0.3], [0.0, 0.0, 0.05], [0.3, 0.0, 0.0], [0.0; 3]];
    std::array::from_fn(|k| ArmJointClaim {
        parent_from_joint: Isometry3::translation(shifts[k][0], shifts[k][1], shifts[k][2]),
        axis: axes[k],
        bounds: [-2.5, 2.5],
    })
}

const START: [f64; 6] = [0.0, 0.2, -0.3, 0.0, 0.5, 0.0];
const NOWHERE: ArmSolidForm<'static> = ArmSolidForm::HalfSpace(Vector3::new(0.0, 0.0, 1.0), -10.0);

fn arm_of<'a>(
    joints: &'a [ArmJointClaim; 6],
    bodies: &'a [ArmBodyClaim],
    solids: &'a [ArmSolidClaim<'a>],
) -> ArmClaim<'a> {
    let tool = Isometry3::translation(0.1, 0.0, 0.0);
    let (build, flange) = (ArmBuild::Chain, Isometry3::identity());
    ArmClaim { joints, build, flange, tool, bodies, solids, clearance: 0.01 }
}

fn tool_at(q: &[f64; 6]) -> Isometry3<f64> {
    let joints = joints();
    let claim = arm_of(&joints, &[], &[]);
    Arm::of(&claim).place(&claim.tool, q)
}

fn target(pose: Isometry3<f64>) -> ArmTarget {
    ArmTarget { pose, configuration: None, angles: None }
}

fn straight(pose: Isometry3<f64>) -> ArmMotion {
    ArmMotion::Straight(target(pose))
}

/// In joints to these angles, the pose being that.
fn turning(angles: [f64; 6], pose: Isometry3<f64>) -> ArmMotion {
    ArmMotion::Joints(ArmTarget { angles: Some(angles), ..target(pose) })
}

/// What is found on `moves` from [`START`], each with its zone, as far as waypoints are not looked at.
fn replay(arm: &ArmClaim, moves: &[ArmMotion], zones: &[f64]) -> Vec<ArmMoveFinding> {
    let zone = |index: usize| zones.get(index).copied().unwrap_or_default();
    let one = |(index, motion): (usize, &ArmMotion)| ArmProgramMove {
        motion: motion.clone(),
        tool: arm.tool,
        object: [Isometry3::identity(); 2],
        zone: zone(index),
    };
    let program = ArmProgramClaim {
        start: START,
        moves: &moves.iter().enumerate().map(one).collect::<Vec<_>>(),
        waypoints: &vec![Point3::origin(); moves.len()],
        singularity: 0.0,
        clear: true,
    };
    verify_arm_program(arm, &program).findings
}

fn check(form: ArmSolidForm, moves: &[ArmMotion]) -> Vec<ArmMoveFinding> {
    let body = |link, name: &str, tool, b: [f64; 3], radius| ArmBodyClaim {
        link,
        name: name.into(),
        tool,
        points: vec![Point3::origin(), b.into()],
        radius,
    };
    let bodies = [body(5, "link 5", false, [0.0; 3], 0.05), body(6, "the tool", true, [0.1, 0.0, 0.0], 0.02)];
    let solids = [ArmSolidClaim { name: "block", tool_only: false, form }];
    replay(&arm_of(&joints(), &bodies, &solids), moves, &[])
}

#[test]
fn straight_moves_are_followed_and_obstacles_on_them_found() {
    let from = tool_at(&START);
    let mut to = from;
    to.translation.vector += Vector3::new(0.0, 0.25, 0.0);
    let moves = [straight(to), straight(from), turning(START, from)];
    assert_eq!(check(NOWHERE, &moves), []);
    // A ball beside the end of the way: touched where |way| · share comes within both radii and the clearance.
    let center = Point3::from(to.translation.vector) + Vector3::new(0.0, 0.1, 0.0);
    let found = check(ArmSolidForm::Ball(center, 0.1), &moves[..1]);
    let [ArmMoveFinding { index: 0, at, what }] = &found[..] else { panic!("{found:?}") };
    assert!(
        (at - (1.0 - 0.03 / 0.25)).abs() < 0.02 && what.contains("the tool keeps") && what.contains("block"),
        "{found:?}"
    );
    // Out of reach, out of bounds, another target than said.
    let mut far = from;
    far.translation.vector += Vector3::new(2.0, 0.0, 0.0);
    assert!(check(NOWHERE, &[straight(far)])[0].what.contains("cannot be led on"));
    let beyond = [2.6, 0.2, -0.3, 0.0, 0.5, 0.0];
    assert!(check(NOWHERE, &[ArmMotion::Posture(beyond)])[0].what.contains("axis 1 is at"));
    assert!(check(NOWHERE, &[turning(START, to)])[0].what.contains("off its target"));
}

#[test]
fn distances_from_all_forms() {
    let p = Point3::new(0.3, 0.4, 1.2);
    let origin = Point3::origin();
    let up = [origin, Point3::new(0.0, 0.0, 1.0)];
    let corner = [Point3::new(1.0, 0.0, 0.0), Point3::new(0.0, 1.0, 0.0), Point3::new(0.0, 0.0, 1.0)];
    // A tetrahedron, corners counter-clockwise from outside.
    let [x, y, z] = corner;
    let tetrahedron = || ArmSolidForm::Triangles(vec![[x, y, z], [origin, y, x], [origin, z, y], [origin, x, z]]);
    for (form, expected) in [
        (ArmSolidForm::Ball(origin, 0.3), 1.0),
        (ArmSolidForm::Box(origin, Vector3::new(0.3, 0.1, 0.8)), 0.5),
        (ArmSolidForm::Capsule(up, 0.1), 0.29_f64.sqrt() - 0.1),
        (ArmSolidForm::Cylinder(up, 0.5), 0.2),
        (ArmSolidForm::HalfSpace(Vector3::new(0.0, 0.0, 2.0), 1.0), 0.7),
    ] {
        assert!((distance(&form, &p) - expected).abs() < 1e-12, "{expected}");
    }
    let inside = Point3::new(0.1, 0.1, 0.1);
    assert!((distance(&tetrahedron(), &inside) + 0.1).abs() < 1e-12);
    assert!((distance(&tetrahedron(), &Point3::new(0.1, 0.1, -0.2)) - 0.2).abs() < 1e-12);
    assert!((distance(&ArmSolidForm::Box(origin, Vector3::repeat(0.5)), &inside) + 0.4).abs() < 1e-12);
    let low = |p: &Point3<f64>| p.z < 1.0;
    assert!(
        distance(&ArmSolidForm::Where(&low), &inside) == 0.0
            && distance(&ArmSolidForm::Where(&low), &p) == f64::INFINITY
    );
}

#[test]
fn arcs_are_followed_on_their_circle() {
    let from = tool_at(&START);
    let shifted = |y: f64, z: f64| {
        Isometry3::from_parts((from.translation.vector + Vector3::new(0.0, y, z)).into(), from.rotation)
    };
    let (via, to) = (Point3::from(shifted(0.1, 0.1).translation.vector), shifted(0.2, 0.0));
    let moves = [ArmMotion::Arc(via, target(to)), straight(from)];
    assert_eq!(check(NOWHERE, &moves), []);
    // A half circle of 0.1 m about the middle: its top is `via`; the straight way passes 0.1 m below it.
    let top = |radius: f64| ArmSolidForm::Ball(via + Vector3::new(0.0, 0.0, 0.05), radius);
    let found = check(top(0.03), &moves);
    assert!(matches!(&found[..], [ArmMoveFinding { index: 0, at, .. }] if (at - 0.5).abs() < 0.2), "{found:?}");
    assert_eq!(check(top(0.01), &moves), []);
    let line = [ArmMotion::Arc(Point3::from(shifted(0.1, 0.0).translation.vector), target(to))];
    assert!(check(NOWHERE, &line)[0].what.contains("on a line"));
}

/// A ball of 2 cm at the tool's point.
fn tip() -> ArmBodyClaim {
    let points = vec![Point3::new(0.1, 0.0, 0.0); 2];
    ArmBodyClaim { link: 6, name: "the tool".into(), tool: true, points, radius: 0.02 }
}

#[test]
fn corners_that_are_cut_keep_their_triangle_clear() {
    let from = tool_at(&START);
    let shifted = |y: f64, z: f64| {
        Isometry3::from_parts((from.translation.vector + Vector3::new(0.0, y, z)).into(), from.rotation)
    };
    let moves = [straight(shifted(0.2, 0.0)), straight(shifted(0.2, -0.2))];
    let cut = |zone: f64, moves: &[ArmMotion]| {
        // Beside both legs by 0.05 m, beyond the 0.03 m of the tool and its clearance, and in the middle of the
        // corner's inside.
        let ball = ArmSolidForm::Ball(Point3::from(from.translation.vector) + Vector3::new(0.15, 0.15, -0.05), 0.0);
        let inside = ArmSolidForm::Ball(Point3::from(from.translation.vector) + Vector3::new(0.0, 0.15, -0.05), 0.005);
        let solids = [("far", ball), ("peg", inside)].map(|(name, form)| ArmSolidClaim { name, tool_only: true, form });
        replay(&arm_of(&joints(), &[tip()], &solids), moves, &[zone])
    };
    assert_eq!(cut(0.0, &moves), []);
    assert_eq!(cut(0.02, &moves), []);
    let found = cut(0.1, &moves);
    assert!(
        matches!(&found[..], [ArmMoveFinding { index: 0, what, .. }] if what.contains("corner") && what.contains("peg")),
        "{found:?}"
    );
    // Half of each leg is the most: no zone reaches farther.
    assert_eq!(cut(5.0, &moves), found);
    let last = [moves[0].clone(), ArmMotion::Posture(START)];
    assert!(cut(0.02, &last).iter().any(|found| found.what.contains("not between two straight moves")));
}

#[test]
fn moves_of_a_graph_lead_from_posture_to_posture() {
    let (other, aside) = ([0.3, 0.25, -0.2, 0.1, 0.4, -0.1], [0.2, 0.0, 0.0, 0.0, 0.4, 0.0]);
    let postures = [START, other, aside];
    let poses = postures.map(|q| tool_at(&q));
    let claim = |form| {
        let solids = [ArmSolidClaim { name: "block", tool_only: false, form }];
        let check = |postures: &[[f64; 6]], poses: &[Isometry3<f64>], way| {
            let joints = joints();
            let bodies = [tip()];
            let claim = ArmClaim { clearance: 0.0, ..arm_of(&joints, &bodies, &solids) };
            let moves = [(0, 1), (1, 0)].map(|(from, to)| ArmWayClaim { from, to, way });
            verify_arm_graph(&claim, postures, poses, &moves).len()
        };
        let mut turned = postures;
        turned[1][5] += 0.1;
        let mut elsewhere = poses;
        elsewhere[1] = poses[0];
        (
            [ArmWay::Straight, ArmWay::Joints, ArmWay::Through(2)].map(|way| check(&postures, &poses, way)),
            check(&postures, &elsewhere, ArmWay::Straight),
            check(&turned, &turned.map(|q| tool_at(&q)), ArmWay::Straight),
            check(&turned, &poses, ArmWay::Straight),
        )
    };
    // All hold; a point that is elsewhere (2 finds: its own place and the arrival at it) and a posture of another pose
    // do not.
    assert_eq!(claim(NOWHERE), ([0, 0, 0], 2, 0, 2));
    let block = |k: usize| ArmSolidForm::Ball(poses[k].translation.vector.into(), 0.02);
    assert_eq!(claim(block(1)).0, [2, 2, 2]);
    // In the way of the arc alone.
    assert_eq!(claim(block(2)).0, [0, 0, 2]);
}
