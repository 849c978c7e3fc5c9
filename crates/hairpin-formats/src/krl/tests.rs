//! Programs written, read by a reader of the tests' own, and read back.

use std::collections::BTreeMap;

use hairpin::math::rotation::quaternion_from_euler;
use hairpin::trajectory::program::{
    JointTarget, Motion, Move, NO_EXTERNAL, PoseTarget, Program, Speed, Tool, WorkObject, Zone,
};
use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion, Vector3};

use super::*;
use crate::listing::{Class, File, Module, Unmodelled};

fn at(x: f64, y: f64) -> PoseTarget {
    let turn = UnitQuaternion::from_euler_angles(0.3, -0.2 - x, 2.4);
    PoseTarget::unnamed(Isometry3::from_parts(Translation3::new(x, y, 0.4), turn))
}

fn program() -> Program {
    let tool = Tool { tcp: at(0.0, 0.1).pose, ..Tool::flange() };
    let object = WorkObject { user: at(0.2, 0.1).pose, object: at(-0.1, 0.0).pose, ..WorkObject::base() };
    let mut program = Program::new("Heavy", "main", tool, object);
    let home =
        JointTarget { name: Some("home".into()), joints: [0.1, -0.2, 0.3, -0.4, 0.5, 0.6], external: NO_EXTERNAL };
    let (v, z) = (|name| Speed::predefined(name).unwrap(), |name| Zone::predefined(name).unwrap());
    program.moves = vec![
        Move::new(Motion::AbsoluteJoint(home.clone()), v("v200"), Zone::stop()),
        Move::new(Motion::Joint(at(0.3, 0.0).named("p0")), v("v200"), z("z10")),
        Move::new(Motion::Linear(at(0.3, 0.1)), v("v150"), z("z10")),
        Move::new(Motion::Circular { via: at(0.35, 0.15), to: at(0.4, 0.1).named("p2") }, v("vmax"), Zone::stop()),
        Move::new(Motion::AbsoluteJoint(home), v("v200"), Zone::stop()),
    ];
    program
}

/// A reader of its own: what each `{X 1,Y 2,…}` says by name.
fn numbers(text: &str) -> BTreeMap<String, f64> {
    let inside = text.split('{').nth(1).unwrap().split('}').next().unwrap();
    let parts = inside.split(',').map(|part| part.trim().split_once(' ').unwrap());
    parts.map(|(name, value)| (name.to_owned(), value.parse().unwrap())).collect()
}

fn assert_frame(text: &str, pose: &Isometry3<f64>) {
    let n = numbers(text);
    let [a, b, c] = ["A", "B", "C"].map(|name| n[name].to_radians());
    let q = quaternion_from_euler(c, b, a);
    let turn = UnitQuaternion::new_normalize(Quaternion::new(q[0], q[1], q[2], q[3]));
    let place = Vector3::new(n["X"], n["Y"], n["Z"]) / 1000.0;
    assert!((place - pose.translation.vector).norm() < 2e-9 && turn.angle_to(&pose.rotation) < 1e-7, "{text}");
}

