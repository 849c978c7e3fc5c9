//! What is no program: nothing panics, nothing takes for ever, and mistakes have their places.

use proptest::prelude::*;

use super::super::{NoModule, Options, read};
use super::{FIRST, inside, main_of};
use crate::listing::Class;

#[test]
fn only_a_file_without_a_module_is_refused() {
    for bytes in [&b""[..], b"hello", b"\xff\xfe\x00\x01", b"MODULE", b"! MODULE M\n", b"\"MODULE M\"", b"x,y\n1,2\n"] {
        assert_eq!(read(bytes, &Options::default()), Err(NoModule::Absent), "{bytes:?}");
    }
    for text in ["MODULE M", "MODULE M\n???\nENDMODULE", "MODULE M(", "module m\nendmodule", "MODULE M PROC"] {
        assert_eq!(read(text.as_bytes(), &Options::default()).unwrap().program.moves, []);
    }
}

#[test]
fn mistakes_have_line_and_column() {
    let module = main_of("MoveL p10, v5, fine, tool0;\n  MoveL p10, , fine tool0;\nMoveL p20, v5, fine, tool0;");
    let found = &module.mistakes[0];
    assert_eq!((found.at.line, found.at.column), (FIRST + 1, 14), "{found:?}");
    assert_eq!(found.what, "expected a value, found `,`");
    assert_eq!((module.program.moves.len(), module.certain), (2, 1));
    assert_eq!(module.class(FIRST + 1), Class::ChangesMotion);
    let module = inside("CONST robtarget p := [[1,2],[1,0,0,0],[0,0,0,0],[0,0,0,0,0,0]];");
    assert_eq!(module.lines[&2].what, "`p` has 2 components, a pos has 3");
}

#[test]
fn broken_blocks_cost_themselves_only() {
    let module = inside(
        "PROC first()\nIF TRUE THEN\nWaitTime 1;\nENDPROC\n\
         PROC main()\nMoveAbsJ [[0,0,0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v5,fine,tool0;\nENDPROC",
    );
    assert_eq!(module.mistakes[0].what, "expected ENDIF, found `ENDPROC`");
    assert_eq!((module.program.moves.len(), module.certain), (1, 1));
}

/// A file that is cut short, or has more than modules in it, is loaded by no controller; the moves that are there stay.
#[test]
fn what_is_cut_short_is_not_understood() {
    let head = "MODULE M\nPROC main()\nMoveAbsJ [[0,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v5,fine,tool0;\n";
    for (rest, line) in [
        ("", 4),
        ("ENDPROC\n", 5),
        ("!ENDPROC\n!ENDMODULE\n", 6),
        ("!ENDPROC\nENDMODULE\n", 5),
        ("ENDPROC\nCONST robtarget p:=[[1,2", 5),
        ("ENDPROC\nPROC other()\nTPWrite \"a\";\n", 7),
        ("ENDPROC\nPROC other()\nIF di1=1 THEN\n", 7),
        ("ENDPROC\nVAR num n:=;\nENDMODULE\n", 5),
        ("ENDPROC\nENDMODULE\nMoveL p10,v5,fine,tool0;\n", 6),
    ] {
        let module = read(format!("{head}{rest}").as_bytes(), &Options::default()).unwrap();
        assert_eq!((module.program.moves.len(), module.certain), (1, 1), "{rest}");
        assert_eq!((module.unclear_line, module.class(line)), (Some(line), Class::ChangesMotion), "{rest}");
        assert!(module.mistakes.iter().any(|found| found.what == module.lines[&line].what), "{rest}");
    }
    for rest in ["ENDPROC\nENDMODULE", "ENDPROC\nENDMODULE\n! end\n\n%%%\nVERSION:1\n%%%\nMODULE N\nENDMODULE\u{1a}"] {
        let module = read(format!("{head}{rest}").as_bytes(), &Options::default()).unwrap();
        super::assert_clear(&module);
    }
}

