//! `--keep`: of which runs the motion stays changes no measure, no result and no verdict; what is needed of it later is
//! executed again, or refused by name where a program flew.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use crate::commands::{assert_same, copy, json, refused, run, small_hull};
use hairpin::campaign::report::worst_first;
use hairpin_formats::folder::CampaignFolder;
use hairpin_formats::parquet::runs::{RunFacts, read_facts};
use serde_json::Value;

const KEEPS: [&str; 3] = ["all", "worst", "none"];
const PART: &str = "executions/part-00000.parquet";
const FACTS: &str = "runs/part-00000.parquet";
const MANY: [&str; 4] = ["stress", "hull.toml", "--set", "execute.repeat=2"];

/// So many cases of two short legs.
fn short(cases: usize) -> String {
    let long = small_hull(&format!("{{ method = \"beam\", waypoints = 60, cases = {cases} }}"));
    long.replace("end_m = [14, 14, 12]\nlength = 5", "end_m = [6, 6, 7]\nlength = 3")
}

fn facts(out: &Path) -> Vec<RunFacts> {
    read_facts(&out.join(FACTS)).unwrap().into_values().collect()
}

/// Runs of which rows stand there, by case.
fn recorded(out: &Path) -> BTreeMap<usize, Vec<usize>> {
    let mut all: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    facts(out)
        .iter()
        .filter(|facts| facts.recorded)
        .for_each(|facts| all.entry(facts.case.0).or_default().push(facts.run));
    all
}

/// What a judgement comes to, without the folder's name.
fn told(mut object: Value) -> Value {
    object.as_object_mut().unwrap().remove("paths");
    object
}

#[test]
fn what_is_kept_changes_no_result() {
    let place = tempfile::tempdir().unwrap();
    let here = place.path();
    fs::write(here.join("hull.toml"), short(11)).unwrap();
    let once = ["stress", "hull.toml", "--set", "execute.flaky.reruns=1"];
    let all = KEEPS.map(|keep| told(json(here, &[&once[..], &["--keep", keep, "--out", keep]].concat())));
    assert!(all[0] == all[1] && all[0] == all[2], "{all:?}");
    let path = |keep: &str| here.join(keep);
    let bytes = |keep: &str, name: &str| fs::read(path(keep).join(name)).unwrap();
    let known = |keep: &str| {
        facts(&path(keep)).into_iter().map(|facts| RunFacts { recorded: true, ..facts }).collect::<Vec<_>>()
    };
    for keep in &KEEPS[1..] {
        for name in ["results.parquet", "waypoints.parquet", "coverage.json"] {
            assert!(bytes("all", name) == bytes(keep, name), "{keep}: {name}");
        }
        // JUnit names the folder, in the commands that carry violations out again.
        let junit = |keep: &str| String::from_utf8(bytes(keep, "junit.xml")).unwrap();
        let there = junit(keep).replace(&format!("replay {keep} "), "replay all ");
        assert!(junit("all") == there && there.contains("again: hairpin replay all --case 0"), "{there}");
        assert!(known("all") == known(keep), "{keep}");
    }
    assert_eq!(facts(&path("all")).iter().filter(|facts| facts.recorded).count(), 11);
    // The runs that decide the ten worst cases, and no others; nothing at all.
    let results = CampaignFolder::open(&path("worst")).unwrap().read_results().unwrap();
    let ten = worst_first(&results).into_iter().take(10).map(|result| (result.case.0, vec![result.run]));
    assert_eq!(recorded(&path("worst")), ten.collect());
    assert!(recorded(&path("none")).is_empty());
    assert!(!path("none").join("executions").exists() && !path("none").join("reruns").exists());
    // Rows that are kept are those that `all` keeps.
    let open = |keep: &str| CampaignFolder::open(&path(keep)).unwrap();
    for (case, runs) in recorded(&path("worst")) {
        let read = |keep: &str| open(keep).read_run(hairpin::campaign::CaseNumber(case), runs[0]).unwrap();
        assert!(read("worst") == read("all"), "case {case}");
    }

    // Judged again, by other limits too, and from another reference that asks for all samples: those that were not
    // kept are executed again.
    for sets in [&["--set", "spec.deviation.max_m=0.01"], &["--set", "spec.deviation.from=\"path\""]] {
        let judged = KEEPS.map(|keep| told(json(here, &[&["judge", keep][..], sets].concat())));
        if sets.last().is_some_and(|key| key.contains("path")) {
            // Of the rows that `all` keeps it is measured within their tolerance.
            let worst = |object: &Value| object["worst"]["max_deviation_m"].as_f64().unwrap();
            assert!((worst(&judged[0]) - worst(&judged[2])).abs() < 2e-4, "{judged:?}");
        } else {
            assert!(judged[0] == judged[1] && judged[0] == judged[2], "{sets:?} {judged:?}");
        }
    }
    assert_eq!(run(here, &["report", "none"]).0, 0);
    for keep in ["all", "none"] {
        let (code, _, error) = run(here, &["export", keep, "--to", "csv,tum"]);
        assert_eq!(code, 0, "{error}");
    }
    assert_eq!(run(here, &["compare", "all", "none"]).0, 0);
    // The executed motion of every case that is shown.
    let page = String::from_utf8(bytes("none", "report.html")).unwrap();
    assert!(page.contains("\"flown\":") && !page.contains("\"flown\":null"));
    let lines = |keep: &str| String::from_utf8(bytes(keep, "export/0003-0.csv")).unwrap().lines().count();
    assert_eq!(lines("none"), lines("all"), "the same samples");
}