#[test]
fn positions_frames_and_speeds_are_those_of_the_program() {
    let program = program();
    let Files { src, dat } = files(&program, &Settings::default(), &["optimal".into()]).unwrap();
    let statements: Vec<&str> = src.split("\r\n").filter(|line| !line.starts_with([';', '&'])).collect();
    let find = |name: &str| dat.split("\r\n").find(|line| line.contains(&format!(" {name}="))).unwrap();
    let home = numbers(find("Xhome"));
    for (index, q) in [0.1, -0.2, 0.3, -0.4, 0.5, 0.6_f64].iter().enumerate() {
        assert!((home[&format!("A{}", index + 1)] - q.to_degrees()).abs() < 1e-6);
    }
    for (name, pose) in [("Xp0", at(0.3, 0.0)), ("XAT1", at(0.3, 0.1)), ("XAT2", at(0.35, 0.15)), ("Xp2", at(0.4, 0.1))]
    {
        assert!(find(name).starts_with("DECL E6POS "));
        assert_frame(find(name), &pose.pose);
    }
    assert_frame(statements[3], &program.tools[0].tcp);
    assert_frame(statements[4], &program.work_objects[0].base_from_object());
    assert!(statements[3].starts_with("$TOOL=") && statements[4].starts_with("$BASE="));
    assert_eq!(statements[..3], ["DEF Heavy ( )", "BAS (#INITMOV,0)", "BAS (#VEL_PTP,30)"]);
    let rest = [
        "PTP Xhome",
        "PTP Xp0",
        "$VEL.CP=0.15",
        "$VEL.ORI1=500",
        "$VEL.ORI2=500",
        "$APO.CDIS=10",
        "LIN XAT1 C_DIS",
        "$VEL.CP=2",
        "CIRC XAT2,Xp2",
        "PTP Xhome",
        "END",
        "",
    ];
    assert_eq!(statements[5..], rest);
    assert!(src.contains("; optimal\r\n; This is a test program") && src.contains("(S, T) are not known"));
    assert!(dat.starts_with("&ACCESS RVP\r\n&REL 1\r\nDEFDAT Heavy\r\n") && dat.ends_with("ENDDAT\r\n"));
}

/// What a tool carries is said before its point, and read back to the same bytes; after a move it is another load.
#[test]
fn loads_of_tools_are_written_and_read() {
    let mut program = program();
    let turn = UnitQuaternion::from_euler_angles(0.1, -0.2, 0.3);
    program.tools[0].mass = 2.5;
    program.tools[0].centre_of_gravity = Vector3::new(0.01, -0.002, 0.08);
    program.tools[0].axes_of_inertia = turn;
    program.tools[0].inertia = [0.01, 0.02, 0.005];
    let written = files(&program, &Settings::default(), &[]).unwrap();
    let line = written.src.split("\r\n").find(|line| line.starts_with("$LOAD=")).unwrap();
    assert!(
        line.starts_with("$LOAD={M 2.5,CM {X 10,Y -2,Z 80,A ") && line.ends_with("},J {X 0.01,Y 0.02,Z 0.005}}"),
        "{line}"
    );
    let read = back(&written);
    assert_eq!((read.unclear_line, read.certain), (None, 5), "{:?}", read.lines);
    let carried = &read.program.tools[read.program.moves[0].tool];
    assert_eq!((carried.mass, carried.inertia), (2.5, [0.01, 0.02, 0.005]));
    assert!((carried.centre_of_gravity - program.tools[0].centre_of_gravity).norm() < 1e-9);
    assert!(carried.axes_of_inertia.angle_to(&turn) < 1e-7);
    assert_eq!(files(&read.program, &Settings::default(), &[]).unwrap(), written);
    // Loads that are said before nothing is known of moves count wherever they stand; half a load does not.
    let of = |body: &str| {
        let text = format!("DEF m ( )\n{body}PTP {{A1 0,A2 -90,A3 90,A4 0,A5 30,A6 0}}\nEND\n");
        read_text(&text)
    };
    let frames = "$TOOL=$NULLFRAME\n$BASE=$NULLFRAME\n";
    let behind = of(&format!("{frames}{line}\n"));
    assert_eq!((behind.unclear_line, behind.program.tools[behind.program.moves[0].tool].mass), (None, 2.5));
    assert_eq!(of(&format!("{frames}$LOAD={{M 3}}\n")).unclear_line, Some(4));
}

fn read_text(text: &str) -> Module {
    read(File { name: "m.src", bytes: text.as_bytes() }, None).unwrap()
}

/// Straight moves alone are bounded: joint moves have a speed of their own.
#[test]
fn speeds_that_are_not_written_are_named() {
    let program = program();
    assert_eq!(slower(&program, &Settings::default()), ["vmax"]);
    let slow = Settings { most_speed: 0.1, ..Settings::default() };
    let names = slower(&program, &slow);
    assert_eq!(names, ["v150", "vmax"]);
    let told = crate::capped::sentence(&names, 0.1).unwrap();
    assert!(told.contains("at v150, vmax go at 0.1 m/s"), "{told}");
    assert_eq!(
        (crate::capped::sentence(&[], 2.0), slower(&program, &Settings { most_speed: 100.0, ..slow })),
        (None, vec!["vmax".into()])
    );
}

