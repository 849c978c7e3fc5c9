//! Programs as they stand in cells.

use hairpin::trajectory::program::{Motion, Speed, Zone};

use super::super::{NoModule, Options, read};
use super::{FIRST, assert_clear, classes, inside, is_linear, main_of, place, pose, unclear};
use crate::listing::{Class, Unmodelled};

/// As a backup has it: header line, attributes, ISO 8859-1 in a comment, values of RobotStudio's making.
const BACKUP: &[u8] = b"%%%\r\n  VERSION:1\r\n  LANGUAGE:ENGLISH\r\n%%%\r\n\r\nMODULE Palette(NOSTEPIN)\r\n\
  ! Gr\xf6\xdfe der Palette\r\n\
  TASK PERS tooldata tGrip:=[TRUE,[[31.792631019,0,229.638935148],[0.945518576,0,0.325568154,0]],[1,[0,0,1],[1,0,0,0],0,0,0]];\r\n\
  TASK PERS wobjdata wPal:=[FALSE,TRUE,\"\",[[1000,-500,200],[0.70710678,0,0,0.70710678]],[[10,0,0],[1,0,0,0]]];\r\n\
  PERS speeddata vPick:=[250,500,5000,1000];\r\n\
  CONST robtarget pPick:=[[100,0,50],[0,1,0,0],[-1,0,1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];\r\n\
  VAR num nCount:=0;\r\n\
  VAR clock ck1;\r\n\
  PROC main()\r\n\
    AccSet 100,100;\r\n\
    ConfL\\Off;\r\n\
    WHILE TRUE DO\r\n\
      Pick;\r\n\
      nCount:=nCount+1;\r\n\
      WaitDI diReady,1;\r\n\
    ENDWHILE\r\n\
  ENDPROC\r\n\
  LOCAL PROC Pick()\r\n\
    MoveJ Offs(pPick,0,0,100),v1000,z50,tGrip\\WObj:=wPal;\r\n\
    MoveL pPick,\r\n\
      vPick\\V:=100,\r\n\
      fine\\Inpos:=inpos50,tGrip\\WObj:=wPal;\r\n\
    Set doGrip; WaitTime\\InPos,0.2;\r\n\
    MoveL RelTool(pPick,0,0,-100\\Rz:=90),v2500,z10,tGrip\\WObj:=wPal;\r\n\
  ERROR\r\n\
    MoveJ pPick,v5,fine,tool0;\r\n\
    RETRY;\r\n\
  ENDPROC\r\n\
ENDMODULE\r\n";

#[test]
fn a_backup_is_read_move_by_move() {
    let module = read(BACKUP, &Options::default()).unwrap();
    // What comes in between is named, and the way without it is certain.
    let handler = "it may move the arm in the ERROR handler of `Pick`, which is not followed";
    assert_eq!((unclear(&module), module.lines[&31].unmodelled), ((31, handler), Some(Unmodelled::Handlers)));
    assert!(module.mistakes.is_empty() && module.certain == module.program.moves.len());
    let program = &module.program;
    assert_eq!((program.name.as_str(), program.procedure.as_str()), ("Palette", "main"));
    assert_eq!(program.moves.len(), 3, "one round of an endless loop");
    assert!(matches!(program.moves[0].motion, Motion::Joint(_)) && is_linear(&program.moves[1]));
    let places: Vec<_> = program.moves.iter().map(place).collect();
    // The tool points down: along its −z is up.
    assert_eq!(places, [[100_000, 0, 150_000], [100_000, 0, 50_000], [100_000, 0, 150_000]]);
    assert_eq!(program.moves[1].speed.tcp, 0.1);
    assert_eq!(program.moves[2].speed, Speed::predefined("v2500").unwrap());
    assert_eq!(program.moves[1].zone, Zone::stop());
    assert_eq!(pose(&program.moves[1]).name.as_deref(), Some("pPick"));
    assert_eq!(pose(&program.moves[1]).configuration, Some([-1, 0, 1, 0]));
    assert!(program.moves[0].configuration_demanded && !program.moves[1].configuration_demanded);
    assert_eq!(program.moves[2].line, Some(29));
    let tool = &program.tools[program.moves[0].tool];
    assert!(tool.declare && (tool.tcp.translation.z - 0.229_638_935_148).abs() < 1e-15);
    let object = &program.work_objects[program.moves[0].work_object];
    assert!((object.base_from_object().translation.vector - nalgebra::Vector3::new(1.0, -0.49, 0.2)).norm() < 1e-8);
    assert_eq!(classes(&module, [19, 25, 31]), [Class::Understood, Class::Understood, Class::ChangesMotion]);
    assert_eq!(module.header, ["Größe der Palette"]);
}

