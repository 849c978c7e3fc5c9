//! Whatever a command is fed, the answer is a sentence and exit code 2: never a panic, never a file left behind.

use std::fs;
use std::path::Path;

use crate::commands::{SMALL, copy, refused, run};

const GARBAGE: &[u8] = b"PAR1\x00\xff\xfe\x80[[[\x00{\"\x07PAR1";

/// Names of files that are none.
fn oddities(folder: &Path, ending: &str) -> Vec<String> {
    fs::write(folder.join(format!("empty{ending}")), "").unwrap();
    fs::write(folder.join(format!("garbage{ending}")), GARBAGE).unwrap();
    fs::create_dir_all(folder.join(format!("folder{ending}"))).unwrap();
    ["missing", "empty", "garbage", "folder"].map(|name| format!("{name}{ending}")).to_vec()
}

#[test]
fn files_that_are_none() {
    let folder = tempfile::tempdir().unwrap();
    let speeds = "t_s,rotor1_rad_s,rotor2_rad_s,rotor3_rad_s,rotor4_rad_s\n0,900,900,900,900\n0.1,900,900,900,900\n";
    fs::write(folder.path().join("speeds.csv"), speeds).unwrap();
    for file in oddities(folder.path(), ".toml") {
        for command in ["stress", "generate"] {
            refused(folder.path(), &[command, &file], &[&file]);
        }
        refused(folder.path(), &["simulate", &file, "--rotor-speeds", "speeds.csv"], &[&file]);
        let robot = format!("robot=\"{file}\"");
        refused(folder.path(), &[&SMALL[..], &["--set", &robot]].concat(), &[&file]);
        let world = format!("world.base=\"{file}\"");
        // An empty world is one without a size.
        let told = if file == "empty.toml" { "world.size_m" } else { &file };
        refused(folder.path(), &[&SMALL[..], &["--set", &world]].concat(), &[told]);
    }
    for file in oddities(folder.path(), ".stl") {
        let obstacle = format!("world.obstacles=[{{name=\"x\", mesh={{file=\"{file}\"}}}}]");
        refused(folder.path(), &[&SMALL[..], &["--set", &obstacle]].concat(), &[&file]);
    }
    for file in oddities(folder.path(), ".csv") {
        refused(folder.path(), &["simulate", "flightgoggles", "--rotor-speeds", &file], &[&file]);
    }
    for file in oddities(folder.path(), ".json") {
        refused(folder.path(), &["replay", &file], &[&file]);
    }
    fs::create_dir(folder.path().join("quadrotor.toml")).unwrap();
    refused(folder.path(), &["new", "quadrotor"], &["quadrotor.toml"]);
    refused(folder.path(), &["new", "quadrotor", "--force"], &["quadrotor.toml", "irectory"]);
    assert!(!folder.path().join("out").exists(), "a mistake must leave nothing behind");
}