#[test]
fn what_controllers_refuse_is_not_written() {
    let refused = |change: &dyn Fn(&mut Program)| {
        let mut program = program();
        change(&mut program);
        files(&program, &Settings::default(), &[]).unwrap_err()
    };
    assert_eq!(refused(&|p| drop(p.moves.remove(0))), KrlError::FirstPose);
    assert!(matches!(refused(&|p| p.name = "a".repeat(25)), KrlError::Name { .. }));
    assert!(matches!(
        refused(&|p| p.moves[2].motion = Motion::Linear(at(0.3, 0.1).named("P0"))),
        KrlError::Twice { .. }
    ));
    assert!(matches!(refused(&|p| p.moves[1].speed.tcp = f64::NAN), KrlError::Program(_)));
    let fast = Settings { joint_percent: 101.0, ..Settings::default() };
    assert!(matches!(files(&program(), &fast, &[]), Err(KrlError::Setting { field: "joint_percent", .. })));
}

fn back(files: &Files) -> Module {
    let file = |name, text: &'static str| File { name, bytes: text.as_bytes() };
    let leak = |text: &str| -> &'static str { String::from(text).leak() };
    read(file("heavy.src", leak(&files.src)), Some(file("heavy.dat", leak(&files.dat)))).unwrap()
}

#[test]
fn what_is_written_reads_back_and_is_written_the_same() {
    let program = program();
    let written = files(&program, &Settings::default(), &["optimal".into()]).unwrap();
    let read = back(&written);
    assert_eq!((read.unclear_line, read.certain, &read.mistakes[..]), (None, 5, &[][..]), "{:?}", read.lines);
    assert_eq!(files(&read.program, &Settings::default(), &read.header).unwrap(), written);
    assert_eq!((read.program.name.as_str(), read.header.as_slice()), ("Heavy", &["optimal".to_owned()][..]));
    for (a, b) in program.moves.iter().zip(&read.program.moves) {
        // Joint moves stop.
        let stops = |m: &Move| m.zone.fine || !matches!(m.motion, Motion::Linear(_) | Motion::Circular { .. });
        assert_eq!((a.motion.name(), stops(a)), (b.motion.name(), stops(b)));
        for (p, q) in a.motion.poses().zip(b.motion.poses()) {
            assert!((p.pose.translation.vector - q.pose.translation.vector).norm() < 2e-9);
            assert!(p.pose.rotation.angle_to(&q.pose.rotation) < 1e-7);
        }
        let (object, again) = (&program.work_objects[a.work_object], &read.program.work_objects[b.work_object]);
        let off = object.base_from_object().inverse() * again.base_from_object();
        assert!(off.translation.vector.norm() < 1e-8 && off.rotation.angle() < 1e-7);
    }
    assert_eq!(read.program.moves[2].speed.tcp, 0.15);
    // Lines are counted through both files; each is told with its own.
    let dat_line = read.targets[0].line;
    assert_eq!((read.told(read.program.moves[0].line.unwrap()), read.targets.len()), ("heavy.src line 13".into(), 4));
    assert_eq!(read.told(dat_line), "heavy.dat line 5");
}

