//! Poses in time with named columns: the one form in which planned and flown motions meet the judge and the files.
//!
//! A flight log, our own simulator and a planned path come to this one form, so that a judge of tracks judges them all.
//! Units are in the names of channels, as they are in columns of files.

use nalgebra::{Isometry3, Point3, Vector3};
use thiserror::Error;

use crate::math::cubic::{Cubic, nearest_along};

/// Channel, 1 throughout, of tracks whose attitudes nobody told: their rotations mean nothing.
pub const ATTITUDE_UNKNOWN: &str = "attitude_unknown";
/// Channel, 1 throughout, of tracks of which nobody told how they ended: they are taken for done.
pub const END_UNSAID: &str = "end_unsaid";
/// Name of the channel, 1 at every sample, that marks a track whose executor sent no heights: they are those of the
/// robot on the map's ground.
pub const HEIGHTS_BY_MAP: &str = "heights_by_map";
/// Name of the channel, 1 at every stamp, that marks what is left of a track whose rows were left out: stamps at which
/// something happened. Its poses tell since when it stood where it ended, and nothing else.
pub const ROWS_LEFT_OUT: &str = "rows_left_out";

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
/// Places are joined by straight lines, but for planned paths that say how they bend.
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
    /// How the place goes from each stamp to the next, `None` where it goes straight; empty where it does everywhere.
    ways: Vec<Option<Cubic>>,
}

