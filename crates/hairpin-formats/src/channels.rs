//! In which order a track's channels stand in files.

use hairpin::trajectory::{Channel, Track};

/// The leg that is being flown.
pub(crate) const LEG: &str = "leg";
/// The velocity, world frame: right after the pose, whatever the track's order.
pub(crate) const VELOCITY: [&str; 3] = ["vx_m_s", "vy_m_s", "vz_m_s"];

/// The channels of `track` as they stand in files: the leg, the velocity, then the others in their order.
pub(crate) fn in_order(track: &Track) -> Vec<&Channel> {
    let place = |channel: &&Channel| match channel.name.as_str() {
        LEG => 0,
        name if VELOCITY.contains(&name) => 1,
        _ => 2,
    };
    let mut channels: Vec<&Channel> = track.channels().iter().collect();
    channels.sort_by_key(place);
    channels
}
