//! Protocol 2, whose answers say what they are of, and what protocol 1 can still tell.

use super::*;

/// An executor that speaks protocol 2 and answers a mission by `body`; `pose` and `end` say what they are of.
pub(super) fn speaks_2(folder: &Path, body: &str) -> Command {
    let mut text = String::from(
        r#"
import json, os, sys, time, threading
of = {}
def say(**message): print(json.dumps(message), flush=True)
def pose(t, p, leg=0, of=None, **more): say(type="pose", t_s=t, p_m=list(p), q_wxyz=[1, 0, 0, 0], leg=leg, **(of or globals()["of"]), **more)
def end(of=None): say(type="end", reason="done", **(of or globals()["of"]))
def good(m, of=None):
    for leg, p in enumerate(m["waypoints_m"]): pose(leg, p, min(leg, len(m["waypoints_m"]) - 2), of)
    end(of)
def fly(m):
"#,
    );
    body.lines().for_each(|line| text.push_str(&format!("    {line}\n")));
    text.push_str(
        r#"
for line in sys.stdin:
    m = json.loads(line)
    if m["type"] == "hello": say(type="ready", protocol=2, name="second", deterministic=True, version="7")
    elif m["type"] == "reset": of = {"case": m["case"], "run": m["run"]}; say(type="ready", **of)
    elif m["type"] == "mission": fly(m)
    else: break
"#,
    );
    let file = folder.join("second.py");
    fs::write(&file, text).unwrap();
    format!("python3 '{}'", file.display()).parse().unwrap()
}

/// Which of `count` missions fail, one worker flying them in their order, and with what.
fn failing(command: &Command, limits: Limits, count: usize) -> Vec<(usize, String)> {
    let flights = fly(command, limits, 1, count);
    for flight in flights.iter().flatten() {
        assert_eq!((flight.ended, flight.reached.iter().flatten().count()), (Ended::Done, 3), "{flight:?}");
    }
    let failed = flights.into_iter().enumerate().filter_map(|(index, flight)| Some((index, flight.err()?.to_string())));
    failed.collect()
}

const AFTER: &str = "sent more after its \"end\", where one mission has one answer: `";

#[test]
fn missions_are_flown_in_either_protocol() {
    let folder = tempfile::tempdir().unwrap();
    assert_eq!(failing(&speaks_2(folder.path(), "good(m)"), limits(), 5), []);
    // Many poses at once, with and without what may be missing.
    let rows = "say(type='poses', poses=[[t, *p, 1, 0, 0, 0, None, None, None, min(t, 1)] for t, p in enumerate(m['waypoints_m'])], **of); end()";
    assert_eq!(failing(&speaks_2(folder.path(), rows), limits(), 3), []);
    // One that speaks 1 alone and minds being greeted otherwise: by its answer, an error, an exit.
    for hello in ["pass", "say(type='error', message='no')\n        continue", "raise SystemExit(1)"] {
        python(folder.path(), "good(m)");
        let file = folder.path().join("executor.py");
        let strict = format!(
            "if m[\"type\"] == \"hello\" and m[\"hairpin\"] != 1:\n        {hello}\n    if m[\"type\"] == \"hello\""
        );
        let text = fs::read_to_string(&file).unwrap().replace("if m[\"type\"] == \"hello\"", &strict);
        fs::write(&file, text).unwrap();
        let command: Command = format!("python3 '{}'", file.display()).parse().unwrap();
        assert_eq!(failing(&command, limits(), 3), [], "{hello}");
    }
}

#[test]
fn answers_count_for_the_mission_that_they_are_of() {
    let folder = tempfile::tempdir().unwrap();
    let before = "{'case': '0001', 'run': 0}";
    for (body, line) in [
        // Twice, at once.
        ("good(m)\nif m['case'] == '0001': good(m)", "\"type\": \"pose\""),
        ("good(m)\nif m['case'] == '0001': end()", "\"type\": \"end\""),
        // A word after the end.
        ("good(m)\nif m['case'] == '0001': print('done!', flush=True)", "done!"),
        // Late, amid the next one.
        (&format!("if m['case'] == '0002': good(m, {before})\ngood(m)"), "\"type\": \"pose\""),
    ] {
        let failed = failing(&speaks_2(folder.path(), body), limits(), 4);
        assert_eq!(failed.len(), 1, "{body}: {failed:?}");
        assert!(failed[0].0 == 1 && failed[0].1.starts_with(AFTER) && failed[0].1.contains(line), "{body}: {failed:?}");
    }
    // Of the last one as well.
    let failed = failing(&speaks_2(folder.path(), "good(m)\nif m['case'] == '0003': good(m)"), limits(), 4);
    assert!(failed.len() == 1 && failed[0].0 == 3 && failed[0].1.starts_with(AFTER), "{failed:?}");
    // Long ago, or never asked for: no business of this mission's.
    let old = format!("if m['case'] == '0003': good(m, {before})\ngood(m, {{'case': '0099', 'run': 0}})\ngood(m)");
    assert_eq!(failing(&speaks_2(folder.path(), &old), limits(), 4), []);
    // Only of another one: no answer.
    let short = Limits { mission: Duration::from_secs(1), ..limits() };
    let other = "good(m, {'case': '0099', 'run': 3} if m['case'] == '0001' else None)";
    let failed = failing(&speaks_2(folder.path(), other), short, 3);
    assert_eq!(failed.len(), 1, "{failed:?}");
    assert!(failed[0].1.ends_with("it answered for case 0099, run 3"), "{failed:?}");
}

