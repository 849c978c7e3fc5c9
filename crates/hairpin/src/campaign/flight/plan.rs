//! The planned motion of a case as a track: the witness where there is one, straight legs at constant speed otherwise.

use nalgebra::{Isometry3, Translation3, UnitQuaternion};

use crate::campaign::clock::{Moment, changes, moments, paced};
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
    track_at(robot, case, &moments(&case.leg_times, RATE))
}

/// The rows where the [`track`] of straight legs bends, and the time between its samples, s: those between which the
/// leg changes, and both ends. `None` of a case with a witness, and of one that is over before the second sample.
///
/// All that is left out lies on the motion between these rows, but for rounding: velocities are even on a leg, and the
/// robot is level.
///
/// # Errors
/// As of [`track`].
pub(super) fn straight_rows(robot: &Quadrotor, case: &Case) -> Result<Option<(Track, f64)>, TrackError> {
    let case = &*paced(case, 1.0, 1.0 / RATE);
    if case.profile().is_some() || case.leg_times.iter().sum::<f64>() * RATE < 1.0 {
        return Ok(None);
    }
    Ok(Some((track_at(robot, case, &changes(&case.leg_times, RATE))?, 1.0 / RATE)))
}

fn track_at(robot: &Quadrotor, case: &Case, moments: &[Moment]) -> Result<Track, TrackError> {
    let flatness = Flatness::new(robot).ok();
    let mut poses = Vec::with_capacity(moments.len());
    let mut columns = [(); 4].map(|()| Vec::with_capacity(moments.len()));
    for &moment in moments {
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

#[cfg(feature = "unit-tests")]
mod tests {
    use std::collections::BTreeSet;

    use nalgebra::Point3;

    use super::*;
    use crate::campaign::CaseNumber;
    use crate::math::random::{stream, unit};
    use crate::simulation::tests::flightgoggles;
    use crate::trajectory::between::period;
    use crate::trajectory::{Tolerances, bends};

    /// Legs of a second, of hundredths that no stamp meets, and without times; of one height and of one line.
    #[test]
    fn rows_of_straight_legs_are_those_where_the_motion_bends() {
        let (robot, mut random) = (flightgoggles(), stream(3));
        let mut number = |scale: f64| scale * unit(&mut random);
        for kind in 0..60 {
            let legs = 1 + kind % 7;
            let place = |k: usize, way: [f64; 3]| match kind % 3 {
                0 => Point3::from(way),
                1 => Point3::new(way[0], way[1], 2.0),
                _ => Point3::new(3.0 + k as f64, 4.0, 0.5 * k as f64),
            };
            let waypoints = (0..=legs).map(|k| place(k, [(); 3].map(|()| number(30.0)))).collect();
            let leg_times = match kind % 4 {
                0 => Vec::new(),
                1 => vec![1.0; legs],
                _ => (0..legs).map(|_| 0.003 + number(2.0)).collect(),
            };
            let case = Case { leg_times, ..Case::bare(CaseNumber(0), 0, waypoints) };
            let all = track(&robot, &case).unwrap();
            let (rows, step) = straight_rows(&robot, &case).unwrap().unwrap();
            assert_eq!(rows, all.picked(&bends(&all, &BTreeSet::new(), &Tolerances::default())), "{case:?}");
            assert_eq!(Some(step), period(&all));
        }
        let short = Case { leg_times: vec![0.009], ..Case::bare(CaseNumber(0), 0, vec![Point3::origin(); 2]) };
        assert_eq!(straight_rows(&robot, &short), Ok(None));
    }
}
