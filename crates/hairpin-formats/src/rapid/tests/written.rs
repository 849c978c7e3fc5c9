//! Programs as they are written.

use hairpin::trajectory::program::{
    JointTarget, Motion, Move, NO_EXTERNAL, PoseTarget, Program, Speed, Tool, WorkObject, Zone, unit_quaternion,
};
use nalgebra::{Isometry3, Translation3, Vector3};

use crate::banner::NOTICE;

use super::super::{NameError, Options, RapidError, as_name, check_name, module, program_file, read, slow};

fn target(x: f64, y: f64, z: f64) -> PoseTarget {
    let turn = unit_quaternion([0.0, 0.6, 0.0, 0.8]).unwrap();
    let pose = Isometry3::from_parts(Translation3::new(x, y, z), turn);
    PoseTarget { configuration: Some([0, -1, 1, 4]), ..PoseTarget::unnamed(pose) }
}

fn small() -> Program {
    let tool = Tool {
        name: "tGrip".into(),
        declare: true,
        tcp: Isometry3::translation(0.0, 0.0, 0.12),
        mass: 0.8,
        centre_of_gravity: Vector3::new(0.0, 0.0, 0.05),
        ..Tool::flange()
    };
    let mut program = Program::new("Heavy", "heavy_run", tool, WorkObject::base());
    let home = JointTarget {
        name: Some("home".into()),
        joints: [0.0, 0.0, 0.0, 0.0, 30_f64.to_radians(), 0.0],
        external: NO_EXTERNAL,
    };
    let speed = |name: &str| Speed::predefined(name).unwrap();
    let move_to = |motion, name: &str| Move::new(motion, speed(name), Zone::stop());
    program.moves = vec![
        move_to(Motion::AbsoluteJoint(home.clone()), "v200"),
        move_to(Motion::Joint(target(0.3, 0.0, 0.4).named("p0")), "vmax"),
        Move { configuration_demanded: false, ..move_to(Motion::Linear(target(0.3, 0.1, 0.4).named("p1")), "v1000") },
        Move {
            zone: Zone::predefined("z10").unwrap(),
            ..move_to(Motion::Circular { via: target(0.35, 0.15, 0.4).named("p2"), to: target(0.4, 0.1, 0.4) }, "v20")
        },
        move_to(Motion::AbsoluteJoint(home), "v200"),
    ];
    program
}

