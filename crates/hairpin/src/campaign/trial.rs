//! Executions that a search asks for: one nominal run of a plan, or of a part of one, wherever it is carried out.
//!
//! A trial is a run in every respect: the same mission, executor, judge and measures as the case will meet later, so
//! that the stress that was searched for is the one that is reported. Confirmations under noise have numbers far
//! above those of runs.

use nalgebra::Point3;

use super::execute::run_of;
use super::graph::{Plan, fingerprint};
use super::judge::{Weighed, measured};
use super::kind::Order;
use super::learn::LegSample;
use super::mission::run_seed;
use super::placement::Placement;
use super::samples::{samples_of, stresses_of};
use super::user_target::RunFacts;
use super::{Case, CaseNumber, Environment, Executor, Run, Setup, mission, mission_again};
use crate::judgement::{Measures, Stress};
use crate::math::random::{case_seed, named_seed};
use crate::search::in_loop::{self, Rank, Trial};
use crate::search::worst::Ran;
use crate::simulation::{Airborne, SimulationError};
use crate::trajectory::Ended;

/// Numbers of the noise that stress is confirmed under begin here: no run and no re-run of a violation has the same.
const CONFIRMING: usize = 1 << 20;

/// The seed that a trajectory over `waypoints` keeps as a case, so that it is carried out later as it was while it was
/// searched for; `None` where it is not, or in our own simulator: there seeds follow from cases' numbers.
fn kept_seed(setup: &Setup, executor: &dyn Executor, waypoints: &[Point3<f64>]) -> Option<u64> {
    if executor.is_ours() || !setup.scenario.executes() {
        return None;
    }
    Some(seed_over(setup.scenario.seed(), waypoints))
}

/// The seed that follows from `waypoints`, of a campaign of that root seed.
fn seed_over(root: u64, waypoints: &[Point3<f64>]) -> u64 {
    let [a, b, c, d, e, f, g, h, ..] = fingerprint(waypoints.iter().copied());
    named_seed(root, "executed", u64::from_le_bytes([a, b, c, d, e, f, g, h]))
}

/// Why the seed of `case` is none of the campaign's; `None` where it follows from the root seed, and the case's number
/// or, of what was executed while it was searched for, its waypoints.
pub fn foreign_seed(setup: &Setup, case: &Case) -> Option<String> {
    let root = setup.scenario.seed();
    let of_number = case_seed(root, case.number.0 as u64);
    if [of_number, seed_over(root, &case.waypoints)].contains(&case.seed) {
        return None;
    }
    Some(format!(
        "`seed` = {}: must be {of_number}, which follows from the root seed {root} and the case's number",
        case.seed
    ))
}

/// Case number `number` that `plan` of graph number `graph` becomes, with the seed that it was executed with.
pub(super) fn executed_case(setup: &Setup, executor: &dyn Executor, plan: Plan, (graph, number): (u64, usize)) -> Case {
    let kept = kept_seed(setup, executor, &plan.waypoints);
    let case = plan.case(setup.scenario.seed(), graph, number);
    Case { seed: kept.unwrap_or(case.seed), ..case }
}

/// What an execution is measured by, more is worse: by the judge, or by a function of the user's.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Sought {
    Measured(Stress),
    Users,
}

/// Executions of plans of one graph.
///
/// Cheap to make; holds nothing of what was executed. Shared by threads.
#[derive(Clone, Copy)]
pub(super) struct Trials<'a> {
    pub(super) setup: &'a Setup,
    pub(super) executor: &'a dyn Executor,
    /// Number of the graph.
    pub(super) graph: u64,
    /// The seed of the case that they are for, where it is known before its trajectory.
    pub(super) seed: Option<u64>,
}

/// A plan that was carried out, and what was measured.
struct Executed {
    case: Case,
    run: Run,
    measures: Measures,
    /// Whether it violates something, whatever is limited.
    fails: bool,
}