#[test]
fn what_is_not_followed_is_named_by_line() {
    let head = "DEF m ( )\n$TOOL={X 0,Y 0,Z 100,A 0,B 0,C 0}\n$BASE=$NULLFRAME\n$VEL.CP=0.2\nPTP {A1 0,A2 -90,A3 90,A4 0,A5 30,A6 0}\n";
    let p = "{X 400,Y 0,Z 300,A 0,B 90,C 0}";
    for (body, kind, words) in [
        (format!("LIN {p}"), None, ""),
        (format!("LIN {p} C_PTP"), Some(Unmodelled::Interpolation), "C_PTP is not followed"),
        ("LIN {X 400,Y 0,Z 300,A 0,B 90,C 0,E1 900}".into(), Some(Unmodelled::ExternalAxes), "E1 = 900 in use"),
        ("PTP {X 400,Y 0,Z 300,A 0,B 90,C 0,S 2,T 'B010'}".into(), Some(Unmodelled::Interpolation), "(S, T)"),
        ("$LOAD={M 3}".into(), Some(Unmodelled::Payload), "$LOAD"),
        ("TRIGGER WHEN DISTANCE=0 DELAY=0 DO $OUT[1]=TRUE".into(), Some(Unmodelled::Triggers), "TRIGGER"),
        ("BAS (#VEL_CP,0.5)".into(), Some(Unmodelled::Speeds), "#VEL_CP"),
        ("IF $IN[1] THEN".into(), None, "`IF` is not followed"),
        ("WAIT FOR far(2)".into(), None, "`far` is not followed"),
        ("PULSE ($OUT[5],TRUE,far())".into(), None, "`far` is not followed"),
        ("$OUT[1]=far ()".into(), None, "`far` is not followed"),
        ("LIN XP9".into(), None, "`XP9` is not declared"),
        ("LIN {X 1,Y 2}".into(), None, "Z is missing"),
        (format!("LIN {}", p.replace("C 0", "C 0,X 900")), None, "`X` stands there twice"),
        ("(what)".into(), None, "is not followed"),
    ] {
        let text = format!("{head}{body} ; comment\nLIN {p}\nEND\n");
        let read = read(File { name: "m.src", bytes: text.as_bytes() }, None).unwrap();
        let line = &read.lines[&6];
        let clear = words.is_empty();
        assert_eq!((read.unclear_line, read.certain), if clear { (None, 3) } else { (Some(6), 1) }, "{body}: {line:?}");
        assert_eq!(line.class, if clear { Class::Understood } else { Class::ChangesMotion }, "{body}");
        assert!(line.what.contains(words) && line.unmodelled == kind, "{body}: {line:?}");
    }
    for body in [
        "WAIT FOR NOT ($IN[1]) AND ($IN[2])",
        "WAIT SEC (0.5)",
        "PULSE ($OUT[5],TRUE,ABS(-0.5))",
        "$OUT[1]=($IN[2] OR (NOT $IN[3]))",
        "MsgNotify(\"far(1)\")",
    ] {
        let text = format!("{head}{body}\nLIN {p}\nEND\n");
        let read = read(File { name: "m.src", bytes: text.as_bytes() }, None).unwrap();
        assert_eq!((read.unclear_line, read.certain), (None, 2), "{body}: {:?}", read.lines);
        assert_eq!(read.lines[&6].class, Class::Harmless, "{body}");
    }
    let cut = format!("{head}LIN {p}\n\n");
    let read_cut = read(File { name: "m.src", bytes: cut.as_bytes() }, None).unwrap();
    assert_eq!((read_cut.unclear_line, read_cut.certain), (Some(6), 2), "{:?}", read_cut.lines);
    assert_eq!(read_cut.lines[&6].what, "the file ends before END: it was cut short");
    let bare = "DEF m ( )\nPTP {A1 0,A2 -90,A3 90,A4 0,A5 30,A6 0}\nEND\n";
    let bare = read(File { name: "m.src", bytes: bare.as_bytes() }, None).unwrap();
    assert!(bare.lines[&2].what.contains("$TOOL and $BASE are not both set"));
    assert_eq!(read(File { name: "m.src", bytes: b"hello" }, None), Err(NoProgram::Absent));
}

const AT: &str = "PTP {A1 0,A2 -90,A3 90,A4 0,A5 30,A6 0}";
const FRAMES: &str = "$TOOL=$NULLFRAME\n$BASE=$NULLFRAME\n";

