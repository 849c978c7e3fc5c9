//! PX4's ULog.

use nalgebra::{Point3, Vector3};
use proptest::prelude::*;

use super::write_ulog::{ATTITUDE, POSITION, Position, Ulog, attitude, flight, singles};
use super::*;
use crate::frames::Geodetic;

fn event(t_s: f64, kind: EventKind, words: &str) -> Event {
    Event { t_s, kind, words: words.into() }
}

fn parsed(bytes: &[u8]) -> Logged {
    parse(bytes, "a.ulg").unwrap()
}

fn fault(bytes: &[u8]) -> String {
    refusal(bytes, "a.ulg")
}

/// A log of positions alone.
fn positions(samples: &[Position]) -> Ulog {
    let mut log = Ulog::new();
    log.message(b'F', POSITION.as_bytes());
    log.subscribe(0, 0, "vehicle_local_position");
    for sample in samples {
        log.data(0, &[&sample.bytes()]);
    }
    log
}

fn at(t_us: u64, ned: [f32; 3]) -> Position {
    Position { t_us, ned, ..Position::STILL }
}

#[test]
fn a_flight_is_read_in_east_north_up() {
    let log = parsed(&flight());
    assert_eq!((log.format, log.clock), ("PX4 ULog", Clock::SinceBoot));
    let reference = Geodetic { lat_deg: 47.3977, lon_deg: 8.5456, alt_amsl_m: 488.0 };
    assert_eq!(log.frame, LogFrame::Enu(Some(reference)));
    let [motion] = &log.motions[..] else { panic!("{:?}", log.motions.len()) };
    assert_eq!(
        (&motion.name[..], motion.source, motion.samples.len()),
        ("vehicle_local_position", Source::Estimate, 100)
    );
    let last = motion.samples[99];
    // The raw data's stamp, not the message's, which is 2 ms later.
    assert!((last.t_s - 11.98).abs() < 1e-9);
    // 3.96 m north on PX4's sphere are 3.96 M/R on the ellipsoid: M(47.4°) = 6 370 100 m and 488 m of height.
    assert!((last.p_m - Point3::new(0.5, 3.96, 1.98)).norm() < 2e-3, "{}", last.p_m);
    assert!((last.p_m.x - 0.5 * 6_390_100.0 / 6_371_000.0).abs() < 1e-4, "{}", last.p_m);
    assert_eq!(last.v_m_s, Some(Vector3::new(0.0, 2.0, 1.0)));
    assert_eq!(last.accuracy_m, Some([0.25, 0.5]));
    // Nose north and 30° up: forward and up as directions of ENU.
    let turn = last.attitude.unwrap();
    let (sin, cos) = 30_f64.to_radians().sin_cos();
    assert!((turn * Vector3::x() - Vector3::new(0.0, cos, sin)).norm() < 1e-6);
    assert!((turn * Vector3::z() - Vector3::new(0.0, -sin, cos)).norm() < 1e-6);
    assert_eq!(
        log.events,
        [
            event(10.0, EventKind::Landed, "landed"),
            event(10.1, EventKind::TookOff, "took off"),
            event(10.1, EventKind::MissionBegins, "nav_state AUTO_MISSION"),
            event(11.6, EventKind::Geofence, "geofence_max_alt_triggered"),
            event(11.6, EventKind::MissionEnds, "nav_state AUTO_RTL, asked for AUTO_MISSION"),
            event(11.6, EventKind::Failsafe, "failsafe, nav_state AUTO_RTL"),
        ]
    );
    let [first, second] = &log.progress[..] else { panic!("{:?}", log.progress) };
    assert_eq!((first.item, second.item), (1, 2));
    // 10⁻⁴° north of the reference, 12 m above it: a hundredth of a metre in eleven, by the meridian's radius.
    let north = 1e-4_f64.to_radians() * 6_370_588.0;
    assert!((first.target_m.unwrap() - Point3::new(0.0, north, 12.0)).norm() < 1e-3, "{first:?}");
    assert!((second.target_m.unwrap().y - 2.0 * north).abs() < 1e-3);
    assert!((log.dropouts[0].from_s - 11.00005).abs() < 1e-9 && (log.dropouts[0].to_s - 11.12005).abs() < 1e-9);
    assert_eq!(log.notes, ["PX4 1.15.2", "SDLOG_PROFILE 1", "1 topics that say nothing of the motion are not read"]);
}