#[test]
fn scalars_come_first() {
    let module = main_of("MoveL p20, v100, fine, tool0;");
    let q = pose(&module.program.moves[0]).pose.rotation;
    assert_eq!([q.w, q.i, q.j, q.k], [0.0, 0.0, 1.0, 0.0]);
}

#[test]
fn arrays_loops_and_arguments_are_evaluated() {
    let module = inside(
        "CONST num n:=3;\n\
         VAR robtarget grid{n};\n\
         CONST robtarget p:=[[0,0,0],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n\
         CONST pos shifts{2,2}:=[[[1,0,0],[2,0,0]],[[3,0,0],[4,0,0]]];\n\
         PROC main()\n\
         FOR i FROM 1 TO Dim(grid,1) DO\n\
           grid{i}:=p;\n\
           grid{i}.trans.x:=100*i;\n\
           grid{i}.trans:=grid{i}.trans+shifts{2,1};\n\
         ENDFOR\n\
         FOR i FROM n TO 1 STEP -2 DO\n\
           visit grid{i}\\height:=10 DIV 3;\n\
         ENDFOR\n\
         visit grid{2};\n\
         ENDPROC\n\
         PROC visit(robtarget goal, \\num height)\n\
           IF Present(height) THEN\n\
             goal.trans.z:=height;\n\
           ENDIF\n\
           MoveL goal, v100, z1, tool0;\n\
         ENDPROC",
    );
    assert_clear(&module);
    let places: Vec<_> = module.program.moves.iter().map(place).collect();
    assert_eq!(places, [[303_000, 0, 3_000], [103_000, 0, 3_000], [203_000, 0, 0]]);
    assert!(module.program.moves.iter().all(|m| m.motion.name().is_none()), "what was changed has no name");
}

#[test]
fn expressions_have_the_precedence_of_rapid() {
    for (expression, value) in [
        ("2+3*4", 14.0),
        ("(2+3)*4", 20.0),
        ("-2*-3", 6.0),
        ("7 MOD 4 + 7 DIV 4", 4.0),
        ("2-3-4", -5.0),
        ("Abs(-5)+Sqrt(9)", 8.0),
        ("Sin(30)*10", 5.0),
        ("ATan2(1,-1)", 135.0),
        ("Round(2.3456\\Dec:=2)", 2.35),
        ("Trunc(-2.7)", -2.0),
        ("Pow(2,10)", 1024.0),
        ("EulerZYX(\\Z,OrientZYX(30,20,10))", 30.0),
        ("EulerZYX(\\X,OrientZYX(30,20,10))", 10.0),
        ("Distance([1,2,2],[0,0,0])", 3.0),
        ("0x1F + .5e1", 36.0),
        ("twice(4)", 8.0),
    ] {
        let module = inside(&format!(
            "FUNC num twice(num x)\nRETURN 2*x;\nENDFUNC\n\
             PROC main()\nVAR num a;\na:={expression};\n\
             MoveL [[a,0,0],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]], v5, fine, tool0;\nENDPROC"
        ));
        assert_clear(&module);
        assert!((pose(&module.program.moves[0]).pose.translation.x * 1e3 - value).abs() < 1e-9, "{expression}");
    }
    for (condition, holds) in [
        ("1<2 AND NOT 2<1", true),
        ("NOT TRUE OR TRUE", true),
        ("NOT (TRUE OR TRUE)", false),
        ("TRUE XOR TRUE", false),
        ("\"ab\"+\"c\"=\"abc\"", true),
        ("di1=1 OR TRUE", true),
        ("[1,2,3]=[1,2,3]", true),
        ("home.robax=[0,-10,20,0,30,0]", true),
        ("p10.robconf<>[0,-1,0,1]", false),
        ("[500,0,600]=p10.trans", true),
        ("p10.trans=[500,0,601]", false),
        ("0.1+0.2=0.3", true),
    ] {
        let module =
            main_of(&format!("IF {condition} THEN MoveL p10,v5,fine,tool0; ELSE MoveL p20,v5,fine,tool0; ENDIF"));
        assert_clear(&module);
        assert_eq!(module.program.moves[0].motion.name(), Some(if holds { "p10" } else { "p20" }), "{condition}");
    }
}

