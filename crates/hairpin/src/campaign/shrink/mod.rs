//! Shrinking: a violating case reduced to the shortest feasible one that still violates in the same way.
//!
//! Waypoints first (delta debugging), then what the run met beside them (drawn values, wind, gusts, forces, noise,
//! obstacles), then the lengths of legs. Every candidate is planned anew and must be feasible by the same claim as the
//! case's own evidence before it is run; it is judged by the same spec.
//!
//! | pass | what | by |
//! | --- | --- | --- |
//! | waypoints | windows that end behind the violated leg, then any | doubling, [`ddmin`](fn@crate::search::ddmin) |
//! | conditions | drawn values, wind, gusts, force, noise; obstacles, keep-outs | one by one; ddmin |
//! | lengths | legs, coordinates that can be read | bisection, rounding |

mod conditions;
mod lengths;
mod route;

use super::scenario::shapes_the_plan;
use super::vary;
use super::{Case, CaseResult, Distribution, Mistake, Scenario, Setup};
use crate::search::ddmin;

use route::{Planner, Route};

/// Passes over waypoints, conditions and lengths: each may make room for the others.
const PASSES: usize = 3;

/// A case that is smaller than the one it was made of.
///
/// Run with `scenario`, as run [`CaseResult::run`], `case` violates the limit that the original violated first.
#[derive(Debug, Clone, PartialEq)]
pub struct Shrunk {
    /// What it is run with: the scenario's, or simpler.
    pub scenario: Scenario,
    /// Waypoints and evidence of its own; number and seed of the original.
    pub case: Case,
    /// What it came to.
    pub result: CaseResult,
    /// What was left out of the scenario, in words, in the order in which it was.
    pub simplified: Vec<String>,
    /// Whether nothing that was tried makes it smaller; else the caller stopped.
    pub finished: bool,
}

/// Why a case cannot be shrunk.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ShrinkError {
    /// It is within spec.
    #[error("case {0} does not violate: there is nothing to shrink")]
    Within(String),
    /// Run again, it does not violate in the same way.
    #[error(
        "case {case}, run {run}, flown again, does not violate its limit of {what} again: only what reproduces can be shrunk"
    )]
    Gone {
        /// The case's name.
        case: String,
        /// The run.
        run: usize,
        /// What was violated.
        what: String,
    },
    /// The scenario is none without what was left out.
    #[error(transparent)]
    Mistake(#[from] Mistake),
    /// What candidates are planned with cannot be built.
    #[error("nothing can be planned anew: {0}")]
    Plan(String),
}

/// Shrinks `case`, whose worst run came to `result`. `run(setup, case)` executes the candidate `case` as run
/// `result.run` under `setup` and judges it; it gives `None` to stop with the smallest so far.
///
/// What is asked of `run` depends on its answers alone.
///
/// At most three passes of waypoints, conditions and lengths, fewer once a pass changes nothing. The number of runs is
/// that of delta debugging: O(n log n) of n waypoints as a rule, O(n²) at worst.
///
/// What is kept is 1-minimal at best: no single waypoint can go, which does not make it the smallest of all.
///
/// # Errors
/// A case that does not violate, at all or again.
///
/// Deterministic: `run` is asked in one order, and may be asked the same thing again by an interrupted shrinking that
/// begins anew.
pub fn shrink(
    setup: &Setup,
    case: &Case,
    result: &CaseResult,
    run: &mut dyn FnMut(&Setup, &Case) -> Option<CaseResult>,
) -> Result<Shrunk, ShrinkError> {
    let Some(violation) = result.violations.first() else { return Err(ShrinkError::Within(case.id())) };
    // What it has beside its waypoints can be left out like anything else of its world.
    let around = setup.around(case)?;
    let (setup, case) = (around.as_ref(), &Case { environment: None, ..case.clone() });
    let scenario = pinned(&setup.scenario, case, result)?;
    let setup = setup.of_draw(scenario.clone())?;
    let best = Shrunk { scenario, case: case.clone(), result: result.clone(), simplified: Vec::new(), finished: false };
    let planner = Planner::new(&setup, case).map_err(ShrinkError::Plan)?;
    let route = Route::of(case);
    let mut job = Job { what: violation.what.clone(), setup, planner, route, best, run, stopped: false };
    match (job.run)(&job.setup, case) {
        None => return Ok(job.best),
        Some(again) if job.violates(&again) => job.best.result = again,
        Some(_) => return Err(ShrinkError::Gone { case: case.id(), run: result.run, what: job.what }),
    }
    for _ in 0..PASSES {
        let before = (job.route.clone(), job.best.simplified.len());
        job.drop_waypoints();
        job.simplify();
        job.shorten();
        if job.stopped || before == (job.route.clone(), job.best.simplified.len()) {
            break;
        }
    }
    job.best.finished = !job.stopped;
    Ok(job.best)
}

