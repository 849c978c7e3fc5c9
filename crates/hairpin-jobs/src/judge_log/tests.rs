//! Logs made by hand, whose right answer is known by construction: each with its sentence and its exit code.

use std::fs;
use std::path::Path;

use hairpin::campaign::scenario::Origin;
use hairpin::campaign::{Case, CaseNumber};
use hairpin_formats::frames::Geodetic;
use hairpin_formats::logs::{
    Clock, Event, EventKind, LogFrame, Logged, LoggedMotion, Progress, Reset, Sample, Source, Span, ToldTo,
};
use hairpin_formats::placement::Placement;
use nalgebra::{Point3, Rotation3, Vector3};
use tempfile::TempDir;

use super::against::Ready;
use super::*;

mod heights;
mod missions;
mod open;
mod unflown;

const SPEED: f64 = 5.0;

/// Two legs of 20 m, flown at 5 m/s.
fn corners() -> [Point3<f64>; 3] {
    [Point3::new(4.0, 4.0, 5.0), Point3::new(24.0, 4.0, 5.0), Point3::new(24.0, 24.0, 5.0)]
}

/// Where the robot is `t` s after the start: `off` m beside the middle of the first leg, none at its ends.
fn place(t: f64, off: f64) -> Point3<f64> {
    let along = SPEED * t;
    if along <= 20.0 {
        let beside = (std::f64::consts::PI * along / 20.0).sin();
        return corners()[0] + Vector3::new(along, off * beside * beside, 0.0);
    }
    corners()[1] + Vector3::new(0.0, (along - 20.0).min(20.0), 0.0)
}

fn samples(rate: f64, off: f64) -> Vec<Sample> {
    let of = |i: usize| {
        let t_s = i as f64 / rate;
        Sample { t_s, p_m: place(t_s, off), attitude: None, v_m_s: None, accuracy_m: None }
    };
    (0..=(8.0 * rate) as usize).map(of).collect()
}

fn log(rate: f64, off: f64) -> Logged {
    Logged {
        format: "PX4 ULog",
        clock: Clock::SinceBoot,
        frame: LogFrame::Enu(None),
        motions: vec![LoggedMotion::of("vehicle_local_position", Source::Estimate, samples(rate, off))],
        joints: Vec::new(),
        progress: Vec::new(),
        events: Vec::new(),
        dropouts: Vec::new(),
        notes: Vec::new(),
    }
}

fn settings(here: &Path, sets: &[(&str, &str)]) -> LogSettings {
    let file = here.join("m.csv");
    let rows = corners().map(|p| format!("{},{},{}\n", p.x, p.y, p.z)).concat();
    fs::write(&file, format!("x_m,y_m,z_m\n{rows}")).unwrap();
    let against = Against::Mission { file, robot: Some("flightgoggles".into()) };
    LogSettings {
        sets: sets.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect(),
        ..LogSettings::new(here.join("log_24.ulg"), against)
    }
}

const HALF: &[(&str, &str)] = &[("spec.deviation.max_m", "0.5")];

fn judged_as(logged: &Logged, change: impl FnOnce(&mut LogSettings, &Path)) -> Result<JudgedLog, String> {
    let here = TempDir::new().unwrap();
    let mut settings = settings(here.path(), HALF);
    change(&mut settings, here.path());
    let against = Ready::of(&settings).map_err(|problem| problem.to_string())?;
    one::judge(&settings.path, logged, &against, &settings).map_err(|problem| problem.to_string())
}

/// The sentence and its exit code.
fn said(logged: &Logged) -> (String, u8) {
    let verdict = judged_as(logged, |_, _| {}).unwrap().verdict;
    (verdict.sentence, verdict.exit_code)
}

#[test]
fn what_keeps_its_limit_passes_and_what_does_not_fails() {
    let (sentence, code) = said(&log(100.0, 0.41));
    assert_eq!(code, 0, "{sentence}");
    assert!(
        sentence.starts_with(
            "PASS m (flown, log_24.ulg, EKF2 estimate without accuracy): 0.41 m ≤ 0.50 m, t = 2.00 s, leg 0→1"
        ),
        "{sentence}"
    );
    let (sentence, code) = said(&log(100.0, 0.65));
    assert_eq!(code, 1);
    assert!(
        sentence.starts_with(
            "FAIL m (flown, log_24.ulg, EKF2 estimate without accuracy): 0.65 m > 0.50 m, t = 2.00 s, leg 0→1"
        ),
        "{sentence}"
    );
    let found = judged_as(&log(100.0, 0.41), |_, _| {}).unwrap().found.unwrap();
    // Mean of sin² over the first half of the flight and of nothing over the second.
    let statistics = found.flown.unwrap().statistics.unwrap();
    assert!((statistics.mean - 0.41 / 4.0).abs() < 1e-3 && (statistics.max - 0.41).abs() < 1e-9, "{statistics:?}");
    assert!(found.finished && found.legs_by == LegsBy::Assigned);
}

/// What is within half a step of its limit, along all three axes, is open; what nothing rounded is as it is told.
#[test]
fn what_rounding_may_have_made_decides_nothing() {
    let rounded = |off: f64, told_to: Option<ToldTo>, limit: &str| {
        let mut logged = log(100.0, off);
        for sample in &mut logged.motions[0].samples {
            sample.p_m = Point3::from(sample.p_m.coords.map(|x| (10.0 * x).round() / 10.0));
        }
        logged.motions[0].told_to = told_to;
        let limits = &[("spec.deviation.max_m", limit)];
        let verdict = judged_as(&logged, |changed, here| *changed = settings(here, limits)).unwrap().verdict;
        (verdict.sentence, verdict.exit_code)
    };
    // Of whatever the numbers themselves show, and of a text whose last decimal it is.
    for told_to in [None, Some(ToldTo::Decimal(0.1)), Some(ToldTo::Steps([0.1; 3]))] {
        for (off, limit, seen) in
            [(0.54, "0.5", "0.50 m ≤ 0.50 m"), (0.56, "0.55", "0.60 m > 0.55 m"), (0.46, "0.5", "0.50 m ≤ 0.50 m")]
        {
            let (sentence, code) = rounded(off, told_to, limit);
            let why = "but its positions are told in steps that move them by up to 0.087 m";
            let seen = sentence.contains(&format!(": {seen}, {why}"));
            assert!(
                code == 5 && seen && sentence.contains("; log more digits or raise the limit"),
                "{off}: {sentence}"
            );
        }
        assert_eq!((rounded(0.65, told_to, "0.5").1, rounded(0.4, told_to, "0.5").1), (1, 0));
    }
    // A text that has three decimals tells three, whatever they are.
    assert_eq!(rounded(0.56, Some(ToldTo::Decimal(1e-3)), "0.55").1, 1);
    assert_eq!((said(&log(100.0, 0.49)).1, said(&log(100.0, 0.51)).1), (0, 1));
}

