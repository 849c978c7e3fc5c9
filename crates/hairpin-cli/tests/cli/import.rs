//! Programs from elsewhere: read, checked by line, and told apart by exit code.

use std::fs;
use std::path::{Path, PathBuf};

use crate::commands::{json, refused, run};

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
        // Before it is out of reach an elbow's singularity is not excluded.
        (
            "MoveL [[2000,0,500],[0.2588190451,0,0.9659258263,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v200,fine,tool0;",
            1,
            "line 8: UNREACHABLE home→(in place): out of reach at 100 % of the move",
        ),
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

/// ABB's controllers tell axis 3 of arms with a parallel rod against the base.
#[test]
fn joint_targets_of_arms_with_a_parallel_rod_are_told_as_their_controller_does() {
    let folder = tempfile::tempdir().unwrap();
    let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data/robots/arm/irb120.toml");
    let arm = fs::read_to_string(shipped).unwrap().replace("name = \"irb120\"", "name = \"ABB IRB 2400\"");
    fs::write(folder.path().join("arm.toml"), arm).unwrap();
    // Axis 3 at −60° against the upper arm, −120° against the base, which as its own angle is beyond −110°.
    let file = module(folder.path(), "MoveAbsJ [[0,-60,-120,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v200,fine,tool0;");
    let check = ["import", &file, "--check", "--robot", "arm.toml"];
    for (coupled, code, words) in [
        (None, 5, "line 7: INCONCLUSIVE home: joint angles of a type of arm whose controller tells axis 3"),
        (Some("robot.joints.j23_coupled=true"), 0, "PASS: 0 findings in 2 moves"),
        (Some("robot.joints.j23_coupled=false"), 1, "axis 3 at"),
    ] {
        let set: Vec<&str> = coupled.into_iter().flat_map(|set| ["--set", set]).collect();
        let (found, out, error) = run(folder.path(), &[&check[..], &set].concat());
        assert!(found == code && out.contains(words), "{found}\n{out}{error}");
    }
    let object = json(folder.path(), &[&check[..], &["--set", "robot.joints.j23_coupled=true"]].concat());
    assert_eq!(object["findings"].as_array().map(Vec::len), Some(0), "{object}");
    // Other languages have the joints' own angles.
    let krl =
        "DEF t( )\nBAS (#INITMOV,0)\n$TOOL=$NULLFRAME\n$BASE=$NULLFRAME\nPTP {A1 0,A2 0,A3 0,A4 0,A5 30,A6 0}\nEND\n";
    fs::write(folder.path().join("t.src"), krl).unwrap();
    let (found, out, error) = run(folder.path(), &["import", "t.src", "--check", "--robot", "arm.toml"]);
    assert!(!out.contains("axis 3 against the base"), "{found}\n{out}{error}");
}

