//! Good and bad executors, as small programs in Python and sh, against the driver.

use std::fs;
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use hairpin::campaign::{CaseNumber, Mission, Scenario, Setup};
use hairpin::trajectory::{ATTITUDE_UNKNOWN, Ended, Flight};
use nalgebra::Point3;
use serde_json::json;

use super::*;

mod in_loop;
mod promises;
mod second;

fn mission(number: usize) -> Mission {
    let scenario: Scenario = serde_json::from_value(json!({
        "hairpin": 1,
        "robot": { "kind": "quadrotor", "name": "test", "mass_kg": 1.0, "inertia_kg_m2": [0.005, 0.005, 0.007],
            "rotors": [
                { "x_m": 0.1, "y_m": 0.1, "spin": 1 }, { "x_m": -0.1, "y_m": 0.1, "spin": -1 },
                { "x_m": -0.1, "y_m": -0.1, "spin": 1 }, { "x_m": 0.1, "y_m": -0.1, "spin": -1 }],
            "thrust_coefficient_n_s2": 1.91e-6, "moment_coefficient_n_m_s2": 2.6e-7, "rotor_speed_rad_s": [0, 2200] },
        "world": { "size_m": [10, 10, 10] },
        "task": { "start_m": [1, 1, 1], "end_m": [1, 5, 1], "length": 3 },
    }))
    .unwrap();
    Mission {
        case: CaseNumber(number).to_string(),
        run: 0,
        seed: u64::MAX - number as u64,
        setup: Setup::new(scenario).unwrap(),
        drawn: Vec::new(),
        waypoints: vec![Point3::new(1.0, 1.0, 1.0), Point3::new(5.0, 1.0, 1.0), Point3::new(1.0, 5.0, 1.0)],
        yaws: vec![0.0; 3],
        accept: 0.5,
        time_limit: 30.0,
        timed: Vec::new(),
    }
}

/// A Python executor whose function `fly(mission)` does `body`; `say(…)` sends, `pose(t, p, leg)` is a shorthand.
fn python(folder: &Path, body: &str) -> Command {
    let mut text = String::from(
        r#"
import json, os, sys, time
def say(**message): print(json.dumps(message), flush=True)
def pose(t, p, leg=0, q=(1, 0, 0, 0), **more): say(type="pose", t_s=t, p_m=list(p), q_wxyz=list(q), leg=leg, **more)
def good(m):
    points, t = m["waypoints_m"], 0.0
    for leg, (a, b) in enumerate(zip(points, points[1:])):
        for i in range(11 if leg == len(points) - 2 else 10):
            pose(t, [u + (v - u) * i / 10 for u, v in zip(a, b)], leg, v_m_s=[v - u for u, v in zip(a, b)])
            t += 0.1
    say(type="end", reason="done")
def fly(m):
"#,
    );
    for line in body.lines() {
        text.push_str("    ");
        text.push_str(line);
        text.push('\n');
    }
    text.push_str(
        r#"
for line in sys.stdin:
    m = json.loads(line)
    if m["type"] == "hello": say(type="ready", protocol=1, name="test")
    elif m["type"] == "mission": fly(m)
    else: break
"#,
    );
    let file = folder.join("executor.py");
    fs::write(&file, text).unwrap();
    format!("python3 '{}'", file.display()).parse().unwrap()
}

fn limits() -> Limits {
    Limits { handshake: Duration::from_secs(20), mission: Duration::from_secs(20), grace: Duration::from_millis(500) }
}

/// Flies `count` missions, in order of their number.
fn fly(command: &Command, limits: Limits, workers: usize, count: usize) -> Vec<Result<Flight, Failed>> {
    let results = Mutex::new(Vec::new());
    let landed = |index, result| results.lock().unwrap().push((index, result));
    fly_all(command, limits, workers, count, &|i| Ok(mission(i)), &landed, &|| false);
    let mut results = results.into_inner().unwrap();
    results.sort_by_key(|(index, _)| *index);
    assert!(results.iter().enumerate().all(|(i, (index, _))| i == *index), "every mission exactly once");
    results.into_iter().map(|(_, result)| result).collect()
}

/// What the one mission of an executor with this body fails with.
fn failure(body: &str) -> String {
    let folder = tempfile::tempdir().unwrap();
    let failed = fly(&python(folder.path(), body), limits(), 1, 1).remove(0).unwrap_err();
    failed.to_string()
}

