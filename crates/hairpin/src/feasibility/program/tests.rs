//! A shipped arm against postures whose poses its forward kinematics gives: what is within reach passes, and each fault
//! is found where it was put.

use std::f64::consts::FRAC_PI_2;

use nalgebra::{Isometry3, Point3, Translation3, UnitQuaternion, Vector3};

use super::{Surroundings, check};
use crate::feasibility::reachability::Refusal;
use crate::feasibility::reachability::joint::{FollowSettings, Motion as Way, follow};
use crate::robot::arm::{Arm, ArmDescription, Joints, Kinematics, Singularity};
use crate::trajectory::program::{
    JointTarget, Motion, Move, NO_EXTERNAL, PoseTarget, Program, Speed, Tool, WorkObject, Zone,
};
use crate::world::Shape;
use crate::world::cell::{Cell, Part, Region};

fn arm() -> Arm {
    let text = include_str!("../../../../../data/robots/arm/irb120.toml");
    toml::from_str::<ArmDescription>(text).unwrap().build().unwrap()
}

fn rad(degrees: [f64; 6]) -> Joints {
    degrees.map(f64::to_radians)
}

const HOME: [f64; 6] = [0.0, 0.0, 0.0, 0.0, 30.0, 0.0];

fn tool() -> Tool {
    Tool { tcp: Isometry3::translation(0.02, 0.0, 0.12), ..Tool::flange() }
}

fn object() -> WorkObject {
    WorkObject {
        user: Isometry3::translation(0.1, -0.2, 0.05),
        object: Isometry3::rotation(Vector3::z() * 0.4),
        ..WorkObject::base()
    }
}

/// The target of the posture, with its configuration.
fn at(arm: &Arm, degrees: [f64; 6], name: &str) -> PoseTarget {
    let q = rad(degrees);
    let pose = object().base_from_object().inverse() * arm.forward(&q) * tool().tcp;
    PoseTarget { configuration: Some(arm.configuration(&q).numbers()), ..PoseTarget::unnamed(pose).named(name) }
}

fn shifted(target: &PoseTarget, x: f64, y: f64, z: f64) -> PoseTarget {
    PoseTarget { pose: Translation3::new(x, y, z) * target.pose, ..target.clone() }
}

fn program(motions: Vec<Motion>) -> Program {
    let mut program = Program::new("M", "main", tool(), object());
    let home = JointTarget { name: Some("home".into()), joints: rad(HOME), external: NO_EXTERNAL };
    let all = std::iter::once(Motion::AbsoluteJoint(home)).chain(motions);
    let go = |(index, motion)| Move {
        line: Some(10 + index),
        ..Move::new(motion, Speed::predefined("v100").unwrap(), Zone::stop())
    };
    program.moves = all.enumerate().map(go).collect();
    program
}

fn settings() -> FollowSettings {
    FollowSettings { locate: true, ..FollowSettings::default() }
}

fn faults(arm: &Arm, program: &Program) -> Vec<(usize, Refusal)> {
    let checked = check(arm, program, program.moves.len(), &Surroundings::default(), &settings());
    assert_eq!(checked.followed + checked.ends_only, program.moves.len());
    checked.findings.into_iter().map(|finding| (finding.index, finding.refusal)).collect()
}

#[test]
fn moves_within_reach_pass_by_lines_arcs_and_joints() {
    let arm = arm();
    let start = at(&arm, [10.0, 5.0, 10.0, 20.0, 50.0, -30.0], "p0");
    let program = program(vec![
        Motion::Joint(start.clone()),
        Motion::Linear(shifted(&start, 0.0, 0.05, -0.03)),
        Motion::Circular { via: shifted(&start, 0.03, 0.07, 0.0), to: shifted(&start, 0.0, 0.09, 0.03) },
        Motion::Linear(start.clone()),
    ]);
    assert_eq!(program.problems(), []);
    assert_eq!(faults(&arm, &program), []);
    // The same from an arm that stands anywhere: the first move's start is not known.
    let mut alone = program.clone();
    alone.moves.drain(..2);
    let checked = check(&arm, &alone, 3, &Surroundings::default(), &settings());
    assert_eq!((checked.followed, checked.ends_only, checked.findings), (2, 1, vec![]));
}