/// Numbers that no move carries are held to their bounds as those are that moves carry.
#[test]
fn what_no_controller_takes_is_told_in_every_language() {
    let folder = tempfile::tempdir().unwrap();
    let script = |body: &str| format!("def t():\n  set_tcp(p[0,0,0,0,0,0])\n  {body}\nend\nt()\n");
    let home = "[0,0,0,0,0.5236,0]";
    let src = |line: &str| {
        format!("DEF t ( )\n$TOOL=$NULLFRAME\n$BASE=$NULLFRAME\n{line}\nPTP {{A1 0,A2 0,A3 0,A4 0,A5 30,A6 0}}\nEND\n")
    };
    for (name, text, words) in [
        ("t.script", script(&format!("movej({home}, v=-1.05)")), "NOT EXECUTABLE line 3: v = -1.05: must be"),
        ("t.script", script(&format!("movej({home}, a=0, v=0)")), "FAIL: 2 findings in 1 moves"),
        ("t.src", src("BAS (#VEL_PTP,150)"), "NOT EXECUTABLE line 4: BAS (#VEL_PTP) = 150: must be"),
        ("t.src", src("$VEL.CP=0"), "NOT EXECUTABLE line 4: $VEL.CP = 0: must be"),
        // From where the arm stands 30° in a millisecond.
        (
            "t.script",
            script(&format!("movej({home})\n  movej([0,0,0,0,0,0], t=0.001)")),
            "line 4: NOT EXECUTABLE (before)→(in place): in the 0.001 s that it is to take axis 5 turns by 30.0°, 30000°/s: its \
             largest speed is 320°/s",
        ),
    ] {
        fs::write(folder.path().join(name), text).unwrap();
        let (code, out, error) = run(folder.path(), &["import", name, "--check"]);
        assert!(code == 1 && out.contains(words), "{words}: {code}\n{out}{error}");
    }
    fs::write(folder.path().join("u.src"), src("PTP XH")).unwrap();
    fs::write(folder.path().join("u.dat"), "DEFDAT t\n$VEL.CP=0\nENDDAT\n").unwrap();
    let (code, out, _) = run(folder.path(), &["import", "u.src", "--check"]);
    assert!(code == 5 && out.contains("u.dat line 2: NOT UNDERSTOOD `$VEL` is not followed"), "{out}");
    let (twice, once) = (format!("{}t()\n", script(&format!("movej({home})"))), script(&format!("movej({home})")));
    for (text, moves) in [(once, 1), (twice, 2)] {
        fs::write(folder.path().join("t.script"), text).unwrap();
        let object = json(folder.path(), &["import", "t.script", "--check"]);
        assert_eq!((object["exit_code"].as_i64(), object["moves"].as_i64()), (Some(0), Some(moves)));
    }
}

