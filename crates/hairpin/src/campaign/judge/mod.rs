//! From runs to a case's result: measures, violations, and the worst run.
//!
//! | file | does |
//! | --- | --- |
//! | `run` | one run: measures, violations, what it leaves open |
//! | `along` | what programs do along their planned paths, as legs, arrivals and violations |
//!
//! Data flow: run → the setup as it was drawn for it → reference of deviations (leg, nearest leg, or path) → measures
//! → violations of the limits → the gravest run → [`CaseResult`].
//!
//! | runs | status |
//! | --- | --- |
//! | one violates | fail |
//! | else one was not carried out | executor failed |
//! | else one decides nothing | inconclusive |
//! | else, limits asked for | pass |
//! | else | unjudged |

mod along;
mod run;

pub(super) use self::run::{Drawn, reference, settings};
use self::run::{JudgedRun, Planned, judge_run};
use super::influence::RunDeviation;
use super::scenario::Asked;
use super::{Case, CaseResult, Draws, Mistake, Run, Setup, Status};
use crate::judgement::Measures;

/// The result of a case: its worst run by its gravity. A run with a violation is worse than one without, a crash is
/// worse than any other violation, and among equals what breaks a limit by the larger share of it; of runs within spec
/// what the first limit bounds, the deviation if it is limited. The first of equals.
///
/// # Errors
/// Values drawn for a run that the scenario's keys do not take, as happens with a folder that was edited.
///
/// Runs may come in any order; the first of equals in this order is the worst. No run at all is inconclusive.
pub fn judge(setup: &Setup, case: &Case, runs: &[Run]) -> Result<CaseResult, Mistake> {
    judge_runs(setup, case, runs).map(|(result, _)| result)
}

/// [`judge`], with the deviation of every run that could be measured: what [`super::influences`] is made of.
///
/// # Errors
/// As [`judge`].
///
/// Deviations are in the order of `runs`, without those that could not be measured. Only runs with drawn values that
/// decide something count in [`CaseResult::draws`], and only where a run may feel them.
pub fn judge_runs(setup: &Setup, case: &Case, runs: &[Run]) -> Result<(CaseResult, Vec<RunDeviation>), Mistake> {
    let mut worst: Option<(JudgedRun, &Run)> = None;
    let mut deviations = Vec::with_capacity(runs.len());
    let (mut failed, mut unflown) = (None, None);
    let plan = Planned::default();
    let mut draws = Draws { violated: 0, of: 0 };
    let are_felt = setup.unfelt_draws().is_none();
    for run in runs {
        let flight = match &run.outcome {
            Ok(flight) => flight,
            Err(message) => {
                unflown = unflown.or_else(|| Some(setup.by_program(run.run, message)));
                continue;
            }
        };
        match judge_run(setup, case, &plan, run, flight)? {
            Ok(judged) => {
                if are_felt && !run.drawn.is_empty() && judged.open.is_none() {
                    draws.of += 1;
                    draws.violated += usize::from(!judged.violations.is_empty());
                }
                failed = failed.or_else(|| judged.open.as_ref().map(|why| format!("run {}: {why}", run.run)));
                deviations.push(RunDeviation {
                    case: case.number,
                    run: run.run,
                    max_deviation: judged.measures.max_deviation,
                    drawn: run.drawn.clone(),
                    moves: judged.moves.clone(),
                });
                if worst.as_ref().is_none_or(|(so_far, _)| judged.gravity() > so_far.gravity()) {
                    worst = Some((judged, run));
                }
            }
            Err(error) => failed = failed.or(Some(format!("run {}: {error}", run.run))),
        }
    }
    let violates = worst.as_ref().is_some_and(|(judged, _)| !judged.violations.is_empty());
    let status = match (violates, &unflown, &failed) {
        (true, ..) => Status::Fail,
        (false, Some(_), _) => Status::ExecutorFailed,
        (false, None, Some(_)) => Status::Inconclusive,
        (false, None, None) if worst.is_none() => Status::Inconclusive,
        (false, None, None) if setup.scenario.asked() == Asked::Limits => Status::Pass,
        (false, None, None) => Status::Unjudged,
    };
    let message = unflown.or(failed);
    let draws = (draws.of > 0).then_some(draws);
    let result = match worst {
        Some((judged, run)) => CaseResult {
            case: case.number,
            status,
            run: run.run,
            ended: judged.ended,
            left_world: judged.left_world,
            measures: Some(judged.measures),
            violations: judged.violations,
            drawn: run.drawn.clone(),
            message,
            reruns: None,
            draws,
        },
        None => CaseResult {
            run: runs.first().map_or(0, |run| run.run),
            drawn: runs.first().map_or_else(Vec::new, |run| run.drawn.clone()),
            message,
            draws,
            ..CaseResult::bare(case.number, status)
        },
    };
    Ok((result, deviations))
}

