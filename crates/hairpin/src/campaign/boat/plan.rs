//! The planned motion of a case as a track: the witness where there is one, straight legs at constant speed otherwise.

use nalgebra::{Isometry3, Point3, Translation3, Vector3};

use super::BoatSetup;
use crate::campaign::clock::{Moment, moments, paced};
use crate::campaign::{Case, Timed};
use crate::math::rotation::{quaternion_from_euler, unit_quaternion};
use crate::trajectory::{Channel, Track, TrackError};

/// Rate of planned tracks, and of the timed reference that executors get, Hz: boats are slow.
///
/// A sample every 0.2 s of what is drawn and compared, every 0.1 s of what executors are handed: who passes on nothing
/// but these is seen as often, accelerations are judged of four poses a second and more, and `check-executor` remarks
/// below ten.
const RATE: f64 = 5.0;
const REFERENCE_RATE: f64 = 10.0;

/// Place, heading and velocity at a moment.
///
/// World frame; m, rad, m/s.
struct Sample {
    leg: usize,
    position: Point3<f64>,
    heading: f64,
    velocity: Vector3<f64>,
}

/// The timed reference of a mission; empty for a case without leg times.
pub(super) fn timed(case: &Case) -> Vec<Timed> {
    let at = |moment: Moment| {
        let Sample { position, velocity, .. } = sample(case, moment);
        Timed { t: moment.t, position, velocity }
    };
    moments(&case.leg_times, REFERENCE_RATE).into_iter().map(at).collect()
}

/// Heading at each waypoint, rad: of a witness the one that it passes with, else along the leg that follows.
///
/// At the last waypoint the heading at the end of the last leg. One 0 for a single waypoint without a leg.
pub(super) fn headings(case: &Case) -> Vec<f64> {
    let legs = case.waypoints.len().saturating_sub(1);
    let along = |leg: usize| {
        let way = case.waypoints[leg + 1] - case.waypoints[leg];
        libm::atan2(way.y, way.x)
    };
    let at = |waypoint: usize| {
        let leg = waypoint.min(legs.saturating_sub(1));
        match case.profile().and_then(|profile| profile.legs.get(leg)) {
            Some(piece) => piece.derivative(if waypoint < legs { 0.0 } else { case.leg_times[leg] }, 0).z,
            None if legs > 0 => along(leg),
            None => 0.0,
        }
    };
    (0..case.waypoints.len()).map(at).collect()
}

/// The planned motion with the channels `leg`, `vx_m_s`, `vy_m_s`, `vz_m_s`. A case without leg times is drawn at the
/// boat's default speed.
///
/// # Errors
/// A case whose numbers are no track.
///
/// At [`RATE`] Hz, both ends included.
///
/// Attitudes are turns about z alone. `vz_m_s` is 0 throughout.
pub(super) fn track(setup: &BoatSetup, case: &Case) -> Result<Track, TrackError> {
    let case = &*paced(case, setup.boat.default_speed, 1.0 / RATE);
    let moments = moments(&case.leg_times, RATE);
    let samples: Vec<Sample> = moments.iter().map(|moment| sample(case, *moment)).collect();
    let pose = |sample: &Sample| {
        let attitude = unit_quaternion(&quaternion_from_euler(0.0, 0.0, sample.heading));
        Isometry3::from_parts(Translation3::from(sample.position), attitude)
    };
    let column = |name: &str, of: &dyn Fn(&Sample) -> f64| Channel {
        name: name.into(),
        values: samples.iter().map(of).collect(),
    };
    let channels = vec![
        column("leg", &|sample| sample.leg as f64),
        column("vx_m_s", &|sample| sample.velocity.x),
        column("vy_m_s", &|sample| sample.velocity.y),
        column("vz_m_s", &|_| 0.0),
    ];
    let poses = samples.iter().map(pose).collect();
    Track::new(moments.iter().map(|moment| moment.t).collect(), poses, channels)
}

/// Of a witness (x, y, ψ) = p(τ) and (ẋ, ẏ) of p′(τ); else constant velocity along the straight leg, the bow along it.
fn sample(case: &Case, Moment { leg, tau, .. }: Moment) -> Sample {
    if let Some(piece) = case.profile().and_then(|profile| profile.legs.get(leg)) {
        let (at, rate) = (piece.derivative(tau, 0), piece.derivative(tau, 1));
        let (position, velocity) = (Point3::new(at.x, at.y, 0.0), Vector3::new(rate.x, rate.y, 0.0));
        return Sample { leg, position, heading: at.z, velocity };
    }
    let (a, b) = (case.waypoints[leg], case.waypoints[leg + 1]);
    let velocity = (b - a) / case.leg_times[leg];
    Sample { leg, position: a + velocity * tau, heading: libm::atan2(velocity.y, velocity.x), velocity }
}
