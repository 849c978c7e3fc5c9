//! A report's contents: assembled once from a judged campaign, shown by whatever format.

use std::collections::BTreeMap;

use nalgebra::Point3;

use super::length::{Length, length};
use super::text::{attitude, violation};
use crate::campaign::gravity::Standing;
use crate::campaign::judge::reference;
use crate::campaign::kind::{Drawing, Surface};
use crate::campaign::scenario::{DeviationFrom, Terms};
use crate::campaign::{
    Baseline, Case, CaseNumber, CaseResult, Coverage, Curve, Environment, Influence, RoundTally, Run, Setup, Tally,
    vary,
};
use crate::judgement::moves::Regression;
use crate::judgement::{
    JudgementError, Measures, Reference, Settings, Statistics, Stress, Verdict, deviation_of_samples,
};
use crate::trajectory::Track;

/// One measure over all judged cases.
///
/// A table's column, or a distribution with its limit.
#[derive(Debug, Clone, PartialEq)]
pub struct Metric {
    /// Name: `max deviation`.
    pub name: &'static str,
    /// Unit that the specification is told in.
    pub unit: &'static str,
    /// The specification's limit, in [`Self::unit`].
    pub limit: Option<f64>,
    /// Whether smaller is worse.
    pub lower_is_worse: bool,
    /// One per result, in the order of [`ReportData::results`]; `None` where it was not measured.
    ///
    /// In [`Self::unit`].
    pub values: Vec<Option<f64>>,
    /// Of random feasible cases that were run alike.
    /// In [`Self::unit`], without order.
    pub random: Vec<f64>,
}

/// What stands beside the runs and the cases of a report.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Beside {
    /// Beside the run that is shown of a case.
    pub runs: &'static str,
    /// Beside the cases in distributions.
    pub cases: &'static str,
    /// What that run of a case is called.
    pub shown: &'static str,
}

impl Default for Beside {
    fn default() -> Self {
        Self { runs: "other runs", cases: "random feasible cases", shown: "this run" }
    }
}

/// The moment at which a case is opened.
#[derive(Debug, Clone, PartialEq)]
pub struct Moment {
    /// s.
    pub at: f64,
    /// The violation, or the largest deviation, in words.
    pub told: String,
    /// The same in a few, to stand beside it.
    pub mark: String,
}

/// A case that is shown in full.
///
/// Tracks and waypoints in the world's frame, m; what the kind draws around them is [`ReportData::drawing`].
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
    /// What was found beside its waypoints, in words.
    pub environment: Vec<String>,
    /// The obstacles of it.
    pub obstacles: Vec<Surface>,
    /// The planned motion.
    pub planned: Track,
    /// The worst run; `None` where the executor failed.
    pub flown: Option<Track>,
    /// Distance from the reference at each stamp of `flown`, m.
    ///
    /// Also where it is not judged; 0 where the judge compares nothing.
    pub distances: Vec<f64>,
    /// Whether it was judged there: inside `corner_m` of a waypoint overshoot is, instead.
    ///
    /// As long as [`Self::distances`].
    pub judged: Vec<bool>,
    /// Of the judged distances.
    ///
    /// `None` where none was.
    pub statistics: Option<Statistics>,
    /// The moment of the gravest violation, or of the largest deviation where none is violated.
    pub moment: Option<Moment>,
    /// Its other runs and how far each was from the reference at its stamps, m.
    pub others: Vec<OtherRun>,
}

/// A run to be shown.
#[derive(Debug, Clone, Copy)]
pub struct Drawn<'a> {
    /// The run.
    pub run: &'a Run,
    /// Of a log: samples before which something was cut out.
    pub breaks: &'a [usize],
}

impl<'a> From<&'a Run> for Drawn<'a> {
    fn from(run: &'a Run) -> Self {
        Self { run, breaks: &[] }
    }
}

/// Another run of a case that is shown.
#[derive(Debug, Clone, PartialEq)]
pub struct OtherRun {
    /// Its number.
    pub run: usize,
    /// Its motion.
    pub flown: Track,
    /// m, one a stamp.
    pub distances: Vec<f64>,
}

impl Shown {
    /// Where it was, and where it was planned to be.
    /// What a drawing's bounds come of: waypoints, plan, flown.
    pub fn places(&self) -> impl Iterator<Item = Point3<f64>> {
        let of = |track: &'_ Track| (0..track.len()).map(|i| track.position(i)).collect::<Vec<_>>();
        self.waypoints.clone().into_iter().chain(of(&self.planned)).chain(self.flown.as_ref().map_or(Vec::new(), of))
    }
}