#[test]
fn records_are_compared_whatever_they_are_made_by() {
    let module = inside(
        "CONST robtarget p:=[[0,0,0],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\nVAR pos a:=[1,2,3];\nVAR num n:=0;\n\
         PROC main()\nIF a=there(2) n:=n+1;\nIF there(2)=a n:=n+10;\nIF a<>there(4) n:=n+100;\n\
         TEST a\nCASE [3,2,1]: n:=0;\nCASE [1,2,3]: n:=n+1000;\nENDTEST\nMoveL Offs(p,n,0,0),v5,fine,tool0; EXIT;\nENDPROC\n\
         FUNC pos there(num y)\nRETURN [1,y,3];\nENDFUNC",
    );
    assert_clear(&module);
    assert_eq!(place(&module.program.moves[0]), [1_111_000, 0, 0]);
}

/// Ten times 0.1 is more than 1 in single precision, and less in double.
#[test]
fn a_num_is_single_and_a_dnum_double() {
    for (kind, rounds, times) in [
        ("num", "WHILE h<1 DO\nh:=h+0.1;\nn:=n+1;\nENDWHILE", 10),
        ("num", "WHILE h<1 DO\nAdd h,0.1;\nn:=n+1;\nENDWHILE", 10),
        ("num", "FOR i FROM 0 TO 1 STEP 0.1 DO\nn:=n+1;\nENDFOR", 10),
        ("num", "WHILE h<1 DO\nh:=tenth()+h;\nn:=n+1;\nENDWHILE", 10),
        ("dnum", "WHILE h<1 DO\nh:=h+0.1;\nn:=n+1;\nENDWHILE", 11),
        ("dnum", "WHILE h<1 DO\nAdd h,0.1;\nn:=n+1;\nENDWHILE", 11),
        ("dnum", "WHILE h<1 DO\nh:=tenth()+h;\nn:=n+1;\nENDWHILE", 11),
    ] {
        let module = inside(&format!(
            "CONST robtarget p:=[[0,0,0],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n\
             PROC main()\nVAR {kind} h:=0;\nVAR num n:=0;\n{rounds}\nMoveL Offs(p,n,0,0),v5,fine,tool0;\nENDPROC\n\
             FUNC {kind} tenth()\nRETURN 0.1;\nENDFUNC"
        ));
        assert_clear(&module);
        assert_eq!(place(&module.program.moves[0]), [times * 1000, 0, 0], "{kind}: {rounds}");
    }
}

