//! Controllers of the user's own on our plants: Python functions and programs steer as ours do, are kept with what they
//! steered, and what they do wrong costs the run that it befell.

use std::fs;
use std::path::Path;

use crate::commands::{assert_same, copy, json, refused, run, small_hull};
use hairpin::campaign::{execute_run, judge, vary};
use hairpin::robot::quadrotor::Quadrotor;
use hairpin::simulation::{Controller, Fault, FlightCommand, FlightState, OwnController, Reference};
use hairpin_formats::folder::CampaignFolder;
use hairpin_formats::scenario::setup_for;
use serde_json::Value;

const EXAMPLES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/controllers");

/// Trajectories by chance, flown by `controller`.
fn scenario(controller: &str) -> String {
    small_hull("{ method = \"uniform\", waypoints = 60, cases = 4 }")
        .replace("controller = \"minimum-snap\"", &format!("controller = {controller:?}\ntimeout_s = 20.0"))
}

fn example(name: &str, here: &Path) {
    fs::copy(Path::new(EXAMPLES).join(name), here.join(name)).unwrap();
}

fn worst(folder: &Path) -> Vec<f64> {
    let results = CampaignFolder::open(folder).unwrap().read_results().unwrap();
    results.iter().map(|result| result.measures.as_ref().unwrap().max_deviation).collect()
}

/// The example as Rust has it.
struct Pd;

impl Controller<Quadrotor> for Pd {
    fn control(&mut self, _dt: f64, now: &FlightState, to: &Reference<Quadrotor>) -> Result<FlightCommand, Fault> {
        let pull = ((to.target() - now.position) * 2.0).cap_magnitude(4.0 * 2.5);
        Ok(FlightCommand::Acceleration(pull - now.velocity * 2.5))
    }
}

#[test]
fn a_function_a_program_and_rust_fly_alike() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    example("pd.py", here);
    example("pd_program.py", here);
    fs::write(here.join("python.toml"), scenario("python:pd.py")).unwrap();
    fs::write(here.join("program.toml"), scenario("command: python3 pd_program.py")).unwrap();
    let told = ["python", "program"].map(|name| json(here, &["stress", &format!("{name}.toml"), "--out", name]));
    let words = ["python:pd.py on hairpin's inner loops", "command: python3 pd_program.py on hairpin's inner loops"];
    for (told, words) in told.iter().zip(words) {
        assert!(told["verdict"].as_str().unwrap().contains(words), "{told}");
    }
    assert_eq!(fs::read(here.join("python/pd.py")).unwrap(), fs::read(here.join("pd.py")).unwrap());
    // Rust has the same controller, and nothing in common with Python but the plant.
    let kept = CampaignFolder::open(&here.join("python")).unwrap();
    let plain = scenario("stable-waypoint");
    fs::write(here.join("plain.toml"), plain).unwrap();
    let setup = setup_for(&here.join("plain.toml").to_string_lossy(), &[]).unwrap();
    let setup = setup.with_controller(OwnController::new("pd", |_: &Quadrotor| Pd)).unwrap();
    let rust: Vec<f64> = kept
        .read_cases()
        .unwrap()
        .iter()
        .map(|case| judge(&setup, case, &[execute_run(&setup, case, 0)]).unwrap().measures.unwrap().max_deviation)
        .collect();
    let [python, program] = ["python", "program"].map(|name| worst(&here.join(name)));
    assert_eq!(python, program);
    assert!(python.len() == 4 && python.iter().zip(&rust).all(|(a, b)| (a - b).abs() < 1e-9), "{python:?} {rust:?}");
}

#[test]
fn a_folder_flies_again_with_what_it_kept() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    example("pd.py", here);
    fs::write(here.join("q.toml"), scenario("python:pd.py")).unwrap();
    let search = ["stress", "q.toml", "--set", "spec.deviation.max_m=0.01"];
    let first = json(here, &[&search[..], &["--out", "a", "--threads", "1"]].concat());
    json(here, &[&search[..], &["--out", "b", "--threads", "2"]].concat());
    assert_same(&here.join("a"), &here.join("b"));
    fs::remove_file(here.join("pd.py")).unwrap();
    for again in
        [&["execute", "a"][..], &["judge", "a"], &["verify", "a"], &["report", "a"], &["replay", "a/repro/0000.json"]]
    {
        let (code, out, error) = run(here, again);
        assert!([0, 1].contains(&code), "{again:?}: {out}{error}");
    }
    assert_same(&here.join("a"), &here.join("b"));
    assert_eq!(json(here, &["judge", "a"])["verdict"], first["verdict"]);
    // Elsewhere, and with another file, it is a stranger's.
    copy(&here.join("a"), &here.join("theirs"));
    fs::write(here.join("theirs/pd.py"), "open('here', 'w')\n").unwrap();
    refused(here, &["execute", "theirs"], &["pd.py", "execute.controller", "--allow-commands"]);
    assert!(!here.join("here").exists() && !here.join("theirs/here").exists());
}

