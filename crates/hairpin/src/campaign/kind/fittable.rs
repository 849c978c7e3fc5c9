//! What of a robot's closed loop logs may tell.

use serde_json::Value;

use crate::simulation::Acceptance;

/// A number of a robot, or of who steers it, that is adjusted until its simulation is nearest to logs.
#[derive(Debug, Clone, PartialEq)]
pub struct Adjustable {
    /// In words: `thrust to weight`.
    pub name: &'static str,
    /// As tables have it: `thrust_to_weight`, `drag_quadratic_n_s2_m2`.
    pub field: &'static str,
    /// `""` for a ratio.
    pub unit: &'static str,
    /// Keys of the scenario, and what each is of the number. The first is the one that it is known by.
    pub keys: Vec<(String, f64)>,
    /// As the scenario has it.
    pub value: f64,
    /// What it may be.
    pub bounds: [f64; 2],
    /// Half of the difference that derivatives are taken over.
    pub step: f64,
    /// Another value to begin a search at.
    pub other: f64,
}

/// Numbers, and how missions are carried out while they are fitted.
#[derive(Debug, Clone)]
pub(in crate::campaign) struct Fittable {
    /// Keys with values that leave out whatever is drawn by chance.
    pub(in crate::campaign) calm: Vec<(String, Value)>,
    /// What is adjusted.
    pub(in crate::campaign) numbers: Vec<Adjustable>,
    /// Where a waypoint counts as reached.
    pub(in crate::campaign) acceptance: Acceptance,
    /// Whether who steers goes by the clock, not from waypoint to waypoint.
    pub(in crate::campaign) timed: bool,
}