#[test]
fn limits_are_found_with_their_numbers_and_a_way_out() {
    let arm = arm();
    let beyond = program(vec![Motion::AbsoluteJoint(JointTarget {
        name: Some("far".into()),
        joints: rad([0.0, 0.0, 0.0, 163.1, 30.0, 0.0]),
        external: NO_EXTERNAL,
    })]);
    let checked = check(&arm, &beyond, 2, &Surroundings::default(), &settings());
    let told: Vec<String> = checked.findings.iter().map(|finding| finding.in_words(&[])).collect();
    assert_eq!(told, ["line 11: UNREACHABLE home→far: axis 4 at 163.1° > 160.0° at 100 % of the move"]);
    // Axis 4 would be at 170°; with the wrist flipped it is at −10°.
    let flipped = at(&arm, [10.0, 5.0, 10.0, 170.0, 50.0, -30.0], "p1");
    assert_eq!(flipped.configuration, Some([0, 1, -1, 0]));
    let checked = check(&arm, &program(vec![Motion::Joint(flipped)]), 2, &Surroundings::default(), &settings());
    let finding = &checked.findings[0];
    assert!(matches!(finding.refusal, Refusal::JointLimit { axis: 3, angle, bound, .. }
        if (angle.to_degrees() - 170.0).abs() < 1e-6 && (bound.to_degrees() - 160.0).abs() < 1e-9));
    let fit = finding.fit.unwrap();
    assert_eq!((fit.configuration[1], fit.configuration[3]), (-1, 1));
    assert!(
        finding.in_words(&[]).contains("home→p1: axis 4 at 170.0° > 160.0° at 100 % of the move; with cf4 = −1"),
        "{finding:?}"
    );
}

/// A straight move along which axis 1 passes its bound: found where it does, by its closed form.
#[test]
fn a_limit_on_the_way_is_found_where_it_is() {
    let arm = arm();
    let (from, to) =
        (at(&arm, [150.0, 0.0, 0.0, 0.0, 60.0, 0.0], "a"), at(&arm, [175.0, 0.0, 0.0, 0.0, 60.0, 0.0], "b"));
    let found = faults(&arm, &program(vec![Motion::Joint(from), Motion::Linear(to)]));
    let [(2, Refusal::JointLimit { axis: 0, angle, bound, at })] = found[..] else { panic!("{found:?}") };
    assert!(angle > bound && (bound.to_degrees() - 165.0).abs() < 1e-9 && angle.to_degrees() < 165.5);
    // On the chord from 150° to 175° the ray at 165° is met at sin 15° / (sin 15° + sin 10°).
    let [a, b] = [15.0_f64, 10.0].map(|degrees| degrees.to_radians().sin());
    assert!((at - a / (a + b)).abs() < 0.02, "{at}");
}

