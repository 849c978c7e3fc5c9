//! Logs that end where their mission does and did not fly it, and logs that do not tell what of them moved.

use super::*;

/// A square that comes back to its start.
const SQUARE: [[f64; 3]; 5] = [[4.0, 4.0, 5.0], [24.0, 4.0, 5.0], [24.0, 24.0, 5.0], [4.0, 24.0, 5.0], [4.0, 4.0, 5.0]];
/// An eight whose first leg crosses its last.
const EIGHT: [[f64; 3]; 4] = [[4.0, 4.0, 5.0], [24.0, 24.0, 5.0], [24.0, 4.0, 5.0], [4.0, 24.0, 5.0]];

/// At 5 m/s and 100 samples a second from place to place; the first of them is where it stands for 2 s.
fn through(places: &[[f64; 3]]) -> Logged {
    let start = Point3::from(places[0]);
    let mut way: Vec<Point3<f64>> = vec![start; 200];
    for pair in places.windows(2) {
        let (from, to) = (Point3::from(pair[0]), Point3::from(pair[1]));
        let steps = ((to - from).norm() / SPEED * 100.0).round() as usize;
        way.extend((1..=steps).map(|step| from + (to - from) * (step as f64 / steps as f64)));
    }
    let sample = |(i, p_m): (usize, &Point3<f64>)| {
        let t_s = i as f64 / 100.0;
        Sample { t_s, p_m: *p_m, attitude: None, v_m_s: None, accuracy_m: None }
    };
    let samples = way.iter().enumerate().map(sample).collect();
    Logged { format: "TUM", motions: vec![LoggedMotion::of("a.tum", Source::Untold, samples)], ..log(100.0, 0.0) }
}

fn over(logged: &Logged, mission: &[[f64; 3]]) -> (String, u8, Found) {
    let judged = judged_as(logged, |_, here| {
        let rows: String = mission.iter().map(|[x, y, z]| format!("{x},{y},{z}\n")).collect();
        fs::write(here.join("m.csv"), format!("x_m,y_m,z_m\n{rows}")).unwrap();
    });
    let judged = judged.unwrap();
    (judged.verdict.sentence, judged.verdict.exit_code, judged.found.unwrap())
}

#[test]
fn who_ends_at_the_last_waypoint_need_not_have_been_at_the_others() {
    let (sentence, code, found) = over(&through(&SQUARE), &SQUARE);
    assert!(code == 0 && found.finished && found.missed.is_none(), "{sentence}");
    // Where it stands is the last waypoint, too.
    let (sentence, code, found) = over(&through(&SQUARE[..1]), &SQUARE);
    assert!(code == 5 && !found.finished && sentence.starts_with("INCONCLUSIVE m"), "{sentence}");
    let words = "waypoint 1 of 0 to 4 was never reached: 20.00 m at the nearest, 1 m accepted";
    assert!(sentence.contains(words), "{sentence}");
    assert_eq!(found.missed.map(|missed| (missed.waypoint, missed.of)), Some((1, 5)));
    // Out and back along the first leg, half of which is far from any other.
    let (sentence, code, found) = over(&through(&[SQUARE[0], [14.0, 4.0, 5.0], SQUARE[0]]), &SQUARE);
    assert!(code == 1 && !found.finished, "{sentence}");
    assert_eq!(found.missed.map(|missed| missed.waypoint), Some(1), "{sentence}");
    // From the first leg to the last where they cross.
    let cut = [EIGHT[0], [14.0, 14.0, 5.0], EIGHT[3]];
    let (sentence, code, found) = over(&through(&cut), &EIGHT);
    assert!(code == 5 && !found.finished, "{sentence}");
    assert!(sentence.contains("waypoint 1 of 0 to 3 was never reached: 14.14 m"), "{sentence}");
    assert_eq!(over(&through(&EIGHT), &EIGHT).1, 0);
    // What was violated all the same is a violation.
    let (sentence, code, _) = over(&through(&[SQUARE[0], [14.0, 8.0, 5.0], SQUARE[0]]), &SQUARE);
    assert!(code == 1, "{sentence}");
}

