use std::f64::consts::{FRAC_PI_2, PI};

use nalgebra::{Isometry3, Matrix4, Translation3, Vector3, Vector4};
use rand::RngExt;

use super::*;
use crate::math::random::{named_seed, stream, unit};
use crate::math::rotation::{from_rotation_vector, rotation_vector};

/// The shipped arms and one with every parameter at work, as their files say.
fn arms() -> Vec<Arm> {
    let text = |name: &str| {
        let path = format!("{}/../../data/robots/arm/{name}.toml", env!("CARGO_MANIFEST_DIR"));
        std::fs::read_to_string(path).unwrap()
    };
    let mut all: Vec<ArmDescription> =
        ["irb120", "irb1200", "irb4600"].map(|name| toml::from_str(&text(name)).unwrap()).into();
    let mut odd = all[2].clone();
    odd.name = "odd".into();
    odd.opw = Some(OpwDescription {
        a1_mm: 150.0,
        a2_mm: -110.0,
        b_mm: 60.0,
        c1_mm: 550.0,
        c2_mm: 550.0,
        c3_mm: 600.0,
        c4_mm: 125.0,
        offsets_deg: [10.0, -90.0, 0.0, 180.0, 15.0, -20.0],
        signs: [-1, 1, 1, -1, -1, -1],
    });
    all.push(odd);
    all.iter().map(|description| description.build().unwrap()).collect()
}

fn opw(arm: &Arm) -> Opw {
    let Kinematics::Opw(opw) = &arm.kinematics else { panic!("{} is no OPW arm", arm.name) };
    *opw
}

/// Rotation and shift between two poses, rad and m.
fn apart(a: &Isometry3<f64>, b: &Isometry3<f64>) -> f64 {
    let turn = rotation_vector(&(a.rotation.inverse() * b.rotation)).norm();
    turn.max((a.translation.vector - b.translation.vector).norm())
}

fn random_joints(arm: &Arm, random: &mut crate::math::random::Stream) -> Joints {
    std::array::from_fn(|k| {
        let limit = &arm.limits[k];
        limit.lower + (limit.upper - limit.lower) * unit(random)
    })
}

/// Denavit and Hartenberg's transform Rz(θ) Tz(d) Tx(a) Rx(α), written out.
fn dh(theta: f64, d: f64, a: f64, alpha: f64) -> Matrix4<f64> {
    let ((st, ct), (sa, ca)) = (theta.sin_cos(), alpha.sin_cos());
    Matrix4::new(ct, -st * ca, st * sa, a * ct, st, ct * ca, -ct * sa, a * st, 0.0, sa, ca, d, 0.0, 0.0, 0.0, 1.0)
}

/// The flange by DH parameters: an independent derivation, in matrices.
fn by_dh(opw: &Opw, q: &Joints) -> Matrix4<f64> {
    let t: Vec<f64> = (0..6).map(|k| opw.signs[k] * q[k] - opw.offsets[k]).collect();
    dh(t[0], opw.c1, opw.a1, -FRAC_PI_2)
        * dh(t[1] - FRAC_PI_2, opw.b, opw.c2, 0.0)
        * dh(t[2] + FRAC_PI_2, 0.0, opw.a2, FRAC_PI_2)
        * dh(t[3], opw.c3, 0.0, -FRAC_PI_2)
        * dh(t[4], 0.0, 0.0, FRAC_PI_2)
        * dh(t[5], opw.c4, 0.0, 0.0)
}

#[test]
fn forward_kinematics_are_those_of_denavit_and_hartenberg() {
    let mut random = stream(named_seed(1, "arm forward", 0));
    for arm in arms() {
        for _ in 0..2000 {
            let q = random_joints(&arm, &mut random);
            let theirs = by_dh(&opw(&arm), &q);
            for ours in [arm.forward(&q), opw(&arm).forward(&q)] {
                let difference = (ours.to_homogeneous() - theirs).amax();
                assert!(difference < 1e-12, "{} at {q:?}: {difference}", arm.name);
            }
        }
    }
}

