//! A report's contents: assembled once from a judged campaign, shown by whatever format.

use std::collections::BTreeMap;

use nalgebra::{Point3, Vector3};
use serde::Serialize;

use super::solid::{Surface, surface};
use super::text::{attitude, cells, leg, number};
use crate::campaign::scenario::DeviationFrom;
use crate::campaign::{Case, CaseResult, Influence, Run, Setup, Status, Tally, vary};
use crate::judgement::{
    JudgementError, Measures, Reference, Settings, Statistics, Verdict, deviation_of_samples, share,
};
use crate::trajectory::Track;

/// A rotor, seen from above.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rotor {
    /// Forward, m.
    pub x: f64,
    /// Left, m.
    pub y: f64,
    /// Whether it turns clockwise seen from above.
    pub clockwise: bool,
}

/// What stands around the flights.
#[derive(Debug, Clone, PartialEq)]
pub struct Drawing {
    /// Edge lengths of the world, m.
    pub size: Vector3<f64>,
    /// Obstacles.
    pub obstacles: Vec<Surface>,
    /// The robot's rotors.
    pub rotors: Vec<Rotor>,
    /// Radius of the ball that holds the robot, m.
    pub radius: f64,
}

/// One measure over all judged cases.
#[derive(Debug, Clone, PartialEq)]
pub struct Metric {
    /// Name: `max deviation`.
    pub name: &'static str,
    /// Unit.
    pub unit: &'static str,
    /// The specification's limit.
    pub limit: Option<f64>,
    /// Whether smaller is worse.
    pub lower_is_worse: bool,
    /// One value per case that has one, in the order of the results.
    pub values: Vec<f64>,
}

/// A case that is shown in full.
#[derive(Debug, Clone, PartialEq)]
pub struct Shown {
    /// Its result.
    pub result: CaseResult,
    /// Waypoints, m.
    pub waypoints: Vec<Point3<f64>>,
    /// Evidence word, with what was proven of the score: [`Case::claim`].
    pub claim: String,
    /// The attitude at the worst moment, in words: `nose up 12°, left side up 8°`.
    pub attitude: Option<String>,
    /// Score.
    pub score: f64,
    /// The planned motion.
    pub planned: Track,
    /// The worst run; `None` where the executor failed.
    pub flown: Option<Track>,
    /// Distance from the reference at each stamp of `flown`, m.
    pub distances: Vec<f64>,
    /// Whether it was judged there: inside `corner_m` of a waypoint overshoot is, instead.
    pub judged: Vec<bool>,
    /// Of the judged distances.
    pub statistics: Option<Statistics>,
}

/// Everything in a report.
#[derive(Debug, Clone, PartialEq)]
pub struct ReportData {
    /// What was tested: the robot's name.
    pub title: String,
    /// The verdict.
    pub verdict: Verdict,
    /// Label, number, and what it means: what stands in large print.
    pub key_numbers: Vec<[String; 3]>,
    /// Label and value: how the campaign was set up.
    pub facts: Vec<[String; 2]>,
    /// World and robot.
    pub drawing: Drawing,
    /// Limit of the deviation, m.
    pub deviation_limit: Option<f64>,
    /// All results, the worst first.
    pub results: Vec<CaseResult>,
    /// Every measure's values.
    pub metrics: Vec<Metric>,
    /// The worst cases in full, the worst first.
    pub shown: Vec<Shown>,
    /// Assumptions and limits of this run.
    pub assumptions: Vec<String>,
    /// Label and value: frames, altitudes and what is counted, before anything is judged.
    pub frame: Vec<[String; 2]>,
    /// [`Case::claim`] of every case, by number.
    pub claims: BTreeMap<usize, String>,
    /// Which parameter did it.
    pub influences: Vec<Influence>,
}

/// What [`assemble`] is given.
#[derive(Debug, Clone)]
pub struct Pieces<'a> {
    /// The scenario and what it describes.
    pub setup: &'a Setup,
    /// All cases.
    pub cases: &'a [Case],
    /// Their results, in any order.
    pub results: &'a [CaseResult],
    /// What the search did.
    pub tally: &'a Tally,
    /// The verdict.
    pub verdict: Verdict,
    /// Assumptions and limits of this run.
    pub assumptions: Vec<String>,
    /// The cases to show in full, from [`shown`], in any order.
    pub shown: Vec<Shown>,
    /// Label and value: frames, altitudes and what is counted.
    pub frame: Vec<[String; 2]>,
    /// Rank correlations of what was varied.
    pub influences: Vec<Influence>,
}

