//! What is flown or driven: one run of a case, with the values of `[vary]` that were drawn for it.
//!
//! Data flow: case and run number → draws of `[vary]` (one stream a parameter, case and run) → the setup with these
//! values → waypoints, times and limits as an executor gets them. Draws change the robot that carries the mission
//! out, never the plan.

use nalgebra::Point3;

use super::kind::PlanError;
use super::{Case, Mistake, Setup, Timed, vary};
use crate::math::random::named_seed;
use crate::trajectory::Track;

/// The planned motion with the channels `leg`, `vx_m_s`, `vy_m_s`, `vz_m_s`: of flights at 100 Hz, of drives step by
/// step of its prediction on the ground, of programs as the virtual controller plans them.
///
/// # Errors
/// A case whose numbers are no motion, as a folder that was edited may hold.
pub fn planned(setup: &Setup, case: &Case) -> Result<Track, PlanError> {
    setup.kind().planned(case)
}

/// The rows of the planned motion where it bends, and the time between its samples, s, of a plan that says where that
/// is: straight legs bend where they meet. `None`: they are found in the [`planned`] motion.
///
/// # Errors
/// As of [`planned`].
pub fn planned_rows(setup: &Setup, case: &Case) -> Result<Option<(Track, f64)>, PlanError> {
    setup.kind().planned_rows(case)
}

/// One run of a case, as it is flown: by our simulator or by an executor of the user's.
///
/// What the executor protocol sends, and all that our simulator is told. SI units, world frame.
#[derive(Debug, Clone)]
pub struct Mission {
    /// The case's name in files.
    /// `0117`.
    pub case: String,
    /// 0: nominal.
    pub run: usize,
    /// The run's seed.
    /// named_seed(case's seed, "run", run).
    pub seed: u64,
    /// Scenario of this run: the drawn values of `[vary]` are in it.
    pub setup: Setup,
    /// Values drawn for this run, by key.
    pub drawn: Vec<(String, serde_json::Value)>,
    /// Both ends included, m, world frame.
    pub waypoints: Vec<Point3<f64>>,
    /// The planned heading at each waypoint, rad from x towards y; empty where there is none.
    pub yaws: Vec<f64>,
    /// A waypoint counts as reached inside this radius, m.
    pub accept: f64,
    /// Time limit, s.
    /// From the number of waypoints, the plan's duration and the way, by the scenario's patience; a run that comes to
    /// it ends as `time`.
    pub time_limit: f64,
    /// The planned motion, for those who track it.
    /// Empty where nothing is planned in time.
    pub timed: Vec<Timed>,
}

/// Run number `run` of `case` once more, for the time number `again`, with other noise: what was drawn for `[vary]`
/// stays, the noise of the robot's own densities is on whether or not it is in the scenario, and its seed is another.
///
/// # Errors
/// As [`mission`].
pub fn mission_again(setup: &Setup, case: &Case, run: usize, again: usize) -> Result<Mission, Mistake> {
    let mut scenario = setup.scenario.clone();
    scenario.set_noisy();
    let seed = named_seed(named_seed(case.seed, "rerun", run as u64), "again", again as u64);
    Ok(Mission { seed, ..mission(&setup.of_draw(scenario)?, case, run)? })
}

/// Run number `run` of `case`. A pure function of the scenario and the case's seed.
///
/// # Errors
/// A drawn value that is out of its key's bounds in combination with the others.
///
/// Run 0 is nominal: nothing is drawn for it.
pub fn mission(setup: &Setup, case: &Case, run: usize) -> Result<Mission, Mistake> {
    let around = setup.around(case)?;
    let setup = around.as_ref();
    let drawn = vary::draw(&setup.scenario, case.seed, run);
    let varied = if drawn.is_empty() { setup.clone() } else { setup.drawn(&drawn)? };
    // The plan is the nominal robot's, whatever was drawn for the one that carries it out.
    let timed = if case.leg_times.is_empty() { Vec::new() } else { setup.kind().timed(case) };
    let yaws = setup.kind().headings(case);
    let executor = varied.scenario.executor();
    let (waypoints, planned) = (case.waypoints.len(), setup.kind().planned_s(&timed));
    let slowest = varied.kind().slowest(&case.waypoints, waypoints, planned);
    let time_limit = executor.patience.time_limit(waypoints, planned, slowest);
    let accept = executor.accept;
    Ok(Mission {
        case: case.id(),
        run,
        seed: run_seed(case.seed, run),
        drawn,
        waypoints: case.waypoints.clone(),
        yaws,
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