#[test]
fn the_default_search_stresses_it() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    example("pd.py", here);
    let search = "{ method = \"worst\", waypoints = 80, cases = 2, executions = 40 }";
    let text = small_hull(search).replace("\"minimum-snap\"", "\"python:pd.py\"\ncontrol_rate_hz = 25.0");
    fs::write(here.join("q.toml"), text).unwrap();
    let told = json(here, &["stress", "q.toml", "--out", "a", "--set", "execute.baseline=8"]);
    let verdict = told["verdict"].as_str().unwrap();
    assert!(verdict.contains("flown; random feasible ones"), "{verdict}");
    let kept = CampaignFolder::open(&here.join("a")).unwrap();
    let chance = kept.read_baseline().unwrap().unwrap();
    let by_chance: Vec<f64> = chance.iter().map(|one| one.measures.as_ref().unwrap().max_deviation).collect();
    let mean = by_chance.iter().sum::<f64>() / by_chance.len() as f64;
    let found = worst(&here.join("a"));
    assert!(by_chance.len() == 8 && found.iter().all(|one| *one > mean), "{found:?} {by_chance:?}");
}

/// What one that goes wrong says, in its first runs or all of them.
#[test]
fn what_goes_wrong_costs_its_own_run() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let good = fs::read_to_string(Path::new(EXAMPLES).join("pd.py")).unwrap();
    // Whether it goes wrong depends on the mission: of four cases some do.
    let sick = |what: &str| {
        format!(
            "{good}\nimport os, sys, time\ngood = control\ndef control(t_s, state, reference):\n    \
             if t_s > 0.5 and reference[\"waypoints_m\"][1][1] > 3.0:\n        {what}\n    \
             return good(t_s, state, reference)\n"
        )
    };
    for (what, words) in [
        ("raise ValueError('no thrust left')", "ValueError: no thrust left"),
        ("os._exit(3)", "it ended without an answer"),
        ("return {'a_m_s2': [float('nan'), 0.0, 0.0]}", "numbers that are not finite"),
        ("return {'a_m_s2': [1.0, 2.0]}", "must be one of {\"v_m_s\"}"),
        ("return {'v_m_s': [0.0, 0.0, 0.0], 'thrust_n': 3.0}", "must be one of {\"v_m_s\"}"),
        ("return {'speed': [0.0, 0.0, 0.0]}", "unknown field `speed`"),
        ("return {'thrust_n': 10.0, 'q_wxyz': [1.0, 1.0, 0.0, 0.0]}", "must have the norm 1"),
        ("return None", "None is no dictionary"),
        ("os.write(1, b'x' * 100); sys.stdout.write('y' * 3_000_000); raise OSError('flooded')", "OSError: flooded"),
    ] {
        fs::write(here.join("sick.py"), sick(what)).unwrap();
        let text = scenario("python:sick.py").replace("timeout_s", "control_rate_hz = 25.0\ntimeout_s");
        fs::write(here.join("q.toml"), text).unwrap();
        let (code, out, error) =
            run(here, &["stress", "q.toml", "--out", "a", "--force", "--set", "spec.deviation.max_m=50"]);
        assert_eq!(code, 4, "{what}: {out}{error}");
        assert!(out.contains("EXECUTOR FAILED") || error.contains("EXECUTOR FAILED"), "{what}: {out}{error}");
        let kept = CampaignFolder::open(&here.join("a")).unwrap();
        let results = kept.read_results().unwrap();
        let failed: Vec<&str> = results.iter().filter_map(|result| result.message.as_deref()).collect();
        assert!(!failed.is_empty() && failed.len() < 4, "{what}: {} of {} failed", failed.len(), results.len());
        let told = |text: &&str| text.contains("controller `python:sick.py` at t = 0.5") && text.contains(words);
        assert!(failed.iter().all(told), "{what}: {failed:?}");
    }
}

