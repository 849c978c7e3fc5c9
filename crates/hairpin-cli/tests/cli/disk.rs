//! Places that take no files: wrong input with the path and the system's reason, and what stood there before still
//! stands.
#![cfg(unix)]

use std::fs;
use std::os::unix::fs::FileTypeExt;
use std::path::Path;
use std::process::Command;

use crate::commands::{SMALL, assert_same, copy, json, refused, run, without_baseline};

#[test]
fn a_folder_that_cannot_be_written_is_wrong_input() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("file"), "").unwrap();
    refused(folder.path(), &[&SMALL[..], &["--out", "file/inside"]].concat(), &["file/inside", "Not a directory"]);
    fs::create_dir(folder.path().join("mine")).unwrap();
    fs::write(folder.path().join("mine/thesis.txt"), "years").unwrap();
    refused(folder.path(), &[&SMALL[..], &["--out", "mine", "--force"]].concat(), &["mine", "not a campaign folder"]);
    assert!(folder.path().join("mine/thesis.txt").is_file());
}

/// Runs where no file may grow beyond `blocks` of 512 bytes: a full disk, as any user can have one. The signal
/// that comes with it ends nothing.
fn cramped(folder: &Path, blocks: usize, arguments: &[&str]) -> (Option<i32>, String) {
    let script = format!("ulimit -f {blocks}; exec \"$@\"");
    let mut shell = Command::new("sh");
    shell
        .current_dir(folder)
        .args(["-c", &script, "sh", env!("CARGO_BIN_EXE_hairpin")])
        .args(without_baseline(arguments));
    let output = shell.output().unwrap();
    (output.status.code(), String::from_utf8(output.stderr).unwrap())
}

#[test]
fn a_full_disk_is_told_and_costs_no_file_that_was_whole() {
    let folder = tempfile::tempdir().unwrap();
    run(folder.path(), &[&SMALL[..], &["--out", "calm"]].concat());
    let (calm, full) = (folder.path().join("calm"), folder.path().join("full"));
    copy(&calm, &full);
    for arguments in [
        &["execute", "full"][..],
        &["execute", "full", "--resume"],
        &["judge", "full"],
        &["report", "full"],
        &["export", "full", "--to", "waypoints"],
        &["export", "full", "--to", "csv"],
        &["export", "full", "--to", "tum"],
        &["new", "quadrotor"],
        &["demo"],
        &[&SMALL[..], &["--out", "full", "--resume"]].concat(),
        &[&SMALL[..], &["--out", "elsewhere"]].concat(),
    ] {
        let (code, error) = cramped(folder.path(), 0, arguments);
        assert_eq!(code, Some(74), "{arguments:?}: {error}");
        assert!(error.contains("cannot write ") && error.contains("File too large"), "{arguments:?}: {error}");
    }
    assert!(!folder.path().join("quadrotor.toml").exists());
    assert_same(&calm, &full);
    assert_eq!(fs::read(calm.join("report.html")).unwrap(), fs::read(full.join("report.html")).unwrap());
}

/// It fills up amid a campaign: tables of trajectories still fit, the report and some others do not.
#[test]
fn a_disk_that_fills_up_leaves_a_campaign_that_goes_on() {
    let folder = tempfile::tempdir().unwrap();
    run(folder.path(), &[&SMALL[..], &["--out", "calm"]].concat());
    let mut kept = Vec::new();
    for blocks in [4, 60, 400] {
        let arguments = [&SMALL[..], &["--out", "full", "--resume"]].concat();
        let (code, error) = cramped(folder.path(), blocks, &arguments);
        assert_eq!(code, Some(74), "{blocks} blocks: {error}");
        assert!(error.contains("cannot write full/") && error.contains("File too large"), "{blocks} blocks: {error}");
        kept.push(error);
    }
    kept.dedup();
    assert!(kept.len() > 1, "it always fails at the same file: {kept:?}");
    let (code, _, error) = run(folder.path(), &[&SMALL[..], &["--out", "full", "--resume"]].concat());
    assert_eq!(code, run(folder.path(), &["judge", "calm"]).0, "{error}");
    assert_same(&folder.path().join("calm"), &folder.path().join("full"));
}