#[test]
fn modes_of_a_log_without_a_mission_are_told() {
    let modes = |modes: &[u8]| {
        let mut log = Ulog::new();
        log.message(b'F', POSITION.as_bytes());
        log.message(b'F', b"vehicle_status:uint64_t timestamp;uint8_t nav_state;bool failsafe;");
        log.subscribe(0, 0, "vehicle_local_position");
        log.subscribe(0, 1, "vehicle_status");
        for (i, mode) in modes.iter().enumerate() {
            let t_us = i as u64 * 100_000;
            log.data(0, &[&at(t_us, [0.0; 3]).bytes()]);
            log.data(1, &[&t_us.to_le_bytes(), &[*mode, 0]]);
        }
        parsed(&log.0).events
    };
    let told =
        [event(0.0, EventKind::OtherMode, "nav_state POSCTL"), event(0.2, EventKind::OtherMode, "nav_state MANUAL")];
    assert_eq!(modes(&[2, 2, 0]), told);
    assert_eq!(modes(&[2, 3]), [event(0.1, EventKind::MissionBegins, "nav_state AUTO_MISSION")]);
}

#[test]
fn jumps_and_what_is_no_estimate_are_told() {
    let delta = [1.0, -2.0, 0.5, 0.3];
    let log = positions(&[
        at(0, [0.0; 3]),
        Position { counters: [1, 0, 0], delta, ..at(100_000, [1.0, -2.0, 0.0]) },
        Position { counters: [1, 1, 1], delta, ..at(200_000, [1.0, -2.0, 0.5]) },
        Position { counters: [4, 1, 1], delta, ..at(300_000, [1.0, -2.0, 0.5]) },
        Position { counters: [4, 1, 1], dead_reckoning: true, ..at(400_000, [1.0; 3]) },
        Position { counters: [4, 1, 1], valid: false, ..at(500_000, [f32::NAN; 3]) },
        Position { counters: [4, 1, 1], ..at(600_000, [1.0; 3]) },
        Position { counters: [4, 1, 1], reference: [47.3977, 8.546, 488.0], ..at(700_000, [1.0; 3]) },
        Position { counters: [4, 1, 1], reference: [47.3977, 8.546, 488.0], valid: false, ..at(800_000, [1.0; 3]) },
    ]);
    let log = parsed(&log.0);
    let [motion] = &log.motions[..] else { panic!() };
    let resets: Vec<_> = motion.resets.iter().map(|reset| (reset.t_s, reset.by_m)).collect();
    let wanted = [
        (0.1, Some(Vector3::new(-2.0, 1.0, 0.0))),
        (0.2, Some(Vector3::new(0.0, 0.0, -0.5))),
        (0.3, None),
        (0.7, None),
    ];
    assert_eq!(resets, wanted.map(|(t_s, by_m)| (t_s, by_m)));
    let spans: Vec<_> = motion.invalid.iter().map(|span| [span.from_s, span.to_s]).collect();
    assert_eq!(spans, [[0.4, 0.6], [0.8, 0.8]]);
    assert_eq!(motion.samples.len(), 8);
    // 4·10⁻⁴° of longitude at 47.4° are 30 m: what moved is the reference, not the vehicle on Earth that it says.
    assert!((motion.samples[6].p_m.x - 1.0 - 30.2).abs() < 0.1, "{}", motion.samples[6].p_m);
    let told = log.notes.join("\n");
    assert!(told.contains("the heading was reset by 17.2° at t = 0.20 s"), "{told}");
    assert!(told.contains("its reference on Earth moved 1 times") && told.contains("no `vehicle_attitude` beside it"));
}

