//! Programs written, read by a reader of the tests' own, and read back.

use hairpin::math::rotation::from_rotation_vector;
use hairpin::robot::arm::{Arm, ArmDescription};
use hairpin::trajectory::program::{
    JointTarget, Motion, Move, NO_EXTERNAL, PoseTarget, Program, Speed, Tool, WorkObject, Zone,
};
use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};

use super::*;
use crate::listing::{Class, File, Module, Unmodelled};

fn turned(roll: f64, pitch: f64, yaw: f64) -> UnitQuaternion<f64> {
    UnitQuaternion::from_euler_angles(roll, pitch, yaw)
}

fn program() -> Program {
    let tool = Tool { tcp: Isometry3::translation(0.0, 0.0, 0.12), mass: 0.8, ..Tool::flange() };
    let object = WorkObject {
        user: Isometry3::from_parts(Translation3::new(0.1, -0.2, 0.3), turned(0.0, 0.0, 0.5)),
        ..WorkObject::base()
    };
    let mut program = Program::new("M", "heavy_run", tool, object);
    let at = |x: f64, y: f64| {
        let turn = turned(3.0, -0.2, 0.4 + x);
        PoseTarget::unnamed(Isometry3::from_parts(Translation3::new(x, y, 0.4), turn))
    };
    let joints = [0.1, -1.5, 2.0, -0.5, 1.5, 6.0];
    let home = JointTarget { name: None, joints, external: NO_EXTERNAL };
    let (v, z) = (|name| Speed::predefined(name).unwrap(), |name| Zone::predefined(name).unwrap());
    program.moves = vec![
        Move::new(Motion::AbsoluteJoint(home), v("v200"), Zone::stop()),
        Move::new(Motion::Joint(at(0.3, 0.0)), v("v200"), z("z10")),
        Move { duration: Some(2.5), ..Move::new(Motion::Linear(at(0.3, 0.1)), v("v150"), z("z10")) },
        Move::new(Motion::Circular { via: at(0.305, 0.108), to: at(0.312, 0.11) }, v("vmax"), z("z100")),
        Move::new(Motion::Linear(at(0.4, 0.11)), v("v2000"), Zone::stop()),
    ];
    program
}

type Call = (String, Vec<Vec<f64>>, Vec<(String, f64)>);

/// A reader of its own: function name, and each call with its numbers in brackets and its named arguments.
fn calls(text: &str) -> Vec<Call> {
    let lines = text.lines().filter(|line| line.starts_with("  "));
    lines
        .map(|line| {
            let (name, rest) = line.trim().split_once('(').unwrap();
            let rest = rest.strip_suffix(')').unwrap();
            let lists = rest
                .split('[')
                .skip(1)
                .map(|list| list.split(']').next().unwrap().split(',').map(|x| x.trim().parse().unwrap()).collect());
            let named = rest.split(", ").filter_map(|part| part.split_once('='));
            let named = named.map(|(name, value)| (name.to_owned(), value.parse().unwrap()));
            (name.to_owned(), lists.collect(), named.collect())
        })
        .collect()
}

