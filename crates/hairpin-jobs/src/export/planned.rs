//! The planned motion of a case, as files for other programs have it.

use hairpin::campaign::Case;
use hairpin::trajectory::{Channel, Track};

use crate::Problem;
use crate::work::Work;

/// Channels of the velocity, m/s, world frame.
const VELOCITY: [&str; 3] = ["vx_m_s", "vy_m_s", "vz_m_s"];

/// The planned motion; of a witnessed drive no faster over ground than it is commanded.
///
/// # Errors
/// The campaign's files are broken, or have no planned motion of the case.
pub(super) fn planned(work: &Work, case: &Case) -> Result<Track, Problem> {
    let track = work.folder.read_planned(case.number)?;
    if work.setup.room().is_none_or(|room| room.flies) {
        return Ok(track);
    }
    let mut case = case.clone();
    if case.witness.is_none() {
        work.folder.read_witness(&mut case)?;
    }
    let Some(drive) = case.commands() else { return Ok(track) };
    let fastest = drive.legs.iter().map(|leg| leg.timing().fastest()).fold(0.0, f64::max);
    Ok(no_faster(track, fastest))
}

/// The same with velocities that are shortened to `most` (m/s) over ground: what is kept of a plan is within a
/// hundredth of its range, on either side.
fn no_faster(track: Track, most: f64) -> Track {
    let [Some(vx), Some(vy), _] = VELOCITY.map(|name| track.channel(name)) else { return track };
    let share = |(x, y): (&f64, &f64)| {
        let speed = libm::hypot(*x, *y);
        if speed > most { most / speed } else { 1.0 }
    };
    let shares: Vec<f64> = vx.iter().zip(vy).map(share).collect();
    let shortened = |channel: &Channel| match VELOCITY.contains(&channel.name.as_str()) {
        true => {
            let values = channel.values.iter().zip(&shares).map(|(value, share)| value * share).collect();
            Channel { name: channel.name.clone(), values }
        }
        false => channel.clone(),
    };
    let channels = track.channels().iter().map(shortened).collect();
    Track::new(track.times().to_vec(), track.poses().to_vec(), channels).expect("a track's own columns, made smaller")
}

#[cfg(test)]
mod tests {
    use nalgebra::Isometry3;

    use super::*;

    #[test]
    fn what_is_faster_over_ground_is_shortened() {
        let channel = |name: &str, values: [f64; 2]| Channel { name: name.into(), values: values.to_vec() };
        let channels =
            [("leg", [0.0, 9.0]), (VELOCITY[0], [3.0, 0.6]), (VELOCITY[1], [4.0, 0.8]), (VELOCITY[2], [2.0; 2])];
        let channels = channels.map(|(name, values)| channel(name, values)).to_vec();
        let track = Track::new(vec![0.0, 1.0], vec![Isometry3::identity(); 2], channels).unwrap();
        let held = no_faster(track.clone(), 2.5);
        let of = |name: &str| held.channel(name).unwrap().to_vec();
        assert_eq!((of(VELOCITY[0]), of(VELOCITY[1])), (vec![1.5, 0.6], vec![2.0, 0.8]));
        assert_eq!((of(VELOCITY[2]), of("leg")), (vec![1.0, 2.0], vec![0.0, 9.0]));
        assert_eq!(no_faster(track.clone(), 5.0), track);
    }
}