/// Velocities that contradict the positions beside them judge nothing, whether they are 0 throughout or lack a sway.
#[test]
fn velocities_are_believed_where_they_are_those_of_the_positions() {
    let limit = &[("spec.acceleration.max_m_s2", "5")];
    let judged = |sway: f64, velocity: &dyn Fn(f64) -> Vector3<f64>| {
        let rate = 50.0;
        let omega = 4.0 * std::f64::consts::PI;
        let at = |t: f64| corners()[0] + Vector3::new(10.0 - 10.0 * (0.3 * t).cos(), 0.0, sway * (omega * t).sin());
        let of = |i: usize| {
            let t_s = i as f64 / rate;
            Sample { t_s, p_m: at(t_s), attitude: None, v_m_s: Some(velocity(t_s)), accuracy_m: None }
        };
        let samples: Vec<Sample> = (0..=500).map(of).collect();
        let mut logged = log(rate, 0.0);
        logged.motions = vec![LoggedMotion::of("vehicle_local_position", Source::Estimate, samples)];
        let found = judged_as(&logged, |settings, here| *settings = super::tests::settings(here, limit)).unwrap();
        let found = found.found.unwrap();
        let flown = found.flown.unwrap();
        let broken: Vec<String> = flown.violations.iter().map(|violation| violation.what.clone()).collect();
        (broken, found.notes.iter().any(|note| note.contains("its velocities are not believed")), flown.measures)
    };
    let smooth = |t: f64| Vector3::new(3.0 * (0.3 * t).sin(), 0.0, 0.0);
    let (broken, told, measures) = judged(0.05, &smooth);
    assert!(broken == ["acceleration"] && told && (measures.max_acceleration - 7.9).abs() < 0.2, "{broken:?}");
    let (broken, told, measures) = judged(0.0, &|_| Vector3::zeros());
    assert!(broken.is_empty() && told && (measures.max_acceleration - 0.9).abs() < 0.05, "{broken:?}");
    let swaying = |t: f64| {
        let omega = 4.0 * std::f64::consts::PI;
        smooth(t) + Vector3::new(0.0, 0.0, 0.05 * omega * (omega * t).cos())
    };
    let (broken, told, _) = judged(0.05, &swaying);
    assert!(broken == ["acceleration"] && !told);
    assert!(!judged(0.0, &smooth).1);
}

/// Ten samples a second: at a bound of a m/s² up to a/800 m hide between two.
#[test]
fn what_may_hide_between_samples_is_open_and_the_rate_that_decides_is_named() {
    let judged = judged_as(&log(10.0, 0.46), |_, _| {}).unwrap();
    let sentence = &judged.verdict.sentence;
    assert_eq!(judged.verdict.exit_code, 5, "{sentence}");
    for words in [
        "INCONCLUSIVE m (flown, log_24.ulg, EKF2 estimate without accuracy): 0.46 m ≤ 0.50 m in samples at 10 Hz, but ",
        "may hide between two of them (speed ≤ ",
        "acceleration ≤ ",
        "log positions at ",
        "etc/logging/logger_topics.txt",
        "no SDLOG_PROFILE",
    ] {
        assert!(sentence.contains(words), "{words}: {sentence}");
    }
    let flown = judged.found.unwrap().flown.unwrap();
    let a = flown.swiftness.acceleration.unwrap();
    assert!((flown.most_between - 0.46 - a * 0.01 / 8.0).abs() < 2e-3, "{} {a}", flown.most_between);
    // The rate that is named decides.
    let Some(hairpin::campaign::Why::Between { rate_hz: Some(rate), .. }) = flown.doubts.first().map(|doubt| doubt.why)
    else {
        panic!("{:?}", flown.doubts)
    };
    assert_eq!(said(&log(rate.ceil(), 0.46)).1, 0);
    // A limit that is far away is kept at any rate, and what is not PX4's is told no profile.
    assert_eq!(said(&log(10.0, 0.2)).1, 0);
    let (sentence, _) = said(&Logged { format: "TUM", ..log(10.0, 0.46) });
    assert!(sentence.contains("Hz or faster") && !sentence.contains("SDLOG"), "{sentence}");
}

#[test]
fn resets_end_what_can_be_judged() {
    let mut announced = log(100.0, 0.3);
    announced.motions[0].resets = vec![Reset { t_s: 3.0, by_m: Some(Vector3::new(1.2, 0.0, 0.0)) }];
    let (sentence, code) = said(&announced);
    let words = "INVALID m (flown, log_24.ulg, EKF2 estimate without accuracy): position reset of 1.2 m at t = 3.0 s; 5.0 s after it not judged";
    assert_eq!((sentence.as_str(), code), (words, 5));
    // One that nobody announced, too: the robot cannot have been so fast.
    let mut silent = log(100.0, 0.3);
    silent.motions[0].samples.iter_mut().filter(|s| s.t_s >= 3.0).for_each(|s| s.p_m.x += 1.2);
    let (sentence, code) = said(&silent);
    // 1.2 m and the 5 cm that were flown.
    assert!(sentence.contains("position jump of 1.3 m at t = 3.0 s; 5.0 s after it not judged"), "{sentence}");
    assert_eq!(code, 5);
    // What was violated before is a fact.
    let mut violated = log(100.0, 0.65);
    violated.motions[0].resets = announced.motions[0].resets.clone();
    let (sentence, code) = said(&violated);
    assert!(code == 1 && sentence.starts_with("FAIL") && sentence.contains("position reset of 1.2 m"), "{sentence}");
    // And where nothing is left, nothing is judged.
    let mut first = log(100.0, 0.3);
    first.motions[0].resets = vec![Reset { t_s: 0.005, by_m: None }];
    let (sentence, code) = said(&first);
    assert!(code == 5 && sentence.contains("nothing is left to judge"), "{sentence}");
}