#[test]
fn poses_speeds_and_corners_are_those_of_the_program() {
    let program = program();
    let text = text(&program, &Settings::default(), None, &["gap 0.3 %".into()]).unwrap();
    assert!(text.starts_with("# gap 0.3 %\n# This is a test program") && text.ends_with("\nend\nheavy_run()\n"));
    let calls = calls(&text);
    let names: Vec<_> = calls.iter().map(|(name, ..)| name.as_str()).collect();
    assert_eq!(names, ["set_tcp", "set_target_payload", "movej", "movej", "movel", "movec", "movel"]);
    assert_eq!(calls[0].1, [[0.0, 0.0, 0.12, 0.0, 0.0, 0.0]]);
    assert_eq!(calls[2].1, [[0.1, -1.5, 2.0, -0.5, 1.5, 6.0]]);
    let base = program.work_objects[0].base_from_object();
    for (call, m) in calls[3..].iter().zip(&program.moves[1..]) {
        for (numbers, target) in call.1.iter().zip(m.motion.poses()) {
            let expected = base * target.pose;
            let turn = from_rotation_vector(&Vector3::new(numbers[3], numbers[4], numbers[5]));
            assert!((Vector3::new(numbers[0], numbers[1], numbers[2]) - expected.translation.vector).norm() < 1e-8);
            assert!(turn.angle_to(&expected.rotation) < 1e-7, "{turn} {expected}");
        }
    }
    let named = |call: usize, name: &str| calls[call].2.iter().find(|(n, _)| n == name).map(|(_, v)| *v);
    assert_eq!(
        (named(4, "v"), named(4, "t"), named(5, "v"), named(6, "v")),
        (Some(0.15), Some(2.5), Some(1.0), Some(1.0))
    );
    // The first corner comes from a posture, of which nothing is known without the arm; the third is cut to half of
    // 12.2 mm.
    assert_eq!((named(3, "r"), named(6, "r")), (Some(0.0), Some(0.0)));
    let half = 0.5 * (0.012_f64.powi(2) + 0.01_f64.powi(2)).sqrt();
    assert!((named(4, "r").unwrap() - half).abs() < 1e-9 && (named(5, "r").unwrap() - half).abs() < 1e-9);
}

#[test]
fn what_controllers_refuse_is_not_written() {
    for name in ["end", "set_tcp"] {
        let named = Program { procedure: name.into(), ..program() };
        assert!(matches!(text(&named, &Settings::default(), None, &[]), Err(UrscriptError::Name { .. })), "{name}");
    }
    let settings = Settings { acceleration: 0.0, ..Settings::default() };
    assert!(matches!(
        text(&program(), &settings, None, &[]),
        Err(UrscriptError::Setting { field: "acceleration", .. })
    ));
    let mut broken = program();
    broken.moves.remove(2);
    broken.moves.remove(0);
    broken.moves.remove(0);
    assert!(matches!(text(&broken, &Settings::default(), None, &[]), Err(UrscriptError::Program(_))));
}

fn back(text: &str) -> Module {
    read(File { name: "m.script", bytes: text.as_bytes() }).unwrap()
}

#[test]
fn what_is_written_reads_back_and_is_written_the_same() {
    let program = program();
    let written = text(&program, &Settings::default(), None, &["gap 0.3 %".into()]).unwrap();
    let read = back(&written);
    assert_eq!((read.unclear_line, read.certain, &read.mistakes[..]), (None, 5, &[][..]), "{:?}", read.lines);
    assert_eq!(text(&read.program, &Settings::default(), None, &read.header).unwrap(), written);
    assert_eq!(read.program.procedure, "heavy_run");
    let (kept, _) = written.rsplit_once("\nend\n").unwrap();
    let cut = back(kept);
    let last = kept.lines().count();
    assert_eq!((cut.unclear_line, cut.certain), (Some(last), 5), "{:?}", cut.lines);
    assert_eq!(cut.lines[&last].what, "the file ends before end: it was cut short");
    for (a, b) in program.moves.iter().zip(&read.program.moves) {
        let base = program.work_objects[a.work_object].base_from_object();
        for (p, q) in a.motion.poses().zip(b.motion.poses()) {
            let off = (base * p.pose).inverse() * q.pose;
            assert!(off.translation.vector.norm() < 1e-8 && off.rotation.angle() < 1e-7);
        }
        assert_eq!(a.duration, b.duration);
    }
    let (tool, again) = (&program.tools[0], &read.program.tools[0]);
    assert_eq!((tool.tcp, tool.mass, tool.centre_of_gravity), (again.tcp, again.mass, again.centre_of_gravity));
}