/// Tool positions of the data sheets' zero pose, mm: forearm level, flange looking along x.
#[test]
fn zero_poses_are_the_published_ones() {
    for (arm, mm) in arms().iter().zip([[374.0, 0.0, 630.0], [533.0, 0.0, 889.1], [1270.0, 0.0, 1570.0]]) {
        let flange = arm.forward(&[0.0; 6]);
        assert!((flange.translation.vector * 1e3 - Vector3::from(mm)).norm() < 1e-9, "{}: {flange}", arm.name);
        assert!((flange.rotation * Vector3::z() - Vector3::x()).norm() < 1e-12, "{}", arm.name);
        assert!((flange.rotation * Vector3::x() + Vector3::z()).norm() < 1e-12, "{}", arm.name);
    }
}

#[test]
fn every_axis_turns_the_right_way() {
    let irb120 = &arms()[0];
    let moved = |axis: usize| {
        let mut q = [0.0, 0.0, 0.0, 0.0, 0.3, 0.0];
        let before = irb120.forward(&q);
        q[axis] += 1e-6;
        let after = irb120.forward(&q);
        let turn = rotation_vector(&(after.rotation * before.rotation.inverse())) / 1e-6;
        (turn, (after.translation.vector - before.translation.vector) / 1e-6)
    };
    // Axis 1 up, axes 2, 3 and 5 lower the tool when they grow, axis 4 along the forearm, axis 6 along the flange.
    let flange = irb120.forward(&[0.0, 0.0, 0.0, 0.0, 0.3, 0.0]).rotation * Vector3::z();
    for (axis, direction) in
        [Vector3::z(), Vector3::y(), Vector3::y(), Vector3::x(), Vector3::y(), flange].into_iter().enumerate()
    {
        assert!((moved(axis).0 - direction).norm() < 1e-6, "axis {}: {:?}", axis + 1, moved(axis));
    }
    for axis in [1, 2, 4] {
        assert!(moved(axis).1.z < -0.01, "axis {}", axis + 1);
    }
}

/// 100 000 seeded poses an arm: every solution reaches the pose, the right one is among them, and each is of its own
/// cfx.
#[test]
fn inverse_and_forward_are_one_anothers() {
    for (number, arm) in arms().iter().enumerate() {
        let mut random = stream(named_seed(2, "arm inverse", number as u64));
        let mut told = 0;
        for i in 0..100_000 {
            let q = random_joints(arm, &mut random);
            let flange = arm.forward(&q);
            let margin = arm.margin(&q).value;
            let near = arm.inverse_in(&flange, arm.branch(&q), &q).map(|found| found.joints);
            // Near a singularity angles lose digits in proportion; the pose itself does not.
            if margin > 1e-6 {
                let found = near.unwrap_or_else(|| panic!("{} pose {i}: no solution at {q:?}", arm.name));
                let worst = found.iter().zip(&q).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                assert!(worst * margin * margin < 1e-12, "{} pose {i}: {worst} at {q:?}", arm.name);
            }
            let all = arm.inverse(&flange, &q);
            assert!(all.len() <= 8 && (margin < 1e-6 || !all.is_empty()));
            for other in &all {
                assert!(apart(&arm.forward(other), &flange) < 2e-7, "{} pose {i}: {other:?}", arm.name);
            }
            let branches: Vec<u8> = all.iter().map(|q| arm.branch(q).cfx()).collect();
            if margin > 1e-3 && all.iter().all(|q| arm.margin(q).value > 1e-3) {
                assert!(branches.windows(2).all(|pair| pair[0] < pair[1]), "{} pose {i}: {branches:?}", arm.name);
                told += 1;
            }
        }
        assert!(told > 80_000, "{}: {told}", arm.name);
    }
}