#[test]
fn a_program_that_hangs_is_given_up() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    fs::write(here.join("hangs.py"), "import time\ndef control(t_s, state, reference):\n    time.sleep(600)\n")
        .unwrap();
    let text = scenario("python:hangs.py").replace("timeout_s = 20.0", "timeout_s = 0.3");
    fs::write(here.join("q.toml"), text).unwrap();
    let begun = std::time::Instant::now();
    let (code, out, error) =
        run(here, &["stress", "q.toml", "--out", "a", "--set", "generate.search.cases=8", "--threads", "1"]);
    assert!(code == 4 && begun.elapsed().as_secs() < 30, "{out}{error}");
    let kept = CampaignFolder::open(&here.join("a")).unwrap().read_results().unwrap();
    let told: Vec<&str> = kept.iter().filter_map(|result| result.message.as_deref()).collect();
    assert!(told.len() == 8 && told[0].contains("not over after 0.3 s"), "{told:?}");
    assert!(told[7].contains("3 runs in a row") || told[3].contains("3 runs in a row"), "{told:?}");
}

/// A line for each turn: no more of them, none later than a run may take, and no others.
#[test]
fn programs_that_fall_out_of_step_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let good = fs::read_to_string(Path::new(EXAMPLES).join("pd_program.py")).unwrap();
    let answer = "    print(json.dumps({\"a_m_s2\": command}), flush=True)\n";
    let (late, unasked) = ("its run was not over after 0.3 s", "where nothing was asked");
    // Whose answer comes first is chance, and so is whether the other's comes amid it.
    let torn = "where nothing was asked|must be a line of JSON";
    for (limit, does, words) in [
        ("0.3", "    __import__('time').sleep(600)\n", late),
        ("0.3", "    __import__('time').sleep(0.01)\n", late),
        ("20.0", answer, unasked),
        ("20.0", &format!("    while True:\n    {answer}"), unasked),
        ("20.0", "    if asked[\"t_s\"] == 0.0:\n        __import__('os').fork()\n", torn),
        ("20.0", "    sys.exit('no thrust left')\n", "no thrust left"),
        ("20.0", "    command[0] = float('nan')\n", "NaN"),
    ] {
        assert!(good.ends_with(answer));
        fs::write(here.join("sick.py"), good.replace(answer, &format!("{does}{answer}"))).unwrap();
        let text = scenario("command: python3 sick.py").replace("timeout_s = 20.0", &format!("timeout_s = {limit}"));
        fs::write(here.join("q.toml"), text).unwrap();
        let one = ["--set", "generate.search.cases=1", "--set", "spec.deviation.max_m=50"];
        let told = json(here, &[&["stress", "q.toml", "--out", "a", "--force"], &one[..]].concat());
        let verdict = told["verdict"].as_str().unwrap();
        assert_eq!(told["exit_code"], 4, "{does}: {told}");
        assert!(verdict.starts_with("EXECUTOR FAILED 1/1"), "{does}: {verdict}");
        assert!(words.split('|').any(|words| verdict.contains(words)), "{does}: {verdict}");
    }
}