/// The whole tensor in the flange's axes, whatever axes the tool tells it in.
#[test]
fn moments_of_inertia_go_along() {
    let mut program = program();
    let tool = &mut program.tools[0];
    (tool.inertia, tool.axes_of_inertia) = ([0.01, 0.02, 0.005], turned(0.3, -0.8, 1.1));
    let tensor = tool.tensor_of_inertia();
    let written = text(&program, &Settings::default(), None, &[]).unwrap();
    let six = &calls(&written)[1].1[1];
    let expected = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)].map(|place| tensor[place]);
    assert!(six.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-9) && six[3].abs() > 1e-4, "{six:?} {tensor}");
    let read = back(&written);
    assert_eq!((read.unclear_line, &read.mistakes[..]), (None, &[][..]), "{:?}", read.lines);
    assert!((read.program.tools[0].tensor_of_inertia() - tensor).norm() < 1e-8);
    // Along the flange's axes they are the numbers themselves.
    let payload = |arguments: &str| {
        let head = "def m():\n  set_tcp(p[0,0,0.1,0,0,0])\n";
        back(&format!(
            "{head}  set_target_payload(1.5, [0,0,0.05]{arguments})\n  movej([0,-1.5,1.5,0,1.5,0])\nend\nm()\n"
        ))
    };
    for told in ["[0.03,0.01,0.02,0,0,0]", "inertia=[0.03,0.01,0.02,0,0,0]"] {
        let read = payload(&format!(", {told}"));
        assert_eq!((read.unclear_line, read.program.tools[0].inertia), (None, [0.03, 0.01, 0.02]), "{:?}", read.lines);
    }
    for (told, words) in [
        ("[0.03,0.01]", "six moments of inertia"),
        ("[0.01,0.01,0.01,0.05,0,0]", "no body has one below 0"),
        ("[0.03,0.01,0.02,0,0,0], 0.5", "argument 4 is not followed"),
        ("transition_time=0.5", "transition_time is not followed"),
    ] {
        let read = payload(&format!(", {told}"));
        assert!(read.unclear_line == Some(3) && read.lines[&3].what.contains(words), "{told}: {:?}", read.lines);
    }
}

#[test]
fn what_is_not_followed_is_named_by_line() {
    let head = "def m():\n  set_tcp(p[0,0,0.1,0,0,0])\n  set_target_payload(1.5, [0,0,0.05])\n  movej([0,-1.5,1.5,0,1.5,0], a=1, v=1, r=0)\n";
    for (body, kind, words) in [
        ("movel(p[0.4,0,0.3,0,3.1,0], a=1.2, v=0.2, r=0)", None, ""),
        ("movel(p[0.4,0,0.3,0,3.1,0], 1.2, 0.2)", None, ""),
        ("sleep(0.5)", None, ""),
        ("sleep(2*(0.5+get_steptime()))", None, ""),
        ("textmsg(\"movel(p)\", to_str(get_actual_tcp_pose()))", None, ""),
        ("sleep(movel(p[9,0,0.4,0,3.1,0]))", None, "`movel` is not followed"),
        ("textmsg(\"at\", movel (p[9,0,0.4,0,3.1,0]))", None, "`movel` is not followed"),
        ("set_digital_out(1, mine())", None, "`mine` is not followed"),
        ("sleep(servoj([0,0,0,0,0,0]))", Some(Unmodelled::Guidance), "`servoj` is not followed"),
        ("set_payload(3.0)", Some(Unmodelled::Payload), "`set_payload` is not followed"),
        ("set_target_payload(3.0, [0,0,0])", Some(Unmodelled::Payload), "set_target_payload"),
        ("movel(p[0.4,0,0.3,0,3.1,0], 1.2, 0.2, 0, 0, 7)", None, "argument 6 is not followed"),
        ("set_tcp(p[0,0,0.1,0,0,0], \"gun\", 1)", None, "argument 3 is not followed"),
        (
            "force_mode(p[0,0,0,0,0,0], [0,0,1,0,0,0], [0,0,9,0,0,0], 2, [1,1,1,1,1,1])",
            Some(Unmodelled::ForceControl),
            "force_mode",
        ),
        ("track_conveyor_linear(p[1,0,0,0,0,0], 500)", Some(Unmodelled::Conveyors), "track_conveyor_linear"),
        ("servoj([0,0,0,0,0,0])", Some(Unmodelled::Guidance), "servoj"),
        (
            "movec(p[0.4,0,0.3,0,3,0], p[0.4,0.1,0.3,0,3,0], a=1, v=1, r=0, mode=1)",
            Some(Unmodelled::Interpolation),
            "mode 1",
        ),
        ("movel(home, a=1.2, v=0.2)", None, "expected a pose"),
        ("if True:", None, "`if` is not followed"),
        ("home = p[0,0,0,0,0,0]", None, "`home` is not followed"),
    ] {
        let text =
            format!("{head}  {body} # comment\n  movel(p[0.4,0.1,0.3,0,3.1,0], a=1.2, v=0.2, r=0.01)\nend\nm()\n");
        let read = back(&text);
        let line = &read.lines[&5];
        let clear = words.is_empty();
        assert_eq!(read.unclear_line, (!clear).then_some(5), "{body}: {line:?}");
        assert!(clear || read.certain == 1, "{body}");
        assert!(line.what.contains(words) && line.unmodelled == kind, "{body}: {line:?}");
        assert_eq!(line.class == Class::ChangesMotion, !clear, "{body}");
    }
    let bare = back("def m():\n  movej([0,0,0,0,0,0])\nend\nm()\nother()\n");
    assert!(bare.lines[&2].what.contains("centre point is not set") && bare.lines[&5].class == Class::ChangesMotion);
    assert_eq!(read(File { name: "m.script", bytes: b"hello" }), Err(NoProgram::Absent));
}