#[test]
fn a_column_of_legs_is_no_word_that_they_were_flown() {
    let step = |t_s: f64, item: u32| Progress { t_s, item, of: None, target_m: None };
    let mut log = Logged { format: "CSV", ..through(&SQUARE) };
    log.progress = vec![step(0.0, 1), step(6.0, 2), step(10.0, 3), step(14.0, 4)];
    let (sentence, code, found) = over(&log, &SQUARE);
    assert!(code == 0 && found.legs_by == LegsBy::Count && found.finished, "{sentence}");
    // It stops at its second leg, and the log goes on.
    log.progress.truncate(2);
    assert!(!over(&log, &SQUARE).2.finished);
    // Standing at the start it counts to the last leg.
    let mut still = Logged { format: "CSV", ..through(&SQUARE[..1]) };
    still.progress = vec![step(0.0, 1), step(0.1, 2), step(0.2, 3), step(0.3, 4)];
    assert!(!over(&still, &SQUARE).2.finished);
}

#[test]
fn a_column_of_other_legs_is_refused() {
    let step = |t_s: f64, item: u32| Progress { t_s, item, of: None, target_m: None };
    let with = |steps: &[(f64, u32)]| {
        let progress = steps.iter().map(|(t_s, leg)| step(*t_s, leg + 1)).collect();
        judged_as(&Logged { format: "CSV", progress, ..log(100.0, 0.3) }, |_, _| {})
    };
    // Behind the last one it may say that all are reached.
    assert_eq!(with(&[(0.0, 0), (4.0, 1), (7.99, 2)]).unwrap().verdict.exit_code, 0);
    let told = with(&[(0.0, 0), (4.0, 57)]).unwrap_err();
    assert!(told.ends_with("column `leg` is 57 at t = 4 s, must be 0 … 1"), "{told}");
    let told = with(&[(0.0, 1), (4.0, 2)]).unwrap_err();
    assert!(told.ends_with("`leg` is 2 at t = 4 s, must be 0 … 1: it seems to number legs from 1"), "{told}");
}

#[test]
fn a_mission_state_that_stops_at_its_first_leg_is_no_whole_mission() {
    let target = |k: usize| Some(Point3::from(SQUARE[k]));
    let mut log = Logged { format: "PX4 ULog", ..through(&[SQUARE[0], [14.0, 4.0, 5.0], SQUARE[0]]) };
    let step = |t_s: f64, item: u32, k: usize| Progress { t_s, item, of: None, target_m: target(k) };
    log.progress = vec![step(0.0, 1, 0), step(1.0, 2, 1)];
    let (sentence, code, found) = over(&log, &SQUARE);
    assert_eq!((found.legs_by, found.finished, found.missed), (LegsBy::Targets, false, None));
    assert!(code == 5 && sentence.contains("the log ends, on leg 0→1 of 5 waypoints"), "{sentence}");
}

/// What `through` flew of `mission` at 100 Hz, with the moments at which an autopilot says it flies to which waypoint.
fn by_autopilot(flown: &[[f64; 3]], mission: &[[f64; 3]], times: &[f64]) -> Logged {
    let mut log = Logged { format: "PX4 ULog", ..through(flown) };
    let step = |(k, t_s): (usize, &f64)| Progress {
        t_s: *t_s,
        item: k as u32,
        of: None,
        target_m: mission.get(k).map(|place| Point3::from(*place)),
    };
    log.progress = times.iter().enumerate().map(step).collect();
    log.events = vec![event(0.0, EventKind::MissionBegins, "nav_state AUTO_MISSION")];
    log
}