#[test]
fn configurations_are_quadrants_and_the_three_questions() {
    let irb120 = &arms()[0];
    let of = |deg: [f64; 6]| irb120.configuration(&deg.map(f64::to_radians)).numbers();
    // At home the wrist is before axis 1 and before the lower arm; axis 5 tells the rest.
    assert_eq!(of([0.0, 0.0, 0.0, 0.0, 30.0, 0.0]), [0, 0, 0, 0]);
    assert_eq!(of([0.0, 0.0, 0.0, 0.0, -30.0, 0.0]), [0, 0, 0, 1]);
    assert_eq!(of([-1.0, 0.0, 0.0, -91.0, 30.0, 271.0]), [-1, -2, 3, 0]);
    assert_eq!(of([90.0, 0.0, 0.0, 89.999, 30.0, -90.0]), [1, 0, -1, 0]);
    // The forearm folded back over the lower arm, leaning forward enough to stay before axis 1.
    assert_eq!(of([0.0, 100.0, -105.0, 0.0, 30.0, 0.0]), [0, 0, 0, 2]);
    // Leaning back: behind axis 1, forearm forward or back of the lower arm.
    assert_eq!(of([0.0, -100.0, 10.0, 0.0, 30.0, 0.0]), [0, 0, 0, 4]);
    assert_eq!(of([0.0, -60.0, -108.0, 0.0, -30.0, 0.0]), [0, 0, 0, 7]);
    for cfx in 0..8 {
        assert_eq!(Branch::from_cfx(cfx).cfx(), cfx);
    }
    assert_eq!(Configuration { cf1: 0, cf4: -1, cf6: 1, cfx: 2 }.to_string(), "[0,-1,1,2]");
}

#[test]
fn limits_turns_and_margins() {
    let arms = arms();
    let irb120 = &arms[0];
    let mut q = [0.0, 0.0, 0.0, 0.0, 0.5, 0.0];
    assert_eq!(irb120.outside_limits(&q), None);
    q[3] = 163.1_f64.to_radians();
    let (axis, beyond) = irb120.outside_limits(&q).unwrap();
    assert!(axis == 3 && (beyond.to_degrees() - 3.1).abs() < 1e-9);
    q[3] = f64::NAN;
    assert_eq!(irb120.outside_limits(&q).unwrap().0, 3);
    // Axis 6 of ±400° has three turns of 0°, and two of 100°; axis 4 of the IRB 4600 the same.
    let turned = irb120.turns_of(&[0.0, 0.0, 0.0, 0.0, 0.5, 0.0]);
    assert_eq!(turned.iter().map(|q| (q[5] / PI).round()).collect::<Vec<_>>(), [-2.0, 0.0, 2.0]);
    assert_eq!(arms[2].turns_of(&[0.0, 0.0, 0.0, 100_f64.to_radians(), 0.5, 0.0]).len(), 2 * 3);
    assert!(irb120.turns_of(&[0.0, 2.5, 0.0, 0.0, 0.5, 0.0]).is_empty());
    for (q, named) in [
        ([0.0, 0.0, 0.0, 0.0, 0.01, 0.0], Singularity::Wrist),
        ([0.0, 0.9, -FRAC_PI_2 + (70f64 / 302.0).atan(), 0.0, 1.0, 0.0], Singularity::Elbow),
        ([0.0, -0.2355, -0.9, 0.0, 1.0, 0.0], Singularity::Shoulder),
    ] {
        let margin = irb120.margin(&q);
        assert!(margin.of == named && margin.value < 0.02, "{margin:?} at {q:?}");
    }
}

/// An arm as a chain must give what its closed form gives.
#[test]
fn chains_are_inverted_by_continuation() {
    let mut random = stream(named_seed(3, "arm chain", 0));
    for arm in arms() {
        let chain = Arm { kinematics: Kinematics::Chain, ..arm.clone() };
        let mut tried = 0;
        while tried < 2000 {
            let q = random_joints(&arm, &mut random);
            if arm.margin(&q).value < 0.1 {
                continue;
            }
            tried += 1;
            let near: Joints = std::array::from_fn(|k| q[k] + random.random_range(-0.03..0.03));
            let target = arm.forward(&q);
            let found = chain.inverse_in(&target, arm.branch(&q), &near).expect("a near pose is met");
            assert!(apart(&chain.forward(&found.joints), &target) < 1e-10);
            let worst = found.joints.iter().zip(&q).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(worst < 1e-8 && (1..=8).contains(&found.iterations), "{}: {worst} {found:?}", arm.name);
        }
        let far = Isometry3::translation(10.0, 0.0, 0.0);
        assert_eq!(chain.inverse(&far, &[0.1; 6]), Vec::<Joints>::new());
        assert_eq!(arm.inverse(&far, &[0.1; 6]), Vec::<Joints>::new());
    }
}