impl Trials<'_> {
    /// Executes `plan`; `None` where the executor or the judge refuses. What comes to the rank `least` is executed
    /// `confirm` times more, under noise, and its stress is the mean; NaN where one of those fails.
    ///
    /// 1 or 1 + `confirm` executions. `least` is the rank from which on a trial would be kept. It fails if the first
    /// execution does: that is the one that its case has later.
    pub(super) fn execute(&self, plan: &Plan, least: Rank) -> Option<Trial> {
        let setup = self.setup;
        let executed = self.executed(plan)?;
        let first = stressed(setup, &executed)?;
        let confirm = setup.scenario.search().confirm;
        if confirm == 0 || !first.reaches(least) {
            return Some(first);
        }
        let again = |number: u64| {
            let Trial { stress, .. } = stressed(setup, &self.again(&executed.case, 0, number)?)?;
            (first.fails || stress.is_finite()).then_some(stress)
        };
        let sum = (0..confirm).try_fold(first.stress, |sum, number| Some(sum + again(number)?));
        let stress = sum.map_or(f64::NAN, |sum| sum / (1 + confirm) as f64);
        Some(Trial { stress, executions: 1 + confirm, ..first })
    }

    /// Executes `plan` as run number `run` and measures it by each of `sought`, NaN where one was not measured; with
    /// what tells the execution from others. What comes to the `least` of one of them is executed `confirm` times more,
    /// as runs 1, 2, … of its case are: with what `[vary]` draws for them, and under noise. Its stresses are the means.
    ///
    /// It fails if the first does. One execution serves all of `sought`. Repeats are made where any of them comes to
    /// its `least`, and count for all.
    pub(super) fn execute_for(&self, (plan, run): (&Plan, usize), sought: &[Sought], least: &[f64]) -> Option<Ran> {
        let executed = self.executed_as(plan, run)?;
        let trial = |sought: &Sought| Trial {
            stress: Rank::of(executed.fails, self.measured(*sought, &executed)).stress,
            fails: executed.fails,
            worst_leg: worst_leg(*sought, &executed.measures),
            executions: 1,
        };
        let mut trials: Vec<Trial> = sought.iter().map(trial).collect();
        let confirm = self.setup.scenario.search().confirm;
        if confirm > 0 && trials.iter().zip(least).any(|(trial, least)| trial.stress >= *least) {
            for number in 0..confirm {
                let again = self.again(&executed.case, 1 + number as usize, number);
                for (trial, sought) in trials.iter_mut().zip(sought) {
                    let again = again.as_ref().map(|again| (again.fails, self.measured(*sought, again)));
                    let stress =
                        again.map_or(f64::NAN, |(fails, stress)| Rank::of(fails && trial.fails, stress).stress);
                    trial.stress += stress;
                }
            }
            for trial in &mut trials {
                (trial.stress, trial.executions) = (trial.stress / (1 + confirm) as f64, 1 + confirm);
            }
        }
        Some(Ran { trials, behaviour: executed.measures.behaviour() })
    }

    fn measured(&self, sought: Sought, executed: &Executed) -> Option<f64> {
        match sought {
            Sought::Measured(stress) => stress.of(&executed.measures),
            Sought::Users => self.asked(executed),
        }
    }

    /// What the user's own function makes of a run.
    fn asked(&self, Executed { case, run, .. }: &Executed) -> Option<f64> {
        let flight = run.outcome.as_ref().ok()?;
        Some(self.setup.user_target()?.measure(&RunFacts::of(flight, &case.waypoints)))
    }

    /// The same once, with the stress of each leg, NaN where there is none to learn from.
    pub(super) fn execute_legs(&self, plan: &Plan) -> Option<(Trial, Vec<f64>)> {
        let executed = self.executed(plan)?;
        let stresses = stresses_of(&executed.measures, self.setup.scenario.search().stress);
        Some((trial(self.setup, &executed)?, stresses))
    }

    /// What there is to learn from an execution of `plan` whose legs had these stresses, as trajectory number
    /// `trajectory`, which keeps legs of one trajectory together when folds and resamples are made.
    pub(super) fn learned(&self, plan: &Plan, stresses: &[f64], trajectory: usize) -> Vec<LegSample> {
        let mut samples = samples_of(&self.case(plan), stresses);
        samples.iter_mut().for_each(|sample| sample.trajectory = trajectory);
        samples
    }

    /// Whether a part of a trajectory can be executed from where its beginning has led: in our own simulator, where
    /// controllers know of one waypoint at a time.
    pub(super) fn resumes(&self) -> bool {
        self.executor.is_ours() && self.setup.kind().leg_by_leg().is_some()
    }

    /// Executes `plan`, the first waypoints of a trajectory, or all where it is `whole`: on from `before` or from the
    /// start; the same as [`execute`](Self::execute) once it is whole. Where executions do not [resume](Self::resumes),
    /// `plan` is carried out as if it were all.
    ///
    /// # Errors
    /// Legs that were executed for nothing.
    pub(super) fn execute_partial(
        &self,
        plan: &Plan,
        before: Option<&Airborne>,
        whole: bool,
    ) -> Result<in_loop::Ran<Airborne>, u64> {
        let setup = self.setup;
        let legs = plan.waypoints.len() as u64 - 1;
        let Some(flying) = setup.kind().leg_by_leg().filter(|_| self.executor.is_ours()) else {
            let Trial { stress, fails, .. } =
                self.executed(plan).and_then(|executed| trial(setup, &executed)).ok_or(legs)?;
            return Ok(in_loop::Ran { stress, fails, state: None, legs });
        };
        let case = self.case(plan);
        let failed = |error: SimulationError| self.executor.ended(Err(&error.to_string()));
        let executor = setup.scenario.executor();
        let length = setup.scenario.length().unwrap_or_default() as usize;
        let limit_of = |waypoints: &[Point3<f64>], planned: f64| {
            executor.patience.time_limit(length, 0.0, setup.kind().slowest(waypoints, length, planned))
        };
        // Before its legs are known a run's time is that of short ones.
        let at_start = limit_of(&case.waypoints[..1], 0.0);
        let mut airborne = match before {
            Some(before) => before.clone(),
            None => {
                let order = Order {
                    waypoints: &case.waypoints,
                    accept: executor.accept,
                    time_limit: at_start,
                    seed: run_seed(case.seed, 0),
                    obstacles: true,
                };
                flying.at_start(&order).map_err(failed).map_err(|()| legs)?
            }
        };
        let mut flown = 0;
        for waypoint in &case.waypoints[airborne.waypoints()..] {
            flown += u64::from(!airborne.ended());
            flying.fly_to(&mut airborne, *waypoint).map_err(failed).map_err(|()| flown)?;
        }
        if whole {
            flying.finish(&mut airborne).map_err(failed).map_err(|()| flown)?;
        }
        self.executor.ended(Ok(()));
        let flight = airborne.so_far();
        let is_longer = || limit_of(&case.waypoints, case.leg_times.iter().sum()) > at_start;
        if whole && flight.ended == Ended::Time && is_longer() {
            let again = self.executed(plan).and_then(|executed| trial(setup, &executed));
            let Trial { stress, fails, .. } = again.ok_or(flown)?;
            return Ok(in_loop::Ran { stress, fails, state: None, legs: flown });
        }
        // The time of a part is that of short legs: over before the whole is, it says nothing.
        let in_time = whole || flight.ended != Ended::Time;
        let run = Run { case: CaseNumber::default(), run: 0, drawn: Vec::new(), outcome: Ok(flight), full_rate: None };
        let weighed = measured(setup, &case, &run);
        let fails = in_time && weighed.as_ref().is_some_and(|weighed| weighed.fails);
        let stress = weighed.and_then(|weighed| setup.scenario.search().stress.of(&weighed.measures));
        let Rank { stress, .. } = Rank::of(fails, stress);
        Ok(in_loop::Ran { stress, fails, state: Some(airborne), legs: flown })
    }

    /// How long the execution of `plan` takes, s.
    pub(super) fn duration(&self, plan: &Plan) -> Option<f64> {
        self.executed(plan).map(|executed| executed.measures.total_time)
    }

    /// `plan` with the obstacles that are asked for, and its execution among them; as it is where none are. `None`
    /// where there is no room for any.
    pub(super) fn furnish(&self, plan: &Plan) -> Option<(Plan, Trial)> {
        let Placement { among, .. } = placement(self.setup, &self.executed(plan)?)?;
        let plan = Plan { environment: Some(among), ..plan.clone() };
        let among = self.executed(&plan)?;
        Some((plan, trial(self.setup, &among)?))
    }

    fn executed(&self, plan: &Plan) -> Option<Executed> {
        self.executed_as(plan, 0)
    }

    /// As run number `run`, with what is drawn for that.
    fn executed_as(&self, plan: &Plan, run: usize) -> Option<Executed> {
        let case = self.case(plan);
        let run = run_of(self.setup, self.executor, &case, run, mission(self.setup, &case, run));
        self.weighed(case, run)
    }

    /// Confirmation number `number` of `case`, with what is drawn for run number `run`, under noise of its own.
    fn again(&self, case: &Case, run: usize, number: u64) -> Option<Executed> {
        let mission = mission_again(self.setup, case, run, CONFIRMING + number as usize);
        let run = run_of(self.setup, self.executor, case, run, mission);
        self.weighed(case.clone(), run)
    }

    /// A run with its measures; whoever carried it out is told.
    fn weighed(&self, case: Case, run: Run) -> Option<Executed> {
        self.executor.ended(run.outcome.as_ref().map(drop).map_err(String::as_str));
        let Weighed { measures, violates, fails } = measured(self.setup, &case, &run)?;
        self.executor.measured(&measures, violates);
        Some(Executed { case, run, measures, fails })
    }

    /// What `plan` is carried out as: a case whose number is not known yet.
    fn case(&self, plan: &Plan) -> Case {
        let case = plan.clone().case(self.setup.scenario.seed(), self.graph, 0);
        let kept = kept_seed(self.setup, self.executor, &case.waypoints).map(|kept| self.seed.unwrap_or(kept));
        Case { seed: kept.unwrap_or(case.seed), ..case }
    }
}

