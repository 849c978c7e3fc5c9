//! Violations that are run again: how often they come again, in every form in which it is told.

use std::fs;

use crate::commands::{SMALL, json, run};
use hairpin::campaign::Run;
use hairpin_formats::folder::CampaignFolder;

#[test]
fn violations_are_run_again_with_other_noise() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    run(here, &[&SMALL[..], &["--out", "a"]].concat());
    // A limit at the worst flight's own deviation, a hair less: noise takes it to either side.
    let worst = json(here, &["judge", "a"])["worst"]["max_deviation_m"].as_f64().unwrap();
    let limit = format!("spec.deviation.max_m={}", worst - 1e-6);
    let again = ["execute", "a", "--set", &limit, "--rerun-violations", "12"];
    assert_eq!(run(here, &again).0, 0);
    let reruns = |folder: &str| -> Vec<Run> {
        let kept = CampaignFolder::open(&here.join(folder)).unwrap();
        kept.read_cases().unwrap().iter().flat_map(|case| kept.read_reruns(case.number).unwrap()).collect()
    };
    let first = reruns("a");
    assert_eq!(first.len(), 12, "one violation, twelve times");
    let distinct: std::collections::BTreeSet<String> = first.iter().map(|run| format!("{:?}", run.outcome)).collect();
    assert_eq!(distinct.len(), 12, "each with noise of its own");

    let object = json(here, &["judge", "a"]);
    assert_eq!(object["counts"]["fail"], 1, "{object}");
    let verdict = object["verdict"].as_str().unwrap();
    assert!(verdict.contains("violations run again 12 times each: "), "{verdict}");
    let again = &object["worst"]["reruns"];
    let (k, n) = (again["violated"].as_u64().unwrap(), again["of"].as_u64().unwrap());
    assert!(n == 12 && k < 12, "{object}");
    let (low, high) = (again["low"].as_f64().unwrap(), again["high"].as_f64().unwrap());
    let share = k as f64 / 12.0;
    assert!(low <= share && share <= high && high - low < 0.7, "{object}");
    let junit = fs::read_to_string(here.join("a/junit.xml")).unwrap();
    assert!(junit.contains(&format!("{k} of 12 violate, share ")), "{junit}");
    assert_eq!(run(here, &["report", "a"]).0, 0);
    let page = fs::read_to_string(here.join("a/report.html")).unwrap();
    assert!(page.contains("Do violations come again?") && page.contains(&format!("{k} of 12")));

    // The same key in the scenario, in any number of threads, gives the same runs; --resume keeps those that are there.
    let key = ["--set", "execute.flaky.reruns=12", "--set", &limit, "--out", "b", "--threads", "1"];
    let whole = json(here, &[&SMALL[..], &key].concat());
    assert_eq!(whole["worst"]["reruns"], *again);
    assert!(reruns("b") == first);
    fs::remove_file(here.join("b/rerun-runs/part-00000.parquet")).unwrap();
    assert_eq!(run(here, &["execute", "b", "--resume"]).0, 0);
    assert!(reruns("b") == first, "the missing ones are flown again");
    // At the confidence that the spec asks for, here as in the verdict.
    let sure = json(here, &["judge", "a", "--set", "spec.confidence=0.99"])["worst"]["reruns"].clone();
    let wide = sure["high"].as_f64().unwrap() - sure["low"].as_f64().unwrap();
    assert!(sure["violated"] == k && wide > high - low + 0.01, "{sure}");
    let page = json(here, &["report", "a"]);
    assert!(fs::read_to_string(here.join("a/report.html")).unwrap().contains("with its 99 % interval"), "{page}");
    // Flown anew without the key there is nothing to run again.
    assert_eq!(json(here, &["execute", "a", "--set", "execute.flaky.reruns=1"])["counts"]["runs"], 4);
    assert_eq!(reruns("a").len(), 1);
}
