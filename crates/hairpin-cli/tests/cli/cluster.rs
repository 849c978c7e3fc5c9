//! One campaign on several machines: the folder is the one that a single machine makes, whoever made which part, in
//! which order, and who was killed at it.
#![cfg(unix)]

use std::fs;
use std::process::Stdio;
use std::thread::sleep;
use std::time::{Duration, Instant};

use crate::commands::{assert_same, hairpin, json, refused, run};
use crate::guides::run_page;

/// Drives and boats in parts by graphs, and an arm, whose search is one; flights are the other tests'.
const KINDS: [(&str, &str); 3] = [
    (
        "drive",
        r#"
hairpin = 1
robot = { kind = "car", name = "any car", wheelbase_m = 1.0, speed_m_s = 3.0, limits = { steering_deg = 40, steering_rate_deg_s = 9000, speed_m_s = 3.0, acceleration_m_s2 = 900 } }
seed = 5
[world]
terrain = { generator = "flat", size_m = 96.0, cell_m = 0.96 }
[task]
start = { x_m = 48, y_m = 48, yaw_deg = 30 }
length = 2
leg_m = [4, 12]
[generate]
manoeuvres = ["forward"]
headings = 2
search = { method = "beam", score = "curvature-change", waypoints = 10, cases = 2 }
[execute]
controller = "stanley"
repeat = 1
[spec]
limits = { path_deviation_m = 0.05 }
"#,
    ),
    (
        "boat",
        r#"
hairpin = 1
robot = "cybership-ii"
seed = 5
[world]
size_m = [60, 60]
[task]
start_m = [27, 27]
end_m = [33, 33]
length = 2
[generate]
leg_time_s = [60, 300]
search = { method = "beam", waypoints = 30, cases = 2 }
[execute]
repeat = 1
time_limit_s = 400
[spec]
deviation = { max_m = 0.1 }
"#,
    ),
    (
        "arm",
        r#"
hairpin = 1
robot = "irb120"
seed = 5
[world]
tool = { name = "tGrip", declare = true, tcp_mm = [0, 0, 60], radius_mm = 20 }
[task]
points = [[300, -100, 300], [350, 50, 400], [280, 120, 350], [320, 0, 260]]
[generate]
mode = "joint"
moves = { kind = "joint", speeds = ["v1000"], zones = ["fine"] }
search = { programs = 2 }
[execute]
repeat = 1
[spec]
path = { max_mm = 0.5 }
"#,
    ),
];

#[test]
fn the_commands_of_the_page_on_clusters_run() {
    run_page("cluster.md");
}

#[test]
fn shards_of_every_kind_make_the_folder_that_one_machine_makes() {
    let place = tempfile::tempdir().unwrap();
    let place = place.path();
    for (kind, text) in KINDS {
        let (scenario, one, many) = (format!("{kind}.toml"), format!("{kind}-one"), format!("{kind}-many"));
        fs::write(place.join(&scenario), text).unwrap();
        let (code, out, error) = run(place, &["stress", &scenario, "--out", &one, "--set", "execute.baseline=1"]);
        assert!([0, 1].contains(&code), "{kind}: {out}{error}");
        let planned = json(place, &["plan", &scenario, "--out", &many, "--set", "execute.baseline=1"]);
        let by = if kind == "arm" { ("search", 3) } else { ("graph", 2) };
        assert_eq!((planned["unit"].as_str(), planned["parts"].as_i64()), (Some(by.0), Some(by.1)), "{planned}");
        refused(place, &["merge", &many], &["missing", "part-00000"]);
        for shard in ["2/2", "1/2"] {
            json(place, &["run-shard", shard, &many]);
        }
        let merged = json(place, &["merge", &many, "--remove-parts"]);
        assert_eq!(merged["judged"]["exit_code"], code, "{kind}");
        assert_same(&place.join(one), &place.join(many));
    }
}