/// The leg to change first. A function says nothing of legs: where the robot strayed most.
///
/// From 0; the leg of which [`Stress::worst_leg`] says that it has the measure.
fn worst_leg(sought: Sought, measures: &Measures) -> usize {
    let stress = match sought {
        Sought::Measured(stress) => stress,
        Sought::Users => Stress::MaxDeviation,
    };
    stress.worst_leg(measures).unwrap_or(0)
}

/// The stress of an execution. Where obstacles are to be placed, it is how deep the robot gets into those that could
/// stand in its way.
fn stressed(setup: &Setup, executed: &Executed) -> Option<Trial> {
    let own = trial(setup, executed);
    let Some(Placement { clearance, leg, .. }) = placement(setup, executed) else { return own };
    let worst_leg = leg.min(executed.case.waypoints.len().saturating_sub(2));
    let placed = Trial { stress: -clearance, fails: executed.fails, worst_leg, executions: 1 };
    own.filter(|own| own.stress >= placed.stress).or(Some(placed))
}

/// Where the obstacles that are asked for, and not there yet, would stand.
fn placement(setup: &Setup, executed: &Executed) -> Option<Placement> {
    let Executed { case, run, .. } = executed;
    let wanted = setup.scenario.search().stress == Stress::Clearance;
    let furnished = case.environment.as_ref().is_some_and(Environment::is_furnished);
    let track = &run.outcome.as_ref().ok().filter(|_| wanted && !furnished)?.track;
    setup.kind().place(case, track)
}

fn trial(setup: &Setup, Executed { measures, fails, .. }: &Executed) -> Option<Trial> {
    let stress = setup.scenario.search().stress;
    let worst_leg = stress.worst_leg(measures).unwrap_or(0);
    let Rank { fails, stress } = Rank::of(*fails, stress.of(measures));
    (!stress.is_nan()).then_some(Trial { stress, fails, worst_leg, executions: 1 })
}
