//! `hairpin compare`: pairs, what counts as worse, and what it exits with.

use crate::commands::{SMALL, copy, json, refused, run};
use serde_json::Value;

fn names(object: &Value, key: &str) -> Vec<String> {
    object[key].as_array().unwrap().iter().map(|name| name.as_str().unwrap().to_owned()).collect()
}

#[test]
fn two_folders_are_paired_by_case_and_seed() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let eight = [&SMALL[..], &["--set", "generate.search.cases=8", "--set", "spec.deviation.max_m=90"]].concat();
    assert_eq!(run(here, &[&eight[..], &["--out", "a"]].concat()).0, 0);

    // A folder with itself: nothing changes.
    let (code, out, error) = run(here, &["compare", "a", "a"]);
    assert_eq!((code, error.as_str()), (0, ""), "{out}");
    let last = out.lines().last().unwrap();
    assert_eq!(last, "better 0, worse 0, newly failing 0; newly passing 0, unchanged 8");
    for words in ["max_deviation_m", "rank biserial", "Wilcoxon signed-rank test, two-sided, exact"] {
        assert!(out.contains(words), "{words}: {out}");
    }

    // The same trajectories in a wind that the controller cannot hold out against: all fail, by whatever limit.
    copy(&here.join("a"), &here.join("b"));
    let wind = "vary.\"world.wind_m_s\".uniform=[[7,0,0],[8,0,0]]";
    assert_eq!(run(here, &["execute", "b", "--set", "execute.repeat=3", "--set", wind]).0, 0);
    refused(here, &["compare", "a", "b"], &["not judged yet", "hairpin judge b"]);
    assert_eq!(run(here, &["judge", "b"]).0, 1);
    let object = json(here, &["compare", "a", "b"]);
    assert_eq!((&object["exit_code"], names(&object, "newly_failing").len()), (&1.into(), 8), "{object}");
    assert!(object["verdict"].as_str().unwrap().starts_with("better 0, worse 0, newly failing 8; "), "{object}");
    // For a build server: each newly failing case with both runs and the command that flies it again.
    assert_eq!(run(here, &["compare", "a", "b", "--junit", "new/compare.xml"]).0, 1);
    let junit = std::fs::read_to_string(here.join("new/compare.xml")).unwrap();
    assert!(junit.contains("tests=\"8\" failures=\"8\" errors=\"0\"") && !junit.contains("<skipped"), "{junit}");
    for words in
        ["type=\"Regression\"", "\nB: fail, ", ">A: pass, largest deviation ", "\nagain: hairpin replay b --case 0003<"]
    {
        assert!(junit.contains(words), "{words}: {junit}");
    }
    let back = json(here, &["compare", "b", "a"]);
    assert_eq!((&back["exit_code"], &back["newly_passing"]), (&0.into(), &object["newly_failing"]));

    // Where all fail in both, what is worse is told by how much, and is no failure unless that was asked for.
    assert_eq!(run(here, &["judge", "a", "--set", "spec.deviation.max_m=0.01"]).0, 1);
    let object = json(here, &["compare", "a", "b"]);
    let count = |key: &str| object[key].as_u64().unwrap();
    assert_eq!((&object["exit_code"], count("better") + count("worse") + count("unchanged")), (&0.into(), 8));
    assert!(count("worse") > count("better") && object["regression"] == true, "{object}");
    assert!(names(&object, "scenario_differences").iter().any(|key| key == "execute.repeat"), "{object}");
    let metrics = object["metrics"].as_array().unwrap();
    let overshoot = metrics.iter().find(|metric| metric["metric"] == "max_overshoot_m").unwrap();
    assert_eq!(
        (&overshoot["change"], &overshoot["test"], &overshoot["pairs"]),
        (&"worse".into(), &"exact".into(), &8.into())
    );
    // All eight are worse: 2 / 2⁸.
    assert_eq!((&overshoot["rank_biserial"], &overshoot["p"]), (&1.0.into(), &0.0078125.into()));
    assert!(overshoot["interval"][0].as_f64().unwrap() <= overshoot["median_difference"].as_f64().unwrap());
    let worse = ["compare", "a", "b", "--fail-on", "regression", "--junit", "worse.xml"];
    assert_eq!(json(here, &worse)["exit_code"], 1);
    // What failed before is no failure; what got worse beyond chance is, as the exit code says.
    let junit = std::fs::read_to_string(here.join("worse.xml")).unwrap();
    let worse = metrics.iter().filter(|metric| metric["change"] == "worse").count();
    assert!(junit.contains(&format!("tests=\"{}\" failures=\"{worse}\" errors=\"0\"", 8 + worse)), "{junit}");
    assert!(junit.contains("regression of max_overshoot_m") && junit.matches("<skipped").count() == 8, "{junit}");
    assert_eq!(json(here, &["compare", "b", "a", "--fail-on", "regression"])["exit_code"], 0);
    assert_eq!(json(here, &["compare", "a", "b", "--tolerance-m", "1000"])["unchanged"], 8);
}

#[test]
fn what_cannot_be_paired_is_told_by_name() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    run(here, &[&SMALL[..], &["--out", "a"]].concat());
    run(
        here,
        &[&SMALL[..], &["--set", "generate.search.cases=3", "--set", "spec.deviation.max_m=50", "--out", "b"]].concat(),
    );
    let (_, out, error) = run(here, &["compare", "a", "b"]);
    assert!(out.contains("not paired: 0003 (only in A)") && out.contains("not paired 1"), "{out}");
    assert!(error.contains("spec.deviation.max_m") && error.contains("each folder's own spec"), "{error}");
    run(here, &["compare", "a", "b", "--page", "two.html"]);
    let page = std::fs::read_to_string(here.join("two.html")).unwrap();
    assert!(page.contains("keys that differ") && page.contains("The scenarios differ in "), "a page of two specs");
    assert!(page.contains("spec.deviation.max_m") && page.contains("The specs differ: what passes and fails"));
    run(here, &[&SMALL[..], &["--seed", "99", "--out", "c"]].concat());
    refused(here, &["compare", "a", "c"], &["another seed", "--missions"]);
    // Pairs whose runs all failed say nothing, and do not pass.
    copy(&here.join("a"), &here.join("broken"));
    run(here, &["execute", "broken", "--executor", "false"]);
    run(here, &["judge", "broken"]);
    let object = json(here, &["compare", "a", "broken"]);
    assert_eq!((&object["exit_code"], names(&object, "undecided").len()), (&5.into(), 4), "{object}");
    assert!(object["verdict"].as_str().unwrap().starts_with("INCONCLUSIVE: none of 4 pairs "), "{object}");
    refused(here, &["compare", "a", "missing"], &["not a campaign folder"]);
}