#[test]
fn what_cannot_steer_is_refused_before_anything_flies() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    for (body, words) in [
        ("def control(t_s, state, reference)\n    pass\n", &["execute.controller", "SyntaxError"][..]),
        ("def steer():\n    pass\n", &["no function control(t_s, state, reference)"]),
        ("import no_such_module_here\n", &["ModuleNotFoundError", "no_such_module_here"]),
    ] {
        fs::write(here.join("c.py"), body).unwrap();
        fs::write(here.join("q.toml"), scenario("python:c.py")).unwrap();
        refused(here, &["stress", "q.toml", "--out", "a"], words);
    }
    example("pd.py", here);
    let given = |text: String| fs::write(here.join("q.toml"), text).unwrap();
    for (controller, words) in [
        ("python:none.py", &["execute.controller", "`none.py` cannot be read"][..]),
        ("python:", &["execute.controller"]),
        ("command:", &["execute.controller", "is empty"]),
        ("command: hairpin-no-such-program", &["`hairpin-no-such-program` cannot be started"]),
        ("pythn:pd.py", &["execute.controller", "minimum-snap"]),
    ] {
        given(scenario(controller));
        refused(here, &["stress", "q.toml", "--out", "a"], words);
    }
    let python = scenario("python:pd.py");
    let with = |key: &str| python.replace("timeout_s = 20.0", &format!("timeout_s = 20.0\n{key}"));
    given(with("command = \"sim\""));
    refused(here, &["stress", "q.toml", "--out", "a"], &["execute.command", "one of the two"]);
    given(with("control_rate_hz = 5000.0"));
    refused(here, &["stress", "q.toml", "--out", "a"], &["execute.control_rate_hz", "1000"]);
    given(format!("{python}\n[vary]\n\"execute.controller\" = {{ choice = [\"anafi\", \"geometric\"] }}\n"));
    refused(here, &["stress", "q.toml", "--out", "a"], &["execute.controller", "left out"]);
    given(scenario("minimum-snap").replace("timeout_s = 20.0", "control_rate_hz = 50.0"));
    refused(here, &["stress", "q.toml", "--out", "a"], &["execute.control_rate_hz", "no controller of yours"]);
    assert!(!here.join("a").exists());
}

/// What it may remember, and what it is told: with `reset` the file is loaded once, without it anew for each run.
#[test]
fn each_run_begins_afresh() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let log = here.join("log");
    let body = |reset: &str| {
        format!(
            "import json\nturns = 0\n{reset}\ndef control(t_s, state, reference):\n    global turns\n    turns += 1\n    \
             if turns in (1, 2):\n        open({log:?}, 'a').write(json.dumps([turns, t_s, state, reference]) + '\\n')\n    \
             return {{'v_m_s': [0.0, 0.0, 0.0]}}\n"
        )
    };
    let reset = format!("def reset(mission):\n    open({log:?}, 'a').write(json.dumps([0, mission]) + '\\n')\n");
    for (out, text, lines, control_lines) in [("a", body(""), 8, 8), ("b", body(&reset), 6, 2)] {
        let _ = fs::remove_file(&log);
        fs::write(here.join("c.py"), text).unwrap();
        fs::write(here.join("q.toml"), scenario("python:c.py").replace("[spec]", "time_limit_s = 1.0\n[spec]"))
            .unwrap();
        let rate = "execute.control_rate_hz=50";
        let (code, told, error) = run(here, &["stress", "q.toml", "--out", out, "--threads", "1", "--set", rate]);
        assert!([0, 1].contains(&code), "{told}{error}");
        let told = fs::read_to_string(&log).unwrap();
        let told: Vec<Value> = told.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
        let turns = told.iter().filter(|line| line[0] != 0).count();
        assert_eq!((told.len(), turns), (lines, control_lines), "{told:?}");
        let first = told.iter().find(|line| line[0] == 1).unwrap();
        assert_eq!((first[1].as_f64(), first[2]["p_m"].clone()), (Some(0.0), serde_json::json!([2.0, 2.0, 5.0])));
        let second = told.iter().find(|line| line[0] == 2).unwrap();
        assert!((second[1].as_f64().unwrap() - 0.02).abs() < 1e-9, "{second}");
        let reference = &first[3];
        assert!(reference["next"].is_u64() && reference["waypoints_m"].as_array().unwrap().len() == 5, "{reference}");
        if let Some(mission) = told.iter().find(|line| line[0] == 0) {
            assert_eq!(mission[1]["robot"]["kind"], "quadrotor");
            assert_eq!(mission[1]["accept_m"], 1.0);
        }
    }
}

