//! Programs followed twice, by the virtual controller and by the proof, which share no equation: both must come to the
//! same places.

use std::f64::consts::{FRAC_PI_2, PI};

use nalgebra::{Isometry3, Point3, Translation3, UnitQuaternion, Vector3};

use super::*;
use crate::math::random::{Stream, stream, unit};
use crate::robot::arm::{JointLimit, Opw};
use crate::simulation::arm::{Order, Plan, PlanSettings, RunSettings};
use crate::trajectory::program::{JointTarget, NO_EXTERNAL, Speed, Tool, WorkObject, Zone};
use crate::verification::{ArmClaim, ArmPath, ArmPiece, ArmProgramClaim, verify_arm_program};

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
        chain: opw.chain(),
        kinematics: Kinematics::Opw(opw),
        limits: bounds.map(limit),
        links: Default::default(),
        estimated: Vec::new(),
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
    let all = arm.inverse(flange, &near).into_iter().filter(|q| arm.outside_limits(q).is_none());
    let upright = |q: &Joints| q[3].abs() + q[1].abs();
    all.min_by(|a, b| upright(a).total_cmp(&upright(b)))
}

fn any(random: &mut Stream, most: f64) -> Isometry3<f64> {
    let mut vector = |most: f64| Vector3::from_fn(|_, _| between(-most, most, random));
    Isometry3::from_parts(vector(0.1).into(), UnitQuaternion::from_scaled_axis(vector(most)))
}

