//! Programs of which `import` followed nothing, or not all.

use std::fs;

use crate::commands::{json, run};

/// Of what was not followed nothing is said to be free of findings.
#[test]
fn a_program_that_was_not_followed_is_no_pass() {
    let folder = tempfile::tempdir().unwrap();
    let place = folder.path();
    let go = |axis_5: i32| format!("MoveAbsJ [[0,0,0,0,{axis_5},0],[9E9,9E9,9E9,9E9,9E9,9E9]],v200,fine,tool0;");
    let two = format!("MODULE A\nPROC one()\n{}\nENDPROC\nPROC two()\n{}\nENDPROC\nENDMODULE\n", go(30), go(330));
    for (name, text, why) in [
        ("em.mod", "MODULE E\nPROC main()\nENDPROC\nENDMODULE\n", "no move was found in it"),
        ("em2.mod", "MODULE E\nVAR num n;\nENDMODULE\n", "no move was found in it"),
        ("em.script", "def p():\nend\np()\n", "no move was found in it"),
        ("em.src", "DEF k ( )\nEND\n", "no move was found in it"),
        ("two.mod", &two, "no main says whether two is executed"),
    ] {
        fs::write(place.join(name), text).unwrap();
        let (code, out, error) = run(place, &["import", name, "--check"]);
        assert!(code == 5 && out.contains("\nINCONCLUSIVE: 0 findings in ") && out.contains(why), "{out}{error}");
        assert_eq!(run(place, &["import", name]).0, 0, "{name}: what is only read is read");
    }
    let object = json(place, &["import", "two.mod", "--check"]);
    assert_eq!(
        (&object["not_executed"][0]["procedure"], &object["not_executed"][0]["line"]),
        (&"two".into(), &5.into())
    );
    let (code, out, error) = run(place, &["import", "two.mod", "--check", "--procedure", "one"]);
    assert!(code == 0 && out.contains("\nPASS: 0 findings in 1 moves"), "{out}{error}");
    assert_eq!(run(place, &["import", "two.mod", "--check", "--procedure", "two"]).0, 1);
    fs::write(place.join("main.mod"), two.replace("PROC one()", "PROC main()")).unwrap();
    assert_eq!(run(place, &["import", "main.mod", "--check"]).0, 0);
}