#[test]
fn moves_with_extras_are_moves() {
    let module = main_of(
        "MoveAbsJ home\\NoEOffs, v1000\\T:=2.5, z50, tool0;\n\
         MoveL \\Conc, p10, v1000, z50\\Z:=15, tool0\\WObj:=wobj0\\TLoad:=load0;\n\
         MoveLDO p20, v100, z10, tool0, do1, 1;\n\
         MoveJSync p10, v100, z10, tool0, \"note\";\n\
         MoveC p20, Offs(p20,-200,100,-50), vmax, z1, tool0;\n\
         movej p20, V100, Fine, TOOL0;\nENDPROC\nPROC note()\nTPWrite \"corner\";",
    );
    assert_clear(&module);
    assert!(module.procedures.iter().all(|procedure| procedure.executed));
    let moves = &module.program.moves;
    assert_eq!(moves.len(), 6);
    let Motion::AbsoluteJoint(home) = &moves[0].motion else { panic!("{:?}", moves[0]) };
    assert_eq!(home.joints.map(|q| q.to_degrees().round()), [0.0, -10.0, 20.0, 0.0, 30.0, 0.0]);
    assert_eq!(moves[0].duration, Some(2.5));
    assert_eq!((moves[1].zone.tcp, moves[1].zone.name.as_deref()), (0.015, None));
    assert!(matches!(moves[4].motion, Motion::Circular { .. }) && moves[4].speed.tcp.is_infinite());
    assert!(moves[5].zone.fine);
    assert_eq!(module.program.problems(), []);
}

#[test]
fn what_depends_on_the_cell_is_told_where_it_matters() {
    for (body, line, words) in [
        ("MoveL p10,v5,fine,tool0;\nIF di1=1 THEN\nMoveL p20,v5,fine,tool0;\nENDIF", 1, "depends on the cell"),
        ("IF di1=1 RETURN;\nMoveL p10,v5,fine,tool0;", 0, "depends on the cell"),
        ("VelSet 50,800;\nMoveL p10,v5,fine,tool0;", 0, "velset is not followed"),
        ("AccSet 50,100;", 0, "accset"),
        ("SingArea\\Wrist;", 0, "singarea"),
        ("PDispSet [[0,0,1],[1,0,0,0]];", 0, "PDispSet is not followed"),
        ("SoftAct 3,20;", 0, "SoftAct"),
        ("TriggL p10,v500,io1,fine,tool0;", 0, "TriggL"),
        ("MoveExtJ home,vrot10,z50;", 0, "MoveExtJ"),
        ("EOffsSet [1,0,0,0,0,0];", 0, "EOffsSet"),
        ("StartMove;", 0, "StartMove"),
        ("Weld;", 0, "`Weld` is not in this file"),
        ("GOTO again;", 0, "GOTO"),
        ("MoveL p99,v5,fine,tool0;", 0, "`p99` is not declared in this file"),
        ("MoveL p10,v5,fine,tGrip;", 0, "tool `tGrip` is not declared in this file"),
        ("MoveL p10,v5,fine,tool0\\WObj:=w1;", 0, "work object `w1` is not declared in this file"),
        ("MoveL p10,v5,fine,tool0\\Corr;", 0, "\\corr"),
        ("MoveL p10,v55,fine,tool0;", 0, "`v55` is not declared"),
        ("MoveL CRobT(),v5,fine,tool0;", 0, "`CRobT` is not known from this file"),
        ("MoveL Offs(CRobT(),1,0,0),v5,fine,tool0;", 0, "`Offs` is not known from this file"),
        ("MoveL Offs(p10,0,part1.h,0),v5,fine,tool0;", 0, "`part1` is not known from this file"),
        ("MoveL RelTool(p10,0,0,1\\Rz:=2*gap),v5,fine,tool0;", 0, "`gap` is not known from this file"),
        ("MoveL home,v5,fine,tool0;", 0, "`home` is no robtarget"),
        ("MoveL p10,v5,fine;", 0, "4 arguments"),
        (
            "MoveL [[1,2,3],[0.9,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v5,fine,tool0;",
            0,
            "square 0.810000: must be 1 within 0.00001",
        ),
    ] {
        let module = main_of(body);
        let (found, what) = unclear(&module);
        assert_eq!(found, FIRST + line, "{body}: {what}");
        assert!(what.contains(words), "{body}: {what}");
        assert_eq!((module.certain, module.unclear_line), (line, Some(found)), "{body}");
    }
}

