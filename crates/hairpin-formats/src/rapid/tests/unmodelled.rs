//! Motion that no model here has: named, line by line, and nothing after its first line is certain.

use super::{FIRST, assert_clear, inside, main_of, unclear};
use crate::listing::{Class, Unmodelled};

const GO: &str = "MoveL p10,v5,fine,tool0;";

#[test]
fn every_kind_is_named_where_it_stands() {
    use Unmodelled::{
        Conveyors, Corrections, Displacements, ExternalAxes, ForceControl, Guidance, Interpolation, MultiMove, Payload,
        Processes, Restarts, Searches, SoftServos, Speeds, StandingTools, Triggers, WorldZones,
    };
    let at = |external: &str| format!("[[500,0,600],[1,0,0,0],[0,0,0,0],{external}]");
    let object = |robhold: &str, ufprog: &str, unit: &str| {
        format!("[{robhold},{ufprog},\"{unit}\",[[0,0,0],[1,0,0,0]],[[0,0,0],[1,0,0,0]]]")
    };
    for (body, kind, words) in [
        (format!("MoveL {},v5,fine,tool0;", at("[0,9E9,9E9,9E9,9E9,9E9]")), ExternalAxes, "eax_a = 0 in use"),
        (
            format!("MoveJ {},v5,fine,tool0;", at("[9E9,9E9,9E9,-3.5,9E9,12]")),
            ExternalAxes,
            "eax_d = -3.5, eax_f = 12 in use",
        ),
        ("MoveAbsJ [[0,0,0,0,30,0],[9E9,90,9E9,9E9,9E9,9E9]],v5,fine,tool0;".into(), ExternalAxes, "eax_b = 90"),
        (format!("MoveC p20,{},v5,fine,tool0;", at("[1,9E9,9E9,9E9,9E9,9E9]")), ExternalAxes, "eax_a = 1"),
        ("ActUnit STN1;".into(), ExternalAxes, "ActUnit"),
        ("DeactUnit STN1;".into(), ExternalAxes, "DeactUnit"),
        ("MoveExtJ home,vrot10,z50;".into(), ExternalAxes, "MoveExtJ"),
        ("EOffsSet [1,0,0,0,0,0];".into(), ExternalAxes, "EOffsSet"),
        ("IndAMove STN1,2\\ToAbsNum:=90,20;".into(), ExternalAxes, "IndAMove"),
        ("WaitWObj wobjcnv1\\RelDist:=0;".into(), Conveyors, "WaitWObj"),
        ("DropWObj wobjcnv1;".into(), Conveyors, "DropWObj"),
        ("SyncToSensor SSYNC1\\On;".into(), Conveyors, "SyncToSensor"),
        (
            format!("MoveL p10,v5,fine,tool0\\WObj:=w;!{}", object("FALSE", "FALSE", "CNV1")),
            Conveyors,
            "moves with `CNV1`",
        ),
        (format!("MoveL p10,v5,fine,tool0\\WObj:=w;!{}", object("TRUE", "TRUE", "")), StandingTools, "is held"),
        ("SyncMoveOn sync1,tasks;".into(), MultiMove, "SyncMoveOn"),
        ("SyncMoveOff sync1;".into(), MultiMove, "SyncMoveOff"),
        ("SyncMoveUndo;".into(), MultiMove, "SyncMoveUndo"),
        ("MoveL p10\\ID:=10,v5,fine,tool0;".into(), MultiMove, "\\id is not followed"),
        ("MoveL p10,v5,fine,tool0\\Corr;".into(), Corrections, "\\corr is not followed"),
        ("CorrCon id;".into(), Corrections, "CorrCon"),
        ("CorrWrite id,shift;".into(), Corrections, "CorrWrite"),
        ("SoftAct 3,20;".into(), SoftServos, "SoftAct"),
        ("FCAct tool0;".into(), ForceControl, "FCAct"),
        ("FCPressL p10,v5,20,fine,tool0;".into(), ForceControl, "FCPressL"),
        ("GripLoad piece;".into(), Payload, "GripLoad"),
        ("MoveL p10,v5,fine,tool0\\TLoad:=[3,[0,0,50],[1,0,0,0],0,0,0];".into(), Payload, "\\TLoad"),
        ("MechUnitLoad STN1,1,load0;".into(), Payload, "MechUnitLoad"),
        ("SetSysData tool0;".into(), Payload, "SetSysData"),
        ("WZLimSup\\Inside,zone,volume;".into(), WorldZones, "WZLimSup"),
        ("TriggL p10,v500,io1,fine,tool0;".into(), Triggers, "TriggL"),
        ("TriggJ p10,v500,io1,fine,tool0;".into(), Triggers, "TriggJ"),
        ("TriggSpeed t,100,0.1,ao1,0.5;".into(), Triggers, "TriggSpeed"),
        ("EGMRunPose id,EGM_STOP_HOLD;".into(), Guidance, "EGMRunPose"),
        ("SearchL di1,found,p10,v5,tool0;".into(), Searches, "SearchL"),
        ("PDispOn p10,tool0;".into(), Displacements, "PDispOn"),
        ("VelSet 50,800;".into(), Speeds, "velset"),
        ("SingArea\\Wrist;".into(), Interpolation, "singarea"),
        ("StopMove;".into(), Restarts, "StopMove"),
        ("ArcL p10,v5,seam,weld,fine,tool0;".into(), Processes, "ArcL"),
    ] {
        let declared = body.split_once('!').map_or(String::new(), |(_, object)| format!("VAR wobjdata w:={object};"));
        let module = main_of(&format!("{declared}\n{GO}\n{body}\n{GO}"));
        let (line, what) = unclear(&module);
        assert_eq!((line, module.certain), (FIRST + 2, 1), "{body}: {what}");
        assert!(what.contains(words), "{body}: {what}");
        assert_eq!(module.lines[&line].unmodelled, Some(kind), "{body}");
        assert!(module.whole().unwrap_err().contains(words), "{body}");
    }
}