/// Everything in a report.
///
/// Formats need nothing else: no file is read, and nothing is judged, when a page is made of it.
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
    /// What lengths of the verdict are told in, with the limit of the deviation.
    pub length: Length,
    /// The case that the verdict names, or else the first that is shown: the page opens with it.
    pub opens: Option<CaseNumber>,
    /// What stands beside them.
    pub beside: Beside,
    /// What logs are called, where they are what is shown and not the cases of a campaign; by the number of a result.
    pub logs: BTreeMap<CaseNumber, String>,
    /// The campaign's folder, where that is not the one that the page lies in.
    pub folder: Option<String>,
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
    pub claims: BTreeMap<CaseNumber, String>,
    /// Which parameter did it.
    pub influences: Vec<Influence>,
    /// Of arms with a baseline: its moves against this campaign's.
    pub regression: Option<Regression>,
    /// Which cells of the grid of motion were met.
    pub coverage: Option<Coverage>,
    /// Confidence of intervals, 0 … 1.
    pub confidence: f64,
    /// What searches that execute look for.
    pub stress: Stress,
    /// What their curves are told in: the stress as columns are named, or `margin_in_spreads` of several limits,
    /// `target` of a function of the user's.
    pub told_in: String,
    /// Of such searches: the largest stress so far in every graph.
    pub curves: Vec<Curve>,
    /// Of adaptive campaigns.
    pub rounds: Vec<RoundTally>,
}

impl ReportData {
    /// What a result is called: by its case's number, or by its log's name.
    pub fn name(&self, case: CaseNumber) -> String {
        self.logs.get(&case).cloned().unwrap_or_else(|| case.to_string())
    }
}

/// What [`super::assemble`] is given.
#[derive(Debug, Clone)]
pub struct Pieces<'a> {
    /// The scenario and what it describes.
    pub setup: &'a Setup,
    /// All cases.
    pub cases: &'a [Case],
    /// Their results, in any order.
    pub results: &'a [CaseResult],
    /// What the search did, where cases are a search's.
    pub tally: Option<&'a Tally>,
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
    /// Which cells of the grid of motion were met.
    pub coverage: Option<Coverage>,
    /// What random feasible cases came to.
    pub baseline: Option<Baseline>,
    /// Their results.
    pub random: &'a [CaseResult],
    /// The case to open, where that is not the one that the verdict names.
    pub asked: Option<CaseNumber>,
}

/// The results' order in tables: failures, then doubts, then passes, each by its deviation, the largest first, failures
/// by the largest share of a limit that it is broken by.
///
/// Within each, crashes come before all else, and equals in the order of their numbers. Executors that failed are last:
/// they say nothing of the robot.
pub fn worst_first(results: &[CaseResult]) -> Vec<&CaseResult> {
    let mut ordered: Vec<(Standing, &CaseResult)> =
        results.iter().map(|result| (Standing::of(result), result)).collect();
    ordered.sort_by(|(a, one), (b, other)| b.against(a).then(one.case.cmp(&other.case)));
    ordered.into_iter().map(|(_, result)| result).collect()
}

