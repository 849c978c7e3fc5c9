//! ROS 2 bags.

use mcap::Compression;
use nalgebra::{Point3, Vector3};
use proptest::prelude::*;

use super::write_bag::{Cdr, bag, drive};
use super::*;

fn pose(seconds: u32, frame: &str, x: f64) -> Vec<u8> {
    Cdr::new(true).header(seconds, 0, frame).numbers(&[x, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]).bytes()
}

#[test]
fn odometry_and_joints_are_read_however_they_are_packed() {
    let of = |little, packed| parse(&drive(little, packed), "a.mcap").unwrap();
    let read = of(true, None);
    assert_eq!((read.format, read.clock, &read.frame), ("ROS 2 MCAP", Clock::Header, &LogFrame::Named("odom".into())));
    let [motion] = &read.motions[..] else { panic!("{read:?}") };
    assert_eq!((&motion.name[..], motion.samples.len()), ("/odom", 20));
    let last = motion.samples[19];
    assert!((last.t_s - 101.9).abs() < 1e-9);
    assert_eq!(last.p_m, Point3::new(19.0, 2.0, 0.5));
    // Turned left by a right angle, 1 m/s ahead: the twist is the body's.
    assert!((last.attitude.unwrap() * Vector3::x() - Vector3::y()).norm() < 1e-12);
    assert!((last.v_m_s.unwrap() - Vector3::y()).norm() < 1e-12);
    assert_eq!(last.accuracy_m, Some([0.2, 0.5]));
    let [joints] = &read.joints[..] else { panic!("{read:?}") };
    assert_eq!(joints.joints, ["q_b", "q_a"]);
    assert_eq!((&joints.positions_rad[7][..], joints.times_s.len()), (&[14.0, 7.0][..], 20));
    assert_eq!(read.notes, ["topics that are not read: /rosout (rcl_interfaces/msg/Log, cdr)"]);
    for (little, packed) in [(false, None), (true, Some(Compression::Zstd)), (false, Some(Compression::Lz4))] {
        assert_eq!(of(little, packed), read);
    }
}

#[test]
fn poses_that_are_no_place_are_told_as_such_and_quaternions_of_no_length_are_not_judged() {
    let kind = "geometry_msgs/msg/PoseStamped";
    let of = |numbers: [f64; 7]| {
        let one = |t: u32, numbers: [f64; 7]| {
            let body = Cdr::new(true).header(t, 0, "map").numbers(&numbers).bytes();
            ("/a", kind, u64::from(t) * 1_000_000_000, body)
        };
        let place = |x: f64| [x, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0];
        parse(&bag(&[one(1, place(1.0)), one(2, numbers), one(3, place(3.0))], None), "a.mcap").unwrap()
    };
    let nan = f64::NAN;
    for numbers in [[nan, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0], [2.0, 0.0, 0.0, 0.0, 0.0, nan, 1.0]] {
        let read = of(numbers);
        let [note] = &read.notes[..] else { panic!("{:?}", read.notes) };
        assert!(note.starts_with("/a: 1 messages without a finite pose are not read, the first at byte "), "{note}");
        assert_eq!((read.motions[0].samples.len(), &read.motions[0].unfit), (2, &None));
    }
    for (numbers, length) in
        [([2.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0], "0.0000"), ([2.0, 0.0, 0.0, 0.0, 0.0, 0.9, 0.0], "0.9000")]
    {
        let read = of(numbers);
        let why = format!("1 quaternions that are none, the first of length {length} with the stamp 2 s, must be 1");
        assert_eq!((read.motions[0].samples.len(), read.motions[0].unfit.as_deref()), (3, Some(&why[..])));
        assert_eq!(read.notes, [format!("/a: {why}")]);
    }
    assert_eq!(of([2.0, 0.0, 0.0, 0.0, 0.0, 0.995, 0.0]).motions[0].unfit, None);
    // Who publishes places alone leaves them all zeros.
    let place =
        |t: u32| Cdr::new(true).header(t, 0, "map").numbers(&[f64::from(t), 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]).bytes();
    let places = [1, 2, 3].map(|t| ("/a", kind, u64::from(t) * 1_000_000_000, place(t)));
    let read = parse(&bag(&places, None), "a.mcap").unwrap();
    assert_eq!((read.motions[0].samples.len(), &read.motions[0].unfit), (3, &None));
    assert!(read.motions[0].samples.iter().all(|sample| sample.attitude.is_none()));
    assert_eq!(read.notes, ["/a: quaternions of zeros: no attitude is told"]);
    let joints = |q: f64| Cdr::new(true).header(1, 0, "").u32(1).text("q").u32(1).numbers(&[q]).u32(0).u32(0).bytes();
    let kind = "sensor_msgs/msg/JointState";
    let messages = [("/j", kind, 1, joints(1.0)), ("/j", kind, 2, joints(f64::INFINITY))];
    let notes = parse(&bag(&messages, None), "a.mcap").unwrap().notes;
    assert!(notes[0].starts_with("/j: 1 messages without finite positions are not read"), "{notes:?}");
}

