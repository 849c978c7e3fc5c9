//! `--portable` through the binary: the same bits as without, and folders that hold one SIMD level.

use std::fs;
use std::path::Path;

use crate::commands::{assert_same, contents, run};

/// The SIMD level that a folder says it was made at, and its scenario without that.
fn level(folder: &Path) -> (String, String) {
    let text = fs::read_to_string(folder.join("scenario.toml")).unwrap();
    let line = text.lines().find(|line| line.starts_with("simd = ")).expect("the level is written").to_owned();
    (line.trim_start_matches("simd = ").trim_matches('"').to_owned(), text.replace(&line, ""))
}

#[test]
fn portable_campaigns_are_the_same_bit_for_bit_and_say_what_they_are() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    // One on `hull`, one on `witness`: between them they run every kernel.
    for scenario in ["paper-stable", "demo-quadrotor"] {
        let small = ["stress", scenario, "--set", "generate.search.cases=3", "--set", "execute.repeat=2", "--force"];
        for out in [&["a", "--portable"][..], &["b", "--portable"], &["c"]] {
            let (code, _, error) = run(folder.path(), &[&small[..], &["--out"], out].concat());
            assert!([0, 1].contains(&code), "{error}");
        }
        assert_same(&at("a"), &at("b"));
        let (mut portable, mut widest) = (contents(&at("a")), contents(&at("c")));
        portable.remove("scenario.toml");
        widest.remove("scenario.toml");
        assert!(portable.keys().filter(|name| name.starts_with("trajectories/")).count() == 1);
        assert!(portable == widest, "{scenario}");
        let ((portable, left), (widest, right)) = (level(&at("a")), level(&at("c")));
        assert_eq!((portable.as_str(), left), ("portable", right));
        assert!(["baseline", "avx2", "avx512", "neon"].contains(&widest.as_str()), "{widest}");
    }
}

#[test]
fn a_folder_has_one_simd_level() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let refuse = |arguments: &[&str], told: &str| {
        let (code, _, error) = run(folder.path(), arguments);
        assert!(code == 2 && error.contains(told), "{arguments:?}: {code} {error}");
    };
    let begun = ["generate", "demo-quadrotor", "--set", "generate.search.cases=2", "--set", "execute.repeat=1"];
    for out in [&["a", "--portable"][..], &["c"]] {
        assert_eq!(run(folder.path(), &[&begun[..], &["--out"], out].concat()).0, 0);
    }
    refuse(&[&begun[..], &["--resume", "--out", "a"]].concat(), "a was begun with --portable");
    refuse(&[&begun[..], &["--resume", "--out", "c", "--portable"]].concat(), "c was begun at the SIMD level");
    refuse(&["execute", "c", "--portable"], "c was begun at the SIMD level");
    for flag in [&[][..], &["--portable"]] {
        // What was begun portable goes on so, asked for or not.
        let (code, _, error) = run(folder.path(), &[&["execute", "a", "--set", "execute.walls=true"], flag].concat());
        assert_eq!((code, level(&at("a")).0.as_str()), (0, "portable"), "{error}");
    }

    // From a machine of another kind.
    let text = fs::read_to_string(at("c/scenario.toml")).unwrap();
    let elsewhere = text.replace(&format!("simd = \"{}\"", level(&at("c")).0), "simd = \"mmx\"");
    fs::write(at("c/scenario.toml"), &elsewhere).unwrap();
    refuse(&[&begun[..], &["--resume", "--out", "c"]].concat(), "the SIMD level mmx");
    refuse(&["execute", "c", "--set", "execute.walls=true"], "the SIMD level mmx");
    assert_eq!(fs::read_to_string(at("c/scenario.toml")).unwrap(), elsewhere, "what is refused changes nothing");
    // The users' own programs run none of our kernels, and judging runs none at all.
    let minimal = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/executors/minimal_executor.py");
    let (code, _, error) = run(folder.path(), &["execute", "c", "--executor", &format!("python3 '{minimal}'")]);
    assert_eq!((code, level(&at("c")).0.as_str()), (0, "mmx"), "{error}");
    assert_eq!(run(folder.path(), &["judge", "c", "--set", "spec.deviation.max_m=100"]).0, 0);
    assert_eq!(level(&at("c")).0, "mmx");
}