/// A case in full: `run` is the result's worst one, `others` are drawn beside it. Distances are those that were judged.
///
/// `case` has its witness: what is followed comes of it. The reference is the scenario's with the run's own draws:
/// the leg being executed, the nearer of it and the one before, or the path that is followed.
///
/// # Errors
/// A track that the judge refuses.
pub fn shown(
    setup: &Setup,
    case: &Case,
    result: &CaseResult,
    planned: Track,
    run: Option<Drawn>,
    others: &[Run],
) -> Result<Shown, JudgementError> {
    let breaks = run.map_or(&[][..], |drawn| drawn.breaks);
    let flown = run.and_then(|drawn| drawn.run.outcome.as_ref().ok()).map(|flight| flight.track.clone());
    let flown = flown.filter(|track| !track.is_empty());
    // What was judged was judged by the run's own limits. Keys of an edited folder that fit nowhere are the judge's to
    // tell.
    let drawn = vary::apply(&setup.scenario, &result.drawn);
    let Terms { from, corner, .. } = drawn.as_ref().unwrap_or(&setup.scenario).head().terms;
    let followed = match from {
        DeviationFrom::Path => {
            let programmed = setup.kind().programs().and_then(|programs| programs.programmed(case));
            reference(setup, case, programmed.as_ref())
        }
        _ => None,
    };
    let compared = match from {
        DeviationFrom::Leg => Reference::Leg,
        DeviationFrom::NearestLeg => Reference::NearestLeg,
        DeviationFrom::Path => Reference::Path(followed.as_ref().unwrap_or(&planned)),
    };
    let (mut distances, mut judged) = (Vec::new(), Vec::new());
    let settings = Settings { reference: compared, corner, ..Settings::default() };
    let everywhere = Settings { corner: 0.0, ..settings };
    let along = |track: &Track, breaks: &[usize]| -> Result<Vec<f64>, JudgementError> {
        let all = deviation_of_samples(track, &case.waypoints, &Settings { breaks, ..everywhere })?;
        Ok(all.into_iter().map(Option::unwrap_or_default).collect())
    };
    if let Some(track) = &flown {
        distances = along(track, breaks)?;
        let settings = Settings { breaks, ..settings };
        judged = deviation_of_samples(track, &case.waypoints, &settings)?.iter().map(Option::is_some).collect();
    }
    // A run that is no track is told by the judge; beside the worst one it is left out.
    let other = |run: &Run| {
        let flown = run.outcome.as_ref().ok()?.track.clone();
        let distances = (!flown.is_empty()).then(|| along(&flown, &[]).ok()).flatten()?;
        Some(OtherRun { run: run.run, flown, distances })
    };
    let others = others.iter().filter(|run| run.run != result.run).filter_map(other).collect();
    let counted: Vec<f64> = distances.iter().zip(&judged).filter(|(_, judged)| **judged).map(|(d, _)| *d).collect();
    Ok(Shown {
        result: result.clone(),
        waypoints: case.waypoints.clone(),
        claim: case.claim(),
        attitude: (flown.as_ref().zip(result.measures.as_ref()))
            .filter(|_| setup.kind().robot_words().has_sides)
            .map(|(track, measures)| worst_attitude(track, measures)),
        score: case.score,
        environment: (case.environment.iter().flat_map(Environment::words))
            .chain(result.elsewhere.iter().map(|one| format!("violated in {one}")))
            .collect(),
        obstacles: own_obstacles(setup, case),
        planned: setup.kind().posed(case, planned),
        flown,
        distances,
        judged,
        statistics: Statistics::of(&counted),
        moment: moment(result, &length(setup)),
        others,
    })
}

/// When a case is opened, and why then.
fn moment(result: &CaseResult, length: &Length) -> Option<Moment> {
    if let Some(first) = result.violations.first() {
        let mark = first.event().unwrap_or_else(|| match first.what.as_str() {
            "deviation" => first.printed().0,
            what => format!("{} {}", what.replace('-', " "), first.printed().0),
        });
        return Some(Moment { at: first.at, told: violation(first), mark });
    }
    let measures = result.measures.as_ref()?;
    let mark = length.told(measures.max_deviation);
    // Another run may deviate more than the one that is shown, which is the worst by what is limited.
    let whose = match result.measured().is_some_and(|all| all.max_deviation > measures.max_deviation) {
        true => format!(" of run {}", result.run),
        false => String::new(),
    };
    let told = format!("largest deviation{whose} {mark} at t={:.2} s", measures.t_worst);
    Some(Moment { at: measures.t_worst, told, mark })
}

/// The obstacles and keep-outs that stand around the waypoints of `case`, its own ones last.
/// Where the case's environment does not fit the scenario, the scenario's alone.
pub fn surroundings(setup: &Setup, case: &Case) -> Vec<Surface> {
    let of = |setup: &Setup| setup.kind().drawing(&case.waypoints).obstacles;
    setup.around(case).map_or_else(|_| of(setup), |around| of(&around))
}

/// The obstacles and keep-outs that only `case` has.
fn own_obstacles(setup: &Setup, case: &Case) -> Vec<Surface> {
    let (Some(_), Ok(around)) = (&case.environment, setup.around(case)) else { return Vec::new() };
    let of = |setup: &Setup| setup.kind().drawing(&case.waypoints).obstacles;
    of(&around).split_off(of(setup).len())
}

/// The attitude at the stamp nearest to the worst moment, in words.
fn worst_attitude(track: &Track, measures: &Measures) -> String {
    let after = track.times().partition_point(|t| *t < measures.t_worst).min(track.len() - 1);
    let before = after.saturating_sub(1);
    let apart = |stamp: usize| (track.times()[stamp] - measures.t_worst).abs();
    let nearest = if apart(before) < apart(after) { before } else { after };
    attitude(&track.poses()[nearest].rotation)
}
