//! Programs that tell what no robot of the file does: the whole command says so, whichever rows are kept, and so does
//! `judge` on the folder.

use std::fs;
use std::path::Path;

use crate::commands::{copy, json};
use hairpin::campaign::{CaseResult, FullRate};
use hairpin_formats::folder::CampaignFolder;
use hairpin_formats::parquet::runs::{RunFacts, read_facts, write_facts};
use serde_json::Value;

const UNLIKE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/hostile/unlike_executor.py");
const FLIGHTS: [&str; 8] = [
    "stress",
    "demo-quadrotor",
    "--set",
    "generate.search.cases=2",
    "--set",
    "execute.repeat=1",
    "--set",
    "generate.limits.max_speed_m_s=3",
];
/// Limits that whoever leaves out most of the way keeps, and one that nobody breaks.
const SPEC: [&str; 2] = ["--set", "spec={ total_time = { max_s = 500 } }"];
const NEAR: [&str; 2] = ["--set", "spec={ deviation = { max_m = 0.3, from = \"leg\" } }"];
const FACTS: &str = "runs/part-00000.parquet";

/// What a judgement comes to, without the folder's name.
fn told(mut object: Value) -> Value {
    object.as_object_mut().unwrap().remove("paths");
    object
}

fn results(out: &Path) -> Vec<CaseResult> {
    CampaignFolder::open(out).unwrap().read_results().unwrap()
}

/// Executed with all rows kept and with none, and judged again: the same each time. What the first case says.
fn flown(here: &Path, mode: &str, spec: &[&str]) -> (String, String) {
    let executor = format!("python3 '{UNLIKE}' {mode}");
    let said = |out: &str| {
        let first = &results(&here.join(out))[0];
        (first.status.word().to_owned(), first.message.clone().unwrap_or_default())
    };
    let all = ["all", "none"].map(|keep| {
        let out = format!("{mode}-{keep}");
        let more = ["--executor", &executor, "--keep", keep, "--out", &out];
        let stressed = told(json(here, &[&FLIGHTS[..], spec, &more].concat()));
        let first = said(&out);
        let judged = told(json(here, &["judge", &out]));
        assert_eq!((&stressed["counts"], &first), (&judged["counts"], &said(&out)), "{out}");
        first
    });
    assert_eq!(all[0], all[1], "{mode}: rows that are kept change no result");
    let [first, _] = all;
    first
}

#[test]
fn what_no_robot_does_is_no_pass_in_campaigns() {
    let place = tempfile::tempdir().unwrap();
    let here = place.path();
    let expected: [(&str, &[&str], &str, &str); 5] = [
        ("straight", &SPEC, "pass", ""),
        ("leap", &SPEC, "inconclusive", " m/s, and ten times what its file allows is "),
        (
            "over",
            &SPEC,
            "inconclusive",
            "attitude: upside down (its up axis 180° from the vertical from t = 0.00 s on)",
        ),
        ("flip", &SPEC, "pass", ""),
        ("held", &NEAR, "inconclusive", " m may hide between two of them"),
    ];
    for (mode, spec, status, words) in expected {
        let (found, why) = flown(here, mode, spec);
        assert_eq!(found, status, "{mode}: {why}");
        assert!(why.contains(words), "{mode}: {why}");
    }
}

/// Rewrites what is known of runs.
fn change(out: &Path, change: &dyn Fn(RunFacts) -> RunFacts) {
    let facts: Vec<RunFacts> = read_facts(&out.join(FACTS)).unwrap().into_values().map(change).collect();
    write_facts(&out.join(FACTS), &facts).unwrap();
}

/// Random cases that nothing can fly are no mean to stand beside.
#[test]
fn what_no_robot_does_is_no_random_case() {
    let place = tempfile::tempdir().unwrap();
    let executor = format!("python3 '{UNLIKE}' some");
    let more = ["--set", "execute.baseline=12", "--executor", &executor, "--out", "some"];
    let found = json(place.path(), &[&FLIGHTS[..], &SPEC, &more].concat());
    let count = |key: &str| found["baseline"][key].as_u64().unwrap_or_else(|| panic!("{key}: {found}"));
    assert!(count("cases") > 0 && count("implausible") > 0, "{found}");
    assert_eq!((count("cases") + count("implausible"), count("failed"), count("executions")), (12, 0, 12), "{found}");
    let again = json(place.path(), &["judge", "some"]);
    assert_eq!(again["baseline"], found["baseline"]);
}

