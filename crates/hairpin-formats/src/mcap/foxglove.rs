//! MCAP for Foxglove: protocol buffers by Foxglove's own schemas.
//!
//! | topic | schema | what |
//! | --- | --- | --- |
//! | `/planned` | `foxglove.PosesInFrame` | the planned path, at its first time |
//! | `/run_N` | `foxglove.PoseInFrame` | where the robot was |
//! | `/tf` | `foxglove.FrameTransform` | the frames `planned` and `run_N` in `world` |
//! | `/scene` | `foxglove.SceneUpdate` | obstacles |

use std::collections::BTreeMap;
use std::path::Path;

use hairpin::campaign::kind::Surface;
use hairpin::trajectory::Track;
use nalgebra::Isometry3;

use super::protobuf::Message;
use super::schema::descriptors;
use super::writer::Writer;
use super::{McapError, Recording, WORLD};

/// What obstacles are painted in: red, green, blue, opacity.
const COLOR: [f64; 4] = [0.55, 0.55, 0.6, 0.6];

/// Writes `recording`; joints have no schema of Foxglove's and are left to the other writer.
///
/// # Errors
/// There is no motion; a time that is none; the file cannot be written.
pub fn write(path: &Path, recording: &Recording) -> Result<(), McapError> {
    let mut writer = Writer::new(path, "")?;
    let moved: Vec<(String, &Track)> =
        recording.planned.map(|track| ("planned".to_owned(), track)).into_iter().collect();
    let runs = recording.runs.iter().map(|(run, track)| (format!("run_{run}"), *track));
    let moved: Vec<(String, &Track)> = moved.into_iter().chain(runs).filter(|(_, track)| !track.is_empty()).collect();
    if moved.is_empty() {
        return Err(McapError::Empty { path: path.into() });
    }
    let frames = channel(&mut writer, "/tf", "foxglove.FrameTransform")?;
    let mut first = u64::MAX;
    for (name, track) in &moved {
        let topic = format!("/{name}");
        let times = writer.nanoseconds(&topic, track.times())?;
        first = times.iter().copied().fold(first, u64::min);
        for (time, pose) in times.iter().zip(track.poses()) {
            writer.push(frames, *time, transform(*time, name, pose));
        }
        if name == "planned" {
            let path = channel(&mut writer, &topic, "foxglove.PosesInFrame")?;
            let start = times.first().copied().unwrap_or_default();
            writer.push(path, start, in_frame(start).messages(3, track.poses().iter().map(pose)).into_bytes());
        } else {
            let poses = channel(&mut writer, &topic, "foxglove.PoseInFrame")?;
            for (time, place) in times.iter().zip(track.poses()) {
                writer.push(poses, *time, in_frame(*time).message(3, &pose(place)).into_bytes());
            }
        }
    }
    if !recording.obstacles.is_empty() {
        let scene = channel(&mut writer, "/scene", "foxglove.SceneUpdate")?;
        let entities = recording.obstacles.iter().enumerate().map(|(index, surface)| entity(first, index, surface));
        writer.push(scene, first, Message::default().messages(2, entities).into_bytes());
    }
    writer.finish(&recording.facts)
}

fn channel(writer: &mut Writer, topic: &str, schema: &'static str) -> Result<u16, McapError> {
    writer.channel(topic, (schema, "protobuf"), descriptors, "protobuf", &BTreeMap::new())
}

fn stamp(time_ns: u64) -> Message {
    Message::default().integer(1, time_ns / 1_000_000_000).integer(2, time_ns % 1_000_000_000)
}

/// Time and frame, with which poses begin.
fn in_frame(time_ns: u64) -> Message {
    Message::default().message(1, &stamp(time_ns)).string(2, WORLD)
}

fn pose(pose: &Isometry3<f64>) -> Message {
    let (p, q) = place(pose);
    Message::default().message(1, &p).message(2, &q)
}

fn place(pose: &Isometry3<f64>) -> (Message, Message) {
    let (p, q) = (pose.translation.vector, pose.rotation);
    (Message::default().doubles([p.x, p.y, p.z]), Message::default().doubles([q.i, q.j, q.k, q.w]))
}

fn transform(time_ns: u64, child: &str, pose: &Isometry3<f64>) -> Vec<u8> {
    let (p, q) = place(pose);
    let transform = Message::default().message(1, &stamp(time_ns)).string(2, WORLD).string(3, child);
    transform.message(4, &p).message(5, &q).into_bytes()
}

fn entity(time_ns: u64, index: usize, surface: &Surface) -> Message {
    let entity = in_frame(time_ns).string(3, &format!("{index} {}", surface.name));
    let points = surface.vertices.iter().map(|v| Message::default().doubles([v.x, v.y, v.z]));
    let (p, q) = place(&Isometry3::identity());
    let triangles =
        Message::default().message(1, &Message::default().message(1, &p).message(2, &q)).messages(2, points);
    let triangles = triangles.message(3, &Message::default().doubles(COLOR));
    entity.message(12, &triangles.fixed32(5, surface.triangles.iter().flatten().copied()))
}