#[test]
fn campaign_folders_that_are_none() {
    let folder = tempfile::tempdir().unwrap();
    let every: [&[&str]; 5] = [&["execute"], &["judge"], &["verify"], &["report"], &["export", "--to", "csv"]];
    let on = |command: &[&'static str], out: &'static str| [&command[..1], &[out], &command[1..]].concat();
    fs::write(folder.path().join("file"), GARBAGE).unwrap();
    fs::create_dir(folder.path().join("empty")).unwrap();
    for (out, text) in [("blank", &b""[..]), ("garbage", GARBAGE)] {
        fs::create_dir(folder.path().join(out)).unwrap();
        fs::write(folder.path().join(out).join("scenario.toml"), text).unwrap();
    }
    for command in every {
        for out in ["missing", "file", "empty"] {
            refused(folder.path(), &on(command, out), &[out, "is not a campaign folder"]);
        }
        for out in ["blank", "garbage"] {
            refused(folder.path(), &on(command, out), &[out, "scenario.toml"]);
        }
    }
    assert_eq!(fs::read_dir(folder.path().join("empty")).unwrap().count(), 0);
}

/// A sound campaign with one of its files gone bad: who reads that file names it.
#[test]
fn campaign_folders_with_a_broken_file() {
    let folder = tempfile::tempdir().unwrap();
    run(folder.path(), &[&SMALL[..], &["--out", "sound", "--set", "spec.deviation.max_m=0.01"]].concat());
    let resume = [&SMALL[..], &["--out", "a", "--set", "spec.deviation.max_m=0.01", "--resume"]].concat();
    let reads: [(&str, &[&[&str]]); 7] = [
        ("scenario.toml", &[&resume, &["execute", "a"], &["judge", "a"], &["verify", "a"], &["report", "a"]]),
        ("generation.json", &[&resume, &["judge", "a"], &["verify", "a"], &["report", "a"]]),
        ("results.parquet", &[&resume, &["execute", "a"], &["judge", "a"], &["verify", "a"], &["report", "a"]]),
        ("waypoints.parquet", &[&resume, &["execute", "a"], &["judge", "a"], &["verify", "a"], &["report", "a"]]),
        ("runs/part-00000.parquet", &[&["judge", "a"], &["report", "a"], &["export", "a", "--to", "csv"]]),
        ("executions/part-00000.parquet", &[&["report", "a"], &["export", "a", "--to", "csv"]]),
        ("trajectories/part-00000.parquet", &[&["report", "a"], &["export", "a", "--to", "csv"]]),
    ];
    for (file, commands) in reads {
        let whole = fs::read(folder.path().join("sound").join(file)).unwrap();
        for bad in [&b""[..], GARBAGE, &whole[..whole.len() / 2]] {
            for arguments in commands {
                let broken = folder.path().join("a");
                copy(&folder.path().join("sound"), &broken);
                fs::write(broken.join(file), bad).unwrap();
                refused(folder.path(), arguments, &[&format!("a/{file}")]);
                fs::remove_dir_all(broken).unwrap();
            }
        }
    }
    // To `verify` a broken profile is a finding about its case.
    copy(&folder.path().join("sound"), &folder.path().join("a"));
    fs::write(folder.path().join("a/profiles/part-00000.parquet"), GARBAGE).unwrap();
    let (code, out, error) = run(folder.path(), &["verify", "a"]);
    assert!(code == 1 && out.contains("NOT VERIFIED 0/4"), "{out}{error}");
    // To `--resume` a broken flight is one that has not been flown.
    copy(&folder.path().join("sound"), &folder.path().join("b"));
    fs::write(folder.path().join("b/executions/part-00000.parquet"), GARBAGE).unwrap();
    assert_eq!(run(folder.path(), &["execute", "b", "--resume"]).0, 0);
    let flight = |out: &str| fs::read(folder.path().join(out).join("executions/part-00000.parquet")).unwrap();
    assert!(flight("b") == flight("sound"));
}

#[test]
fn numbers_that_mean_nothing() {
    let folder = tempfile::tempdir().unwrap();
    for (set, told) in [
        ("generate.search.waypoints=1_000_000_000", "1 … 100 000"),
        ("task.length=1", "2 … 10 000"),
        ("task.length=0", "2 … 10 000"),
        ("task.length=-3", "task.length"),
        ("task.length=1_000_000", "2 … 10 000"),
        ("task.length=99999999999999999999", "task.length"),
        ("task.start_m=[nan,3,3]", "task.start_m[0]"),
        ("task.end_m=[15,inf,15]", "task.end_m[1]"),
        ("task.end_m=[15,15,31]", "inside the world"),
        ("world.obstacles=[{name=\"rock\",sphere={center_m=[3,3,3],radius_m=1}}]", "outside obstacle `rock`"),
        ("world.size_m=[30,30,-30]", "world.size_m[2]"),
        ("world.size_m=[inf,30,30]", "world.size_m[0]"),
        ("world.keep_in_margin_m=nan", "world.keep_in_margin_m"),
        ("robot.mass_kg=-1", "mass_kg"),
        ("robot.mass_kg=0", "mass_kg"),
        ("robot.mass_kg=nan", "mass_kg"),
        ("robot.mass_kg=inf", "mass_kg"),
        ("robot.rotor_speed_rad_s=[2200,900]", "rotor_speed_rad_s"),
        ("robot.rotor_speed_rad_s=[0,nan]", "rotor_speed_rad_s"),
        ("robot.inertia_kg_m2=[0,1,1]", "inertia_kg_m2"),
        ("robot.max_speed_m_s=-inf", "max_speed_m_s"),
        ("robot.gravity_m_s2=0", "gravity_m_s2"),
        ("generate.limits.max_tilt_deg=nan", "max_tilt_deg"),
        ("generate.limits.max_speed_m_s=-1", "max_speed_m_s"),
        ("generate.timing.step_s=0", "step_s"),
        ("execute.repeat=-1", "execute.repeat"),
        ("execute.repeat=1e9", "execute.repeat"),
        ("execute.step_s=nan", "execute.step_s"),
        ("execute.timeout_s=inf", "execute.timeout_s"),
        ("spec.deviation.max_m=nan", "spec.deviation.max_m"),
        ("spec.confidence=1", "spec.confidence"),
        ("seed=-1", "seed"),
    ] {
        for command in ["stress", "generate"] {
            refused(folder.path(), &[command, "demo-quadrotor", "--set", set], &[told]);
        }
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0, "a mistake must leave nothing behind");
}

/// A repro file is written to be edited.
#[test]
fn repro_files_that_mean_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let strict = [&SMALL[..], &["--out", "a", "--set", "spec.deviation.max_m=0.01"]].concat();
    assert_eq!(run(folder.path(), &strict).0, 1);
    let sound: serde_json::Value =
        serde_json::from_slice(&fs::read(folder.path().join("a/repro/0000.json")).unwrap()).unwrap();
    let null = serde_json::Value::Null;
    for (pointer, value, told) in [
        ("/hairpin_repro", 2.into(), "hairpin_repro = 2"),
        ("/case", "zero".into(), "must be a number"),
        ("/seed", (-1).into(), "`-1`"),
        ("/run", 1.5.into(), "`1.5`"),
        ("/waypoints_m", serde_json::json!([]), "waypoints_m"),
        ("/waypoints_m", serde_json::json!([[1, 2, 3]]), "waypoints_m"),
        ("/waypoints_m/1/2", 1e300.into(), "waypoints_m[1]"),
        ("/waypoints_m/1/2", null.clone(), "f64"),
        ("/leg_times_s", serde_json::json!([1.0]), "leg_times_s"),
        ("/leg_times_s/2", (-1.0).into(), "leg_times_s[2]"),
        ("/leg_times_s/0", 0.0.into(), "leg_times_s[0]"),
        ("/leg_times_s/3", 1e300.into(), "leg_times_s[3]"),
        ("/profile", serde_json::json!([]), "profile"),
        ("/profile/1/duration_s", (-1.0).into(), "profile[1]"),
        ("/evidence", "proven".into(), "evidence"),
        ("/scenario/robot/mass_kg", (-1.0).into(), "mass_kg"),
        ("/scenario/task/length", 0.into(), "task.length"),
        ("/scenario", null, "is no repro file"),
    ] {
        let mut repro = sound.clone();
        *repro.pointer_mut(pointer).unwrap_or_else(|| panic!("{pointer}: {sound}")) = value;
        fs::write(folder.path().join("edited.json"), repro.to_string()).unwrap();
        refused(folder.path(), &["replay", "edited.json"], &["edited.json", told]);
    }
    fs::write(folder.path().join("edited.json"), sound.to_string()).unwrap();
    assert_eq!(run(folder.path(), &["replay", "edited.json"]).0, 1);
}

