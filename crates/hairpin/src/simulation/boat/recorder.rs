//! The log of a run: poses and channels in columns.

use nalgebra::{Isometry3, Translation3};

use super::plant::BoatPlant;
use crate::math::rotation::{quaternion_from_euler, unit_quaternion};
use crate::trajectory::{Channel, Track};

/// Velocities `v…` over ground in the map's frame; `surge`, `sway` and `r` through the water in the body's; forces as
/// the thrusters give them. `vz_m_s` is 0.
const CHANNELS: [&str; 11] = [
    "leg",
    "vx_m_s",
    "vy_m_s",
    "vz_m_s",
    "surge_m_s",
    "sway_m_s",
    "r_rad_s",
    "surge_n",
    "sway_n",
    "yaw_n_m",
    "thrust_at_limit",
];

/// Columns being filled.
#[derive(Debug, Clone, Default)]
pub(super) struct Recorder {
    times: Vec<f64>,
    poses: Vec<Isometry3<f64>>,
    columns: [Vec<f64>; CHANNELS.len()],
}

impl Recorder {
    /// Appends a sample; one that is not finite or not later than the last is left out.
    ///
    /// `thrust_at_limit` is taken from the plant, which begins to count anew.
    pub(super) fn push(&mut self, t: f64, plant: &mut BoatPlant, leg: usize) {
        if self.times.last().is_some_and(|last| t <= *last) || !plant.is_finite() {
            return;
        }
        let (at, over_ground) = (plant.position(), plant.over_ground());
        let (nu, thrust) = (plant.through_water(), plant.thrust());
        let attitude = unit_quaternion(&quaternion_from_euler(0.0, 0.0, plant.heading()));
        self.times.push(t);
        self.poses.push(Isometry3::from_parts(Translation3::new(at.x, at.y, 0.0), attitude));
        let saturated = plant.take_saturated();
        let values = [leg as f64, over_ground.x, over_ground.y, 0.0, nu.x, nu.y, nu.z, thrust.x, thrust.y, thrust.z];
        for (column, value) in self.columns.iter_mut().zip(values.into_iter().chain([saturated])) {
            column.push(value);
        }
    }

    /// The track.
    pub(super) fn into_track(self) -> Track {
        let named = CHANNELS.into_iter().zip(self.columns);
        let channels = named.map(|(name, values)| Channel { name: name.into(), values }).collect();
        Track::new(self.times, self.poses, channels).expect("our own samples are finite and in order")
    }
}
