//! Random feasible cases beside a campaign: drawn and flown alike, kept by themselves, and counted nowhere; and limits
//! that follow from such cases.

use std::fs;
use std::path::Path;

use crate::commands::{assert_same, hairpin, json, refused, run, small_hull, told};
use hairpin_formats::folder::CampaignFolder;
use hairpin_formats::parquet::results;
use serde_json::{Value, json};

const SEARCH: &str = "{ method = \"beam\", waypoints = 60, cases = 3 }";
const OF_FOUR: [&str; 6] = ["stress", "hull.toml", "--set", "execute.baseline=4", "--set", "execute.repeat=2"];
const MINIMAL: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/executors/minimal_executor.py");

fn hull(folder: &Path) {
    let windy = "[vary]\n\"world.wind_m_s\" = { uniform = [[-2, -2, 0], [2, 2, 0]] }\n";
    fs::write(folder.join("hull.toml"), small_hull(SEARCH) + windy).unwrap();
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value}"))
}

#[test]
fn a_campaign_stands_beside_cases_that_nobody_chose() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    hull(here);
    let object = json(here, &[&OF_FOUR[..], &["--out", "a"]].concat());
    let random = &object["baseline"];
    assert_eq!((&random["cases"], &random["executions"]), (&json!(4), &json!(8)), "{object}");
    assert_eq!(random["metric"], "max_deviation_m");
    let rows = results::read(&here.join("a/baseline.parquet")).unwrap();
    let measured: Vec<f64> =
        rows.iter().map(|row| row.result.as_ref().unwrap().measures.as_ref().unwrap().max_deviation).collect();
    let mean = measured.iter().sum::<f64>() / 4.0;
    assert!((number(&random["mean"]) - mean).abs() < 1e-12, "{random}");
    assert_eq!(number(&random["max"]), measured.iter().copied().fold(0.0, f64::max));
    let [low, high] = [0, 1].map(|end| number(&random["interval"][end]));
    assert!(low < mean && mean < high && low >= 0.0, "{random}");
    // By how much the campaign's own deviate more, in the mean.
    let own = CampaignFolder::open(&here.join("a")).unwrap().read_results().unwrap();
    let own = own.iter().map(|result| result.measures.as_ref().unwrap().max_deviation).sum::<f64>() / 3.0;
    assert!((number(&object["stress_percent"]) - 100.0 * (own / mean - 1.0)).abs() < 1e-9, "{object}");
    let verdict = object["verdict"].as_str().unwrap();
    let told = format!(", of 6 flown; random feasible ones {mean:.2} m in the mean (");
    assert!(verdict.contains(&told) && verdict.contains(" m at worst of 4; "), "{verdict}");

    // They are none of the campaign's, and of none of its graphs.
    let cases = CampaignFolder::open(&here.join("a")).unwrap().read_cases().unwrap();
    for row in &rows {
        assert!(cases.iter().all(|case| case.seed != row.case.seed && case.graph != row.case.graph), "{row:?}");
        let result = row.result.as_ref().unwrap();
        assert_eq!((result.status.word(), result.violations.len()), ("unjudged", 0));
    }
    assert!(rows.iter().any(|row| !row.result.as_ref().unwrap().drawn.is_empty()), "winds are drawn for them too");
    assert_eq!((&object["counts"]["cases"], &object["share"]["of"]), (&json!(3), &json!(3)));
    let junit = fs::read_to_string(here.join("a/junit.xml")).unwrap();
    assert!(junit.contains("tests=\"3\""), "{junit}");
    let page = fs::read_to_string(here.join("a/report.html")).unwrap();
    assert!(
        page.contains("random feasible cases") && page.contains("Random feasible cases: 4 of the same feasible set")
    );

    // The same where it is judged or reported again, with fewer threads, or part by part; and where it goes on.
    assert_eq!(json(here, &["judge", "a"])["verdict"], object["verdict"]);
    assert_eq!(json(here, &["report", "a"])["verdict"], object["verdict"]);
    run(here, &[&OF_FOUR[..], &["--out", "b", "--threads", "1"]].concat());
    assert_same(&here.join("a"), &here.join("b"));
    run(here, &[&["generate"], &OF_FOUR[1..], &["--out", "c"]].concat());
    assert!(!here.join("c/baseline.parquet").exists(), "nothing was flown yet");
    run(here, &["execute", "c"]);
    run(here, &["judge", "c"]);
    assert_same(&here.join("a"), &here.join("c"));
    fs::remove_file(here.join("c/baseline.parquet")).unwrap();
    run(here, &[&OF_FOUR[..], &["--out", "c", "--resume"]].concat());
    assert_same(&here.join("a"), &here.join("c"));
}