/// A controller stops at an index that no element has.
#[test]
fn elements_that_are_not_there_are_told() {
    let go = "MoveAbsJ [[0,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v5,fine,tool0;";
    for (body, index, bound) in [
        ("a{4}:=9;", 4, 3),
        ("a{n}:=9;", 0, 3),
        ("n:=a{4};", 4, 3),
        ("IF a{4}=1 TPWrite \"x\";", 4, 3),
        ("b{2,3}:=1;", 3, 2),
        ("n:=b{3,1};", 3, 2),
    ] {
        let module = inside(&format!(
            "VAR num a{{3}}:=[1,2,3];\nVAR num b{{2,2}};\nPROC main()\nVAR num n:=0;\n{go}\n{body}\n{go}\nENDPROC"
        ));
        assert_eq!((module.unclear_line, module.certain), (Some(7), 1), "{body}");
        let what = &module.lines[&7].what;
        assert!(what.ends_with(&format!("has the index {index}: must be from 1 to {bound}")), "{what}");
    }
    let guarded = "FOR n FROM 1 TO 4 DO\nIF n<=3 AND a{n}>0 a{n}:=0;\nENDFOR";
    super::assert_clear(&inside(&format!("VAR num a{{3}}:=[1,2,3];\nPROC main()\n{guarded}\n{go}\nENDPROC")));
}

/// So does it at what cannot be computed or assigned, and what is raised goes on elsewhere.
#[test]
fn what_stops_a_controller_is_told() {
    let go = "MoveAbsJ [[0,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v5,fine,tool0;";
    let of = |body: &str| {
        inside(&format!("VAR num n:=0; CONST num c{{2}}:=[1,2];\nPROC main()\n{go}\n{body}\n{go}\nENDPROC"))
    };
    for (body, words) in [
        ("n:=1/0;", "`/` by zero stops a controller"),
        ("n:=5 DIV n;", "`DIV` by zero stops a controller"),
        ("n:=5 MOD (n*3);", "`MOD` by zero stops a controller"),
        ("zz:=4;", "`zz` is not declared in this file"),
        ("n:=\"abc\";", "the value for `n` "),
        ("c{1}:=3;", "`c` is CONST, and is not assigned to"),
        ("Incr c{1};", "`c` is CONST, and is not assigned to"),
        ("FOR n FROM 1 TO 2 DO n:=2; ENDFOR", "`n` counts a loop, and is not assigned to"),
        ("RAISE 5;", "RAISE goes on in an error handler, and none is followed"),
    ] {
        let module = of(body);
        assert_eq!((module.unclear_line, module.certain), (Some(5), 1), "{body}: {:?}", module.lines[&5]);
        assert!(module.lines[&5].what.contains(words), "{body}: {:?}", module.lines[&5]);
    }
    let gives = |body: &str| {
        let module = inside(&format!(
            "CONST num c:=1;\nPROC give(INOUT num x)\nENDPROC\nPROC main()\nVAR num n:=0;\n{go}\n{body}\n{go}\nENDPROC"
        ));
        module.unclear().map(|(_, line)| line.what.clone()).collect::<Vec<_>>()
    };
    assert_eq!(gives("give c;"), ["`x` of `give` gives back, and `c` is CONST"]);
    assert_eq!(gives("give 4;"), ["`x` of `give` gives back, and is no data"]);
    assert_eq!(gives("give gone;"), ["`x` of `give` gives back, and `gone` is not declared in this file"]);
    assert!(gives("give n;").is_empty());
    for body in ["reg1:=4;", "IF n>0 AND 1/n>1 n:=2;", "n:=0/5;", "IF n>0 RAISE 5;", "n:=n;", "n:=c{2};"] {
        super::assert_clear(&of(body));
    }
}

/// Each would take years, or more memory than there is, if it were followed.
#[test]
fn nothing_takes_for_ever_or_too_much() {
    let deep = |open: &str, close: &str, n: usize| format!("{}{}", open.repeat(n), close.repeat(n));
    let bodies = [
        "FOR i FROM 1 TO 1E9 DO\nMoveL p10,v5,fine,tool0;\nENDFOR".to_owned(),
        "FOR i FROM 1 TO 1E9 DO\nFOR j FROM 1 TO 1E9 DO\nENDFOR\nENDFOR".to_owned(),
        "FOR i FROM 1 TO 2 STEP 1E-300 DO\nWaitTime 1;\nENDFOR".to_owned(),
        "main;\nmain;".to_owned(),
        "WHILE 1<2 DO\nIF FALSE RETURN;\nENDWHILE".to_owned(),
        format!("reg1 := {};", deep("(", ")", 100_000)),
        format!("reg1 := {}1;", "-".repeat(100_000)),
        format!("reg1 := 1{};", "+1".repeat(100_000)),
        format!("reg1 := {};", deep("[", "]", 100_000)),
        deep("IF TRUE THEN\n", "ENDIF\n", 10_000),
        deep("IF di1=1 THEN\n", "ENDIF\n", 50),
        "IF TRUE ".repeat(10_000),
    ];
    for body in bodies {
        let module = main_of(&body);
        assert!(module.program.moves.len() <= 100_000);
    }
    let mut chain = String::from("PROC main()\nIF di1=1 q0;\nENDPROC\n");
    for i in 0..20_000 {
        chain.push_str(&format!("PROC q{i}()\nq{};\nENDPROC\n", i + 1));
    }
    assert_eq!(inside(&chain).unclear_line, Some(3), "how far it goes is not looked at");
    inside("FUNC num f(num x)\nRETURN -(-(-(-(-(-(f(x)))))));\nENDFUNC\nPROC main()\nreg1:=f(1);\nENDPROC");
    let huge = inside(
        "VAR num a{1000,1000,1000};\nVAR robtarget b{1E300};\nVAR num c{400000};\n\
         PROC main()\nVAR num d{400000};\nWHILE di1=0 DO\nENDWHILE\nFOR i FROM 1 TO 1000000 DO\nc:=d;\nd:=c;\nENDFOR\nENDPROC",
    );
    assert!(huge.lines[&2].what.contains("too large") && huge.lines[&3].what.contains("extent"));
}

