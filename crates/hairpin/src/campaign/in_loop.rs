//! Executions that a search asks for: one nominal run of a plan, in our own simulator.

use super::graph::Plan;
use super::judge::measures_of;
use super::learn::{LegSample, samples_of};
use super::{Case, Setup, execute_run};
use crate::judgement::Measures;
use crate::search::in_loop::Trial;

/// Executes `plan` of graph number `graph` once; `None` where the simulator or the judge refuses.
pub(super) fn execute(setup: &Setup, graph: u64, plan: &Plan) -> Option<Trial> {
    trial(setup, &measured(setup, graph, plan)?.1)
}

/// The same, with what there is to learn from it as trajectory number `trajectory`.
pub(super) fn execute_and_learn(
    setup: &Setup,
    graph: u64,
    plan: &Plan,
    trajectory: usize,
) -> Option<(Trial, Vec<LegSample>)> {
    let (case, measures) = measured(setup, graph, plan)?;
    let mut samples = samples_of(&case, &measures, setup.scenario.search().stress);
    samples.iter_mut().for_each(|sample| sample.trajectory = trajectory);
    Some((trial(setup, &measures)?, samples))
}

fn measured(setup: &Setup, graph: u64, plan: &Plan) -> Option<(Case, Measures)> {
    let case = plan.clone().case(setup.scenario.seed(), graph, 0);
    let run = execute_run(setup, &case, 0);
    let measures = measures_of(setup, &case, &run)?;
    Some((case, measures))
}

fn trial(setup: &Setup, measures: &Measures) -> Option<Trial> {
    let stress = setup.scenario.search().stress;
    let worst_leg = stress.worst_leg(measures).unwrap_or(0);
    Some(Trial { stress: stress.of(measures)?, worst_leg })
}