/// Of what earlier versions executed the rows tell, and where none were kept nobody knows.
#[test]
fn runs_that_nobody_looked_at_are_looked_at_or_open() {
    let place = tempfile::tempdir().unwrap();
    let here = place.path();
    for mode in ["straight", "leap"] {
        flown(here, mode, &SPEC);
        for keep in ["all", "none"] {
            let (out, older) = (format!("{mode}-{keep}"), format!("older-{mode}-{keep}"));
            copy(&here.join(&out), &here.join(&older));
            change(&here.join(&older), &|facts| {
                let full_rate = facts.full_rate.map(|known| Box::new(FullRate { implausible: None, ..*known }));
                RunFacts { full_rate, ..facts }
            });
            json(here, &["judge", &older]);
            let first = results(&here.join(&older)).remove(0);
            let now = results(&here.join(&out)).remove(0);
            if keep == "all" {
                assert_eq!((first.status, first.message), (now.status, now.message), "{older}");
            } else {
                let why = first.message.unwrap();
                assert_eq!(first.status.word(), "inconclusive", "{older}: {why}");
                assert!(why.contains("its rows were not kept"), "{older}: {why}");
            }
        }
    }
}

/// Drives every plan exactly, and leans over from half of the way on, more and more.
const LEANING: &str = "import json, math, sys\n\
say = lambda **words: print(json.dumps(words), flush=True)\n\
for line in sys.stdin:\n    \
    heard = json.loads(line)\n    \
    if heard['type'] == 'hello':\n        \
        say(type='ready', protocol=1, name='leaning')\n    \
    elif heard['type'] == 'mission':\n        \
        rows = [[one['t_s'], *one['p_m']] for one in heard['timed']]\n        \
        end = rows[-1][0]\n        \
        for t, x, y, z in rows:\n            \
            half = 0.5 * max(0.0, 4.0 * (t / end - 0.5))\n            \
            say(type='pose', t_s=t, p_m=[x, y, z], q_wxyz=[math.cos(half), math.sin(half), 0, 0])\n        \
        say(type='end', reason='done')\n";

#[test]
fn what_falls_over_does_when_it_first_did() {
    let place = tempfile::tempdir().unwrap();
    let here = place.path();
    fs::write(here.join("leaning.py"), LEANING).unwrap();
    let drives = [
        "stress",
        "rover",
        "--set",
        "task.length=4",
        "--set",
        "generate.manoeuvres=[\"forward\"]",
        "--set",
        "generate.search={ score = \"slope+slip\", waypoints = 24, cases = 1 }",
        "--set",
        "execute.repeat=1",
        "--set",
        "world.terrain={ generator = \"craters\", size_m = 60, cell_m = 0.2 }",
        "--set",
        "spec.limits={ total_time_s = 1000 }",
        "--executor",
        "python3 leaning.py",
    ];
    for keep in ["all", "none"] {
        let stressed = json(here, &[&drives[..], &["--keep", keep, "--out", keep]].concat());
        assert_eq!(stressed["exit_code"], 1, "{stressed}");
        for again in [false, true] {
            if again {
                json(here, &["judge", keep]);
            }
            let first = results(&here.join(keep)).remove(0);
            let (measures, fell) = (first.measures.unwrap(), &first.violations[0]);
            assert_eq!(fell.what, "tip-over", "{fell:?}");
            // A third of a turn at its end, where it leans most: beyond its 45° and 5° it is after 0.72 of the way.
            assert!((0.70..0.75).contains(&(fell.at / measures.total_time)), "{keep}: {fell:?}");
            assert!(measures.t_tilt > 0.98 * measures.total_time, "{keep}: {measures:?}");
        }
    }
}
