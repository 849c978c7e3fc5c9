//! A folder that somebody else made is data: nothing in it runs that its user has not allowed, nothing leads out of it,
//! and nothing of the user's own is replaced.

use std::fs;
use std::path::Path;

use crate::commands::{SMALL, copy, hairpin, json, refused, run, small_hull, told};

/// Of the cases that come from elsewhere.
fn hostile(name: &str) -> String {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/hostile");
    format!("{folder}/{name}")
}

/// As [`run`], as another user: one who has run nothing yet.
fn as_another(folder: &Path, arguments: &[&str]) -> (i32, String, String) {
    told(hairpin(folder, arguments).env("XDG_STATE_HOME", folder.join("another")))
}

/// Refused to another user, who is told `what` would have run; and nothing has.
fn asks(folder: &Path, arguments: &[&str], what: &str) {
    let _ = fs::remove_file(folder.join("ran"));
    let (code, out, error) = as_another(folder, arguments);
    assert_eq!(code, 2, "{arguments:?}: {out}{error}");
    for words in [what, "--allow-commands", "is data"] {
        assert!(error.contains(words), "{arguments:?}: {error}");
    }
    assert!(!folder.join("ran").exists(), "{arguments:?} ran it");
    assert!(!folder.join("another").exists(), "asking leaves nothing");
}

#[test]
fn a_repro_file_runs_nothing_unasked() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    fs::copy(hostile("repro-runs-a-command.json"), here.join("r.json")).unwrap();
    let pwned = || here.join("PWNED").exists();
    refused(here, &["replay", "r.json"], &["touch PWNED", "execute.command", "--allow-commands"]);
    fs::create_dir(here.join("repro")).unwrap();
    fs::rename(here.join("r.json"), here.join("repro/r.json")).unwrap();
    for state in ["/dev/null", "", "relative"] {
        let mut command = hairpin(here, &["replay", "repro/r.json"]);
        let (code, _, error) = told(command.env("XDG_STATE_HOME", state).env("HOME", "/dev/null"));
        assert!(code == 2 && error.contains("touch PWNED"), "{error}");
    }
    assert!(!pwned());
    let (code, out, error) = run(here, &["replay", "repro/r.json", "--allow-commands"]);
    assert!(code == 4 && pwned(), "{code} {out}{error}");
    // On that call alone.
    refused(here, &["replay", "repro/r.json"], &["touch PWNED"]);
}

/// A program that flies a metre beside its legs, and leaves a file where it ran.
fn beside(folder: &Path) {
    let minimal = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/executors/minimal_executor.py");
    let text = fs::read_to_string(minimal).unwrap();
    let off = text.replace("for u, v in zip(a, velocity)]", "for u, v in zip(a, velocity)]; position[2] += 1");
    assert_ne!(text, off);
    fs::write(folder.join("beside.py"), format!("open('ran', 'w').close()\n{off}")).unwrap();
}