#[test]
fn a_module_is_written_as_controllers_load_it() {
    let text = module(&small(), &["cost 12.3 → optimal, clear: all links".into()]).unwrap();
    let expected = "MODULE Heavy\r
  ! cost 12.3 -> optimal, clear: all links\r
  ! This is a test program: it is stressful by design, and no safety certificate.\r
  LOCAL CONST jointtarget home := [[0,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\r
  TASK PERS tooldata tGrip := [TRUE,[[0,0,120],[1,0,0,0]],[0.8,[0,0,50],[1,0,0,0],0,0,0]];\r
  LOCAL CONST robtarget p0 := [[300,0,400],[0,0.6,0,0.8],[0,-1,1,4],[9E9,9E9,9E9,9E9,9E9,9E9]];\r
  LOCAL CONST robtarget p1 := [[300,100,400],[0,0.6,0,0.8],[0,-1,1,4],[9E9,9E9,9E9,9E9,9E9,9E9]];\r
  LOCAL CONST robtarget p2 := [[350,150,400],[0,0.6,0,0.8],[0,-1,1,4],[9E9,9E9,9E9,9E9,9E9,9E9]];\r
\r
  PROC heavy_run()\r
    MoveAbsJ home, v200, fine, tGrip \\WObj:=wobj0;\r
    MoveJ p0, vmax, fine, tGrip \\WObj:=wobj0;\r
    ConfL \\Off;\r
    MoveL p1, v1000, fine, tGrip \\WObj:=wobj0;\r
    ConfL \\On;\r
    MoveC p2, [[400,100,400],[0,0.6,0,0.8],[0,-1,1,4],[9E9,9E9,9E9,9E9,9E9,9E9]], v20, z10, tGrip \\WObj:=wobj0;\r
    MoveAbsJ home, v200, fine, tGrip \\WObj:=wobj0;\r
  ENDPROC\r
ENDMODULE\r
";
    assert_eq!(text, expected);
    assert!(text.is_ascii() && text.matches('\n').count() == text.matches("\r\n").count());
    let back = read(text.as_bytes(), &Options::default()).unwrap();
    assert_eq!(back.header, ["cost 12.3 -> optimal, clear: all links"]);
    assert!(text.contains(NOTICE));
}

#[test]
fn the_first_run_is_slow_all_over() {
    let program = small();
    let slowed = slow(&program, &Speed::predefined("v50").unwrap());
    let text = module(&slowed, &[]).unwrap();
    assert!(text.starts_with("MODULE Heavy_slow\r\n") && text.contains("PROC heavy_run_slow()"));
    let speeds: Vec<_> = slowed.moves.iter().map(|m| m.speed.name.as_deref().unwrap()).collect();
    assert_eq!(speeds, ["v50", "v50", "v50", "v20", "v50"]);
    let named = Program { name: "N".repeat(32), procedure: "P".repeat(30), ..program };
    let slowed = slow(&named, &Speed::predefined("v50").unwrap());
    assert_eq!((slowed.name.len(), slowed.procedure.len()), (32, 32));
    module(&slowed, &[]).unwrap();
}

#[test]
fn the_program_file_names_the_module() {
    let text = program_file("a&b.mod");
    assert_eq!(
        text,
        "<?xml version=\"1.0\" encoding=\"ISO-8859-1\" ?>\r\n<Program>\r\n\t<Module>a&amp;b.mod</Module>\r\n</Program>\r\n"
    );
}

#[test]
fn names_that_controllers_refuse_are_refused() {
    for good in ["p10", "P", "a_b_3", &"x".repeat(32)] {
        assert_eq!(check_name(good), Ok(()));
    }
    for reserved in
        ["MOD", "div", "Proc", "xor", "tool0", "WOBJ0", "v1000", "VMAX", "fine", "z50", "MoveL", "robtarget", "Offs"]
    {
        assert_eq!(check_name(reserved), Err(NameError::Reserved { name: reserved.into() }), "{reserved}");
        check_name(&as_name(reserved)).unwrap();
    }
    for spelt in ["", "1a", "_a", "a-b", "größe", "a b"] {
        assert_eq!(check_name(spelt), Err(NameError::Spelling { name: spelt.into() }), "{spelt}");
        check_name(&as_name(spelt)).unwrap();
    }
    assert!(matches!(check_name(&"x".repeat(33)), Err(NameError::Long { length: 33, .. })));
    check_name(&as_name(&"v".repeat(60))).unwrap();
}

#[test]
fn programs_that_would_stop_a_controller_are_not_written() {
    let refused = |change: &dyn Fn(&mut Program)| {
        let mut program = small();
        change(&mut program);
        module(&program, &[]).unwrap_err()
    };
    let error = refused(&|p| p.name = "MODULE".into());
    assert_eq!(error.to_string(), "module: `MODULE` is a name that RAPID or the controller uses itself");
    assert!(matches!(refused(&|p| p.procedure = "heavy".into()), RapidError::Twice { .. }));
    let same_name = refused(&|p| p.moves[2].motion = Motion::Linear(target(0.3, 0.1, 0.45).named("P0")));
    assert_eq!(same_name, RapidError::Twice { name: "P0".into() });
    let endless = |p: &mut Program| p.moves[1].speed.name = Some("vBig".into());
    assert!(matches!(refused(&endless), RapidError::Endless { index: 1, .. }));
    for (change, words) in [
        (&(|p: &mut Program| drop(p.moves.drain(..3))) as &dyn Fn(&mut Program), "cannot begin with a circular move"),
        (&|p| p.moves[0].zone.tcp = f64::NAN, "zone = NaN"),
        (&|p| p.moves[2].motion = Motion::Linear(target(f64::INFINITY, 0.0, 0.0)), "position = inf"),
        (&|p| p.moves[1].tool = 3, "tool 3 of 1"),
    ] {
        let error = refused(change).to_string();
        assert!(error.contains(words), "{error}");
    }
}