#[test]
fn a_shard_that_is_killed_is_run_again() {
    let place = tempfile::tempdir().unwrap();
    let place = place.path();
    let plan = ["plan", "demo-quadrotor", "--cases", "4", "--set", "execute.repeat=1", "--set", "execute.baseline=0"];
    let hash = |folder: &str| json(place, &["merge", folder])["content_hash"].as_str().unwrap().to_owned();
    for folder in ["calm", "hit"] {
        json(place, &[&plan[..], &["--out", folder]].concat());
    }
    json(place, &["run-shard", "1/1", "calm"]);
    let mut command = hairpin(place, &["run-shard", "--shard", "1/1", "hit", "--threads", "1"]);
    let mut child = command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
    let parts = || fs::read_dir(place.join("hit/parts")).map_or(0, |entries| entries.count());
    let begun = Instant::now();
    // Two are there, or one and what is made of another.
    while parts() < 2 && child.try_wait().unwrap().is_none() && begun.elapsed() < Duration::from_secs(60) {
        sleep(Duration::from_millis(1));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    // Its share falls to others, however they divide it.
    let made: i64 =
        (1..=3).map(|i| json(place, &["run-shard", &format!("{i}/3"), "hit"])["parts"]["made"].as_i64().unwrap()).sum();
    assert!(made < 4, "{made}");
    assert_eq!(hash("calm"), hash("hit"));
    // Once more is the same, and an ordinary campaign is what is left.
    assert_eq!(hash("hit"), hash("calm"));
    for verb in ["judge", "report", "verify"] {
        let (code, out, error) = run(place, &[verb, "hit"]);
        assert!([0, 1].contains(&code), "{verb}: {out}{error}");
    }
    assert_eq!(run(place, &["compare", "calm", "hit"]).0, 0);
}

/// A point that flies from waypoint to waypoint in no time, and takes its time to say so.
const SLOW: &str = r#"
import json, sys, time
say = lambda **message: print(json.dumps(message), flush=True)
for line in sys.stdin:
    message = json.loads(line)
    if message["type"] == "hello":
        say(type="ready", protocol=1, name="slow")
    elif message["type"] == "mission":
        time.sleep(0.03)
        w = message["waypoints_m"]
        for k in range(20 * (len(w) - 1) + 1):
            i, u = min(k // 20, len(w) - 2), k / 20 - min(k // 20, len(w) - 2)
            x, y, z = [a + u * (b - a) for a, b in zip(w[i], w[i + 1])]
            say(type="pose", t_s=k / 20, p_m=[x, y + 0.1 * (i % 2), z], q_wxyz=[1, 0, 0, 0], leg=i)
        say(type="end", reason="done")
    elif message["type"] == "bye":
        break
"#;

#[test]
fn a_shard_that_is_killed_in_a_round_holds_up_no_other() {
    let place = tempfile::tempdir().unwrap();
    let place = place.path();
    fs::write(place.join("slow.py"), SLOW).unwrap();
    let search = "generate.search={ method = 'worst', waypoints = 60, cases = 2, executions = 30 }";
    let few = ["--set", search, "--set", "execute.repeat=1", "--set", "execute.baseline=0"];
    let flown_by = ["--executor", "python3 slow.py", "--set", "execute.processes=1"];
    for verb in [["stress", "one"], ["plan", "many"]] {
        let words = [&[verb[0], "demo-quadrotor", "--out", verb[1]], &few[..], &flown_by].concat();
        assert!([0, 1].contains(&run(place, &words).0), "{verb:?}");
    }
    let start = |shard: &str| {
        let mut command = hairpin(place, &["run-shard", shard, "many", "--threads", "1", "--json"]);
        command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap()
    };
    let executed = || {
        let rounds = fs::read_dir(place.join("many/parts")).into_iter().flatten().flatten();
        let rounds = rounds.filter(|entry| entry.file_name().to_string_lossy().starts_with("rounds-"));
        let files = rounds.flat_map(|entry| fs::read_dir(entry.path()).unwrap()).flatten();
        files.filter(|file| file.path().extension().is_some_and(|extension| extension == "tsv")).count()
    };
    let (mut killed, mut other) = (start("1/3"), start("2/3"));
    let begun = Instant::now();
    while executed() < 15 && begun.elapsed() < Duration::from_secs(60) {
        sleep(Duration::from_millis(2));
    }
    killed.kill().unwrap();
    killed.wait().unwrap();
    assert!(executed() < 60, "it was too late to be killed");
    // The third comes late.
    assert!(start("3/3").wait().unwrap().success() && other.wait().unwrap().success());
    assert_eq!(executed(), 60, "each has one result");
    json(place, &["run-shard", "1/3", "many"]);
    json(place, &["merge", "many", "--remove-parts"]);
    assert_same(&place.join("one"), &place.join("many"));
}

/// A scheduler that tries what ends with 4 again flies what no program could be started for.
#[test]
fn a_shard_without_its_program_is_exit_code_4() {
    let place = tempfile::tempdir().unwrap();
    let place = place.path();
    let search = "generate.search={ method = 'uniform', waypoints = 60, cases = 2 }";
    let few = ["--set", search, "--set", "execute.repeat=1", "--set", "execute.baseline=0"];
    let plan = [&["plan", "demo-quadrotor", "--out", "wide", "--executor", "./not-there"][..], &few].concat();
    assert_eq!(run(place, &plan).0, 0);
    let again = "2 of its runs were not flown, as no program could be started: the same command again flies them";
    for _ in 0..2 {
        let (code, out, _) = run(place, &["run-shard", "1/1", "wide", "--json"]);
        let object: serde_json::Value = serde_json::from_str(&out).unwrap();
        assert_eq!((code, object["exit_code"].as_i64(), object["told"].as_str()), (4, Some(4), Some(again)), "{out}");
        assert_eq!(object["counts"], serde_json::json!({ "cases": 2, "executor_failed": 2, "never_asked": 2 }));
        let (code, out, _) = run(place, &["run-shard", "1/1", "wide"]);
        assert_eq!(code, 4);
        assert_eq!(
            out.lines().collect::<Vec<_>>(),
            ["SHARD 1/1: 2 of 2 parts with 2 cases, 2 made and 0 there", again]
        );
    }
}

#[test]
fn what_is_no_plan_or_no_shard_is_refused() {
    let place = tempfile::tempdir().unwrap();
    let place = place.path();
    let plan = ["plan", "demo-quadrotor", "--out", "wide", "--set", "generate.search.cases=2"];
    assert_eq!(run(place, &plan).0, 0);
    refused(place, &["run-shard", "3/2", "wide"], &["3/2", "i from 1 to N"]);
    refused(place, &["run-shard", "wide"], &["which shard?"]);
    refused(place, &["run-shard", "--shard", "from-env", "wide"], &["SLURM_ARRAY_TASK_ID", "JOB_COMPLETION_INDEX"]);
    refused(place, &["run-shard", "1/2", "elsewhere"], &["elsewhere"]);
    refused(place, &plan, &["--resume", "--force"]);
    refused(place, &[&plan[..], &["--resume", "--parts", "1"]].concat(), &["divided otherwise"]);
    refused(place, &[&plan[..], &["--force", "--parts", "3"]].concat(), &["--parts 3", "1 to 2"]);
    let (code, out, _) = run(place, &["stress", "demo-quadrotor", "--out", "one", "--set", "generate.search.cases=1"]);
    assert!([0, 1].contains(&code), "{out}");
    refused(place, &["merge", "one"], &["not divided"]);
}
