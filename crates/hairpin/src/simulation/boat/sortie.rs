//! What sails where, under which conditions, and how a run is ended and logged.

use nalgebra::Point3;

use crate::robot::boat::Boat;
use crate::simulation::SimulationError;
use crate::trajectory::Profile;
use crate::world::terrain::KeepOuts;

/// What sails where.
#[derive(Debug, Clone, Copy)]
pub struct BoatSortie<'a> {
    /// The boat.
    pub boat: &'a Boat,
    /// As it was planned with, which controllers know.
    pub nominal: &'a Boat,
    /// The waters reach from (0, 0) to here, m.
    pub size: [f64; 2],
    /// Where it must not come, with its disc.
    pub keep_outs: &'a KeepOuts,
    /// Both ends included, m, at z = 0, at least two. The run starts at the first, lying still.
    pub waypoints: &'a [Point3<f64>],
    /// The planned motion through them: x, y and, in place of z, ψ.
    pub profile: Option<&'a Profile>,
}

impl BoatSortie<'_> {
    /// The heading that it starts with, rad: the plan's, or that of the first leg.
    pub(super) fn heading(&self) -> f64 {
        if let Some(leg) = self.profile.and_then(|profile| profile.legs.first()) {
            return leg.coefficients[2][0];
        }
        let way = self.waypoints[1] - self.waypoints[0];
        libm::atan2(way.y, way.x)
    }
}

/// Water, forces and noise of a run.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct BoatConditions {
    /// Velocity of the water, m/s, east and north.
    pub current: [f64; 2],
    /// Steady force from outside, N, east and north.
    pub external_force: [f64; 2],
    /// Whether what is measured is noisy.
    pub noise: bool,
}

/// Largest part of a current, m/s, and of a steady force, N.
const MOST_CURRENT: f64 = 100.0;
const MOST_FORCE: f64 = 1e6;

impl BoatConditions {
    pub(super) fn check(&self) -> Result<(), SimulationError> {
        if !self.current.iter().all(|part| part.abs() <= MOST_CURRENT) {
            return Err(SimulationError::new("current", format!("{:?}", self.current), "within ±100 m/s"));
        }
        if !self.external_force.iter().all(|part| part.abs() <= MOST_FORCE) {
            let value = format!("{:?}", self.external_force);
            return Err(SimulationError::new("external_force", value, "within ±1e6 N"));
        }
        Ok(())
    }
}

/// How a run is ended and logged. Numbers out of bounds are an error that names the field.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SailSettings {
    /// Time between two samples of the log, s, rounded to whole turns of the controller.
    pub log_period: f64,
    /// A waypoint counts as reached inside this radius, m.
    pub accept: f64,
    /// A run ends here, s.
    pub time_limit: f64,
    /// Time after the last waypoint that belongs to the run, s.
    pub linger: f64,
    /// Whether leaving the waters is a crash.
    pub walls: bool,
}

impl Default for SailSettings {
    fn default() -> Self {
        Self { log_period: 0.1, accept: 0.5, time_limit: 600.0, linger: 5.0, walls: false }
    }
}

impl SailSettings {
    pub(super) fn check(&self) -> Result<(), SimulationError> {
        let positive = [("log_period", self.log_period), ("accept", self.accept), ("time_limit", self.time_limit)];
        SimulationError::unless_timed(&positive, self.linger)
    }
}
