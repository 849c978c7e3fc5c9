//! Programs: RAPID, program files, KRL, URScript.

use hairpin_formats::listing::{File, Module};
use hairpin_formats::{krl, rapid, urscript};

use super::{Answer, Sample};

/// Moves, tools and frames, without the lines that they stand on.
fn said(module: Module) -> Answer {
    if module.unclear_line.is_some() {
        return Answer::Open;
    }
    let mut program = module.program;
    program.moves.iter_mut().for_each(|m| m.line = None);
    Answer::Read(format!("{program:?}"))
}

fn of_rapid(text: &str) -> Answer {
    match rapid::read(text.as_bytes(), &rapid::Options::default()) {
        Ok(module) => said(module),
        Err(error) => Answer::Refused(error.to_string()),
    }
}

fn of_krl(text: &str) -> Answer {
    match krl::read(File { name: "m.src", bytes: text.as_bytes() }, None) {
        Ok(module) => said(module),
        Err(error) => Answer::Refused(error.to_string()),
    }
}

fn of_urscript(text: &str) -> Answer {
    match urscript::read(File { name: "m.script", bytes: text.as_bytes() }) {
        Ok(module) => said(module),
        Err(error) => Answer::Refused(error.to_string()),
    }
}

fn of_program_file(text: &str) -> Answer {
    match rapid::modules_of(text.as_bytes()) {
        Ok(names) => Answer::Read(names.join(" ")),
        Err(error) => Answer::Refused(error.to_string()),
    }
}

/// A module whose `main` has `body` between two moves.
fn module(body: &str) -> String {
    format!(
        "MODULE M\nCONST robtarget p:=[[400,0,300],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n\
         PERS tooldata t:=[TRUE,[[0,0,100],[1,0,0,0]],[1,[0,0,50],[1,0,0,0],0,0,0]];\nPROC main()\n\
         MoveJ p,v100,fine,t;\n{body}\nMoveL Offs(p,0,0,50),v100,z10,t;\nENDPROC\n\
         TRAP moves\nStopMove;\nENDTRAP\nENDMODULE\n"
    )
}

fn rapid_row(row: &'static str, body: &str) -> Sample {
    Sample { row, read: of_rapid, without: module(""), with: module(body) }
}

fn src(body: &str) -> String {
    format!(
        "DEF m ( )\n$TOOL={{X 0,Y 0,Z 100,A 0,B 0,C 0}}\n$BASE={{X 0,Y 0,Z 0,A 0,B 0,C 0}}\n$VEL.CP=0.2\n\
         PTP {{A1 0,A2 -90,A3 90,A4 0,A5 30,A6 0}}\n{body}\nLIN {{X 400,Y 0,Z 300,A 0,B 90,C 0}}\nEND\n"
    )
}

fn krl_row(row: &'static str, body: &str) -> Sample {
    Sample { row, read: of_krl, without: src(""), with: src(body) }
}

fn script(body: &str) -> String {
    format!(
        "def m():\n  set_tcp(p[0,0,0.1,0,0,0])\n  movej([0,-1.5,1.5,0,1.5,0], a=1, v=1, r=0)\n  {body}\n  \
         movel(p[0.4,0,0.3,0,3.1,0], a=1.2, v=0.2, r=0)\nend\nm()\n"
    )
}

fn urscript_row(row: &'static str, body: &str) -> Sample {
    Sample { row, read: of_urscript, without: script(""), with: script(body) }
}

fn program_file(inside: &str) -> String {
    format!("<?xml version=\"1.0\"?>\n<Program>\n<Module>a.mod</Module>\n{inside}\n</Program>\n")
}

fn program_file_row(row: &'static str, inside: &str) -> Sample {
    Sample { row, read: of_program_file, without: program_file(""), with: program_file(inside) }
}

