//! The log of a run: poses and channels at a fixed rate, in columns that are allocated once.
//!
//! Columns are the judge's and the files' (names with units). Copies of a run in mid-air share the log of what they
//! flew together.

use std::sync::Arc;

use nalgebra::{Isometry3, Translation3};

use super::plant::Plant;
use super::step::Motion;
use crate::math::rotation::unit_quaternion;
use crate::trajectory::{Channel, Track};

/// `leg`, those of the plant, `saturated`.
const COLUMNS: usize = Plant::CHANNELS.len() + 2;

/// A part of the log.
#[derive(Debug, Clone, Default)]
struct Samples {
    times: Vec<f64>,
    poses: Vec<Isometry3<f64>>,
    columns: [Vec<f64>; COLUMNS],
}

/// Columns being filled, and earlier parts of the log, which copies share.
#[derive(Debug, Clone)]
pub(crate) struct Recorder {
    /// In the order in which they were flown; never changed.
    sealed: Vec<Arc<Samples>>,
    open: Samples,
    /// Time of the last sample, s, whichever part it is in.
    last: Option<f64>,
}

/// Samples that a log is allocated for at once; longer ones grow.
const MOST_AT_ONCE: usize = 1 << 16;

impl Recorder {
    /// For about `samples` samples.
    pub(crate) fn new(samples: usize) -> Self {
        let room = samples.min(MOST_AT_ONCE);
        let open = Samples {
            times: Vec::with_capacity(room),
            poses: Vec::with_capacity(room),
            columns: std::array::from_fn(|_| Vec::with_capacity(room)),
        };
        Self { sealed: Vec::new(), open, last: None }
    }

    /// Lets copies made from now on share what was logged so far.
    ///
    /// Costs one shrink; a copy made then costs as little as its open part, however long the flight was.
    pub(crate) fn seal(&mut self) {
        let mut samples = std::mem::take(&mut self.open);
        if samples.times.is_empty() {
            return;
        }
        samples.times.shrink_to_fit();
        samples.poses.shrink_to_fit();
        samples.columns.iter_mut().for_each(Vec::shrink_to_fit);
        self.sealed.push(Arc::new(samples));
    }

    /// Appends a sample; one that is not finite or not later than the last is left out.
    pub(crate) fn push(&mut self, t: f64, motion: &Motion, leg: usize, saturated: f64) {
        if self.last.is_some_and(|last| t <= last) || !motion.is_finite() {
            return;
        }
        let [[x, y, z, _], [vx, vy, vz, _], [p, q, r, _], [w1, w2, w3, w4]] = motion.logged();
        let attitude = unit_quaternion(&motion.quaternion());
        self.last = Some(t);
        self.open.times.push(t);
        self.open.poses.push(Isometry3::from_parts(Translation3::new(x, y, z), attitude));
        let values = [leg as f64, vx, vy, vz, p, q, r, w1, w2, w3, w4, saturated];
        for (column, value) in self.open.columns.iter_mut().zip(values) {
            column.push(value);
        }
    }

    /// The track.
    ///
    /// O(samples); parts are joined only here.
    pub(crate) fn into_track(self) -> Track {
        let Samples { times, poses, columns } = match self.sealed.is_empty() {
            true => self.open,
            false => self.joined(),
        };
        let names = std::iter::once("leg").chain(Plant::CHANNELS).chain(["saturated"]);
        let channels = names.zip(columns).map(|(name, values)| Channel { name: name.into(), values }).collect();
        Track::new(times, poses, channels).expect("our own samples are finite and in order")
    }

    /// Parts in the order they were flown.
    fn joined(&self) -> Samples {
        let mut all = Samples::default();
        for part in self.sealed.iter().map(Arc::as_ref).chain([&self.open]) {
            all.times.extend(&part.times);
            all.poses.extend(&part.poses);
            for (column, values) in all.columns.iter_mut().zip(&part.columns) {
                column.extend(values);
            }
        }
        all
    }
}
