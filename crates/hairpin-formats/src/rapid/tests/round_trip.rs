//! What is written reads back to the same program, and that is written as the same bytes.

use hairpin::trajectory::program::{
    JointTarget, Motion, Move, PoseTarget, Program, Speed, Tool, WorkObject, Zone, unit_quaternion,
};
use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};
use proptest::prelude::*;

use super::super::{Options, module, read};
use crate::listing::Unmodelled;

fn turn() -> BoxedStrategy<UnitQuaternion<f64>> {
    let component = || prop_oneof![3 => -1.0..1.0_f64, 1 => Just(0.0)];
    let four = (component(), component(), component(), component());
    four.prop_filter_map("a direction", |(w, x, y, z)| {
        UnitQuaternion::try_new(nalgebra::Quaternion::new(w, x, y, z), 1e-3)
    })
    .boxed()
}

fn frame() -> BoxedStrategy<Isometry3<f64>> {
    (prop::array::uniform3(-3.0..3.0_f64), turn())
        .prop_map(|(at, turn)| Isometry3::from_parts(Translation3::from(Vector3::from(at)), turn))
        .boxed()
}

fn external() -> impl Strategy<Value = [Option<f64>; 6]> {
    prop::array::uniform6(prop::option::weighted(0.3, -5000.0..5000.0_f64))
}

fn pose_target(name: Option<String>) -> BoxedStrategy<PoseTarget> {
    (frame(), prop::option::weighted(0.9, prop::array::uniform4(-4..8_i32)), external())
        .prop_map(move |(pose, configuration, external)| PoseTarget {
            name: name.clone(),
            pose,
            configuration,
            external,
        })
        .boxed()
}

fn speed() -> BoxedStrategy<Speed> {
    let names: Vec<String> = Speed::predefined_names().collect();
    prop_oneof![
        3 => prop::sample::select(names).prop_map(|name| Speed::predefined(&name).unwrap()),
        1 => prop::array::uniform4(0.001..9.0_f64).prop_map(|[tcp, orientation, linear_external, rotating_external]| {
            Speed { name: None, tcp, orientation, linear_external, rotating_external }
        }),
        1 => (1..4_u32).prop_map(|n| Speed { name: Some(format!("vOwn{n}")), tcp: f64::from(n) / 7.0, ..Speed::predefined("v5").unwrap() }),
    ]
    .boxed()
}

fn zone() -> BoxedStrategy<Zone> {
    let names: Vec<&str> = Zone::predefined_names().collect();
    prop_oneof![
        3 => prop::sample::select(names).prop_map(|name| Zone::predefined(name).unwrap()),
        1 => (any::<bool>(), prop::array::uniform6(0.0..0.3_f64)).prop_map(|(fine, [a, b, c, d, e, f])| Zone {
            name: None, fine, tcp: a, path_orientation: b, path_external: c, orientation: d, linear_external: e, rotating_external: f,
        }),
        1 => (1..4_u32).prop_map(|n| Zone { name: Some(format!("zOwn{n}")), tcp: f64::from(n) / 70.0, ..Zone::predefined("z0").unwrap() }),
    ]
    .boxed()
}

/// Move `index`; names differ from move to move, or are absent.
fn one_move(index: usize) -> BoxedStrategy<Move> {
    let named = move |prefix: &'static str| prop::option::weighted(0.7, Just(format!("{prefix}{index}")));
    let target = move |prefix| named(prefix).prop_flat_map(pose_target);
    let joints = (named("j"), prop::array::uniform6(-7.0..7.0_f64), external())
        .prop_map(|(name, joints, external)| Motion::AbsoluteJoint(JointTarget { name, joints, external }));
    let motion = prop_oneof![
        joints.boxed(),
        target("p").prop_map(Motion::Joint),
        target("p").prop_map(Motion::Linear),
        (target("c"), target("p")).prop_map(|(via, to)| Motion::Circular { via, to }),
    ];
    (motion, speed(), zone(), prop::option::weighted(0.2, 0.001..100.0_f64), 0..2_usize, 0..2_usize, any::<bool>())
        .prop_map(move |(motion, speed, zone, duration, tool, work_object, configuration_demanded)| Move {
            motion,
            speed,
            zone,
            duration,
            tool,
            work_object,
            configuration_demanded,
            line: None,
        })
        .boxed()
}

fn tool() -> BoxedStrategy<Tool> {
    (frame(), 0.001..50.0_f64, prop::array::uniform3(-0.5..0.5_f64), turn(), prop::array::uniform3(0.0..2.0_f64))
        .prop_map(|(tcp, mass, cog, axes_of_inertia, inertia)| Tool {
            name: "tOwn".into(),
            declare: true,
            held: true,
            tcp,
            mass,
            centre_of_gravity: Vector3::from(cog),
            axes_of_inertia,
            inertia,
        })
        .boxed()
}

fn program() -> BoxedStrategy<Program> {
    let moves = (1..12_usize).prop_flat_map(|count| (0..count).map(one_move).collect::<Vec<_>>());
    (tool(), frame(), frame(), moves)
        .prop_map(|(tool, user, object, moves)| {
            let own = WorkObject { name: "wOwn".into(), declare: true, user, object, ..WorkObject::base() };
            Program {
                name: "Made".into(),
                procedure: "made_run".into(),
                tools: vec![Tool::flange(), tool],
                work_objects: vec![own, WorkObject::base()],
                moves,
            }
        })
        .prop_filter("arcs that a controller takes", |program| program.problems().is_empty())
        .boxed()
}

