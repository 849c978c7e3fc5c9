//! Programs followed twice, by the virtual controller and by the proof, which share no equation: both must come to the
//! same places.

use std::f64::consts::{FRAC_PI_2, PI};

use nalgebra::{Isometry3, Point3, Translation3, UnitQuaternion, Vector3};

use super::*;
use crate::math::random::{Stream, stream, unit};
use crate::robot::arm::{JointLimit, Opw};
use crate::simulation::arm::{Order, Plan, PlanSettings, RunSettings};
use crate::trajectory::program::{JointTarget, NO_EXTERNAL, Speed, Tool, WorkObject, Zone};
use crate::verification::{ArmClaim, ArmPath, ArmPiece, ArmProgramClaim, ArmProgramReplay, verify_arm_program};

/// A small arm of 0.58 m whose arm's plane passes `b` beside axis 1, its axes counting as `signs` say.
fn arm(b: f64, signs: Joints) -> Arm {
    let offsets = [0.0, 0.0, -FRAC_PI_2, 0.0, 0.0, 0.0];
    let opw = Opw { a1: 0.02, a2: -0.07, b, c1: 0.29, c2: 0.27, c3: 0.302, c4: 0.072, offsets, signs };
    let bounds = [165.0, 110.0, 110.0, 160.0, 120.0, 400.0_f64];
    let limit = |bound: f64| JointLimit {
        lower: -bound.to_radians(),
        upper: bound.to_radians(),
        speed: 4.0,
        acceleration: 24.0,
    };
    Arm {
        name: "small".into(),
        caveat: String::new(),
        source: String::new(),
        up: Vector3::z(),
        base_from_controller: Isometry3::identity(),
        chain: opw.chain(),
        kinematics: Kinematics::Opw(opw),
        limits: bounds.map(limit),
        coupling: Default::default(),
        lags: None,
        joint_names: Default::default(),
        links: Default::default(),
        estimated: Vec::new(),
        excluded: Vec::new(),
    }
}

/// The same arm as one of which nothing is known but its joints.
fn chain(arm: &Arm) -> Arm {
    Arm { kinematics: Kinematics::Chain, ..arm.clone() }
}

fn arms() -> Vec<Arm> {
    let signs = [[1.0; 6], [1.0, 1.0, -1.0, -1.0, -1.0, -1.0], [-1.0, 1.0, -1.0, -1.0, 1.0, 1.0]];
    vec![arm(0.0, signs[0]), arm(0.03, signs[1]), arm(-0.02, signs[2]), chain(&arm(0.0, signs[0]))]
}

fn between(low: f64, high: f64, random: &mut Stream) -> f64 {
    low + (high - low) * unit(random)
}

/// A pose before the arm with the tool about down, base frame.
fn pose(random: &mut Stream) -> Isometry3<f64> {
    let place = [between(0.25, 0.42, random), between(-0.22, 0.22, random), between(0.1, 0.35, random)];
    let down = UnitQuaternion::from_axis_angle(&Vector3::y_axis(), PI);
    let tilt = |random: &mut Stream| between(-0.5, 0.5, random);
    let tilted = Vector3::new(0.4 * tilt(random), 0.4 * tilt(random), 1.2 * tilt(random));
    Isometry3::from_parts(Translation3::from(place), UnitQuaternion::from_scaled_axis(tilted) * down)
}

/// Joint angles with the flange at a pose, the arm upright, and nothing out of bounds.
fn stand(arm: &Arm, flange: &Isometry3<f64>) -> Option<Joints> {
    let near = [0.0, 0.0, 0.0, 0.0, 0.5, 0.0];
    let all = match arm.kinematics {
        // Where Newton's steps from there lead, and nowhere else: what is folded otherwise is not upright.
        Kinematics::Chain => arm.chain.inverse_near(flange, &near).map(|found| found.joints).into_iter().collect(),
        Kinematics::Opw(_) => arm.inverse(flange, &near),
    };
    let all = all.into_iter().filter(|q| arm.outside_limits(q).is_none());
    let upright = |q: &Joints| q[3].abs() + q[1].abs();
    all.min_by(|a, b| upright(a).total_cmp(&upright(b)))
}

