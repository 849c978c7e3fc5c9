//! From runs to a case's result: measures, violations, and the worst run.
//!
//! | file | does |
//! | --- | --- |
//! | `run` | one run: measures, violations, what it leaves open |
//! | `looked` | what of a program's run no robot of its kind does |
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
mod looked;
mod run;

pub(super) use self::looked::look;
pub(super) use self::run::{Drawn, reference, settings};
use self::run::{JudgedRun, Planned, judge_run};
use super::influence::RunDeviation;
use super::scenario::Asked;
use super::{Case, CaseResult, Draws, Mistake, Run, Setup, Status, vary};
use crate::judgement::{self, Measures, Violation};

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
    let mut of_runs: Option<Box<Measures>> = None;
    let mut broken: Vec<(usize, Violation)> = Vec::new();
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
                of_runs = match (of_runs, &worst) {
                    (Some(so_far), _) => Some(Box::new(so_far.worst_of_each(&judged.measures))),
                    (None, Some((first, _))) => Some(Box::new(first.measures.worst_of_each(&judged.measures))),
                    (None, None) => None,
                };
                for one in &judged.violations {
                    match broken.iter_mut().find(|(_, so_far)| so_far.what == one.what) {
                        Some(so_far) if one.relative_excess() > so_far.1.relative_excess() => {
                            *so_far = (run.run, one.clone());
                        }
                        Some(_) => {}
                        None => broken.push((run.run, one.clone())),
                    }
                }
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
            of_runs,
            elsewhere: broken
                .iter()
                .filter(|(_, one)| judged.violations.iter().all(|own| own.what != one.what))
                .map(|(number, one)| format!("run {number}: {}", one.in_words()))
                .collect(),
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

/// The limit that a result breaks by its own measures though it is a pass, in words: it is of another spec, or was
/// changed since it was written. `None` of what is no pass.
///
/// The worst run is held to the limits that were drawn for it; the worst of each measure over all runs to the
/// scenario's, where none is drawn.
pub fn contradiction(setup: &Setup, result: &CaseResult) -> Option<String> {
    let measures = result.measures.as_ref().filter(|_| result.status == Status::Pass)?;
    let nominal = setup.scenario.head().terms.limits;
    let drawn = match result.drawn.iter().any(|(key, _)| key.starts_with("spec.")) {
        true => vary::apply(&setup.scenario, &result.drawn).ok()?.head().terms.limits,
        false => nominal,
    };
    let of_run = judgement::exceeded(measures, &drawn);
    let all = result.of_runs.as_deref().filter(|_| drawn == nominal);
    let broken =
        of_run.into_iter().chain(all.map(|all| judgement::exceeded(all, &drawn)).unwrap_or_default()).next()?;
    let told = match setup.kind().programs() {
        Some(programs) => programs.in_their_units(broken),
        None => broken,
    };
    Some(told.in_words())
}

/// Why `run` says nothing of what its robot does, in a sentence: its program tells a motion that no robot of its kind
/// makes. `None` of our own simulators, and of what was not carried out.
pub fn unlike(setup: &Setup, case: &Case, run: &Run) -> Option<String> {
    looked::unlike(setup, case, run.outcome.as_ref().ok()?, run.full_rate.as_deref())
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

#[cfg(feature = "unit-tests")]
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

    /// One run shakes, another one strays: by what is limited the first is the worst, and the second is told all the
    /// same.
    #[test]
    fn what_other_runs_break_is_told_beside_the_worst() {
        let judged = |spec: serde_json::Value| {
            let scenario: Scenario = serde_json::from_value(json!({
                "hairpin": 1, "robot": quadrotor(), "world": { "size_m": [30.0, 30.0, 30.0] },
                "task": { "start_m": [3.0, 3.0, 3.0], "end_m": [23.0, 3.0, 3.0], "length": 2 },
                "execute": { "command": "sim", "repeat": 2 }, "spec": spec,
            }))
            .unwrap();
            let setup = Setup::new(scenario).unwrap();
            let waypoints = vec![Point3::new(3.0, 3.0, 3.0), Point3::new(23.0, 3.0, 3.0)];
            let case = Case::bare(CaseNumber(0), 1, waypoints);
            let run = |(run, amplitude, pulse): (usize, f64, f64)| {
                let times: Vec<f64> = (0..=500).map(|i| f64::from(i) / 50.0).collect();
                let aside = |t: f64| amplitude * (pulse * t).sin() * (0.1 * std::f64::consts::PI * t).sin();
                let pose = |t: &f64| Isometry3::translation(3.0 + 2.0 * t, 3.0 + aside(*t), 3.0);
                let leg = Channel { name: "leg".into(), values: vec![0.0; times.len()] };
                let track = Track::new(times.clone(), times.iter().map(pose).collect(), vec![leg]).unwrap();
                let reached = vec![Some(0.0), Some(10.0)];
                let flight = Flight { track, ended: Ended::Done, left_world: None, reached };
                Run { case: CaseNumber(0), run, drawn: Vec::new(), outcome: Ok(flight), full_rate: None }
            };
            let runs: Vec<Run> = [(0, 0.05, 10.0), (1, 0.9, 0.3)].into_iter().map(run).collect();
            judge(&setup, &case, &runs).unwrap()
        };
        let both = judged(json!({ "deviation": { "max_m": 0.6 }, "acceleration": { "max_m_s2": 1.0 } }));
        let alone = judged(json!({ "deviation": { "max_m": 0.6 } }));
        assert_eq!((both.run, alone.run), (0, 1));
        assert_eq!(both.violations.iter().map(|one| one.what.as_str()).collect::<Vec<_>>(), ["acceleration"]);
        assert!(matches!(&both.elsewhere[..], [one] if one.starts_with("run 1: deviation 0.")), "{:?}", both.elsewhere);
        assert_eq!(alone.elsewhere, Vec::<String>::new());
        // What is told of the case is the same.
        assert_eq!(both.measured(), alone.measured());
        let (all, shaken) = (both.measured().unwrap(), both.measures.as_ref().unwrap());
        assert!(all.max_deviation > 0.6 && shaken.max_deviation < 0.06, "{all:?}");
        assert_eq!(all.max_acceleration, shaken.max_acceleration);
    }
}
