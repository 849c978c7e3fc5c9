//! What is quoted of files: cut where it is long, with its file, not at all where it is nobody's business, and never as
//! a line of its own.

use std::fs;
use std::path::Path;

use crate::commands::{SMALL, copy, refused, run, small_hull};

/// A cell of three hundred kilobytes.
fn long() -> String {
    "9x".repeat(150_000)
}

#[test]
fn a_huge_cell_is_not_echoed() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let long = long();
    let write = |name: &str, text: String| fs::write(here.join(name), text).unwrap();
    fs::create_dir(here.join("mine")).unwrap();
    write("mine/a.csv", format!("x_m,y_m,z_m\n1,2,3\n{long},3,4\n"));
    write("q.csv", format!("id,x,y,yaw,k0,kf\n0,{long},1,0,0,0\n"));
    write("costs.csv", format!(",1\n{long},\n"));
    write("cloud.csv", format!("x_mm,y_mm,z_mm\n300,0,300\n{long},0,300\n"));
    write("header.csv", format!("{long},y_mm,z_mm\n300,0,300\n"));
    write("map.asc", format!("ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2\n3 {long}\n"));
    write("rotors.csv", format!("t_s,rotor1_rad_s,rotor2_rad_s,rotor3_rad_s,rotor4_rad_s\n0,{long},1,1,1\n"));
    write("value.toml", format!("hairpin = 1\nrobot = \"{long}\"\n"));
    write("key.toml", format!("hairpin = 1\n\"{long}\" = 1\n"));
    write("none.toml", format!("hairpin = {long}\n"));
    write("word.toml", small_hull("{ waypoints = 5 }").replace("\"minimum-snap\"", &format!("\"{long}\"")));
    write("repro.json", format!("{{\"hairpin_repro\": \"{long}\"}}"));
    write("robot.toml", format!("kind = \"{long}\"\n"));
    let (code, _, error) = run(here, &["generate", "demo-quadrotor", "--set", "generate.search.cases=1", "--out", "a"]);
    assert_eq!(code, 0, "{error}");
    for arguments in [
        &["execute", "a", "--missions", "mine"][..],
        &["steer", "generic", "--queries", "q.csv"],
        &["max-load", "--graph", "costs.csv"],
        &["max-load", "--cloud", "cloud.csv", "irb120"],
        &["max-load", "--cloud", "header.csv", "irb120"],
        &["show", "terrain", "map.asc"],
        &["simulate", "flightgoggles", "--rotor-speeds", "rotors.csv"],
        &["stress", "value.toml"],
        &["stress", "key.toml"],
        &["stress", "none.toml"],
        &["stress", "word.toml"],
        &["stress", "robot.toml"],
        &["replay", "repro.json"],
    ] {
        let (code, out, error) = run(here, arguments);
        assert_eq!(code, 2, "{arguments:?}: {:.2000}", error);
        assert!(
            !error.is_empty() && error.len() < 9_000 && out.len() < 9_000,
            "{arguments:?}: {} {}",
            error.len(),
            out.len()
        );
        let (_, out, error) = run(here, &[arguments, &["--json"]].concat());
        assert!(error.len() < 9_000 && out.len() < 20_000, "{arguments:?}: {} {}", error.len(), out.len());
    }
    // What is long and read is cut as well.
    write(
        "long.mod",
        format!("MODULE m\nPROC main()\n  {long};\n x{long};\n  MoveJ x{long},v100,fine,tool0;\nENDPROC\nENDMODULE\n"),
    );
    let (_, out, error) = run(here, &["import", "long.mod"]);
    assert!(out.len() < 9_000 && error.len() < 9_000, "{} {}", out.len(), error.len());
    let (_, out, _) = run(here, &["import", "long.mod", "--lines", "--json"]);
    assert!(out.len() < 9_000, "{}", out.len());
}

#[test]
fn what_leads_nowhere_is_told_with_its_file() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    // One rotor alone turns the body ever faster, until its rates are no numbers any more.
    let rows: String = [0, 1, 5, 20].iter().map(|t| format!("{t},1000,0,0,0\n")).collect();
    let header = "t_s,rotor1_rad_s,rotor2_rad_s,rotor3_rad_s,rotor4_rad_s\n";
    fs::write(here.join("spin.csv"), format!("{header}{rows}")).unwrap();
    refused(here, &["simulate", "crazyflie", "--rotor-speeds", "spin.csv"], &["spin.csv", "vx_m_s[3] = NaN"]);
}

#[test]
fn a_file_that_is_no_robot_is_not_shown() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    fs::write(here.join("secret"), "root:x:0:0:root:/root:/bin/bash\n").unwrap();
    fs::create_dir(here.join("guest")).unwrap();
    let scenario = small_hull("{ waypoints = 5 }");
    for (from, to, key) in [
        ("robot = \"flightgoggles\"", "robot = \"../secret\"", "`robot`"),
        ("size_m = [20, 20, 20]", "base = \"../secret\"", "`world.base`"),
    ] {
        assert!(scenario.contains(from));
        fs::write(here.join("guest/q.toml"), scenario.replace(from, to)).unwrap();
        let (code, out, error) = run(here, &["stress", "guest/q.toml", "--json"]);
        assert!(code == 2 && !out.contains("/bin/bash") && !error.contains("/bin/bash"), "{out}{error}");
        assert!(error.contains(key) && error.contains("../secret") && error.contains("line 1"), "{error}");
    }
    // A robot's file that has a slip is shown with a caret, as ever.
    fs::write(here.join("own.toml"), "kind = \"quadrotor\"\nmass_kg = = 1\n").unwrap();
    refused(here, &["stress", "own.toml"], &["own.toml:2", "mass_kg = = 1"]);
}