pub(crate) fn samples() -> Vec<Sample> {
    vec![
        rapid_row("rapid.moves", "MoveC Offs(p,20,20,0),Offs(p,40,0,0),v100,z5,t;"),
        rapid_row("rapid.flow", "FOR i FROM 1 TO 3 DO\nMoveL Offs(p,i,0,0),v100,z1,t;\nENDFOR"),
        rapid_row("rapid.predefined", "MoveL p,v50,z0,tool0\\WObj:=wobj0;"),
        rapid_row("rapid.configuration", "ConfL\\Off;"),
        rapid_row("rapid.outputs", "SetDO do1,1;\nWaitTime 0.5;\nTPWrite \"x\";"),
        rapid_row("rapid.conditions", "IF di1=1 THEN\nSetDO do1,1;\nENDIF"),
        rapid_row("rapid.conditional-moves", "IF di1=1 THEN\nMoveL p,v5,fine,t;\nENDIF"),
        rapid_row("rapid.handlers", "ErrRaise \"E\",1,\"a\",\"b\",\"c\",\"d\",\"e\";"),
        rapid_row("rapid.moving-handlers", "ERROR\nMoveL p,v5,fine,t;\nRETRY;"),
        rapid_row("rapid.unknown", "Weld 3;"),
        rapid_row("rapid.external-axes", "MoveL [[400,0,300],[0,0,1,0],[0,0,0,0],[0,9E9,9E9,9E9,9E9,9E9]],v5,fine,t;"),
        rapid_row("rapid.conveyors", "WaitWObj wcnv1;"),
        rapid_row("rapid.multimove", "SyncMoveOn s1,all;"),
        rapid_row("rapid.corrections", "MoveL p,v5,fine,t\\Corr;"),
        rapid_row("rapid.soft-servos", "SoftAct 1,50;"),
        rapid_row("rapid.force-control", "FCAct t;"),
        rapid_row("rapid.payload", "GripLoad piece;"),
        rapid_row("rapid.no-payload", "GripLoad load0;"),
        rapid_row("rapid.world-zones", "WZLimSup\\Inside,z1,v1;"),
        rapid_row("rapid.triggers", "TriggL p,v5,t1,fine,t;"),
        rapid_row("rapid.speeds", "VelSet 50,800;"),
        rapid_row("rapid.interrupts", "CONNECT i1 WITH moves;"),
        rapid_row("rapid.broken", "MoveL p,,fine t;"),
        Sample { row: "rapid.no-module", read: of_rapid, without: module(""), with: "PROC main()\nENDPROC\n".into() },
        program_file_row("pgf.modules", "<Module>b.sys</Module>"),
        program_file_row("pgf.other", "<Comment>x</Comment>"),
        program_file_row("pgf.outside", "<Module>../b.sys</Module>"),
        krl_row("krl.moves", "LIN {X 400,Y 20,Z 300,A 0,B 90,C 0}"),
        krl_row("krl.frames", "$BASE={X 10,Y 0,Z 0,A 0,B 0,C 0}"),
        krl_row("krl.outputs", "$OUT[1]=TRUE\nWAIT SEC 1"),
        krl_row("krl.folds", ";FOLD LIN P1 Vel=2 m/s;%{PE}"),
        krl_row("krl.external-axes", "LIN {X 400,Y 20,Z 300,A 0,B 90,C 0,E1 5}"),
        krl_row("krl.status", "PTP {X 400,Y 0,Z 300,A 0,B 90,C 0,S 2,T 10}"),
        krl_row("krl.load", "$LOAD={M 3}"),
        krl_row("krl.flow", "IF $IN[1] THEN"),
        Sample { row: "krl.no-program", read: of_krl, without: src(""), with: "PTP HOME\n".into() },
        urscript_row("urscript.moves", "movel(p[0.4,0.02,0.3,0,3.1,0], a=1.2, v=0.2, r=0.01)"),
        urscript_row("urscript.outputs", "set_digital_out(1, True)"),
        urscript_row("urscript.payload", "set_payload(3.0)"),
        urscript_row(
            "urscript.force-control",
            "force_mode(p[0,0,0,0,0,0], [0,0,1,0,0,0], [0,0,9,0,0,0], 2, [1,1,1,1,1,1])",
        ),
        urscript_row("urscript.conveyors", "track_conveyor_linear(p[1,0,0,0,0,0], 500)"),
        urscript_row("urscript.flow", "if digital_in(1):"),
        Sample { row: "urscript.no-program", read: of_urscript, without: script(""), with: "movej([0])\n".into() },
    ]
}