/// A program of every kind of move from where its first posture puts the arm, through tools and work objects, with
/// stops and zones. Configurations are demanded where `configured`.
fn random_program(arm: &Arm, random: &mut Stream, configured: bool) -> Program {
    let tools = [Tool::flange(), Tool { tcp: any(random, 0.3), ..Tool::flange() }];
    let object =
        |random: &mut Stream| WorkObject { user: any(random, 2.0), object: any(random, 2.0), ..WorkObject::base() };
    let objects = [WorkObject::base(), object(random)];
    let mut program = Program::new("Random", "main", tools[0].clone(), objects[0].clone());
    program.tools = tools.to_vec();
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
            tool = 1 - tool;
        }
        let (work_object, flange) = ((2.0 * unit(random)) as usize, pose(random));
        let into_object = program.work_objects[work_object].base_from_object().inverse();
        let Some(joints) = stand(arm, &flange) else { continue };
        let pose_of = |flange: &Isometry3<f64>| into_object * flange * program.tools[tool].tcp;
        let configuration = configured.then(|| arm.configuration(&joints).numbers());
        let to = PoseTarget { configuration, ..PoseTarget::unnamed(pose_of(&flange)) };
        let motion = match kind {
            0 => Motion::AbsoluteJoint(JointTarget { name: None, joints, external: NO_EXTERNAL }),
            1 => Motion::Joint(to),
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

fn moves(arm: &Arm, program: &Program) -> Vec<ArmProgramMove> {
    let chain = matches!(arm.kinematics, Kinematics::Chain);
    moves_of(program, |_, _| None::<Joints>.filter(|_| chain))
}

/// Distance, m, a turn of 1 rad counting as 0.1 m.
fn off(a: &Isometry3<f64>, b: &Isometry3<f64>) -> f64 {
    (a.translation.vector - b.translation.vector).norm() + 0.1 * a.rotation.angle_to(&b.rotation)
}

/// How far a pose lies from pieces of a path.
fn distance(path: &ArmPath, pieces: &[ArmPiece], pose: &Isometry3<f64>) -> f64 {
    const SHARES: usize = 512;
    let at = |piece: ArmPiece, w: f64| off(&path.at(piece, w).unwrap().1, pose);
    let coarse = pieces.iter().flat_map(|piece| (0..=SHARES).map(move |i| (*piece, i as f64 / SHARES as f64)));
    let (piece, w) = coarse.min_by(|a, b| at(a.0, a.1).total_cmp(&at(b.0, b.1))).unwrap();
    let (mut low, mut high) = ((w - 1.0 / SHARES as f64).max(0.0), (w + 1.0 / SHARES as f64).min(1.0));
    while high - low > 1e-13 {
        let (left, right) = (low + 0.4 * (high - low), low + 0.6 * (high - low));
        if at(piece, left) < at(piece, right) { high = right } else { low = left }
    }
    at(piece, low)
}

#[test]
fn look_at_it() {
    for (number, arm) in arms().iter().enumerate() {
        let (mut whole, mut stopped, mut disagree) = (0, 0, 0);
        for seed in 0..8u64 {
            let mut random = stream(1000 * number as u64 + seed);
            let program = random_program(arm, &mut random, seed % 2 == 0 && number != 3);
            if !program.problems().is_empty() {
                continue;
            }
            let orders = Order::all_of(&program).unwrap();
            let plan = Plan::new(arm, &start(&program), &orders, &PlanSettings::default()).unwrap();
            claimed(arm, &program, |claim| {
                let moves = moves(arm, &program);
                let waypoints = vec![Point3::origin(); moves.len()];
                let asked = ArmProgramClaim {
                    start: start(&program),
                    moves: &moves,
                    waypoints: &waypoints,
                    singularity: 0.01,
                    clear: false,
                };
                let replay = verify_arm_program(claim, &asked);
                match (plan.stop(), replay.findings.first()) {
                    (None, None) => {}
                    (Some(stop), Some(finding)) if stop.order.abs_diff(finding.index) <= 1 => {
                        stopped += 1;
                        return;
                    }
                    (stop, finding) => {
                        println!(
                            "arm {number} seed {seed}: {stop:?} {} | {finding:?}",
                            stop.map_or(String::new(), |s| s.reason.to_string())
                        );
                        disagree += 1;
                        return;
                    }
                }
                whole += 1;
                let path = ArmPath::of(claim, &asked);
                let planned = plan.path();
                let pieces = path.pieces();
                let mut begin = 0;
                let mut worst_end = 0.0f64;
                let mut histogram = [0; 16];
                for (k, m) in planned.moves().iter().enumerate() {
                    let end = if pieces.contains(&ArmPiece::Corner(k)) {
                        path.at(ArmPiece::Corner(k), 0.5)
                    } else {
                        path.at(ArmPiece::Along(k, [0.0, 1.0]), 1.0)
                    }
                    .unwrap();
                    worst_end = worst_end.max(off(&end.1, &planned.track().poses()[m.end]));
                    if seed < 8 {
                        let own: Vec<ArmPiece> = pieces
                            .iter()
                            .copied()
                            .filter(|p| match p {
                                ArmPiece::Along(i, _) => *i == k,
                                ArmPiece::Corner(i) => *i == k || *i + 1 == k,
                            })
                            .collect();
                        for i in (begin + 1..m.end).step_by(7) {
                            let d = distance(&path, &own, &planned.track().poses()[i]);
                            let bin = (-d.max(1e-15).log10()) as usize;
                            histogram[bin] += 1;
                            if d > 2e-6 {
                                for j in i.saturating_sub(3)..i + 4 {
                                    let q = &planned.track().poses()[j];
                                    println!(
                                        "   {j} t {} p {:?} d {:e}",
                                        planned.track().times()[j],
                                        q.translation.vector.as_slice(),
                                        distance(&path, &own, q)
                                    );
                                }
                                println!(
                                    "arm {number} seed {seed} move {k} pose {i} of {begin}..{}: {d:e} {own:?} {:?}",
                                    m.end,
                                    std::mem::discriminant(&program.moves[k].motion)
                                );
                            }
                        }
                    }
                    begin = m.end;
                }
                let run = plan.execute(&RunSettings { lag: 0.0, ..RunSettings::default() }, &[], 1).unwrap();
                let last = run.recording.len() - 1;
                let joints: Joints =
                    std::array::from_fn(|j| run.recording.channel(&format!("q{}_rad", j + 1)).unwrap()[last]);
                let other = path.at(*pieces.last().unwrap(), 1.0).unwrap().0;
                let apart = (0..6).map(|j| (joints[j] - other[j]).abs()).fold(0.0, f64::max);
                if apart > 1e-8 || worst_end > 1e-9 {
                    println!("arm {number} seed {seed}: joints {apart:e} ends {worst_end:e}");
                }
                if seed < 8 {
                    println!("{number} {seed} {histogram:?}");
                }
            });
        }
        println!("arm {number}: whole {whole} stopped {stopped} disagree {disagree}");
    }
}
