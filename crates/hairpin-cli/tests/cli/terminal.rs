//! What a user sees who sits at a terminal, and what stands in a log where nobody does.

use std::fs;
use std::path::Path;

use crate::commands::{SMALL, run, told, without_baseline};

/// Runs hairpin at a terminal of so many columns: exit code, and what is seen of stdout and stderr together.
fn seen(here: &Path, columns: usize, environment: &[(&str, &str)], arguments: &[&str]) -> (i32, String) {
    const PTY: &str = "\
import fcntl, os, pty, struct, sys, termios
child, terminal = pty.fork()
if child == 0:
    fcntl.ioctl(1, termios.TIOCSWINSZ, struct.pack('HHHH', 40, int(sys.argv[1]), 0, 0))
    os.execv(sys.argv[2], sys.argv[2:])
seen = b''
while True:
    try:
        more = os.read(terminal, 65536)
    except OSError:
        break
    if not more:
        break
    seen += more
os.write(1, seen.replace(b'\\r\\n', b'\\n'))
sys.exit(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))
";
    let mut command = std::process::Command::new("python3");
    command.args(["-c", PTY, &columns.to_string(), env!("CARGO_BIN_EXE_hairpin")]).args(without_baseline(arguments));
    command.current_dir(here).env("XDG_STATE_HOME", here.join(".state")).env("TERM", "xterm").env_remove("NO_COLOR");
    command.envs(environment.iter().copied());
    let (code, out, error) = told(&mut command);
    assert!(error.is_empty(), "{error}");
    (code, out)
}

#[test]
fn at_a_terminal_the_verdict_comes_first_and_in_colour() {
    let place = tempfile::tempdir().unwrap();
    let here = place.path();
    let strict = [&SMALL[..], &["--set", "spec.deviation.max_m=0.01", "--out", "a"]].concat();
    let (code, out, error) = run(here, &strict);
    assert_eq!(code, 1, "{out}{error}");
    // In a log the verdict is the last line, nothing is in colour, and what to do next stands on stderr.
    let verdict = out.lines().last().unwrap();
    assert!(verdict.starts_with("FAIL 4/4 ") && !out.contains('\u{1b}') && out.starts_with("case"), "{out}");
    let next: Vec<&str> = error.lines().filter_map(|line| line.strip_prefix("next: hairpin ")).collect();
    let worst = next[0].strip_prefix("replay a --case ").unwrap();
    assert_eq!(
        next,
        [
            &format!("replay a --case {worst}"),
            &format!("shrink a --case {worst}"),
            "report a --open",
            "export a --to csv,mcap --worst 10"
        ]
    );
    assert!(verdict.contains(&format!("case {worst}, ")), "{verdict}");
    let names = ["max ", "mean ", "median ", "min ", "rmse ", "sse ", "std "];
    let statistics = out.lines().find(|line| line.starts_with(&format!("case {worst}, run 0: max "))).unwrap();
    let at: Vec<usize> = names.iter().map(|name| statistics.find(&format!(" {name}")).unwrap()).collect();
    assert!(at.is_sorted(), "evo's order: {statistics}");
    assert!(out.lines().any(|line| line.contains('█') && line.contains("limit 0.01 m")), "{out}");
    assert!(out.contains("; alignment: not aligned; ") && out.contains("is neither a vehicle's local origin"), "{out}");

    for columns in [40, 80, 160] {
        let (code, screen) = seen(here, columns, &[], &["judge", "a"]);
        let first = screen.lines().next().unwrap();
        assert!(code == 1 && first.starts_with("\u{1b}[1;31mFAIL 4/4\u{1b}[0m (simulated"), "{screen}");
        let table: Vec<&str> = screen.lines().skip(2).take_while(|line| !line.is_empty()).collect();
        assert!(table[0].trim_start().starts_with("case"), "{screen}");
        assert!(table.iter().all(|line| line.chars().count() <= columns), "{columns}: {table:#?}");
        assert!(screen.contains(&format!("next: hairpin replay a --case {worst}")), "{screen}");
        let frame: Vec<&str> = screen.lines().filter(|line| line.starts_with("frame: ")).collect();
        assert!(frame.len() == 1 && frame[0].contains("; not aligned; "), "{screen}");
        assert!(frame[0].ends_with("told by the executor") && !screen.contains("local origin"), "{screen}");
    }
    let (_, all) = seen(here, 80, &[], &["-v", "judge", "a"]);
    assert!(
        all.contains("\norigins: the cage origin is neither a vehicle's local origin"),
        "where it is asked for: {all}"
    );
    let (_, plain) = seen(here, 80, &[("NO_COLOR", "1")], &["judge", "a"]);
    assert!(plain.starts_with("FAIL 4/4 (simulated"), "{plain}");
    let lax = ["judge", "a", "--set", "spec.deviation.max_m=20"];
    assert!(seen(here, 80, &[], &lax).1.starts_with("\u{1b}[1;32mPASS 4/4\u{1b}[0m ("));
}

#[test]
fn hairpin_alone_shows_the_ways_in() {
    let place = tempfile::tempdir().unwrap();
    let (code, out, error) = run(place.path(), &[]);
    assert!(code == 2 && out.is_empty(), "{out}");
    for way in
        ["a drone", "a rover", "a car", "an arm", "your own simulator", "hairpin demo", "hairpin help exit-codes"]
    {
        assert!(error.contains(way), "{way}: {error}");
    }
}

#[test]
fn man_pages_are_written() {
    let place = tempfile::tempdir().unwrap();
    let (code, out, error) = run(place.path(), &["man", "--out", "man1"]);
    assert!(code == 0 && out.contains(" pages in man1"), "{out}{error}");
    let page = |name: &str| fs::read_to_string(place.path().join("man1").join(name)).unwrap();
    assert!(page("hairpin.1").contains(".TH hairpin 1"));
    let stress = page("hairpin-stress.1");
    assert!(stress.contains("\\-\\-budget") && stress.contains("Examples"), "{stress}");
    assert!(page("hairpin-init-ci.1").contains("jenkins"));
}
