//! What is flown: one run of a case, with the values of `[vary]` that were drawn for it.

use nalgebra::{Point3, Vector3};

use super::{Case, Mistake, Setup, plan, vary};
use crate::math::random::named_seed;

/// Planned time per waypoint after which a run is given up, s: what the paper's authors charged.
const SECONDS_PER_WAYPOINT: f64 = 9.0;

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

/// One run of a case, as it is flown: by our simulator or by an executor of the user's.
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

/// Run number `run` of `case`. A pure function of the scenario and the case's seed.
///
/// # Errors
/// A drawn value that is out of its key's bounds in combination with the others.
pub fn mission(setup: &Setup, case: &Case, run: usize) -> Result<Mission, Mistake> {
    let drawn = vary::draw(&setup.scenario, case.seed, run);
    let varied = if drawn.is_empty() { setup.clone() } else { setup.of_draw(vary::apply(&setup.scenario, &drawn)?)? };
    let execute = &varied.scenario.execute;
    let time_limit = execute.time_limit_s.unwrap_or(SECONDS_PER_WAYPOINT * case.waypoints.len() as f64);
    Ok(Mission {
        case: case.id(),
        run,
        seed: named_seed(case.seed, "run", run as u64),
        drawn,
        waypoints: case.waypoints.clone(),
        accept: execute.accept_m,
        time_limit,
        timed: plan::timed(case),
        setup: varied,
    })
}
