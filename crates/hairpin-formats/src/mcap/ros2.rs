//! MCAP for ROS 2: what `ros2 bag play`, RViz and rosbags read.
//!
//! | topic | type | what |
//! | --- | --- | --- |
//! | `/planned`, `/run_N/path` | `nav_msgs/msg/Path` | the whole way, each pose with its time; at its first time |
//! | `/run_N/pose` | `geometry_msgs/msg/PoseStamped` | where the robot was |
//! | `/NAME/joints` | `trajectory_msgs/msg/JointTrajectory` | an arm's joints, at their first time |

use std::collections::BTreeMap;
use std::path::Path;

use hairpin::trajectory::Track;

use super::cdr::Cdr;
use super::writer::Writer;
use super::{JointMotion, McapError, Recording, WORLD};

const PATH: &str = "nav_msgs/msg/Path";
const POSE: &str = "geometry_msgs/msg/PoseStamped";
const JOINTS: &str = "trajectory_msgs/msg/JointTrajectory";

/// Writes `recording`; obstacles are left to the other writer.
///
/// # Errors
/// There is no motion; a time that is none; rows of joints of another length than their names; the file
/// cannot be written.
pub fn write(path: &Path, recording: &Recording) -> Result<(), McapError> {
    let mut writer = Writer::new(path, "ros2")?;
    let planned = recording.planned.filter(|track| !track.is_empty());
    let runs: Vec<(usize, &Track)> = recording.runs.iter().filter(|(_, track)| !track.is_empty()).copied().collect();
    if planned.is_none() && runs.is_empty() && recording.joints.is_empty() {
        return Err(McapError::Empty { path: path.into() });
    }
    if let Some(track) = planned {
        write_path(&mut writer, "/planned", track)?;
    }
    for (run, track) in runs {
        write_path(&mut writer, &format!("/run_{run}/path"), track)?;
        let topic = format!("/run_{run}/pose");
        let times = writer.nanoseconds(&topic, track.times())?;
        let channel = channel(&mut writer, &topic, POSE, false)?;
        for (time, pose) in times.iter().zip(track.poses()) {
            let mut message = Cdr::new();
            message.header(*time, WORLD);
            message.pose(pose);
            writer.push(channel, *time, message.into_bytes());
        }
    }
    for joints in &recording.joints {
        write_joints(path, &mut writer, joints)?;
    }
    writer.finish(&recording.facts)
}

fn write_path(writer: &mut Writer, topic: &str, track: &Track) -> Result<(), McapError> {
    let times = writer.nanoseconds(topic, track.times())?;
    let start = times.first().copied().unwrap_or_default();
    let mut message = Cdr::new();
    message.header(start, WORLD);
    message.u32(times.len() as u32);
    for (time, pose) in times.iter().zip(track.poses()) {
        message.header(*time, WORLD);
        message.pose(pose);
    }
    let channel = channel(writer, topic, PATH, true)?;
    writer.push(channel, start, message.into_bytes());
    Ok(())
}

/// `time_from_start` is from the header's stamp, the first time, on.
fn write_joints(path: &Path, writer: &mut Writer, joints: &JointMotion) -> Result<(), McapError> {
    let topic = format!("/{}/joints", joints.name);
    let times = writer.nanoseconds(&topic, &joints.times_s)?;
    let Some(start) = times.first().copied() else { return Err(McapError::Empty { path: path.into() }) };
    let mut message = Cdr::new();
    message.header(start, "base_link");
    message.u32(joints.names.len() as u32);
    joints.names.iter().for_each(|name| message.string(name));
    message.u32(times.len() as u32);
    for (index, time) in times.iter().enumerate() {
        let row = joints.rows.get(index).map_or(&[][..], Vec::as_slice);
        if row.len() != joints.names.len() {
            let (found, expected) = (row.len(), joints.names.len());
            return Err(McapError::Joints { path: path.into(), topic, found, expected });
        }
        message.doubles(row);
        // Velocities, accelerations and effort are left to the controller.
        (0..3).for_each(|_| message.u32(0));
        message.time(time - start);
    }
    let channel = channel(writer, &topic, JOINTS, true)?;
    writer.push(channel, start, message.into_bytes());
    Ok(())
}

/// A channel; who subscribes late still gets what is `latched`.
fn channel(writer: &mut Writer, topic: &str, schema: &'static str, latched: bool) -> Result<u16, McapError> {
    let metadata = BTreeMap::from([("offered_qos_profiles".to_owned(), quality_of_service(latched))]);
    writer.channel(topic, (schema, "ros2msg"), || definition(schema).into_bytes(), "cdr", &metadata)
}

/// Reliable, keeping the last; numbers as rosbag2 has them.
fn quality_of_service(latched: bool) -> String {
    let durability = if latched { 1 } else { 2 };
    let forever = |name: &str| format!("  {name}:\n    sec: 9223372036\n    nsec: 854775807\n");
    format!(
        "- history: 1\n  depth: 10\n  reliability: 1\n  durability: {durability}\n{}{}  liveliness: 1\n{}  \
         avoid_ros_namespace_conventions: false",
        forever("deadline"),
        forever("lifespan"),
        forever("liveliness_lease_duration"),
    )
}

/// Definitions of `common_interfaces` and `rcl_interfaces`, without their comments.
const DEFINITIONS: [(&str, &str); 8] = [
    ("builtin_interfaces/Time", "int32 sec\nuint32 nanosec\n"),
    ("builtin_interfaces/Duration", "int32 sec\nuint32 nanosec\n"),
    ("std_msgs/Header", "builtin_interfaces/Time stamp\nstring frame_id\n"),
    ("geometry_msgs/Point", "float64 x\nfloat64 y\nfloat64 z\n"),
    ("geometry_msgs/Quaternion", "float64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1\n"),
    ("geometry_msgs/Pose", "geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n"),
    ("geometry_msgs/PoseStamped", "std_msgs/Header header\ngeometry_msgs/Pose pose\n"),
    (
        "trajectory_msgs/JointTrajectoryPoint",
        "float64[] positions\nfloat64[] velocities\nfloat64[] accelerations\nfloat64[] effort\n\
         builtin_interfaces/Duration time_from_start\n",
    ),
];

/// A type's definition and those of all that it holds, as MCAP's registry asks for them ("ros2msg").
fn definition(schema: &str) -> String {
    const POSES: [&str; 5] = [
        "std_msgs/Header",
        "builtin_interfaces/Time",
        "geometry_msgs/Pose",
        "geometry_msgs/Point",
        "geometry_msgs/Quaternion",
    ];
    let (own, first, others) = match schema {
        PATH => (
            "std_msgs/Header header\ngeometry_msgs/PoseStamped[] poses\n",
            Some("geometry_msgs/PoseStamped"),
            &POSES[..],
        ),
        POSE => ("std_msgs/Header header\ngeometry_msgs/Pose pose\n", None, &POSES[..]),
        _ => (
            "std_msgs/Header header\nstring[] joint_names\ntrajectory_msgs/JointTrajectoryPoint[] points\n",
            Some("trajectory_msgs/JointTrajectoryPoint"),
            &["std_msgs/Header", "builtin_interfaces/Time", "builtin_interfaces/Duration"][..],
        ),
    };
    let mut text = own.to_owned();
    for name in first.iter().chain(others) {
        let fields = DEFINITIONS.iter().find(|(known, _)| known == name).map_or("", |(_, fields)| fields);
        text += &format!("{}\nMSG: {name}\n{fields}", "=".repeat(80));
    }
    text
}
