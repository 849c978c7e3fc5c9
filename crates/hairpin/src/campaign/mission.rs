//! What is flown: the planned track of a case, and the mission that an executor of the user's is handed.

use nalgebra::{Point3, Vector3};

use super::Setup;

/// One sample of the planned motion.
#[derive(Debug, Clone, PartialEq)]
pub struct Timed {
    /// Stamp, s.
    pub t: f64,
    /// Position, m.
    pub position: Point3<f64>,
    /// Velocity, m/s.
    pub velocity: Vector3<f64>,
}

/// One run of a case, as an executor of the user's gets it.
#[derive(Debug, Clone)]
pub struct Mission {
    /// The case's name in files.
    pub case: String,
    /// 0: nominal.
    pub run: usize,
    /// The run's seed.
    pub seed: u64,
    /// Scenario of this run: the drawn values of `[vary]` are in it.
    pub setup: Setup,
    /// Values drawn for this run, by key.
    pub drawn: Vec<(String, serde_json::Value)>,
    /// Both ends included, m, world frame.
    pub waypoints: Vec<Point3<f64>>,
    /// A waypoint counts as reached inside this radius, m.
    pub accept: f64,
    /// Time limit, s.
    pub time_limit: f64,
    /// The planned motion, for those who track it.
    pub timed: Vec<Timed>,
}