#[test]
fn what_drives_and_what_sails_is_steered_too() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    example("pursuit.py", here);
    fs::write(
        here.join("boat.py"),
        "import math\ndef control(t_s, state, reference):\n    \
         c, s = math.cos(state['yaw_rad']), math.sin(state['yaw_rad'])\n    \
         e = [20 * (p - q) + 40 * (v - w) for p, q, v, w in zip(reference['p_m'], state['p_m'], reference['v_m_s'], state['v_m_s'])]\n    \
         turn = math.remainder(reference['yaw_rad'] - state['yaw_rad'], 2 * math.pi)\n    \
         return {'force_n': [c * e[0] + s * e[1], c * e[1] - s * e[0]], 'moment_n_m': 10 * turn - 10 * state['w_rad_s'][2]}\n",
    )
    .unwrap();
    for (scenario, file) in [("demo-rover", "pursuit.py"), ("boat", "boat.py")] {
        let controller = format!("execute.controller=\"python:{file}\"");
        let words = [
            "--set",
            "generate.search.cases=2",
            "--set",
            "generate.search.method=\"uniform\"",
            "--set",
            "generate.search.waypoints=16",
            "--set",
            "execute.repeat=1",
            "--set",
            "task.length=3",
            "--set",
            "execute.control_rate_hz=20",
        ];
        let told = json(here, &[&["stress", scenario, "--out", scenario, "--set", &controller][..], &words].concat());
        assert!(told["verdict"].as_str().unwrap().contains(&format!("python:{file}")), "{told}");
        assert_ne!(told["exit_code"], 4, "{told}");
        let kept = CampaignFolder::open(&here.join(scenario)).unwrap();
        let done = kept.read_results().unwrap().iter().filter(|result| result.message.is_none()).count();
        assert_eq!(done, 2);
    }
}

/// On the servos of the virtual controller: who tracks its plan comes as near as that does, who lags does not.
#[test]
fn arms_are_steered_too() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let arm = |name: &str, forward: f64, gain: f64| {
        let body = format!(
            "def control(t_s, state, reference):\n    \
             return {{'dq_rad_s': [{forward} * w + {gain} * (a - q) for w, a, q in \
             zip(reference['dq_rad_s'], reference['q_rad'], state['q_rad'])]}}\n"
        );
        fs::write(here.join(name), body).unwrap();
    };
    arm("tracks.py", 1.0, 10.0);
    arm("lags.py", 0.0, 5.0);
    let ran = |out: &str, controller: &str| {
        let controller = format!("execute.controller=\"{controller}\"");
        let keys = ["generate.search.programs=1", "execute.faults={}", "execute.noise_mm=0.0"];
        let sets = keys.into_iter().chain([controller.as_str()]).flat_map(|key| ["--set", key]);
        let words = ["stress", "demo-arm", "--out", out].into_iter().chain(sets).collect::<Vec<_>>();
        let told = json(here, &words);
        assert!(told["exit_code"] == 0 || told["exit_code"] == 1, "{told}");
        (worst(&here.join(out))[0], told["verdict"].as_str().unwrap().to_owned())
    };
    let (own, verdict) = ran("tracks", "python:tracks.py");
    assert!(verdict.contains("python:tracks.py on hairpin's servos"), "{verdict}");
    let (ours, _) = ran("ours", "virtual");
    let (late, _) = ran("lags", "python:lags.py");
    assert!((own - ours).abs() < 0.01 && late > own + 0.01, "{own} {ours} {late}");
}

/// The limit of a search's time is none of who steers: what was found is flown after it.
#[test]
fn a_search_that_ran_out_of_time_is_executed_all_the_same() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    example("pd.py", here);
    let search = "{ method = \"worst\", waypoints = 60, cases = 2, executions = 4000 }";
    let text = small_hull(search).replace("\"minimum-snap\"", "\"python:pd.py\"");
    fs::write(here.join("q.toml"), text).unwrap();
    let told = json(here, &["stress", "q.toml", "--out", "a", "--time-limit", "2"]);
    assert!(told["counts"]["cases"].as_u64().unwrap() > 0, "{told}");
    assert_eq!(told["counts"]["executor_failed"], 0, "{told}");
    let verdict = told["verdict"].as_str().unwrap();
    assert!(verdict.contains("; the search was stopped before its end, after "), "{verdict}");
}

/// A scenario that names code which was not read is steered by nobody else in its place.
#[test]
fn another_word_is_another_controller() {
    let folder = tempfile::tempdir().unwrap();
    example("pd.py", folder.path());
    let file = folder.path().join("q.toml");
    fs::write(&file, scenario("python:pd.py")).unwrap();
    let setup = setup_for(&file.to_string_lossy(), &[]).unwrap();
    assert_eq!(setup.controller(), Some("python:pd.py"));
    let with = |word: &str| {
        let changes = [("execute.controller".to_owned(), word.into())];
        setup.changed(vary::apply(&setup.scenario, &changes).unwrap())
    };
    assert_eq!(with("anafi").unwrap().controller(), Some("anafi"));
    let refused = with("python:other.py").unwrap_err();
    assert_eq!((refused.key.as_str(), refused.bound.as_str()), ("execute.controller", "read with its scenario"));
}