#[test]
fn reach_and_singularities_are_found() {
    let arm = arm();
    let start = at(&arm, [0.0, 0.0, 0.0, 0.0, 60.0, 0.0], "a");
    let away = shifted(&start, 0.8, 0.0, 0.0);
    let out = faults(&arm, &program(vec![Motion::Joint(start.clone()), Motion::Linear(away.clone())]));
    assert_eq!(out, [(2, Refusal::OutOfReach { at: 1.0 })]);
    let in_base = |target: &PoseTarget| object().base_from_object() * target.pose;
    let carried = crate::robot::arm::Tool { tcp: tool().tcp, ..crate::robot::arm::Tool::flange() };
    let (way, from) = (Way::linear(&in_base(&start), &in_base(&away)), rad([0.0, 0.0, 0.0, 0.0, 60.0, 0.0]));
    let stopped = follow(&arm, &carried, None, &way, &from, &settings(), &mut 0);
    let Err(Refusal::Singular { margin, at: share, .. }) = stopped else { panic!("{stopped:?}") };
    // The wrist's centre leaves the sphere of the stretched arm about the shoulder: |w + s·d|² = (c2 + √(a2² + c3²))².
    let wrist = arm.forward(&rad([0.0, 0.0, 0.0, 0.0, 60.0, 0.0])) * Point3::new(0.0, 0.0, -0.072)
        - Point3::new(0.0, 0.0, 0.29);
    let way = object().base_from_object().rotation * Vector3::new(0.8, 0.0, 0.0);
    let (half, room) = (wrist.dot(&way), wrist.norm_squared() - (0.27 + 0.07_f64.hypot(0.302)).powi(2));
    let leaves = (-half + (half * half - way.norm_squared() * room).sqrt()) / way.norm_squared();
    assert!(margin.of == Singularity::Elbow && share < leaves && leaves - share < 2e-3, "{margin:?} {share} {leaves}");
    let far = faults(&arm, &program(vec![Motion::Joint(shifted(&start, 3.0, 0.0, 0.0))]));
    assert_eq!(far, [(1, Refusal::OutOfReach { at: 1.0 })]);
    // Whatever is undecided on a straight way: it has no end.
    for (x, from) in [(1.5, 30.0), (0.9, 30.0), (1.5, 0.0)] {
        let start = at(&arm, [0.0, 0.0, 0.0, 0.0, from, 0.0], "a");
        let far = shifted(&start, x, 0.0, 0.0);
        let via = shifted(&start, 0.5 * x, 0.2, 0.0);
        for motion in [Motion::Linear(far.clone()), Motion::Circular { via, to: far }] {
            let asked = program(vec![Motion::Joint(start.clone()), motion]);
            let found = check(&arm, &asked, 3, &Surroundings::default(), &settings()).findings;
            let far: Vec<_> = found.iter().filter(|finding| finding.index == 2).collect();
            assert!(
                matches!(&far[..], [only] if !only.open && only.in_words(&[]).contains("UNREACHABLE")),
                "{found:?}"
            );
        }
    }
    // Axis 5 goes from 20° through 0° to −20°.
    let (a, b) = (at(&arm, [0.0, 0.0, 0.0, 0.0, 20.0, 0.0], "a"), at(&arm, [0.0, 0.0, 0.0, 0.0, -20.0, 0.0], "b"));
    let found = faults(&arm, &program(vec![Motion::Joint(a), Motion::Linear(b)]));
    let [(2, Refusal::Singular { margin, least, at })] = found[..] else { panic!("{found:?}") };
    assert!(margin.of.to_string() == "wrist" && margin.value < least && (at - 0.5).abs() < 0.1, "{margin:?} {at}");
}

#[test]
fn demanded_configurations_are_held_to() {
    let arm = arm();
    let start = at(&arm, [10.0, 5.0, 10.0, 20.0, 50.0, -30.0], "a");
    let wrong = PoseTarget { configuration: Some([2, 0, 0, 0]), ..start.clone() };
    let mut asked = program(vec![Motion::Joint(wrong.clone())]);
    assert_eq!(faults(&arm, &asked), [(1, Refusal::NoSuchConfiguration { demanded: [2, 0, 0, 0] })]);
    asked.moves[1].configuration_demanded = false;
    assert_eq!(faults(&arm, &asked), []);
    let other = PoseTarget { configuration: Some([0, 1, -1, 0]), ..shifted(&start, 0.0, 0.02, 0.0) };
    let mut asked = program(vec![Motion::Joint(start), Motion::Linear(other)]);
    let found = faults(&arm, &asked);
    let arrives = [0, 0, -1, 0];
    assert_eq!(found, [(2, Refusal::ArrivesOtherwise { demanded: [0, 1, -1, 0], arrives })]);
    asked.moves[2].configuration_demanded = false;
    assert_eq!(faults(&arm, &asked), []);
}