fn near(a: &Isometry3<f64>, b: &Isometry3<f64>) -> bool {
    (a.translation.vector - b.translation.vector).norm() < 1e-8 && (a.rotation.coords - b.rotation.coords).norm() < 1e-8
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, ..ProptestConfig::default() })]

    /// What is planned before it is written is what is planned after it was read, to the bit: a time law that compares
    /// is another one by the last digit.
    #[test]
    fn a_program_in_digits_reads_back_as_it_is(program in program()) {
        let program = program.in_digits();
        let back = read(module(&program, &[]).unwrap().as_bytes(), &Options::default()).unwrap().program;
        for (a, b) in program.moves.iter().zip(&back.moves) {
            let poses = |m: &Move| m.motion.poses().map(|to| (to.pose.translation, to.pose.rotation.coords)).collect::<Vec<_>>();
            prop_assert_eq!(poses(a), poses(b));
            if let (Motion::AbsoluteJoint(a), Motion::AbsoluteJoint(b)) = (&a.motion, &b.motion) {
                prop_assert_eq!(a.joints, b.joints);
            }
            let (a, b) = (&program.tools[a.tool], &back.tools[b.tool]);
            prop_assert_eq!((a.tcp, a.mass, a.centre_of_gravity, a.inertia), (b.tcp, b.mass, b.centre_of_gravity, b.inertia));
        }
        for (a, b) in program.moves.iter().zip(&back.moves) {
            let (a, b) = (&program.work_objects[a.work_object], &back.work_objects[b.work_object]);
            prop_assert_eq!((a.user, a.object), (b.user, b.object));
        }
    }

    #[test]
    fn written_read_and_written_again(program in program(), header in prop::collection::vec("[ -~]{0,60}", 0..3)) {
        let header: Vec<String> = header.iter().map(|line| line.trim().to_owned()).collect();
        let text = module(&program, &header).unwrap();
        let back = read(text.as_bytes(), &Options::default()).unwrap();
        prop_assert!(back.mistakes.is_empty());
        // External axes are read and written, and no move with them is certain.
        let first = program.moves.iter().position(beside);
        prop_assert_eq!(back.certain, first.unwrap_or(program.moves.len()));
        prop_assert!(back.unclear().all(|(_, line)| line.unmodelled == Some(Unmodelled::ExternalAxes)));
        let again = module(&back.program, &back.header).unwrap();
        prop_assert_eq!(&again, &text);
        for (a, b) in program.moves.iter().zip(&back.program.moves) {
            prop_assert_eq!(&a.speed.name, &b.speed.name);
            prop_assert_eq!(&a.zone.name, &b.zone.name);
            prop_assert_eq!(a.motion.name(), b.motion.name());
            prop_assert_eq!(&program.tools[a.tool].name, &back.program.tools[b.tool].name);
            prop_assert_eq!(&program.work_objects[a.work_object].name, &back.program.work_objects[b.work_object].name);
            for (p, q) in a.motion.poses().zip(b.motion.poses()) {
                prop_assert!(near(&p.pose, &q.pose), "{:?} {:?}", p, q);
                prop_assert_eq!(p.configuration.unwrap_or_default(), q.configuration.unwrap());
            }
        }
    }
}

/// Whether external axes are in use at the move's end.
fn beside(m: &Move) -> bool {
    let external = match &m.motion {
        Motion::AbsoluteJoint(to) => &to.external,
        Motion::Joint(to) | Motion::Linear(to) | Motion::Circular { to, .. } => &to.external,
    };
    external.iter().any(Option::is_some)
}

#[test]
fn every_predefined_speed_and_zone_survives() {
    let there = PoseTarget::unnamed(Isometry3::translation(0.4, 0.0, 0.4));
    let mut program = Program::new("All", "all_run", Tool::flange(), WorkObject::base());
    for name in Speed::predefined_names() {
        let speed = Speed::predefined(&name).unwrap();
        program.moves.push(Move::new(Motion::Linear(there.clone()), speed, Zone::stop()));
    }
    for name in Zone::predefined_names() {
        let zone = Zone::predefined(name).unwrap();
        program.moves.push(Move::new(Motion::Linear(there.clone()), Speed::predefined("v5").unwrap(), zone));
    }
    assert_eq!(program.moves.len(), 26 + 15);
    let text = module(&program, &[]).unwrap();
    let back = read(text.as_bytes(), &Options::default()).unwrap().program;
    for (a, b) in program.moves.iter().zip(&back.moves) {
        assert_eq!((&a.speed, &a.zone), (&b.speed, &b.zone));
    }
}

/// Quaternions of five decimals, as pendants show them, are taken and keep the rotation.
#[test]
fn short_quaternions_are_taken() {
    let text = "MODULE M\nPROC main()\nMoveL [[1,2,3],[0.70711,0,0.70711,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v5,fine,tool0;\nENDPROC\nENDMODULE";
    let program = read(text.as_bytes(), &Options::default()).unwrap().program;
    let turn = program.moves[0].motion.end().unwrap().pose.rotation;
    assert!((turn.norm() - 1.0).abs() < 1e-15 && turn.w == turn.j);
    assert!(unit_quaternion([0.6001, 0.0, 0.8, 0.0]).is_err());
    let once = module(&program, &[]).unwrap();
    let twice = module(&read(once.as_bytes(), &Options::default()).unwrap().program, &[]).unwrap();
    assert_eq!(once, twice);
}