#[test]
fn endless_programs_are_followed_once_round() {
    let module = main_of(
        "WHILE TRUE DO\nMoveL p10,v5,fine,tool0;\nMoveL p20,v5,fine,tool0;\nENDWHILE\nMoveL p10,v5,fine,tool0;",
    );
    assert_eq!((module.program.moves.len(), module.certain), (2, 2));
    assert!(module.lines[&FIRST].what.contains("one round"));
    assert_eq!(module.class(FIRST + 4), Class::Unreached);
    let counted = main_of("WHILE TRUE DO\nMoveL p10,v5,fine,tool0;\nIncr reg1;\nIF reg1>3 RETURN;\nENDWHILE");
    assert_eq!(counted.certain, 1, "reg1 is the controller's: {:?}", counted.lines);
    let counted = main_of("reg1:=0;\nWHILE TRUE DO\nMoveL p10,v5,fine,tool0;\nIncr reg1;\nIF reg1>3 RETURN;\nENDWHILE");
    assert_eq!((counted.certain, counted.unclear_line), (4, None));
}

#[test]
fn a_loop_that_comes_back_to_where_it_was_is_seen_at_once() {
    let moves = "MoveL p10,v5,fine,tool0;\nMoveL p20,v5,fine,tool0;";
    // Neither condition nor way out is constant, and nothing changes either.
    for (head, way_out) in [("WHILE TRUE DO", "IF done EXIT;"), ("WHILE NOT done DO", "WaitTime 1;")] {
        let module = main_of(&format!("VAR bool done:=FALSE;\n{head}\n{moves}\n{way_out}\nENDWHILE\n{moves}"));
        assert_eq!((module.program.moves.len(), module.certain, module.unclear_line), (2, 2, None), "{head}");
        assert!(module.lines[&(FIRST + 1)].what.contains("one round is followed"), "{:?}", module.lines);
        assert_eq!(module.class(FIRST + 6), Class::Unreached);
    }
    // The first round is another one.
    let module = main_of(&format!(
        "VAR bool first:=TRUE;\nWHILE TRUE DO\nIF first MoveL p20,v5,fine,tool0;\nfirst:=FALSE;\n{moves}\n\
         IF first RETURN;\nENDWHILE"
    ));
    assert_eq!((module.program.moves.len(), module.unclear_line), (5, None), "{:?}", module.lines);
    assert!(module.lines[&(FIRST + 1)].what.contains("2 rounds are followed"), "{:?}", module.lines);
    // What is only counted and told decides nothing.
    let counted = main_of(&format!(
        "VAR num parts:=0;\nWHILE TRUE DO\n{moves}\nIncr parts;\nTPWrite \"parts\"\\Num:=parts;\nENDWHILE"
    ));
    assert_eq!((counted.program.moves.len(), counted.unclear_line), (2, None), "{:?}", counted.lines);
    // Every third round is another one.
    let third = main_of(&format!(
        "VAR num n:=0;\nWHILE TRUE DO\n{moves}\nn:=n+1;\nIF n=3 THEN\nMoveL p10,v5,fine,tool0;\nn:=0;\nENDIF\nENDWHILE"
    ));
    let all = third.program.moves.len();
    assert!((7..=21).contains(&all) && third.unclear_line.is_none(), "{all} {:?}", third.lines);
    // A place that goes on is never the same, whatever the condition.
    for head in ["WHILE TRUE DO", "WHILE 1=1 DO"] {
        let on = main_of(&format!("VAR num n:=0;\n{head}\nMoveL Offs(p10,0,n,0),v5,fine,tool0;\nn:=n+400;\nENDWHILE"));
        assert!(on.program.moves.len() > 3 && on.unclear_line.is_some(), "{head}: {:?}", on.program.moves.len());
    }
    // A flag that the first round sets lets the second one move.
    let later = main_of("VAR bool b:=FALSE;\nWHILE TRUE DO\nIF b MoveL p20,v5,fine,tool0;\nb:=TRUE;\nENDWHILE");
    assert_eq!((later.program.moves.len(), later.unclear_line), (1, None), "{:?}", later.lines);
    // What counts on never comes back: the bound is told where it was met.
    let module = inside("VAR num n:=0;\nPROC main()\nWHILE n>=0 DO\nn:=n+1;\nENDWHILE\nENDPROC");
    let (line, told) = (module.unclear_line.unwrap(), "more than 1000000 steps until here");
    assert!((4..=5).contains(&line) && module.lines[&line].what.contains(told), "{:?}", module.lines);
}