#[test]
fn flies_every_mission_and_tells_when_waypoints_were_reached() {
    let folder = tempfile::tempdir().unwrap();
    let flights = fly(&python(folder.path(), "good(m)"), limits(), 3, 12);
    for flight in flights {
        let flight = flight.unwrap();
        assert_eq!(flight.ended, Ended::Done);
        assert_eq!(flight.track.len(), 21);
        assert_eq!(flight.track.channel("leg").unwrap()[9..12], [0.0, 1.0, 1.0]);
        assert_eq!(flight.track.channel("vz_m_s").unwrap().len(), 21);
        assert_eq!((flight.reached[0], flight.left_world), (Some(0.0), None));
        // Leg 1 begins at pose 10; the end is 4√2 m on, its radius of 0.5 m begins between poses 9 and 10 of 10.
        assert!((flight.reached[1].unwrap() - 1.0).abs() < 1e-9 && (flight.reached[2].unwrap() - 2.0).abs() < 1e-9);
    }
}

/// Windows' shells put it before what they pass on.
#[test]
fn a_stream_may_begin_with_a_byte_order_mark_and_no_other_line_may() {
    let folder = tempfile::tempdir().unwrap();
    let command = |body: &str, from: &str, to: &str| {
        let command = python(folder.path(), body);
        let file = folder.path().join("executor.py");
        let text = fs::read_to_string(&file).unwrap();
        assert!(text.contains(from));
        fs::write(&file, text.replace(from, to)).unwrap();
        command
    };
    let marked = "if m[\"type\"] == \"hello\": sys.stdout.buffer.write(b'\\xef\\xbb\\xbf'); \
                  say(type=\"ready\", protocol=1, name=\"test\")";
    let plain = "if m[\"type\"] == \"hello\": say(type=\"ready\", protocol=1, name=\"test\")";
    let flown = fly(&command("good(m)", plain, marked), limits(), 1, 2);
    assert!(flown.iter().all(Result::is_ok), "{flown:?}");
    let found = failure("sys.stdout.buffer.write(b'\\xef\\xbb\\xbf'); pose(0, [1, 1, 1])");
    assert!(found.contains("line 2 of its stdout is no message: it begins with a byte order mark"), "{found}");
}

#[test]
fn the_mission_says_all_that_the_protocol_promises() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("mission.json");
    let command =
        python(folder.path(), &format!("open({:?}, 'w').write(json.dumps(m))\ngood(m)", file.to_str().unwrap()));
    fly(&command, limits(), 1, 1).remove(0).unwrap();
    let said: serde_json::Value = serde_json::from_str(&fs::read_to_string(file).unwrap()).unwrap();
    assert_eq!(said["seed"].as_u64(), Some(u64::MAX));
    assert_eq!((&said["case"], &said["run"], &said["accept_m"]), (&json!("0000"), &json!(0), &json!(0.5)));
    assert_eq!(said["waypoints_m"][1], json!([5.0, 1.0, 1.0]));
    assert_eq!(said["robot"]["thrust_coefficient_n_s2"], json!(1.91e-6));
    assert_eq!(said["robot"]["rotors"][1]["x_m"], json!(-0.1));
    assert_eq!(said["world"]["size_m"], json!([10.0, 10.0, 10.0]));
    assert!(said["timed"].is_array() && said["time_limit_s"] == json!(30.0));
}

#[test]
fn a_crash_costs_one_mission_and_keeps_its_traceback() {
    let folder = tempfile::tempdir().unwrap();
    let body = "if m['case'] == '0002':\n    pose(0, [1, 1, 1])\n    raise RuntimeError('lost rotor 3')\ngood(m)";
    let flights = fly(&python(folder.path(), body), limits(), 2, 5);
    for (number, flight) in flights.iter().enumerate() {
        assert_eq!(flight.is_ok(), number != 2, "{number}: {flight:?}");
    }
    let failed = flights[2].as_ref().unwrap_err();
    assert_eq!(failed.to_string(), "ended without \"end\" (exit status: 1)");
    assert!(failed.stderr.contains("RuntimeError: lost rotor 3"), "{}", failed.stderr);
}

