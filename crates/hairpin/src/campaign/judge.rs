//! From runs to a case's result: measures, violations, and the worst run.
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

use std::borrow::Cow;
use std::cell::OnceCell;

use super::gravity::Gravity;
use super::hidden::{hidden, sampled};
use super::impossible::too_fast;
use super::influence::RunDeviation;
use super::missed::missed;
use super::scenario::{Asked, DeviationFrom, Terms};
use super::{Case, CaseResult, Draws, Mistake, Run, Setup, Status};
use crate::judgement::moves::Measured;
use crate::judgement::{self, Clearance, JudgementError, Late, LegSource, Measures, Reference, Settings, Violation};
use crate::trajectory::{Channel, Ended, Flight, PlannedPath, Track};

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

struct JudgedRun {
    measures: Measures,
    violations: Vec<Violation>,
    /// Why what was recorded decides nothing.
    open: Option<String>,
    ended: String,
    left_world: Option<f64>,
    /// What it is compared by where it violates nothing: what the first limit bounds.
    within: f64,
    moves: Option<Measured>,
}

impl JudgedRun {
    fn gravity(&self) -> Gravity {
        Gravity::of((&self.violations, &self.ended), self.measures.max_deviation, self.within)
    }
}

/// A case's planned motion, once a run asked for it.
#[derive(Default)]
struct Planned {
    /// What deviations are measured from.
    reference: OnceCell<Option<Track>>,
    /// Of programs: the path with its zones and where its moves end.
    programmed: OnceCell<Option<PlannedPath>>,
}

/// Measures one run in the world that was drawn for it.
fn judge_run(
    setup: &Setup,
    case: &Case,
    plan: &Planned,
    run: &Run,
    flight: &Flight,
) -> Result<Result<JudgedRun, JudgementError>, Mistake> {
    let around = setup.around(case)?;
    let setup = around.as_ref();
    let Drawn { own, terms } = Drawn::of(setup, run)?;
    let programmed = plan.programmed.get_or_init(|| setup.kind().programs()?.programmed(case)).as_ref();
    // Rows may have been left out since it was measured so; deviations that are asked for otherwise are measured of
    // those that stand.
    let known = run.full_rate.as_ref().filter(|known| known.is_by(&terms));
    let path = match terms.from {
        DeviationFrom::Path if known.is_none() => {
            plan.reference.get_or_init(|| reference(setup, case, programmed)).as_ref()
        }
        _ => None,
    };
    let programs = setup.kind().programs();
    let mut moves = programs.and_then(|programs| programs.measured(programmed?, &flight.track, path));
    let legs = moves.as_mut().map(|moves| std::mem::take(&mut moves.legs)).unwrap_or_default();
    let measured = match known {
        Some(known) => Ok(known.measures.clone()),
        None => {
            let clearance = own.kind().clearance();
            let settings = settings(&terms, path, clearance.as_deref());
            let rows = match with_legs(&flight.track, &legs, case.waypoints.len()) {
                Some(track) => sampled(&own, &track, &case.waypoints, &settings)
                    .map(|rows| Measures { leg_source: LegSource::Assigned, ..rows }),
                None => sampled(&own, &flight.track, &case.waypoints, &settings),
            };
            rows.map(|rows| match &run.full_rate {
                Some(by_others) => by_others.beside(rows),
                None => rows,
            })
        }
    };
    Ok(measured.map(|mut measures| {
        measures.latest = moves.as_ref().and_then(latest);
        let moves_of = moves.iter().flat_map(|moves| &moves.moves);
        measures.legs.iter_mut().zip(moves_of).for_each(|(leg, one)| leg.lateness = one.late());
        let mut violations = judgement::violations(&measures, flight, &terms.limits);
        let ours = programs.is_some_and(|programs| programs.recordings().is_none());
        if let Some(moves) = moves.as_ref().filter(|_| ours && terms.limits.unfinished && flight.ended == Ended::Done) {
            violations.splice(..0, left_out(moves));
        }
        let unseen = moves.as_ref().and_then(|moves| moves.unseen.as_ref());
        if let (Some(unseen), Some(moves)) = (unseen, &moves) {
            proven(&mut violations, unseen.late_proven, moves);
        }
        let hidden = || hidden(&own, &measures, &terms.limits);
        let unmeasured = || terms.limits.open(&measures);
        // What violates has an answer.
        let missed = || missed(&own, flight, &measures, &terms.limits).filter(|_| violations.is_empty());
        let kept = || moves.as_ref().filter(|_| violations.is_empty());
        let beside = || kept().filter(|_| terms.limits.unfinished)?.beside(terms.limits.deviation.is_some());
        let unarrived = || kept().filter(|_| terms.limits.late.is_some())?.unarrived();
        let too_fast = || too_fast(&own, case, flight, &terms.limits);
        let beyond = || programs.filter(|_| terms.limits.are_given())?.beyond(&flight.track);
        let open = too_fast()
            .or_else(beyond)
            .or_else(|| unseen?.open.clone())
            .or_else(beside)
            .or_else(unarrived)
            .or_else(missed)
            .or_else(hidden)
            .or_else(unmeasured);
        if let Some(programs) = programs {
            violations = violations.into_iter().map(|violation| programs.in_their_units(violation)).collect();
        }
        JudgedRun {
            open,
            violations,
            ended: flight.ended.word().into(),
            left_world: flight.left_world,
            within: terms.gauge().of(&measures).unwrap_or(measures.max_deviation),
            measures,
            moves,
        }
    }))
}

