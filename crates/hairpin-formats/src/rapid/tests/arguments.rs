//! What is handed to instructions and functions: what is called in it is followed, what comes back is not known.

use super::{assert_clear, inside, place};
use crate::listing::Module;

/// Line of the body's first line.
const BODY: usize = 6;

/// A `main` of the body, a step if `b` holds, and a move to `n` mm; once.
fn of(body: &str) -> Module {
    inside(&format!(
        "CONST robtarget p:=[[0,0,0],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\nVAR num n:=1;\nVAR bool b;\n\
         PROC main()\n{body}\nIF b n:=5;\nMoveL Offs(p,n,0,0),v5,fine,tool0; EXIT;\nENDPROC\n\
         FUNC num count()\nn:=n+1;\nRETURN n;\nENDFUNC\n\
         FUNC bool ready()\nn:=n+1;\nRETURN di1=1;\nENDFUNC\n\
         FUNC num far()\nMoveL Offs(p,4000,0,0),v5,fine,tool0;\nRETURN 1;\nENDFUNC\n\
         FUNC bool gone()\nMoveL Offs(p,4000,0,0),v5,fine,tool0;\nRETURN di1=1;\nENDFUNC\n\
         FUNC bool went()\nMoveL Offs(p,4000,0,0),v5,fine,tool0;\nRETURN TRUE;\nENDFUNC\n\
         PROC said(\\num by)\nTPWrite \"said\";\nENDPROC\n\
         PROC waits(\\INOUT bool flag)\nWaitDI di1,1\\MaxTime:=2\\TimeFlag?flag;\nENDPROC\n\
         PROC grip(VAR signaldo out)\nSet out;\nENDPROC\n\
         PROC carry(PERS tooldata t, PERS wobjdata w)\nTPWrite \"carried\";\nENDPROC"
    ))
}

#[test]
fn functions_that_are_called_in_them_are_followed() {
    for body in [
        "WaitTime count();",
        "WaitDI di1,count();",
        "SetDO do1,count();",
        "SetDO\\SDelay:=count(),do1,1;",
        "SetAO ao1,2*count();",
        "PulseDO\\PLength:=count(),do1;",
        "ISignalDI\\Single,di1,count(),i1;",
        "Write f,\"x\"\\Num:=count();",
        "ErrWrite \"x\",ValToStr(count());",
        "TPWrite NumToStr(count(),0);",
        "TPWrite \"x\"\\Pos:=[1,-count(),3];",
        "TPReadNum reg1,\"x\"+ValToStr(count());",
        "MoveLDO p,v5,fine,tool0,do1,count();",
        "MoveL p,v5,fine\\Inpos:=count(),tool0;",
        "reg1:=ReadNum(f\\Time:=count());",
        "%\"said\"%\\by:=count();",
    ] {
        let module = of(body);
        assert_clear(&module);
        assert_eq!(module.program.moves.last().map(place), Some([2_000, 0, 0]), "{body}");
    }
    let added = of("Add n,count();");
    assert_clear(&added);
    assert_eq!(place(&added.program.moves[0]), [4_000, 0, 0]);
    for body in [
        "WaitUntil went();",
        "SetDO do1,far();",
        "TPWrite \"x\"\\Num:=far();",
        "MoveLDO p,v5,fine,tool0,do1,far();",
        "%\"said\"%\\by:=far();",
    ] {
        let module = of(body);
        assert_clear(&module);
        assert_eq!(place(&module.program.moves[0]), [4_000_000, 0, 0], "{body}");
    }
}

/// What is evaluated until it holds, or perhaps, may do its part any number of times.
#[test]
fn how_often_they_are_called_may_depend_on_the_cell() {
    for (body, line, certain) in [
        ("WaitUntil ready();", BODY + 2, 0),
        ("WaitUntil\\InPos,ready()\\MaxTime:=2;", BODY + 2, 0),
        ("WHILE ready() DO ENDWHILE", BODY + 2, 0),
        ("IF di1=1 THEN Stop; ELSEIF ready() THEN Stop; ENDIF", BODY + 2, 0),
        ("IF di1=1 TPWrite \"x\"\\Num:=count();", BODY + 2, 0),
        ("WaitUntil gone();", BODY, 1),
        ("WHILE gone() DO ENDWHILE", BODY, 1),
        ("IF di1=1 THEN Stop; ELSEIF gone() THEN Stop; ENDIF", BODY, 0),
        ("IF di1=1 WaitTime far();", BODY, 0),
    ] {
        let module = of(body);
        assert_eq!((module.unclear_line, module.certain), (Some(line), certain), "{body}: {:?}", module.lines);
    }
}