/// Of a joint that is named twice nobody knows which position is its own.
#[test]
fn messages_that_name_a_joint_twice_are_not_read() {
    let joints = |seconds: u32, second: &str| {
        let head = Cdr::new(true).header(seconds, 0, "").u32(2).text("q_a").text(second);
        head.u32(2).numbers(&[1.0, 2.0]).u32(0).u32(0).bytes()
    };
    let kind = "sensor_msgs/msg/JointState";
    let messages = [(7, "q_b"), (8, "q_b"), (9, "q_a")]
        .map(|(seconds, second)| ("/j", kind, u64::from(seconds) * 1_000_000_000, joints(seconds, second)));
    let read = parse(&bag(&messages, None), "a.mcap").unwrap();
    assert_eq!(read.joints[0].times_s.len(), 2);
    let told = read.notes.join("\n");
    assert!(told.contains("/j: 1 messages that tell nothing, the first with the joint q_a twice, at byte "), "{told}");
    let empty = |seconds: u32| Cdr::new(true).header(seconds, 0, "").u32(1).text("q").u32(0).u32(0).u32(0).bytes();
    let messages = [1, 2].map(|seconds| ("/j", kind, u64::from(seconds) * 1_000_000_000, empty(seconds)));
    let told = format!("{:?}", parse(&bag(&messages, None), "a.mcap").unwrap_err());
    assert!(told.contains("/j: 2 messages that tell nothing, the first without positions, at byte "), "{told}");
}

/// A message without a stamp is of an unknown moment, not of the year 1970.
#[test]
fn messages_without_a_stamp_among_others_are_left_out() {
    const BEGUN: u32 = 1_700_000_000;
    let joints = |t: u32, q: f64| {
        let head = Cdr::new(true).header(if q < 0.0 { 0 } else { t }, 0, "").u32(1).text("q_a");
        head.u32(1).numbers(&[q.abs()]).u32(0).u32(0).bytes()
    };
    let place = |t: u32, x: f64| pose(if x < 0.0 { 0 } else { t }, "map", x.abs());
    let read = |begun: u32, without: &[u32]| {
        let one = |t: u32| {
            let q = if without.contains(&t) { -1.0 } else { 1.0 } * f64::from(t);
            let at = u64::from(begun + t) * 1_000_000_000;
            [
                ("/j", "sensor_msgs/msg/JointState", at, joints(begun + t, q)),
                ("/a", "geometry_msgs/msg/PoseStamped", at, place(begun + t, q)),
            ]
        };
        parse(&bag(&(1..=6).flat_map(one).collect::<Vec<_>>(), None), "a.mcap").unwrap()
    };
    for without in [&[1][..], &[3, 4], &[6]] {
        let found = read(BEGUN, without);
        let kept: Vec<f64> = (1..=6).filter(|t| !without.contains(t)).map(|t| f64::from(BEGUN + t)).collect();
        let (motion, joints) = (&found.motions[0], &found.joints[0]);
        assert_eq!(motion.samples.iter().map(|sample| sample.t_s).collect::<Vec<_>>(), kept, "{without:?}");
        assert_eq!((&joints.times_s, &motion.unfit, &joints.unfit), (&kept, &None, &None), "{without:?}");
        let told = found.notes.join("\n");
        for name in ["/j", "/a"] {
            let note =
                format!("{name}: {} of 6 messages have no stamp in their header and are left out", without.len());
            assert!(told.contains(&note), "{told}");
        }
    }
    // Of whom most tell no time, nothing is known of when.
    let found = read(BEGUN, &[2, 4, 6]);
    let why = "3 of 6 messages have no stamp in their header: when they were nobody knows";
    let unfit = [found.motions[0].unfit.as_deref(), found.joints[0].unfit.as_deref()];
    assert_eq!(unfit, [Some(why); 2]);
    // A simulation's clock begins at 0.
    let found = read(0, &[1]);
    let (motion, joints) = (&found.motions[0], &found.joints[0]);
    let kept = [0.0, 2.0, 3.0, 4.0, 5.0, 6.0];
    assert_eq!(motion.samples.iter().map(|sample| sample.t_s).collect::<Vec<_>>(), kept);
    assert_eq!((&joints.times_s[..], &motion.unfit, &joints.unfit), (&kept[..], &None, &None));
}

