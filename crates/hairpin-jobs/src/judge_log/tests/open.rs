//! What a log leaves open beside its limits: the world's edge, bounds that it exceeds, when its mission began, and
//! whether that ever did.

use super::*;

/// Judged in a world of `size_m`, as far off its legs as it likes.
fn walled(logged: &Logged, size_m: &str) -> (String, u8) {
    let judged = judged_as(logged, |settings, here| {
        let world = here.join("w.toml");
        fs::write(&world, format!("size_m = {size_m}\n")).unwrap();
        settings.world = Some(world.to_string_lossy().into_owned());
        settings.sets = vec![("spec.deviation.max_m".into(), "5".into())];
    });
    let verdict = judged.unwrap().verdict;
    (verdict.sentence, verdict.exit_code)
}

#[test]
fn a_wall_that_may_be_behind_two_samples_is_open() {
    // Waypoint 1 is at x = 24 m: twice a second more than 0.2 m may hide, a hundred times no more than a millimetre.
    let near = "[24.2, 30, 30]";
    let (sentence, code) = walled(&log(100.0, 0.0), near);
    assert_eq!(code, 0, "{sentence}");
    let (sentence, code) = walled(&log(2.0, 0.0), near);
    assert_eq!(code, 5, "{sentence}");
    for words in ["distance to the world's edge 0.20 m ≥ 0.00 m in samples at 2 Hz, but -", "Hz or faster"] {
        assert!(sentence.contains(words), "{words}: {sentence}");
    }
    // Far walls are not in doubt, nor are those that are not known.
    assert_eq!(walled(&log(2.0, 0.0), "[60, 60, 60]").1, 0);
    let lax = |settings: &mut LogSettings, _: &Path| settings.sets = vec![("spec.deviation.max_m".into(), "5".into())];
    assert_eq!(judged_as(&log(2.0, 0.0), lax).unwrap().verdict.exit_code, 0);
}

#[test]
fn a_wall_within_what_the_log_knows_of_its_place_is_open() {
    let with = |accuracy: [f64; 2]| {
        let mut log = log(100.0, 0.0);
        log.motions[0].samples.iter_mut().for_each(|s| s.accuracy_m = Some(accuracy));
        log
    };
    let (sentence, code) = walled(&with([1.0, 0.2]), "[24.3, 30, 30]");
    let words = "INCONCLUSIVE m (flown, log_24.ulg, EKF2 estimate): distance to the world's edge 0.30 m ≥ 0.00 m, but \
                 the log's own eph is 1.0 m, so that it may have left the world; judge motion capture";
    assert_eq!((sentence.as_str(), code), (words, 5));
    // The ceiling is as near as the log knows its height, not its place.
    let (sentence, code) = walled(&with([0.2, 1.0]), "[30, 30, 5.3]");
    assert!(code == 5 && sentence.contains("the log's own epv is 1.0 m"), "{sentence}");
    for (accuracy, size_m) in [([0.2, 1.0], "[24.3, 30, 30]"), ([1.0, 0.2], "[30, 30, 5.3]")] {
        let (sentence, code) = walled(&with(accuracy), size_m);
        assert_eq!(code, 0, "{sentence}");
    }
}