/// A corner behind a move to joint angles is the programmed one: where these lead the arm says.
#[test]
fn corners_beside_postures_take_the_arm() {
    let text_of = include_str!("../../../../data/robots/arm/irb120.toml");
    let arm: Arm = toml::from_str::<ArmDescription>(text_of).unwrap().build().unwrap();
    let program = program();
    let radius = |arm: Option<&Arm>| {
        let written = text(&program, &Settings::default(), arm, &[]).unwrap();
        calls(&written)[3].2.iter().find(|(name, _)| name == "r").unwrap().1
    };
    assert_eq!((radius(None), radius(Some(&arm))), (0.0, 0.01));
    // Cut to half of the way from there.
    let mut near = program.clone();
    let Motion::AbsoluteJoint(home) = &program.moves[0].motion else { panic!("it begins at a posture") };
    let at_home = arm.forward(&home.joints) * program.tools[0].tcp;
    let there = program.work_objects[0].base_from_object().inverse() * Translation3::new(0.0, 0.0, 0.004) * at_home;
    near.moves[1].motion = Motion::Joint(PoseTarget::unnamed(there));
    let written = text(&near, &Settings::default(), Some(&arm), &[]).unwrap();
    let cut = calls(&written)[3].2.iter().find(|(name, _)| name == "r").unwrap().1;
    assert!((cut - 0.002).abs() < 1e-8, "{cut}");
}

const GO: &str = "movel(p[0.4,0,0.3,0,3.1,0], a=1.2, v=0.2)";