/// The results' order in tables: failures, then doubts, then passes, each by its deviation, the largest first.
pub fn worst_first(results: &[CaseResult]) -> Vec<&CaseResult> {
    let rank = |result: &CaseResult| match result.status {
        Status::Fail => 0,
        Status::Inconclusive => 1,
        Status::Pass => 2,
        Status::ExecutorFailed => 3,
    };
    let crashed = |result: &CaseResult| result.violations.first().is_some_and(|violation| violation.what == "crash");
    let deviation = |result: &CaseResult| result.measures.as_ref().map_or(0.0, |m| m.max_deviation);
    let mut ordered: Vec<&CaseResult> = results.iter().collect();
    ordered.sort_by(|a, b| {
        (rank(a).cmp(&rank(b)))
            .then(crashed(b).cmp(&crashed(a)))
            .then(deviation(b).total_cmp(&deviation(a)))
            .then(a.case.cmp(&b.case))
    });
    ordered
}

/// A case in full: `run` is the result's worst one. Distances are those that were judged.
///
/// # Errors
/// A track that the judge refuses.
pub fn shown(
    setup: &Setup,
    case: &Case,
    result: &CaseResult,
    planned: Track,
    run: Option<&Run>,
) -> Result<Shown, JudgementError> {
    let flown = run.and_then(|run| run.outcome.as_ref().ok()).map(|flight| flight.track.clone());
    let flown = flown.filter(|track| !track.is_empty());
    // What was judged was judged by the run's own limits. Keys of an edited folder that fit nowhere are the judge's to tell.
    let drawn = vary::apply(&setup.scenario, &result.drawn);
    let deviation = drawn.as_ref().unwrap_or(&setup.scenario).spec.deviation;
    let reference = match deviation.map_or(DeviationFrom::Leg, |spec| spec.from) {
        DeviationFrom::Leg => Reference::Leg,
        DeviationFrom::NearestLeg => Reference::NearestLeg,
        DeviationFrom::Path => Reference::Path(&planned),
    };
    let (mut distances, mut judged) = (Vec::new(), Vec::new());
    if let Some(track) = &flown {
        let settings = Settings { reference, corner: deviation.map_or(0.0, |spec| spec.corner_m), clearance: None };
        let everywhere = Settings { corner: 0.0, ..settings };
        let all = deviation_of_samples(track, &case.waypoints, &everywhere)?;
        distances = all.into_iter().map(Option::unwrap_or_default).collect();
        judged = deviation_of_samples(track, &case.waypoints, &settings)?.iter().map(Option::is_some).collect();
    }
    let counted: Vec<f64> = distances.iter().zip(&judged).filter(|(_, judged)| **judged).map(|(d, _)| *d).collect();
    Ok(Shown {
        result: result.clone(),
        waypoints: case.waypoints.clone(),
        claim: case.claim(),
        attitude: flown.as_ref().zip(result.measures.as_ref()).map(|(track, measures)| worst_attitude(track, measures)),
        score: case.score,
        planned,
        flown,
        distances,
        judged,
        statistics: Statistics::of(&counted),
    })
}

/// The attitude at the stamp nearest to the worst moment, in words.
fn worst_attitude(track: &Track, measures: &Measures) -> String {
    let after = track.times().partition_point(|t| *t < measures.t_worst).min(track.len() - 1);
    let before = after.saturating_sub(1);
    let apart = |stamp: usize| (track.times()[stamp] - measures.t_worst).abs();
    let nearest = if apart(before) < apart(after) { before } else { after };
    attitude(&track.poses()[nearest].rotation)
}

/// Puts the pieces of a report together.
pub fn assemble(pieces: Pieces) -> ReportData {
    let order = |shown: &Shown| -> usize {
        let ordered = worst_first(pieces.results);
        ordered.iter().position(|result| result.case == shown.result.case).unwrap_or(usize::MAX)
    };
    let mut shown = pieces.shown.clone();
    shown.sort_by_cached_key(order);
    let robot = &pieces.setup.robot;
    ReportData {
        title: robot.name.clone(),
        verdict: pieces.verdict.clone(),
        key_numbers: key_numbers(&pieces),
        facts: facts(&pieces),
        drawing: Drawing {
            size: pieces.setup.world.size(),
            obstacles: pieces.setup.world.obstacles().iter().map(surface).collect(),
            rotors: robot.rotors.iter().map(|r| Rotor { x: r.x, y: r.y, clockwise: r.spin > 0.0 }).collect(),
            radius: robot.clearance_radius,
        },
        deviation_limit: pieces.setup.scenario.spec.deviation.map(|spec| spec.max_m),
        results: worst_first(pieces.results).into_iter().cloned().collect(),
        metrics: metrics(&pieces),
        shown,
        assumptions: pieces.assumptions,
        frame: pieces.frame,
        claims: pieces.cases.iter().map(|case| (case.number, case.claim())).collect(),
        influences: pieces.influences,
    }
}