/// Searches that execute, with little.
const SEARCHES: [&str; 3] = [
    r#"{ method = "worst", waypoints = 60, cases = 2, executions = 16 }"#,
    r#"{ method = "in-loop", waypoints = 60, cases = 2, executions = 16, move_waypoints = true }"#,
    r#"{ method = "adaptive", waypoints = 120, cases = 2, executions = 26, rounds = 2 }"#,
];

/// Hull legs that `search` executes, steered by `controller`.
fn searched(search: &str, controller: &str) -> String {
    scenario(controller).replace("{ method = \"uniform\", waypoints = 60, cases = 4 }", search)
}

/// It gives up on about every third mission; so does the program.
const GIVES_UP: &str = "def control(t_s, state, reference):\n    \
    if round(1000 * reference['waypoints_m'][1][0]) % 3 == 0:\n        \
    raise RuntimeError('no table for this')\n    \
    target = reference['waypoints_m'][min(reference['next'], len(reference['waypoints_m']) - 1)]\n    \
    return {'v_m_s': [goal - at for goal, at in zip(target, state['p_m'])]}\n";

#[test]
fn a_search_in_which_a_controller_fails_passes_of_nothing_and_says_so() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    fs::write(here.join("part.py"), GIVES_UP).unwrap();
    let wide = ["--set", "spec.deviation.max_m=1000", "--set", "execute.baseline=6", "--json"];
    for (place, search) in SEARCHES.into_iter().enumerate() {
        fs::write(here.join("q.toml"), searched(search, "python:part.py")).unwrap();
        let mut kept = Vec::new();
        for threads in ["1", "2"] {
            let out = format!("{place}-{threads}");
            let arguments = [&["stress", "q.toml", "--out", &out, "--threads", threads][..], &wide].concat();
            let (code, said, error) = run(here, &arguments);
            assert_eq!(code, 4, "{said}{error}");
            let told: Value = serde_json::from_str(&said).unwrap();
            let (failed, of) =
                (told["search"]["failed"].as_u64().unwrap(), told["search"]["executions"].as_u64().unwrap());
            assert!(0 < failed && failed < of, "{told}");
            let verdict = told["verdict"].as_str().unwrap();
            let begins = format!(
                "EXECUTOR FAILED {failed}/{of} executions of the search (controller `python:part.py` at t = 0 s: "
            );
            assert!(verdict.starts_with(&begins) && verdict.contains("no table for this"), "{verdict}");
            assert!(verdict.contains("; 2 judged (simulated, "), "{verdict}");
            assert!(error.contains(" executions in the loop failed; the last: controller `python:part.py`"), "{error}");
            let beside = &told["baseline"];
            let (measured, lost) = (beside["cases"].as_u64().unwrap(), beside["failed"].as_u64().unwrap());
            assert!(measured + lost == 6 && lost > 0, "{beside}");
            assert!(verdict.contains(&format!(" at worst of {measured}, {lost} more failed")), "{verdict}");
            let file = |name: &str| fs::read_to_string(here.join(&out).join(name)).unwrap();
            assert!(file("junit.xml").contains("type=\"ExecutorFailed\""), "{}", file("junit.xml"));
            assert!(file("report.html").contains(&format!("{failed} of {of} executions of the search failed")));
            kept.push(file("generation.json"));
            // It stays so for whoever goes on, and judges anew.
            let (code, said, _) = run(here, &["judge", &out, "--json"]);
            let again: Value = serde_json::from_str(&said).unwrap();
            assert_eq!((code, again["verdict"].as_str()), (4, Some(verdict)));
        }
        assert_eq!(kept[0], kept[1], "threads change what failed");
        let (code, said, _) =
            run(here, &["stress", "q.toml", "--out", "narrow", "--force", "--set", "spec.deviation.max_m=0.001"]);
        assert_eq!(code, 1, "{said}");
        assert!(said.contains("\nFAIL 2/2 ") && said.contains("; executor failed in "), "{said}");
    }
}

