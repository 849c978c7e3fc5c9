//! ArduPilot's DataFlash logs.

use nalgebra::{Point3, Vector3};
use proptest::prelude::*;

use super::write_dataflash::{Bin, flight};
use super::*;

fn parsed(bytes: &[u8]) -> Logged {
    parse(bytes, "a.bin").unwrap()
}

#[test]
fn a_flight_is_read_in_east_north_up() {
    let log = parsed(&flight());
    assert_eq!((log.format, log.clock), ("ArduPilot DataFlash", Clock::SinceBoot));
    assert!(matches!(log.frame, LogFrame::Enu(Some(place)) if (place.lat_deg - 47.3977).abs() < 1e-9));
    let [position, filter] = &log.motions[..] else { panic!("{}", log.motions.len()) };
    assert_eq!((&position.name[..], &filter.name[..]), ("POS", "XKF1[0]"));
    assert_eq!((position.source, position.samples.len(), filter.samples.len()), (Source::Estimate, 100, 100));
    let last = position.samples[99];
    assert!((last.t_s - 11.98).abs() < 1e-9);
    // Degrees of 10⁻⁷ are 8 mm from east to west.
    assert!((last.p_m - Point3::new(3.96, 0.0, 1.98)).norm() < 6e-3, "{}", last.p_m);
    let (sin, cos) = 30_f64.to_radians().sin_cos();
    for turn in [last.attitude, filter.samples[99].attitude] {
        assert!((turn.unwrap() * Vector3::x() - Vector3::new(0.0, cos, sin)).norm() < 1e-9);
        assert!((turn.unwrap() * Vector3::z() - Vector3::new(0.0, -sin, cos)).norm() < 1e-9);
    }
    let last = filter.samples[99];
    assert_eq!(last.v_m_s, Some(Vector3::new(2.0, 0.0, 1.0)));
    // ArduPilot's 3.96 m east are degrees over 111 318.845 cos φ, which are 75 495.6 m on the ground.
    let east = 3.96 / (111_318.845 * 47.3977_f64.to_radians().cos()) * 75_495.57;
    assert!((last.p_m - Point3::new(east, 0.5, 1.98)).norm() < 4e-3, "{} {east}", last.p_m);
    let event = |t_s, kind, words: &str| Event { t_s, kind, words: words.into() };
    let events = [
        event(10.1, EventKind::TookOff, "EV not landed"),
        event(10.1, EventKind::MissionBegins, "MODE AUTO"),
        event(11.6, EventKind::Geofence, "ERR subsystem 9, code 1"),
        event(11.6, EventKind::MissionEnds, "MODE RTL"),
        event(12.0, EventKind::Landed, "EV land complete"),
    ];
    assert_eq!(log.events, events);
    let [first, second] = &log.progress[..] else { panic!("{:?}", log.progress) };
    assert_eq!((first.item, first.t_s, second.item, second.t_s), (1, 10.1, 2, 11.0));
    assert!((first.target_m.unwrap() - Point3::new(2e-4 * 75_495.57, 0.0, 12.0)).norm() < 0.01, "{first:?}");
    assert!(log.notes.is_empty(), "{:?}", log.notes);
}

#[test]
fn modes_are_those_of_the_vehicle_and_of_none_nobody_knows_are_missions() {
    let of = |vehicle: &str| {
        let mut log = flight();
        let at = log.windows(10).position(|bytes| bytes == b"ArduCopter").unwrap();
        log[at..at + 10].copy_from_slice(format!("{vehicle:10}").as_bytes());
        let log = parsed(&log);
        let of_modes = log.events.iter().filter(|event| event.words.starts_with("MODE"));
        (of_modes.map(|event| (event.kind, event.words.clone())).collect::<Vec<_>>(), log.notes)
    };
    let flown = |mode: &str| {
        vec![(EventKind::MissionBegins, "MODE AUTO".to_owned()), (EventKind::MissionEnds, mode.to_owned())]
    };
    let other =
        |modes: &[&str]| modes.iter().map(|mode| (EventKind::OtherMode, (*mode).to_owned())).collect::<Vec<_>>();
    assert_eq!(of("ArduSub"), (flown("MODE 6"), vec![]));
    assert_eq!(of("ArduPlane"), (other(&["MODE FBWA", "MODE 3", "MODE FBWB"]), vec![]));
    let unknown = vec!["modes are not read: no message says which vehicle's they are".to_owned()];
    assert_eq!(of("Blimp"), (other(&["MODE 5"]), unknown));
}

