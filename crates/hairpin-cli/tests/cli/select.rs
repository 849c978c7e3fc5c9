//! `hairpin select`, and what a test set exercised.

use std::fs;
use std::path::Path;

use crate::commands::{SMALL, contents, json, refused, run};
use hairpin_formats::folder::CampaignFolder;
use serde_json::Value;

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

/// Cells that coverage.tsv says were met, and all.
fn cells(folder: &Path) -> (usize, usize) {
    let text = fs::read_to_string(folder.join("coverage.tsv")).unwrap();
    let rows: Vec<&str> = text.lines().skip(1).collect();
    (rows.iter().filter(|row| !row.ends_with("\t0")).count(), rows.len())
}

#[test]
fn a_choice_is_a_campaign_folder_of_its_own() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let eight = [&SMALL[..], &["--set", "generate.search.cases=8", "--set", "spec.deviation.max_m=4"]].concat();
    run(here, &[&eight[..], &["--out", "all"]].concat());
    let select = |by: &str, out: &str| json(here, &["select", "all", "--cases", "3", "--by", by, "--out", out]);
    let stress = select("stress", "stress");
    let diverse = select("diverse", "diverse");
    let coverage = select("coverage", "coverage");
    for object in [&stress, &diverse, &coverage] {
        assert_eq!((&object["exit_code"], &object["selected"]["cases"]), (&0.into(), &3.into()), "{object}");
        assert_eq!(object["most_stressful"], stress["selected"]);
        assert!(number(&object["selected"]["stress"]) <= number(&stress["selected"]["stress"]));
        assert!(object["guarantee"].as_str().unwrap().len() > 10);
    }
    let of = |object: &Value, what: &str| number(&object["selected"][what]);
    assert!(of(&diverse, "spread") >= of(&stress, "spread") && of(&diverse, "nearest") > 0.0, "{diverse} {stress}");
    assert!(of(&coverage, "cells") >= of(&stress, "cells") && of(&coverage, "cells") >= of(&diverse, "cells"));
    // Stress counts what was measured: the largest deviation of the worst case is the campaign's.
    let all = json(here, &["judge", "all"]);
    assert_eq!(stress["selected"]["worst"], all["worst"]["max_deviation_m"]);

    // One case has no other to be far from: it is the most stressful.
    let one = json(here, &["select", "all", "--cases", "1", "--out", "one"]);
    assert_eq!((&one["cases"][0], &one["selected"]), (&all["worst"]["case"], &one["most_stressful"]), "{one}");

    // Every other command takes it; the cases keep number, seed, plan and runs.
    let judged = json(here, &["judge", "stress"]);
    assert_eq!((&judged["counts"]["asked"], &judged["counts"]["cases"]), (&3.into(), &3.into()), "{judged}");
    assert_eq!(judged["worst"], all["worst"]);
    let compared = json(here, &["compare", "all", "stress"]);
    assert_eq!((&compared["pairs"], &compared["unchanged"]), (&3.into(), &3.into()), "{compared}");
    assert_eq!(run(here, &["verify", "stress"]).0, 0);
    let before = contents(&here.join("stress"));
    assert_eq!(json(here, &["execute", "stress"])["counts"]["runs"], 3);
    let after = contents(&here.join("stress"));
    assert!(
        before.iter().filter(|(name, _)| name.starts_with("executions/")).all(|(name, bytes)| after[name] == *bytes)
    );

    refused(here, &["select", "all", "--cases", "9", "--out", "x"], &["--cases 9", "8 cases"]);
    refused(here, &["select", "all", "--cases", "2", "--out", "all"], &["another folder"]);
    let generated = ["generate", "demo-quadrotor", "--set", "generate.search.cases=2", "--out", "plans"];
    run(here, &generated);
    refused(here, &["select", "plans", "--cases", "1", "--by", "coverage", "--out", "x"], &["hairpin execute plans"]);
    assert_eq!(json(here, &["select", "plans", "--cases", "1", "--out", "planned"])["selected"]["cases"], 1);
}

#[test]
fn flights_drives_and_programs_say_what_they_exercised() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    run(here, &[&SMALL[..], &["--out", "flight"]].concat());
    run(here, &["stress", "demo-rover", "--set", "generate.search.cases=1", "--out", "drive"]);
    run(here, &["stress", "demo-arm", "--out", "arm"]);
    // Stress is told with its unit, of arms in mm.
    for (name, unit) in [("flight", " m,"), ("arm", " mm,")] {
        let (_, out, _) = run(here, &["select", name, "--cases", "1", "--out", &format!("one-{name}")]);
        let told = out.lines().find(|line| line.starts_with("SELECTED 1 of ")).unwrap_or_else(|| panic!("{out}"));
        assert!(told.split(" spread").next().unwrap().ends_with(unit), "{told}");
        assert!(out.contains(&format!("worst{}", &unit[..unit.len() - 1])), "{out}");
    }
    let table = fs::read_to_string(here.join("flight/coverage.tsv")).unwrap();
    assert!(table.starts_with(
        "speed_from_m_s\tspeed_to_m_s\tturn_from_deg\tturn_to_deg\tclimb_from_deg\tclimb_to_deg\tcases\n"
    ));
    for (name, axes, all) in [
        ("flight", ["speed", "turn", "climb"].as_slice(), 100),
        ("drive", &["slope", "curvature", "slip"], 125),
        ("arm", &["joint", "place in range", "speed", "direction"], 6 * 8 * 4 * 3),
    ] {
        let (hit, of) = cells(&here.join(name));
        assert_eq!(of, all, "{name}");
        assert!(hit > 0 && hit < of, "{name}: {hit} of {of}");
        let object = json(here, &["report", name]);
        let told = &object["coverage"];
        assert_eq!((&told["hit"], &told["cells"]), (&hit.into(), &of.into()), "{object}");
        let names: Vec<&str> =
            told["grid"]["axes"].as_array().unwrap().iter().map(|axis| axis["name"].as_str().unwrap()).collect();
        assert_eq!(names, axes);
        let page = fs::read_to_string(here.join(name).join("report.html")).unwrap();
        assert!(page.contains("What was exercised") && page.contains(&format!("{hit} of {of} cells")), "{name}");
    }
}