#[test]
fn gaps_and_spans_without_a_position_are_cut_out_and_told() {
    let mut gap = log(100.0, 0.3);
    gap.motions[0].samples.retain(|s| s.t_s <= 3.0 || s.t_s >= 3.5);
    let (sentence, code) = said(&gap);
    assert!(code == 5 && sentence.contains("gap of 0.5 s at t = 3.0 s not judged"), "{sentence}");
    gap.dropouts = vec![Span { from_s: 3.1, to_s: 3.4 }];
    assert!(said(&gap).0.contains("the logger dropped messages"));
    let mut reckoning = log(100.0, 0.3);
    reckoning.motions[0].invalid = vec![Span { from_s: 1.0, to_s: 2.0 }];
    let (sentence, code) = said(&reckoning);
    assert!(code == 5 && sentence.contains("INVALID") && sentence.contains("no valid position of 1.0 s"), "{sentence}");
    // What lies in them does not count: the worst moment was one.
    let mut worst = log(100.0, 0.65);
    worst.motions[0].invalid = vec![Span { from_s: 0.8, to_s: 3.2 }];
    assert_eq!(said(&worst).1, 5);
}

#[test]
fn many_gaps_are_counted_and_the_longest_is_told() {
    // Bursts of ten samples at 1 kHz, 20 ms apart, and half a second once.
    let mut bursts = log(1000.0, 0.3);
    bursts.motions[0].samples.retain(|s| (s.t_s * 1000.0).round() as u32 % 30 < 10 && !(3.01..3.5).contains(&s.t_s));
    let judged = judged_as(&bursts, |_, _| {}).unwrap();
    let (sentence, found) = (&judged.verdict.sentence, judged.found.as_ref().unwrap());
    assert!(judged.verdict.exit_code == 5 && found.cuts.len() > 200 && sentence.len() < 300, "{sentence}");
    let count =
        format!("INVALID m (flown, log_24.ulg, EKF2 estimate without accuracy): {} parts of ", found.cuts.len());
    let longest = " in all not judged, the longest: gap of 0.5 s at t = 3.0 s not judged";
    assert!(sentence.starts_with(&count) && sentence.contains(longest), "{sentence}");
    assert_eq!(found.cuts[0].in_words(), "gap of 21 ms at t = 0.009 s not judged");
    assert_eq!(found.lines().iter().filter(|[label, _]| label == "cut out").count(), 1);
}

#[test]
fn a_log_that_does_not_know_its_place_decides_nothing() {
    let with = |off: f64, accuracy: [f64; 2]| {
        let mut log = log(100.0, off);
        log.motions[0].samples.iter_mut().for_each(|s| s.accuracy_m = Some(accuracy));
        log
    };
    let (sentence, code) = said(&with(0.65, [0.9, 0.1]));
    let words = "INCONCLUSIVE m (flown, log_24.ulg, EKF2 estimate): 0.65 m > 0.50 m, but the log's own eph is 0.9 m; \
                 judge motion capture or raise the limit";
    assert_eq!((sentence.as_str(), code), (words, 5));
    let (sentence, code) = said(&with(0.45, [0.1, 0.0]));
    assert!(
        code == 5 && sentence.contains("0.45 m ≤ 0.50 m, but the log's own eph is 0.1 m, so that it may be more"),
        "{sentence}"
    );
    // Sideways it is off, so that only what it knows sideways counts.
    assert_eq!(said(&with(0.65, [0.1, 3.0])).1, 1);
    assert_eq!(said(&with(0.30, [0.05, 0.05])).1, 0);
    // Motion capture goes before it.
    let mut both = with(0.65, [0.9, 0.1]);
    both.motions.push(LoggedMotion::of("vehicle_mocap_odometry", Source::MotionCapture, samples(100.0, 0.41)));
    let judged = judged_as(&both, |_, _| {}).unwrap();
    assert!(judged.verdict.sentence.contains("motion capture): 0.41 m ≤ 0.50 m"), "{}", judged.verdict.sentence);
    assert_eq!(judged.found.unwrap().source.others, ["vehicle_local_position"]);
    let asked = judged_as(&both, |settings, _| settings.source = Some("vehicle_local_position".into())).unwrap();
    assert!(asked.verdict.sentence.contains("EKF2 estimate): 0.65 m"), "{}", asked.verdict.sentence);
    let none = judged_as(&both, |settings, _| settings.source = Some("gps".into())).unwrap_err();
    assert!(none.contains("--source gps") && none.contains("vehicle_mocap_odometry"), "{none}");
    both.motions.push(LoggedMotion::of("vehicle_mocap_odometry", Source::MotionCapture, samples(100.0, 0.0)));
    let two = judged_as(&both, |settings, _| settings.source = Some("vehicle_mocap_odometry".into())).unwrap_err();
    assert!(two.contains("--source vehicle_mocap_odometry: the log has several channels of that topic"), "{two}");
}