#[test]
fn what_is_cut_or_spoiled_is_told_by_its_byte() {
    let whole = flight();
    let cut = whole.len() - 12 - 20;
    let log = parsed(&whole[..cut]);
    assert!(log.notes[0].ends_with("the log ends within a message; read as far as that"), "{:?}", log.notes);
    let mut spoiled = whole.clone();
    let at = whole.len() - 12 - 46;
    spoiled[at] = 0;
    let told = format!("byte {at}: no message; read on at byte {}", whole.len() - 12);
    assert_eq!(parsed(&spoiled).notes, [told]);
    let mut log = Bin::new();
    log.describe(3, 23, "POS", "QLLf", "TimeUS,Lat,Lng,Alt");
    log.describe(10, 44, "FMTU", "QBNN", "TimeUS,FmtType,UnitIds,MultIds");
    log.message(10, &[&[0; 8], &[3], b"sDUf\0\0\0\0\0\0\0\0\0\0\0\0", b"FGG0\0\0\0\0\0\0\0\0\0\0\0\0"]);
    log.message(3, &[&[1; 20]]);
    let told = refusal(&log.0, "a.bin");
    assert!(
        told.contains("without any motion (POS: `Alt` has the unit `f` and the multiplier `0`: not read)"),
        "{told}"
    );
}

/// A log of `POS` at latitudes, degrees by 10⁻⁷ behind the point, and stamps.
fn positions(rows: &[(u64, i32)]) -> Logged {
    let mut log = Bin::new();
    log.describe(3, 23, "POS", "QLLf", "TimeUS,Lat,Lng,Alt");
    for (t, lat) in rows {
        let place = [473_977_000 + lat, 85_456_000].map(i32::to_le_bytes).concat();
        log.message(3, &[&t.to_le_bytes(), &place, &488_f32.to_le_bytes()]);
    }
    parsed(&log.0)
}

/// Degrees of 10⁻⁷ are 1.1 cm, which metres made of them no longer show.
#[test]
fn degrees_tell_places_in_steps() {
    let log = positions(&[(100_000, 0), (200_000, 50), (300_000, 100)]);
    let Some(ToldTo::Steps([north, east, up])) = log.motions[0].told_to else { panic!("{:?}", log.motions[0].told_to) };
    assert!((north - 0.011_13).abs() < 1e-5 && (east - 0.011_13 * 47.3977_f64.to_radians().cos()).abs() < 1e-5);
    assert_eq!(up, 0.0);
}

#[test]
fn what_is_at_two_places_with_one_stamp_is_not_fit_to_be_judged() {
    let again = positions(&[(100_000, 0), (200_000, 50), (200_000, 51), (100_000, 0), (300_000, 100)]);
    assert_eq!((again.motions[0].samples.len(), &again.motions[0].unfit), (3, &None));
    let other = positions(&[(100_000, 0), (200_000, 50), (300_000, 100), (200_000, 350)]);
    let why = "two places with the stamp 0.2 s, 47.3977050°, 8.5456000°, 488.00 m and 47.3977350°, 8.5456000°, 488.00 m: \
               nobody knows which is true";
    assert_eq!(other.motions[0].unfit.as_deref(), Some(why));
    assert!(other.notes.contains(&format!("POS: {why}")), "{:?}", other.notes);
    // One that was overtaken, and a clock that was set back.
    let still: Vec<(u64, i32)> = (1..50).map(|step| (100_000 * step, 0)).collect();
    assert_eq!(positions(&[&still[..], &[(4_750_000, 1)]].concat()).motions[0].unfit, None);
    let set_back = positions(&[&still[..], &[(2_750_000, 0)]].concat());
    let why = "stamps go back from 4.9 s to 2.75 s: nobody knows what was when";
    assert_eq!(set_back.motions[0].unfit.as_deref(), Some(why));
}