/// What stands behind a harmless word, a declaration or a frame is read over by nobody.
#[test]
fn statements_are_understood_to_their_end() {
    let far = "PTP {A1 170,A2 -90,A3 90,A4 0,A5 30,A6 0}";
    let of = |body: &str| read_text(&format!("DEF m ( )\n{FRAMES}{AT}\n{body}\n{AT}\nEND\n"));
    for body in [
        &format!("HALT {far}")[..],
        &format!("WAIT SEC 1 {far}"),
        &format!("WAIT FOR $IN[1] {far}"),
        &format!("$OUT[1]=TRUE {far}"),
        "CONTINUE $TOOL={X 0,Y 0,Z 900,A 0,B 0,C 0}",
        &format!("$ADVANCE=3 {far}"),
        "$ADVANCE=0",
        "$ADVANCE=n",
        &format!("PULSE ($OUT[1],TRUE,0.5) {far}"),
        &format!("ANOUT ON x=1+$VEL_ACT DELAY=0.1 {far}"),
        &format!("ANOUT OFF x {far}"),
        &format!("MsgNotify(\"a\") {far}"),
        "CWRITE($CMD,STAT,MODE,\"RUN /R1/FAR()\")",
        &format!("BAS (#VEL_PTP,30) {far}"),
        &format!("BAS (#INITMOV,0) {far}"),
        "$OUT[far()]=TRUE",
        "$TIMER_OF_MINE=3",
        "WAIT",
        "WAIT SEC",
        "WAIT FOR ($IN[1]",
        "GLOBAL INTERRUPT DECL 3 WHEN $IN[1]==TRUE DO far ( )",
    ] {
        let read = of(body);
        assert_eq!((read.unclear_line, read.certain), (Some(5), 1), "{body}: {:?}", read.lines);
        assert_eq!(read.program.moves.len(), 2, "{body}");
    }
    // Declarations are read before anything is executed.
    for body in [
        &format!("DECL INT i {far}")[..],
        &format!("SIGNAL s $OUT[1] {far}"),
        "INT i=far()",
        "DECL FRAME $BASE={X 2000}",
    ] {
        let read = of(body);
        assert_eq!((read.unclear_line, read.certain), (Some(5), 0), "{body}: {:?}", read.lines);
    }
    for body in [
        "HALT",
        "CONTINUE",
        "WAIT SEC 0.5*(1+2)",
        "WAIT FOR ($IN[1]==TRUE) AND NOT $IN[2] OR (x.y[2]<>#OPEN)",
        "$OUT[2+1]=$IN[1] EXOR FALSE",
        "$ADVANCE=3",
        "$TIMER[1]=-1.5E3",
        "PULSE($OUT[1],TRUE,0.5)",
        "ANOUT ON x=0.5*$VEL_ACT-0.1 DELAY=0.1 MINIMUM=0.3",
        "DIGIN OFF",
        "SWRITE(text[],STATE,OFFSET,\"%d; PTP\",n)",
        "DECL INT i,j[3]",
        "DECL CHAR text[20]",
        "GLOBAL CONST REAL r=-1.5",
        "STRUC GRIP INT a,b,BOOL c",
        "ENUM COLOUR RED,GREEN",
        "SIGNAL s $OUT[1] TO $OUT[8]",
        "EXT BAS (BAS_COMMAND :IN,REAL :IN )",
        "DECL FDAT F1={TOOL_NO 1,BASE_NO 0,IPO_FRAME #BASE,POINT2[] \" \",TQ_STATE FALSE}",
    ] {
        let read = of(body);
        let left = body == "DIGIN OFF";
        assert_eq!(read.unclear_line, left.then_some(5), "{body}: {:?}", read.lines);
    }
    for (text, line) in [
        (format!("$BASE=$NULLFRAME\nDEF m ( )\n{FRAMES}{AT}\nEND\n"), 1),
        (format!("DEF m ( ) {far}\n{FRAMES}{AT}\nEND\n"), 1),
        (format!("DEF m ( )\n{FRAMES}{AT}\nEND {far}\n"), 5),
        (format!("DEF m ( )\n{FRAMES}{AT}\nEND\n{far}\n"), 6),
    ] {
        let read = read_text(&text);
        assert_eq!(read.unclear_line, Some(line), "{text}: {:?}", read.lines);
    }
    // What another routine declares is its own.
    let two = format!(
        "DEF m ( )\nDECL AXIS XH={{A1 0,A2 -90,A3 90,A4 0,A5 30,A6 0}}\n{FRAMES}PTP XH\nEND\nDEF n ( )\n\
         DECL AXIS XH={{A1 170,A2 -90,A3 90,A4 0,A5 30,A6 0}}\nEND\n"
    );
    let read = read_text(&two);
    assert_eq!(read.unclear_line, None, "{:?}", read.lines);
    assert!(matches!(&read.program.moves[0].motion, Motion::AbsoluteJoint(to) if to.joints[0] == 0.0));
    let twice = two.replace("END\nDEF n ( )\n", "");
    assert_eq!(read_text(&twice).unclear_line, Some(5), "{twice}");
    let deep = format!("WAIT FOR {}", "(".repeat(100_000));
    assert_eq!(of(&deep).unclear_line, Some(5));
}