#[test]
fn what_a_user_has_run_himself_runs_again_and_for_nobody_else() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    beside(here);
    let limit = ["--set", "spec.deviation.max_m=0.5", "--set", "execute.accept_m=3"];
    let few = [&SMALL[..], &["--set", "generate.search.cases=2"]].concat();
    let begun = run(here, &[&few[..], &limit, &["--executor", "python3 beside.py", "--out", "a"]].concat());
    assert!(begun.0 == 1 && !begun.2.contains("asks to"), "what is typed runs: {begun:?}");
    let all: [&[&str]; 6] = [
        &["replay", "a/repro/0000.json"],
        &["shrink", "a", "--case", "0", "--budget", "1"],
        &["generate", "a/scenario.toml", "--out", "b", "--force"],
        &["stress", "a/scenario.toml", "--out", "b", "--force"],
        &["execute", "a", "--resume"],
        &["execute", "a"],
    ];
    for arguments in all {
        asks(here, arguments, "python3 beside.py");
    }
    assert!(!here.join("b").exists());
    for arguments in all {
        let (code, out, error) = run(here, arguments);
        assert!([0, 1].contains(&code) && !error.contains("asks to"), "{arguments:?}: {out}{error}");
        let allowed = [arguments, &["--allow-commands"]].concat();
        let (code, out, error) = as_another(here, &allowed);
        assert!([0, 1].contains(&code), "{allowed:?}: {out}{error}");
        // Campaigns of his own that he begins so are his.
        let _ = fs::remove_dir_all(here.join("another"));
    }
    // What reads and runs nothing asks nothing.
    for arguments in [&["judge", "a"][..], &["report", "a"], &["verify", "a"], &["export", "a", "--to", "waypoints"]] {
        let (code, out, error) = as_another(here, arguments);
        assert!([0, 1].contains(&code), "{arguments:?}: {out}{error}");
    }

    // A choice of its cases is his as well, a copy is not.
    run(here, &["select", "a", "--cases", "1", "--out", "few"]);
    assert_eq!(run(here, &["execute", "few"]).0, 0);
    copy(&here.join("a"), &here.join("copy"));
    refused(here, &["execute", "copy"], &["python3 beside.py", "--allow-commands"]);

    // Another command in its place is noticed; one that is typed is remembered.
    let scenario = here.join("a/scenario.toml");
    let text = fs::read_to_string(&scenario).unwrap();
    fs::write(&scenario, text.replace("python3 beside.py", "touch ran")).unwrap();
    let _ = fs::remove_file(here.join("ran"));
    refused(here, &["execute", "a"], &["touch ran", "--allow-commands"]);
    assert!(!here.join("ran").exists());
    assert_eq!(run(here, &["execute", "a", "--executor", "python3 ./beside.py"]).0, 0);
    assert_eq!(run(here, &["execute", "a"]).0, 0);
}

#[test]
fn a_scenario_file_tells_what_it_runs() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    beside(here);
    let text = small_hull("{ method = \"beam\", waypoints = 60, cases = 2 }");
    let text = text.replace("controller = \"minimum-snap\"", "command = \"python3 beside.py\"");
    fs::write(here.join("q.toml"), text).unwrap();
    let (code, _, error) = run(here, &["generate", "q.toml", "--out", "a"]);
    assert!(code == 0 && error.contains("q.toml asks to run `python3 beside.py` (`execute.command`)"), "{error}");
    assert_eq!(run(here, &["execute", "a"]).0, 0);
    asks(here, &["execute", "a"], "python3 beside.py");
    // Without a place to remember it, each call is asked.
    let homeless =
        |arguments: &[&str]| told(hairpin(here, arguments).env_remove("XDG_STATE_HOME").env("HOME", "/dev/null"));
    assert_eq!(homeless(&["generate", "q.toml", "--out", "b"]).0, 0);
    let (code, _, error) = homeless(&["execute", "b"]);
    assert!(code == 2 && error.contains("--allow-commands"), "{error}");
    assert_eq!(homeless(&["execute", "b", "--allow-commands"]).0, 0);
}

#[test]
fn python_in_a_folder_is_asked_for_and_stands_alone() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let search = "{ method = \"exact\", waypoints = 60, cases = 2 }\nscore = \"python:mine.py\"";
    fs::write(here.join("q.toml"), small_hull(search)).unwrap();
    let score = "import colorsys\nopen('ran', 'w').close()\ndef score(leg):\n    return leg['length_m']\n";
    fs::write(here.join("mine.py"), score).unwrap();
    // Where hairpin is started is no place that Python takes modules from.
    for name in ["json.py", "colorsys.py"] {
        fs::write(here.join(name), "raise SystemExit('of the current folder')\n").unwrap();
    }
    let (code, _, error) = run(here, &["generate", "q.toml", "--out", "a"]);
    assert!(code == 2 && error.contains("of the current folder"), "beside the user's own file they are his: {error}");
    fs::create_dir(here.join("of")).unwrap();
    for name in ["q.toml", "mine.py"] {
        fs::rename(here.join(name), here.join("of").join(name)).unwrap();
    }
    let (code, _, error) = run(here, &["generate", "of/q.toml", "--out", "a"]);
    assert!(code == 0 && error.contains("of/q.toml asks to run the Python file \"python:mine.py\""), "{error}");

    let explain = ["explain", "a/scenario.toml", "--graphs", "1"];
    let again = ["generate", "a/scenario.toml", "--out", "b"];
    asks(here, &explain, "score.py");
    asks(here, &again, "score.py");
    for arguments in [&explain[..], &again] {
        let (code, out, error) = run(here, arguments);
        assert_eq!(code, 0, "{arguments:?}: {out}{error}");
    }
    // Modules that came with the folder are none.
    fs::write(here.join("a/colorsys.py"), "raise SystemExit('of the folder')\n").unwrap();
    assert_eq!(run(here, &explain).0, 0);
    fs::write(here.join("a/score.py"), format!("{score}# edited\n")).unwrap();
    refused(here, &explain, &["score.py", "--allow-commands"]);
    assert_eq!(run(here, &[&explain[..], &["--allow-commands"]].concat()).0, 0);
    // What was executed by hairpin's own controller needs no Python.
    assert_eq!(as_another(here, &["execute", "a"]).0, 0);
}