#[test]
fn times_are_when_they_were_recorded_where_headers_have_none() {
    let kind = "geometry_msgs/msg/PoseStamped";
    let messages = [
        ("/a", kind, 3_000_000_000, pose(0, "map", 1.0)),
        ("/a", kind, 2_000_000_000, pose(0, "map", 2.0)),
        ("/a", kind, 3_000_000_000, pose(0, "map", 3.0)),
        ("/a", kind, 4_000_000_000, pose(0, "odom", 4.0)),
        ("/a", kind, 5_000_000_000, vec![0, 1, 0, 0, 9]),
        ("/b", kind, 5_000_000_000, pose(7, "other", 9.0)),
    ];
    let read = parse(&bag(&messages, None), "a.mcap").unwrap();
    assert_eq!((read.clock, &read.frame), (Clock::Receive, &LogFrame::Named("map".into())));
    let of = |motion: &LoggedMotion| motion.samples.iter().map(|sample| (sample.t_s, sample.p_m.x)).collect::<Vec<_>>();
    assert_eq!(of(&read.motions[0]), [(2.0, 2.0), (3.0, 1.0)]);
    assert_eq!(of(&read.motions[1]), [(5.0, 9.0)]);
    let told = read.notes.join("\n");
    for part in [
        "no stamps in the headers of /a: times are when messages were recorded",
        "/a: 1 messages with a stamp that was there before",
        "/a: 1 poses in another frame than the first are not read",
        "/a: 1 messages that are none of its type, the first at byte ",
        "/b is in the frame `other`, /a in `map`: nothing is turned or moved",
        "several topics of a motion: /a, /b",
    ] {
        assert!(told.contains(part), "{part} is not in {told}");
    }
}

/// Messages at 50 Hz of what moves at 1 unit a second, and one more with the header's stamp of the one at 0.2 s.
fn one_more(kind: &'static str, body: impl Fn(u32, f64) -> Vec<u8>, at: f64) -> Logged {
    let message = |step: u32, at: f64, behind: u64| {
        ("/a", kind, 1_000_000_000 + u64::from(step) * 20_000_000 + behind, body(step * 20_000_000, at))
    };
    let mut messages: Vec<_> = (0..20).map(|step| message(step, 0.02 * f64::from(step), 0)).collect();
    messages.push(message(10, at, 1_000));
    parse(&bag(&messages, None), "a.mcap").unwrap()
}

#[test]
fn what_is_at_two_places_with_one_stamp_is_not_fit_to_be_judged() {
    let pose =
        |ns: u32, x: f64| Cdr::new(true).header(7, ns, "map").numbers(&[x, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]).bytes();
    let joints = |ns: u32, q: f64| {
        let head = Cdr::new(true).header(7, ns, "").u32(2).text("q_a").text("q_b");
        head.u32(2).numbers(&[5.0, q]).u32(0).u32(0).bytes()
    };
    // Again the same, and again within the milliseconds that stamps are told in.
    for at in [0.2, 0.2 + 1e-9, 0.201] {
        let read = one_more("geometry_msgs/msg/PoseStamped", pose, at);
        assert_eq!((read.motions[0].samples.len(), &read.motions[0].unfit), (20, &None), "{at}");
        assert_eq!(read.notes, ["/a: 1 messages with a stamp that was there before"]);
        assert_eq!(one_more("sensor_msgs/msg/JointState", joints, at).joints[0].unfit, None, "{at}");
    }
    let read = one_more("geometry_msgs/msg/PoseStamped", pose, 3.2);
    let why = "two places with the stamp 7.2 s, (0.2, 0, 0) m and (3.2, 0, 0) m: nobody knows which is true";
    assert_eq!(read.motions[0].unfit.as_deref(), Some(why));
    assert!(read.notes.contains(&format!("/a: {why}")), "{:?}", read.notes);
    let read = one_more("sensor_msgs/msg/JointState", joints, 0.3);
    let why = "two positions of the joint q_b with the stamp 7.2 s, 0.2 rad and 0.3 rad: nobody knows which is true";
    assert_eq!(read.joints[0].unfit.as_deref(), Some(why));
    // Without stamps a recorder that was held up has some of one time, but not what is metres away.
    let unstamped = |far: f64| {
        let message = |step: u64, x: f64| {
            let pose = Cdr::new(true).header(0, 0, "map").numbers(&[x, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]).bytes();
            ("/a", "geometry_msgs/msg/PoseStamped", 1_000_000_000 + step * 20_000_000, pose)
        };
        let mut messages: Vec<_> = (0..20).map(|step| message(step, 0.02 * step as f64)).collect();
        messages.push(message(10, 0.2 + far));
        parse(&bag(&messages, None), "a.mcap").unwrap().motions[0].unfit.clone()
    };
    let why = "two places with the stamp 1.2 s, (0.2, 0, 0) m and (3.2, 0, 0) m: nobody knows which is true";
    assert_eq!((unstamped(0.4), unstamped(3.0).as_deref()), (None, Some(why)));
}

