//! When a robot is carried on beyond a waypoint, and when it strays from the leg behind it.

/// So many times as far from a waypoint as a robot is carried on beyond its place, that place still is at the waypoint.
const NEAR: f64 = 5.0;

/// Whether a robot is carried on that is `beyond` (m) its place in the direction in which it came, where that place is
/// `aside` (m) from the waypoint; with `room`, m, whether one may be that is no farther away than that.
///
/// Of what is no number nothing is left out.
pub(super) fn counts_beyond(beyond: f64, aside: f64, room: f64) -> bool {
    aside - room <= NEAR * (beyond + room) || aside.is_nan() || beyond.is_nan()
}