/// `track` with the legs that its samples have along the planned path, where it tells none itself: what moves in joints
/// bulges away from the straight lines between its waypoints, and another leg's may be the nearer one.
fn with_legs(track: &Track, legs: &[usize], waypoints: usize) -> Option<Track> {
    if track.channel("leg").is_some() || legs.len() != track.len() {
        return None;
    }
    let last = waypoints.saturating_sub(2);
    let leg = Channel { name: "leg".into(), values: legs.iter().map(|leg| (*leg).min(last) as f64).collect() };
    let channels = track.channels().iter().cloned().chain([leg]).collect();
    Track::new(track.times().to_vec(), track.poses().to_vec(), channels).ok()
}

/// The first target on the way that an arm did not come to though its program's time was over and it ended where that
/// does: who stands at home has ended there. Whether it came to the last is told by how it ended.
fn left_out(moves: &Measured) -> Option<Violation> {
    let (_, on_the_way) = moves.moves.split_last()?;
    let leg = on_the_way.iter().position(|one| one.arrived.is_none())?;
    Some(Violation {
        what: "unfinished".into(),
        value: (leg + 1) as f64,
        limit: (moves.moves.len() + 1) as f64,
        unit: "waypoints".into(),
        at: on_the_way[leg].planned,
        leg,
    })
}

/// What a run is judged by, with what was drawn for it.
pub(super) struct Drawn<'a> {
    /// The scenario that it was flown in.
    pub(super) own: Cow<'a, Setup>,
    pub(super) terms: Terms,
}

impl<'a> Drawn<'a> {
    pub(super) fn of(setup: &'a Setup, run: &Run) -> Result<Self, Mistake> {
        let own = match run.drawn.is_empty() {
            true => Cow::Borrowed(setup),
            false => Cow::Owned(setup.drawn(&run.drawn)?),
        };
        let mut terms = own.scenario.head().terms;
        // Who asks for nothing does not ask for missions that are finished either.
        terms.limits.unfinished = own.scenario.asked() != Asked::Nothing;
        terms.limits.contact = own.program().is_some();
        Ok(Self { own, terms })
    }
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

/// How a run is measured by `terms`, from the `path` where they ask for it. Recordings of ours have no breaks.
pub(super) fn settings<'a>(
    terms: &Terms,
    path: Option<&'a Track>,
    clearance: Option<&'a Clearance<'a>>,
) -> Settings<'a> {
    let reference = match (terms.from, path) {
        (DeviationFrom::Path, Some(path)) => Reference::Path(path),
        (DeviationFrom::NearestLeg, _) => Reference::NearestLeg,
        _ => Reference::Leg,
    };
    Settings { reference, corner: terms.corner, clearance, breaks: &[] }
}

/// The motion that deviations from the path are measured from.
///
/// `None` where the case has no motion: the judge then says that nothing can be measured from a path.
pub(super) fn reference(setup: &Setup, case: &Case, programmed: Option<&PlannedPath>) -> Option<Track> {
    match setup.kind().programs() {
        Some(programs) => programs.reference(case, programmed),
        None => setup.kind().followed(case).ok(),
    }
}

/// Of violations by a recording: a late arrival stands only where the samples about it prove that, as the latest of
/// those.
fn proven(violations: &mut Vec<Violation>, late: Option<usize>, measured: &Measured) {
    let late = late.and_then(|leg| Some((leg, measured.moves.get(leg)?)));
    violations.retain_mut(|violation| match (violation.what.as_str(), late) {
        ("late", None) => false,
        ("late", Some((leg, one))) => {
            violation.leg = leg;
            violation.value = one.late().unwrap_or(violation.value);
            violation.at = one.arrived.unwrap_or(violation.at);
            true
        }
        _ => true,
    });
}

/// The latest of all arrivals at points; `None` where it arrived nowhere.
fn latest(measured: &Measured) -> Option<Late> {
    let arrivals = measured.moves.iter().enumerate();
    let late = arrivals.filter_map(|(leg, m)| Some(Late { by: m.late()?, at: m.arrived?, leg }));
    late.max_by(|a, b| a.by.total_cmp(&b.by))
}

#[cfg(test)]
mod tests {
    use nalgebra::{Isometry3, Point3};
    use serde_json::json;

    use super::*;
    use crate::campaign::testing::quadrotor;
    use crate::campaign::{CaseNumber, Scenario};
    use crate::trajectory::{Channel, Ended};

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