#[test]
fn bounds_that_the_log_itself_exceeds_bound_nothing() {
    let with_velocities = |faster: f64, off: f64| {
        let mut log = log(100.0, off);
        for sample in &mut log.motions[0].samples {
            let way = if sample.t_s < 4.0 { Vector3::x() } else { Vector3::y() };
            sample.v_m_s = Some(way * SPEED * faster);
            sample.t_s /= faster;
        }
        log
    };
    // At 40 m/s; the robot's file has 18.
    let judged = judged_as(&with_velocities(8.0, 0.0), |_, _| {}).unwrap();
    let sentence = &judged.verdict.sentence;
    assert_eq!(judged.verdict.exit_code, 5, "{sentence}");
    let words = "the log's own speed of 40.0 m/s is beyond the robot's 18.0 m/s";
    assert!(sentence.contains(words), "{sentence}");
    let flown = judged.found.unwrap().flown.unwrap();
    assert_eq!((flown.swiftness.speed, flown.swiftness.acceleration), (None, None));
    assert!(flown.most_between.is_infinite() && flown.exceeded.is_some_and(|exceeded| exceeded.what == "speed"));
    // What is told is the largest that the samples have, not where it is first in doubt.
    let sentence = said(&with_velocities(8.0, 0.3)).0;
    assert!(sentence.contains(": 0.30 m ≤ 0.50 m in samples at 800 Hz, but nothing bounds"), "{sentence}");
    // So do positions alone, whatever velocities stand beside them.
    for v_m_s in [None, Some(Vector3::x())] {
        let mut log = with_velocities(4.0, 0.0);
        log.motions[0].samples.iter_mut().for_each(|sample| sample.v_m_s = v_m_s);
        let verdict = judged_as(&log, |_, _| {}).unwrap().verdict;
        assert!(verdict.exit_code == 5 && verdict.sentence.contains("own speed of 20.0 m/s"), "{}", verdict.sentence);
    }
    // From one way into another within a hundredth of a second: what is left is the bound of speeds.
    let judged = judged_as(&with_velocities(1.0, 0.46), |_, _| {}).unwrap();
    let sentence = &judged.verdict.sentence;
    assert!(
        judged.verdict.exit_code == 5 && sentence.contains("the log's own acceleration of 707.1 m/s²"),
        "{sentence}"
    );
    let flown = judged.found.unwrap().flown.unwrap();
    assert_eq!((flown.swiftness.speed, flown.swiftness.acceleration), (Some(18.0), None));
    assert_eq!(judged_as(&with_velocities(1.0, 0.3), |_, _| {}).unwrap().verdict.exit_code, 0);
}

/// Stamps in another unit keep every limit of duration.
#[test]
fn what_no_robot_of_the_file_flies_decides_nothing() {
    let of = |share: f64| {
        let mut log = log(100.0, 0.0);
        log.motions[0].samples.iter_mut().for_each(|sample| sample.t_s *= share);
        let brief =
            |settings: &mut LogSettings, _: &Path| settings.sets = vec![("spec.total_time.max_s".into(), "9".into())];
        let verdict = judged_as(&log, brief).unwrap().verdict;
        (verdict.sentence, verdict.exit_code)
    };
    assert_eq!(of(1.0).1, 0, "{}", of(1.0).0);
    let (sentence, code) = of(1e-3);
    let words = "28.28 m in 0.0080 s from t = 0.00 s on are 3535.5 m/s, and ten times what its file allows is ";
    assert!(code == 5 && sentence.contains(&format!("without accuracy): {words}")), "{sentence}");
}

#[test]
fn modes_that_fly_no_mission_decide_nothing() {
    let other = |t_s: f64, words: &str| event(t_s, EventKind::OtherMode, words);
    let mut posctl = log(100.0, 0.65);
    posctl.events =
        vec![other(0.0, "nav_state POSCTL"), other(3.0, "nav_state MANUAL"), other(5.0, "nav_state POSCTL")];
    let judged = judged_as(&posctl, |_, _| {}).unwrap();
    let words = "INCONCLUSIVE m (flown, log_24.ulg, EKF2 estimate without accuracy): the mission never began: modes \
                 nav_state POSCTL, nav_state MANUAL; what else was done is not judged";
    assert_eq!((judged.verdict.sentence.as_str(), judged.verdict.exit_code), (words, 5));
    assert!(judged.found.unwrap().flown.is_none());
    // Whoever does not tell modes says nothing of the kind.
    posctl.events.clear();
    assert_eq!(said(&posctl).1, 1);
}

