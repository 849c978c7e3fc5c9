//! What is written is read back; the formats' own readers read it in tests/python.

use nalgebra::{Isometry3, Point3, Translation3, UnitQuaternion};

use super::*;
use crate::logs::{Clock, LogFrame, Source, read};

fn track(step: f64) -> Track {
    let pose = |i: f64| {
        let turn = UnitQuaternion::from_euler_angles(0.3, -0.45, 2.1 + i);
        Isometry3::from_parts(Translation3::new(3.0 + i, -7.0, 11.0 - 0.1 * i), turn)
    };
    let times = (0..4).map(|i| f64::from(i) * step).collect();
    Track::new(times, (0..4).map(|i| pose(f64::from(i))).collect(), Vec::new()).unwrap()
}

fn tetrahedron() -> Surface {
    let vertices = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 3.0]].map(Point3::from).to_vec();
    Surface { name: "rock".into(), vertices, triangles: vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]] }
}

fn joints() -> JointMotion<'static> {
    let rows = vec![vec![0.0, 1.0], vec![0.1, 2.0]];
    JointMotion { name: "planned", names: vec!["a".into(), "b".into()], times_s: vec![0.5, 0.75], rows }
}

#[test]
fn what_is_written_for_ros_is_read_as_it_was() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.ros2.mcap");
    let (planned, flown) = (track(0.5), track(0.25));
    let facts = vec![("case", "0007".to_owned())];
    let recording = Recording {
        planned: Some(&planned),
        runs: vec![(3, &flown)],
        joints: vec![joints()],
        facts,
        ..Recording::default()
    };
    ros2::write(&path, &recording).unwrap();
    let read = read(&path).unwrap();
    assert_eq!((read.format, read.clock, &read.frame), ("ROS 2 MCAP", Clock::Header, &LogFrame::Named("world".into())));
    let names: Vec<_> = read.motions.iter().map(|motion| &motion.name[..]).collect();
    let sources: Vec<_> = read.motions.iter().map(|motion| motion.source).collect();
    assert_eq!(sources, [Source::Untold, Source::Way, Source::Asked]);
    // What is to be judged goes first, the plan last.
    assert_eq!(names, ["/run_3/pose", "/run_3/path", "/planned"]);
    for (motion, track) in read.motions.iter().zip([&flown, &flown, &planned]) {
        for ((sample, pose), time) in motion.samples.iter().zip(track.poses()).zip(track.times()) {
            assert_eq!((sample.t_s, sample.p_m), (*time, pose.translation.vector.into()));
            assert!(sample.attitude.unwrap().angle_to(&pose.rotation) < 1e-7);
        }
    }
    assert!(
        read.notes.iter().any(|note| note.starts_with("topics that are not read: /planned/joints (trajectory_msgs"))
    );
}

#[test]
fn files_have_one_encoding_each_and_are_in_order() {
    let folder = tempfile::tempdir().unwrap();
    let (planned, flown) = (track(0.5), track(0.25));
    let recording = Recording {
        planned: Some(&planned),
        runs: vec![(0, &flown)],
        joints: vec![joints()],
        obstacles: vec![tetrahedron()],
        ..Recording::default()
    };
    type Write = fn(&std::path::Path, &Recording) -> Result<(), McapError>;
    for (name, write, encoding) in
        [("a.mcap", foxglove::write as Write, "protobuf"), ("a.ros2.mcap", ros2::write as Write, "cdr")]
    {
        let path = folder.path().join(name);
        write(&path, &recording).unwrap();
        let bytes = std::fs::read(&path).unwrap();
        let summary = ::mcap::Summary::read(&bytes).unwrap().unwrap();
        assert!(!summary.chunk_indexes.is_empty());
        assert!(summary.channels.values().all(|channel| channel.message_encoding == encoding), "{name}");
        let messages: Vec<_> = ::mcap::MessageStream::new(&bytes).unwrap().map(Result::unwrap).collect();
        assert!(messages.is_sorted_by_key(|message| message.log_time));
        let expected = if encoding == "cdr" { 1 + 1 + 4 + 1 } else { 4 + 4 + 1 + 4 + 1 };
        assert_eq!(messages.len(), expected, "{name}");
        write(&path, &recording).unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), bytes, "the same bytes again");
    }
}

#[test]
fn what_is_no_motion_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.mcap");
    assert!(matches!(foxglove::write(&path, &Recording::default()), Err(McapError::Empty { .. })));
    assert!(matches!(ros2::write(&path, &Recording::default()), Err(McapError::Empty { .. })));
    let near = Track::new(vec![0.0, 1e-10], vec![Isometry3::identity(); 2], Vec::new()).unwrap();
    let refused = ros2::write(&path, &Recording { planned: Some(&near), ..Recording::default() }).unwrap_err();
    assert!(refused.to_string().contains("/planned: time 0.0000000001 s: must rise by a nanosecond"), "{refused}");
    let short = JointMotion { rows: vec![vec![0.0]; 2], ..joints() };
    let refused = ros2::write(&path, &Recording { joints: vec![short], ..Recording::default() }).unwrap_err();
    assert!(refused.to_string().ends_with("/planned/joints: 1 angles in a row, must be 2"), "{refused}");
    assert!(!path.exists());
}