#[test]
fn what_was_not_kept_is_not_flown_when_a_campaign_goes_on() {
    let place = tempfile::tempdir().unwrap();
    let here = place.path();
    fs::write(here.join("hull.toml"), short(3)).unwrap();
    run(here, &[&MANY[..], &["--out", "a"]].concat());
    for keep in KEEPS {
        assert_eq!(run(here, &["execute", "a", "--keep", keep]).0, 0);
        copy(&here.join("a"), &here.join(keep));
        // A run of each case, of two.
        let kept = recorded(&here.join("a")).values().map(Vec::len).sum::<usize>();
        assert_eq!(kept, [6, 3, 0][KEEPS.iter().position(|one| *one == keep).unwrap()]);
        let again = json(here, &["execute", keep, "--resume"]);
        assert_eq!(again["counts"]["runs"], 6);
        assert_same(&here.join("a"), &here.join(keep));
        // Of those that are gone each is flown, and nothing else of the folder changes.
        fs::remove_file(here.join(keep).join(FACTS)).unwrap();
        assert_eq!(run(here, &["execute", keep, "--resume"]).0, 0);
        assert_same(&here.join("a"), &here.join(keep));
    }
    refused(here, &["execute", "a", "--resume", "--keep", "all"], &["--resume: `execute.record`"]);
    refused(here, &["execute", "a", "--keep", "some"], &["all, worst, none"]);
    // Another simulator, or another folder's runs, are not taken for those that were measured.
    let edited = fs::read_to_string(here.join("none/scenario.toml")).unwrap().replace("fixed_velocity_m_s", "# ");
    let edited = edited.replace("controller = \"minimum-snap\"", "controller = \"unstable-waypoint\"");
    fs::write(here.join("none/scenario.toml"), &edited).unwrap();
    refused(here, &["export", "none", "--to", "csv"], &["`execute.controller`", "The runs are of what it was"]);
    // Of a folder of before, which does not say what it was, what comes out tells it.
    let made = edited.find("settings = ").unwrap();
    let rest = made + edited[made..].find("simd = ").unwrap();
    fs::write(here.join("none/scenario.toml"), format!("{}{}", &edited[..made], &edited[rest..])).unwrap();
    refused(here, &["export", "none", "--to", "csv"], &["case 0000, run 0", "comes out otherwise", "--keep all"]);
}

#[test]
fn runs_of_a_program_that_were_not_kept_are_named() {
    let place = tempfile::tempdir().unwrap();
    let here = place.path();
    let program = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/executors/minimal_executor.py");
    let executor = format!("python3 '{program}'");
    fs::write(here.join("hull.toml"), short(2)).unwrap();
    let flown = ["stress", "hull.toml", "--set", "execute={}", "--executor", &executor];
    let verdicts = KEEPS.map(|keep| told(json(here, &[&flown[..], &["--keep", keep, "--out", keep]].concat())));
    assert!(verdicts[0] == verdicts[1] && verdicts[0] == verdicts[2], "{verdicts:?}");
    assert_eq!(told(json(here, &["judge", "none"])), told(json(here, &["judge", "all"])));
    assert_eq!((recorded(&here.join("worst")).len(), here.join("none").join(PART).exists()), (2, false));
    let why = ["case 000", "run 0", "`execute.record` = \"none\"", "a program flew it"];
    for arguments in [
        &["export", "none", "--to", "csv"][..],
        &["export", "none", "--to", "tum"],
        &["report", "none"],
        &["judge", "none", "--set", "spec.deviation.from=\"leg\""],
    ] {
        refused(here, arguments, &why);
    }
    for arguments in [&["export", "worst", "--to", "csv,tum"][..], &["report", "worst"]] {
        assert_eq!(run(here, arguments).0, 0, "{arguments:?}");
    }
    // It can fly a case again where that is what is asked for.
    assert!([0, 1].contains(&run(here, &["replay", "none", "--case", "0000"]).0));
}

/// Programs are judged move by move, of all rows: what is not kept runs again.
#[test]
fn programs_that_were_not_kept_run_again() {
    let place = tempfile::tempdir().unwrap();
    let here = place.path();
    let few = ["stress", "arm", "--set", "task.points.count=4", "--set", "generate.search.programs=1"];
    let twice = ["--set", "execute.repeat=2", "--set", "spec.path.max_mm=0.001"];
    let all = KEEPS.map(|keep| told(json(here, &[&few[..], &twice, &["--keep", keep, "--out", keep]].concat())));
    assert!(all[0] == all[1] && all[0] == all[2], "{all:?}");
    let bytes = |keep: &str, name: &str| fs::read(here.join(keep).join(name)).unwrap();
    for name in ["results.parquet", "moves.json", "programs/part-00000.parquet"] {
        assert!(bytes("all", name) == bytes("worst", name) && bytes("all", name) == bytes("none", name), "{name}");
    }
    assert_eq!(KEEPS.map(|keep| recorded(&here.join(keep)).values().map(Vec::len).sum::<usize>()), [2, 1, 0]);
    assert!(told(json(here, &["judge", "none"])) == all[0]);
    for keep in ["all", "none"] {
        assert_eq!(run(here, &["export", keep, "--to", "csv,rapid"]).0, 0);
    }
    for run in ["export/0000-0.csv", "export/0000-1.csv"] {
        assert!(bytes("none", run) == bytes("all", run), "{run}: of programs all rows are kept");
    }
    let logs = ["execute", "all", "--logs", "logs/*.csv", "--keep", "worst"];
    refused(here, &logs, &["execute.record", "a recording cannot be made again"]);
}