#[test]
fn what_does_not_touch_motion_is_harmless() {
    let harmless = [
        "SetDO do1,1;",
        "WaitTime 0.5;",
        "WaitUntil di1=1;",
        "TPWrite \"part \"\\Num:=3;",
        "VelSet 100,5000;",
        "SingArea\\Off;",
        "ClkReset ck; ClkStart ck;",
        "IF di1=1 THEN\nSet do1;\nENDIF",
        "IF di1=1 TPWrite \"go\";",
        "TPReadNum n, \"How many?\";",
        "PulseDO\\PLength:=0.2, do1;",
        "GripLoad load0;",
        "IDelete i1; ISleep i1;",
        "SoftDeact;",
        "ErrRaise \"ERR_NONE\",4800,\"No part\",\"put one\",\"\",\"\",\"\";",
        "label1:",
    ];
    for line in harmless {
        let module = main_of(&format!("{line}\nMoveL p10,v5,fine,tool0;"));
        assert_clear(&module);
        assert_eq!((module.class(FIRST), module.program.moves.len()), (Class::Harmless, 1), "{line}");
    }
}

#[test]
fn what_the_cell_may_have_changed_is_not_known() {
    for write in ["TPReadNum n, \"x\";", "IF di1=1 THEN n:=5; ENDIF", "n:=ReadNum(f);", "IF di1=1 Incr n;", "set5 n;"] {
        let module = inside(&format!(
            "CONST robtarget p:=[[0,0,0],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\nVAR num n:=1;\n\
             PROC main()\nMoveL Offs(p,n,0,0),v5,fine,tool0;\n{write}\nMoveL Offs(p,n,0,0),v5,fine,tool0;\nENDPROC\n\
             PROC set5(INOUT num k)\nIF di1=1 k:=5;\nENDPROC"
        ));
        assert_eq!((module.certain, module.unclear_line), (1, Some(7)), "{write}");
    }
}

#[test]
fn variables_handed_over_come_back() {
    let module = inside(
        "CONST robtarget p:=[[0,0,0],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n\
         PROC main()\nVAR num n;\nFOR i FROM 1 TO 2 DO\nIncr n;\nraise5 n;\nENDFOR\nMoveL Offs(p,n,0,0),v5,fine,tool0;\nENDPROC\n\
         PROC raise5(INOUT num k)\nAdd k,5;\nENDPROC",
    );
    assert_clear(&module);
    assert_eq!(place(&module.program.moves[0]), [12_000, 0, 0]);
}

#[test]
fn the_first_procedure_that_no_other_calls_is_executed() {
    let text = "MODULE Paths\nPROC sub()\nENDPROC\nPROC Path_10()\nsub;\nENDPROC\nPROC Path_20()\nENDPROC\nENDMODULE";
    let module = read(text.as_bytes(), &Options::default()).unwrap();
    assert_eq!(module.program.procedure, "Path_10");
    let executed: Vec<_> = module.procedures.iter().map(|p| p.executed).collect();
    assert_eq!(executed, [true, true, false]);
    let asked = Options { procedure: Some("path_20"), ..Options::default() };
    assert_eq!(read(text.as_bytes(), &asked).unwrap().program.procedure, "Path_20");
    let asked = Options { procedure: Some("path_30"), ..Options::default() };
    let there = ["sub", "Path_10", "Path_20"].map(String::from).to_vec();
    assert_eq!(read(text.as_bytes(), &asked), Err(NoModule::Procedure { asked: "path_30".into(), there }));
}

#[test]
fn targets_are_listed_with_their_lines() {
    let module = inside(
        "CONST robtarget a:=[[1,2,3],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n\
         CONST robtarget b{2}:=[[[1,0,0],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],\n\
           [[2,0,0],[2,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]];",
    );
    let names: Vec<_> = module.targets.iter().map(|t| (t.line, t.name.as_str(), t.target.is_ok())).collect();
    assert_eq!(names, [(2, "a", true), (3, "b_1", true), (3, "b_2", false)]);
}