fn any(random: &mut Stream, most: f64) -> Isometry3<f64> {
    let mut vector = |most: f64| Vector3::from_fn(|_, _| between(-most, most, random));
    Isometry3::from_parts(vector(0.1).into(), UnitQuaternion::from_scaled_axis(vector(most)))
}

/// A program of every kind of move from where its first posture puts the arm, through so many tools and two work
/// objects, with stops and zones. Configurations are demanded where `configured`; chains, of which none tells the
/// posture, go to poses on lines and arcs alone.
fn random_program(arm: &Arm, random: &mut Stream, tools: usize, configured: bool) -> Program {
    let chain = matches!(arm.kinematics, Kinematics::Chain);
    let all = [Tool { tcp: any(random, 0.3), ..Tool::flange() }, Tool::flange()];
    let object =
        |random: &mut Stream| WorkObject { user: any(random, 2.0), object: any(random, 2.0), ..WorkObject::base() };
    let objects = [WorkObject::base(), object(random)];
    let mut program = Program::new("Random", "main", all[0].clone(), objects[0].clone());
    program.tools = all[..tools].to_vec();
    program.work_objects = objects.to_vec();
    let posture = loop {
        if let Some(joints) = stand(arm, &pose(random)) {
            break JointTarget { name: None, joints, external: NO_EXTERNAL };
        }
    };
    let fast = Speed::predefined("v1000").unwrap();
    program.moves.push(Move::new(Motion::AbsoluteJoint(posture), fast.clone(), Zone::stop()));
    let mut tool = 0;
    while program.moves.len() < 7 {
        let kind = (4.5 * unit(random)) as usize;
        if unit(random) < 0.2 {
            tool = (tool + 1) % tools;
        }
        let (work_object, flange) = ((2.0 * unit(random)) as usize, pose(random));
        let into_object = program.work_objects[work_object].base_from_object().inverse();
        let Some(joints) = stand(arm, &flange) else { continue };
        let pose_of = |flange: &Isometry3<f64>| into_object * flange * program.tools[tool].tcp;
        let configuration = configured.then(|| arm.configuration(&joints).numbers());
        let to = PoseTarget { configuration, ..PoseTarget::unnamed(pose_of(&flange)) };
        let motion = match kind {
            0 => Motion::AbsoluteJoint(JointTarget { name: None, joints, external: NO_EXTERNAL }),
            1 if !chain => Motion::Joint(to),
            2 => Motion::Circular { via: PoseTarget::unnamed(pose_of(&pose(random))), to },
            _ => Motion::Linear(to),
        };
        let zone = Zone::predefined(["fine", "z1", "z10", "z50"][(4.0 * unit(random)) as usize]).unwrap();
        program.moves.push(Move { tool, work_object, ..Move::new(motion, fast.clone(), zone) });
    }
    program
}

fn start(program: &Program) -> Joints {
    match &program.moves[0].motion {
        Motion::AbsoluteJoint(to) => to.joints,
        other => panic!("{other:?} is no posture"),
    }
}

/// Hands `arm` with the program's first tool to `look`.
fn claimed<T>(arm: &Arm, program: &Program, look: impl FnOnce(&ArmClaim) -> T) -> T {
    let (build, flange, tool) = (build_of(arm), arm.chain.flange, program.tools[0].tcp);
    look(&ArmClaim { joints: &joints_of(arm), build, flange, tool, bodies: &[], solids: &[], clearance: 0.0 })
}

/// Follows a program by both: the controller's plan, the proof's path, and what came of that.
fn both(
    arm: &Arm,
    program: &Program,
    waypoints: &[Point3<f64>],
    look: impl FnOnce(&Plan, &ArmPath, &ArmProgramReplay),
) {
    let orders = Order::all_of(program).unwrap();
    let settings = PlanSettings::default();
    let plan = Plan::new(arm, &start(program), &orders, &settings).unwrap();
    let moves = moves_of(program, |_, _| None);
    let asked = ArmProgramClaim {
        start: start(program),
        moves: &moves,
        waypoints,
        singularity: settings.singularity,
        clear: false,
    };
    claimed(arm, program, |claim| look(&plan, &ArmPath::of(claim, &asked), &verify_arm_program(claim, &asked)));
}