#[test]
fn how_long_a_mission_took_is_not_seen_in_a_part_of_it() {
    let within = |logged: &Logged, most_s: &str, from_s: Option<f64>| {
        let judged = judged_as(logged, |settings, _| {
            settings.sets.push(("spec.total_time.max_s".into(), most_s.into()));
            settings.from_s = from_s;
        });
        let verdict = judged.unwrap().verdict;
        (verdict.sentence, verdict.exit_code)
    };
    let whole = log(100.0, 0.3);
    assert_eq!(within(&whole, "8.5", None).1, 0);
    assert_eq!(within(&whole, "7.9", None).1, 1);
    let (sentence, code) = within(&whole, "7.9", Some(0.15));
    assert!(code == 5 && sentence.contains("when the mission began is not seen: --from leaves out 0.1"), "{sentence}");
    let to = |most_s: &str| {
        let judged = judged_as(&whole, |settings, _| {
            settings.sets.push(("spec.total_time.max_s".into(), most_s.into()));
            settings.to_s = Some(7.95);
        });
        let verdict = judged.unwrap().verdict;
        (verdict.sentence, verdict.exit_code)
    };
    let (sentence, code) = to("7.97");
    assert!(code == 5 && sentence.contains("when the mission ended is not seen: --to leaves out 0."), "{sentence}");
    assert_eq!(to("7").1, 1);
    // What the part alone exceeds is a violation.
    assert_eq!(within(&whole, "7", Some(0.15)).1, 1);
    // A log that has no more than that.
    let mut late = whole.clone();
    late.motions[0].samples.retain(|s| s.t_s >= 0.145);
    let (sentence, code) = within(&late, "7.9", None);
    assert!(code == 5 && sentence.contains("the log begins amid the motion away from waypoint 0"), "{sentence}");
    // From standing beside waypoint 0 all of it is seen, and so it is where the log tells when the mission began.
    let mut stood = whole.clone();
    stood.motions[0].samples.iter_mut().for_each(|s| s.p_m.z += 0.2);
    let still = |i: i32| Sample { t_s: f64::from(i) / 100.0, ..stood.motions[0].samples[0] };
    let before: Vec<Sample> = (-100..0).map(still).collect();
    stood.motions[0].samples.splice(0..0, before);
    assert_eq!(within(&stood, "9.5", None).1, 0);
    let mut told = whole;
    told.events = vec![event(0.145, EventKind::MissionBegins, "nav_state AUTO_MISSION")];
    assert_eq!(within(&told, "7.9", None).1, 0);
}

#[test]
fn what_is_told_of_the_edge_is_the_least_distance() {
    // At 40 m/s, which no robot of the file flies: nothing bounds what lies between two samples, from the first on.
    let mut fast = log(100.0, 0.0);
    for sample in &mut fast.motions[0].samples {
        let way = if sample.t_s < 4.0 { Vector3::x() } else { Vector3::y() };
        sample.v_m_s = Some(way * SPEED * 8.0);
        sample.t_s /= 8.0;
    }
    let judged = judged_as(&fast, |settings, here| {
        let world = here.join("w.toml");
        fs::write(&world, "size_m = [24.2, 30, 30]\n").unwrap();
        settings.world = Some(world.to_string_lossy().into_owned());
    });
    let judged = judged.unwrap();
    let words = "distance to the world's edge 0.20 m ≥ 0.00 m in samples at 800 Hz, but nothing bounds";
    assert!(judged.verdict.sentence.contains(words), "{}", judged.verdict.sentence);
    let flown = judged.found.unwrap().flown.unwrap();
    let edge = flown.doubts.iter().find(|doubt| doubt.value.what == "edge").unwrap();
    assert!((edge.value.at - 0.5).abs() < 1e-9 && (edge.value.value - 0.2).abs() < 1e-9, "{edge:?}");
}

#[test]
fn parts_that_end_before_they_begin_are_refused_and_what_a_flag_ends_is_said() {
    let here = TempDir::new().unwrap();
    let mut settings = settings(here.path(), HALF);
    (settings.from_s, settings.to_s) = (Some(20.0), Some(10.0));
    let told = judge_log(&settings, &crate::Unwatched).unwrap_err().to_string();
    assert!(told.contains("--from 20 --to 10: --from must be before --to"), "{told}");
    let cut = judged_as(&log(100.0, 0.1), |settings, _| settings.to_s = Some(6.0)).unwrap().verdict;
    assert!(cut.exit_code == 5 && cut.sentence.contains("--to at t = 6.0 s, on leg 1→2"), "{}", cut.sentence);
    let longer = judged_as(&log(100.0, 0.1), |settings, _| settings.to_s = Some(60.0)).unwrap().verdict;
    assert_eq!(longer.exit_code, 0, "{}", longer.sentence);
}

#[test]
fn a_mission_in_degrees_needs_a_world_on_earth() {
    let told = judged_as(&log(100.0, 0.1), |settings, here| {
        let file = here.join("degrees.csv");
        fs::write(&file, "lat_deg,lon_deg,alt_amsl_m\n47,8,405\n47.0001,8,405\n").unwrap();
        settings.against = Against::Mission { file, robot: Some("flightgoggles".into()) };
    });
    let told = told.unwrap_err();
    assert!(told.contains("degrees.csv") && told.contains("without --world there is no world.origin"), "{told}");
}
