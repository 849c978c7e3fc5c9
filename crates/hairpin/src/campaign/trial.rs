//! Executions that a search asks for: one nominal run of a plan, or of a part of one, in our own simulator.

use super::graph::Plan;
use super::judge::measures_of;
use super::kind::Order;
use super::learn::LegSample;
use super::mission::run_seed;
use super::placement::Placement;
use super::samples::samples_of;
use super::select::behaviour;
use super::{Case, CaseNumber, Environment, Run, Setup, execute_again, execute_run};
use crate::judgement::{Measures, Stress};
use crate::search::in_loop::{self, Trial};
use crate::search::worst::Ran;
use crate::simulation::Airborne;

/// Numbers of the noise that stress is confirmed under begin here: no run and no re-run of a violation has the same.
const CONFIRMING: usize = 1 << 20;

/// A plan that was carried out, and what was measured.
struct Executed {
    case: Case,
    run: Run,
    measures: Measures,
}

/// Executes `plan` of graph number `graph`; `None` where the simulator or the judge refuses. What comes to the stress
/// `least` is executed `confirm` times more, under noise, and its stress is the mean; NaN where one of those fails.
pub(super) fn execute(setup: &Setup, graph: u64, plan: &Plan, least: f64) -> Option<Trial> {
    let executed = executed(setup, graph, plan)?;
    let first = stressed(setup, &executed)?;
    let confirm = setup.scenario.search().confirm;
    if confirm == 0 || first.stress.is_nan() || first.stress < least {
        return Some(first);
    }
    let again = |number: u64| {
        let case = executed.case.clone();
        let run = execute_again(setup, &case, 0, CONFIRMING + number as usize);
        let measures = measures_of(setup, &case, &run)?;
        Some(stressed(setup, &Executed { case, run, measures })?.stress)
    };
    let sum = (0..confirm).try_fold(first.stress, |sum, number| Some(sum + again(number)?));
    let stress = sum.map_or(f64::NAN, |sum| sum / (1 + confirm) as f64);
    Some(Trial { stress, executions: 1 + confirm, ..first })
}

/// Executes `plan` of the graph with its number and measures it by each of `stresses`, NaN where one was not measured;
/// with what tells the execution from others. What comes to the `least` of one of them is executed `confirm` times more,
/// under noise, and its stresses are the means.
pub(super) fn execute_for(
    setup: &Setup,
    (graph, plan): (u64, &Plan),
    stresses: &[Stress],
    least: &[f64],
) -> Option<Ran> {
    let executed = executed(setup, graph, plan)?;
    let measured = |stress: &Stress, measures: &Measures| stress.of(measures).unwrap_or(f64::NAN);
    let trial = |stress: &Stress| Trial {
        stress: measured(stress, &executed.measures),
        worst_leg: stress.worst_leg(&executed.measures).unwrap_or(0),
        executions: 1,
    };
    let mut trials: Vec<Trial> = stresses.iter().map(trial).collect();
    let confirm = setup.scenario.search().confirm;
    if confirm > 0 && trials.iter().zip(least).any(|(trial, least)| trial.stress >= *least) {
        for number in 0..confirm {
            let measures = again(setup, &executed.case, number);
            for (trial, stress) in trials.iter_mut().zip(stresses) {
                trial.stress += measures.as_ref().map_or(f64::NAN, |measures| measured(stress, measures));
            }
        }
        for trial in &mut trials {
            (trial.stress, trial.executions) = (trial.stress / (1 + confirm) as f64, 1 + confirm);
        }
    }
    Some(Ran { trials, behaviour: behaviour(&executed.measures) })
}

/// The measures of confirmation number `number` of `case`.
fn again(setup: &Setup, case: &Case, number: u64) -> Option<Measures> {
    measures_of(setup, case, &execute_again(setup, case, 0, CONFIRMING + number as usize))
}

/// The stress of an execution. Where obstacles are to be placed, it is how deep the robot gets into those that could
/// stand in its way.
fn stressed(setup: &Setup, executed: &Executed) -> Option<Trial> {
    let own = trial(setup, &executed.measures);
    let Some(Placement { clearance, leg, .. }) = placement(setup, executed) else { return own };
    let worst_leg = leg.min(executed.case.waypoints.len().saturating_sub(2));
    let placed = Trial { stress: -clearance, worst_leg, executions: 1 };
    own.filter(|own| own.stress >= placed.stress).or(Some(placed))
}

