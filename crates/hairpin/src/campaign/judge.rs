//! From runs to a case's result, and from results to the one sentence.

use std::cell::OnceCell;

use nalgebra::Point3;

use super::case::gap_word;
use super::influence::RunDeviation;
use super::scenario::DeviationFrom;
use super::setup::Kind;
use super::terms::Terms;
use super::{Case, CaseResult, Mistake, Reruns, Run, Setup, Status, Tally, arm, planned, vary};
use crate::judgement::moves::Measured;
use crate::judgement::{
    self, Claim, Clearance, Judged, JudgementError, Measures, Reference, Settings, Verdict, Violation, Worst,
};
use crate::trajectory::{Flight, PlannedPath, Track};

/// Confidence of intervals where the spec names none.
const CONFIDENCE: f64 = 0.95;

/// The result of a case: its worst run. A run with a violation is worse than one without, a crash is worse than any
/// other violation, and among equals the larger deviation is worse; the first of equals.
///
/// # Errors
/// Values drawn for a run that the scenario's keys do not take, as happens with a folder that was edited.
pub fn judge(setup: &Setup, case: &Case, runs: &[Run]) -> Result<CaseResult, Mistake> {
    judge_runs(setup, case, runs).map(|(result, _)| result)
}

/// [`judge`], with the deviation of every run that could be measured: what [`super::influences`] is made of.
///
/// # Errors
/// As [`judge`].
pub fn judge_runs(setup: &Setup, case: &Case, runs: &[Run]) -> Result<(CaseResult, Vec<RunDeviation>), Mistake> {
    let mut worst: Option<(JudgedRun, &Run)> = None;
    let mut deviations = Vec::with_capacity(runs.len());
    let (mut failed, mut unflown) = (None, None);
    let plan = Planned::default();
    for run in runs {
        let flight = match &run.outcome {
            Ok(flight) => flight,
            Err(message) => {
                unflown = unflown.or(Some(format!("run {}: {message}", run.run)));
                continue;
            }
        };
        match judge_run(setup, case, &plan, run, flight)? {
            Ok(judged) => {
                deviations.push(RunDeviation {
                    case: case.number,
                    run: run.run,
                    max_deviation: judged.measures.max_deviation,
                    drawn: run.drawn.clone(),
                    moves: judged.moves.clone(),
                });
                if worst.as_ref().is_none_or(|(so_far, _)| judged.rank() > so_far.rank()) {
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
        (false, None, None) => Status::Pass,
    };
    let message = unflown.or(failed);
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
        },
        None => CaseResult {
            case: case.number,
            status,
            run: runs.first().map_or(0, |run| run.run),
            ended: status.word().into(),
            left_world: None,
            measures: None,
            violations: Vec::new(),
            drawn: runs.first().map_or_else(Vec::new, |run| run.drawn.clone()),
            message,
            reruns: None,
        },
    };
    Ok((result, deviations))
}

/// What one run measured; `None` where it was not carried out or cannot be judged.
pub(super) fn measures_of(setup: &Setup, case: &Case, run: &Run) -> Option<Measures> {
    let flight = run.outcome.as_ref().ok()?;
    let judged = judge_run(setup, case, &Planned::default(), run, flight).ok()?.ok()?;
    Some(judged.measures)
}

struct JudgedRun {
    measures: Measures,
    violations: Vec<Violation>,
    ended: String,
    left_world: Option<f64>,
    crashed: bool,
    moves: Option<Measured>,
}

impl JudgedRun {
    fn rank(&self) -> (bool, bool, TotalOrder) {
        (!self.violations.is_empty(), self.crashed, TotalOrder(self.measures.max_deviation))
    }
}

/// Floats in the order of `total_cmp`.
#[derive(PartialEq)]
struct TotalOrder(f64);

impl PartialOrd for TotalOrder {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.0.total_cmp(&other.0))
    }
}