/// Times and speeds that no arm has are a slip in the unit or in a digit.
#[test]
fn what_no_arm_is_fast_enough_for_is_told() {
    let folder = tempfile::tempdir().unwrap();
    for (body, code, words) in [
        ("MoveL p10,v100,fine,tool0;\nMoveL Offs(p10,0,50,0),v100\\T:=2,fine,tool0;", 0, "PASS: 0 findings"),
        (
            "MoveL p10,v100,fine,tool0;\nMoveL Offs(p10,0,50,0),v100\\T:=0.001,fine,tool0;",
            1,
            "line 9: NOT EXECUTABLE p10→(in place): in the 0.001 s that it is to take axis ",
        ),
        (
            "MoveL p10,v100,fine,tool0;\nMoveAbsJ home,v100\\T:=0.001,fine,tool0;",
            1,
            "line 9: NOT EXECUTABLE p10→home: in the ",
        ),
        (
            "MoveL p10,[90000,500,5000,1000],fine,tool0;",
            1,
            "NOT EXECUTABLE line 8 (to p10): tcp speed = 90: must be a number, more than 0 m/s and at most 20 m/s, or vmax",
        ),
        ("MoveL p10,v100\\V:=90000,fine,tool0;", 1, "NOT EXECUTABLE line 8 (to p10): tcp speed = 90: must be"),
        ("MoveL p10,vmax,fine,tool0;", 0, "PASS: 0 findings"),
    ] {
        let file = module(folder.path(), body);
        let (found, out, error) = run(folder.path(), &["import", &file, "--check"]);
        assert!(found == code && out.contains(words), "{body}: {found}\n{out}{error}");
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
    let held = "held against 2 obstacles and keep-outs, of which the 1 in words hold for the tool alone\n";
    assert!(code == 1 && out.contains(held), "{out}{error}");
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

/// Inputs on which something wrong was said once.
fn cases() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/cases/rapid")
}

#[test]
fn an_axis_beside_the_arm_is_named_line_by_line() {
    let (code, out, error) = run(&cases(), &["import", "track_false_pass.mod", "--check"]);
    assert_eq!(code, 5, "{out}{error}");
    for line in 4..=7 {
        assert!(out.contains(&format!("line {line}: NOT MODELLED external axes: eax_a = ")), "{out}");
    }
    assert!(out.contains("\nINCONCLUSIVE: 0 findings in the 0 of 4 moves before line 4, estimated: "), "{out}");
    let object = json(&cases(), &["import", "track_false_pass.mod", "--check"]);
    assert_eq!((object["exit_code"].as_i64(), object["certain_moves"].as_i64()), (Some(5), Some(0)));
    let named = object["not_understood"].as_array().unwrap();
    assert_eq!(named.len(), 4);
    assert!(named.iter().all(|line| line["kind"] == "external-axes" && line["file"] == "track_false_pass.mod"));
}

/// What is proven before the first line that is not modelled is proven.
#[test]
fn a_finding_before_what_is_not_modelled_is_a_finding() {
    let folder = tempfile::tempdir().unwrap();
    let track = "MoveAbsJ [[0,0,0,0,30,0],[900,9E9,9E9,9E9,9E9,9E9]],v200,fine,tool0;";
    let before = module(folder.path(), &format!("MoveAbsJ far,v200,fine,tool0;\n{track}"));
    let object = json(folder.path(), &["import", &before, "--check"]);
    assert_eq!((object["exit_code"].as_i64(), object["findings"][0]["line"].as_i64()), (Some(1), Some(8)));
    assert_eq!(
        (&object["not_understood"][0]["line"], &object["not_understood"][0]["kind"]),
        (&9.into(), &"external-axes".into())
    );
    let after = module(folder.path(), &format!("{track}\nMoveAbsJ far,v200,fine,tool0;"));
    let object = json(folder.path(), &["import", &after, "--check"]);
    assert_eq!((object["exit_code"].as_i64(), object["findings"].as_array().unwrap().len()), (Some(5), 0));
}

#[test]
fn predefined_data_and_the_state_of_the_program_are_followed() {
    let (code, out, error) = run(&cases(), &["import", "alias_speed.mod", "--check"]);
    // Followed to its end: the tool is turned by −30° about its axis, and axis 6 with it, which is no cf6 of 0.
    assert!(code == 1 && !out.contains("not known") && !out.contains("NOT UNDERSTOOD"), "{out}{error}");
    let handler = "line 27: NOT MODELLED handlers that move the arm: it may move the arm in the ERROR handler of `";
    assert!(out.contains(handler) && out.matches("NOT MODELLED").count() == 1, "{out}");
    let verdict = "FAIL: 3 findings in 7 moves, but line 27 is in a handler, and none is followed\n";
    assert!(out.ends_with(verdict) && out.matches("[0,0,0,0]").count() == 3, "{out}");
    let (code, out, error) = run(&cases(), &["import", "conf_off_after.mod", "--check"]);
    assert_eq!(code, 1, "{out}{error}");
    assert!(out.contains("line 10: UNREACHABLE pA→pFar") && out.ends_with("FAIL: 1 finding in 4 moves\n"), "{out}");
}

/// What may come in between is no PASS, and takes nothing from what is certain without it.
#[test]
fn handlers_that_move_the_arm_are_named_and_pass_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let go = "MoveAbsJ home,v200,fine,tool0;";
    for kind in ["ERROR", "UNDO", "BACKWARD"] {
        let file = module(folder.path(), &format!("{go}\n{kind}\nMoveAbsJ far,v200,fine,tool0;\nRETRY;"));
        let (code, out, error) = run(folder.path(), &["import", &file, "--check"]);
        let named = format!(
            "line 10: NOT MODELLED handlers that move the arm: it may move the arm in the {kind} handler of `main`"
        );
        assert!(code == 5 && out.contains(&named), "{out}{error}");
        assert!(out.contains("\nINCONCLUSIVE: 0 findings in 2 moves, but line 10 is in a handler"), "{out}");
        let object = json(folder.path(), &["import", &file, "--check"]);
        assert_eq!((&object["certain_moves"], &object["not_understood"][0]["kind"]), (&2.into(), &"handlers".into()));
    }
    let file = module(folder.path(), &format!("{go}\nERROR\nTPWrite \"again\";\nRETRY;"));
    assert_eq!(run(folder.path(), &["import", &file, "--check"]).0, 0);
    // Of a trap that moves nothing itself.
    let trap = "ENDPROC\nTRAP tStop\nTPWrite \"stop\";\nERROR\nMoveAbsJ far,v200,fine,tool0;\nENDTRAP\nPROC more()";
    let file = module(folder.path(), &format!("CONNECT iStop WITH tStop;\n{go}\n{trap}"));
    let (code, out, _) = run(folder.path(), &["import", &file, "--check"]);
    assert!(code == 5 && out.contains("in the ERROR handler of `tStop`"), "{out}");
}