#[test]
fn what_an_autopilot_flies_after_the_judged_part_is_not_flown_in_it() {
    let log = by_autopilot(&SQUARE, &SQUARE, &[0.0, 2.0, 6.0, 10.0, 14.0]);
    let (sentence, code, found) = over(&log, &SQUARE);
    assert!(code == 0 && found.finished && found.missed.is_none(), "{sentence}");
    // The mission ends where it begins, near which it is left and taken up again.
    let mut left = log.clone();
    left.events.push(event(2.1, EventKind::MissionEnds, "nav_state POSCTL"));
    left.events.push(event(2.4, EventKind::MissionBegins, "nav_state AUTO_MISSION"));
    let (sentence, code, found) = over(&left, &SQUARE);
    assert!(code == 5 && !found.finished && sentence.starts_with("INCONCLUSIVE m"), "{sentence}");
    assert!(sentence.contains("nav_state POSCTL at t = 2.1 s, on leg 0→1 of 5 waypoints"), "{sentence}");
    // It says that it has finished, and flies on.
    let mut early = log;
    early.events.push(event(4.0, EventKind::MissionEnds, "mission_result finished"));
    let (sentence, code, found) = over(&early, &SQUARE);
    assert!(code == 5 && !found.finished, "{sentence}");
    assert!(sentence.contains("mission_result finished at t = 4.0 s, on leg 0→1 of 5 waypoints"), "{sentence}");
}

#[test]
fn an_autopilots_word_is_held_against_its_positions() {
    // There and back, and to the side.
    let mission = [SQUARE[0], SQUARE[1], SQUARE[0], SQUARE[3]];
    let turned = |x: f64| {
        let flown = [mission[0], [x, 4.0, 5.0], mission[2], mission[3]];
        let way_s = (x - 4.0) / SPEED;
        over(&by_autopilot(&flown, &mission, &[0.0, 2.0, 2.0 + way_s, 2.0 + 2.0 * way_s]), &mission)
    };
    let (sentence, code, found) = turned(17.0);
    assert!(code == 5 && !found.finished, "{sentence}");
    let words = "waypoint 1 of 0 to 3 was never reached: 7.00 m at the nearest, 3 m accepted";
    assert!(sentence.contains(words), "{sentence}");
    assert_eq!(found.missed.map(|missed| missed.waypoint), Some(1));
    // Its own radius may be wider than the scenario's.
    let (sentence, _, found) = turned(22.0);
    assert!(found.finished && found.missed.is_none(), "{sentence}");
    // It says that it has finished, 15 m before the last waypoint.
    let mut short = by_autopilot(&SQUARE, &SQUARE, &[0.0, 2.0, 6.0, 10.0, 14.0]);
    short.events.push(event(15.0, EventKind::MissionEnds, "mission_result finished"));
    let (sentence, code, found) = over(&short, &SQUARE);
    assert!(code == 5 && !found.finished, "{sentence}");
    assert!(sentence.contains("waypoint 4 of 0 to 4 was never reached: "), "{sentence}");
}

