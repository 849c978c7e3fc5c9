//! The log of a drive: poses and channels in columns.

use nalgebra::Isometry3;

use super::plant::{Lost, Plant, Stands};
use crate::robot::rover::{Rover, Suspension};
use crate::trajectory::{Channel, Track};

/// Columns being filled.
#[derive(Debug, Clone)]
pub(super) struct Recorder {
    times: Vec<f64>,
    poses: Vec<Isometry3<f64>>,
    channels: Vec<Channel>,
    crabs: bool,
    weighs: bool,
}

/// Velocities of the body's origin in the map's frame; speed of the wheels, negative in reverse; the curvature of the
/// wheels and the one that was commanded.
const MOTION: [&str; 7] =
    ["leg", "vx_m_s", "vy_m_s", "vz_m_s", "speed_m_s", "curvature_1_m", "commanded_curvature_1_m"];
const DIRECTION: [&str; 1] = ["travel_direction_rad"];
const TORQUE: [&str; 1] = ["wheel_torque_n_m"];
/// The worst since the sample before, not that of the moment.
const STANDING: [&str; 2] = ["tip_over_margin_deg", "belly_clearance_m"];
const JOINTS: [&str; 3] = ["joint_rocker_rad", "joint_left_bogie_rad", "joint_right_bogie_rad"];

impl Recorder {
    /// With the channels that `vehicle` has: what a point without wheels cannot tell is left out, the direction of
    /// travel where nothing `crabs`, and torques where nothing weighs.
    pub(super) fn new(vehicle: &Rover, crabs: bool) -> Self {
        let standing: &[&str] = if vehicle.suspension == Suspension::Level { &[] } else { &STANDING };
        let joints: &[&str] = if matches!(vehicle.suspension, Suspension::RockerBogie(_)) { &JOINTS } else { &[] };
        let direction: &[&str] = if crabs { &DIRECTION } else { &[] };
        let weighs = vehicle.weight.is_some();
        let torque: &[&str] = if weighs { &TORQUE } else { &[] };
        let names = MOTION.iter().chain(&["slip"]).chain(direction).chain(torque).chain(standing).chain(joints);
        let channels = names.map(|name| Channel { name: (*name).into(), values: vec![] }).collect();
        Self { times: vec![], poses: vec![], channels, crabs, weighs }
    }

    /// Appends a sample; one that is not later than the last is left out. `least` is the worst since the sample before.
    ///
    /// Only a margin that was not looked at yet is asked of the plant, which may have lost the ground: [`Lost`].
    ///
    /// # Errors
    /// The ground was lost where the margin had to be asked.
    pub(super) fn push(
        &mut self,
        t: f64,
        plant: &Plant,
        leg: usize,
        commanded: f64,
        least: &Stands,
    ) -> Result<(), Lost> {
        if self.times.last().is_some_and(|last| t <= *last) {
            return Ok(());
        }
        let v = plant.velocity();
        let mut values = vec![leg as f64, v.x, v.y, v.z, plant.speed, plant.curvature(), commanded, plant.slip()];
        if self.crabs {
            values.push(plant.direction);
        }
        if self.weighs {
            values.push(plant.torque().unwrap_or(0.0));
        }
        if self.channels.len() > values.len() {
            let least = if least.margin.is_finite() { *least } else { plant.stands()? };
            values.extend([least.margin.to_degrees(), least.clearance]);
        }
        if self.channels.len() > values.len() {
            values.extend(plant.pose.joints);
        }
        self.times.push(t);
        self.poses.push(plant.world_from_body());
        for (channel, value) in self.channels.iter_mut().zip(values) {
            channel.values.push(value);
        }
        Ok(())
    }

    /// The track.
    ///
    /// With channels named by unit, in the order of [`MOTION`], slip and what follows.
    pub(super) fn into_track(self) -> Track {
        Track::new(self.times, self.poses, self.channels).expect("our own samples are finite and in order")
    }
}
