//! What can be typed: help of every command, wrong input with exit code 2 and clear words, nothing but results on
//! stdout.

use std::fs;

use assert_cmd::Command;

fn hairpin() -> Command {
    let mut command = Command::cargo_bin("hairpin").expect("the binary is built with its tests");
    command.env_remove("NO_COLOR");
    command
}

/// Runs in `folder`; exit code, stdout, stderr.
fn run(folder: &std::path::Path, arguments: &[&str]) -> (i32, String, String) {
    let output = hairpin().current_dir(folder).args(arguments).output().unwrap();
    let text = |bytes| String::from_utf8(bytes).expect("UTF-8");
    (output.status.code().expect("no signal"), text(output.stdout), text(output.stderr))
}

#[test]
fn every_listed_command_has_help() {
    let folder = tempfile::tempdir().unwrap();
    let (code, help, _) = run(folder.path(), &["--help"]);
    assert_eq!(code, 0);
    let listed: Vec<&str> = help
        .lines()
        .skip_while(|line| !line.starts_with("Commands:"))
        .skip(1)
        .take_while(|line| !line.trim().is_empty())
        .filter_map(|line| line.strip_prefix("  ")?.split_whitespace().next().filter(|_| !line.starts_with("   ")))
        .collect();
    for name in ["demo", "new", "stress", "generate", "execute", "judge", "verify", "replay", "export", "report"] {
        assert!(listed.contains(&name), "{name} is not in {listed:?}");
    }
    for name in listed.iter().filter(|name| **name != "help") {
        let (code, help, error) = run(folder.path(), &[name, "--help"]);
        assert!(code == 0 && help.contains("Usage: hairpin") && error.is_empty(), "{name}: {code} {error}");
    }
}

#[test]
fn wrong_input_is_2_and_says_what_to_do() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("broken.toml"), "hairpin = 1\nrobot = \"anafi\"\n[task]\nlenght = 3\n").unwrap();
    fs::write(folder.path().join("empty.toml"), "").unwrap();
    for (arguments, told) in [
        (vec!["strees"], "unrecognized subcommand"),
        (vec!["stress"], "<SCENARIO>"),
        (vec!["stress", "no-such.toml"], "no-such.toml"),
        (vec!["stress", "broken.toml"], "lenght"),
        (vec!["stress", "empty.toml"], "Error: empty.toml: `robot` is missing"),
        (vec!["stress", "demo-quadrotor", "--threads", "0"], "--threads"),
        (vec!["stress", "demo-quadrotor", "--threads", "65535"], "1..=1024"),
        (vec!["stress", "demo-quadrotor", "--seed", "-1"], "invalid value '-1' for '--seed <N>'"),
        (vec!["stress", "demo-quadrotor", "--seed", "18446744073709551615"], "0..=9223372036854775807"),
        (vec!["stress", "demo-quadrotor", "--time-limit", "-1"], "--time-limit"),
        (vec!["stress", "demo-quadrotor", "--set", "execute.repeat"], "KEY=VALUE"),
        (vec!["stress", "demo-quadrotor", "--set", "execute.repaet=2"], "repeat"),
        (vec!["stress", "demo-quadrotor", "--resume", "--force"], "cannot be used with"),
        (vec!["stress", "demo-quadrotor", "--executor", "python 'x"], "quote"),
        (vec!["judge", "nowhere"], "not a campaign folder"),
        (vec!["verify", "nowhere"], "not a campaign folder"),
        (vec!["replay", "nowhere.json"], "nowhere.json"),
        (vec!["replay", "broken.toml"], "no repro file"),
        (vec!["export", "nowhere", "--to", "waypoints,plan9"], "plan9"),
        (vec!["bench", "no-such"], "beam-expansions"),
        (vec!["simulate", "anafi", "--rotor-speeds", "none.csv"], "none.csv"),
    ] {
        let (code, out, error) = run(folder.path(), &arguments);
        assert_eq!(code, 2, "{arguments:?}: {out}{error}");
        assert!(error.contains(told), "{arguments:?} should mention {told}: {error}");
        assert!(out.is_empty(), "{arguments:?} wrote to stdout: {out}");
        assert!(!error.contains('\u{1b}'), "colour where nobody looks: {error:?}");
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2, "a mistake must leave nothing behind");
}

#[test]
fn mistakes_are_an_object_for_machines() {
    let folder = tempfile::tempdir().unwrap();
    let (code, out, _) = run(folder.path(), &["stress", "demo-quadrotor", "--set", "execute.repeat=-1", "--json"]);
    let object: serde_json::Value = serde_json::from_str(&out).unwrap();
    assert_eq!((code, object["exit_code"].as_i64()), (2, Some(2)));
    assert_eq!(object["mistakes"][0]["field"], "execute.repeat");
}

#[test]
fn new_writes_once_and_what_it_writes_is_a_scenario() {
    let folder = tempfile::tempdir().unwrap();
    let (code, out, _) = run(folder.path(), &["new", "quadrotor"]);
    assert!(code == 0 && out.contains("hairpin stress quadrotor.toml"));
    let file = folder.path().join("quadrotor.toml");
    let text = fs::read_to_string(&file).unwrap();
    assert!(text.matches('#').count() > 10, "it must be commented");
    fs::write(&file, "mine").unwrap();
    let (code, _, error) = run(folder.path(), &["new", "quadrotor"]);
    assert!(code == 2 && error.contains("--force"), "{error}");
    assert_eq!(fs::read_to_string(&file).unwrap(), "mine");
    assert_eq!(run(folder.path(), &["new", "quadrotor", "--force"]).0, 0);
    assert_eq!(fs::read_to_string(&file).unwrap(), text);
}

#[test]
fn schemas_and_completions_are_printed() {
    let folder = tempfile::tempdir().unwrap();
    for (document, key) in [("scenario", "generate"), ("robot", "mass_kg"), ("arm", "joints")] {
        let (code, out, _) = run(folder.path(), &["schema", document]);
        let schema: serde_json::Value = serde_json::from_str(&out).unwrap();
        assert!(code == 0 && schema["properties"][key].is_object(), "{document}");
    }
    let (code, out, _) = run(folder.path(), &["schema", "--kind", "boat"]);
    assert!(code == 0 && out.contains("BoatDescription"), "{out}");
    let (code, _, error) = run(folder.path(), &["schema", "--kind", "ship"]);
    assert!(code == 2 && error.contains("--kind ship: must be one of quadrotor, "), "{error}");
    for shell in ["bash", "zsh", "fish"] {
        let (code, out, _) = run(folder.path(), &["completions", shell]);
        assert!(code == 0 && out.contains("stress"));
    }
}

#[test]
fn a_reader_that_goes_away_is_no_mistake() {
    let folder = tempfile::tempdir().unwrap();
    let binary = env!("CARGO_BIN_EXE_hairpin");
    let script = format!("'{binary}' schema | head -c 10 >/dev/null; echo ${{PIPESTATUS[0]}}");
    let output = std::process::Command::new("bash").args(["-c", &script]).current_dir(folder.path()).output().unwrap();
    assert_eq!(String::from_utf8_lossy(&output.stdout).trim(), "0");
    assert!(output.stderr.is_empty(), "{}", String::from_utf8_lossy(&output.stderr));
}