#[test]
fn a_hang_ends_at_the_time_out_with_all_its_children() {
    let folder = tempfile::tempdir().unwrap();
    let pid = folder.path().join("pid");
    let body = format!(
        "if m['case'] != '0000':\n    return good(m)\nimport subprocess\nopen({:?}, 'w').write(str(subprocess.Popen(['sleep', '600']).pid))\ntime.sleep(600)",
        pid.to_str().unwrap()
    );
    let limits = Limits { mission: Duration::from_secs(3), ..limits() };
    let begun = Instant::now();
    let flights = fly(&python(folder.path(), &body), limits, 1, 2);
    let failed = flights[0].as_ref().unwrap_err();
    assert_eq!(failed.to_string(), "time-out: no \"end\" within 3 s (execute.timeout_s)");
    assert!(flights[1].is_ok(), "{:?}", flights[1]);
    assert!(begun.elapsed() < Duration::from_secs(30));
    let grandchild = fs::read_to_string(pid).unwrap();
    let alive = || {
        let stat = fs::read_to_string(format!("/proc/{grandchild}/stat")).unwrap_or_default();
        !stat.is_empty() && !stat.contains(") Z")
    };
    let gone = (0..200).any(|_| {
        !alive() || {
            std::thread::sleep(Duration::from_millis(10));
            false
        }
    });
    assert!(gone, "process {grandchild} outlived its executor");
}

#[test]
fn every_broken_promise_has_its_sentence() {
    for (body, sentence) in [
        (
            "print('Loading model...', flush=True)",
            "line 2 of its stdout is no message: expected value at line 1 column 1; it reads `Loading model...`",
        ),
        (
            "sys.stdout.buffer.write(b'\\xff\\xfe\\n'); sys.stdout.flush()",
            "line 2 of its stdout is no message: not UTF-8",
        ),
        (
            "sys.stdout.write('x' * 3000000); sys.stdout.flush(); time.sleep(60)",
            "line 2 of its stdout is longer than 1048576 bytes",
        ),
        ("pose(0, [float('nan'), 1, 1])", "NaN is no JSON number"),
        ("pose(0, [1, 1])", "invalid length 2"),
        ("say(type='pose', p_m=[1, 1, 1], q_wxyz=[1, 0, 0, 0])", "missing field `t_s`"),
        ("pose(0, [1, 1, 1], 0.5)", "floating point `0.5`"),
        (
            "pose(0, [1, 1, 1], '0')",
            "line 2 of its stdout is a message that is not understood: invalid type: string \"0\", expected a whole number",
        ),
        ("print(42, flush=True)", "line 2 of its stdout is no message: invalid type: integer `42`"),
        ("say(type='poes')", "unknown variant `poes`"),
        ("say(type='ready', protocol=1)", "sent \"ready\" where \"pose\" was due"),
        ("pose(0.5, [1, 1, 1])", "its first pose has t_s = 0.5: must be 0"),
        (
            "pose(0, [1, 1, 1]); pose(0.1, [1, 1, 1]); pose(0.1, [1, 1, 1])",
            "pose 2: t_s = 0.1 does not follow 0.1: must rise strictly",
        ),
        (
            "pose(0, [1, 1, 1]); pose(1e-160, [1, 1, 1.1])",
            "pose 1: t_s = 1e-160 is 1e-160 s after 0e0: must be at least 5e-10 s",
        ),
        ("pose(0, [1, 1, 1], q=(0.9, 0, 0, 0))", "q_wxyz has length 0.900000"),
        ("pose(0, [1, 1, 1], 3)", "leg = 3: must be 0 … 1"),
        ("pose(0, [1, 1, 1]); pose(1, [1e8, 1, 1])", "p_m[0] = 1e8: must be within ±2.1e7 m"),
        ("pose(0, [1, 1, 1]); pose(1, [2, 1, 1], v_m_s=[0, -1e39, 0])", "v_m_s[1] = -1e39: must be within ±1e6 m/s"),
        ("pose(0, [1, 1, 1]); pose(41, [1, 1, 1])", "t_s = 41 and no \"end\", time_limit_s is 30"),
        ("say(type='end', reason='done')", "\"end\" before the first pose"),
        ("say(type='end', reason='bored')", "unknown variant `bored`"),
        ("say(type='error', message='no GPU\\nhere')", "reports: no GPU here"),
        ("os.close(1); time.sleep(60)", "closed its stdout without \"end\""),
        ("os.kill(os.getpid(), 9)", "ended without \"end\" (signal: 9 (SIGKILL))"),
    ] {
        let found = failure(body);
        assert!(found.contains(sentence), "{body}\n found: {found}\nwanted: {sentence}");
    }
}