/// Distance, m, a turn of 1 rad counting as 0.1 m.
fn off(a: &Isometry3<f64>, b: &Isometry3<f64>) -> f64 {
    (a.translation.vector - b.translation.vector).norm() + 0.1 * a.rotation.angle_to(&b.rotation)
}

/// How far a pose lies from pieces of a path.
fn distance(path: &ArmPath, pieces: &[ArmPiece], pose: &Isometry3<f64>) -> f64 {
    const SHARES: usize = 256;
    const STEP: f64 = 1.0 / SHARES as f64;
    let at = |piece: ArmPiece, w: f64| off(&path.at(piece, w).unwrap().1, pose);
    let coarse = pieces.iter().flat_map(|piece| (0..=SHARES).map(move |i| (*piece, i as f64 * STEP)));
    let (_, piece, w) = coarse.map(|(piece, w)| (at(piece, w), piece, w)).min_by(|a, b| a.0.total_cmp(&b.0)).unwrap();
    let (mut low, mut high) = ((w - STEP).max(0.0), (w + STEP).min(1.0));
    while high - low > 1e-14 {
        let (left, right) = (low + 0.4 * (high - low), low + 0.6 * (high - low));
        if at(piece, left) < at(piece, right) { high = right } else { low = left }
    }
    at(piece, low)
}

/// Holds every fifth pose of the plan against the proof's path: how many were exact, and how many were looked at. What
/// lies between the plan's nodes is a cubic through joint angles.
fn compared(plan: &Plan, path: &ArmPath, case: &str) -> [usize; 2] {
    let (planned, pieces) = (plan.path(), path.pieces());
    let (mut exact, mut seen, mut begin) = (0, 0, 0);
    for (k, one) in planned.moves().iter().enumerate() {
        let cut = pieces.contains(&ArmPiece::Corner(k));
        assert!(!(one.stops && cut), "{case}, move {k}");
        let own = pieces.iter().copied().filter(|piece| match piece {
            ArmPiece::Along(index, _) => *index == k,
            ArmPiece::Corner(index) => *index == k || *index + 1 == k,
        });
        let own: Vec<ArmPiece> = own.collect();
        let along = own.iter().copied().find(|piece| matches!(piece, ArmPiece::Along(..))).unwrap();
        let end = if cut { path.at(ArmPiece::Corner(k), 0.5) } else { path.at(along, 1.0) };
        let miss = off(&end.unwrap().1, &planned.track().poses()[one.end]);
        assert!(miss < 1e-9, "{case}, move {k} ends {miss:e} m apart");
        for i in (begin + 1..one.end).step_by(5) {
            let off = distance(path, &own, &planned.track().poses()[i]);
            assert!(off < 2e-6, "{case}, move {k}: pose {i} is {off:e} m off");
            exact += usize::from(off < 1e-9);
            seen += 1;
        }
        begin = one.end;
    }
    let run = plan.execute(&RunSettings { lags: [0.0; 6], ..RunSettings::default() }, &[], 1).unwrap().recording;
    let angle = |k: usize| run.channel(&format!("q{}_rad", k + 1)).unwrap()[run.len() - 1];
    let last = path.at(*pieces.last().unwrap(), 1.0).unwrap().0;
    assert!((0..6).all(|k| (angle(k) - last[k]).abs() < 1e-9), "{case}: ends in {last:?}");
    [exact, seen]
}