/// The same, with what there is to learn from it as trajectory number `trajectory`.
pub(super) fn execute_and_learn(
    setup: &Setup,
    graph: u64,
    plan: &Plan,
    trajectory: usize,
) -> Option<(Trial, Vec<LegSample>)> {
    let Executed { case, measures, .. } = executed(setup, graph, plan)?;
    let mut samples = samples_of(&case, &measures, setup.scenario.search().stress);
    samples.iter_mut().for_each(|sample| sample.trajectory = trajectory);
    Some((trial(setup, &measures)?, samples))
}

/// Whether a part of a trajectory can be executed from where its beginning has led: where controllers know of one
/// waypoint at a time.
pub(super) fn resumes(setup: &Setup) -> bool {
    setup.kind().leg_by_leg().is_some()
}

/// Executes `plan`, the first waypoints of a trajectory of graph number `graph`, or all where it is `whole`: on from
/// `before` or from the start; the same as [`execute`] once it is whole. Where executions do not [resume](resumes),
/// `plan` is carried out as if it were all.
///
/// # Errors
/// Legs that were executed for nothing.
pub(super) fn execute_partial(
    setup: &Setup,
    graph: u64,
    plan: &Plan,
    before: Option<&Airborne>,
    whole: bool,
) -> Result<in_loop::Ran<Airborne>, u64> {
    let legs = plan.waypoints.len() as u64 - 1;
    let Some(flying) = setup.kind().leg_by_leg() else {
        let stress = executed(setup, graph, plan).and_then(|executed| trial(setup, &executed.measures));
        return Ok(in_loop::Ran { stress: stress.ok_or(legs)?.stress, state: None, legs });
    };
    let case = plan.clone().case(setup.scenario.seed(), graph, 0);
    let mut airborne = match before {
        Some(before) => before.clone(),
        None => {
            let executor = setup.scenario.executor();
            let length = setup.scenario.length().unwrap_or_default() as usize;
            let order = Order {
                waypoints: &case.waypoints,
                accept: executor.accept,
                time_limit: executor.patience.time_limit(length, 0.0),
                seed: run_seed(case.seed, 0),
            };
            flying.at_start(&order).map_err(|_| legs)?
        }
    };
    let mut flown = 0;
    for waypoint in &case.waypoints[airborne.waypoints()..] {
        flown += u64::from(!airborne.ended());
        flying.fly_to(&mut airborne, *waypoint).map_err(|_| flown)?;
    }
    if whole {
        flying.finish(&mut airborne).map_err(|_| flown)?;
    }
    let run = Run { case: CaseNumber::default(), run: 0, drawn: Vec::new(), outcome: Ok(airborne.so_far()) };
    let stress = measures_of(setup, &case, &run).and_then(|measures| setup.scenario.search().stress.of(&measures));
    Ok(in_loop::Ran { stress: stress.unwrap_or(f64::NAN), state: Some(airborne), legs: flown })
}

/// How long the execution of `plan` takes, s.
pub(super) fn duration(setup: &Setup, graph: u64, plan: &Plan) -> Option<f64> {
    executed(setup, graph, plan).map(|executed| executed.measures.total_time)
}

/// `plan` with the obstacles that are asked for, and its execution among them; as it is where none are. `None` where
/// there is no room for any.
pub(super) fn furnish(setup: &Setup, graph: u64, plan: &Plan) -> Option<(Plan, Trial)> {
    let Placement { among, .. } = placement(setup, &executed(setup, graph, plan)?)?;
    let plan = Plan { environment: Some(among), ..plan.clone() };
    let among = executed(setup, graph, &plan)?;
    Some((plan, trial(setup, &among.measures)?))
}

fn executed(setup: &Setup, graph: u64, plan: &Plan) -> Option<Executed> {
    let case = plan.clone().case(setup.scenario.seed(), graph, 0);
    let run = execute_run(setup, &case, 0);
    let measures = measures_of(setup, &case, &run)?;
    Some(Executed { case, run, measures })
}

/// Where the obstacles that are asked for, and not there yet, would stand.
fn placement(setup: &Setup, executed: &Executed) -> Option<Placement> {
    let Executed { case, run, .. } = executed;
    let wanted = setup.scenario.search().stress == Stress::Clearance;
    let furnished = case.environment.as_ref().is_some_and(Environment::is_furnished);
    let track = &run.outcome.as_ref().ok().filter(|_| wanted && !furnished)?.track;
    setup.kind().place(case, track)
}

fn trial(setup: &Setup, measures: &Measures) -> Option<Trial> {
    let stress = setup.scenario.search().stress;
    let worst_leg = stress.worst_leg(measures).unwrap_or(0);
    Some(Trial { stress: stress.of(measures)?, worst_leg, executions: 1 })
}