#[test]
fn who_measured_it_stands_before_who_estimated_it() {
    let mut log = Ulog::new();
    let odometry = "vehicle_mocap_odometry:uint64_t timestamp;uint64_t timestamp_sample;float[3] position;float[4] q;\
                    float[3] velocity;float[3] position_variance;uint8_t pose_frame;uint8_t velocity_frame;";
    for format in [POSITION, &POSITION.replacen("position:", "position_groundtruth:", 1), odometry, ATTITUDE] {
        log.message(b'F', format.as_bytes());
    }
    log.subscribe(0, 0, "vehicle_local_position");
    log.subscribe(0, 1, "vehicle_local_position_groundtruth");
    log.subscribe(0, 2, "vehicle_mocap_odometry");
    log.subscribe(1, 3, "vehicle_local_position");
    for t in [0_u64, 20_000] {
        log.data(0, &[&at(t, [1.0, 2.0, 3.0]).bytes()]);
        log.data(3, &[&at(t, [1.0, 2.0, 3.0]).bytes()]);
        log.data(1, &[&at(t, [1.0, 2.0, 3.0]).bytes()]);
        let half = std::f32::consts::FRAC_1_SQRT_2;
        // Nose east, and 1 m/s to its right, which is south.
        let parts =
            [singles([1.0, 2.0, 3.0]), singles([half, 0.0, 0.0, half]), singles([0.0, 1.0, 0.0]), singles([0.04; 3])];
        log.data(2, &[&t.to_le_bytes(), &t.to_le_bytes(), &parts.concat(), &[1, 3]]);
    }
    let log = parsed(&log.0);
    let order: Vec<_> = log.motions.iter().map(|motion| (&motion.name[..], motion.source)).collect();
    let wanted = [
        ("vehicle_mocap_odometry", Source::MotionCapture),
        ("vehicle_local_position_groundtruth", Source::GroundTruth),
        ("vehicle_local_position", Source::Estimate),
        ("vehicle_local_position[1]", Source::Estimate),
    ];
    assert_eq!(order, wanted);
    // Motion capture is about a point of the room.
    assert_eq!(log.frame, LogFrame::Enu(None));
    let sample = log.motions[0].samples[1];
    assert_eq!(sample.p_m, Point3::new(2.0, 1.0, -3.0));
    assert!((sample.v_m_s.unwrap() - Vector3::new(0.0, -1.0, 0.0)).norm() < 1e-6, "{sample:?}");
    assert!((sample.attitude.unwrap() * Vector3::x() - Vector3::x()).norm() < 1e-6);
    assert!((sample.accuracy_m.unwrap()[0] - 0.2).abs() < 1e-6);
}

const VISUAL: &str = "vehicle_visual_odometry:uint64_t timestamp;uint64_t timestamp_sample;float[3] position;\
                      float[4] q;float[3] velocity;float[3] position_variance;uint8_t pose_frame;uint8_t velocity_frame;";

/// Two topics of positions, subscribed to as they stand; `selected`: from when on (µs) which instance was chosen.
fn two(topics: [(u8, &str); 2], selected: &[(u64, u8)]) -> Logged {
    let mut log = Ulog::new();
    let selector = "estimator_selector_status:uint64_t timestamp;uint8_t primary_instance;";
    for format in [POSITION, VISUAL, selector] {
        log.message(b'F', format.as_bytes());
    }
    for (id, (instance, name)) in topics.into_iter().enumerate() {
        log.subscribe(instance, id as u16, name);
    }
    log.subscribe(0, 9, "estimator_selector_status");
    for step in 0..4_u64 {
        let t = 100_000 * step;
        for (at_us, instance) in selected.iter().filter(|(at_us, _)| *at_us / 100_000 == step) {
            log.data(9, &[&at_us.to_le_bytes(), &[*instance]]);
        }
        for (id, (instance, name)) in topics.into_iter().enumerate() {
            let north = step as f32 + f32::from(instance) * 10.0;
            if name == "vehicle_local_position" {
                log.data(id as u16, &[&at(t, [north, 0.0, 0.0]).bytes()]);
            } else {
                let parts =
                    [singles([north, 0.0, 0.0]), singles([1.0, 0.0, 0.0, 0.0]), singles([0.0; 3]), singles([0.04; 3])];
                log.data(id as u16, &[&t.to_le_bytes(), &t.to_le_bytes(), &parts.concat(), &[1, 1]]);
            }
        }
    }
    parsed(&log.0)
}