#[test]
fn an_error_that_the_program_reports_keeps_it_running() {
    let folder = tempfile::tempdir().unwrap();
    let body =
        "global n\nn = globals().get('n', 0) + 1\nif n == 1:\n    return say(type='error', message='busy')\ngood(m)";
    let flights = fly(&python(folder.path(), body), limits(), 1, 3);
    assert_eq!(flights[0].as_ref().unwrap_err().to_string(), "reports: busy");
    // A new process would have said `busy` again.
    assert!(flights[1].is_ok() && flights[2].is_ok());
}

#[test]
fn time_crash_and_leaving_the_world_are_flights() {
    let folder = tempfile::tempdir().unwrap();
    let body = "pose(0, [1, 1, 1]); pose(1, [1, 1, 10.5]); pose(2, [1, 1, 11]); say(type='end', reason=['time', 'crash'][int(m['case'])])";
    let flights = fly(&python(folder.path(), body), limits(), 1, 2);
    for (flight, ended) in flights.into_iter().zip([Ended::Time, Ended::Crash]) {
        let flight = flight.unwrap();
        assert_eq!((flight.ended, flight.left_world), (ended, Some(1.0)));
        assert_eq!(flight.reached, [Some(0.0), None, None]);
    }
}

#[test]
fn without_legs_waypoints_are_reached_one_after_the_other() {
    let folder = tempfile::tempdir().unwrap();
    // Passes waypoint 2 before waypoint 1: that does not count.
    let body = "for t, p in enumerate([[1, 1, 1], [1, 5, 1], [5, 1, 1], [1, 5, 1]]):\n    say(type='pose', t_s=t, p_m=p, q_wxyz=[1, 0, 0, 0])\nsay(type='end', reason='done')";
    let flight = fly(&python(folder.path(), body), limits(), 1, 1).remove(0).unwrap();
    assert_eq!(flight.reached, [Some(0.0), Some(2.0), Some(3.0)]);
    assert!(flight.track.channels().is_empty());
}

#[test]
fn flights_are_not_refused_for_how_they_were_flown() {
    let end = "say(type='end', reason='done')";
    for (poses, reached, channels) in [
        // Done at once.
        ("pose(0, [1, 1, 1.4])", [Some(0.0), None, None], vec!["leg"]),
        // Done on the first leg, at the end: by its own account it has not flown the second.
        ("pose(0, [1, 1, 1]); pose(1, [1, 5, 1])", [Some(0.0), None, None], vec!["leg"]),
        // One more than the last leg: all reached.
        (
            "pose(0, [1, 1, 1]); pose(1, [5, 1, 1], 1); pose(2, [1, 5, 1], 2)",
            [Some(0.0), Some(1.0), Some(2.0)],
            vec!["leg"],
        ),
        // Velocities that come and go are none.
        ("pose(0, [1, 1, 1], None, v_m_s=[0, 0, 0]); pose(1, [5, 1, 1], None)", [Some(0.0), Some(1.0), None], vec![]),
        (
            "pose(0, [1, 1, 1]); say(type='pose', t_s=1, p_m=[5, 1, 1], leg=1)",
            [Some(0.0), Some(1.0), None],
            vec!["leg", ATTITUDE_UNKNOWN],
        ),
        // Its word alone, 4 m from waypoint 1, is no place; but passing it between two poses is.
        ("pose(0, [1, 1, 1]); pose(1, [1, 3, 1], 1); pose(2, [1, 5, 1], 1)", [Some(0.0), None, Some(2.0)], vec!["leg"]),
        (
            "pose(0, [1, 1, 1]); pose(1, [7, 1, 1], 1); pose(2, [1, 5, 1], 1)",
            [Some(0.0), Some(1.0), Some(2.0)],
            vec!["leg"],
        ),
        // A missed waypoint does not hide the end; but the end alone is not a flight.
        ("pose(0, [1, 1, 1], None); pose(1, [1, 5, 1], None)", [Some(0.0), None, None], vec![]),
    ] {
        let folder = tempfile::tempdir().unwrap();
        let flight = fly(&python(folder.path(), &format!("{poses}; {end}")), limits(), 1, 1).remove(0).unwrap();
        assert_eq!((flight.ended, &flight.reached[..]), (Ended::Done, &reached[..]), "{poses}");
        assert_eq!(flight.track.channels().iter().map(|c| c.name.as_str()).collect::<Vec<_>>(), channels, "{poses}");
    }
}