/// A loop that counts finds the same on each of its rounds.
#[test]
fn what_a_loop_finds_again_is_told_once() {
    let folder = tempfile::tempdir().unwrap();
    let file = module(
        folder.path(),
        "FOR i FROM 1 TO 40 DO\nMoveAbsJ [[100+i,0,0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v200,fine,tool0;\nMoveAbsJ [[200+i,0,0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v200,fine,tool0;\nENDFOR",
    );
    let (code, out, error) = run(folder.path(), &["import", &file, "--check"]);
    assert_eq!(code, 1, "{out}{error}");
    assert!(
        out.matches("line 10: ").count() == 1 && out.contains("; 40 times, from move 3 to move 81, the last: "),
        "{out}"
    );
    let object = json(folder.path(), &["import", &file, "--check"]);
    let found = object["findings"].as_array().unwrap();
    let of_line = |line: i64| found.iter().filter(|one| one["line"] == line).collect::<Vec<_>>();
    assert_eq!(
        (of_line(10).len(), &of_line(10)[0]["count"], &of_line(10)[0]["moves"]),
        (1, &40.into(), &serde_json::json!([3, 81]))
    );
    assert_ne!(of_line(10)[0]["last"], of_line(10)[0]["reason"]);
}

#[test]
fn several_modules_are_one_program() {
    for files in
        [&["cell.pgf"][..], &["cell_main.mod", "cell_data.sys"], &["cell_data.sys", "cell_main.mod", "cell.pgf"]]
    {
        let arguments: Vec<&str> = ["import"].iter().chain(files).chain(&["--check"]).copied().collect();
        let (code, out, error) = run(&cases(), &arguments);
        assert!(out.contains("module MainModule, procedure main, 3 moves"), "{files:?}: {out}{error}");
        assert!(code == 0 && out.contains("\nPASS: 0 findings in 3 moves, estimated: "), "{files:?}: {out}{error}");
    }
    let alone = run(&cases(), &["import", "cell_main.mod", "--check"]);
    assert_eq!(alone.0, 5, "{}", alone.1);
}

