//! What protocol 2 promises either side, and what a broken promise would be judged as: a violation that nobody flew.

use std::sync::Arc;

use hairpin::campaign::Timed;
use nalgebra::Vector3;

use super::second::speaks_2;
use super::*;

/// The mission as a program in each protocol sees it.
#[test]
fn missions_of_protocol_2_say_more() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("mission.json");
    let keep = format!("open({:?}, 'w').write(json.dumps(m))\ngood(m)", file.to_str().unwrap());
    let said = |command: Command| -> serde_json::Value {
        fly(&command, limits(), 1, 1).remove(0).unwrap();
        serde_json::from_str(&fs::read_to_string(&file).unwrap()).unwrap()
    };
    let second = said(speaks_2(folder.path(), &keep));
    assert_eq!(second["yaw_rad"], json!([0.0, 0.0, 0.0]));
    assert_eq!(second["limits"], json!({}));
    assert_eq!(second["accept"], json!({ "radius_m": 0.5, "height_m": 0.5 }));
    let first = said(python(folder.path(), &keep));
    assert!(["yaw_rad", "limits", "accept"].iter().all(|key| first.get(key).is_none()), "{first}");
    let keys = |mission: &serde_json::Value| mission.as_object().unwrap().keys().cloned().collect::<Vec<_>>();
    assert!(keys(&first).iter().all(|key| second.get(key).is_some()), "{first} {second}");
}

/// Who does not follow the plan need not read it.
#[test]
fn the_timed_motion_is_left_out_for_whom_does_not_want_it() {
    let sample = Timed { t: 0.5, position: Point3::new(1.0, 2.0, 3.0), velocity: Vector3::new(0.1, 0.2, 0.3) };
    let asked = Mission { timed: vec![sample; 40], ..mission(0) };
    let said = |word: Option<bool>, protocol: u64| -> serde_json::Value {
        let greeting = Greeting { protocol, timed: word, ..Greeting::default() };
        serde_json::from_slice(&mission_message(&asked, &greeting).line()).unwrap()
    };
    for protocol in [1, 2] {
        let mut all = said(None, protocol);
        assert_eq!(all["timed"][39], json!({ "t_s": 0.5, "p_m": [1.0, 2.0, 3.0], "v_m_s": [0.1, 0.2, 0.3] }));
        assert_eq!(said(Some(true), protocol), all);
        all["timed"] = json!([]);
        assert_eq!(said(Some(false), protocol), all);
    }
    let folder = tempfile::tempdir().unwrap();
    let told = speaks_2(folder.path(), "if m['timed']: raise SystemExit('too much')\ngood(m)");
    let file = folder.path().join("second.py");
    let text = fs::read_to_string(&file).unwrap().replace("deterministic=True", "deterministic=True, timed=False");
    assert!(text.contains("timed=False"));
    fs::write(&file, text).unwrap();
    assert!(
        fly_all(&told, limits(), 1, 1, &|_| Ok(asked.clone()), &|_, flight| drop(flight.unwrap()), &|| false).is_some()
    );
}

#[test]
fn limits_are_those_of_the_scenario() {
    let given = [("max_speed_m_s", 4.5), ("max_tilt_deg", 30.0)];
    let given = given.map(|(key, value)| (format!("generate.limits.{key}"), json!(value)));
    let setup = mission(0).setup.drawn(&given).unwrap();
    let second = Greeting { protocol: 2, ..Greeting::default() };
    let line = mission_message(&Mission { setup, ..mission(0) }, &second).line();
    let said: serde_json::Value = serde_json::from_slice(&line).unwrap();
    assert_eq!(said["limits"], json!({ "max_speed_m_s": 4.5, "max_tilt_deg": 30.0 }));
}