#[test]
fn a_path_without_times_is_a_plan() {
    let path = |stamps: [u32; 2]| {
        let cdr = Cdr::new(true)
            .header(9, 0, "map")
            .u32(2)
            .header(stamps[0], 0, "")
            .numbers(&[1.0, 2.0, 3.0, 0.0, 0.0, 0.0, 1.0]);
        cdr.header(stamps[1], 0, "").numbers(&[4.0, 5.0, 6.0, 0.0, 0.0, 0.0, 1.0]).bytes()
    };
    let kind = "nav_msgs/msg/Path";
    let read = parse(&bag(&[("/p", kind, 1, path([1, 2])), ("/p", kind, 2, path([3, 4]))], None), "a.mcap").unwrap();
    let times: Vec<_> = read.motions[0].samples.iter().map(|sample| sample.t_s).collect();
    assert_eq!((times, &read.frame), (vec![3.0, 4.0], &LogFrame::Named("map".into())));
    let told = refusal(&bag(&[("/p", kind, 1, path([0, 0]))], None), "a.mcap");
    assert!(
        told.contains("without any motion (/p: 1 paths; none has poses with stamps that rise: a plan, not a motion)"),
        "{told}"
    );
}

#[test]
fn what_was_asked_for_comes_behind_what_moved() {
    let kind = "geometry_msgs/msg/PoseStamped";
    let names =
        ["/a/command/pose", "/goal_pose", "/mavros/setpoint_raw", "/set_point", "/planned", "/commander/pose", "/z"];
    let poses = |name: &'static str| [1, 2].map(|t| (name, kind, t, pose(t as u32, name, 1.0)));
    let messages: Vec<_> = names.into_iter().flat_map(poses).collect();
    let read = parse(&bag(&messages, None), "a.mcap").unwrap();
    let found: Vec<_> = read.motions.iter().map(|motion| (&motion.name[..], motion.source)).collect();
    assert_eq!(found[..2], [("/commander/pose", Source::Untold), ("/z", Source::Untold)]);
    assert!(found.len() == 7 && found[2..].iter().all(|(_, source)| *source == Source::Asked), "{found:?}");
    // The frame that is told is the first one's.
    assert_eq!(read.frame, LogFrame::Named("/commander/pose".into()));
}

#[test]
fn names_of_what_was_asked_for_are_read_by_their_words() {
    let source = |name: &'static str, kind: &'static str, body: &dyn Fn(u32) -> Vec<u8>| {
        let messages: Vec<_> = [1, 2].map(|t| (name, kind, u64::from(t), body(t))).into();
        let read = parse(&bag(&messages, None), "a.mcap").unwrap();
        read.motions.first().map_or_else(|| read.joints[0].source, |motion| motion.source)
    };
    let of_pose = |name| source(name, "geometry_msgs/msg/PoseStamped", &|t| pose(t, "map", 1.0));
    let joints = |t: u32| Cdr::new(true).header(t, 0, "").u32(1).text("a").u32(1).numbers(&[0.5]).u32(0).u32(0).bytes();
    let of_joints = |name| source(name, "sensor_msgs/msg/JointState", &joints);
    for name in [
        "/goalPose",
        "/targetPose",
        "/setpointPose",
        "/desiredPose",
        "/cmdPose",
        "/CMDPose",
        "/target1/pose",
        "/goal2",
        "/Goal_Pose",
        "/setPoint",
        "/goalpose",
        "/uav1/poseCmd",
        "/desired/odom",
        "/pose_sp",
        "/offboard/sp",
        "/carrot",
        "/initialpose",
        "/fmu/in/pose",
        "/predicted",
    ] {
        assert_eq!(of_pose(name), Source::Asked, "{name}");
    }
    for name in
        ["/fmu/out/pose", "/robot1/odom", "/commander/pose", "/vrpn/Platform2/pose", "/preferencePose", "/run_0/pose"]
    {
        assert_eq!(of_pose(name), Source::Untold, "{name}");
    }
    for name in ["/joint_command", "/desired/joint_states", "/jointCommands", "/jointcmd"] {
        assert_eq!(of_joints(name), Source::Asked, "{name}");
    }
    assert_eq!(of_joints("/joint_states"), Source::Untold);
}