#[test]
fn what_a_filter_takes_in_ranks_after_what_it_gives() {
    let (own, seen) = ((0, "vehicle_local_position"), (0, "vehicle_visual_odometry"));
    for topics in [[own, seen], [seen, own]] {
        let log = two(topics, &[]);
        let order: Vec<_> = log.motions.iter().map(|motion| (&motion.name[..], motion.source)).collect();
        let wanted = [("vehicle_local_position", Source::Estimate), ("vehicle_visual_odometry", Source::Input)];
        assert_eq!(order, wanted);
        assert!(matches!(log.frame, LogFrame::Enu(Some(_))), "by the estimate's reference: {:?}", log.frame);
        let words = "vehicle_visual_odometry: about a point of its own, which is nowhere on Earth";
        assert!(log.notes.iter().any(|note| note == words), "{:?}", log.notes);
    }
}

#[test]
fn of_two_instances_the_selector_says_which_was_flown_by() {
    let of = |instance| (instance, "vehicle_local_position");
    for topics in [[of(0), of(1)], [of(1), of(0)]] {
        // Nobody says: neither is known to be what moved.
        let log = two(topics, &[]);
        assert!(log.motions.iter().all(|motion| motion.source == Source::Untold), "{:?}", log.motions);
        let words = "no word of which of vehicle_local_position, vehicle_local_position[1] is of the vehicle";
        assert!(log.notes.iter().any(|note| note.starts_with(words)), "{:?}", log.notes);
        for (selected, name) in [(0, "vehicle_local_position"), (1, "vehicle_local_position[1]")] {
            let log = two(topics, &[(0, 255), (50_000, selected)]);
            assert_eq!((&log.motions[0].name[..], log.motions[0].source), (name, Source::Estimate));
        }
        let log = two(topics, &[(0, 0), (200_000, 1)]);
        let flown = &log.motions[0];
        assert_eq!(flown.name, "vehicle_local_position[primary]");
        let north: Vec<f64> = flown.samples.iter().map(|sample| sample.p_m.y.round()).collect();
        assert_eq!((north, flown.resets.len()), (vec![0.0, 1.0, 12.0, 13.0], 1));
        let log = two(topics, &[(0, 3)]);
        assert!(log.motions[0].unfit.as_ref().is_some_and(|why| why.contains("instance 3")), "{:?}", log.motions[0]);
    }
    // Of two cameras nobody says which is meant, either; what the filter gives does.
    let camera = |instance| (instance, "vehicle_visual_odometry");
    let log = two([camera(0), camera(1)], &[]);
    assert!(log.motions.iter().all(|motion| motion.source == Source::Untold));
}

/// The subscriptions that tell something in a step.
type Ids = fn(u64) -> &'static [u16];

