//! Modules that are one program, each in its file.

use super::super::{NoModule, Options, read_all};
use super::assert_clear;
use crate::listing::{Class, File, Module};

fn all(texts: &[(&'static str, &str)]) -> Result<Module, (usize, NoModule)> {
    let files: Vec<File<'_>> = texts.iter().map(|(name, text)| File { name, bytes: text.as_bytes() }).collect();
    read_all(&files, &Options::default())
}

const END: &str = "[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];";

#[test]
fn what_one_declares_all_know_but_for_what_is_local() {
    let data = format!(
        "MODULE Data(SYSMODULE)\nCONST robtarget p1:=[[1,0,0],{END}\nLOCAL CONST robtarget mine:=[[2,0,0],{END}\n\
         PROC go()\nMoveL mine,v5,fine,tool0;\nlift;\nENDPROC\nLOCAL PROC lift()\nMoveL Offs(mine,0,0,7),v5,fine,tool0;\nENDPROC\nENDMODULE"
    );
    let main = format!(
        "%%%\nVERSION:1\n%%%\nMODULE Main\nLOCAL CONST robtarget mine:=[[3,0,0],{END}\nPROC main()\nMoveL p1,v5,fine,tool0;\n\
         go;\nMoveL mine,v5,fine,tool0;\nlift;\nENDPROC\nLOCAL PROC lift()\nMoveL Offs(mine,0,0,9),v5,fine,tool0;\nENDPROC\nENDMODULE\n"
    );
    for texts in [[("d.sys", data.as_str()), ("m.mod", &main)], [("m.mod", &main), ("d.sys", &data)]] {
        let module = all(&texts).unwrap();
        assert_clear(&module);
        let places: Vec<_> =
            module.program.moves.iter().map(super::place).map(|[x, _, z]| [x / 1000, z / 1000]).collect();
        assert_eq!(places, [[1, 0], [2, 0], [2, 7], [3, 0], [3, 9]]);
        assert_eq!((module.program.name.as_str(), module.program.procedure.as_str()), ("Main", "main"));
        let told: Vec<_> = module.program.moves.iter().map(|m| module.told(m.line.unwrap())).collect();
        assert_eq!(told, ["m.mod line 7", "d.sys line 5", "d.sys line 9", "m.mod line 9", "m.mod line 13"]);
    }
    let alone = all(&[("m.mod", &main)]).unwrap();
    assert_eq!(alone.unclear().map(|(line, _)| alone.told(line)).collect::<Vec<_>>(), ["line 7", "line 8"]);
}

/// What a procedure of another module may assign to depends on the cell there, too.
#[test]
fn what_may_have_changed_is_that_module_s() {
    let other =
        "MODULE B\nLOCAL VAR num n:=1;\nPROC up()\nn:=n+1;\nENDPROC\nFUNC num got()\nRETURN n;\nENDFUNC\nENDMODULE";
    let main = |body: &str| {
        format!(
            "MODULE A\nVAR num n:=5;\nCONST robtarget p:=[[0,0,0],{END}\nPROC main()\n{body} EXIT;\nENDPROC\nENDMODULE"
        )
    };
    let known = main("up;\nMoveL Offs(p,got(),n,0),v5,fine,tool0;");
    let module = all(&[("a.mod", &known), ("b.mod", other)]).unwrap();
    assert_clear(&module);
    assert_eq!(super::place(&module.program.moves[0]), [2000, 5000, 0]);
    let open = main("IF di1=1 up;\nMoveL Offs(p,0,n,0),v5,fine,tool0;\nMoveL Offs(p,got(),0,0),v5,fine,tool0;");
    let module = all(&[("a.mod", &open), ("b.mod", other)]).unwrap();
    assert_eq!((module.certain, module.unclear_line.map(|line| module.told(line))), (1, Some("a.mod line 7".into())));
}

#[test]
fn mistakes_and_doubts_name_their_file() {
    let main = "MODULE A\nPROC main()\nhelp;\nENDPROC\nENDMODULE\n";
    let other = "MODULE B\nPROC help()\n  MoveL ,v5;\nSoftAct 1,20;\nENDPROC\nENDMODULE\n";
    let module = all(&[("a.mod", main), ("b.sys", other)]).unwrap();
    let found = &module.mistakes[0];
    assert_eq!((module.told(found.at.line), found.at.column), ("b.sys line 3".into(), 9));
    assert_eq!(
        module.unclear().map(|(line, _)| module.told(line)).collect::<Vec<_>>(),
        ["b.sys line 3", "b.sys line 4"]
    );
    assert!(module.whole().unwrap_err().starts_with("b.sys line 3 is not understood"));
    assert_eq!(all(&[("a.mod", main), ("x.mod", "hello")]), Err((1, NoModule::Absent)));
    assert_eq!(all(&[]), Err((0, NoModule::Absent)));
}

#[test]
fn what_is_declared_twice_is_followed_nowhere() {
    let p = |x: f64| format!("CONST robtarget p:=[[{x},0,0],{END}\n");
    let main = format!("MODULE A\n{}PROC main()\nMoveL p,v5,fine,tool0;\nENDPROC\nENDMODULE", p(1.0));
    let other = format!("MODULE B\n{}ENDMODULE", p(2.0));
    let module = all(&[("a.mod", &main), ("b.mod", &other)]).unwrap();
    assert_eq!((module.certain, module.unclear_line), (0, Some(4)));
    assert!(module.lines[&2].what.contains("more than once"), "{:?}", module.lines);
    let again = "MODULE B\nPROC main()\nENDPROC\nENDMODULE";
    let module = all(&[("a.mod", &main), ("b.mod", again)]).unwrap();
    assert_eq!((module.certain, module.class(3)), (0, Class::ChangesMotion));
    // A name of its own for each is no second one.
    let local = format!("MODULE B\nLOCAL {}ENDMODULE", p(2.0));
    assert_clear(&all(&[("a.mod", &main), ("b.mod", &local)]).unwrap());
}
