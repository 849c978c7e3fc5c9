//! What drives where, under which conditions, and how a run is simulated.

use crate::robot::rover::Rover;
use crate::simulation::SimulationError;
use crate::trajectory::Drive;
use crate::world::terrain::{ElevationMap, KeepOuts};

/// What drives where.
///
/// `nominal` has the numbers that the plan was made with, `vehicle` those that were drawn for the run.
#[derive(Debug, Clone, Copy)]
pub struct GroundSortie<'a> {
    /// The vehicle as it is: its slip, its latency and its lags act.
    pub vehicle: &'a Rover,
    /// The vehicle as it was planned with, which is all that controllers know.
    pub nominal: &'a Rover,
    /// The ground.
    pub terrain: &'a ElevationMap,
    /// Where it must not go.
    pub keep_outs: &'a KeepOuts,
    /// The body's origin keeps this far off them, m, ≥ 0.
    pub clearance_radius: f64,
    /// The plan. The run starts at rest at its first pose, or beside it.
    pub drive: &'a Drive,
}

/// What is added to the vehicle's own imperfections.
///
/// `Default` adds nothing.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct GroundConditions {
    /// A command acts this much later, s, on top of the vehicle's own latency.
    pub latency: f64,
    /// Steady force on the vehicle, at its centre of mass, N: east, north, up. The vehicle must have a weight for it.
    pub external_force: [f64; 3],
    /// Controllers see a pose with white noise of so many times 1 cm along each axis and 0.3° of yaw, standard
    /// deviations; 0: as it is.
    pub noise: f64,
    /// Where the run starts, in the frame of the plan's first pose: forward and left, m, and yaw, rad.
    pub start_offset: [f64; 3],
}

/// How a drive is simulated, ended and logged.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DriveSettings {
    /// A waypoint counts as reached inside this distance over the ground plan, m.
    pub accept: f64,
    /// A run ends here, s; `None`: at twice the plan's duration and a minute more.
    pub time_limit: Option<f64>,
    /// Time after the end of the plan that belongs to the run, s.
    pub linger: f64,
    /// A run whose plan is not over ends `stuck` if the body moves less than 1 cm and 1° in this time, s, or in twice
    /// the longest that the plan takes for that, where it is longer.
    pub patience: f64,
    /// Whether a place to keep out of that is touched ends the run.
    pub keep_outs: bool,
}

impl Default for DriveSettings {
    fn default() -> Self {
        Self { accept: 0.25, time_limit: None, linger: 1.0, patience: 30.0, keep_outs: true }
    }
}

impl DriveSettings {
    /// Radii, limits and patience finite and above 0, `linger` at least 0; errors name the field.
    pub(super) fn check(&self) -> Result<(), SimulationError> {
        let limit = self.time_limit.unwrap_or(1.0);
        let positive = [("accept", self.accept), ("time_limit", limit), ("patience", self.patience)];
        SimulationError::unless_timed(&positive, self.linger)
    }
}