/// A case's planned motion, once a run asked for it.
#[derive(Default)]
struct Planned {
    /// What deviations are measured from.
    reference: OnceCell<Option<Track>>,
    /// Of arms: the path with its zones and where its moves end.
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
    let drawn;
    let own = if run.drawn.is_empty() {
        setup
    } else {
        drawn = setup.of_draw(vary::apply(&setup.scenario, &run.drawn)?)?;
        &drawn
    };
    let terms = Terms::of(&own.scenario);
    let path = match terms.from {
        DeviationFrom::Path => plan.reference.get_or_init(|| reference(setup, case)).as_ref(),
        DeviationFrom::Leg | DeviationFrom::NearestLeg => None,
    };
    let clearance = clearance_of(own);
    let settings = Settings {
        reference: match (terms.from, path) {
            (DeviationFrom::Path, Some(path)) => Reference::Path(path),
            (DeviationFrom::NearestLeg, _) => Reference::NearestLeg,
            _ => Reference::Leg,
        },
        corner: terms.corner,
        clearance: clearance.as_deref(),
    };
    Ok(judgement::measure(&flight.track, &case.waypoints, &settings).map(|mut measures| {
        let arm = setup.arm();
        let moves = arm.and_then(|arm| {
            let programmed = plan.programmed.get_or_init(|| arm.planned(case).ok()).as_ref();
            arm::measured(&arm, programmed?, &flight.track)
        });
        measures.latest = moves.as_ref().and_then(arm::latest);
        let mut violations = judgement::violations(&measures, flight, &terms.limits);
        if arm.is_some() {
            violations = violations.into_iter().map(arm::in_small_units).collect();
        }
        JudgedRun {
            violations,
            ended: flight.ended.word().into(),
            left_world: flight.left_world,
            crashed: flight.ended.is_crash(),
            measures,
            moves,
        }
    }))
}