/// What an arm stands on is no length of it: on a pedestal of 3 m, aside and leaning, all margins are the same.
#[test]
fn where_an_arm_stands_changes_no_margin() {
    let mut random = stream(named_seed(7, "arm stands", 0));
    for arm in arms() {
        let here = Arm { kinematics: Kinematics::Chain, ..arm };
        let mut there = here.clone();
        let base = Isometry3::new(Vector3::new(0.4, -1.0, 3.0), Vector3::new(0.3, 0.8, 0.0));
        there.chain.joints[0].origin = base * here.chain.joints[0].origin;
        for _ in 0..200 {
            let q = random_joints(&here, &mut random);
            let margins = [&here, &there].map(|arm| arm.margin(&q).value);
            assert!((margins[0] - margins[1]).abs() < 1e-9, "{}: {margins:?} at {q:?}", here.name);
        }
    }
}

/// Poses made from postures within the bounds: a chain finds a posture within them for each, from one home.
#[test]
fn chains_are_searched_from_more_than_one_seed() {
    let mut random = stream(named_seed(8, "arm seeds", 0));
    for arm in arms() {
        let chain = Arm { kinematics: Kinematics::Chain, ..arm.clone() };
        let home = [0.0, 0.0, 0.0, 0.0, 0.5, 0.0];
        let (mut tried, mut at_once) = (0, 0);
        while tried < 200 {
            let q = random_joints(&arm, &mut random);
            if arm.margin(&q).value < 0.05 {
                continue;
            }
            tried += 1;
            let flange = arm.forward(&q);
            let found = chain.inverse(&flange, &home);
            let [posture] = found[..] else { panic!("{}: none at {q:?}", arm.name) };
            assert_eq!(chain.outside_limits(&posture), None, "{}: {posture:?}", arm.name);
            assert!(apart(&chain.forward(&posture), &flange) < 1e-10, "{}: {posture:?}", arm.name);
            if let Some(first) = chain.chain.inverse_near(&flange, &home)
                && chain.outside_limits(&first.joints).is_none()
            {
                // What one seed finds stays what is found.
                assert_eq!(posture, first.joints);
                at_once += 1;
            }
        }
        assert!(at_once < tried, "{}", arm.name);
    }
}

#[test]
fn jacobians_are_derivatives() {
    let mut random = stream(named_seed(4, "arm jacobian", 0));
    for arm in arms() {
        let q = random_joints(&arm, &mut random);
        let flange = arm.forward(&q);
        let jacobian = arm.chain.jacobian(&arm.chain.frames(&q), &flange.translation.vector.into());
        for axis in 0..6 {
            let (mut up, mut down) = (q, q);
            up[axis] += 1e-6;
            down[axis] -= 1e-6;
            let (up, down) = (arm.forward(&up), arm.forward(&down));
            let shift = (up.translation.vector - down.translation.vector) / 2e-6;
            let turn = rotation_vector(&(up.rotation * down.rotation.inverse())) / 2e-6;
            assert!((shift - jacobian.fixed_view::<3, 1>(0, axis)).norm() < 1e-8);
            assert!((turn - jacobian.fixed_view::<3, 1>(3, axis)).norm() < 1e-8);
        }
    }
}