#[test]
fn a_sample_that_tells_no_accuracy_counts_as_the_least_accurate() {
    let of = |off: f64| {
        let mut log = log(100.0, off);
        for (i, sample) in log.motions[0].samples.iter_mut().enumerate() {
            // Where it is farthest off it says nothing.
            sample.accuracy_m = (!(150..250).contains(&i)).then_some(if i == 700 { [0.2, 0.1] } else { [0.05, 0.3] });
        }
        judged_as(&log, |_, _| {}).unwrap()
    };
    let judged = of(0.41);
    let sentence = &judged.verdict.sentence;
    assert!(judged.verdict.exit_code == 5 && sentence.contains("the log's own eph is 0.2 m"), "{sentence}");
    let note =
        "100 of 801 samples tell no accuracy: they count as the least accurate that do, 0.20 m across and 0.30 m up";
    assert_eq!(judged.found.unwrap().notes, [note]);
    assert_eq!(of(0.2).verdict.exit_code, 0);
}

fn event(t_s: f64, kind: EventKind, words: &str) -> Event {
    Event { t_s, kind, words: words.into() }
}

#[test]
fn what_ends_the_mission_ends_judgement_and_is_told() {
    for (kind, words) in [
        (EventKind::MissionEnds, "nav_state AUTO_RTL"),
        (EventKind::Failsafe, "failsafe"),
        (EventKind::Geofence, "geofence_result: breached"),
    ] {
        let mut log = log(100.0, 0.3);
        log.events = vec![event(0.0, EventKind::MissionBegins, "nav_state AUTO_MISSION"), event(6.0, kind, words)];
        // What comes after is not judged.
        log.motions[0].samples.iter_mut().filter(|s| s.t_s > 6.0).for_each(|s| s.p_m.z += 0.6);
        let (sentence, code) = said(&log);
        let on = format!("{words} at t = 6.0 s, on leg 1→2 of 3 waypoints: what was left of the mission is not judged");
        assert!(code == 5 && sentence.starts_with("INCONCLUSIVE") && sentence.contains(&on), "{sentence}");
    }
    // Landing after the last waypoint is as it should be; standing before take-off is no landing.
    let mut landed = log(100.0, 0.3);
    landed.events = vec![
        event(0.0, EventKind::MissionBegins, "nav_state AUTO_MISSION"),
        event(0.0, EventKind::Landed, "landed"),
        event(0.0, EventKind::TookOff, "took off"),
        event(8.0, EventKind::MissionEnds, "nav_state AUTO_LAND"),
    ];
    let judged = judged_as(&landed, |_, _| {}).unwrap();
    assert_eq!(judged.verdict.exit_code, 0, "{}", judged.verdict.sentence);
    assert_eq!(judged.found.unwrap().ended.unwrap(), "nav_state AUTO_LAND at t = 8.0 s");
    // A log that merely stops short was not finished either; by name a part is judged.
    let short = judged_as(&log(100.0, 0.3), |settings, _| settings.to_s = Some(6.0)).unwrap().verdict;
    assert!(short.exit_code == 5 && short.sentence.contains("--to at t = 6.0 s, on leg 1→2"), "{}", short.sentence);
}

#[test]
fn a_log_that_lies_elsewhere_is_refused_and_moved_by_name_only() {
    let moved = |turn_deg: f64, by: Vector3<f64>| {
        let mut log = log(100.0, 0.3);
        let turn = Rotation3::from_axis_angle(&Vector3::z_axis(), turn_deg.to_radians());
        log.motions[0].samples.iter_mut().for_each(|s| s.p_m = turn * s.p_m + by);
        log
    };
    for (turn, by) in [(0.0, Vector3::new(3.0, -2.0, 0.5)), (73.5, Vector3::zeros())] {
        let refused = judged_as(&moved(turn, by), |_, _| {}).unwrap_err();
        for words in [
            "does not begin where its mission does",
            "m from waypoint 0 of m, (4.00, 4.00, 5.00) m",
            "--offset",
            "--turn",
        ] {
            assert!(refused.contains(words), "{words}: {refused}");
        }
    }
    let far = judged_as(&moved(0.0, Vector3::new(3.0, -2.0, 0.5)), |_, _| {}).unwrap_err();
    assert!(far.contains("3.64 m") && far.contains("--offset -3.00,2.00,-0.50"), "{far}");
    let named =
        judged_as(&moved(0.0, Vector3::new(3.0, -2.0, 0.5)), |s, _| s.frame.offset_m = [-3.0, 2.0, -0.5]).unwrap();
    assert_eq!(named.verdict.exit_code, 0, "{}", named.verdict.sentence);
    assert_eq!(named.found.unwrap().frame.named().unwrap(), "moved by (-3, 2, -0.5) m (--offset)");
    assert_eq!(
        judged_as(&moved(73.5, Vector3::zeros()), |s, _| s.frame.turn_deg = -73.5).unwrap().verdict.exit_code,
        0
    );
    // Half a metre within the acceptance is not taken off either: it is deviation.
    let near = judged_as(&moved(0.0, Vector3::new(0.0, 0.6, 0.0)), |_, _| {}).unwrap();
    assert_eq!(near.verdict.exit_code, 1, "{}", near.verdict.sentence);
}

#[test]
fn a_log_of_another_place_on_earth_is_refused() {
    let world = |settings: &mut LogSettings, _: &Path| settings.world = Some("cage-30m".into());
    let at = |lat_deg: f64, lon_deg: f64| {
        let origin = Geodetic { lat_deg, lon_deg, alt_amsl_m: 180.0 };
        judged_as(&Logged { frame: LogFrame::Enu(Some(origin)), ..log(100.0, 0.3) }, world)
    };
    let told = at(-78.5079772, 38.0335530).unwrap_err();
    assert!(
        told.contains("it was flown elsewhere on Earth: 1") && told.contains(" km from the world's origin"),
        "{told}"
    );
    assert!(told.contains(", 20 at most; latitude and longitude may be exchanged"), "{told}");
    // What jumps there is a jump, and what is within the bound is judged.
    let mut jumps = log(100.0, 0.3);
    jumps.frame = LogFrame::Enu(Some(Geodetic { lat_deg: 38.0335530, lon_deg: -78.5079772, alt_amsl_m: 180.0 }));
    jumps.motions[0].samples.last_mut().unwrap().p_m.x = 3e6;
    let told = judged_as(&jumps, world).map(|judged| judged.verdict.sentence).unwrap_or_else(|why| why);
    assert!(!told.contains("elsewhere on Earth"), "{told}");
}