#[test]
fn of_two_subscriptions_to_one_instance_at_one_time_nobody_knows_which_is_the_vehicles() {
    let why = "2 subscriptions to this one instance at one time: nobody knows which is the vehicle's";
    for name in ["vehicle_local_position", "vehicle_visual_odometry"] {
        let log = two([(0, name); 2], &[(0, 0)]);
        let [motion] = &log.motions[..] else { panic!("{:?}", log.motions) };
        assert_eq!(motion.unfit.as_deref(), Some(why), "{name}");
        assert!(log.notes.contains(&format!("{name}: {why}")), "{:?}", log.notes);
    }
    // What stands beside positions.
    let mut log = Ulog::new();
    let status = "vehicle_status:uint64_t timestamp;uint8_t nav_state;bool failsafe;";
    for format in [POSITION, ATTITUDE, status] {
        log.message(b'F', format.as_bytes());
    }
    log.subscribe(0, 0, "vehicle_local_position");
    let logged = |twice: &str, data: &dyn Fn(u64) -> Vec<u8>, ids: &dyn Fn(u64) -> &'static [u16]| {
        let mut log = Ulog(log.0.clone());
        log.subscribe(0, 1, twice);
        log.subscribe(0, 2, twice);
        for step in 0..6_u64 {
            let t = 100_000 * step;
            log.data(0, &[&at(t, [step as f32, 0.0, 0.0]).bytes()]);
            ids(step).iter().for_each(|id| log.data(*id, &[&data(t)]));
        }
        parsed(&log.0).motions.remove(0)
    };
    let both: Ids = |_| &[1, 2];
    let one_then_other: Ids = |step| if step < 3 { &[1] } else { &[2] };
    let turn = |t: u64| attitude(t, [1.0, 0.0, 0.0, 0.0]);
    let mode = |t: u64| [&t.to_le_bytes()[..], &[3, 0]].concat();
    for (twice, data) in [("vehicle_attitude", &turn as &dyn Fn(u64) -> Vec<u8>), ("vehicle_status", &mode)] {
        let told = logged(twice, data, &both).unfit;
        assert_eq!(told, Some(format!("{twice}: {why}")));
        // One ends before the other begins: the logger subscribed to it again.
        let again = logged(twice, data, &one_then_other);
        assert_eq!(again.unfit, None);
        assert!(twice != "vehicle_attitude" || again.samples.iter().all(|sample| sample.attitude.is_some()));
    }
}

#[test]
fn a_position_that_is_subscribed_to_again_later_is_one() {
    let of = |ids: [u16; 6]| {
        let mut log = positions(&[]);
        log.subscribe(0, 7, "vehicle_local_position");
        for (step, id) in (0_u64..).zip(ids) {
            log.data(id, &[&at(100_000 * step, [step as f32, 0.0, 0.0]).bytes()]);
        }
        parsed(&log.0).motions.remove(0)
    };
    let one = of([0, 0, 0, 7, 7, 7]);
    assert_eq!((one.samples.len(), one.unfit), (6, None));
    assert!(of([0, 0, 7, 7, 7, 0]).unfit.is_some());
}

#[test]
fn poses_in_another_frame_than_the_first_are_left_out() {
    let of = |frames: [u8; 6]| {
        let mut log = Ulog::new();
        log.message(b'F', VISUAL.as_bytes());
        log.subscribe(0, 0, "vehicle_visual_odometry");
        for (step, frame) in (0_u64..).zip(frames) {
            let (t, place) = (100_000 * step, singles([step as f32, 0.0, 0.0]));
            let parts = [place, singles([1.0, 0.0, 0.0, 0.0]), singles([0.0; 3]), singles([0.04; 3])];
            log.data(0, &[&t.to_le_bytes(), &t.to_le_bytes(), &parts.concat(), &[frame, 1]]);
        }
        parsed(&log.0)
    };
    let told = "vehicle_visual_odometry: 3 poses in another frame than the first are not read";
    for (frames, wanted, is_frd) in
        [([1, 1, 1, 2, 2, 2], [0.0, 1.0, 2.0], false), ([2, 1, 2, 1, 2, 1], [0.0, 2.0, 4.0], true)]
    {
        let log = of(frames);
        let north: Vec<f64> = log.motions[0].samples.iter().map(|sample| sample.p_m.y.round()).collect();
        assert_eq!(north, wanted);
        assert!(log.notes.iter().any(|note| note == told), "{:?}", log.notes);
        assert_eq!(matches!(log.frame, LogFrame::Named(_)), is_frd);
    }
    assert_eq!(of([2; 6]).motions[0].samples.len(), 6);
}