/// In either protocol.
#[test]
fn what_would_be_a_false_violation_is_refused() {
    let end = "say(type='end', reason='done', **globals().get('of', {}))";
    for (poses, sentence) in [
        (
            "pose(0, [1, 1, -1])",
            "its first pose is at (1.00, 1.00, -1.00), the start at (1.00, 1.00, 1.00): must be within 0.5 m; it is the start as NED has it",
        ),
        ("pose(0, [0, 0, 0])", "it is the program's own origin"),
        ("pose(0, [9, 9, 9])", "the start at (1.00, 1.00, 1.00): must be within 0.5 m"),
        (
            "pose(0, [1, 1, 1]); pose(1, [5, 1, 1], 1); pose(2, [1, 5, 1], 0)",
            "pose 2 (t_s = 2): leg = 0 after 1: must never fall",
        ),
        (
            "pose(0, [1, 1, 1]); pose(1, [5, 1, 1], None)",
            "pose 1 (t_s = 1) comes without \"leg\", those before it with: must be in all poses or in none",
        ),
        (
            "pose(0, [1, 1, 1], 1); pose(1, [5, 1, 1], 2); pose(2, [1, 5, 1], 2)",
            "pose 1 (t_s = 1): leg = 2: must be 0 … 1, and 2 once all waypoints are reached: it seems to number legs from 1",
        ),
        (
            "pose(0, [1, 1, 1], None); pose(1, [5, 1, 1], 0)",
            "pose 1 (t_s = 1) comes with \"leg\", those before it without",
        ),
    ] {
        let folder = tempfile::tempdir().unwrap();
        for command in
            [python(folder.path(), &format!("{poses}; {end}")), speaks_2(folder.path(), &format!("{poses}; {end}"))]
        {
            let failed = fly(&command, limits(), 1, 1).remove(0).unwrap_err().to_string();
            assert!(failed.contains(sentence), "{poses}: {failed}");
        }
    }
}

/// What a velocity is not: in km/h, or one that is not known.
#[test]
fn velocities_have_to_be_those_of_the_places() {
    for (told, slip) in [("3.6 * (v - u)", "they look like km/h"), ("0", "they are 0 throughout: leave \"v_m_s\" out")]
    {
        let folder = tempfile::tempdir().unwrap();
        let program = python(folder.path(), "good(m)");
        let file = folder.path().join("executor.py");
        let text = fs::read_to_string(&file).unwrap();
        fs::write(&file, text.replace("v_m_s=[v - u for", &format!("v_m_s=[{told} for"))).unwrap();
        let failed = fly(&program, limits(), 1, 1).remove(0).unwrap_err().to_string();
        assert!(failed.contains("v_m_s[1] adds up to ") && failed.contains(slip), "{failed}");
    }
}

/// In a corner of the cylinder that is outside of the sphere.
#[test]
fn acceptance_is_a_cylinder_from_protocol_2_on() {
    let poses = "pose(0, [1, 1, 1], None); pose(1, [5.4, 1, 1.4], None); pose(2, [1, 5.4, 0.6], None)";
    let folder = tempfile::tempdir().unwrap();
    let reached = |command: &Command| fly(command, limits(), 1, 1).remove(0).unwrap().reached;
    let end = "say(type='end', reason='done', **globals().get('of', {}))";
    assert_eq!(reached(&python(folder.path(), &format!("{poses}; {end}"))), [Some(0.0), None, None]);
    assert_eq!(reached(&speaks_2(folder.path(), &format!("{poses}; {end}"))), [Some(0.0), Some(1.0), Some(2.0)]);
}

/// Our own simulator ends at the limit; a program's word does not stretch it.
#[test]
fn what_is_reached_after_the_time_limit_is_not_reached() {
    let folder = tempfile::tempdir().unwrap();
    let flown = |last: f64, end: &str| {
        let poses = format!("pose(0, [1, 1, 1]); pose(15, [5, 1, 1], 1); pose({last}, [1, 5, 1], 1)");
        let body = format!("{poses}; say(type='end', reason='{end}')");
        fly(&python(folder.path(), &body), limits(), 1, 1).remove(0).unwrap()
    };
    for (last, end, ended, is_there) in [
        (30.0, "done", Ended::Done, true),
        (30.1, "done", Ended::Time, false),
        (39.0, "done", Ended::Time, false),
        (30.1, "time", Ended::Time, false),
        (30.0, "time", Ended::Time, true),
    ] {
        let flight = flown(last, end);
        let reached = [Some(0.0), Some(15.0), is_there.then_some(last)];
        assert_eq!((flight.ended, &flight.reached[..]), (ended, &reached[..]), "{last} s, {end}");
    }
    // He who was there in time may fly on.
    let body = "pose(0, [1, 1, 1]); pose(15, [5, 1, 1], 1); pose(29.9, [1, 5, 1], 1); pose(31.5, [1, 5, 1], 1)";
    let flight = fly(&python(folder.path(), &format!("{body}; say(type='end', reason='done')")), limits(), 1, 1);
    assert_eq!(flight[0].as_ref().unwrap().ended, Ended::Done);
}