/// A function is executed as often as it is called, wherever that is.
#[test]
fn functions_are_followed_as_often_as_they_are_called() {
    let tool = "set_tcp(p[0,0,0.1,0,0,0])";
    for (text, moves, name) in [
        (format!("def t():\n  {tool}\n  {GO}\n  {GO}\nend\nt()\nt()\n"), 4, "t"),
        (format!("def s():\n  {GO}\nend\ndef t():\n  {tool}\n  s()\n  {GO}\n  s()\nend\nt()\n"), 3, "t"),
        (format!("def t():\n  {tool}\n  def s():\n    {GO}\n  end\n  s()\n  s()\nend\nt()\n"), 2, "t"),
        (format!("def t():\n  {tool}\n  {GO}\nend\ndef u():\n  t()\n  t()\nend\nu()\nu()\n"), 4, "u"),
        (format!("def t():\n  {tool}\n  {GO}\nend\ndef u():\n  {GO}\nend\nu()\nt()\n"), 2, "u"),
        // Of the file's own is what it calls, whatever URScript has under that name.
        (format!("def sleep():\n  {GO}\nend\ndef t():\n  {tool}\n  sleep()\nend\nt()\n"), 1, "t"),
        (format!("def t():\n  {tool}\n  {GO}\nend\n"), 1, "t"),
    ] {
        let read = back(&text);
        assert_eq!((read.program.moves.len(), read.program.procedure.as_str()), (moves, name), "{text}");
        // Only where the tool is not set yet something is not certain.
        let is_open = text.ends_with("u()\nt()\n");
        assert_eq!(read.unclear_line.is_some(), is_open, "{text}: {:?}", read.lines);
    }
    // A tool that is set again is the same.
    let twice = back(&format!("def t():\n  {tool}\n  {GO}\nend\nt()\nt()\n"));
    assert_eq!(twice.program.moves.iter().map(|m| m.line).collect::<Vec<_>>(), [Some(3), Some(3)]);
    assert_eq!(twice.program.tools.len(), 1);
}

#[test]
fn calls_that_are_not_followed_are_named() {
    let tool = "set_tcp(p[0,0,0.1,0,0,0])";
    for (text, line, certain, words) in [
        (format!("def s(x):\n  {GO}\nend\ndef t():\n  {tool}\n  {GO}\n  s(1)\nend\nt()\n"), 7, 1, "it has arguments"),
        (format!("def t():\n  {tool}\n  {GO}\nend\nt(1)\n"), 5, 0, "it has arguments"),
        (format!("def t():\n  {tool}\n  {GO}\n  s()\nend\nt()\ndef s():\n  {GO}\nend\n"), 4, 1, "before it is defined"),
        (format!("def t():\n  {tool}\n  {GO}\n  t()\nend\nt()\n"), 4, 250, "in more than 250 others"),
        (
            format!("def s():\n  {GO}\nend\ndef s():\n  {GO}\nend\ndef t():\n  {tool}\n  {GO}\n  s()\nend\nt()\n"),
            10,
            1,
            "defined twice",
        ),
        (format!("def t():\n  {tool}\n  {GO}\n  sleep(s())\nend\ndef s():\n  {GO}\nend\nt()\n"), 4, 1, "`s`"),
        (format!("def t():\n  {tool}\n  {GO}\nend\ndef u():\n  {GO}\nend\n"), 5, 1, "nothing says whether `u`"),
        (format!("def t(): {GO}\n  {tool}\n  {GO}\nend\nt()\n"), 1, 0, "a colon alone"),
        (format!("def t():\n  {tool}\n  {GO}\nend\nt() t()\n"), 5, 0, "`t` is not followed"),
        (format!("def t():\n  {tool}\n  {GO}\nend\nt()\nend\n"), 6, 0, "ends nothing"),
    ] {
        let read = back(&text);
        assert_eq!((read.unclear_line, read.certain), (Some(line), certain), "{text}: {:?}", read.lines);
        assert!(read.lines[&line].what.contains(words), "{text}: {:?}", read.lines[&line]);
    }
    // What doubles at each of forty levels ends somewhere.
    let mut many = format!("def f0():\n  {GO}\nend\n");
    for k in 1..40 {
        many += &format!("def f{k}():\n  f{0}()\n  f{0}()\nend\n", k - 1);
    }
    let read = back(&format!("{many}def t():\n  {tool}\n  f39()\nend\nt()\n"));
    assert!(read.unclear_line.is_some() && read.certain == 100_000, "{}", read.certain);
}

/// What stands behind a statement's brackets is no part of it.
#[test]
fn statements_are_understood_to_their_end() {
    for body in [
        "sleep(1) halt",
        "sleep(1) (2)",
        "sync() x = p[0,0,0,0,0,0]",
        "textmsg(\"a\") + textmsg(\"b\")",
        "set_digital_out(1, True) set_tcp(p[0,0,2,0,0,0])",
    ] {
        let read = back(&format!("def t():\n  set_tcp(p[0,0,0.1,0,0,0])\n  {GO}\n  {body}\n  {GO}\nend\nt()\n"));
        assert_eq!((read.unclear_line, read.certain), (Some(4), 1), "{body}: {:?}", read.lines);
    }
}