#[test]
fn an_accuracy_that_is_told_of_one_counts_for_both() {
    let odometry = |t: u32, variances: [f64; 3]| {
        let mut covariance = [0.0; 36];
        [covariance[0], covariance[7], covariance[14]] = variances;
        let place = Cdr::new(true).header(t, 0, "odom").text("base").numbers(&[f64::from(t), 0.0, 0.0]);
        let place = place.numbers(&[0.0, 0.0, 0.0, 1.0]).numbers(&covariance);
        place.numbers(&[0.0; 6]).numbers(&[0.0; 36]).bytes()
    };
    let told = |variances: [f64; 3]| {
        let messages = [1, 2].map(|t| ("/odom", "nav_msgs/msg/Odometry", u64::from(t), odometry(t, variances)));
        let read = parse(&bag(&messages, None), "a.mcap").unwrap();
        (read.motions[0].samples[0].accuracy_m, read.notes)
    };
    let note = "/odom: 2 samples tell their accuracy across or up alone, which counts for both";
    assert_eq!(told([4.0, 25.0, -1.0]), (Some([5.0; 2]), vec![note.to_owned()]));
    assert_eq!(told([f64::NAN, f64::NAN, 0.25]), (Some([0.5; 2]), vec![note.to_owned()]));
    assert_eq!(told([0.0; 3]), (None, Vec::new()));
    assert_eq!(told([-1.0; 3]), (None, Vec::new()));
    assert_eq!(told([f64::INFINITY, 1.0, 0.25]), (Some([1e7, 0.5]), Vec::new()));
}

#[test]
fn what_is_cut_or_spoiled_is_told_by_its_byte() {
    let whole = drive(true, Some(Compression::Zstd));
    let cut = parse(&whole[..whole.len() / 2], "a.mcap").unwrap();
    assert!(cut.notes.iter().any(|note| note.ends_with("the file ends within a record; read as far as that")));
    assert!((1..20).contains(&cut.motions[0].samples.len()));
    // The first chunk begins behind the header's record.
    let header = 8 + 9 + u64::from_le_bytes(whole[9..17].try_into().unwrap()) as usize;
    assert_eq!(whole[header], 6);
    let mut spoiled = whole.clone();
    spoiled[header + 90] ^= 4;
    let read = parse(&spoiled, "a.mcap").unwrap();
    let told = format!("byte {header}: a broken chunk: ");
    assert!(
        read.notes.iter().any(|note| note.starts_with(&told) && note.ends_with("the record is not read")),
        "{:?}",
        read.notes
    );
    assert!((1..20).contains(&read.motions[0].samples.len()));
    // A chunk that says it holds gigabytes takes no room for them.
    let mut large = whole.clone();
    large[header + 9 + 16..][..8].copy_from_slice(&(1_u64 << 40).to_le_bytes());
    let taken = allocation_counter::measure(|| drop(parse(&large, "a.mcap")));
    assert!(taken.bytes_max < 10_000_000, "{}", taken.bytes_max);
    let mut zero = whole;
    zero[header] = 0;
    assert_eq!(refusal(&zero, "a.mcap"), format!(", byte {header}: a record of the operation 0, which there is not"));
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn flips_and_cuts_are_answers(place in 0_usize..20_000, bit in 0_u8..8, cut in 0_usize..20_000, packed in 0..3) {
        let packed = [None, Some(Compression::Zstd), Some(Compression::Lz4)][packed as usize];
        let mut bytes = drive(true, packed);
        let (place, cut) = (place % bytes.len(), cut % bytes.len());
        bytes[place] ^= 1 << bit;
        drop(parse(&bytes, "a.mcap"));
        drop(parse(&bytes[..cut], "a.mcap"));
    }
}
