//! The planned motion of a case as a track: the witness where there is one, straight legs at constant speed otherwise.

use nalgebra::{Isometry3, Translation3, UnitQuaternion};

use crate::campaign::clock::{Moment, moments, paced};
use crate::campaign::{Case, Timed};
use crate::feasibility::steering::Flatness;
use crate::robot::quadrotor::Quadrotor;
use crate::trajectory::{Channel, Track, TrackError};

/// The rate of planned and of drawn tracks, Hz.
///
/// A sample every 10 ms, and one at the end.
const RATE: f64 = 100.0;

/// Of a witness p(τ) and p′(τ) of its polynomial; else constant velocity along the straight leg.
///
/// Position m, velocity m/s. At the joint of two legs the later one is asked.
fn sample(case: &Case, Moment { t, leg, tau }: Moment) -> Timed {
    if let Some(profile) = case.profile() {
        let piece = &profile.legs[leg];
        return Timed { t, position: piece.position(tau), velocity: piece.derivative(tau, 1) };
    }
    let (a, b) = (case.waypoints[leg], case.waypoints[leg + 1]);
    let velocity = (b - a) / case.leg_times[leg];
    Timed { t, position: a + velocity * tau, velocity }
}

/// The timed reference of a mission at `rate` (Hz).
///
/// Positions in m and velocities in m/s, in the cage's frame; the last stamp is the flight's end.
///
/// Empty for a case without leg times.
pub(super) fn timed(case: &Case, rate: f64) -> Vec<Timed> {
    moments(&case.leg_times, rate).into_iter().map(|moment| sample(case, moment)).collect()
}

/// The planned motion at 100 Hz with the channels `leg`, `vx_m_s`, `vy_m_s`, `vz_m_s`. Attitudes are those that a
/// witness flies; without one the robot is drawn level. A case without leg times (a mission made elsewhere) is drawn at
/// 1 m/s: its path is planned, its clock is not.
///
/// # Errors
/// A case whose numbers are no track, as a folder that was edited may hold.
pub(super) fn track(robot: &Quadrotor, case: &Case) -> Result<Track, TrackError> {
    let case = &*paced(case, 1.0, 1.0 / RATE);
    let moments = moments(&case.leg_times, RATE);
    let flatness = Flatness::new(robot).ok();
    let mut poses = Vec::with_capacity(moments.len());
    let mut columns = [(); 4].map(|()| Vec::with_capacity(moments.len()));
    for &moment in &moments {
        let now = sample(case, moment);
        let attitude = match (case.profile(), &flatness) {
            (Some(profile), Some(flatness)) => flatness.body_state(&profile.legs[moment.leg], moment.tau).attitude,
            _ => UnitQuaternion::identity(),
        };
        poses.push(Isometry3::from_parts(Translation3::from(now.position), attitude));
        columns[0].push(moment.leg as f64);
        for axis in 0..3 {
            columns[axis + 1].push(now.velocity[axis]);
        }
    }
    let names = ["leg", "vx_m_s", "vy_m_s", "vz_m_s"];
    let channels = names.into_iter().zip(columns).map(|(name, values)| Channel { name: name.into(), values });
    Track::new(moments.iter().map(|moment| moment.t).collect(), poses, channels.collect())
}