#[test]
fn what_is_at_two_places_with_one_stamp_is_not_fit_to_be_judged() {
    let step = |step: u64| at(100_000 * step, [step as f32, 0.0, -2.0]);
    let of = |more: &[Position]| {
        let log = positions(&[&[step(1), step(2), step(3)], more].concat());
        parsed(&log.0).motions.remove(0)
    };
    // Loggers write samples again, and go back where they lost some.
    let again = of(&[step(3), step(2), at(150_000, [1.4, 0.0, -2.0]), step(4)]);
    assert_eq!((again.samples.len(), again.unfit), (4, None));
    let far = "a sample with the stamp 0.15 s, after 0.3 s, is 15.84 m from those of that time";
    assert_eq!(of(&[at(150_000, [9.0; 3])]).unfit.as_deref(), Some(far));
    // What is not valid says nothing.
    assert_eq!(of(&[Position { valid: false, ..at(200_000, [9.0; 3]) }]).unfit, None);
    let why = "two places with the stamp 0.2 s, (0, 2, 2) m and (0, 2, 5) m: nobody knows which is true";
    assert_eq!(of(&[at(200_000, [2.0, 0.0, -5.0])]).unfit.as_deref(), Some(why));
}

#[test]
fn a_clock_that_was_set_back_is_not_fit_to_be_judged() {
    let log = |back_us: u64| {
        // Away and back again, with stamps of the time before if the clock was set back.
        let of = |step: u64| {
            let (t_us, aside) = (20_000 * step, if (60..80).contains(&step) { 2.0 } else { 0.0 });
            at(t_us + 10_000_000 - if step < 50 { 0 } else { back_us }, [aside, 0.0, -2.0])
        };
        parsed(&positions(&(0..100).map(of).collect::<Vec<_>>()).0)
    };
    assert_eq!(log(0).motions[0].unfit, None);
    let set_back = log(997_000);
    let why = "stamps go back from 10.98 s to 10.003 s: nobody knows what was when";
    assert_eq!(set_back.motions[0].unfit.as_deref(), Some(why));
    assert!(set_back.notes.contains(&format!("vehicle_local_position: {why}")), "{:?}", set_back.notes);
}

#[test]
fn where_the_odometry_says_that_it_failed_it_is_not_valid() {
    let mut log = Ulog::new();
    let format = b"vehicle_visual_odometry:uint64_t timestamp;float[3] position;uint8_t pose_frame;int8_t quality;";
    log.message(b'F', format);
    log.subscribe(0, 0, "vehicle_visual_odometry");
    for (t_us, quality) in (1_u64..).zip([0_i8, 100, -1, -1, 1, -1]).map(|(step, of)| (100_000 * step, of)) {
        log.data(0, &[&t_us.to_le_bytes(), &singles([1.0, 2.0, 3.0]), &[1], &quality.to_le_bytes()]);
    }
    let motion = parsed(&log.0).motions.remove(0);
    assert_eq!((motion.samples.len(), motion.unfit), (6, None));
    let spans: Vec<_> = motion.invalid.iter().map(|span| [span.from_s, span.to_s]).collect();
    assert_eq!(spans, [[0.3, 0.5], [0.6, 0.6]]);
}

#[test]
fn an_accuracy_that_is_told_of_one_counts_for_both() {
    let of = |accuracy: [f32; 2]| {
        let read = parsed(&positions(&[Position { accuracy, ..at(100_000, [0.0; 3]) }]).0);
        let is_told = read.notes.iter().any(|note| note.contains("1 samples tell their accuracy across or up alone"));
        (read.motions[0].samples[0].accuracy_m, is_told)
    };
    assert_eq!(of([5.0, f32::NAN]), (Some([5.0; 2]), true));
    assert_eq!(of([f32::NAN, 0.5]), (Some([0.5; 2]), true));
    assert_eq!(of([5.0, 0.5]), (Some([5.0, 0.5]), false));
    assert_eq!(of([f32::INFINITY, 0.5]), (Some([1e7, 0.5]), false));
    assert_eq!(of([f32::NAN, -1.0]), (None, false));
}