#[test]
fn a_decoder_that_panics_is_wrong_input() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let (code, _, error) = run(here, &[&SMALL[..], &["--out", "sound"]].concat());
    assert!([0, 1].contains(&code), "{error}");
    let broken = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/contradicting-bytes.parquet");
    for table in ["waypoints.parquet", "results.parquet", "runs/part-00000.parquet"] {
        let out = here.join("a");
        copy(&here.join("sound"), &out);
        assert!(out.join(table).is_file(), "{table}");
        fs::copy(&broken, out.join(table)).unwrap();
        let told = ["judge", "verify", "report"].map(|command| run(here, &[command, "a"]));
        for (code, _, error) in &told {
            assert!(!error.contains("hairpin's own"), "{table}: {error}");
            assert!(*code != 2 || error.contains(table), "{table}: {error}");
        }
        assert!(told.iter().any(|(code, ..)| *code == 2), "{table}: {told:?}");
        fs::remove_dir_all(out).unwrap();
    }
}

#[test]
fn names_of_all_kinds_begin_no_line() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let bad = "x\\nPASS 9\\u001b[2J";
    let clean = |what: &str, text: &str| {
        assert!(!text.contains('\u{1b}'), "{what}: {text}");
        assert!(!text.lines().any(|line| line.starts_with("PASS 9")), "{what}: {text}");
    };
    let file = |path: &str| fs::read_to_string(here.join(path)).unwrap();
    // The robot's name, and those of obstacles and keep-outs.
    let name = format!("robot.name=\"{bad}\"");
    let box_ =
        format!("world.obstacles=[{{ name = \"{bad}\", box = {{ center_m = [15, 15, 4], size_m = [1, 1, 1] }} }}]");
    let typed =
        [&SMALL[..], &["--set", &name, "--set", &box_, "--set", "spec.deviation.max_m=0.01", "--out", "a"]].concat();
    let (code, out, error) = run(here, &typed);
    assert!(code == 1, "{out}{error}");
    clean("stress", &format!("{out}{error}"));
    clean("junit", &file("a/junit.xml"));
    clean("report", &file("a/report.html"));
    for command in [
        &["execute", "a"][..],
        &["judge", "a"],
        &["verify", "a"],
        &["replay", "a/repro/0000.json"],
        &["shrink", "a", "--case", "0", "--budget", "2"],
        &["compare", "a", "a"],
        &["select", "a", "--cases", "1", "--out", "one"],
        &["export", "a", "--to", "tum"],
        &["explain", "a/scenario.toml", "--graphs", "1"],
    ] {
        let (_, out, error) = run(here, command);
        clean(&command.join(" "), &format!("{out}{error}"));
    }
    // Of an arm's cell.
    let cell = format!(
        "hairpin = 1\nrobot = \"irb120\"\n[world]\ntool = {{ radius_mm = 10 }}\n\
         obstacles = [{{ name = \"{bad}\", capsule = {{ a_mm = [200, 60, 300], b_mm = [500, 60, 300], radius_mm = 2 }} }}]\n\
         [task]\npoints = [[350, 0, 400], [350, 100, 400]]\n[spec]\npath = {{ max_mm = 50 }}\n"
    );
    fs::write(here.join("cell.toml"), cell).unwrap();
    let module = "MODULE m\nCONST robtarget p1 := [[350,0,400],[0.70710678,0,0.70710678,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n\
                  CONST robtarget p2 := [[350,120,400],[0.70710678,0,0.70710678,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n\
                  CONST robtarget p3 := [[350,120,300],[0.70710678,0,0.70710678,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n\
                  CONST robtarget p4 := [[350,0,300],[0.70710678,0,0.70710678,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n\
                  PROC main()\nMoveJ p1,v100,fine,tool0;\nMoveL p2,v100,fine,tool0;\nMoveL p3,v100,fine,tool0;\nMoveL p4,v100,fine,tool0;\nENDPROC\nENDMODULE\n";
    fs::write(here.join("m.mod"), module).unwrap();
    for command in [
        &["import", "m.mod", "--check", "--cell", "cell.toml", "--lines"][..],
        &["stress", "cell.toml", "--out", "arm"],
        &["explain", "cell.toml"],
        &["export", "arm", "--to", "rapid"],
        &["verify", "arm"],
    ] {
        let (_, out, error) = run(here, command);
        clean(&command.join(" "), &format!("{out}{error}"));
    }
    // Of missions made elsewhere.
    fs::create_dir(here.join("mine")).unwrap();
    let there = here.join("mine/x\nPASS 9\u{1b}[2J.csv");
    fs::write(&there, "x_m,y_m,z_m\n3,3,3\n3,3,300\n").unwrap();
    let (_, out, error) = run(here, &["execute", "one", "--missions", "mine"]);
    clean("missions", &format!("{out}{error}"));
    fs::write(&there, "x_m,y_m,z_m\n3,3,3\n3,three,300\n").unwrap();
    let (_, out, error) = run(here, &["execute", "one", "--missions", "mine"]);
    clean("broken missions", &format!("{out}{error}"));
}