/// In continuous mode `main` begins again where it ends, and its modules keep their data.
#[test]
fn cycles_of_main_are_rounds() {
    let moves = "MoveL p10,v5,fine,tool0;\nMoveL p20,v5,fine,tool0;";
    let cycles = |data: &str, body: &str| {
        inside(&format!(
            "CONST robtarget p10:=[[500,0,600],[0.707107,0,0.707107,0],[0,-1,0,1],[9E9,9E9,9E9,9E9,9E9,9E9]];\n\
             CONST robtarget p20:=[[400,-200,500],[0,0,1,0],[-1,0,-1,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n\
             PERS tooldata grip:=[TRUE,[[0,0,100],[1,0,0,0]],[1,[0,0,1],[1,0,0,0],0,0,0]];\n\
             {data}\nPROC main()\n{body}\nENDPROC"
        ))
    };
    // What moves in the second cycle alone.
    let first = cycles(
        "VAR bool first:=TRUE;",
        "IF first THEN\nMoveL p10,v5,fine,tool0;\nfirst:=FALSE;\nELSE\nMoveL p20,v5,fine,tool0;\nENDIF",
    );
    assert_eq!((first.program.moves.len(), first.certain, first.unclear_line), (2, 2, None), "{:?}", first.lines);
    assert!(first.lines[&6].what.contains("2 cycles are followed"), "{:?}", first.lines[&6]);
    let kept = cycles("PERS num n:=0;", "MoveL p10,v5,fine,tool0;\nIF n=1 MoveL p20,v5,fine,tool0;\nn:=1;");
    assert_eq!((kept.program.moves.len(), kept.unclear_line), (3, None), "{:?}", kept.lines);
    // What goes on and on is told where the bound is met.
    let on = cycles("VAR num n:=0;", "MoveL Offs(p10,0,n,0),v5,fine,tool0;\nn:=n+400;");
    assert!(on.program.moves.len() > 3 && on.unclear_line.is_some(), "{}", on.program.moves.len());
    // Most begin again as they began, whatever they say and carry, or as they began their second cycle.
    for (data, head) in [
        ("", "ConfL\\Off;\nConfJ\\Off;\nMoveL p10,v5,fine,grip;"),
        ("VAR num parts:=0;", "parts:=parts+1;\nTPWrite \"parts\"\\Num:=parts;"),
        ("VAR num i:=7;", "i:=0;\nWHILE i<2 DO\ni:=i+1;\nENDWHILE"),
    ] {
        let module = cycles(data, &format!("{head}\n{moves}"));
        let once = 2 + usize::from(head.contains("grip"));
        assert_eq!((module.program.moves.len(), module.unclear_line), (once, None), "{head}: {:?}", module.lines);
    }
    // ConfL that the first cycle leaves off is off for the second.
    let left = cycles("", "MoveL p10,v5,fine,tool0;\nConfL\\Off;");
    let demanded: Vec<bool> = left.program.moves.iter().map(|m| m.configuration_demanded).collect();
    assert_eq!(demanded, [true, false]);
    // EXIT ends it, and no other procedure begins again.
    let ended = cycles(
        "VAR bool first:=TRUE;",
        "IF first MoveL p10,v5,fine,tool0;\nIF NOT first MoveL p20,v5,fine,tool0;\nfirst:=FALSE;\nEXIT;",
    );
    assert_eq!(ended.program.moves.len(), 1);
}

