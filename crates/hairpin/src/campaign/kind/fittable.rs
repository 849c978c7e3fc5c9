//! What of a robot's closed loop logs may tell.
//!
//! What [`crate::campaign::fit`] needs to know of a kind: numbers with their bounds and steps, outputs with their
//! units, and from which sampling on they can be told.

use serde_json::Value;

use crate::simulation::Acceptance;

/// A number of a robot, or of who steers it, that is adjusted until its simulation is nearest to logs.
///
/// One entry of θ. Its derivative is the central difference over [`Self::step`], by simulating twice.
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
    /// In [`Self::unit`].
    pub value: f64,
    /// What it may be.
    /// The search stays within; an estimate at a bound has no interval.
    pub bounds: [f64; 2],
    /// Half of the difference that derivatives are taken over.
    pub step: f64,
    /// Another value to begin a search at.
    pub other: f64,
    /// Why its interval is not believed, where on drawn robots it did not hold: what is found is shown, and not told.
    pub doubt: Option<&'static str>,
}

/// An output of a motion, which a simulation and a log have.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::campaign) enum Output {
    /// Of the body's origin, or the tool's point, along a world axis, m.
    Position(usize),
    /// Likewise, m/s.
    Velocity(usize),
    /// Of the first axis of the body the part along the second, of the world.
    Axis(usize, usize),
    /// Mean of the squares of all rotors' speeds, rad²/s².
    Thrust,
    /// Angle of an axis of an arm, from 0, rad.
    Joint(usize),
}

/// How long and how often logs are compared.
///
/// What a log must have in order to be compared, and how its samples are weighed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::campaign) struct Sampling {
    /// Shortest motion of a log, s.
    pub(in crate::campaign) least_s: f64,
    /// Least samples of a log in a second.
    pub(in crate::campaign) least_hz: f64,
    /// Samples are compared so often, s.
    pub(in crate::campaign) period: f64,
    /// A log's length in stretches as good as independent, s: what disturbs, and the loop that answers it, are over.
    pub(in crate::campaign) stretch: f64,
    /// Whether stretches are of whole legs.
    pub(in crate::campaign) whole_legs: bool,
    /// A log may begin so far from the first waypoint, m; within the radius of a waypoint if not given.
    pub(in crate::campaign) start_m: Option<f64>,
}

/// Numbers, and how missions are carried out and compared while they are fitted.
///
/// `numbers` and `outputs` are those that the kind can tell at all; which of them logs determine is settled by their
/// sensitivities.
#[derive(Debug, Clone)]
pub(in crate::campaign) struct Fittable {
    /// Keys with values that leave out whatever is drawn by chance.
    pub(in crate::campaign) calm: Vec<(String, Value)>,
    /// Keys of the robot as it is, written out so that single numbers of them can be adjusted.
    pub(in crate::campaign) spelt: Vec<(String, Value)>,
    /// Whether what the robot leaves out is derived from its other numbers.
    pub(in crate::campaign) derives: bool,
    /// What is adjusted.
    pub(in crate::campaign) numbers: Vec<Adjustable>,
    /// What is compared, of what logs have; outputs of one number have one standard deviation.
    pub(in crate::campaign) outputs: &'static [(Output, usize)],
    /// World axes in which the gap is told.
    pub(in crate::campaign) axes: usize,
    /// What may be between the logs' scatter and what a fit leaves, of which the intervals do not tell: to be read
    /// after "whether".
    pub(in crate::campaign) undescribed: &'static str,
    /// Unit of the gap, and so many of it in a metre.
    pub(in crate::campaign) unit: (&'static str, f64),
    /// How long and how often.
    pub(in crate::campaign) sampling: Sampling,
    /// Where a waypoint counts as reached.
    pub(in crate::campaign) acceptance: Acceptance,
    /// Drawn robots, and who steered them, on which intervals were found to hold.
    pub(in crate::campaign) tried: &'static str,
    /// Who steers, where intervals were never tried on anything that it steers: its name.
    pub(in crate::campaign) untried: Option<&'static str>,
    /// Whether motions are compared by the clock from their begin, not from waypoint to waypoint.
    pub(in crate::campaign) timed: bool,
}