#[test]
fn programs_that_never_start_fail_every_mission_quickly() {
    let command: Command = "hairpin-no-such-program --fast".parse().unwrap();
    for failed in fly(&command, limits(), 2, 20) {
        assert!(failed.unwrap_err().to_string().starts_with("cannot start `hairpin-no-such-program`: "));
    }
    let silent: Command = "sleep 600".parse().unwrap();
    let limits = Limits { handshake: Duration::from_millis(200), ..limits() };
    let begun = Instant::now();
    for failed in fly(&silent, limits, 1, 20) {
        assert_eq!(failed.unwrap_err().to_string(), "no \"ready\" within 0.2 s of \"hello\"");
    }
    assert!(begun.elapsed() < Duration::from_secs(10), "a hopeless program must not be started for every mission");
    let new: Command = r#"sh -c 'echo "{\"type\":\"ready\",\"protocol\":3}"; sleep 60'"#.parse().unwrap();
    assert_eq!(
        fly(&new, limits, 1, 1)[0].as_ref().unwrap_err().to_string(),
        "speaks protocol 3; this hairpin speaks 1 and 2"
    );
}

#[test]
fn a_program_that_never_reads_is_no_trap() {
    let deaf: Command = r#"sh -c 'echo "{\"type\":\"ready\",\"protocol\":1}"; exec sleep 600'"#.parse().unwrap();
    let mut long = mission(0);
    // Far more than a pipe holds.
    long.timed =
        vec![
            hairpin::campaign::Timed { t: 0.0, position: Point3::origin(), velocity: nalgebra::Vector3::zeros() };
            20_000
        ];
    let limits = Limits { mission: Duration::from_millis(500), ..limits() };
    let worker = Worker::start(&deaf, limits, 2, &|| false).unwrap();
    let Answer { result, worker, .. } = worker.fly(&long, Duration::ZERO, &|| false);
    assert!(matches!(result.unwrap_err().failure, Failure::TimeOut { .. }));
    assert!(worker.is_none());
}

#[test]
fn says_bye_and_lets_the_program_exit() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("bye");
    let mut text = fs::read_to_string({
        python(folder.path(), "good(m)");
        folder.path().join("executor.py")
    })
    .unwrap();
    text.push_str(&format!("time.sleep(0.1)\nopen({:?}, 'w').write(m['type'])\n", file.to_str().unwrap()));
    let script = folder.path().join("polite.py");
    fs::write(&script, text).unwrap();
    let command: Command = format!("python3 '{}'", script.display()).parse().unwrap();
    assert!(fly(&command, Limits { grace: Duration::from_secs(10), ..limits() }, 1, 1)[0].is_ok());
    assert_eq!(fs::read_to_string(file).unwrap(), "bye");
}

#[test]
fn stops_when_asked_and_reports_nothing_half_flown() {
    let folder = tempfile::tempdir().unwrap();
    let command = python(folder.path(), "if m['case'] == '0001':\n    time.sleep(600)\ngood(m)");
    let (stop, results) = (AtomicBool::new(false), Mutex::new(Vec::new()));
    let begun = Instant::now();
    let landed = |index, result: Result<Flight, Failed>| {
        results.lock().unwrap().push((index, result.is_ok()));
        stop.store(true, Ordering::Relaxed);
    };
    fly_all(&command, limits(), 2, 50, &|i| Ok(mission(i)), &landed, &|| stop.load(Ordering::Relaxed));
    assert!(begun.elapsed() < Duration::from_secs(15));
    let results = results.into_inner().unwrap();
    assert!(results.iter().all(|&(index, ok)| ok && index != 1) && results.len() < 5, "{results:?}");
}

#[test]
fn commands_are_split_as_a_shell_does() {
    assert_eq!("".parse::<Command>(), Err(CommandError::Empty));
    assert_eq!("  '' x".parse::<Command>(), Err(CommandError::Empty));
    assert_eq!("python 'a b".parse::<Command>(), Err(CommandError::Quotes));
    assert_eq!("sh -c 'a b'".parse::<Command>(), "sh -c \"a b\"".parse::<Command>());
}