#[test]
fn each_line_is_named_and_each_reason_of_a_line() {
    let module = main_of(&format!(
        "SoftAct 3,20;\n{GO}\nSoftDeact;\nMoveL [[1,0,0],[1,0,0,0],[0,0,0,0],[5,9E9,9E9,9E9,9E9,9E9]]\\ID:=10,v5,fine,tool0;\n{GO}"
    ));
    let named: Vec<_> =
        module.unclear().map(|(line, said)| (line - FIRST, said.unmodelled, said.what.as_str())).collect();
    assert_eq!(
        named,
        [
            (0, Some(Unmodelled::SoftServos), "SoftAct is not followed"),
            (2, Some(Unmodelled::SoftServos), "SoftDeact: servos get stiff again"),
            (3, Some(Unmodelled::ExternalAxes), "eax_a = 5 in use; \\id is not followed"),
        ]
    );
    assert_eq!((module.certain, module.program.moves.len()), (0, 3));
}

#[test]
fn loads_that_stay_change_nothing() {
    assert_clear(&main_of(&format!("GripLoad load0;\nIF di1=1 GripLoad load0;\n{GO}")));
    let none = "CONST loaddata none:=[0.001,[0,0,0.001],[1,0,0,0],0,0,0];";
    let tool = "PERS tooldata t:=[TRUE,[[0,0,100],[1,0,0,0]],[1,[0,0,50],[1,0,0,0],0,0,0]];";
    let all = |body: &str| {
        inside(&format!(
            "{none}\n{tool}\nCONST robtarget p10:=[[500,0,600],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\nPROC main()\n{body}\nENDPROC"
        ))
    };
    // What is set before the tool moves, and what its frame becomes, is no change of a load.
    assert_clear(&all(
        "GripLoad none;\nt.tload.mass:=2;\nMoveL p10,v5,fine,t\\TLoad:=load0;\nt.tframe.trans.z:=90;\nMoveL p10,v5,fine,t;",
    ));
    for change in ["t.tload.mass:=2;", "t.tload:=none;", "t:=tool0;", "t.tload:=measured();"] {
        let module = all(&format!("MoveL p10,v5,fine,t;\n{change}\nMoveL p10,v5,fine,tool0;"));
        let (line, what) = unclear(&module);
        assert_eq!((line, module.lines[&line].unmodelled), (7, Some(Unmodelled::Payload)), "{change}: {what}");
        assert!(what.contains("load of tool `t` changes"), "{what}");
    }
    let put_down = all("GripLoad [1,[0,0,5],[1,0,0,0],0,0,0];\nGripLoad load0;");
    assert_eq!(put_down.unclear().map(|(line, _)| line).collect::<Vec<_>>(), [6, 7]);
}