/// Share of the way between two stamps by which velocities may lead elsewhere and still be those of that way.
const EVEN: f64 = 0.05;

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
        Ok(Self { times, poses, channels, ways: Vec::new() })
    }

    /// The same track whose place goes from each stamp to the next along these `ways`, straight where there is none.
    ///
    /// # Panics
    /// Unless there is one from every stamp to the next.
    pub(crate) fn along(self, ways: Vec<Option<Cubic>>) -> Self {
        assert_eq!(ways.len() + 1, self.len(), "a way from every stamp to the next");
        Self { ways, ..self }
    }

    /// The stamps `which`, by their indices in rising order, with their poses and channels; places go straight from one
    /// to the next.
    ///
    /// # Panics
    /// If there is no such stamp.
    pub fn only(&self, which: &[usize]) -> Self {
        let of = |values: &[f64]| which.iter().map(|&i| values[i]).collect();
        let channel = |channel: &Channel| Channel { name: channel.name.clone(), values: of(&channel.values) };
        Self {
            times: of(&self.times),
            poses: which.iter().map(|&i| self.poses[i]).collect(),
            channels: self.channels.iter().map(channel).collect(),
            ways: Vec::new(),
        }
    }

    /// Whether its poses are those of a motion: not where its rows were left out ([`ROWS_LEFT_OUT`]).
    pub fn has_places(&self) -> bool {
        self.channel(ROWS_LEFT_OUT).is_none()
    }

    /// How the place goes from stamp `index` to the next, where that is not straight.
    pub(crate) fn way(&self, index: usize) -> Option<&Cubic> {
        self.ways.get(index)?.as_ref()
    }

    /// The place nearest to `p` between stamp `index` and the next, m.
    pub(crate) fn nearest(&self, index: usize, p: &Point3<f64>) -> Point3<f64> {
        nearest_along(self.way(index), p, &self.position(index), &self.position(index + 1))
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

    /// Place, velocity and acceleration at `t` (s) of a track with the channels `vx_m_s`, `vy_m_s`, `vz_m_s`; beyond
    /// its ends as there. `None` without them, or of fewer than two stamps.
    ///
    /// In m, m/s and m/s². Between two stamps of places p, q and velocities v, w the acceleration is even, (w − v)/h,
    /// where that leads from p to q; where velocities jump on the way, the way is even and goes by (q − p)/h, no faster
    /// than at the faster end. Where the place jumps and the velocity does not (joints of legs), the way is even, and
    /// the velocity is what it is at the ends.
    ///
    /// ```text
    /// σ = (t − t_i)/h
    /// even:   p + σ (q − p) + ½ h (w − v)(σ² − σ),   v + σ (w − v),   (w − v)/h
    /// else:   p + σ (q − p),   v·w > 0: v + σ (w − v), otherwise (q − p)/h · min(1, max(|v|, |w|)/|(q − p)/h|),   0
    /// ```
    ///
    /// Even is what ½ h (v + w) leads from p to q within 5 % of the way and 1 nm. A binary search a question.
    pub fn motion_at(&self, t: f64) -> Option<(Point3<f64>, Vector3<f64>, Vector3<f64>)> {
        let [x, y, z] = ["vx_m_s", "vy_m_s", "vz_m_s"].map(|name| self.channel(name));
        let [x, y, z] = [x?, y?, z?];
        let last = self.len().checked_sub(1).filter(|last| *last > 0)?;
        let at = self.times.partition_point(|stamp| *stamp <= t).clamp(1, last) - 1;
        let velocity = |i: usize| Vector3::new(x[i], y[i], z[i]);
        let span = self.times[at + 1] - self.times[at];
        let share = ((t - self.times[at]) / span).clamp(0.0, 1.0);
        let (p, v, w) = (self.position(at), velocity(at), velocity(at + 1));
        let way = self.position(at + 1) - p;
        let even = (0.5 * span * (v + w) - way).norm() <= EVEN * way.norm() + 1e-9;
        if !even {
            let mean = way / span;
            let velocity = match v.dot(&w) > 0.0 {
                true => v.lerp(&w, share),
                false => mean.cap_magnitude(v.norm().max(w.norm())),
            };
            return Some((p + way * share, velocity, Vector3::zeros()));
        }
        let bent = 0.5 * span * (w - v) * (share * share - share);
        Some((p + way * share + bent, v.lerp(&w, share), (w - v) / span))
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

/// The first value that is not finite, with the column's name.
fn finite(column: &str, values: impl Iterator<Item = f64>) -> Result<(), TrackError> {
    for (index, value) in values.enumerate() {
        if !value.is_finite() {
            return Err(TrackError::NotFinite { column: column.into(), index, value });
        }
    }
    Ok(())
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;

    #[test]
    fn between_stamps_acceleration_is_even_unless_velocities_jump() {
        let channel = |name: &str, values: &[f64]| Channel { name: name.into(), values: values.to_vec() };
        // From rest to 2 m/s in a second, and back at once at that speed.
        let poses = [0.0, 1.0, -1.0].map(|x| Isometry3::translation(x, 0.0, 0.0)).to_vec();
        let zeros = [0.0; 3];
        let channels = vec![channel("vx_m_s", &[0.0, 2.0, -2.0]), channel("vy_m_s", &zeros), channel("vz_m_s", &zeros)];
        let track = Track::new(vec![0.0, 1.0, 2.0], poses, channels).unwrap();
        let at = |t: f64| track.motion_at(t).map(|(p, v, a)| [p.x, v.x, a.x]).unwrap();
        assert_eq!(at(0.0), [0.0, 0.0, 2.0]);
        assert_eq!(at(0.5), [0.25, 1.0, 2.0]);
        assert_eq!((at(1.5), at(9.0)), ([0.0, -2.0, 0.0], [-1.0, -2.0, 0.0]));
        assert!(Track::new(vec![0.0], vec![Isometry3::identity()], vec![]).unwrap().motion_at(0.0).is_none());
    }

    /// A joint of two legs of 2 m/s, off by half a metre; then a change of gear that is off by as much.
    #[test]
    fn where_places_jump_nothing_is_faster_than_at_the_ends() {
        let channel = |name: &str, values: &[f64]| Channel { name: name.into(), values: values.to_vec() };
        let poses = [0.0, 2.5, 0.0].map(|x| Isometry3::translation(x, 0.0, 0.0)).to_vec();
        let zeros = [0.0; 3];
        let channels = vec![channel("vx_m_s", &[2.0, 2.0, -2.0]), channel("vy_m_s", &zeros), channel("vz_m_s", &zeros)];
        let track = Track::new(vec![0.0, 1.0, 2.0], poses, channels).unwrap();
        let at = |t: f64| track.motion_at(t).map(|(p, v, a)| [p.x, v.x, a.x]).unwrap();
        assert_eq!((at(0.5), at(1.5)), ([1.25, 2.0, 0.0], [1.25, -2.0, 0.0]));
    }

    #[test]
    fn refuses_what_is_no_track() {
        let pose = Isometry3::identity();
        assert!(matches!(Track::new(vec![0.0, 0.0], vec![pose; 2], vec![]), Err(TrackError::Times { index: 1, .. })));
        assert!(matches!(Track::new(vec![0.0], vec![pose; 2], vec![]), Err(TrackError::Length { .. })));
        let bad = Channel { name: "vx_m_s".into(), values: vec![f64::NAN] };
        assert!(matches!(Track::new(vec![0.0], vec![pose], vec![bad]), Err(TrackError::NotFinite { .. })));
    }
}