#[test]
fn mistakes_in_modules_name_their_file_and_program_files_stay_in_their_folder() {
    let place = tempfile::tempdir().unwrap();
    let folder = place.path().join("cell");
    fs::create_dir(&folder).unwrap();
    for name in ["cell_main.mod", "cell_data.sys"] {
        fs::copy(cases().join(name), folder.join(name)).unwrap();
    }
    let data = fs::read_to_string(folder.join("cell_data.sys")).unwrap();
    fs::write(folder.join("cell_data.sys"), data.replace("[[350,-120,200]", "[[3500,-120,200]")).unwrap();
    let pgf = |module: &str| {
        let text = format!("<Program>\n<Module>cell_main.mod</Module>\n<Module>{module}</Module>\n</Program>");
        fs::write(folder.join("cell.pgf"), text).unwrap();
    };
    pgf("cell_data.sys");
    let (code, out, _) = run(&folder, &["import", "cell.pgf", "--check"]);
    assert!(code == 1 && out.contains("cell_main.mod line 5: UNREACHABLE pHome→"), "{out}");
    let object = json(&folder, &["import", "cell.pgf", "--check"]);
    assert_eq!((&object["findings"][0]["file"], &object["findings"][0]["line"]), (&"cell_main.mod".into(), &5.into()));
    fs::write(folder.join("cell_data.sys"), data.replace("ConfJ \\On;", "ConfJ \\;")).unwrap();
    let (code, out, error) = run(&folder, &["import", "cell.pgf", "--check"]);
    assert!(code == 5 && out.contains("cell_data.sys line 7: NOT UNDERSTOOD expected"), "{out}{error}");
    assert!(error.contains("cell_data.sys line 7, column "), "{error}");
    pgf("../cell_data.sys");
    refused(&folder, &["import", "cell.pgf"], &["cell.pgf: line 3: `../cell_data.sys`", "in the folder"]);
    pgf("nowhere.mod");
    refused(&folder, &["import", "cell.pgf"], &["cell.pgf: module `nowhere.mod` cannot be read"]);
    fs::write(place.path().join("secret.mod"), "MODULE S\nENDMODULE\n").unwrap();
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink("../secret.mod", folder.join("link.mod")).unwrap();
        pgf("link.mod");
        refused(&folder, &["import", "cell.pgf"], &["link.mod", "leads out of the folder"]);
    }
    fs::write(folder.join("cell.pgf"), "hello").unwrap();
    refused(&folder, &["import", "cell.pgf"], &["cell.pgf: is no XML"]);
}

/// What `export` writes in any language, `import` follows move by move.
/// Where the fixtures of logs and missions are.
fn fixture(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../hairpin-formats/tests/fixtures").join(name);
    path.to_string_lossy().into_owned()
}

#[test]
fn logs_and_missions_are_told_by_what_they_hold() {
    let folder = tempfile::tempdir().unwrap();
    let place = folder.path();
    fs::write(place.join("a.txt"), "# t x y z qx qy qz qw\n0.0 0 0 1 0 0 0 1\n0.1 0.1 0 1 0 0 0 1\n").unwrap();
    let step = |k: u32| format!("{:.1},{:.1},0,1\n", 0.1 * f64::from(k), 0.1 * f64::from(k));
    let rows = |gap: u32| (0..20).filter(|k| *k < 8 || *k > 8 + gap).map(step).collect::<String>();
    fs::write(place.join("whole.csv"), format!("t_s,x_m,y_m,z_m\n{}", rows(0))).unwrap();
    fs::write(place.join("gap.csv"), format!("t_s,x_m,y_m,z_m\n{}", rows(7))).unwrap();
    fs::write(place.join("mission.csv"), "x_m,y_m,z_m\n0,0,5\n3,4,5\n").unwrap();
    for (file, kind, format) in [
        (fixture("logs/flight.ulg"), "log", "PX4 ULog"),
        (fixture("logs/flight.bin"), "log", "ArduPilot DataFlash"),
        (fixture("logs/drive.mcap"), "log", "ROS 2 MCAP"),
        ("a.txt".into(), "log", "TUM"),
        ("whole.csv".into(), "log", "CSV"),
        (fixture("missions/cage.plan"), "mission", "QGroundControl plan"),
        (fixture("missions/cage.waypoints"), "mission", "QGC WPL 110"),
        ("mission.csv".into(), "mission", "CSV"),
    ] {
        let object = json(place, &["import", &file]);
        assert_eq!(
            (object["kind"].as_str(), object["format"].as_str()),
            (Some(kind), Some(format)),
            "{file}: {object}"
        );
    }
    assert_eq!(json(place, &["import", "mission.csv"])["length_m"].as_f64(), Some(5.0));

    // What a judgement would cut out is a finding, with its time; what is whole is none.
    let (code, out, error) = run(place, &["import", "whole.csv"]);
    assert!(code == 0 && error.contains("next: hairpin judge whole.csv --mission"), "{code}: {out}{error}");
    let (code, out, _) = run(place, &["import", "gap.csv"]);
    assert!(code == 1 && out.contains("gap of 0.9 s at t = 0.7 s not judged"), "{code}: {out}");
    let (code, _, error) = run(place, &["import", "mission.csv"]);
    assert!(code == 0 && error.contains("next: hairpin check mission.csv --robot"), "{code}: {error}");

    refused(place, &["import", "whole.csv", "--check"], &["--check", "hairpin judge"]);
    refused(place, &["import", "mission.csv", "--out", "x.csv"], &["--out", "hairpin check"]);
    fs::write(place.join("t.parquet"), b"PAR1\0\0").unwrap();
    refused(place, &["import", "t.parquet"], &["Parquet", "import reads RAPID modules"]);
    fs::write(place.join("note.txt"), "hello\n").unwrap();
    refused(place, &["import", "note.txt"], &["note.txt", "no RAPID module", "missions"]);
}