#[test]
fn what_is_no_file_is_written_to_and_never_replaced() {
    let folder = tempfile::tempdir().unwrap();
    let speeds = "t_s,rotor1_rad_s,rotor2_rad_s,rotor3_rad_s,rotor4_rad_s\n0,900,900,900,900\n0.1,900,900,900,900\n";
    fs::write(folder.path().join("speeds.csv"), speeds).unwrap();
    let simulate = ["simulate", "flightgoggles", "--rotor-speeds", "speeds.csv", "--out"];
    assert_eq!(run(folder.path(), &[&simulate[..], &["file.csv"]].concat()).0, 0);
    let expected = fs::read(folder.path().join("file.csv")).unwrap();

    let pipe = folder.path().join("pipe");
    assert!(Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    let reader = {
        let pipe = pipe.clone();
        std::thread::spawn(move || fs::read(pipe).unwrap())
    };
    assert_eq!(run(folder.path(), &[&simulate[..], &["pipe"]].concat()).0, 0);
    assert!(fs::metadata(&pipe).unwrap().file_type().is_fifo(), "the pipe is gone");
    assert_eq!(reader.join().unwrap(), expected);

    fs::create_dir(folder.path().join("far")).unwrap();
    fs::write(folder.path().join("far/target.csv"), "old").unwrap();
    std::os::unix::fs::symlink("far/target.csv", folder.path().join("link.csv")).unwrap();
    assert_eq!(run(folder.path(), &[&simulate[..], &["link.csv"]].concat()).0, 0);
    assert!(fs::symlink_metadata(folder.path().join("link.csv")).unwrap().is_symlink(), "the link is gone");
    assert_eq!(fs::read(folder.path().join("far/target.csv")).unwrap(), expected);

    if cfg!(target_os = "linux") {
        let (code, _, error) = run(folder.path(), &[&simulate[..], &["/dev/full"]].concat());
        assert!(code == 74 && error.contains("cannot write /dev/full: No space left"), "{code:?}: {error}");
        assert!(fs::metadata("/dev/full").unwrap().file_type().is_char_device());
    }
}

#[test]
fn a_folder_in_the_place_of_a_file_is_told() {
    let folder = tempfile::tempdir().unwrap();
    run(folder.path(), &[&SMALL[..], &["--out", "calm"]].concat());
    for (file, command) in [
        ("results.parquet", &["judge", "a"][..]),
        ("junit.xml", &["judge", "a"]),
        ("report.html", &["report", "a"]),
        ("executions/part-00000.parquet", &["execute", "a"]),
        ("export/0002.csv", &["export", "a", "--to", "waypoints"]),
        (".lock", &["judge", "a"]),
    ] {
        let broken = folder.path().join("a");
        copy(&folder.path().join("calm"), &broken);
        let _ = fs::remove_file(broken.join(file));
        fs::create_dir_all(broken.join(file)).unwrap();
        refused(folder.path(), command, &[&format!("a/{file}"), "irectory"]);
        fs::remove_dir_all(broken).unwrap();
    }
    assert_eq!(json(folder.path(), &["verify", "calm"])["checked"], 4);
}

/// Runs with stdout at `place`; the exit code and stderr.
fn poured(folder: &Path, place: &str, arguments: &[&str]) -> (Option<i32>, String) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_hairpin"));
    let stdout = fs::OpenOptions::new().write(true).open(place).unwrap();
    let output = command.current_dir(folder).args(arguments).stdout(stdout).output().unwrap();
    (output.status.code(), String::from_utf8(output.stderr).unwrap())
}

#[test]
#[cfg(target_os = "linux")]
fn results_that_do_not_get_to_stdout_are_told() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("queries.csv"), "id,x,y,yaw,k0,kf\n0,4,1,0.5,0,0\n1,5,0,0,0,0\n").unwrap();
    fs::write(folder.path().join("costs.csv"), "0,1,2\n1,0,3\n2,3,0\n").unwrap();
    run(folder.path(), &[&SMALL[..], &["--out", "calm"]].concat());
    for arguments in [
        &["schema", "scenario"][..],
        &["steer", "generic", "--queries", "queries.csv"],
        &["steer", "generic", "--to", "4,1,0.5"],
        &["max-load", "--graph", "costs.csv"],
        &["judge", "calm"],
        &["judge", "calm", "--json"],
        &["completions", "bash"],
    ] {
        let (code, error) = poured(folder.path(), "/dev/full", arguments);
        assert!(code == Some(74) && error.contains("stdout: No space left"), "{arguments:?}: {code:?}: {error}");
    }
    // Nobody listens, and nothing is lost.
    assert_eq!(poured(folder.path(), "/dev/null", &["schema", "scenario"]).0, Some(0));
}