/// How far the robot, a ball or a disc about its origin, is from what it must not meet, m; `None` where there is nothing.
fn clearance_of(setup: &Setup) -> Option<Box<Clearance<'_>>> {
    match setup.kind() {
        Kind::Flight(setup) => {
            let (world, radius) = (setup.world, setup.robot.clearance_radius);
            (!world.obstacles().is_empty())
                .then(|| Box::new(move |p: &Point3<f64>| world.obstacle_distance(p) - radius) as Box<Clearance<'_>>)
        }
        Kind::Drive(setup) => {
            let (places, radius) = (setup.keep_out, setup.radius());
            (!setup.scenario.world.keep_out.is_empty())
                .then(|| Box::new(move |p: &Point3<f64>| places.distance(p.x, p.y) - radius) as Box<Clearance<'_>>)
        }
        // What is proven clear of an arm's plan is not measured again along its recordings.
        Kind::Arm(_) => None,
    }
}

/// The planned motion that deviations are measured from.
fn reference(setup: &Setup, case: &Case) -> Option<Track> {
    match setup.arm() {
        Some(arm) => arm.reference(case).map(|path| path.track().clone()),
        None => planned(setup, case).ok(),
    }
}

/// The verdict on a campaign: on its results, or that nothing was feasible.
pub fn verdict(setup: &Setup, cases: &[Case], results: &[CaseResult], tally: &Tally) -> Verdict {
    let asked = tally.asked(setup.scenario.search().cases);
    if cases.is_empty() {
        return if tally.stopped { nothing_found(setup, tally, asked) } else { nothing_feasible(setup, tally, None) };
    }
    let count = |status: Status| results.iter().filter(|result| result.status == status).count();
    let claims: Vec<Claim> = super::Evidence::ALL
        .iter()
        .map(|evidence| Claim {
            word: evidence.word(),
            count: cases.iter().filter(|case| case.evidence == *evidence).count(),
        })
        .filter(|claim| claim.count > 0)
        .collect();
    let worst = worst_of(setup, results);
    let how = how_obtained(setup);
    let how: Vec<&str> = how.iter().map(String::as_str).collect();
    let gaps: Option<Vec<f64>> = cases.iter().map(Case::gap).collect();
    let proof = gaps.map(|gaps| gap_word(gaps.into_iter().fold(0.0, f64::max), "gap at most"));
    let confidence = setup.scenario.confidence().unwrap_or(CONFIDENCE);
    let reruns = rerun_words(results, confidence);
    let trouble = results.iter().find_map(|result| result.message.clone()).unwrap_or_default();
    judgement::verdict(&Judged {
        how: &how,
        runs: setup.scenario.executor().repeat as usize,
        cases: results.len(),
        asked,
        failed: count(Status::Fail),
        executor_failed: count(Status::ExecutorFailed),
        inconclusive: count(Status::Inconclusive),
        trouble: &trouble,
        worst: worst.as_ref().map(|(case, value, saturation)| Worst { case, value, saturation: *saturation }),
        share_limit: setup.scenario.violation_share(),
        confidence,
        claims: &claims,
        reruns: reruns.as_deref(),
        proof: proof.as_deref(),
    })
}

/// `violations run again 10 times each: 5 of 7 violate every time, least often 0117, 3/10 [6.7, 65.2] %`.
fn rerun_words(results: &[CaseResult], confidence: f64) -> Option<String> {
    let again: Vec<(&CaseResult, Reruns)> = results
        .iter()
        .filter_map(|result| Some((result, result.reruns?)))
        .filter(|(_, reruns)| reruns.of > 0)
        .collect();
    let failed = results.iter().filter(|result| result.status == Status::Fail).count();
    let always = again.iter().filter(|(_, reruns)| reruns.violated == reruns.of).count();
    let share = |reruns: &Reruns| reruns.violated as f64 / reruns.of as f64;
    let (result, least) = again.iter().min_by(|a, b| share(&a.1).total_cmp(&share(&b.1)))?;
    let most = again.iter().map(|(_, reruns)| reruns.of).max()?;
    let mut words = format!("violations run again {most} times each: {always} of {} violate every time", again.len());
    if let Some(interval) = least.share(confidence).filter(|_| least.violated < least.of) {
        let (low, high) = (100.0 * interval.low, 100.0 * interval.high);
        let (k, n) = (least.violated, least.of);
        words += &format!(", least often {:04}, {k}/{n} [{low:.1}, {high:.1}] %", result.case);
    }
    // A limit that became tighter since makes violations of what was not one.
    if failed > again.len() {
        words += &format!(", {} not run again", failed - again.len());
    }
    Some(words)
}

/// `simulated, anafi stand-in, minimum-snap`, or the executor's command; of logs `hardware, irb120, nightly/*.csv`.
pub fn how_obtained(setup: &Setup) -> Vec<String> {
    if let Some(logs) = setup.recordings() {
        // What was recorded was no stand-in, only what it is held against is computed with one.
        let logs = logs.trim_start_matches("../");
        return vec!["hardware".into(), setup.robot_name().into(), logs.into()];
    }
    let name = setup.robot_name();
    let stand_in = if setup.caveat().is_empty() { name.to_owned() } else { format!("{name} stand-in") };
    let who = match (setup.scenario.executor().command, setup.scenario.controller()) {
        (Some(command), None) => format!("executor `{command}`"),
        (_, Some(controller)) => controller.into(),
        (None, None) => "no controller".into(),
    };
    vec!["simulated".into(), stand_in, who]
}

/// The worst result, and what is said of it: its gravest violation, or the deviation that came nearest to the limit.
fn worst_of(setup: &Setup, results: &[CaseResult]) -> Option<(String, Violation, Option<f64>)> {
    let mut worst: Option<(&CaseResult, &Measures)> = None;
    let rank = |result: &CaseResult, measures: &Measures| {
        let crashed = result.violations.first().is_some_and(Violation::is_crash);
        (!result.violations.is_empty(), crashed, TotalOrder(measures.max_deviation))
    };
    for result in results {
        let Some(measures) = &result.measures else { continue };
        if worst.is_none_or(|(so_far, old)| rank(result, measures) > rank(so_far, old)) {
            worst = Some((result, measures));
        }
    }
    let (result, measures) = worst?;
    let nearest = || {
        setup.scenario.deviation_limit().map(|limit| Violation {
            what: "deviation".into(),
            value: measures.max_deviation,
            limit,
            unit: "m".into(),
            at: measures.t_worst,
            leg: measures.leg_worst,
        })
    };
    let told = |violation| if setup.arm().is_some() { arm::in_small_units(violation) } else { violation };
    let value = result.violations.first().cloned().or_else(|| nearest().map(told))?;
    let saturation = measures.legs.get(value.leg).and_then(|leg| leg.saturation_share).or(measures.saturation_share);
    Some((format!("{:04}", result.case), value, saturation))
}

/// The verdict of exit 5 on a search that a time limit ended too soon: that nothing is feasible was not found out.
fn nothing_found(setup: &Setup, tally: &Tally, asked: usize) -> Verdict {
    let searched = format!("{} graphs searched", tally.graphs);
    let how = [searched.as_str(), setup.scenario.reach()];
    judgement::inconclusive(&format!("0/{asked}"), &how, "stopped before the first trajectory was found")
}

/// The verdict of exit 3, with what it rests on, and the smallest change that helps where that was looked for.
pub(super) fn nothing_feasible(setup: &Setup, tally: &Tally, change: Option<&str>) -> Verdict {
    let rests_on = match tally.proven_empty {
        proven if proven > 0 && proven == tally.graphs => "proof".into(),
        _ => format!("{} graphs searched", tally.graphs),
    };
    let open = setup.scenario.drive().is_some_and(|scenario| scenario.task.end_m.is_none());
    let ends = if open { "from the start" } else { "from start to end" };
    let chain = match setup.scenario.length() {
        Some(length) => format!("no chain of {length} waypoints {ends}"),
        None => "no program from home to home".into(),
    };
    let what = match &tally.nothing {
        Some(reason) => format!("{chain}: {reason}"),
        None => chain,
    };
    judgement::nothing_feasible(&[&rests_on, setup.scenario.reach()], &what, change)
}