/// A case that the executor failed on has a score and no deviation: it is no choice among those that have one.
#[test]
fn deviations_are_not_compared_with_scores() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let minimal = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/executors/minimal_executor.py");
    let point = fs::read_to_string(minimal).unwrap();
    let sick = "        if message[\"case\"] == \"0002\":\n            sys.exit(1)\n        fly(message)\n";
    fs::write(here.join("sick.py"), point.replace("        fly(message)\n", sick)).unwrap();
    let fly = ["--executor", "python3 sick.py", "--set", "execute.workers=1", "--out", "all"];
    run(here, &[&SMALL[..], &fly].concat());
    let (_, out, error) = run(here, &["select", "all", "--cases", "1", "--by", "stress", "--out", "one", "--json"]);
    assert!(error.contains("1 of ") && error.contains("left out: 0002"), "{error}");
    let chosen: Value = serde_json::from_str(&out).unwrap();
    // The point never leaves its path by 0.1 m, and scores add up to more than 1.
    let worst = number(&chosen["all"]["worst"]);
    assert!(worst < 0.1 && chosen["selected"]["stress"] == chosen["all"]["worst"], "{chosen}");
    assert!(chosen["cases"][0] != "0002", "{chosen}");
    // Who flew them is named in what is said of the few, too.
    assert_eq!(fs::read(here.join("one/executor.json")).unwrap(), fs::read(here.join("all/executor.json")).unwrap());
    let verdict = json(here, &["judge", "one"])["verdict"].clone();
    assert!(verdict.as_str().unwrap().contains("executor minimal executor"), "{verdict}");
    let all = number(&chosen["all"]["cases"]) as usize + 1;
    refused(
        here,
        &["select", "all", "--cases", &all.to_string(), "--out", "no"],
        &["cases that were executed and measured"],
    );
}

#[test]
fn a_choice_replaces_nothing_by_way_of_a_folder_that_is_not_there() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    run(here, &[&SMALL[..], &["--out", "all"]].concat());
    let before = contents(&here.join("all"));
    for typed in [
        &["select", "all", "--cases", "1", "--out", "new/../all"][..],
        &["generate", "demo-quadrotor", "--out", "new/../all"],
    ] {
        refused(here, typed, &["new/../all", "there is no folder new"]);
    }
    assert!(before == contents(&here.join("all")));
    // A motion that the table of runs has and the folder has not is missed, not passed over; what was measured of it
    // stands.
    let judged = json(here, &["judge", "all"]);
    fs::remove_file(here.join("all/executions/part-00000.parquet")).unwrap();
    assert_eq!(json(here, &["judge", "all"]), judged);
    refused(here, &["export", "all", "--to", "csv"], &["case 0000", "its motion is missing", "--resume"]);
}

#[test]
fn a_choice_of_a_choice_keeps_the_names_of_its_missions() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    run(here, &[&SMALL[..], &["--out", "all"]].concat());
    fs::create_dir(here.join("mine")).unwrap();
    for (name, top) in [("a", 5), ("b", 9), ("c", 12)] {
        fs::write(here.join(format!("mine/{name}.csv")), format!("x_m,y_m,z_m\n3,3,3\n3,3,{top}\n9,3,9\n")).unwrap();
    }
    run(here, &["execute", "all", "--missions", "mine"]);
    let missions = |folder: &str| -> Vec<String> {
        let tally = CampaignFolder::open(&here.join(folder)).unwrap().read_tally().unwrap();
        tally.missions
    };
    let first = json(here, &["select", "all", "--cases", "2", "--by", "stress", "--out", "two"]);
    let again = json(here, &["select", "two", "--cases", "1", "--by", "stress", "--out", "one"]);
    let all = missions("all");
    let named = |object: &Value| -> Vec<String> {
        let mut numbers: Vec<usize> =
            object["cases"].as_array().unwrap().iter().map(|case| case.as_str().unwrap().parse().unwrap()).collect();
        numbers.sort_unstable();
        numbers.into_iter().map(|number| all[number].clone()).collect()
    };
    assert_eq!((missions("two"), missions("one")), (named(&first), named(&again)));
}