fn key_numbers(pieces: &Pieces) -> Vec<[String; 3]> {
    let of = |a: &str, b: String, c: String| [a.to_owned(), b, c];
    let judged = pieces.results.iter().filter(|r| matches!(r.status, Status::Pass | Status::Fail)).count();
    let failed = pieces.results.iter().filter(|r| r.status == Status::Fail).count();
    let mut numbers = Vec::new();
    if let Some((worst, measures)) = largest_deviation(pieces.results) {
        let limit = pieces.setup.scenario.spec.deviation;
        let limit = limit.map_or("no limit set".into(), |spec| format!("limit {} m", number(Some(spec.max_m))));
        numbers.push(of("largest deviation", format!("{} m", number(Some(measures.max_deviation))), limit));
        let place = format!("t = {} s, leg {}", number(Some(measures.t_worst)), leg(measures.leg_worst));
        numbers.push(of("in case", cells(worst)[0].clone(), place));
    }
    let confidence = pieces.setup.scenario.spec.confidence.unwrap_or(0.95);
    let interval = share(failed, judged, confidence).map_or("none judged".into(), |share| {
        format!("{:.1} % [{:.1}, {:.1}]", 100.0 * share.value, 100.0 * share.low, 100.0 * share.high)
    });
    numbers.push(of("violations", format!("{failed} of {judged}"), interval));
    let tally = pieces.tally;
    let asked = pieces.setup.scenario.generate.search.cases;
    let origin = if tally.missions.is_empty() {
        format!("{asked} asked for; {} of {} graphs had one", tally.solved, tally.graphs)
    } else {
        "missions made elsewhere".into()
    };
    numbers.push(of("cases", pieces.cases.len().to_string(), origin));
    numbers
}

fn largest_deviation(results: &[CaseResult]) -> Option<(&CaseResult, &Measures)> {
    let measured = results.iter().filter_map(|result| result.measures.as_ref().map(|m| (result, m)));
    measured.max_by(|a, b| a.1.max_deviation.total_cmp(&b.1.max_deviation).then(b.0.case.cmp(&a.0.case)))
}

fn facts(pieces: &Pieces) -> Vec<[String; 2]> {
    let (scenario, robot) = (&pieces.setup.scenario, &pieces.setup.robot);
    let (generate, execute) = (&scenario.generate, &scenario.execute);
    let caveat = if robot.caveat.is_empty() { String::new() } else { format!(" ({})", robot.caveat) };
    let size = pieces.setup.world.size();
    let point = |p: [f64; 3]| format!("({}, {}, {})", p[0], p[1], p[2]);
    let executor = match (&execute.controller, &execute.command) {
        (Some(controller), _) => format!("{}, simulated", word(controller)),
        (None, Some(command)) => format!("`{command}`"),
        (None, None) => "none".into(),
    };
    let task = &scenario.task;
    let search = format!(
        "{}, width {}, {} waypoints per graph, score {}",
        word(&generate.search.method),
        generate.search.width,
        generate.search.waypoints,
        generate.score
    );
    let fact = |label: &str, value: String| [label.to_owned(), value];
    vec![
        fact("robot", format!("{}{caveat}", robot.name)),
        fact("world", format!("{} × {} × {} m, {} obstacles", size.x, size.y, size.z, scenario.world.obstacles.len())),
        fact("task", format!("{} waypoints from {} to {} m", task.length, point(task.start_m), point(task.end_m))),
        fact("reach set", word(&generate.reach)),
        fact("search", search),
        fact("executor", executor),
        fact("runs", format!("{} per case, the worst counts", execute.repeat)),
        fact("root seed", scenario.seed.to_string()),
    ]
}

/// A key's word, as it stands in scenario files.
fn word(value: &impl Serialize) -> String {
    serde_json::to_value(value).ok().and_then(|value| value.as_str().map(str::to_owned)).unwrap_or_default()
}

fn metrics(pieces: &Pieces) -> Vec<Metric> {
    let spec = &pieces.setup.scenario.spec;
    let metric = |name, unit, limit, of: fn(&Measures) -> Option<f64>| Metric {
        name,
        unit,
        limit,
        lower_is_worse: name == "clearance",
        values: pieces.results.iter().filter_map(|result| result.measures.as_ref().and_then(of)).collect(),
    };
    let all = vec![
        metric("max deviation", "m", spec.deviation.map(|s| s.max_m), |m| Some(m.max_deviation)),
        metric("mean deviation", "m", None, |m| Some(m.mean_deviation)),
        metric("overshoot", "m", spec.overshoot.map(|s| s.max_m), |m| Some(m.max_overshoot())),
        metric("acceleration", "m/s²", spec.acceleration.map(|s| s.max_m_s2), |m| Some(m.max_acceleration)),
        metric("total time", "s", spec.total_time.map(|s| s.max_s), |m| Some(m.total_time)),
        metric("clearance", "m", spec.clearance.map(|s| s.min_m), |m| m.min_clearance),
        metric("saturation", "%", None, |m| m.saturation_share.map(|share| 100.0 * share)),
    ];
    all.into_iter().filter(|metric| !metric.values.is_empty()).collect()
}