#[test]
fn positions_that_the_mission_outlasts_are_a_gap() {
    let with = |from_s: f64, to_s: f64, finished: Option<f64>| {
        let mut log = by_autopilot(&SQUARE, &SQUARE, &[0.0, 2.0, 6.0, 10.0, 14.0]);
        log.motions[0].samples.retain(|sample| (from_s..=to_s).contains(&sample.t_s));
        log.events.extend(finished.map(|t_s| event(t_s, EventKind::MissionEnds, "mission_result finished")));
        log
    };
    let (end, begin) = ("the positions end before the mission does", "the mission begins before the positions do");
    for (log, which, at) in [
        (with(0.0, 12.0, Some(18.0)), end, "of 6.0 s at t = 12.0 s"),
        (with(0.0, 12.0, None), end, "of 2.0 s at t = 12.0 s"),
        (with(8.0, 18.0, None), begin, "of 6.0 s at t = 2.0 s"),
    ] {
        let words = format!("gap ({which}) {at} not judged");
        let (sentence, code, found) = over(&log, &SQUARE);
        assert!(code == 5 && sentence.starts_with("INVALID m") && sentence.contains(&words), "{sentence}");
        assert_eq!(found.cuts.len(), 1, "{sentence}");
        // Without a mission beside it, too.
        let anything = hairpin::judgement::Swiftness { speed: None, acceleration: None };
        let sound = Unsound { resets: &[], invalid: &[], dropouts: &[] };
        assert_eq!(cut(&log.motions[0].samples, sound, due_alone(&log), &anything).cuts.len(), 1);
    }
    // Samples are not where words are, and a first word may be from before the log began.
    let (sentence, _, found) = over(&with(2.5, 18.0, Some(18.03)), &SQUARE);
    assert!(found.cuts.is_empty() && found.finished, "{sentence}");
    // What its user types is not the log's word.
    let mut late = log(100.0, 0.3);
    late.motions[0].samples.iter_mut().for_each(|sample| sample.t_s += 5.0);
    let judged = judged_as(&late, |settings, _| settings.from_s = Some(0.0)).unwrap();
    assert_eq!(judged.verdict.exit_code, 0, "{}", judged.verdict.sentence);
}

#[test]
fn a_mission_that_is_flown_twice_is_judged_by_the_flight_that_is_chosen() {
    let first = by_autopilot(&SQUARE, &SQUARE, &[0.0, 2.0, 6.0, 10.0, 14.0]);
    let with = |mut log: Logged, again: f64| {
        log.events.push(event(17.9, EventKind::MissionEnds, "mission_result finished"));
        log.events.push(event(again, EventKind::MissionBegins, "nav_state AUTO_MISSION"));
        log
    };
    // Its mode alone is no flight.
    let (sentence, code, found) = over(&with(first.clone(), 17.95), &SQUARE);
    assert!(code == 0 && found.again_s.is_none(), "{sentence}");
    let around: Vec<[f64; 3]> = SQUARE.iter().chain(&SQUARE[1..]).copied().collect();
    let mut twice = with(by_autopilot(&around, &SQUARE, &[0.0, 2.0, 6.0, 10.0, 14.0]), 18.0);
    let second = first.progress.iter().zip([17.95, 18.0, 22.0, 26.0, 30.0]);
    twice.progress.extend(second.map(|(step, t_s)| Progress { t_s, ..*step }));
    let (sentence, code, found) = over(&twice, &SQUARE);
    assert!(code == 5 && found.finished && found.again_s == Some(18.0), "{sentence}");
    let words =
        "the mission is flown again from t = 18.0 s, which is not judged: --from S and --to S choose one flight";
    assert!(sentence.contains(words) && found.notes.iter().any(|note| note == words), "{sentence}");
    let chosen = |from_s: Option<f64>, to_s: Option<f64>| {
        let judged = judged_as(&twice, |settings, here| {
            let rows = SQUARE.map(|[x, y, z]| format!("{x},{y},{z}\n")).concat();
            fs::write(here.join("m.csv"), format!("x_m,y_m,z_m\n{rows}")).unwrap();
            (settings.from_s, settings.to_s) = (from_s, to_s);
        });
        let judged = judged.unwrap();
        assert_eq!(judged.verdict.exit_code, 0, "{}", judged.verdict.sentence);
        judged.found.unwrap().span_s.unwrap()
    };
    assert_eq!(chosen(None, Some(17.9)), [2.0, 17.9]);
    assert_eq!(chosen(Some(17.92), None)[0], 18.0);
}