#[test]
fn programs_are_known_by_what_they_say_of_themselves() {
    let folder = tempfile::tempdir().unwrap();
    let greeting = |command: &Command| fly_all(command, limits(), 2, 3, &|i| Ok(mission(i)), &|_, _| {}, &|| false);
    let second = Greeting {
        name: "second".into(),
        version: Some("7".into()),
        protocol: 2,
        deterministic: Some(true),
        timed: None,
    };
    assert_eq!(greeting(&speaks_2(folder.path(), "good(m)")), Some(second));
    let first = Greeting { name: "test".into(), protocol: 1, ..Greeting::default() };
    assert_eq!(greeting(&python(folder.path(), "good(m)")), Some(first));
    assert_eq!(greeting(&"hairpin-no-such-program".parse().unwrap()), None);
}

/// Of a program that is another than the one that flew before nothing lands, and none of its missions counts as failed.
#[test]
fn nothing_lands_of_a_program_that_is_not_wanted() {
    let folder = tempfile::tempdir().unwrap();
    let asked = folder.path().join("asked");
    let body = format!("open({:?}, 'a').write(m['case'])\ngood(m)", asked.to_str().unwrap());
    let command = speaks_2(folder.path(), &body);
    let landed = std::sync::atomic::AtomicUsize::new(0);
    let land = |_, flight: Result<_, _>| {
        flight.map(drop).unwrap();
        landed.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
    };
    for (name, flown) in [("first", 0), ("second", 3)] {
        let is_wanted = |greeting: &Greeting| greeting.name == name;
        let (program, make) = ((&command, limits()), |i| Ok(mission(i)));
        let greeting = super::super::fly_all_if(program, &is_wanted, 2, 3, &make, &land, &|| false);
        assert_eq!(greeting.map(|greeting| greeting.name).as_deref(), Some("second"));
        assert_eq!((landed.load(std::sync::atomic::Ordering::Relaxed), asked.exists()), (flown, flown > 0), "{name}");
    }
}

/// A program that lives on after its `error`: what it wrote before is another pipe's.
#[test]
fn an_error_keeps_what_was_said_on_stderr_before_it() {
    let folder = tempfile::tempdir().unwrap();
    let body = "print('no map of case ' + m['case'], file=sys.stderr, flush=True); say(type='error', message='cannot')";
    for (number, answer) in fly(&python(folder.path(), body), limits(), 1, 5).into_iter().enumerate() {
        let failed = answer.unwrap_err();
        assert_eq!(failed.stderr.trim_end(), format!("no map of case {}", CaseNumber(number)));
    }
}

#[test]
fn failures_end_with_the_last_line_of_stderr() {
    let folder = tempfile::tempdir().unwrap();
    let body = "print('warming up', file=sys.stderr)\nraise SystemExit('rotor 3 is gone\\n\\n')";
    let failed = fly(&python(folder.path(), body), limits(), 1, 1).remove(0).unwrap_err();
    let sentence = "ended without \"end\" (exit status: 1); the last line of its stderr: rotor 3 is gone";
    assert_eq!(failed.in_full(), sentence);
}

#[test]
fn a_wire_keeps_both_sides() {
    let folder = tempfile::tempdir().unwrap();
    let (wire, command) = (Wire::kept(), speaks_2(folder.path(), "good(m)"));
    let worker = Worker::start_on(&wire, &command, limits(), 2, &|| false).unwrap();
    assert_eq!((worker.greeting().name.as_str(), worker.greeting().protocol), ("second", 2));
    let answer = worker.fly(&mission(0), Duration::ZERO, &|| false);
    let said: Arc<[String]> = wire.take().said.iter().map(|said| format!("{:?} {}", said.by, said.line)).collect();
    for (place, beginning) in [
        (0, "Hairpin {\"type\":\"hello\",\"hairpin\":2}"),
        (1, "Program {\"type\": \"ready\""),
        (2, "Hairpin {\"type\":\"reset\",\"case\":\"0000\",\"run\":0}"),
        (4, "Hairpin {\"type\":\"mission\""),
    ] {
        assert!(said[place].starts_with(beginning), "{said:?}");
    }
    assert_eq!(said.len(), 5 + 3 + 1);
    assert!(answer.worker.unwrap().stop().is_none());
    assert_eq!(wire.take().said[0].line, "{\"type\":\"bye\"}");
}