/// Along straight tool moves no joint leaves its bound between samples, in closed form and as a chain.
#[test]
fn bounds_between_samples_hold_and_are_of_use() {
    let mut random = stream(named_seed(5, "arm rates", 0));
    for arm in arms() {
        let chain = Arm { kinematics: Kinematics::Chain, ..arm.clone() };
        let (mut bounded, mut ratios) = (0, Vec::new());
        while bounded < 1500 {
            let q = random_joints(&arm, &mut random);
            let tcp = Isometry3::translation(0.0, 0.02, 0.12);
            let velocity = Vector3::from_fn(|_, _| random.random_range(-0.5..0.5));
            let turn = Vector3::from_fn(|_, _| random.random_range(-0.5..0.5));
            let sweep = Sweep { speed: velocity.norm(), turn: turn.norm(), tcp };
            let half = random.random_range(0.0005..0.02);
            let start = arm.forward(&q) * tcp;
            for (arm, half) in [(&arm, half), (&chain, 0.05 * half)] {
                let Some(bounds) = arm.bounds_around(&q, &sweep, half) else { continue };
                bounded += 1;
                let mut seen: f64 = 0.0;
                for s in (-20..=20).map(|i| half * f64::from(i) / 20.0) {
                    let rotation = from_rotation_vector(&(turn * s)) * start.rotation;
                    let shift = Translation3::from(start.translation.vector + velocity * s);
                    let flange = Isometry3::from_parts(shift, rotation) * tcp.inverse();
                    let there = arm.inverse_in(&flange, arm.branch(&q), &q).expect("on the same branch").joints;
                    for axis in 0..6 {
                        let moved = (there[axis] - q[axis]).abs();
                        assert!(moved <= bounds.rates[axis] * s.abs() + 1e-9, "{} axis {axis} at {q:?}", arm.name);
                        seen = seen.max(moved / (bounds.rates[axis] * half));
                    }
                    assert!(arm.margin(&there).value >= bounds.margin.value - 1e-9);
                }
                ratios.push(seen);
            }
        }
        ratios.sort_by(f64::total_cmp);
        let median = ratios[ratios.len() / 2];
        assert!(median > 0.1, "{}: bounds {} times too wide", arm.name, 1.0 / median);
    }
}

#[test]
fn links_move_no_farther_than_bounded() {
    let mut random = stream(named_seed(6, "arm links", 0));
    for arm in arms() {
        for _ in 0..500 {
            let q = random_joints(&arm, &mut random);
            let turns: Joints = std::array::from_fn(|_| random.random_range(0.0..0.2));
            let there: Joints = std::array::from_fn(|k| q[k] + turns[k] * random.random_range(-1.0..1.0));
            let (before, after) = (arm.chain.frames(&q), arm.chain.frames(&there));
            let axes = arm.chain.axes(&before);
            for (link, body) in arm.links.iter().enumerate() {
                for end in body.capsules.iter().flat_map(|capsule| [capsule.a, capsule.b]) {
                    let most = Chain::displacement(&axes, link, &[before[link] * end], &turns);
                    let moved = (after[link] * end - before[link] * end).norm();
                    assert!(moved <= most + 1e-12, "link {link}: {moved} > {most}");
                }
            }
        }
    }
}

#[test]
fn tools_and_work_objects_are_checked() {
    let turned = Tool::new("tGrip", [0.0, 0.0, 120.0], [0.0, 1.0, 0.0, 0.0], 60.0, 0.8, [0.0, 0.0, 50.0]).unwrap();
    assert!(
        (turned.tcp * nalgebra::Point3::new(0.0, 0.0, 0.01) - nalgebra::Point3::new(0.0, 0.0, 0.11)).norm() < 1e-15
    );
    assert_eq!((turned.radius, turned.mass, turned.centre_of_mass.z), (0.06, 0.8, 0.05));
    let wrong = |q| Tool::new("t", [0.0; 3], q, 0.0, 0.0, [0.0; 3]).unwrap_err().to_string();
    assert!(wrong([1.0, 0.1, 0.0, 0.0]).starts_with("q1_q4 = [1.0, 0.1, 0.0, 0.0]: must be of length 1"));
    assert!(wrong([f64::NAN, 0.0, 0.0, 1.0]).starts_with("q1_q4"));
    assert_eq!(Tool::new("t", [0.0; 3], [1.0, 0.0, 0.0, 0.0], -1.0, 0.0, [0.0; 3]).unwrap_err().field, "radius_mm");
    // User frame first, then the object in it.
    let half = std::f64::consts::FRAC_1_SQRT_2;
    let object =
        WorkObject::new("wTest", ([100.0, 0.0, 0.0], [half, 0.0, 0.0, half]), ([50.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0]));
    let at = object.unwrap().base_from_object().translation.vector;
    assert!((at - Vector3::new(0.1, 0.05, 0.0)).norm() < 1e-12, "{at}");
}