/// The square by an autopilot's word, 0.65 m above the middle of its first leg, judged from `from_s` to `to_s`.
fn from(from_s: Option<f64>, to_s: Option<f64>, change: impl FnOnce(&mut Logged)) -> (String, u8, Found) {
    let mut log = by_autopilot(&SQUARE, &SQUARE, &[0.0, 2.0, 6.0, 10.0, 14.0]);
    let first_leg = log.motions[0].samples.iter_mut().filter(|s| (2.0..6.0).contains(&s.t_s));
    first_leg.for_each(|s| s.p_m.z += 0.65 * (std::f64::consts::PI * (s.t_s - 2.0) / 4.0).sin().powi(2));
    change(&mut log);
    let judged = judged_as(&log, |settings, here| {
        let rows = SQUARE.map(|[x, y, z]| format!("{x},{y},{z}\n")).concat();
        fs::write(here.join("m.csv"), format!("x_m,y_m,z_m\n{rows}")).unwrap();
        (settings.from_s, settings.to_s) = (from_s, to_s);
    });
    let judged = judged.unwrap();
    (judged.verdict.sentence, judged.verdict.exit_code, judged.found.unwrap())
}

#[test]
fn what_is_judged_from_the_middle_cannot_pass() {
    // The violation is on the first leg: seen, it is one, whatever is left out before it.
    for from_s in [None, Some(1.5), Some(2.0), Some(3.0)] {
        let (sentence, code, _) = from(from_s, None, |_| {});
        assert!(code == 1 && sentence.starts_with("FAIL"), "{sentence}");
    }
    for (from_s, words) in [
        (5.0, "--from leaves out a part of leg 0→1: 3.00 s since the mission left waypoint 0 at t = 2.00 s"),
        (6.0, "--from leaves out leg 0→1: 4.00 s since the mission left waypoint 0 at t = 2.00 s"),
        (7.0, "--from leaves out leg 0→1 and a part of leg 1→2: 5.00 s since"),
        (12.0, "--from leaves out legs 0→1 to 1→2 and a part of leg 2→3: 10.00 s since"),
    ] {
        let (sentence, code, found) = from(Some(from_s), None, |_| {});
        assert!(code == 5 && sentence.contains(&format!("told): {words}")), "{sentence}");
        assert!(!found.finished && found.to_the_end && sentence.contains(" are not judged; 0."));
        assert!(found.notes.iter().any(|note| note.starts_with(words)), "{:?}", found.notes);
    }
    // Both ends are told.
    let (sentence, code, _) = from(Some(7.0), Some(12.0), |_| {});
    assert!(code == 5 && sentence.contains("--from leaves out leg 0→1 and a part"), "{sentence}");
    assert!(sentence.contains("; --to at t = 12.0 s, on leg 2→3 of 5 waypoints: what was left"), "{sentence}");
    // What is left out before the mission left its first waypoint is none of it.
    let keep = |log: &mut Logged| log.motions[0].samples.iter_mut().for_each(|s| s.p_m.z = 5.0);
    for from_s in [None, Some(0.5), Some(1.995), Some(2.0)] {
        let (sentence, code, found) = from(from_s, None, keep);
        assert!(code == 0 && found.left_out.is_none(), "{sentence}");
    }
    // Nor is what begins between two samples; positions that begin late are a gap, from when on ever they are judged.
    let (sentence, code, _) = from(Some(2.005), None, |log| {
        keep(log);
        log.progress[1].t_s = 2.001;
    });
    assert_eq!(code, 0, "{sentence}");
    for from_s in [2.5, 4.9] {
        let (sentence, code, _) = from(Some(from_s), None, |log| log.motions[0].samples.retain(|s| s.t_s >= 5.0));
        assert!(code == 5 && !sentence.starts_with("PASS"), "{sentence}");
    }
    // A first leg that is over before the first position.
    let (sentence, code, found) = from(None, None, |log| {
        keep(log);
        log.motions[0].samples.retain(|s| s.t_s >= 6.1);
        log.progress[1].t_s = 5.5;
    });
    let words = "the positions leave out leg 0→1: 0.60 s since the mission left waypoint 0 at t = 5.50 s";
    assert!(code == 5 && sentence.contains(words) && found.left_out.is_some(), "{sentence}");
}