#[test]
fn they_change_nothing_that_is_counted() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    hull(here);
    let with = json(here, &[&OF_FOUR[..], &["--out", "with"]].concat());
    let none = [&OF_FOUR[..2], &OF_FOUR[4..], &["--set", "execute.baseline=0", "--out", "none"]].concat();
    let without = json(here, &none);
    assert_eq!((&without["baseline"], &without["stress_percent"]), (&Value::Null, &Value::Null));
    let verdict = without["verdict"].as_str().unwrap();
    assert!(!verdict.contains("random") && !verdict.contains("flown;"), "{verdict}");
    for key in ["exit_code", "counts", "share", "worst"] {
        assert_eq!(with[key], without[key], "{key}");
    }
    for name in ["results.parquet", "runs/part-00000.parquet", "waypoints.parquet", "generation.json"] {
        let of = |out: &str| fs::read(here.join(out).join(name)).unwrap();
        assert!(of("with") == of("none"), "{name}");
    }
    assert!(!here.join("none/baseline.parquet").exists());
    let compared = json(here, &["compare", "with", "none"]);
    assert_eq!((&compared["pairs"], &compared["exit_code"]), (&json!(3), &json!(0)), "{compared}");
    // What was measured from another reference does not stand beside what is.
    let (code, out, error) = run(here, &["judge", "with", "--set", "spec.deviation.max_m=40"]);
    assert!(code == 0 && out.contains("random feasible ones") && !error.contains("Warning"), "{out}{error}");
    let kept = "scenario.toml has spec.deviation.max_m as it is given now: later judgements go by it";
    assert!(error.contains(kept), "{error}");
    assert!(!run(here, &["judge", "with"]).2.contains("as it is given now"));
    let (_, out, error) = run(here, &["judge", "with", "--set", "spec.deviation.from=leg"]);
    assert!(error.contains("measured from another reference") && !out.contains("random feasible"), "{out}{error}");
    assert!(!here.join("with/baseline.parquet").exists());
    assert!(json(here, &["execute", "with"])["exit_code"] == 0 && here.join("with/baseline.parquet").is_file());
    refused(here, &["stress", "hull.toml", "--set", "execute.baseline=-1"], &["execute.baseline"]);
    let varied = "vary.\"execute.baseline\".uniform=[0,9]";
    refused(
        here,
        &["stress", "hull.toml", "--set", varied],
        &["execute.baseline", "the number of cases to compare with"],
    );
}

#[test]
fn a_program_of_the_users_flies_them_as_well() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    hull(here);
    fs::copy(MINIMAL, here.join("fly.py")).unwrap();
    let asked = [&OF_FOUR[..], &["--executor", "python3 fly.py"]].concat();
    let object = json(here, &[&asked[..], &["--out", "a"]].concat());
    assert_eq!((&object["baseline"]["cases"], &object["baseline"]["executions"]), (&json!(4), &json!(8)), "{object}");
    // Who flies nothing of the campaign is not asked for more.
    fs::write(here.join("broken.py"), "raise SystemExit('no')\n").unwrap();
    let broken = [&OF_FOUR[..], &["--executor", "python3 broken.py", "--out", "b"]].concat();
    let object = json(here, &broken);
    assert_eq!((&object["exit_code"], &object["baseline"]), (&json!(4), &Value::Null), "{object}");
    // Missions that were made elsewhere are compared with them as well.
    run(here, &["export", "a", "--to", "waypoints"]);
    run(here, &["execute", "a", "--missions", "a/export"]);
    assert_eq!(json(here, &["judge", "a"])["missions"]["worst"]["random"]["cases"], 4);
    // Programs of arms are drawn as well.
    let arm =
        ["stress", "demo-arm", "--set", "execute.baseline=3", "--set", "generate.search.programs=1", "--out", "arm"];
    let object = json(here, &arm);
    assert_eq!(object["baseline"]["cases"], json!(3), "{object}");
}

