//! Programs from elsewhere: read, checked by line, and told apart by exit code.

mod commands;

use std::fs;

use commands::{json, refused, run};

const DATA: &str = "MODULE Cell
CONST jointtarget home:=[[0,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
CONST jointtarget far:=[[0,0,0,163.1,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
CONST robtarget away:=[[2000,0,400],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
CONST robtarget p10:=[[350,0,300],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
PROC main()
MoveAbsJ home,v200,fine,tool0;
";

fn module(folder: &std::path::Path, body: &str) -> String {
    let name = "cell.mod";
    fs::write(folder.join(name), format!("{DATA}{body}\nENDPROC\nENDMODULE\n").replace('\n', "\r\n")).unwrap();
    name.into()
}

#[test]
fn findings_are_told_by_line_and_exit_code() {
    let folder = tempfile::tempdir().unwrap();
    let go = "MoveL p10,v100,fine,tool0;\nMoveL Offs(p10,0,50,0),v100,z5,tool0;";
    for (body, code, words) in [
        (go, 0, "PASS: 0 findings in 3 moves"),
        (
            "MoveAbsJ far,v200,fine,tool0;",
            1,
            "line 8: UNREACHABLE home→far: axis 4 at 163.1° > 160.0° at 100 % of the move",
        ),
        ("ConfL\\Off;\nMoveJ p10,v100,fine,tool0;\nMoveL away,v100,fine,tool0;", 1, "line 10: UNREACHABLE p10→away: "),
        ("MoveL p10,v100,fine,tool0;\nMoveC p10,p10,v100,fine,tool0;", 1, "NOT EXECUTABLE line 9 (to p10): "),
        (
            "VelSet 50,800;\nMoveAbsJ far,v200,fine,tool0;",
            5,
            "INCONCLUSIVE: 0 findings in the 1 of 2 moves before line 8",
        ),
        ("MoveAbsJ far,v200,fine,tool0;\nWeld;", 1, "line 9: NOT UNDERSTOOD `Weld` is not in this file"),
    ] {
        let file = module(folder.path(), body);
        let (found, out, error) = run(folder.path(), &["import", &file, "--check"]);
        assert!(found == code && out.contains(words), "{body}: {found}\n{out}{error}");
        assert!(out.contains("irb120") && out.contains("obstacles are not looked at"), "{out}");
    }
}

#[test]
fn machines_get_the_same() {
    let folder = tempfile::tempdir().unwrap();
    let file = module(folder.path(), "MoveAbsJ far,v200,fine,tool0;\nSoftAct 3,20;\nMoveAbsJ home,v200,fine,tool0;");
    let object = json(folder.path(), &["import", &file, "--check", "--robot", "irb120", "--lines"]);
    assert_eq!((object["exit_code"].as_i64(), object["moves"].as_i64()), (Some(1), Some(3)));
    assert_eq!((object["certain_moves"].as_i64(), object["certain_up_to_line"].as_i64()), (Some(2), Some(9)));
    let finding = &object["findings"][0];
    assert_eq!(
        (finding["line"].as_i64(), finding["kind"].as_str(), finding["to"].as_str()),
        (Some(8), Some("limit"), Some("far"))
    );
    assert_eq!(object["not_understood"][0]["line"], 9);
    assert_eq!(object["lines"].as_array().unwrap().iter().filter(|line| line["class"] == "understood").count(), 8);
    let read = json(folder.path(), &["import", &file]);
    assert_eq!((read["exit_code"].as_i64(), read["robot"].is_null()), (Some(5), true));
}

#[test]
fn what_cannot_be_read_at_all_is_wrong_input() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("no.mod"), "hello\n").unwrap();
    let file = module(folder.path(), "");
    refused(folder.path(), &["import", "no.mod", "--check"], &["no.mod", "no RAPID module"]);
    refused(folder.path(), &["import", "nowhere.mod"], &["nowhere.mod"]);
    refused(folder.path(), &["import", &file, "--check", "--robot", "anafi"], &["anafi"]);
    refused(folder.path(), &["import", &file, "--procedure", "Path_30"], &["Path_30", "main"]);
}

#[test]
fn collisions_with_a_cell_are_told_by_line() {
    let folder = tempfile::tempdir().unwrap();
    let cell = "hairpin = 1\nrobot = \"irb120\"\n[world]\ntool = { radius_mm = 10 }\n\
        obstacles = [{ name = \"rod\", capsule = { a_mm = [200, 60, 300], b_mm = [500, 60, 300], radius_mm = 2 } }]\n\
        keep_out_mm = [\"z < 100\"]\n[task]\npoints = [[350, 0, 400]]\n";
    fs::write(folder.path().join("cell.toml"), cell).unwrap();
    let file = module(folder.path(), "MoveL p10,v100,fine,tool0;\nMoveL Offs(p10,0,120,0),v100,z5,tool0;");
    assert_eq!(run(folder.path(), &["import", &file, "--check"]).0, 0);
    let (code, out, error) = run(folder.path(), &["import", &file, "--check", "--cell", "cell.toml"]);
    assert!(code == 1 && out.contains("held against 2 obstacles and keep-outs"), "{out}{error}");
    assert!(out.contains("line 9: COLLISION p10→"), "{out}");
    assert!(out.contains(" meets rod at ") && out.contains("FAIL: 1 finding in 3 moves"), "{out}");
    let object = json(folder.path(), &["import", &file, "--check", "--cell", "cell.toml"]);
    assert_eq!(
        (object["findings"][0]["kind"].as_str(), object["findings"][0]["line"].as_i64()),
        (Some("collision"), Some(9))
    );
    let low = module(folder.path(), "MoveL p10,v100,fine,tool0;\nMoveL Offs(p10,0,0,-250),v100,z5,tool0;");
    let (code, out, _) = run(folder.path(), &["import", &low, "--check", "--cell", "cell.toml"]);
    assert!(code == 1 && out.contains("the tool ") && out.contains("keep-out z < 100"), "{out}");
    refused(folder.path(), &["import", &file, "--check", "--cell", "anafi"], &["no arm's"]);
    refused(folder.path(), &["import", &file, "--check", "--cell", "nowhere.toml"], &["nowhere.toml"]);
}