#[test]
fn a_log_that_is_near_no_case_is_asked_for_none() {
    let case = |number: usize, off: f64| {
        Case::bare(CaseNumber(number), 1, corners().map(|p| p + Vector3::new(0.0, off, 0.0)).to_vec())
    };
    let cases = [case(0, 0.0), case(1, 60.0)];
    let found = |scale: f64, by: f64| {
        let mut log = log(10.0, 0.0);
        let moved = |p: Point3<f64>| Point3::from(p.coords * scale + Vector3::z() * by);
        log.motions[0].samples.iter_mut().for_each(|sample| sample.p_m = moved(sample.p_m));
        let found = matched(&cases, &log.motions[0].samples, (&log, &[], 1.0), (&|_| Ok(None), &Asks::JUDGE));
        found.map(|(case, _)| case.id()).map_err(|why| why.to_string())
    };
    assert_eq!(found(1.0, 0.0).as_deref(), Ok("0000"));
    for (scale, by, far) in [(1e3, 0.0, " km away in the mean"), (1.0, 47.0, "is 47.0 m away in the mean")] {
        let told = found(scale, by).unwrap_err();
        assert!(told.contains("flew none of the 2 cases: the nearest, 000") && told.contains(far), "{told}");
        assert!(told.contains("no more than 28.3 m across") && told.contains("mm for m"), "{told}");
        assert!(!told.contains("too near each other") && told.ends_with("--case ID says which"), "{told}");
    }
    // Who is beside one is matched to it, to be judged.
    assert_eq!(found(1.0, 8.0).as_deref(), Ok("0000"));
}

/// Two cases through the same corners, one of which is planned round: from straight legs nobody could tell them apart.
#[test]
fn a_log_is_matched_by_what_it_is_judged_from() {
    let plan = |off: f64| {
        let (times, poses) = samples(10.0, off)
            .iter()
            .map(|s| (s.t_s, nalgebra::Isometry3::translation(s.p_m.x, s.p_m.y, s.p_m.z)))
            .unzip();
        hairpin::trajectory::Track::new(times, poses, Vec::new()).unwrap()
    };
    let cases = [0, 1].map(|number| Case::bare(CaseNumber(number), 1, corners().to_vec()));
    let planned = |case: &Case| -> Result<Option<hairpin::trajectory::Track>, Problem> {
        Ok(Some(plan(if case.number.0 == 0 { 4.0 } else { -4.0 })))
    };
    for (off, wanted) in [(4.0, "0000"), (-3.9, "0001")] {
        let log = log(10.0, off);
        let of = (&log, &[][..], 1.0);
        let found = matched(&cases, &log.motions[0].samples, of, (&planned, &Asks::JUDGE)).unwrap();
        assert!(found.0.id() == wanted && found.1.mean_m < 0.1, "{off}: {:?}", found.1);
        let legs = matched(&cases, &log.motions[0].samples, of, (&|_| Ok(None), &Asks::JUDGE));
        assert!(legs.unwrap_err().to_string().contains("come too near each other to tell"));
    }
}

/// Axes of a cage whose x points to 73.5° in east and north, by the compass: nothing of our conversions is used.
#[test]
fn logs_with_a_place_on_earth_come_into_the_world_by_its_origin() {
    let (lat, lon, alt): (f64, f64, f64) = (38.0335530, -78.5079772, 180.0);
    let heading = 73.5_f64.to_radians();
    let (x, y) = (Vector3::new(heading.sin(), heading.cos(), 0.0), Vector3::new(-heading.cos(), heading.sin(), 0.0));
    // The log's origin is 12 m north and 7 m east of the cage's corner and 0.7 m higher: metres a degree at this
    // latitude.
    let phi = lat.to_radians();
    let north = 111_132.92 - 559.82 * (2.0 * phi).cos() + 1.175 * (4.0 * phi).cos();
    let east = 111_412.84 * phi.cos() - 93.5 * (3.0 * phi).cos();
    let origin = Geodetic { lat_deg: lat + 12.0 / north, lon_deg: lon + 7.0 / east, alt_amsl_m: alt + 0.7 };
    let mut log = log(100.0, 0.3);
    log.frame = LogFrame::Enu(Some(origin));
    log.motions[0].samples.iter_mut().for_each(|s| {
        let enu = x * s.p_m.x + y * s.p_m.y + Vector3::z() * s.p_m.z;
        s.p_m = Point3::from(enu - Vector3::new(7.0, 12.0, 0.0));
        s.v_m_s = None;
    });
    let world = |settings: &mut LogSettings, _: &Path| settings.world = Some("cage-30m".into());
    let judged = judged_as(&log, world).unwrap();
    let found = judged.found.unwrap();
    assert!(found.frame.by_earth && !found.frame.altitude_applied);
    assert!((found.frame.altitude_difference_m.unwrap() - 0.7).abs() < 1e-3);
    let worst = found.flown.unwrap().measures.max_deviation;
    assert!((worst - 0.3).abs() < 2e-3 && judged.verdict.exit_code == 0, "{worst} {}", judged.verdict.sentence);
    // From 2.4 km away the Earth falls by half a metre: altitudes are what they were.
    let far = Geodetic { lat_deg: origin.lat_deg + 2400.0 / north, alt_amsl_m: alt, ..origin };
    let of = |about: &Geodetic| {
        let Geodetic { lat_deg, lon_deg, alt_amsl_m } = *about;
        Placement::by_origin(&Origin { lat_deg, lon_deg, alt_amsl_m, x_axis_heading_deg: 90.0 })
    };
    let level = Geodetic { alt_amsl_m: alt, ..origin };
    let mut from_afar = log.clone();
    from_afar.frame = LogFrame::Enu(Some(far));
    from_afar.motions[0].samples.iter_mut().for_each(|s| {
        s.p_m = of(&far).from_geodetic(&of(&level).geodetic(&s.p_m).unwrap()).unwrap();
    });
    let found = judged_as(&from_afar, world).unwrap().found.unwrap();
    assert!(found.frame.altitude_difference_m.unwrap().abs() < 1e-9, "{:?}", found.frame);
    let worst = found.flown.unwrap().measures.max_deviation;
    assert!((worst - 0.3).abs() < 5e-3, "{worst}");
    // By name the altitude counts, and with it the log is 0.7 m too high.
    let amsl = judged_as(&log, |settings, here| {
        world(settings, here);
        settings.frame.altitude = Altitude::Amsl;
    });
    let amsl = amsl.unwrap();
    let worst = amsl.found.unwrap().flown.unwrap().measures.max_deviation;
    assert!(amsl.verdict.exit_code == 1 && (worst - (0.49_f64 + 0.09).sqrt()).abs() < 2e-3, "{worst}");
}