/// What one run measured; `None` where it was not carried out or cannot be judged.
///
/// By the limits' own reference and corner; of programs also move by move.
pub fn measures_of(setup: &Setup, case: &Case, run: &Run) -> Option<Measures> {
    measured(setup, case, run).map(|judged| judged.measures)
}

/// What one run measured, and what that comes to.
pub(super) struct Weighed {
    pub(super) measures: Measures,
    /// Whether it violates anything.
    pub(super) violates: bool,
    /// Whether it would, whatever is limited: it crashed, left the world or stopped short of its end.
    pub(super) fails: bool,
}

/// [`measures_of`], weighed.
pub(super) fn measured(setup: &Setup, case: &Case, run: &Run) -> Option<Weighed> {
    let flight = run.outcome.as_ref().ok()?;
    let JudgedRun { measures, violations, .. } = judge_run(setup, case, &Planned::default(), run, flight).ok()?.ok()?;
    let fails = violations.iter().any(|one| one.event().is_some());
    Some(Weighed { measures, violates: !violations.is_empty(), fails })
}

/// Whether `run` is judged by what was measured of all of its rows, and not of those that were kept.
///
/// # Errors
/// As [`judge`].
pub fn is_at_full_rate(setup: &Setup, case: &Case, run: &Run) -> Result<bool, Mistake> {
    let Some(known) = &run.full_rate else { return Ok(false) };
    let around = setup.around(case)?;
    Ok(known.is_by(&Drawn::of(&around, run)?.terms))
}

#[cfg(test)]
mod tests {
    use nalgebra::{Isometry3, Point3};
    use serde_json::json;

    use super::*;
    use crate::campaign::testing::quadrotor;
    use crate::campaign::{CaseNumber, Scenario};
    use crate::trajectory::{Channel, Ended, Flight, Track};

    /// The case's result where a program flies at 2 m/s through a ball, 50 poses a second, and says that it is `ended`.
    fn through_a_ball(spec: &serde_json::Value, ended: Ended) -> CaseResult {
        let ball = json!({ "name": "ball", "sphere": { "center_m": [12.0, 3.0, 3.0], "radius_m": 0.5 } });
        let scenario: Scenario = serde_json::from_value(json!({
            "hairpin": 1, "robot": quadrotor(), "world": { "size_m": [30.0, 30.0, 30.0], "obstacles": [ball] },
            "task": { "start_m": [3.0, 3.0, 3.0], "end_m": [23.0, 3.0, 3.0], "length": 2 },
            "execute": { "command": "sim" }, "spec": spec,
        }))
        .unwrap();
        let setup = Setup::new(scenario).unwrap();
        let waypoints = vec![Point3::new(3.0, 3.0, 3.0), Point3::new(23.0, 3.0, 3.0)];
        let case = Case::bare(CaseNumber(0), 1, waypoints);
        let times: Vec<f64> = (0..=500).map(|i| f64::from(i) / 50.0).collect();
        let poses = times.iter().map(|t| Isometry3::translation(3.0 + 2.0 * t, 3.0, 3.0)).collect();
        let leg = Channel { name: "leg".into(), values: vec![0.0; times.len()] };
        let track = Track::new(times, poses, vec![leg]).unwrap();
        let flight = Flight { track, ended, left_world: None, reached: vec![Some(0.0), Some(10.0)] };
        let run = Run { case: CaseNumber(0), run: 0, drawn: Vec::new(), outcome: Ok(flight), full_rate: None };
        judge(&setup, &case, &[run]).unwrap()
    }

    #[test]
    fn a_program_that_flies_through_an_obstacle_violates_whatever_is_limited() {
        for spec in [json!({ "deviation": { "max_m": 1.5 } }), json!("none")] {
            let result = through_a_ball(&spec, Ended::Done);
            assert_eq!((result.status, result.ended.as_str()), (Status::Fail, "done"), "{spec}");
            let [found] = &result.violations[..] else { panic!("{:?}", result.violations) };
            assert!(found.what == "contact" && found.is_crash() && (found.at - 4.5).abs() < 1e-9, "{found:?}");
            assert_eq!(found.event().unwrap(), "met an obstacle: clearance -0.73 m");
        }
        // One that says so itself is told once.
        let crashed = through_a_ball(&json!({ "deviation": { "max_m": 1.5 } }), Ended::Obstacle);
        assert_eq!(crashed.violations.iter().map(|one| one.what.as_str()).collect::<Vec<_>>(), ["crash"]);
    }
}
