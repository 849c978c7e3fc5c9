//! What is flown or driven: one run of a case, with the values of `[vary]` that were drawn for it.

use nalgebra::Point3;

use super::flight::FlightSetup;
use super::planned::timed;
use super::setup::Kind;
use super::{Case, Mistake, Scenario, Setup, Timed, vary};
use crate::math::random::named_seed;

/// Time per waypoint after which a flight is given up, s: what the paper's authors charged.
const SECONDS_PER_WAYPOINT: f64 = 9.0;
/// A drive is given up after this multiple of its planned duration …
const SLOWNESS: f64 = 2.0;
/// … and this time, s.
const SPARE_SECONDS: f64 = 60.0;

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

/// Run number `run` of `case` once more, for the time number `again`, with other noise: what was drawn for `[vary]`
/// stays, the noise of the robot's own densities is on whether or not it is in the scenario, and its seed is another.
///
/// # Errors
/// As [`mission`].
pub fn mission_again(setup: &Setup, case: &Case, run: usize, again: usize) -> Result<Mission, Mistake> {
    let mut scenario = setup.scenario.clone();
    match &mut scenario {
        Scenario::Flight(scenario) => scenario.execute.noise = true,
        Scenario::Drive(scenario) => scenario.execute.noise = true,
        // The virtual controller has noise of its own.
        Scenario::Arm(_) => {}
    }
    let seed = named_seed(named_seed(case.seed, "rerun", run as u64), "again", again as u64);
    Ok(Mission { seed, ..mission(&setup.of_draw(scenario)?, case, run)? })
}

/// Run number `run` of `case`. A pure function of the scenario and the case's seed.
///
/// # Errors
/// A drawn value that is out of its key's bounds in combination with the others.
pub fn mission(setup: &Setup, case: &Case, run: usize) -> Result<Mission, Mistake> {
    let around = setup.around(case)?;
    let setup = around.as_ref();
    let drawn = vary::draw(&setup.scenario, case.seed, run);
    let varied = if drawn.is_empty() { setup.clone() } else { setup.of_draw(vary::apply(&setup.scenario, &drawn)?)? };
    // The plan is the nominal robot's, whatever was drawn for the one that carries it out.
    let timed = timed(setup, case);
    let time_limit = match varied.kind() {
        Kind::Flight(setup) => flight_time_limit(&setup, case.waypoints.len()),
        Kind::Drive(setup) => {
            let planned = timed.last().map_or(0.0, |last| last.t);
            setup.scenario.execute.time_limit_s.unwrap_or(SLOWNESS * planned + SPARE_SECONDS)
        }
        // The virtual controller's runs end with their program.
        Kind::Arm(_) => f64::INFINITY,
    };
    let accept = varied.scenario.executor().accept;
    Ok(Mission {
        case: case.id(),
        run,
        seed: run_seed(case.seed, run),
        drawn,
        waypoints: case.waypoints.clone(),
        accept,
        time_limit,
        timed,
        setup: varied,
    })
}

/// The seed of run number `run` of a case.
pub(super) fn run_seed(case_seed: u64, run: usize) -> u64 {
    named_seed(case_seed, "run", run as u64)
}

/// Time limit of a flight over so many waypoints, s.
pub(super) fn flight_time_limit(setup: &FlightSetup, waypoints: usize) -> f64 {
    setup.scenario.execute.time_limit_s.unwrap_or(SECONDS_PER_WAYPOINT * waypoints as f64)
}
