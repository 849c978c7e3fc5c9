//! Flies missions in our own simulator.

use nalgebra::Vector3;
use rayon::prelude::*;

use super::{Case, Mission, Run, Stop, mission};
use crate::campaign::Setup;
use crate::simulation::{self, Conditions, ControllerKind, ControllerSettings, FlySettings, Gusts, Sortie};
use crate::trajectory::Flight;

/// Runs of `cases` that `wanted(case, run)` asks for, in our own simulator, on all threads of the current pool.
///
/// `sink` gets each run when it is done, in no particular order and from any thread. Runs are pure functions of the
/// scenario, the case's seed and the run's number.
pub fn execute(
    setup: &Setup,
    cases: &[Case],
    wanted: &(dyn Fn(usize, usize) -> bool + Sync),
    stop: &Stop,
    sink: &(dyn Fn(Run) + Sync),
) {
    let repeat = setup.scenario.execute.repeat as usize;
    let total = cases.len() * repeat;
    let todo: Vec<(&Case, usize)> = cases
        .iter()
        .flat_map(|case| (0..repeat).map(move |run| (case, run)))
        .filter(|(case, run)| wanted(case.number, *run))
        .collect();
    let done = std::sync::atomic::AtomicUsize::new(total - todo.len());
    (stop.progress)(total - todo.len(), total);
    todo.into_par_iter().for_each(|(case, run)| {
        if (stop.cancelled)() {
            return;
        }
        sink(execute_run(setup, case, run));
        (stop.progress)(1 + done.fetch_add(1, std::sync::atomic::Ordering::Relaxed), total);
    });
}

/// Run number `run` of `case` in our own simulator.
pub fn execute_run(setup: &Setup, case: &Case, run: usize) -> Run {
    match mission(setup, case, run) {
        Ok(mission) => {
            let outcome = fly(&mission, case).map_err(|error| error.to_string());
            Run { case: case.number, run, drawn: mission.drawn, outcome }
        }
        Err(mistake) => Run { case: case.number, run, drawn: Vec::new(), outcome: Err(mistake.to_string()) },
    }
}

fn fly(mission: &Mission, case: &Case) -> Result<Flight, simulation::SimulationError> {
    let Setup { scenario, robot, world, simd } = &mission.setup;
    let execute = &scenario.execute;
    let sortie = Sortie { robot, world, waypoints: &mission.waypoints, profile: case.profile.as_ref() };
    let controller = ControllerSettings {
        kind: execute.controller_in_force().unwrap_or(ControllerKind::StableWaypoint),
        fixed_velocity: execute.fixed_velocity_m_s,
        segment_times: execute.segment_times,
    };
    let conditions = Conditions {
        wind: Vector3::from(scenario.world.wind_m_s.unwrap_or_default()),
        gusts: scenario.world.gusts.map(|gusts| Gusts { std: gusts.std_m_s, correlation: gusts.correlation_s }),
        noise: execute.noise,
    };
    let settings = FlySettings {
        step: execute.step_s,
        accept: mission.accept,
        time_limit: mission.time_limit,
        walls: execute.walls,
        simd: *simd,
        ..FlySettings::default()
    };
    simulation::fly(&sortie, &controller, &conditions, &settings, mission.seed)
}
