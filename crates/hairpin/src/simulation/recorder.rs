//! The log of a run: poses and channels at a fixed rate, in columns that are allocated once.

use nalgebra::{Isometry3, Translation3};

use super::step::Motion;
use crate::math::rotation::unit_quaternion;
use crate::trajectory::{Channel, Track};

const NAMES: [&str; 12] = [
    "leg",
    "vx_m_s",
    "vy_m_s",
    "vz_m_s",
    "p_rad_s",
    "q_rad_s",
    "r_rad_s",
    "rotor1_rad_s",
    "rotor2_rad_s",
    "rotor3_rad_s",
    "rotor4_rad_s",
    "saturated",
];

/// Columns being filled.
#[derive(Debug, Clone)]
pub(crate) struct Recorder {
    times: Vec<f64>,
    poses: Vec<Isometry3<f64>>,
    columns: [Vec<f64>; NAMES.len()],
}

/// Samples that a log is allocated for at once; longer ones grow.
const MOST_AT_ONCE: usize = 1 << 16;

impl Recorder {
    /// For about `samples` samples.
    pub(crate) fn new(samples: usize) -> Self {
        let room = samples.min(MOST_AT_ONCE);
        Self {
            times: Vec::with_capacity(room),
            poses: Vec::with_capacity(room),
            columns: std::array::from_fn(|_| Vec::with_capacity(room)),
        }
    }

    /// Appends a sample; one that is not finite or not later than the last is left out.
    pub(crate) fn push(&mut self, t: f64, motion: &Motion, leg: usize, saturated: f64) {
        if self.times.last().is_some_and(|last| t <= *last) || !motion.is_finite() {
            return;
        }
        let [[x, y, z, _], [vx, vy, vz, _], [p, q, r, _], [w1, w2, w3, w4]] = motion.logged();
        let attitude = unit_quaternion(&motion.quaternion());
        self.times.push(t);
        self.poses.push(Isometry3::from_parts(Translation3::new(x, y, z), attitude));
        let values = [leg as f64, vx, vy, vz, p, q, r, w1, w2, w3, w4, saturated];
        for (column, value) in self.columns.iter_mut().zip(values) {
            column.push(value);
        }
    }

    /// The track.
    pub(crate) fn into_track(self) -> Track {
        let channels =
            NAMES.into_iter().zip(self.columns).map(|(name, values)| Channel { name: name.into(), values }).collect();
        Track::new(self.times, self.poses, channels).expect("our own samples are finite and in order")
    }
}