/// The program is ahead of the arm when the procedure of a corner comes.
#[test]
fn what_procedures_of_corners_do_is_not_known() {
    let with = |call: &str, corner: &str| {
        inside(&format!(
            "CONST robtarget p10:=[[500,0,600],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\nVAR num n:=1;\n\
             PROC main()\n{GO}\n{call}\nMoveL Offs(p10,n,0,0),v5,fine,tool0;\nENDPROC\nPROC corner()\n{corner}\nENDPROC"
        ))
    };
    let calls = [
        "MoveLSync p10,v5,z10,tool0,\"corner\";",
        "MoveJSync p10,v5,z10,tool0\\WObj:=wobj0,\"CORNER\";",
        "MoveCSync Offs(p10,9,9,0),Offs(p10,20,0,0),v5,z10,tool0,\"M:corner\";",
    ];
    for call in calls {
        let said = with(call, "TPWrite \"here\";");
        assert_clear(&said);
        assert_eq!(said.program.moves.len(), 3, "{call}");
        let assigned = with(call, "n:=3000;");
        assert_eq!((assigned.certain, assigned.unclear_line), (2, Some(7)), "{call}");
        for corner in ["StopMove;", GO, "IF di1=1 EXIT;", "away;"] {
            let module = with(call, corner);
            let (line, what) = unclear(&module);
            assert_eq!((line, module.certain), (6, 1), "{call} {corner}: {what}");
            assert_eq!(module.lines[&6].unmodelled, Some(Unmodelled::Triggers), "{corner}");
        }
    }
    for (call, words) in [
        ("MoveLSync p10,v5,z10,tool0,\"gone\";", "`gone` is not in this file"),
        ("MoveLSync p10,v5,z10,tool0,which;", "which procedure it calls is not known"),
        ("MoveLSync p10,v5,z10,tool0;", "which procedure it calls is not known"),
    ] {
        let module = with(call, "");
        assert!(unclear(&module).1.contains(words), "{call}: {}", unclear(&module).1);
    }
}

#[test]
fn interrupts_that_move_the_arm_are_named() {
    let with = |trap: &str, after: &str| {
        inside(&format!(
            "CONST robtarget p10:=[[500,0,600],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\nVAR num n:=0;\n\
             PROC main()\nCONNECT i1 WITH t1;\nISignalDI di1,1,i1;\n{after}\nENDPROC\nTRAP t1\n{trap}\nENDTRAP"
        ))
    };
    for trap in ["StopMove;", "MoveL p10,v5,fine,tool0;", "IF di2=1 StorePath;", "away;"] {
        let module = with(trap, GO);
        let (line, what) = unclear(&module);
        assert_eq!((line, module.certain), (5, 0), "{trap}: {what}");
        assert_eq!(module.lines[&5].unmodelled, Some(Unmodelled::Interrupts), "{trap}");
    }
    let counted = with("Incr n;", GO);
    assert_clear(&counted);
    assert_eq!(counted.class(5), Class::Harmless);
    // What an interrupt counts is not known, whenever it is looked at.
    let used = with("Incr n;", "n:=3;\nMoveL Offs(p10,n,0,0),v5,fine,tool0;");
    assert_eq!(used.unclear_line, Some(8));
    let elsewhere = main_of("CONNECT i1 WITH tElsewhere;");
    assert!(unclear(&elsewhere).1.contains("`tElsewhere` is not in this file"));
}