/// A folder of the user's with files that are called as hairpin's are.
fn of_the_users(folder: &Path, scenario: &str) -> Vec<&'static str> {
    let names = ["results.parquet", "report.html", "0000.mod", "0001-2.csv", "executor-0000-0.log", "thesis.tex"];
    let deep = ["executions/0000-0.parquet", "programs/mine.mod", "missions/0000.csv", "repro/0000.json"];
    fs::create_dir(folder).unwrap();
    fs::write(folder.join("scenario.toml"), scenario).unwrap();
    for name in names.iter().chain(&deep) {
        fs::create_dir_all(folder.join(name).parent().unwrap()).unwrap();
        fs::write(folder.join(name), "mine").unwrap();
    }
    names.into_iter().chain(deep).collect()
}

#[test]
fn a_folder_that_is_not_hairpins_keeps_what_is_in_it() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    json(here, &[&SMALL[..], &["--out", "a"]].concat());
    let resolved = fs::read_to_string(here.join("a/scenario.toml")).unwrap();
    for (name, scenario) in [("plain", "hairpin = 1\nrobot = \"anafi\"\n"), ("copied", &resolved)] {
        let mine = of_the_users(&here.join(name), scenario);
        let before = crate::commands::contents(&here.join(name));
        let out = ["--out", name];
        for arguments in [&[&SMALL[..], &out, &["--force"]].concat(), &[&SMALL[..], &out, &["--resume"]].concat()] {
            refused(here, arguments, &[name, "no .hairpin", "--out"]);
        }
        refused(here, &[&SMALL[..], &out].concat(), &[name]);
        refused(here, &["select", "a", "--cases", "1", "--out", name, "--force"], &["no .hairpin"]);
        refused(here, &["execute", name], &[name]);
        assert!(before == crate::commands::contents(&here.join(name)), "{name} changed");
        for file in mine {
            assert!(here.join(name).join(file).is_file(), "{file}");
        }
    }
    // In a campaign's own folder, files that hairpin has no names for stay.
    let mine = ["a/notes.csv", "a/executions/notes.parquet", "a/repro/mine.json", "a/missions/mine.csv"];
    for name in &mine[..2] {
        fs::write(here.join(name), "mine").unwrap();
    }
    let (code, out, error) = run(here, &[&SMALL[..], &["--out", "a", "--force"]].concat());
    assert!([0, 1].contains(&code), "{out}{error}");
    for name in &mine[..2] {
        assert_eq!(fs::read_to_string(here.join(name)).unwrap(), "mine");
    }
    // One that an earlier version made, or that was copied without its dotted files, is taken over.
    for name in [".hairpin", ".lock"] {
        fs::remove_file(here.join("a").join(name)).unwrap();
    }
    let (code, out, error) = run(here, &["execute", "a"]);
    assert!(code == 0 && here.join("a/.hairpin").is_file(), "{out}{error}");
}