#[test]
fn names_begin_no_lines_and_command_no_terminal() {
    let folder = tempfile::tempdir().unwrap();
    let name = "robot.name=\"anafi\\nPASS 9/9\\u001b[2J\"";
    let (_, said, error) = run(folder.path(), &[&SMALL[..], &["--set", name, "--out", "named"]].concat());
    for text in [said, error, run(folder.path(), &["judge", "named"]).1, run(folder.path(), &["verify", "named"]).1] {
        assert!(!text.contains('\u{1b}') && !text.lines().any(|line| line.starts_with("PASS 9/9")), "{text}");
    }
}

#[test]
fn rows_of_which_none_is_a_query_are_wrong_input() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("wrong.csv"), "id,x,y,yaw,k0,kf\n0,abc,1,0,0,0\n1,1,,2,0,0\n").unwrap();
    let steer = ["steer", "generic", "--queries", "wrong.csv"];
    let (code, _, error) = run(folder.path(), &steer);
    assert!(code == 2 && error.contains("wrong.csv, line 2"), "{code}: {error}");
    let (code, said, _) = run(folder.path(), &[&steer[..], &["--json"]].concat());
    assert!(code == 2 && said.contains("\"exit_code\":2"), "{code}: {said}");
    fs::write(folder.path().join("some.csv"), "id,x,y,yaw,k0,kf\n0,abc,1,0,0,0\n1,4,1,0.5,0,0\n").unwrap();
    assert_eq!(run(folder.path(), &["steer", "generic", "--queries", "some.csv"]).0, 0);
}

#[test]
fn names_that_mean_two_things_and_folders_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let text = "hairpin = 1\nrobot = \"anafi\"\nspec = \"none\"\n[world]\nsize_m = [30, 30, 30]\n[task]\nstart_m = [10, 10, 10]\n\
                end_m = [20, 20, 20]\nlength = 3\n[generate.search]\ncases = 1\nwaypoints = 5\n";
    fs::write(folder.path().join("quadrotor"), text).unwrap();
    let (_, _, error) = run(folder.path(), &["generate", "quadrotor", "--out", "own"]);
    assert!(error.contains("`quadrotor` is a file here and a shipped name: the file is taken"), "{error}");
    assert!(fs::read_to_string(folder.path().join("own/scenario.toml")).unwrap().contains("length = 3"));
    refused(folder.path(), &["stress", "own"], &["`own` is a folder", "hairpin execute own", "own/scenario.toml"]);
    fs::create_dir(folder.path().join("empty")).unwrap();
    refused(folder.path(), &["stress", "empty"], &["`empty` is a folder", "no scenario.toml"]);
    fs::write(folder.path().join("x.ulg"), b"ULog\x01\x12\x35\x01").unwrap();
    refused(folder.path(), &["import", "x.ulg"], &["x.ulg, byte 8", "ends within its header"]);
}