#[test]
fn what_is_exported_is_read_back() {
    let place = tempfile::tempdir().unwrap();
    let text = "hairpin = 1\nrobot = \"irb120\"\nseed = 3\n[world]\ntool = { name = \"tGrip\", declare = true, tcp_mm = [0, 0, 100], radius_mm = 20 }\n\
        [task]\npoints = [[300, 100, 400], [350, -100, 300], [400, 50, 350], [250, 200, 450]]\n\
        [generate]\nmoves = { speeds = [\"v500\"], zones = [\"fine\", \"z10\"] }\nsearch = { programs = 1 }\n\
        [spec]\npath = { max_mm = 20 }\n";
    fs::write(place.path().join("arm.toml"), text).unwrap();
    let (code, out, error) = run(place.path(), &["generate", "arm.toml", "--out", "A"]);
    assert_eq!(code, 0, "{out}{error}");
    let mut counts = Vec::new();
    for (language, file) in [
        ("rapid", "A/export/0000.mod"),
        ("rapid", "A/export/0000.pgf"),
        ("krl", "A/export/0000.src"),
        ("urscript", "A/export/0000.script"),
    ] {
        let (code, out, error) = run(place.path(), &["export", "A", "--to", language]);
        assert_eq!(code, 0, "{out}{error}");
        let (code, out, error) = run(place.path(), &["import", file, "--check"]);
        assert!(code == 0 && out.contains("PASS: 0 findings in "), "{file}: {out}{error}");
        counts.push(json(place.path(), &["import", file])["certain_moves"].as_i64().unwrap());
    }
    assert!(counts[0] > 4 && counts.iter().all(|count| *count == counts[0]), "{counts:?}");
    fs::remove_file(place.path().join("A/export/0000.dat")).unwrap();
    let (code, out, _) = run(place.path(), &["import", "A/export/0000.src", "--check"]);
    assert!(code == 5 && out.contains("NOT UNDERSTOOD `X") && out.contains("is not declared in this program"), "{out}");
}

