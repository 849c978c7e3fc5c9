//! What a log shows not to bound the robot that flew it.

use nalgebra::Vector3;

use super::log::Log;
use crate::campaign::impossible::fastest;
use crate::judgement::Swiftness;

/// A bound of the robot's that a log of it exceeds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Exceeded {
    /// `speed` or `acceleration`.
    pub what: &'static str,
    /// The largest that the log has, in `unit`.
    pub seen: f64,
    /// The robot's, in `unit`.
    pub bound: f64,
    /// `m/s` or `m/s²`.
    pub unit: &'static str,
}

/// So many times its largest speed is what noise and wind explain.
const FASTER: f64 = 1.1;
/// So much (m/s) of a change of velocity is what the noise of an estimate explains.
const ROOM_M_S: f64 = 0.5;

/// What bounds the robot, without what the log itself shows not to, and what that is.
///
/// A larger speed than the model has says that its speed bounds nothing: of logged velocities, or what positions come
/// to over a second ([`over_seconds`]). The bound of accelerations counts drag at that speed, at most the square of it:
/// as far as [`FASTER`] it grows so; beyond, and where velocities change faster than by a h + [`ROOM_M_S`], the model
/// does not bound this robot at all. Of a log without velocities steps are told that are longer than the speed allows;
/// each is without its bound already ([`Swiftness::bulge`]).
pub(super) fn refuted(swiftness: Swiftness, log: &Log) -> (Swiftness, Option<Exceeded>) {
    let track = &log.flight.track;
    let span = |i: usize| track.times()[i + 1] - track.times()[i];
    let whole = || (0..track.len().saturating_sub(1)).filter(|i| log.breaks.binary_search(&(i + 1)).is_err());
    let too_fast = |seen: f64| {
        let bound = swiftness.speed.filter(|speed| *speed < seen)?;
        Some(Exceeded { what: "speed", seen, bound, unit: "m/s" })
    };
    let velocities = match ["vx_m_s", "vy_m_s", "vz_m_s"].map(|name| track.channel(name)) {
        [Some(x), Some(y), Some(z)] => Some([x, y, z]),
        _ => None,
    };
    let velocity = |i: usize| velocities.map(|axes| Vector3::from(axes.map(|axis| axis[i])));
    let told = (0..track.len()).filter_map(velocity).map(|v| v.norm()).fold(0.0, f64::max);
    let faster = too_fast(told.max(over_seconds(log)));
    let mut left = swiftness;
    if let Some(Exceeded { seen, bound, .. }) = faster {
        let ratio = seen / bound;
        left = Swiftness { speed: None, acceleration: left.acceleration.map(|a| a * ratio * ratio) };
        if ratio > FASTER {
            return (Swiftness::default(), faster);
        }
    }
    if velocities.is_none() {
        let steps = whole().map(|i| (track.position(i + 1) - track.position(i)).norm() / span(i));
        return (left, faster.or_else(|| too_fast(steps.fold(0.0, f64::max))));
    }
    let change = |i: usize| Some((velocity(i + 1)? - velocity(i)?).norm());
    let changes = whole().filter_map(|i| Some((change(i)?, span(i))));
    let sudden = left.acceleration.and_then(|bound| {
        let beyond = changes.filter(|(change, span)| *change > bound * span + ROOM_M_S);
        let seen = beyond.map(|(change, span)| change / span).max_by(f64::total_cmp)?;
        Some(Exceeded { what: "acceleration", seen, bound, unit: "m/s²" })
    });
    if sudden.is_some() {
        left.acceleration = None;
    }
    (left, sudden.or(faster))
}

/// The largest speed (m/s) that the positions come to in the mean over a second or little more, without what their
/// accuracy explains; 0 where nothing is as long.
fn over_seconds(log: &Log) -> f64 {
    fastest(&log.flight.track, &log.breaks, &|i| log.radius(i)).map_or(0.0, |fastest| fastest.speed())
}