#[test]
fn controller_and_proof_come_to_the_same_places() {
    let (mut whole, mut stopped, mut exact, mut seen) = (0, 0, 0, 0);
    for (number, arm) in arms().iter().enumerate() {
        for seed in 0..60u64 {
            let case = format!("arm {number}, seed {seed}");
            let program = random_program(arm, &mut stream(1000 * number as u64 + seed), 2, seed % 2 == 0);
            if !program.problems().is_empty() {
                continue;
            }
            both(arm, &program, &vec![Point3::origin(); program.moves.len()], |plan, path, replay| {
                match (plan.stop(), replay.findings.first()) {
                    (None, None) => whole += 1,
                    // A corner belongs to both moves.
                    (Some(stop), Some(finding)) if stop.order.abs_diff(finding.index) <= 1 => stopped += 1,
                    (stop, finding) => panic!("{case}: {stop:?}, {finding:?}"),
                }
                if plan.stop().is_none() && seed < 12 {
                    let [own, all] = compared(plan, path, &case);
                    (exact, seen) = (exact + own, seen + all);
                }
            });
        }
    }
    assert!(whole > 100 && stopped > 20, "{whole} {stopped}");
    assert!(seen > 1000 && 10 * exact > 9 * seen, "{exact} of {seen}");
}

/// Where the moves of a program end, base frame.
fn ends(arm: &Arm, program: &Program) -> Vec<Point3<f64>> {
    let end = |one: &Move| match &one.motion {
        Motion::AbsoluteJoint(to) => arm.forward(&to.joints) * program.tools[one.tool].tcp,
        motion => program.work_objects[one.work_object].base_from_object() * motion.end().unwrap().pose,
    };
    program.moves.iter().map(|one| end(one).translation.vector.into()).collect()
}

#[test]
fn what_was_changed_in_a_program_is_found() {
    let mut tried = 0;
    for (number, arm) in arms().iter().enumerate() {
        for seed in 0..20u64 {
            let written = random_program(arm, &mut stream(5000 + 1000 * number as u64 + seed), 1, true);
            let waypoints = ends(arm, &written);
            let found = |program: &Program| {
                let mut found = 0;
                if program.problems().is_empty() {
                    both(arm, program, &waypoints, |_, _, replay| {
                        let missed = replay.misses.iter().filter(|miss| **miss > 1e-6).count();
                        found = missed + replay.findings.len();
                    });
                }
                found
            };
            if !written.problems().is_empty() || found(&written) > 0 {
                continue;
            }
            let changed = |change: &dyn Fn(&mut Program)| {
                let mut program = written.clone();
                change(&mut program);
                program
            };
            let shift = |pose: &mut Isometry3<f64>| pose.translation.vector.y += 1e-5;
            for index in 0..written.moves.len() {
                let moved = changed(&|program| match &mut program.moves[index].motion {
                    Motion::AbsoluteJoint(to) => to.joints[2] += 1e-4,
                    Motion::Joint(to) | Motion::Linear(to) | Motion::Circular { to, .. } => shift(&mut to.pose),
                });
                assert!(found(&moved) > 0, "arm {number}, seed {seed}: target {index} was moved");
                let gone = changed(&|program| drop(program.moves.remove(index)));
                let lost = || gone.problems().is_empty() && found(&gone) == 0;
                assert!(index == 0 || !lost(), "arm {number}, seed {seed}: move {index} was taken out");
                let other = changed(&|program| match &mut program.moves[index].motion {
                    Motion::AbsoluteJoint(to) => to.joints[4] += 1e-4,
                    Motion::Joint(to) | Motion::Linear(to) | Motion::Circular { to, .. } => {
                        to.configuration = to.configuration.map(|[cf1, cf4, cf6, cfx]| [cf1, cf4, cf6, cfx ^ 1]);
                    }
                });
                assert!(found(&other) > 0, "arm {number}, seed {seed}: posture {index} was changed");
                tried += 1;
            }
            assert!(
                found(&changed(&|program| shift(&mut program.tools[0].tcp))) > 0,
                "arm {number}, seed {seed}: tool"
            );
            for object in 0..2 {
                let used = written
                    .moves
                    .iter()
                    .any(|one| one.work_object == object && !matches!(one.motion, Motion::AbsoluteJoint(_)));
                let elsewhere = changed(&|program| shift(&mut program.work_objects[object].user));
                assert!(!used || found(&elsewhere) > 0, "arm {number}, seed {seed}: work object {object}");
            }
        }
    }
    assert!(tried > 150, "{tried}");
}