/// As packages of Universal Robots have it, the controller counts from a link that is turned against the root.
#[test]
fn poses_of_programs_count_from_the_controllers_base() {
    let folder = tempfile::tempdir().unwrap();
    let joint = |k: usize, parent: &str, xyz: &str, axis: &str| {
        format!(
            "<joint name='j{k}' type='revolute'><parent link='{parent}'/><child link='l{k}'/><origin xyz='{xyz}'/><axis xyz='{axis}'/>\
             <limit lower='-2.8' upper='2.8' velocity='4' effort='0'/></joint><link name='l{k}'/>\n"
        )
    };
    let arm = |base: &str| {
        let joints = [
            joint(1, "base_link", "0 0 0.29", "0 0 1"),
            joint(2, "l1", "0 0 0", "0 1 0"),
            joint(3, "l2", "0 0 0.27", "0 1 0"),
            joint(4, "l3", "0 0 0.07", "1 0 0"),
            joint(5, "l4", "0.302 0 0", "0 1 0"),
            joint(6, "l5", "0 0 0", "1 0 0"),
        ];
        let tip = "<joint name='t' type='fixed'><parent link='l6'/><child link='tool0'/>\
            <origin xyz='0.072 0 0' rpy='0 1.5707963267948966 0'/></joint><link name='tool0'/>";
        format!("<robot name='six'><link name='base_link'/>\n{}{tip}{base}</robot>", joints.concat())
    };
    let turned = "<joint name='b' type='fixed'><parent link='base_link'/><child link='base'/>\
        <origin rpy='0 0 3.141592653589793'/></joint><link name='base'/>";
    fs::write(folder.path().join("root.urdf"), arm("")).unwrap();
    fs::write(folder.path().join("turned.urdf"), arm(turned)).unwrap();
    let cell = |urdf: &str| {
        format!(
            "hairpin = 1\nrobot = {{ kind = \"arm\", urdf = \"{urdf}\", no_body = [0, 1, 2, 3, 4, 5, 6] }}\n[world]\n\
             tool = {{ name = \"tool0\", declare = false, tcp_mm = [0, 0, 0], radius_mm = 10 }}\nobstacles = [{{ name = \"ball\", sphere = {{ center_mm = [350, 100, 350], radius_mm = 20 }} }}]\n\
             [task]\npoints = [[350, -100, 400], [350, -50, 400]]\nhome_deg = [0, 0, 0, 0, 60, 0]\n[spec]\npath = {{ max_mm = 5 }}\n"
        )
    };
    for name in ["root", "turned"] {
        fs::write(folder.path().join(format!("{name}.toml")), cell(&format!("{name}.urdf"))).unwrap();
    }
    // Down through the ball, as the root sees it, and as half a turn about z does.
    let script = |x: f64, y: f64, turn: &str| {
        format!(
            "def t():\n  set_tcp(p[0,0,0,0,0,0])\n  movej([0.27,0,0,0,0.9,0], a=1.4, v=1.05)\n  movel(p[{x},{y},0.4,{turn}], a=1.2, v=0.25)\n  \
             movel(p[{x},{y},0.3,{turn}], a=1.2, v=0.25)\nend\nt()\n"
        )
    };
    fs::write(folder.path().join("root.script"), script(0.35, 0.1, "0,3.141592653589793,0")).unwrap();
    fs::write(folder.path().join("turned.script"), script(-0.35, -0.1, "3.141592653589793,0,0")).unwrap();
    for (name, code) in [("root", 1), ("turned", 1)] {
        let (script, cell) = (format!("{name}.script"), format!("{name}.toml"));
        let (found, out, error) = run(folder.path(), &["import", &script, "--check", "--cell", &cell]);
        assert!(found == code && out.contains("the tool meets ball"), "{name}: {found}\n{out}{error}");
    }
    // What is written of the same campaign differs by half a turn, and reads back.
    let written = |name: &str| {
        let (cell, out) = (format!("{name}.toml"), format!("out-{name}"));
        for args in [vec!["generate", &cell, "--out", &out], vec!["export", &out, "--to", "urscript"]] {
            let (code, said, error) = run(folder.path(), &args);
            assert!(code == 0, "{name}: {said}{error}");
        }
        let path = folder.path().join(&out).join("export/0000.script");
        let text = fs::read_to_string(&path).unwrap();
        let (code, said, error) = run(folder.path(), &["import", &path.to_string_lossy(), "--check", "--cell", &cell]);
        assert!(code == 0, "{name}: {said}{error}");
        let first = text.lines().find_map(|line| line.split_once("movel(p[")).expect("a straight move").1.to_owned();
        let mut numbers = first.split(',').map(|number| number.parse::<f64>().unwrap_or(f64::NAN));
        [numbers.next().unwrap(), numbers.next().unwrap()]
    };
    let ([x, y], [turned_x, turned_y]) = (written("root"), written("turned"));
    assert!(
        x.hypot(y) > 0.3 && (x + turned_x).abs().max((y + turned_y).abs()) < 1e-6,
        "{x}, {y}; {turned_x}, {turned_y}"
    );
}