#[test]
fn promises_of_protocol_2_have_their_sentences() {
    for (body, sentence) in [
        ("say(type='pose', t_s=0, p_m=[1, 1, 1])", "sent \"pose\" without the case and the run that it is of"),
        ("say(type='end', reason='done', case='0000')", "sent \"end\" without the case and the run that it is of"),
        ("say(type='poses', poses=[[0, 1, 1, 1]], **of)", "row 0 of \"poses\" has 4 numbers: must be 12"),
        ("say(type='poses', poses=[[0, 1, 1, 1] + [None] * 7 + [0.5]], **of)", "row 0 of \"poses\" has leg = 0.5"),
        ("say(type='error', message='no GPU')", "reports: no GPU"),
        ("say(type='ready', **of)", "sent \"ready\" where \"pose\" was due"),
    ] {
        let folder = tempfile::tempdir().unwrap();
        let failed = failing(&speaks_2(folder.path(), body), limits(), 1);
        assert!(failed[0].1.starts_with(sentence), "{body}: {failed:?}");
    }
    let folder = tempfile::tempdir().unwrap();
    python(folder.path(), "good(m)");
    let file = folder.path().join("executor.py");
    // It claims protocol 2 and does not know `reset`.
    let text = fs::read_to_string(&file).unwrap().replace("protocol=1", "protocol=m['hairpin']");
    fs::write(&file, text.replace("    else: break", "")).unwrap();
    let command: Command = format!("python3 '{}'", file.display()).parse().unwrap();
    let short = Limits { mission: Duration::from_millis(500), ..limits() };
    let failed = failing(&command, short, 1);
    assert_eq!(failed[0].1, "time-out: no \"ready\" within 0.5 s (execute.timeout_s)");
}

#[test]
fn in_protocol_1_what_follows_an_end_is_a_mistake_of_that_mission() {
    let folder = tempfile::tempdir().unwrap();
    for body in [
        "good(m)\nif m['case'] == '0001': good(m)",
        "good(m)\nif m['case'] == '0001': print('done!', flush=True)",
        "good(m)\nif m['case'] == '0001': time.sleep(0.01); say(type='end', reason='done')",
        // Later than anybody listens: amid the next mission, or after it.
        "if m['case'] == '0001':\n    global threading\n    import threading\n    threading.Timer(0.15, lambda: pose(99, [1, 1, 1])).start()\nif m['case'] == '0002' and 'threading' in globals(): time.sleep(0.3)\ngood(m)",
    ] {
        let failed = failing(&python(folder.path(), body), limits(), 4);
        assert!(failed.len() == 1 && failed[0].0 == 1, "{body}: {failed:?}");
    }
    // Of the last one, and of one whose fault it is in any process.
    let last = failing(&python(folder.path(), "good(m)\nif m['case'] == '0003': good(m)"), limits(), 4);
    assert!(last.len() == 1 && last[0].0 == 3, "{last:?}");
    let own = failing(&python(folder.path(), "pose(0.5, [1, 1, 1]) if m['case'] == '0002' else good(m)"), limits(), 4);
    assert!(own.len() == 1 && own[0].0 == 2 && own[0].1.contains("first pose"), "{own:?}");
}

#[test]
fn a_program_that_hangs_costs_three_times_its_limit() {
    let folder = tempfile::tempdir().unwrap();
    let limits = Limits { mission: Duration::from_millis(400), ..limits() };
    let begun = Instant::now();
    let failed = failing(&python(folder.path(), "good(m) if m['case'] == '0000' else time.sleep(600)"), limits, 40);
    assert!(begun.elapsed() < Duration::from_secs(15), "{:?}", begun.elapsed());
    let sentences: Vec<&str> = failed.iter().map(|(_, sentence)| sentence.as_str()).collect();
    assert_eq!(sentences.len(), 39);
    assert!(sentences[..3].iter().all(|sentence| sentence.starts_with("time-out: no \"end\"")), "{sentences:?}");
    let rest = "not flown: the program had left three missions in a row unanswered (execute.timeout_s = 0.4); --resume flies it";
    assert!(sentences[3..].iter().all(|sentence| *sentence == rest), "{sentences:?}");
    assert!(was_never_asked(rest) && !was_never_asked(sentences[0]));
    // One that is answered between begins it anew.
    let body = "good(m) if int(m['case']) % 3 == 2 else time.sleep(600)";
    assert_eq!(failing(&python(folder.path(), body), limits, 7).len(), 5);
}

#[test]
#[cfg(target_os = "linux")]
fn what_leaves_its_group_is_ended_too() {
    let folder = tempfile::tempdir().unwrap();
    let pid = folder.path().join("pid");
    let body = format!(
        "import subprocess\nopen({:?}, 'w').write(str(subprocess.Popen(['setsid', 'sleep', '600']).pid))\ntime.sleep(0.2)\ngood(m)",
        pid.to_str().unwrap()
    );
    assert_eq!(failing(&python(folder.path(), &body), limits(), 1), []);
    let stray = fs::read_to_string(pid).unwrap();
    // A kill is sent, not waited for.
    let ended = || {
        let stat = fs::read_to_string(format!("/proc/{stray}/stat")).unwrap_or_default();
        stat.is_empty() || stat.contains(") Z")
    };
    let begun = std::time::Instant::now();
    while !ended() {
        assert!(begun.elapsed().as_secs() < 20, "{stray} goes on");
        std::thread::sleep(std::time::Duration::from_millis(10));
    }
}