/// The scenario of the run that violated: what was drawn for the plan in place, what was drawn for the run as the only
/// choice, so that the same run number draws it again and the plan stays the nominal robot's.
fn pinned(scenario: &Scenario, case: &Case, result: &CaseResult) -> Result<Scenario, Mistake> {
    let mut pinned = vary::apply(scenario, &vary::draw_for_case(scenario, case.seed, case.number))?;
    for (key, value) in result.drawn.iter().filter(|(key, _)| !shapes_the_plan(key)) {
        let only =
            Distribution { uniform: None, normal: None, choice: Some(vec![value.clone()]), min: None, max: None };
        // The key as the scenario writes it, or it would be drawn twice.
        pinned.vary_mut().retain(|other, _| !vary::is_same(other, key));
        pinned.vary_mut().insert(key.clone(), only);
    }
    Ok(pinned)
}

/// The state of a shrinking.
struct Job<'a> {
    /// What must stay violated.
    what: String,
    /// That of the smallest case.
    setup: Setup,
    planner: Planner,
    /// That of the smallest case.
    route: Route,
    best: Shrunk,
    run: &'a mut dyn FnMut(&Setup, &Case) -> Option<CaseResult>,
    stopped: bool,
}

impl Job<'_> {
    /// By the name of the limit; where and by how much may differ.
    fn violates(&self, result: &CaseResult) -> bool {
        result.violations.iter().any(|violation| violation.what == self.what)
    }

    /// Whether the way along `route` under `setup` is feasible and violates; then it is the smallest so far. `None`:
    /// stopped.
    ///
    /// A way that cannot be planned does not violate, and costs no run.
    fn holds(&mut self, setup: Option<&Setup>, route: &Route) -> Option<bool> {
        let own = setup.unwrap_or(&self.setup);
        let Some(case) = self.planner.plan(own, &self.best.case, route) else { return Some(false) };
        let Some(result) = (self.run)(own, &case) else {
            self.stopped = true;
            return None;
        };
        let violates = self.violates(&result);
        if violates {
            self.best.case = case;
            self.best.result = result;
            self.route = route.clone();
            if let Some(setup) = setup {
                self.best.scenario = setup.scenario.clone();
                self.setup = setup.clone();
            }
        }
        Some(violates)
    }

    /// The fewest waypoints: first those around where it happened, then whatever can go.
    fn drop_waypoints(&mut self) {
        if self.stopped {
            return;
        }
        let leg = self.best.result.violations.iter().find(|v| v.what == self.what).map_or(0, |v| v.leg);
        let whole = self.route.clone();
        let free = whole.free();
        // Windows that end behind the leg, longer and longer: what comes later cannot have caused it.
        let end = free.iter().position(|index| *index > leg).map_or(free.len(), |at| at + 1);
        let mut length = 2;
        while length < free.len() {
            let window = whole.keep(&free[end.saturating_sub(length)..end]);
            match window.is_way().then(|| self.holds(None, &window)) {
                Some(None) => return,
                Some(Some(true)) => break,
                _ if length >= end => break,
                _ => length = (2 * length).min(end),
            }
        }
        let whole = self.route.clone();
        ddmin(&whole.free(), &mut |part| {
            let shorter = whole.keep(part);
            if shorter.is_way() { self.holds(None, &shorter) } else { Some(false) }
        });
    }
}