/// Ten positions of each of `cores`, a metre east of each other a core, and from when on (steps) which is the primary.
fn filters(cores: &[u8], primary: &[(u64, u8)]) -> Logged {
    let mut log = Bin::new();
    log.describe(2, 24, "ORGN", "QBLLf", "TimeUS,Type,Lat,Lng,Alt");
    log.describe(5, 24, "XKF1", "QBfff", "TimeUS,C,PN,PE,PD");
    log.describe(6, 13, "XKF4", "QBB", "TimeUS,C,PI");
    let place = [473_977_000, 85_456_000].map(i32::to_le_bytes).concat();
    log.message(2, &[&1_u64.to_le_bytes(), &[0], &place, &488_f32.to_le_bytes()]);
    for step in 0..10_u64 {
        let t = (100_000 * (step + 1)).to_le_bytes();
        for core in cores {
            let ned = [0.0, f32::from(*core), -1.0].map(f32::to_le_bytes).concat();
            log.message(5, &[&t, &[*core], &ned]);
            if let Some((_, primary)) = primary.iter().rfind(|(from, _)| *from <= step) {
                log.message(6, &[&t, &[*core], &[*primary]]);
            }
        }
    }
    parsed(&log.0)
}

#[test]
fn what_the_vehicle_flew_by_stands_before_other_cores() {
    let names = |log: &Logged| log.motions.iter().map(|motion| motion.name.clone()).collect::<Vec<_>>();
    assert_eq!(names(&filters(&[0, 1], &[(0, 0)])), ["XKF1[0]", "XKF1[1]"]);
    let second = filters(&[0, 1], &[(0, 1)]);
    assert_eq!(names(&second), ["XKF1[1]", "XKF1[0]"]);
    assert_eq!(second.notes, ["XKF1[1] is what the vehicle flew by (XKF4.PI)"]);
    // By turns: from the fifth position on the other one.
    let turns = filters(&[0, 1], &[(0, 1), (4, 0)]);
    assert_eq!(names(&turns), ["XKF1[primary]", "XKF1[0]", "XKF1[1]"]);
    let flown = &turns.motions[0];
    let east: Vec<f64> = flown.samples.iter().map(|sample| sample.p_m.x.round()).collect();
    assert_eq!(east, [1.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    assert_eq!(flown.resets, [Reset { t_s: 0.5, by_m: None }]);
    // One whose positions are not there, and no word at all.
    let gone = filters(&[0], &[(0, 1)]);
    let why = "the vehicle flew by core 1, whose positions are not in the log";
    assert_eq!(gone.motions[0].unfit.as_deref(), Some(why));
    let untold = filters(&[0, 1], &[]);
    assert!(untold.motions.iter().all(|motion| motion.source == Source::Untold), "{:?}", untold.notes);
    // The only one there is needs none.
    let only = filters(&[0], &[]);
    assert_eq!((only.motions[0].source, &only.motions[0].unfit), (Source::Estimate, &None));
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn flips_and_cuts_are_answers(place in 0_usize..40_000, bit in 0_u8..8, cut in 0_usize..40_000) {
        let mut bytes = flight();
        let (place, cut) = (place % bytes.len(), cut % bytes.len());
        bytes[place] ^= 1 << bit;
        drop(parse(&bytes, "a.bin"));
        drop(parse(&bytes[..cut], "a.bin"));
    }
}