/// A number that no controller takes is refused with its bound; what is given twice, or is none of its arguments, is
/// not understood.
#[test]
fn arguments_are_held_to_what_controllers_take() {
    let of = |body: &str| back(&format!("def t():\n  set_tcp(p[0,0,0.1,0,0,0])\n  {body}\nend\nt()\n"));
    let (joints, pose) = ("[0,-1.5,1.5,0,1.5,0]", "p[0.4,0,0.3,0,3.1,0]");
    for (body, words) in [
        (format!("movej({joints}, a=1.4, v=-1.05)"), "v = -1.05: must be more than 0 rad/s and at most 10 rad/s"),
        (format!("movej({joints}, 1.4, 0)"), "v = 0: must be more than 0 rad/s and at most 10 rad/s"),
        (format!("movej({pose}, a=0)"), "a = 0: must be a number, more than 0 rad/s²"),
        (format!("movej({joints}, a=-1.2, t=2)"), "a = -1.2: must be"),
        (format!("movel({pose}, a=-1.2, v=0.2)"), "a = -1.2: must be a number, more than 0 m/s²"),
        (format!("movej({joints}, a=1.4, v=105)"), "v = 105: must be more than 0 rad/s and at most 10 rad/s"),
        (format!("movel({pose}, a=1.2, v=250)"), "v = 250: must be more than 0 m/s and at most 5 m/s"),
        (format!("movel({pose}, v=0)"), "tcp speed = 0: must be a number, more than 0 m/s"),
        (format!("movel({pose}, a=1.2, v=0.2, r=-1)"), "zone = -1: must be a number from 0 to 10000"),
        (format!("movej({joints}, t=-3)"), "duration = -3: must be more than 0 s"),
        (format!("movec({pose}, {pose}, 1, 1, -0.1)"), "zone = -0.1: must be"),
    ] {
        let read = of(&body);
        assert_eq!((read.unclear_line, read.certain), (None, 1), "{body}: {:?}", read.lines);
        let problems = read.program.problems().into_iter().filter(|one| !one.to_string().contains("circular"));
        let told: Vec<String> = problems.chain(read.refused.clone()).map(|one| one.to_string()).collect();
        assert!(told.len() == 1 && told[0].contains(words) && told[0].contains("line 3"), "{body}: {told:?}");
    }
    // A time of 0 is none, and with one nobody looks at speeds.
    for body in [format!("movej({joints}, a=1.4, v=1.05, t=0, r=0)"), format!("movel({pose}, 0, 0, 2)")] {
        let read = of(&body);
        assert_eq!((read.unclear_line, read.refused.len(), read.program.problems().len()), (None, 0, 0), "{body}");
    }
    for (body, words) in [
        (format!("movel({pose}, a=1.2, v=0.2, v=99)"), "v is given twice"),
        (format!("movel(p[2,0,0.5,0,2.6,0], pose={pose})"), "pose is given twice"),
        (format!("movel({pose}, 1.2, a=1)"), "a is given twice"),
        (format!("movel({pose}, a=1.2, q=9)"), "q is not followed"),
        (format!("movel({pose}, a=1.2, 0.2)"), "has no name"),
        (format!("movel({pose}, , 0.2)"), "a is empty"),
        ("set_tcp(p[0,0,0,0,0,0], pose=p[0,0,1,0,0,0])".into(), "pose is given twice"),
    ] {
        let read = of(&body);
        assert!(read.unclear_line == Some(3) && read.lines[&3].what.contains(words), "{body}: {:?}", read.lines);
    }
    // Behind what is not understood nothing is certain, numbers neither.
    assert_eq!(of(&format!("if True:\n  end\n  movej({joints}, v=-1)")).refused.len(), 0);
}