/// Words that make most of what can go wrong.
const WORDS: [&str; 48] = [
    "MODULE",
    "M",
    "ENDMODULE",
    "PROC",
    "main",
    "(",
    ")",
    "ENDPROC",
    "FUNC",
    "num",
    "ENDFUNC",
    "IF",
    "THEN",
    "ELSE",
    "ENDIF",
    "WHILE",
    "DO",
    "ENDWHILE",
    "FOR",
    "i",
    "FROM",
    "TO",
    "ENDFOR",
    "TEST",
    "CASE",
    ":",
    "ENDTEST",
    ":=",
    ";",
    "[",
    "]",
    "{",
    "}",
    "\\",
    ",",
    "1",
    "-",
    "+",
    "NOT",
    "MoveL",
    "p10",
    "v5",
    "fine",
    "tool0",
    ".trans",
    "VAR",
    "%",
    "\"a",
];

proptest! {
    #![proptest_config(ProptestConfig { cases: 1500, ..ProptestConfig::default() })]

    #[test]
    fn any_words_are_read(picked in prop::collection::vec(0..WORDS.len(), 0..200), newlines in any::<u64>()) {
        let mut text = String::from("MODULE M PROC main() ");
        for (index, word) in picked.iter().enumerate() {
            text.push_str(WORDS[*word]);
            text.push(if newlines >> (index % 64) & 1 == 1 { '\n' } else { ' ' });
        }
        let module = read(text.as_bytes(), &Options::default()).unwrap();
        prop_assert!(module.certain <= module.program.moves.len());
    }

    #[test]
    fn any_bytes_are_read(bytes in prop::collection::vec(any::<u8>(), 0..300)) {
        let all = [b"MODULE M\n".as_slice(), &bytes].concat();
        prop_assert!(read(&all, &Options::default()).is_ok());
        let _ = read(&bytes, &Options::default());
    }
}

proptest! {
    // Loops that no longer end take their million steps each; two thousand more are read in tests/fuzz.
    #![proptest_config(ProptestConfig { cases: 300, ..ProptestConfig::default() })]

    #[test]
    fn changed_modules_are_read(cuts in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>(), 0..4_u8), 1..12)) {
        let mut bytes = CELL.as_bytes().to_vec();
        for (at, byte, what) in cuts {
            let at = at.index(bytes.len());
            match what {
                0 => bytes[at] = byte,
                1 => drop(bytes.drain(at..(at + usize::from(byte) % 20).min(bytes.len() - 1).max(at))),
                2 => bytes.insert(at, byte),
                _ => {
                    let piece = bytes[at..(at + 30).min(bytes.len())].to_vec();
                    bytes.splice(at..at, piece);
                }
            }
        }
        let _ = read(&bytes, &Options::default());
    }
}

/// Everything that is followed, at least once.
const CELL: &str = "MODULE Cell(SYSMODULE)
  RECORD part num id; ENDRECORD
  ALIAS num level;
  PERS tooldata tGrip:=[TRUE,[[0,0,120],[1,0,0,0]],[0.8,[0,0,50],[1,0,0,0],0,0,0]];
  CONST robtarget p10:=[[500,0,600],[0.707107,0,0.707107,0],[0,-1,0,1],[9E9,9E9,9E9,9E9,9E9,9E9]];
  VAR num grid{2,3}:=[[1,2,3],[4,5,6]];
  PROC main()
    VAR num n:=2;
    VAR robtarget there;
    there:=Offs(p10,grid{1,n},0,-grid{2,3});
    there.trans.z:=there.trans.z+Sqrt(2)*Sin(45);
    FOR i FROM 1 TO 3 STEP 2 DO
      TEST i
      CASE 1,2:
        go RelTool(there,0,0,10\\Rx:=10)\\fast;
      DEFAULT:
        go there;
      ENDTEST
    ENDFOR
    WHILE n<5 DO n:=n+twice(n); ENDWHILE
    IF di1=1 THEN SetDO do1,1; ELSEIF n>3 THEN TPWrite \"n=\"\\Num:=n; ELSE Stop; ENDIF
    MoveC Offs(p10,50,50,0),Offs(p10,100,0,0),[100,500,5000,1000]\\T:=2,[FALSE,5,8,8,.8,8,.8],tGrip;
    %\"main\"+\"2\"%;
  ERROR
    RETRY;
  ENDPROC
  LOCAL PROC go(robtarget goal \\switch fast | num slow, INOUT num k{*})
    MoveL goal,v100,z10,tGrip;
  ENDPROC
  FUNC num twice(num x) RETURN 2*x; ENDFUNC
  TRAP t1 Incr grid{1,1}; ENDTRAP
ENDMODULE
";