#[test]
fn legs_are_the_missions_own_where_it_tells_them() {
    let step = |t_s: f64, item: u32, target: Option<Point3<f64>>| Progress { t_s, item, of: None, target_m: target };
    // Take-off, a speed item, three waypoints, landing.
    let up = Point3::new(4.0, 4.0, 2.0);
    let [a, b, c] = corners().map(Some);
    let mut log = log(100.0, 0.3);
    log.progress =
        vec![step(-9.0, 0, Some(up)), step(-5.0, 2, a), step(0.0, 3, b), step(3.9, 4, c), step(7.9, 5, Some(up))];
    let found = judged_as(&log, |_, _| {}).unwrap().found.unwrap();
    assert_eq!((found.legs_by, found.finished), (LegsBy::Targets, true));
    assert!(found.span_s.unwrap()[1] < 7.9, "{:?}", found.span_s);
    // A leg that begins too late is deviation, which no nearest leg would show.
    log.progress[3].t_s = 4.5;
    let verdict = judged_as(&log, |_, _| {}).unwrap().verdict;
    assert!(
        verdict.exit_code == 1 && verdict.sentence.contains("2.45 m > 0.50 m, t = 4.49 s, leg 0→1"),
        "{}",
        verdict.sentence
    );
    // Without targets they are counted: take-off and landing beside the waypoints.
    let counted = |items: [u32; 5], total: u32| {
        let step = |(item, t_s)| Progress { t_s, item, of: Some(total), target_m: None };
        items.into_iter().zip([-9.0, -5.0, 0.0, 3.9, 7.9]).map(step).collect::<Vec<_>>()
    };
    log.progress = counted([0, 1, 2, 3, 4], 5);
    let whole = judged_as(&log, |_, _| {}).unwrap().found.unwrap();
    assert_eq!((whole.legs_by, whole.finished), (LegsBy::Count, true));
    let most = |found: &Found| found.flown.as_ref().unwrap().measures.max_deviation;
    // A change of speed between two of them is none of the places.
    log.progress = counted([0, 1, 3, 4, 5], 6);
    assert_eq!(judged_as(&log, |_, _| {}).unwrap().found.unwrap().legs_by, LegsBy::Count);
    // Nor are two, although there are as many items as waypoints with a take-off and a landing.
    log.progress =
        [(0, -5.0), (2, 0.0), (4, 3.9)].map(|(item, t_s)| Progress { t_s, item, of: Some(5), target_m: None }).to_vec();
    let found = judged_as(&log, |_, _| {}).unwrap().found.unwrap();
    assert_eq!((found.legs_by, found.finished), (LegsBy::Count, true));
    // It is what was uploaded that counts: a log may begin on the way to a waypoint, or end there.
    log.progress = counted([0, 1, 2, 3, 4], 5).split_off(2);
    let late = judged_as(&log, |_, _| {}).unwrap().found.unwrap();
    assert_eq!((late.legs_by, late.finished), (LegsBy::Count, true));
    assert_eq!(most(&late), most(&whole));
    for (items, total) in [([0, 1, 2, 3, 4], 9), ([1, 2, 3, 4, 5], 7), ([0, 1, 2, 4, 3], 5)] {
        log.progress = counted(items, total);
        assert_eq!(judged_as(&log, |_, _| {}).unwrap().found.unwrap().legs_by, LegsBy::Assigned, "{items:?}");
    }
    log.progress = vec![step(-5.0, 0, None), step(0.0, 1, None), step(3.9, 2, None)];
    let untold = judged_as(&log, |_, _| {}).unwrap().found.unwrap();
    assert_eq!(untold.legs_by, LegsBy::Assigned, "nothing says how many there are");
    // Nor do places, where one of the waypoints comes first that is not the first.
    log.progress = vec![step(-5.0, 3, b), step(0.0, 4, a), step(3.9, 5, b), step(7.9, 6, c)];
    assert_eq!(judged_as(&log, |_, _| {}).unwrap().found.unwrap().legs_by, LegsBy::Assigned);
    // A mission over other waypoints tells nothing of these.
    log.progress = vec![step(0.0, 1, a), step(4.0, 2, Some(up))];
    let found = judged_as(&log, |_, _| {}).unwrap().found.unwrap();
    assert_eq!(found.legs_by, LegsBy::Assigned);
    assert!(found.notes.iter().any(|note| note.contains("not the waypoints")));
}