#[test]
fn a_bound_that_is_passed_by_little_is_told_so() {
    let [angle, bound] = [70.00001_f64, 70.0].map(f64::to_radians);
    let refusal = Refusal::JointLimit { axis: 2, angle, bound, at: 1.0 };
    assert_eq!(refusal.in_words(&[]).to_string(), "axis 3 at 70.00001° > 70.00000° at 100 % of the move");
}

/// What a cfx means of a chain nobody knows: it is no finding that another one is demanded, and it is told once.
#[test]
fn configurations_of_a_chain_are_not_found_out() {
    let arm = arm();
    let start = at(&arm, [10.0, 5.0, 10.0, 20.0, 50.0, -30.0], "a");
    let chain = Arm { kinematics: Kinematics::Chain, ..arm };
    let other = PoseTarget { configuration: Some([0, 0, -1, 4]), ..start };
    let ways = || vec![Motion::Joint(other.clone()), Motion::Linear(shifted(&other, 0.0, 0.02, 0.0))];
    let mut asked = program(ways());
    let found =
        |asked: &Program| check(&chain, asked, asked.moves.len(), &Surroundings::default(), &settings()).findings;
    let once = found(&asked);
    let [only] = &once[..] else { panic!("{once:?}") };
    assert_eq!((only.index, only.refusal), (1, Refusal::UnknownConfiguration { demanded: [0, 0, -1, 4] }));
    assert!(only.open && only.fit.is_none() && only.in_words(&[]).starts_with("line 11: INCONCLUSIVE home→a: "));
    // A posture that is assumed fails nothing for certain: with other bounds the same way is not found out either.
    let mut narrow = chain.clone();
    narrow.limits[4].upper = 50.0_f64.to_radians() + 1e-3;
    let all = check(&narrow, &program(ways()), 3, &Surroundings::default(), &settings()).findings;
    assert!(all.iter().all(|finding| finding.open), "{all:?}");
    asked.moves[1..].iter_mut().for_each(|m| m.configuration_demanded = false);
    assert_eq!(found(&asked).len(), 0);
}

/// A flange that looks back at the arm: nearer than all lengths together, and the wrist cannot come there. A closed
/// inverse proves that, and that Newton's steps find nothing does not.
#[test]
fn what_a_search_does_not_find_is_not_found_out() {
    let arm = arm();
    let back =
        Isometry3::from_parts(Translation3::new(0.65, 0.0, 0.29), UnitQuaternion::new(Vector3::y() * -FRAC_PI_2));
    let asked = |flange: Isometry3<f64>| {
        let pose = object().base_from_object().inverse() * flange * tool().tcp;
        program(vec![Motion::Joint(PoseTarget::unnamed(pose))])
    };
    let chain = Arm { kinematics: Kinematics::Chain, ..arm.clone() };
    let found = |arm: &Arm, flange: Isometry3<f64>| {
        let all = check(arm, &asked(flange), 2, &Surroundings::default(), &settings()).findings;
        let [only] = &all[..] else { panic!("{all:?}") };
        only.clone()
    };
    let open = found(&chain, back);
    assert_eq!((open.refusal, open.open), (Refusal::NotFound { at: 1.0 }, true));
    let told = open.in_words(&[]);
    assert!(told.contains("INCONCLUSIVE home→") && told.contains("no posture within the limits found"), "{told}");
    let proven = found(&arm, back);
    assert_eq!((proven.refusal, proven.open), (Refusal::OutOfReach { at: 1.0 }, false));
    // Farther off than all lengths together nothing is.
    let far = found(&chain, Translation3::new(3.0, 0.0, 0.0) * back);
    assert_eq!((far.refusal, far.open), (Refusal::OutOfReach { at: 1.0 }, false));
}