#[test]
fn a_log_that_is_cut_is_read_as_far_as_it_goes() {
    let whole = flight();
    let cut = parsed(&whole[..whole.len() - 30]);
    assert!(cut.motions[0].samples.len() >= 98);
    assert!(
        cut.notes.iter().any(|note| note.ends_with("the file ends within a message; read as far as that")),
        "{:?}",
        cut.notes
    );
    assert_eq!(fault(&whole[..12]), ", byte 12: the file ends within its header of 16 bytes");
    let told = fault(&whole[..200]);
    assert!(
        told.starts_with(": a PX4 ULog log without any motion (") && told.contains("ends within a message"),
        "{told}"
    );
}

#[test]
fn a_message_that_is_spoiled_is_told_and_the_next_in_step_is_read() {
    let whole = flight();
    let sync =
        whole.windows(8).rposition(|bytes| bytes == [0x2f, 0x73, 0x13, 0x20, 0x25, 0x0c, 0xbb, 0x12]).unwrap() - 3;
    // The size of the last data before the last synchronisation but one message: of the dropout (2 bytes) and the
    // string (14).
    let spoiled = sync - 17 - 5;
    assert_eq!(whole[spoiled + 2], b'O');
    let mut bytes = whole.clone();
    bytes[spoiled + 2] = b'o';
    let log = parsed(&bytes);
    let told = format!(
        "byte {spoiled}: no message: size 2, type 0x6f; read on at byte {sync}, where the log is in step again"
    );
    assert!(log.notes.contains(&told), "{:?}", log.notes);
    assert_eq!(log.motions[0].samples.len(), 100);
    let mut flags = whole.clone();
    flags[16 + 3 + 8] = 4;
    assert_eq!(
        fault(&flags),
        ", byte 27: flags 0x04 of a newer ULog, which no reader may read that does not know them"
    );
    let mut log = Ulog::new();
    log.message(b'F', b"vehicle_local_position:uint64_t timestamp;vehicle_local_position x;");
    log.subscribe(0, 0, "vehicle_local_position");
    assert_eq!(fault(&log.0), ", byte 129: the format `vehicle_local_position` holds itself");
    let mut log = Ulog::new();
    log.message(b'F', b"a:uint64_t timestamp;b[60000] x;");
    log.message(b'F', b"b:double[60000] x;");
    log.subscribe(0, 0, "a");
    assert!(fault(&log.0).ends_with("the format `b` is larger than 65535 bytes"), "{}", fault(&log.0));
    let mut log = positions(&[at(0, [0.0; 3])]);
    log.data(0, &[&[0; 20]]);
    let told = parsed(&log.0).notes.join("\n");
    assert!(told.contains("20 bytes of data of `vehicle_local_position`, must be 106; read as far as that"), "{told}");
}

#[test]
fn what_was_appended_is_read_behind_a_message_that_stops() {
    let mut log = positions(&[at(0, [0.0; 3])]);
    let end = log.0.len() + 10;
    log.data(0, &[&at(1_000, [9.0; 3]).bytes()]);
    log.0.truncate(end);
    log.data(0, &[&at(3_000, [1.0; 3]).bytes()]);
    log.0[16 + 3 + 8] = 1;
    log.0[16 + 3 + 16..][..8].copy_from_slice(&(end as u64).to_le_bytes());
    let read = parsed(&log.0);
    assert_eq!(read.motions[0].samples.iter().map(|sample| sample.t_s).collect::<Vec<_>>(), [0.002, 0.003]);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn flips_and_cuts_are_answers(place in 0_usize..20_000, bit in 0_u8..8, cut in 0_usize..20_000) {
        let mut bytes = flight();
        let (place, cut) = (place % bytes.len(), cut % bytes.len());
        bytes[place] ^= 1 << bit;
        drop(parse(&bytes, "a.ulg"));
        drop(parse(&bytes[..cut], "a.ulg"));
    }
}
