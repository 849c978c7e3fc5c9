//! The binary, run as a user does, and what it leaves.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::Command;

use serde_json::Value;

pub(crate) const SMALL: [&str; 6] =
    ["stress", "demo-quadrotor", "--set", "generate.search.cases=4", "--set", "execute.repeat=1"];

/// Small graphs of hull legs, flown by minimum snap; `search` is that key of `[generate]`, and what else stands there.
pub(crate) fn small_hull(search: &str) -> String {
    format!(
        r#"
hairpin = 1
robot = "flightgoggles"
seed = 3
[world]
size_m = [20, 20, 20]
[task]
start_m = [2, 2, 5]
end_m = [14, 14, 12]
length = 5
[generate]
reach = "hull"
timing = {{ step_s = 1.0 }}
search = {search}
[execute]
controller = "minimum-snap"
[spec]
deviation = {{ max_m = 0.5, from = "nearest-leg" }}
"#
    )
}

/// As they were typed; campaigns that say nothing of cases by chance have none, for what other tests count and compare.
pub(crate) fn without_baseline<'a>(arguments: &[&'a str]) -> Vec<&'a str> {
    let searches = matches!(arguments.first(), Some(&("stress" | "generate")));
    let says = arguments.iter().any(|argument| argument.contains("execute.baseline"));
    let none: &[&str] = if searches && !says { &["--set", "execute.baseline=0"] } else { &[] };
    [arguments, none].concat()
}

pub(crate) fn hairpin(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_hairpin"));
    // Marks of what a user has run himself belong to this test's user.
    command.current_dir(folder).args(without_baseline(arguments)).env("XDG_STATE_HOME", folder.join(".state"));
    command
}

/// Exit code, stdout, stderr.
pub(crate) fn run(folder: &Path, arguments: &[&str]) -> (i32, String, String) {
    told(&mut hairpin(folder, arguments))
}

/// The same of a command that is ready to run.
pub(crate) fn told(command: &mut Command) -> (i32, String, String) {
    let output = command.output().unwrap();
    let text = |bytes| String::from_utf8(bytes).expect("UTF-8");
    (output.status.code().expect("no signal"), text(output.stdout), text(output.stderr))
}

pub(crate) fn json(folder: &Path, arguments: &[&str]) -> Value {
    let arguments = [arguments, &["--json"]].concat();
    let (code, out, error) = run(folder, &arguments);
    let object: Value = serde_json::from_str(&out).unwrap_or_else(|e| panic!("{e}: {out}{error}"));
    assert_eq!(object["exit_code"].as_i64(), Some(code.into()), "{object}");
    object
}

/// Every file that must not depend on clock, threads or place, with its bytes.
pub(crate) fn contents(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut all = BTreeMap::new();
    let mut open = vec![folder.to_path_buf()];
    while let Some(place) = open.pop() {
        for entry in fs::read_dir(place).unwrap() {
            let path = entry.unwrap().path();
            let name = path.strip_prefix(folder).unwrap().to_string_lossy().into_owned();
            if path.is_dir() {
                open.push(path);
            } else if !["report.html", "junit.xml", ".lock"].contains(&name.as_str()) && !name.ends_with(".log") {
                all.insert(name, fs::read(path).unwrap());
            }
        }
    }
    all
}

pub(crate) fn assert_same(a: &Path, b: &Path) {
    let (a, b) = (contents(a), contents(b));
    assert_eq!(a.keys().collect::<Vec<_>>(), b.keys().collect::<Vec<_>>());
    for (name, bytes) in &a {
        assert!(b[name] == *bytes, "{name} differs");
    }
}

/// Runs, and expects a refusal: exit code 2 with every one of `words` in a message on stderr, and nothing on stdout.
pub(crate) fn refused(folder: &Path, arguments: &[&str], words: &[&str]) {
    let (code, out, error) = run(folder, arguments);
    assert_eq!(code, 2, "{arguments:?}: {out}{error}");
    assert!(out.is_empty(), "{arguments:?} wrote to stdout: {out}");
    assert!(!error.contains("hairpin's own"), "{arguments:?}: {error}");
    for word in words {
        assert!(error.contains(word), "{arguments:?} should mention {word:?}: {error}");
    }
}

/// A copy of a folder and all that is in it.
pub(crate) fn copy(from: &Path, to: &Path) {
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(from).unwrap() {
        let path = entry.unwrap().path();
        let there = to.join(path.file_name().unwrap());
        if path.is_dir() {
            copy(&path, &there);
        } else {
            fs::copy(&path, &there).unwrap();
        }
    }
}