/// A file of data holds declarations, and nothing else.
#[test]
fn what_is_no_declaration_among_data_is_named() {
    let src = format!("DEF m ( )\n{FRAMES}PTP XH\nEND\n");
    let of = |body: &str| {
        let dat = format!("DEFDAT m PUBLIC\nDECL E6AXIS XH={{A1 0,A2 -90,A3 90,A4 0,A5 30,A6 0}}\n{body}");
        read(File { name: "m.src", bytes: src.as_bytes() }, Some(File { name: "m.dat", bytes: dat.as_bytes() }))
            .unwrap()
    };
    for body in [
        "$BASE={X 2000,Y 0,Z 0,A 0,B 0,C 0}\nENDDAT\n",
        "XH={A1 170,A2 -90,A3 90,A4 0,A5 30,A6 0}\nENDDAT\n",
        "DECL INT i $BASE={X 2000,Y 0,Z 0,A 0,B 0,C 0}\nENDDAT\n",
        "i[1]=5 6\nENDDAT\n",
        "ENDDAT $BASE={X 2000}\n",
        "DECL INT i\n",
    ] {
        let read = of(body);
        let line = read.unclear_line.map(|line| read.told(line));
        assert_eq!((line.as_deref(), read.certain), (Some("m.dat line 3"), 0), "{body}");
    }
    let read = of(";FOLD\nDECL INT i[3]\ni[1]=5\nDECL LDAT L1={VEL 2.0,APO_MODE #CDIS}\nENDDAT\n");
    assert_eq!((read.unclear_line, read.certain), (None, 1), "{:?}", read.lines);
}

#[test]
fn rates_are_held_to_what_controllers_take() {
    let of = |line: &str| read_text(&format!("DEF m ( )\n{FRAMES}{line}\n{AT}\nEND\n"));
    for (line, words) in [
        ("BAS (#VEL_PTP,0)", "line 4: BAS (#VEL_PTP) = 0: must be more than 0 % and at most 100 %"),
        ("BAS(#VEL_PTP,150)", "BAS (#VEL_PTP) = 150: must be"),
        ("BAS (#ACC_PTP,-5)", "BAS (#ACC_PTP) = -5: must be"),
        ("$VEL.CP=0", "$VEL.CP = 0: must be more than 0 m/s and at most 3 m/s"),
        ("$VEL.CP=200", "$VEL.CP = 200: must be more than 0 m/s and at most 3 m/s"),
        ("$VEL.CP=-1", "$VEL.CP = -1: must be"),
        ("$VEL.ORI1=0", "$VEL.ORI1 = 0: must be a number, more than 0 °/s"),
        ("$VEL.ORI2=-3", "$VEL.ORI2 = -3: must be"),
        ("$APO.CDIS=-5", "$APO.CDIS = -5: must be a number from 0 to 10000"),
    ] {
        let read = of(line);
        assert_eq!((read.unclear_line, read.certain), (None, 1), "{line}: {:?}", read.lines);
        let told: Vec<String> = read.refused.iter().map(ToString::to_string).collect();
        assert!(told.len() == 1 && told[0].contains(words), "{line}: {told:?}");
        assert!(read.whole().unwrap_err().contains(words), "{line}");
    }
    for line in ["BAS (#VEL_PTP,30)", "BAS (#ACC_PTP,100)", "$VEL.CP=0.25", "$APO.CDIS=0"] {
        assert_eq!(of(line).refused.len(), 0, "{line}");
    }
    assert_eq!(of("BAS (#VEL_PTP,v)").unclear_line, Some(4));
}