#[test]
fn files_are_held_to_their_bounds() {
    let sound = ArmDescription {
        kind: ArmKind::Arm,
        name: "mine".into(),
        source: String::new(),
        caveat: String::new(),
        opw: Some(OpwDescription {
            a1_mm: 0.0,
            a2_mm: -70.0,
            b_mm: 0.0,
            c1_mm: 290.0,
            c2_mm: 270.0,
            c3_mm: 302.0,
            c4_mm: 72.0,
            offsets_deg: [0.0; 6],
            signs: [1; 6],
        }),
        chain: None,
        joints: JointsDescription {
            lower_deg: [-100.0; 6],
            upper_deg: [100.0; 6],
            speed_deg_s: [200.0; 6],
            acceleration_deg_s2: None,
            lag_s: None,
            j23_coupled: None,
        },
        joint_names: Vec::new(),
        capsules: Vec::new(),
        hulls: Vec::new(),
        stand_ins: Vec::new(),
        no_body: Vec::new(),
        exclude: Vec::new(),
        estimates: Vec::new(),
        masses: Vec::new(),
        estimated: Default::default(),
    };
    let built = sound.build().unwrap();
    assert_eq!(built.estimated, ["capsules", "joints.acceleration_deg_s2"]);
    assert!((built.limits[0].acceleration.to_degrees() - 1000.0).abs() < 1e-9);
    let wrong = |change: &dyn Fn(&mut ArmDescription)| {
        let mut broken = sound.clone();
        change(&mut broken);
        broken.build().unwrap_err().field
    };
    assert_eq!(wrong(&|arm| arm.name.clear()), "name");
    assert_eq!(wrong(&|arm| arm.opw = None), "opw");
    assert_eq!(built.joint_names[4], "joint_5");
    for names in [&["a", "b", "c", "d", "e"][..], &["a", "b", "c", "d", "e", "a"], &["a", "b", "c", "d", "e", " "]] {
        assert_eq!(wrong(&|arm| arm.joint_names = names.iter().map(ToString::to_string).collect()), "joint_names");
    }
    assert_eq!(wrong(&|arm| arm.opw.as_mut().unwrap().c2_mm = f64::NAN), "opw.c2_mm");
    assert_eq!(wrong(&|arm| arm.opw.as_mut().unwrap().signs[4] = 0), "opw.signs[4]");
    assert_eq!(wrong(&|arm| arm.joints.upper_deg[2] = -101.0), "joints.upper_deg[2]");
    assert_eq!(wrong(&|arm| arm.joints.speed_deg_s[5] = 0.0), "joints.speed_deg_s[5]");
    let capsule = CapsuleDescription { link: 7, a_mm: [0.0; 3], b_mm: [0.0; 3], radius_mm: 10.0, larger_mm: 0.0 };
    assert_eq!(wrong(&|arm| arm.capsules = vec![capsule]), "capsules[0].link");
    assert_eq!(wrong(&|arm| (arm.no_body, arm.stand_ins) = (vec![2, 5], vec![5])), "no_body[1]");
    let mass = MassDescription {
        link: 1,
        mass_kg: 3.0,
        centre_mm: [0.0; 3],
        inertia_kg_m2: [0.0; 3],
        products_kg_m2: [0.0; 3],
    };
    assert_eq!(wrong(&|arm| arm.masses = vec![mass]), "masses");
    assert_eq!(wrong(&|arm| arm.masses = vec![mass, mass]), "masses[1].link");
    let joint = ChainJoint { xyz_mm: [0.0, 0.0, 100.0], rpy_deg: [0.0; 3], axis: [0.0, 0.0, 0.0] };
    let chain = |joints| {
        Some(ChainDescription {
            joints,
            flange_mm: [0.0; 3],
            flange_rpy_deg: [0.0; 3],
            controller_mm: [0.0; 3],
            controller_rpy_deg: [0.0; 3],
        })
    };
    assert_eq!(wrong(&|arm| arm.chain = chain(vec![joint; 6])), "opw");
    for (joints, field) in [(5, "chain.joints"), (6, "chain.joints[0].axis")] {
        assert_eq!(wrong(&|arm| (arm.opw, arm.chain) = (None, chain(vec![joint; joints]))), field);
    }
    assert_eq!(Vector4::new(0.0, 0.0, 0.0, 1.0), by_dh(&opw(&built), &[0.3; 6]).row(3).transpose());
}
