//! Executions that a search asks for: one nominal run of a plan, in our own simulator.

use super::graph::Plan;
use super::judge::measures_of;
use super::{Setup, execute_run};
use crate::search::in_loop::Trial;

/// Executes `plan` of graph number `graph` once; `None` where the simulator or the judge refuses.
pub(super) fn execute(setup: &Setup, graph: u64, plan: &Plan) -> Option<Trial> {
    let stress = setup.scenario.search().stress;
    let case = plan.clone().case(setup.scenario.seed(), graph, 0);
    let run = execute_run(setup, &case, 0);
    let measures = measures_of(setup, &case, &run)?;
    let worst_leg = stress.worst_leg(&measures).unwrap_or(0);
    Some(Trial { stress: stress.of(&measures)?, worst_leg })
}
