//! The planned motion of a drive: its commands followed on the ground by the vehicle that was planned with.

use nalgebra::Point3;

use super::DriveSetup;
use crate::campaign::{Case, PlanError, Timed};
use crate::simulation::ground::planned_track;
use crate::trajectory::drive::{Gear, Motion, Planar, Segment};
use crate::trajectory::{Drive, DriveLeg, Track};

/// The planned motion with the channels `leg`, `vx_m_s`, `vy_m_s`, `vz_m_s`. A case without a drive is drawn along its
/// straight legs, turning in place at each waypoint.
///
/// # Errors
/// A drive that the ground does not carry, as a folder that was edited may hold.
///
/// Poses are the settled body's, step by step of the motion prediction; velocities are the planned speeds along its
/// way.
///
/// Deterministic; O(length of the drive / step of the prediction). The planner's vehicle drives: latency, lags and
/// scales are not in it.
pub(super) fn track(setup: &DriveSetup, case: &Case) -> Result<Track, PlanError> {
    let drive = drive_of(setup, case);
    Ok(planned_track(&setup.planner, &setup.map, &drive)?)
}

/// The commands of `case`, or the straight way where it has none.
///
/// A copy of the case's own commands. The straight way is driven at the setup's pace.
pub(super) fn drive_of(setup: &DriveSetup, case: &Case) -> Drive {
    case.commands().cloned().unwrap_or_else(|| straight_legs(setup, &case.waypoints))
}

/// The body's heading at each waypoint, rad; of a case without a drive those that turns in place come to.
///
/// One for each waypoint, the first the start's.
pub(super) fn headings(setup: &DriveSetup, case: &Case) -> Vec<f64> {
    let drive = drive_of(setup, case);
    let first = drive.legs.first().map(|leg| leg.from.yaw);
    first.into_iter().chain(drive.legs.iter().map(|leg| leg.to.yaw)).collect()
}

/// The timed reference of a mission at `rate` (Hz).
///
/// At t = k / rate and at the drive's end, by even accelerations between the track's stamps
/// ([`Track::motion_at`]). Empty for a drive that the ground does not carry.
///
/// Positions m and velocities m/s in the map's frame; the last interval may be shorter than 1/rate, and is left out
/// below 1 ns.
pub(super) fn timed(setup: &DriveSetup, case: &Case, rate: f64) -> Vec<Timed> {
    let Ok(track) = track(setup, case) else { return Vec::new() };
    let end = track.times().last().copied().unwrap_or_default();
    let count = (end * rate).floor() as usize;
    let even = (0..=count).map(|k| k as f64 / rate);
    let rest = Some(end).filter(|end| end - count as f64 / rate > 1e-9);
    let row = |t: f64| track.motion_at(t).map(|(position, velocity, _)| Timed { t, position, velocity });
    even.chain(rest).filter_map(row).collect()
}

/// Turns towards each waypoint and straight lines to it, from rest to rest.
///
/// Each turn is the shortest, −π to π. Of a range of directions of travel its middle is taken.
///
/// Two segments a leg, a turn of 0 included; headings are those of the way less the direction of travel. The start's
/// curvature is not kept: straight legs have none.
fn straight_legs(setup: &DriveSetup, waypoints: &[Point3<f64>]) -> Drive {
    let (speed, [low, high]) = (setup.speed(), setup.directions());
    // Straight legs have one direction.
    let direction = if low == high { low } else { 0.5 * (low + high) };
    let mut yaw = setup.scenario.task.start.yaw_deg.to_radians();
    let mut legs = Vec::with_capacity(waypoints.len().saturating_sub(1));
    for pair in waypoints.windows(2) {
        let way = pair[1] - pair[0];
        let (length, heading) = (libm::hypot(way.x, way.y), libm::atan2(way.y, way.x) - direction);
        let turn = libm::remainder(heading - yaw, std::f64::consts::TAU);
        let turn = Segment { motion: Motion::Turn { angle_rad: turn }, gear: Gear::Forward };
        let place = |p: &Point3<f64>, yaw| Planar { x: p.x, y: p.y, yaw, curvature: 0.0 };
        let segments = vec![turn, Segment::straight(length, Gear::Forward)];
        let (from, to) = (place(&pair[0], yaw), place(&pair[1], heading));
        legs.push(DriveLeg { from, to, segments, speed: speed.into(), direction: direction.into() });
        yaw = heading;
    }
    let segments: Vec<&[Segment]> = legs.iter().map(|leg| leg.segments.as_slice()).collect();
    let wishes = vec![0.0; legs.len() + 1];
    let profiles = setup.pace().over(speed, &wishes, &segments, &setup.planner.response);
    for (leg, profile) in legs.iter_mut().zip(profiles) {
        leg.speed = profile;
    }
    Drive { legs, speed, turn_rate: setup.turn_rate() }
}