/// Whoever repaired it executes again: what was found decides, and what was never executed is told.
#[test]
fn a_repaired_controller_decides_anew_and_what_failed_before_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    fs::write(here.join("part.py"), GIVES_UP).unwrap();
    fs::write(here.join("q.toml"), searched(SEARCHES[0], "python:part.py")).unwrap();
    let wide = ["--set", "spec.deviation.max_m=1000", "--set", "execute.baseline=0", "--json"];
    let (code, said, error) = run(here, &[&["stress", "q.toml", "--out", "a"], &wide[..]].concat());
    assert_eq!(code, 4, "{said}{error}");
    let judged = |out: &str| {
        let (code, said, _) = run(here, &["judge", out, "--json"]);
        let told: Value = serde_json::from_str(&said).unwrap();
        (code, told["verdict"].as_str().unwrap().to_owned(), told["search"]["flown_by_another_since"] == true)
    };
    // The same again has repaired nothing.
    let (code, said, error) = run(here, &["execute", "a"]);
    assert!(code == 0 && error.contains("the verdict stays EXECUTOR FAILED"), "{said}{error}");
    let (code, verdict, is_past) = judged("a");
    assert!(code == 4 && verdict.starts_with("EXECUTOR FAILED ") && !is_past, "{verdict}");
    fs::write(here.join("part.py"), GIVES_UP.replace("% 3 == 0", "% 3 == 5")).unwrap();
    // A name alone is that of the campaign's own copy.
    let repaired = format!("execute.controller=\"python:{}\"", here.join("part.py").display());
    let repaired = ["--set", &repaired];
    let past = " executions of the search failed (controller `python:part.py` at t = 0 s: ";
    let never = ") before another executor flew the cases, and what they were of was never executed";
    let aside = run(here, &[&["execute", "a", "--out", "b"], &repaired[..]].concat());
    let there = run(here, &[&["execute", "a"], &repaired[..]].concat());
    for ((code, said, error), out) in [(aside, "b"), (there, "a")] {
        assert!(code == 0 && !error.contains("stays EXECUTOR FAILED"), "{said}{error}");
        let (code, verdict, is_past) = judged(out);
        assert!(code == 0 && verdict.starts_with("PASS 2/2 ") && is_past, "{verdict}");
        assert!(verdict.contains(past) && verdict.contains(never), "{verdict}");
    }
    let counted = |out: &str| judged(out).1.split(past).next().unwrap().rsplit("; ").next().unwrap().to_owned();
    assert_eq!(counted("a"), counted("b"), "31 of 80, and not of those that failed");
    // It fails what it fails.
    fs::write(here.join("part.py"), GIVES_UP.replace("% 3 == 0", "% 3 != 5")).unwrap();
    let (code, said, _) = run(here, &[&["execute", "a"], &repaired[..]].concat());
    assert_eq!(code, 4, "{said}");
    let (code, verdict, _) = judged("a");
    assert!(code == 4 && verdict.starts_with("EXECUTOR FAILED 2/2 ("), "{verdict}");
}

#[test]
fn a_controller_that_always_fails_ends_a_search_with_its_cause() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let always = |body: &str| format!("import sys, time\ndef control(t_s, state, reference):\n    {body}\n");
    let one = &SEARCHES[..1];
    // A busy machine takes its time to begin Python.
    let patient = "execute.timeout_s=10";
    for (body, searches, words, limit) in [
        ("raise RuntimeError('boom')", &SEARCHES[..], "boom", patient),
        ("return None", one, "None", patient),
        ("return {'v_m_s': [float('nan'), 0.0, 0.0]}", one, "controller `python:bad.py`", patient),
        ("return {'v_m_s': [0.0]}", one, "v_m_s", patient),
        ("sys.exit(3)", one, "controller `python:bad.py`", patient),
        ("time.sleep(60)", one, "execute.timeout_s", "execute.timeout_s=1"),
    ] {
        fs::write(here.join("bad.py"), always(body)).unwrap();
        for search in searches {
            fs::write(here.join("q.toml"), searched(search, "python:bad.py")).unwrap();
            let limit = ["--set", limit, "--threads", "2"];
            let (code, said, error) = run(here, &[&["stress", "q.toml", "--out", "a", "--force"], &limit[..]].concat());
            assert_eq!(code, 4, "{body}: {said}{error}");
            assert!(error.contains("EXECUTOR FAILED: ") && error.contains(words), "{body}: {error}");
        }
    }
}