#[test]
fn obstacles_need_not_have_been_there() {
    let judge = |off: f64, rate: f64| {
        judged_as(&log(rate, off), |settings, here| {
            let world = here.join("w.toml");
            // 0.6 m beside the middle of the first leg.
            let ball = "[[obstacles]]\nname = \"ball\"\nsphere = { center_m = [14, 6, 5], radius_m = 1.4 }\n";
            fs::write(&world, format!("size_m = [30, 30, 30]\n{ball}")).unwrap();
            settings.world = Some(world.to_string_lossy().into_owned());
            settings.sets = vec![("spec.clearance.min_m".into(), "0.05".into())];
        })
        .unwrap()
    };
    let radius =
        |judged: &JudgedLog| judged.found.as_ref().unwrap().flown.as_ref().unwrap().measures.min_clearance.unwrap();
    let straight = judge(0.0, 100.0);
    let hit = judge(0.5, 100.0);
    assert!((radius(&straight) - radius(&hit) - 0.5).abs() < 1e-6);
    assert!(hit.verdict.exit_code == 1 && hit.verdict.sentence.contains("clearance"), "{}", hit.verdict.sentence);
    assert_eq!(
        straight.verdict.exit_code,
        if radius(&straight) > 0.06 { 0 } else { 1 },
        "{}",
        straight.verdict.sentence
    );
}

/// What no limit asks for counts as in simulation: an obstacle is in the way whatever is judged.
#[test]
fn what_is_in_an_obstacle_has_met_it() {
    let judge = |rate: f64, off: f64, accuracy_m: Option<[f64; 2]>| {
        let mut log = log(rate, off);
        log.motions[0].samples.iter_mut().for_each(|sample| sample.accuracy_m = accuracy_m);
        let judged = judged_as(&log, |settings, here| {
            let world = here.join("w.toml");
            let ball = "[[obstacles]]\nname = \"ball\"\nsphere = { center_m = [14, 6, 5], radius_m = 0.5 }\n";
            fs::write(&world, format!("size_m = [30, 30, 30]\n{ball}")).unwrap();
            settings.world = Some(world.to_string_lossy().into_owned());
            settings.sets = vec![("spec.deviation.max_m".into(), "5".into())];
        });
        let verdict = judged.unwrap().verdict;
        (verdict.sentence, verdict.exit_code)
    };
    for off in [0.0, 1.0] {
        let (sentence, code) = judge(100.0, off, None);
        assert_eq!(code, 0, "{sentence}");
    }
    let (sentence, code) = judge(100.0, 1.8, None);
    assert!(code == 1 && sentence.contains("): met an obstacle: clearance -0."), "{sentence}");
    // Between two samples, and within what the log knows of its place, it may have.
    let (sentence, code) = judge(2.0, 1.0, None);
    assert!(code == 5 && sentence.contains("it may have met an obstacle: clearance "), "{sentence}");
    for off in [1.0, 1.8] {
        let (sentence, code) = judge(100.0, off, Some([1.0, 1.0]));
        assert!(code == 5 && sentence.contains("it may have met an obstacle: clearance "), "{sentence}");
        assert!(sentence.contains("but the log's own eph is 1.0 m") && !sentence.contains("the limit"), "{sentence}");
    }
}

#[test]
fn an_acceleration_in_long_means_is_open() {
    let judge = |rate: f64| {
        let sets = vec![("spec.acceleration.max_m_s2".into(), "1000".into())];
        let verdict = judged_as(&log(rate, 0.0), |settings, _| settings.sets = sets).unwrap().verdict;
        (verdict.sentence, verdict.exit_code)
    };
    let (sentence, code) = judge(1.0);
    assert_eq!(code, 5, "{sentence}");
    let words = "in samples at 1 Hz, but as a mean over as much as 2.00 s, and what is shorter was not seen";
    assert!(sentence.contains(words) && sentence.contains("log at 4 Hz or faster"), "{sentence}");
    let (sentence, code) = judge(10.0);
    assert_eq!(code, 0, "{sentence}");
}

#[test]
fn a_mission_needs_a_robot_and_a_limit() {
    let none =
        |change: &dyn Fn(&mut LogSettings)| judged_as(&log(100.0, 0.3), |settings, _| change(settings)).unwrap_err();
    let robot = none(&|s| {
        let Against::Mission { robot, .. } = &mut s.against else { unreachable!() };
        *robot = None;
    });
    assert!(robot.contains("--robot R") && robot.contains("--world W"), "{robot}");
    let limit = none(&|s| s.sets.clear());
    assert!(limit.contains("spec"), "{limit}");
    let other = none(&|s| s.sets = vec![("task.length".into(), "4".into())]);
    assert!(other.contains("only spec can be set"), "{other}");
    let unjudged =
        judged_as(&log(100.0, 0.65), |s, _| s.sets = vec![("spec".into(), "\"none\"".into())]).unwrap().verdict;
    assert!(unjudged.exit_code == 0 && unjudged.sentence.starts_with("UNJUDGED m"), "{}", unjudged.sentence);
}

#[test]
fn a_folder_with_a_broken_log_judges_the_others() {
    let here = TempDir::new().unwrap();
    let logs = here.path().join("logs");
    fs::create_dir(&logs).unwrap();
    let rows: Vec<String> = samples(100.0, 0.3)
        .iter()
        .map(|s| format!("{} {} {} {} 0 0 0 1\n", s.t_s, s.p_m.x, s.p_m.y, s.p_m.z))
        .collect();
    fs::write(logs.join("a.tum"), rows.concat()).unwrap();
    fs::write(logs.join("b.tum"), "0 1 2 three 0 0 0 1\n").unwrap();
    fs::write(logs.join("notes.md"), "no log").unwrap();
    for name in ["0000.planned.csv", "0000.ref.tum"] {
        fs::write(logs.join(name), rows.concat()).unwrap();
    }
    let mut settings = LogSettings { path: logs, ..settings(here.path(), HALF) };
    let judged = judge_log(&settings, &crate::Unwatched).unwrap();
    assert_eq!(judged.logs.iter().map(|log| log.outcome).collect::<Vec<_>>(), [Outcome::Pass, Outcome::Invalid]);
    let count = judged.count.as_ref().unwrap();
    assert!(
        count.sentence.starts_with("INCONCLUSIVE 0/2 (flown, logs, 2 logs): 1 within spec, 1 invalid"),
        "{}",
        count.sentence
    );
    let planned = "; left out, by their names planned: 0000.planned.csv, 0000.ref.tum";
    assert!(count.sentence.ends_with(planned) && judged.left_out.len() == 2, "{}", count.sentence);
    assert_eq!(judged.exit_code(), 5);
    let broken = &judged.logs[1].verdict.sentence;
    assert!(broken.contains("b.tum") && broken.contains("line 1"), "{broken}");
    // Alone it is wrong input, and a plan is judged where it is named, and then called one.
    let alone = |name: &str, source: Option<&str>| {
        let (path, source) = (settings.path.join(name), source.map(str::to_owned));
        judge_log(&LogSettings { path, source, ..settings.clone() }, &crate::Unwatched)
    };
    let refused = alone("0000.ref.tum", None).unwrap_err().to_string();
    assert!(refused.contains("nothing in it is known to have moved: 0000.ref.tum"), "{refused}");
    let named = alone("0000.ref.tum", Some("0000.ref.tum")).unwrap().logs.remove(0).verdict.sentence;
    assert!(named.contains("by its name a plan"), "{named}");
    settings.path.push("b.tum");
    assert!(matches!(judge_log(&settings, &crate::Unwatched), Err(Problem::Input(_))));
}