#[test]
fn obstacles_are_met_where_they_stand() {
    let arm = arm();
    let start = at(&arm, [0.0, 10.0, 0.0, 0.0, 50.0, 0.0], "a");
    let way = object().base_from_object().rotation * Vector3::new(0.0, 0.2, 0.0);
    let tip = (arm.forward(&rad([0.0, 10.0, 0.0, 0.0, 50.0, 0.0])) * tool().tcp).translation.vector;
    // A thin rod across the way of the tool's point, at 60 % of it: thinner than any two samples are apart.
    let across = way.cross(&Vector3::z()).normalize();
    let middle = tip + way * 0.6;
    let rod = Shape::capsule((middle - across * 0.3).into(), (middle + across * 0.3).into(), 0.002).unwrap();
    let cell = Cell { parts: vec![Part { name: "rod".into(), region: Region::Shape(rod) }] };
    let end = PoseTarget { configuration: None, ..shifted(&start, 0.0, 0.2, 0.0) };
    let asked = program(vec![Motion::Joint(start.clone()), Motion::Linear(end)]);
    assert_eq!(faults(&arm, &asked), []);
    let around = Surroundings { cell: Some(&cell), tool_radius: 0.01, clearance: 0.0 };
    let found = check(&arm, &asked, 3, &around, &settings()).findings;
    let [finding] = &found[..] else { panic!("{found:?}") };
    let Refusal::Collides { link: 7, part: 0, at, .. } = finding.refusal else { panic!("{finding:?}") };
    let first = 0.6 - 0.012 / way.norm();
    assert!((at - first).abs() < 0.02, "{at} {first}");
    let told = finding.in_words(&["rod".into()]);
    assert!(told.starts_with("line 12: COLLISION a→a: the tool meets rod at "), "{told}");
    // Moves in joints are followed too: the arm that swings through a post is told so.
    let post = Shape::capsule([0.3, 0.3, 0.0], [0.3, 0.3, 1.0], 0.05).unwrap();
    let cell = Cell { parts: vec![Part { name: "post".into(), region: Region::Shape(post) }] };
    let aside = JointTarget {
        name: Some("aside".into()),
        joints: rad([90.0, 0.0, 0.0, 0.0, 30.0, 0.0]),
        external: NO_EXTERNAL,
    };
    let around = Surroundings { cell: Some(&cell), ..around };
    let found = check(&arm, &program(vec![Motion::AbsoluteJoint(aside)]), 2, &around, &settings()).findings;
    assert!(matches!(found[..], [super::Finding { refusal: Refusal::Collides { part: 0, .. }, .. }]), "{found:?}");
}

/// What one move does wrong is told once: the next goes on from the program's own state, which demands no
/// configuration.
#[test]
fn a_finding_leaves_the_state_of_the_program() {
    let arm = arm();
    let start = at(&arm, [10.0, 5.0, 10.0, 20.0, 50.0, -30.0], "a");
    // Nobody has these quadrants there.
    let free = PoseTarget { configuration: Some([2, 2, 2, 0]), ..start.clone() };
    let far = PoseTarget { pose: Translation3::new(2.0, 0.0, 0.0) * start.pose, ..free.clone() };
    let away = JointTarget {
        name: Some("away".into()),
        joints: rad([0.0, 0.0, 0.0, 200.0, 30.0, 0.0]),
        external: NO_EXTERNAL,
    };
    for wrong in [Motion::Linear(far.clone()), Motion::Joint(far), Motion::AbsoluteJoint(away)] {
        let after = |demanded: bool| {
            let mut asked = program(vec![
                Motion::Joint(free.clone()),
                wrong.clone(),
                Motion::Linear(shifted(&free, 0.0, 0.02, 0.0)),
                Motion::Joint(free.clone()),
            ]);
            asked.moves[1..].iter_mut().for_each(|m| m.configuration_demanded = demanded);
            faults(&arm, &asked).into_iter().map(|(index, _)| index).collect::<Vec<_>>()
        };
        assert_eq!(after(false), [2], "{wrong:?}");
        assert_eq!(after(true), [1, 2, 3, 4], "{wrong:?}");
    }
}