/// Several topics of a bag.
fn bag(topics: &[(&str, Source)]) -> Logged {
    let motions = topics.iter().map(|(name, source)| LoggedMotion::of(name, *source, samples(100.0, 0.3))).collect();
    Logged { format: "ROS 2 MCAP", motions, ..log(100.0, 0.3) }
}

#[test]
fn what_may_be_a_plan_is_judged_only_where_it_is_named() {
    let asked = |logged: &Logged, topic: &str| {
        judged_as(logged, |settings, _| settings.source = Some(topic.into())).unwrap().verdict
    };
    let refused = |logged: &Logged| judged_as(logged, |_, _| {}).unwrap_err();
    // Two that do not tell whose word they are.
    let two = bag(&[("/a_pose", Source::Untold), ("/vicon/pose", Source::Untold), ("/plan", Source::Asked)]);
    let told = refused(&two);
    assert!(told.contains("several topics may be what moved: /a_pose, /vicon/pose; --source TOPIC"), "{told}");
    assert_eq!(asked(&two, "/vicon/pose").exit_code, 0);
    let told = best(&two, &Asks::FIT).unwrap_err();
    assert!(told.contains("/vicon/pose; `fit` reads") && !told.contains("--source"), "{told}");
    // One beside plans and goals is what moved.
    let one = bag(&[("/robot/odom", Source::Untold), ("/trail", Source::Way), ("/goal_pose", Source::Asked)]);
    let found = judged_as(&one, |_, _| {}).unwrap().found.unwrap();
    assert_eq!((found.source.topic.as_str(), found.source.others.len()), ("/robot/odom", 2));
    // A plan alone is none, and by its name it is told in the sentence.
    for (name, source, words) in [
        ("/planned", Source::Asked, "by its name a plan, goal or command"),
        ("/trail", Source::Way, "a whole way, of a plan or a trail"),
    ] {
        let alone = bag(&[(name, source)]);
        let told = refused(&alone);
        assert!(told.contains(&format!("{name} may be a plan, a goal or a command; --source TOPIC")), "{told}");
        let sentence = asked(&alone, name).sentence;
        assert!(sentence.starts_with(&format!("PASS m (flown, log_24.ulg, {words}): ")), "{sentence}");
    }
}

#[test]
fn what_is_at_two_places_at_one_moment_is_not_judged() {
    let mut two = bag(&[("/a/odom", Source::Untold), ("/b/pose", Source::Asked)]);
    two.motions[0].unfit = Some("two places with the stamp 7 s, here and there".into());
    let told = judged_as(&two, |_, _| {}).unwrap_err();
    assert!(told.contains("/a/odom: two places with the stamp 7 s, here and there"), "{told}");
    // Nor where it is named; another that is named is.
    let by_name = |topic: &str| judged_as(&two, |settings, _| settings.source = Some(topic.into()));
    assert!(by_name("/a/odom").unwrap_err().contains("two places with the stamp 7 s"));
    assert_eq!(by_name("/b/pose").unwrap().verdict.exit_code, 0);
    assert!(best(&two, &Asks::FIT).unwrap_err().contains("two places"));
}

#[test]
fn a_limit_that_a_log_does_not_measure_is_open() {
    let both = [("spec.deviation.max_m".to_owned(), "0.5".to_owned()), ("spec.clearance.min_m".into(), "0.1".into())];
    // Without --world no obstacle is known.
    let judged = judged_as(&log(100.0, 0.3), |settings, _| settings.sets = both.to_vec()).unwrap().verdict;
    assert_eq!(judged.exit_code, 5, "{}", judged.sentence);
    assert!(judged.sentence.contains("not all that `spec` limits was measured: no clearance"), "{}", judged.sentence);
    let violated = judged_as(&log(100.0, 0.65), |settings, _| settings.sets = both.to_vec()).unwrap().verdict;
    assert_eq!(violated.exit_code, 1, "{}", violated.sentence);
}