#[test]
fn logs_that_are_one_recording_are_told() {
    let here = TempDir::new().unwrap();
    let logs = here.path().join("logs");
    fs::create_dir_all(logs.join("more")).unwrap();
    let rows = |off: f64| -> String {
        let row = |s: &Sample| format!("{} {} {} {} 0 0 0 1\n", s.t_s, s.p_m.x, s.p_m.y, s.p_m.z);
        samples(100.0, off).iter().map(row).collect()
    };
    for (name, off) in [("a.tum", 0.3), ("b.tum", 0.2), ("more/a.tum", 0.3)] {
        fs::write(logs.join(name), rows(off)).unwrap();
    }
    // What cannot be read is no recording.
    for name in ["c.tum", "d.tum"] {
        fs::write(logs.join(name), "0 1 2 three 0 0 0 1\n").unwrap();
    }
    let judged = judge_log(&LogSettings { path: logs.clone(), ..settings(here.path(), HALF) }, &crate::Unwatched);
    let judged = judged.unwrap();
    assert_eq!(judged.copies, [[logs.join("a.tum"), logs.join("more/a.tum")]]);
    let told = "3 within spec, 2 invalid; one recording under several names, which are no repeats: a.tum = more/a.tum";
    let count = judged.count.unwrap().sentence;
    assert!(count.ends_with(told), "{count}");
}

#[cfg(unix)]
#[test]
fn a_link_that_leads_nowhere_is_a_log_that_was_not_judged() {
    let here = TempDir::new().unwrap();
    let logs = here.path().join("logs");
    fs::create_dir(&logs).unwrap();
    let row = |s: &Sample| format!("{} {} {} {} 0 0 0 1\n", s.t_s, s.p_m.x, s.p_m.y, s.p_m.z);
    fs::write(logs.join("a.tum"), samples(100.0, 0.3).iter().map(row).collect::<String>()).unwrap();
    std::os::unix::fs::symlink("gone.ulg", logs.join("b.ulg")).unwrap();
    let judged = judge_log(&LogSettings { path: logs, ..settings(here.path(), HALF) }, &crate::Unwatched).unwrap();
    assert_eq!(judged.logs.iter().map(|log| log.outcome).collect::<Vec<_>>(), [Outcome::Pass, Outcome::Invalid]);
    assert_eq!(judged.exit_code(), 5);
}

#[test]
fn heights_above_the_sea_need_places_on_earth() {
    let amsl = |settings: &mut LogSettings| settings.frame.altitude = Altitude::Amsl;
    let refused = judged_as(&log(100.0, 0.3), |settings, _| amsl(settings)).unwrap_err();
    assert!(refused.contains("--altitude amsl: the log does not say where on Earth it is"), "{refused}");
    let mut placed = log(100.0, 0.3);
    placed.frame = LogFrame::Enu(Some(Geodetic { lat_deg: 38.0335530, lon_deg: -78.5079772, alt_amsl_m: 180.0 }));
    let refused = judged_as(&placed, |settings, _| amsl(settings)).unwrap_err();
    assert!(refused.contains("the world does not say where on Earth it is (world.origin)"), "{refused}");
}

#[test]
fn numbers_that_no_log_has_are_refused_and_told_shortly() {
    let here = TempDir::new().unwrap();
    let refused = |change: fn(&mut LogSettings)| {
        let mut settings = settings(here.path(), HALF);
        change(&mut settings);
        judge_log(&settings, &crate::Unwatched).unwrap_err().to_string()
    };
    assert_eq!(refused(|s| s.frame.offset_m[1] = -1e300), "--offset -1e300: must be within 1e7 m either way");
    assert_eq!(refused(|s| s.from_s = Some(1e300)), "--from 1e300: must be within 1e12 s either way");
    assert_eq!(refused(|s| s.frame.turn_deg = 1e20), "--turn 1e20: must be within 1e6 ° either way");
}

#[test]
fn a_limit_between_told_legs_and_assigned_ones_is_told() {
    let told = |pair: [Option<f64>; 2], limit: f64| super::told::told_otherwise(pair, Some(limit));
    let words = told([Some(0.8), Some(1.67)], 1.0).unwrap();
    assert!(words.contains("0.80 m off") && words.contains("told 1.67 m") && words.contains("1.00 m lies between"));
    assert_eq!(told([Some(0.8), Some(1.67)], 0.7), None);
    assert_eq!(told([Some(0.8), Some(1.67)], 2.0), None);
    assert_eq!(told([None, Some(1.67)], 1.0), None);
}

#[test]
fn a_gap_of_nothing_has_no_sign_of_less() {
    let told = |gap: f64| format!("{:+.2}", super::told::hundredths(gap));
    assert_eq!([-0.004, 0.004, -0.006, 1.234].map(told), ["+0.00", "+0.00", "-0.01", "+1.23"]);
}
