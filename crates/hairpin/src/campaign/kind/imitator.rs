//! Runs that logs are imitated by, and the signs that both are compared by.

use super::{Order, Same};
use crate::simulation::SimulationError;
use crate::trajectory::Flight;

/// A log of a motion over the ground: when, s from its begin, and x, y (m) and ψ (rad, not wrapped) then.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::campaign) struct GroundLog {
    pub(in crate::campaign) times: Vec<f64>,
    pub(in crate::campaign) places: Vec<[f64; 3]>,
}

/// What a kind gives for fits by imitation: one nominal vehicle, and the missions of all logs.
pub(in crate::campaign) trait Imitator: Sync {
    /// Carries out mission number `at` as [`super::Act::run`] does, by `vehicle`, with so many times the usual noise in
    /// the controller's eyes.
    ///
    /// # Errors
    /// As of that.
    fn run(&self, vehicle: Same, at: usize, order: &Order, noise: f64) -> Result<Flight, SimulationError>;

    /// Numbers that tell of a vehicle, of logs of all missions in their order: always as many, in one order. `None` of
    /// logs that are too short for that.
    fn signs(&self, logs: &[GroundLog]) -> Option<Vec<f64>>;

    /// Where to begin, for logs that have these signs: values of all numbers of [`super::Fittable`], in their order,
    /// which are `given` as the robot has them.
    fn starts(&self, signs: &[f64], given: &[f64]) -> Vec<Vec<f64>>;

    /// Variances of what is independent from sample to sample in logs that have these signs: of x or y, m², and of ψ,
    /// rad².
    fn scatter(&self, signs: &[f64]) -> [f64; 2];
}
