//! Poses in time with named columns: the one form in which planned and flown motions meet the judge and the files.
//!
//! A flight log, our own simulator and a planned path come to this one form, so that a judge of tracks judges them all.
//! Units are in the names of channels, as they are in columns of files.

use nalgebra::{Isometry3, Point3};
use thiserror::Error;

/// Channel, 1 throughout, of tracks whose attitudes nobody told: their rotations mean nothing.
pub const ATTITUDE_UNKNOWN: &str = "attitude_unknown";

/// A named column beside the poses, one value per stamp.
///
/// SI by its name's suffix: `_m`, `_m_s`, `_rad_s`; shares and numbers have none.
#[derive(Debug, Clone, PartialEq)]
pub struct Channel {
    /// Name with its unit, as it is written to files: `vx_m_s`, `rotor1_rad_s`, `leg`.
    pub name: String,
    /// One value per stamp.
    pub values: Vec<f64>,
}

/// `times.len() == poses.len() ==` every channel's length; times rise strictly, s; poses are `world_from_body`.
///
/// ```
/// use hairpin::trajectory::{Channel, Track};
/// use nalgebra::Isometry3;
///
/// let poses = (0..3).map(|i| Isometry3::translation(f64::from(i), 0.0, 1.0)).collect();
/// let leg = Channel { name: "leg".into(), values: vec![0.0; 3] };
/// let track = Track::new(vec![0.0, 0.5, 1.0], poses, vec![leg])?.with_velocities();
/// assert_eq!(track.channel("vx_m_s"), Some([2.0; 3].as_slice()));
/// assert!(Track::new(vec![0.0, 0.0], vec![Isometry3::identity(); 2], vec![]).is_err()); // times must rise
/// # Ok::<(), hairpin::trajectory::TrackError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Track {
    times: Vec<f64>,
    poses: Vec<Isometry3<f64>>,
    channels: Vec<Channel>,
}

/// Why columns are no track.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum TrackError {
    /// A column is longer or shorter than the times.
    #[error("column `{column}` has {found} values, the times have {expected}")]
    Length {
        /// The column's name.
        column: String,
        /// Its length.
        found: usize,
        /// Number of stamps.
        expected: usize,
    },
    /// Times must rise strictly.
    #[error("times must rise strictly: t[{index}] = {time} s does not follow t[{}] = {before} s", index - 1)]
    Times {
        /// Index of the stamp that does not rise.
        index: usize,
        /// The stamp, s.
        time: f64,
        /// The one before it, s.
        before: f64,
    },
    /// NaN or infinite.
    #[error("{column}[{index}] = {value}: must be finite")]
    NotFinite {
        /// The column's name.
        column: String,
        /// Index of the stamp.
        index: usize,
        /// The number.
        value: f64,
    },
}

impl Track {
    /// Checks and takes the columns.
    ///
    /// Linear in stamps times columns. Quaternions are taken as they are: finite, not renormalised.
    ///
    /// # Errors
    /// Unequal lengths, stamps that do not rise strictly, numbers that are not finite.
    pub fn new(times: Vec<f64>, poses: Vec<Isometry3<f64>>, channels: Vec<Channel>) -> Result<Self, TrackError> {
        let expected = times.len();
        let length = |column: &str, found: usize| {
            if found == expected { Ok(()) } else { Err(TrackError::Length { column: column.into(), found, expected }) }
        };
        length("pose", poses.len())?;
        for channel in &channels {
            length(&channel.name, channel.values.len())?;
            finite(&channel.name, channel.values.iter().copied())?;
        }
        finite("t_s", times.iter().copied())?;
        for axis in 0..3 {
            finite(["x_m", "y_m", "z_m"][axis], poses.iter().map(|pose| pose.translation.vector[axis]))?;
        }
        finite("qw", poses.iter().map(|pose| pose.rotation.w + pose.rotation.i + pose.rotation.j + pose.rotation.k))?;
        if let Some(index) = (1..times.len()).find(|&i| times[i] <= times[i - 1]) {
            return Err(TrackError::Times { index, time: times[index], before: times[index - 1] });
        }
        Ok(Self { times, poses, channels })
    }

    /// Stamps, s.
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// `world_from_body` per stamp.
    pub fn poses(&self) -> &[Isometry3<f64>] {
        &self.poses
    }

    /// The named columns.
    pub fn channels(&self) -> &[Channel] {
        &self.channels
    }

    /// The values of the channel called `name`.
    pub fn channel(&self, name: &str) -> Option<&[f64]> {
        self.channels.iter().find(|channel| channel.name == name).map(|channel| channel.values.as_slice())
    }

    /// Position at stamp `index`, m.
    pub fn position(&self, index: usize) -> Point3<f64> {
        Point3::from(self.poses[index].translation.vector)
    }

    /// The same track with the channels `vx_m_s`, `vy_m_s`, `vz_m_s`: the way from the stamp before to the stamp after
    /// by the time between them, at both ends to the only neighbour; 0 of a single stamp.
    ///
    /// v_i = (p_{i+1} − p_{i−1})/(t_{i+1} − t_{i−1}): of second order on even stamps, and what a log has that tells no
    /// velocities.
    pub fn with_velocities(mut self) -> Self {
        let last = self.len().saturating_sub(1);
        let mut velocity: [Vec<f64>; 3] = Default::default();
        for i in 0..self.len() {
            let (before, after) = (i.saturating_sub(1), (i + 1).min(last));
            let moved = self.position(after) - self.position(before);
            let rate = if after > before { moved / (self.times[after] - self.times[before]) } else { moved };
            velocity.iter_mut().zip(rate.iter()).for_each(|(column, rate)| column.push(*rate));
        }
        let rates = ["vx_m_s", "vy_m_s", "vz_m_s"].into_iter().zip(velocity);
        self.channels.extend(rates.map(|(name, values)| Channel { name: name.into(), values }));
        self
    }

    /// Number of stamps.
    pub fn len(&self) -> usize {
        self.times.len()
    }

    /// Whether there is no stamp.
    pub fn is_empty(&self) -> bool {
        self.times.is_empty()
    }
}

fn finite(column: &str, values: impl Iterator<Item = f64>) -> Result<(), TrackError> {
    for (index, value) in values.enumerate() {
        if !value.is_finite() {
            return Err(TrackError::NotFinite { column: column.into(), index, value });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn refuses_what_is_no_track() {
        let pose = Isometry3::identity();
        assert!(matches!(Track::new(vec![0.0, 0.0], vec![pose; 2], vec![]), Err(TrackError::Times { index: 1, .. })));
        assert!(matches!(Track::new(vec![0.0], vec![pose; 2], vec![]), Err(TrackError::Length { .. })));
        let bad = Channel { name: "vx_m_s".into(), values: vec![f64::NAN] };
        assert!(matches!(Track::new(vec![0.0], vec![pose], vec![bad]), Err(TrackError::NotFinite { .. })));
    }
}