#[test]
fn a_list_names_nothing_outside_its_folder() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    json(here, &[&SMALL[..], &["--out", "a"]].concat());
    let list = fs::read_to_string(here.join("a/.hairpin")).unwrap();
    assert!(list.lines().any(|line| line == "executions/part-PART.parquet"), "{list}");
    fs::write(here.join("victim.parquet"), "mine").unwrap();
    let out = here.join("victim.parquet");
    for name in ["../victim.parquet", out.to_str().unwrap(), "executions/../../victim.parquet"] {
        fs::write(here.join("a/.hairpin"), format!("{list}{name}\n")).unwrap();
        for arguments in [&[&SMALL[..], &["--out", "a", "--force"]].concat()[..], &["execute", "a"], &["report", "a"]] {
            refused(here, arguments, &[".hairpin", "below the folder"]);
        }
    }
    // What the list does not have stays, and is not replaced either.
    let without: String = list.lines().filter(|line| *line != "report.html").map(|line| format!("{line}\n")).collect();
    fs::write(here.join("a/.hairpin"), without).unwrap();
    fs::write(here.join("a/report.html"), "mine").unwrap();
    refused(here, &[&SMALL[..], &["--out", "a", "--force"]].concat(), &["report.html", "not hairpin's"]);
    assert_eq!(fs::read_to_string(here.join("a/report.html")).unwrap(), "mine");
}

#[test]
#[cfg(unix)]
fn links_do_not_lead_out_of_a_folder() {
    use std::os::unix::fs::symlink;
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    json(here, &[&SMALL[..], &["--out", "a"]].concat());
    fs::create_dir(here.join("target")).unwrap();
    fs::write(here.join("target/victim"), "mine").unwrap();
    let links =
        ["report.html", "results.parquet", ".lock", "junit.xml", "executions/part-00000.parquet", "executions", "runs"];
    for (number, name) in links.into_iter().enumerate() {
        let received = format!("r{number}");
        copy(&here.join("a"), &here.join(&received));
        let link = here.join(&received).join(name);
        let is_folder = link.is_dir();
        if is_folder {
            fs::remove_dir_all(&link).unwrap()
        } else {
            fs::remove_file(&link).unwrap()
        }
        symlink(here.join(if is_folder { "target" } else { "target/victim" }), &link).unwrap();
        for command in [&["execute"][..], &["judge"], &["report"], &["verify"], &["export", "--to", "csv"]] {
            refused(here, &[command, &[received.as_str()]].concat(), &[name, "is a link"]);
        }
        for more in ["--force", "--resume"] {
            refused(here, &[&SMALL[..], &["--out", &received, more]].concat(), &[name, "is a link"]);
        }
        assert!(link.is_symlink());
    }
    assert_eq!(fs::read_to_string(here.join("target/victim")).unwrap(), "mine");
    assert_eq!(fs::read_dir(here.join("target")).unwrap().count(), 1);
    // The folder itself may be reached by one.
    symlink(here.join("a"), here.join("latest")).unwrap();
    assert_eq!(run(here, &["report", "latest"]).0, 0);
}

#[test]
fn names_in_a_folder_stay_in_it() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    fs::write(here.join("mine.py"), "def score(leg):\n    return 1\n").unwrap();
    fs::write(here.join("secret"), "the user's own words").unwrap();
    let search = "{ method = \"exact\", waypoints = 60, cases = 2 }\nscore = \"python:mine.py\"";
    fs::write(here.join("q.toml"), small_hull(search)).unwrap();
    json(here, &["generate", "q.toml", "--out", "a"]);
    let scenario = here.join("a/scenario.toml");
    let text = fs::read_to_string(&scenario).unwrap();
    let secret = here.join("secret");
    for name in ["../mine.py", here.join("mine.py").to_str().unwrap()] {
        fs::write(&scenario, text.replace("python:score.py", &format!("python:{name}"))).unwrap();
        for arguments in [&["execute", "a"][..], &["explain", "a/scenario.toml"], &["report", "a"]] {
            refused(here, arguments, &["generate.score", "no `..`"]);
        }
    }
    for name in ["../secret", secret.to_str().unwrap(), "../../../../etc/passwd"] {
        let robot =
            format!("hairpin = 1\nrobot = \"{name}\"\n[made_by]\nversion = \"0\"\nroot_seed = 0\nsimd = \"none\"\n");
        fs::write(&scenario, robot).unwrap();
        let (code, _, error) = run(here, &["verify", "a"]);
        assert!(
            code == 2 && error.contains("no `..`") && !error.contains("own words") && !error.contains("root:"),
            "{error}"
        );
    }
}