#[test]
fn what_comes_back_is_not_known() {
    for body in [
        "WaitDI di1,1\\MaxTime:=2\\TimeFlag:=b;",
        "WaitDO do1,1\\MaxTime:=2\\TimeFlag:=b;",
        "WaitUntil di1=1\\MaxTime:=2\\TimeFlag:=b;",
        "WaitAI ai1\\GT,5\\MaxTime:=2\\ValueAtTimeout:=n;",
        "WaitAO ao1\\GT,5\\MaxTime:=2\\ValueAtTimeout:=n;",
        "WaitGI gi1,5\\MaxTime:=2\\ValueAtTimeout:=n;",
        "WaitGO go1,5\\MaxTime:=2\\ValueAtTimeout:=n;",
        "UIMsgBox \"x\"\\Result:=n;",
        "UIShow \"a\",\"b\"\\Status:=n;",
        "SocketAccept s1,s2\\ClientAddress:=n;",
        "WaitTestAndSet b;",
        "BookErrNo n;",
        "IF di1=1 WaitTestAndSet b;",
        "IF di1=1 WaitDI di1,1\\MaxTime:=2\\TimeFlag:=b;",
        "waits\\flag:=b;",
        "IVarValue \"s1:\",1,n,i1;",
        "IF StrToVal(\"4\",n) TPWrite \"x\";",
        "IF di1=1 AND StrToVal(\"4\",n) TPWrite \"x\";",
        "IF di1=1 THEN Stop; ELSEIF StrToVal(\"4\",n) THEN Stop; ENDIF",
        "IF TestAndSet(b) TPWrite \"x\";",
        "reg1:=elsewhere(n);",
        "TPWrite NumToStr(UINumEntry(\\MaxTime:=2\\BreakFlag:=n),0);",
        "IF di1=1 TPWrite NumToStr(UINumEntry(\\MaxTime:=2\\BreakFlag:=n),0);",
    ] {
        let module = of(body);
        assert_eq!((module.unclear_line, module.certain), (Some(BODY + 2), 0), "{body}: {:?}", module.lines);
    }
    // A sensor writes whenever it likes.
    let module = of("IVarValue \"s1:\",1,n,i1;\nn:=3;");
    assert_eq!((module.unclear_line, module.certain), (Some(BODY + 3), 0));
}

#[test]
fn what_is_looked_at_stays_known() {
    for body in [
        "WaitTime n;",
        "SetAO ao1,n;",
        "WaitDI di1,1\\MaxTime:=n;",
        "WaitUntil di1=n;",
        "IPers n,i1;",
        "TPWrite \"x\"\\Num:=n;",
        "TPWrite NumToStr(n,0)+ValToStr(n);",
        "IF di1=1 TPWrite NumToStr(n,0);",
        "reg1:=StrLen(ValToStr(n));",
        "reg1:=ReadNum(f\\Time:=n);",
        "reg1:=elsewhere(p);",
        "IF di1=1 reg1:=elsewhere(p);",
        "waits;",
        "grip do1;",
        "carry tool0,wobj0;",
    ] {
        let module = of(body);
        assert_clear(&module);
        assert_eq!(place(&module.program.moves[0]), [1_000, 0, 0], "{body}");
    }
}

/// What no instruction takes, or takes once, is not left aside.
#[test]
fn arguments_beyond_those_of_a_move_are_not_understood() {
    for (body, words) in [
        ("MoveL p,v5,fine,tool0,wobj0;", "takes 4 arguments without a backslash at most, found 5"),
        ("MoveLDO p,v5,fine,tool0,do1,1,2;", "takes 6 arguments"),
        ("MoveL p,v5\\V:=10\\V:=900,fine,tool0;", "\\v is given twice"),
        ("said\\by:=1\\by:=2;", "is given twice"),
        ("said\\far:=1;", "has no `\\far`"),
    ] {
        let module = of(body);
        assert_eq!((module.unclear_line, module.certain), (Some(BODY), 0), "{body}: {:?}", module.lines);
        assert!(module.lines[&BODY].what.contains(words), "{body}: {:?}", module.lines[&BODY]);
    }
}