#[test]
fn limits_follow_from_what_is_ordinary() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    hull(here);
    let calm = ["--set", "execute.repeat=1", "--set", "execute.controller=stable-waypoint"];
    let one = [&["calibrate", "hull.toml"][..], &calm].concat();
    let object = json(here, &one);
    assert_eq!((&object["field"], &object["cases"]), (&json!("spec.deviation.max_m"), &json!(200)), "{object}");
    let (value, low, high) = (number(&object["value"]), number(&object["interval"][0]), number(&object["interval"][1]));
    assert!(0.0 < low && low <= value && value <= high, "{object}");
    assert_eq!((object["limits"].as_array().unwrap().len(), object["reason"].is_null()), (1, true));
    assert!(fs::read_dir(here).unwrap().count() == 1, "nothing is written");
    // What is told is a table to paste, and 5 % break it.
    let (code, out, _) = run(here, &one);
    let pasted = out.split("[spec]\n").nth(1).unwrap();
    assert!(
        code == 0 && out.starts_with("[spec]\n# 5.0 % of 200 random feasible cases break spec.deviation.max_m"),
        "{out}"
    );
    let text = fs::read_to_string(here.join("hull.toml")).unwrap();
    let calibrated = text.replace("deviation = { max_m = 0.5, from = \"nearest-leg\" }\n", pasted);
    assert_ne!(calibrated, text);
    fs::write(here.join("new.toml"), calibrated).unwrap();
    let again = json(here, &[&["calibrate", "new.toml"][..], &calm].concat());
    assert_eq!((&again["value"], &again["interval"]), (&object["value"], &object["interval"]));
    // A tighter share; every limit that there is; other draws.
    let two = [&one[..], &["--share", "0.25", "--set", "spec.total_time.max_s=9"]].concat();
    let both = json(here, &two);
    let fields: Vec<&str> =
        both["limits"].as_array().unwrap().iter().map(|one| one["field"].as_str().unwrap()).collect();
    assert_eq!(fields, ["spec.deviation.max_m", "spec.total_time.max_s"]);
    assert!(number(&both["value"]) < low, "{both} {object}");
    assert_ne!(json(here, &[&one[..], &["--seed", "4"]].concat())["value"], object["value"]);
}

#[test]
fn too_few_flights_give_no_number() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    hull(here);
    let few = ["calibrate", "hull.toml", "--cases", "30", "--set", "execute.repeat=1"];
    let object = json(here, &few);
    assert_eq!((&object["exit_code"], &object["value"], &object["interval"]), (&json!(5), &Value::Null, &Value::Null));
    assert!(object["reason"].as_str().unwrap().contains("30 cases were measured, and 200 are the least"), "{object}");
    let (_, out, _) = run(here, &few);
    assert!(
        out.starts_with("spec.deviation.max_m: no limit: 30 cases were measured") && !out.contains("[spec]"),
        "{out}"
    );
    // Nothing is feasible; a share that no number of cases shows.
    let far = [&few[..], &["--set", "generate.timing.step_s=0.05"]].concat();
    assert_eq!(json(here, &far)["exit_code"], 3);
    refused(here, &["calibrate", "hull.toml", "--share", "0"], &["--share", "0.001 to 0.5"]);
    // A program of the user's flies them.
    fs::copy(MINIMAL, here.join("fly.py")).unwrap();
    let (code, out, error) = told(&mut hairpin(here, &[&few[..], &["--executor", "python3 fly.py"]].concat()));
    assert!(code == 5 && out.contains("30 cases were measured"), "{out}{error}");
}
