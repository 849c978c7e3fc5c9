//! From results to the one sentence.
//!
//! Gathers what [`fn@judgement::verdict`] says, which knows no scenario: counts, worst, claims, intervals, budget. The
//! sentence and the exit code are made there.

use std::collections::BTreeMap;

use super::case::{Undone, gap_word};
use super::chance::Baseline;
use super::digits::grouped;
use super::gravity::Gravity;
use super::scenario::{Asked, UNMEASURED, shapes_the_plan};
use super::{Case, CaseNumber, CaseResult, Evidence, Reruns, Setup, Status, Tally};
use crate::judgement::{self, Beside, Claim, Judged, Measures, Verdict, Violation, Worst, nearest};

/// The verdict on a campaign: on its results, beside the cases by chance that were run alike if there are any; or that
/// nothing was feasible.
///
/// `results` belong to `cases`, and may be fewer. Without cases the verdict is `NOTHING FEASIBLE` (3), or
/// `INCONCLUSIVE` (5) where a time ended the search, or nothing that was executed came to a measure, or `EXECUTOR
/// FAILED` (4) where some of that failed.
pub fn verdict(setup: &Setup, cases: &[Case], judged: (&[CaseResult], Option<&Baseline>), tally: &Tally) -> Verdict {
    let runs = judged.0.len() * setup.scenario.executor().repeat as usize;
    verdict_on(setup, cases, judged, tally, runs)
}

/// [`verdict`], where so many of the cases' `runs` came to a flight: those that a program refused are told beside a
/// violation, and are none of those that the worst is the worst of.
pub fn verdict_on(
    setup: &Setup,
    cases: &[Case],
    (results, baseline): (&[CaseResult], Option<&Baseline>),
    tally: &Tally,
    runs: usize,
) -> Verdict {
    let asked = tally.asked(setup.scenario.search().cases);
    if cases.is_empty() {
        return match tally.nothing.as_deref() {
            _ if tally.stopped => nothing_found(setup, tally, asked),
            // Whether anything is stressful was not found out where who executes gave up.
            Some(why) if !tally.failures.is_none() => {
                judgement::search_in_vain(search_failed(tally), search_trouble(tally), why)
            }
            Some(UNMEASURED) => nothing_measured(setup, tally, asked),
            _ => nothing_feasible(setup, tally, None),
        };
    }
    let count = |status: Status| results.iter().filter(|result| result.status == status).count();
    let words: Vec<String> = Evidence::ALL.iter().map(|evidence| claim_words(*evidence, setup, tally)).collect();
    let claims: Vec<Claim> = Evidence::ALL
        .iter()
        .zip(&words)
        .map(|(evidence, word)| Claim { word, count: cases.iter().filter(|case| case.evidence == *evidence).count() })
        .filter(|claim| claim.count > 0)
        .collect();
    let worst = named(setup, results);
    let case = worst.as_ref().map(|named| named.case.to_string()).unwrap_or_default();
    let how = how_obtained(setup);
    let how: Vec<&str> = how.iter().map(String::as_str).collect();
    let gaps: Option<Vec<f64>> = cases.iter().map(Case::gap).collect();
    let proof = gaps.map(|gaps| gap_word(gaps.into_iter().fold(0.0, f64::max), "gap at most"));
    let confidence = setup.scenario.confidence_of_intervals();
    let draws = |result: &CaseResult| result.draws.map(|draws| [draws.violated, draws.of]);
    let reruns = rerun_words(results, confidence, setup.repeats());
    let trouble = trouble(results).unwrap_or_default();
    let undone = |what: Undone| results.iter().filter(|result| result.is_undone(what)).count();
    let undone = [undone(Undone::NotExecuted), undone(Undone::NotJudged)];
    let cut = cut_words(tally, undone, results.len());
    let is_doubt = |result: &&CaseResult| result.status == Status::Inconclusive && !result.is_left_undone();
    let doubt = results.iter().find(is_doubt);
    let doubt = doubt.and_then(|result| Some(format!("{}, {}", result.case, result.message.as_ref()?)));
    let searched: u64 = tally.curves.iter().map(|curve| curve.executions).sum();
    let flown = format!("{} flown", grouped(searched + runs as u64));
    let alone = worst.as_ref().is_none_or(|named| named.value.what == "deviation");
    let beside = baseline.map(|baseline| (flown, baseline.in_words(setup, alone)));
    let unfelt = setup.unfelt_draws().map(|why| format!("what `[vary]` draws is no draw of any run: {why}"));
    let (undrawn, unknown) = (not_drawn(setup), setup.unknown_shapes());
    let past = tally.past_failures_in_words();
    let stopped = (tally.stopped && cut.is_none()).then(|| stopped_words(searched));
    let passed_over: Vec<String> = passed_over(setup, cases, results)
        .into_iter()
        .chain(unfelt)
        .chain(undrawn)
        .chain(stopped)
        .chain(past)
        .collect();
    let repeat = setup.scenario.executor().repeat as usize;
    let carried_out = if setup.recordings().is_none() { (results.len() - undone[0]) * repeat } else { runs };
    judgement::verdict(&Judged {
        how: &how,
        runs: repeat,
        unflown: [carried_out.saturating_sub(runs), carried_out],
        cases: results.len(),
        limited: setup.scenario.asked() == Asked::Limits,
        asked,
        failed: count(Status::Fail),
        executor_failed: count(Status::ExecutorFailed),
        inconclusive: results.iter().filter(is_doubt).count(),
        undone: undone.iter().sum(),
        cut: cut.as_deref(),
        // Whoever executes anew decides for itself.
        search_failed: if tally.failures.is_past { [0, 0] } else { search_failed(tally) },
        search_trouble: search_trouble(tally),
        trouble: &trouble,
        doubt: doubt.as_deref().unwrap_or_default(),
        worst: worst.as_ref().map(|named| Worst { case: &case, value: &named.value, saturation: named.saturation }),
        beside: beside.as_ref().map(|(of, by_chance)| Beside { of, by_chance }),
        share_limit: setup.scenario.violation_share(),
        confidence,
        chosen: tally.chosen(&setup.scenario.search()),
        draws: if let [only] = results { draws(only) } else { None },
        claims: &claims,
        reruns: reruns.as_deref(),
        passed_over: &passed_over,
        estimated: unknown.as_deref(),
        proof: proof.as_deref(),
    })
}

/// Executions of the search that failed, of how many.
fn search_failed(tally: &Tally) -> [u64; 2] {
    if tally.failures.is_none() { [0, 0] } else { [tally.failures.failed, tally.executed()] }
}

/// Why one of them did.
fn search_trouble(tally: &Tally) -> &str {
    tally.failures.why.as_deref().unwrap_or_default()
}

/// `0001, my simulator, run 0: ended without "end"`: the first case that the executor failed to fly, and why.
fn trouble(results: &[CaseResult]) -> Option<String> {
    let failed = results.iter().find(|result| result.status == Status::ExecutorFailed)?;
    let why = failed.message.as_ref().map_or(String::new(), |message| format!(", {message}"));
    Some(format!("{}{why}", failed.case))
}

/// `2 of 20 legs within corner_m of their waypoints: no deviation judged there`, of the worst runs.
fn passed_over(setup: &Setup, cases: &[Case], results: &[CaseResult]) -> Option<String> {
    let terms = setup.scenario.head().terms;
    if terms.corner <= 0.0 {
        return None;
    }
    let waypoints: BTreeMap<CaseNumber, _> = cases.iter().map(|case| (case.number, &case.waypoints)).collect();
    let (mut within, mut of) = (0, 0);
    for result in results {
        let (Some(measures), Some(waypoints)) = (&result.measures, waypoints.get(&result.case)) else { continue };
        within += terms.in_corners(measures, waypoints);
        of += measures.legs.len();
    }
    (within > 0).then(|| format!("{within} of {of} legs within corner_m of their waypoints: no deviation judged there"))
}

/// Where a case has its nominal run alone, of which nothing is drawn though `[vary]` has something for runs.
fn not_drawn(setup: &Setup) -> Option<String> {
    let drawn = setup.scenario.vary().keys().any(|key| !shapes_the_plan(key));
    let alone = setup.scenario.executor().repeat == 1 && setup.recordings().is_none();
    (drawn && alone).then(|| "nothing of `vary` was drawn: execute.repeat = 1".into())
}

/// `clear: all links`, and `… within 15 mm of the path` where the judgement lets runs be farther off it: evidence
/// belongs to the limit that it was proven for.
fn claim_words(evidence: Evidence, setup: &Setup, tally: &Tally) -> String {
    let within = tally.proven_short_of(&*setup.scenario).filter(|_| evidence.is_clearance());
    within
        .map_or_else(|| evidence.word().into(), |within| format!("{} within {within} mm of the path", evidence.word()))
}

/// Of a search that a limit of its time ended, or whoever watched: it passes by what it found until then.
fn stopped_words(executions: u64) -> String {
    let after = if executions == 0 { String::new() } else { format!(", after {} executions", grouped(executions)) };
    format!("the search was stopped before its end{after}")
}

/// `cut short by the budget of time: the search after 1 200 of 4 000 executions, 12 of 40 cases not executed`.
fn cut_words(tally: &Tally, [not_executed, not_judged]: [usize; 2], of: usize) -> Option<String> {
    let cases = |count: usize, what: &str| (count > 0).then(|| format!("{count} of {of} cases {what}"));
    let parts: Vec<String> = tally
        .cut
        .iter()
        .cloned()
        .chain(cases(not_executed, "not executed"))
        .chain(cases(not_judged, "not judged"))
        .collect();
    (!parts.is_empty()).then(|| format!("cut short by the budget of time: {}", parts.join(", ")))
}

/// `violations run again 10 times each: 5 of 7 violate every time, least often 0117, 3/10 [6.7, 65.2] %`.
///
/// Where they are all the same run, and why, is told as well: they say nothing of how often it comes again.
fn rerun_words(results: &[CaseResult], confidence: f64, the_same: Option<&str>) -> Option<String> {
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
        words += &format!(", least often {}, {k}/{n} [{low:.1}, {high:.1}] %", result.case);
    }
    // A limit that became tighter since makes violations of what was not one.
    if failed > again.len() {
        words += &format!(", {} not run again", failed - again.len());
    }
    if let Some(why) = the_same {
        words += &format!(", each the same run: {why}");
    }
    Some(words)
}

/// `simulated, anafi stand-in, minimum-snap`, or `executor my simulator`; of logs `hardware, irb120, nightly/*.csv`.
///
/// Two or three words: how, what robot, who steered; of controllers that `[vary]` draws all.
pub fn how_obtained(setup: &Setup) -> Vec<String> {
    if let Some(logs) = setup.recordings() {
        // What was recorded was no stand-in, only what it is held against is computed with one.
        let logs = logs.trim_start_matches("../");
        return vec!["hardware".into(), setup.robot_name().into(), logs.into()];
    }
    let name = setup.robot_name();
    let stand_in = if setup.caveat().is_empty() { name.to_owned() } else { format!("{name} stand-in") };
    let who = match (setup.program(), setup.controllers()) {
        (Some(program), None) => format!("executor {program}"),
        (_, Some(controller)) => match setup.loops() {
            Some(loops) => format!("{controller} on {loops}"),
            None => controller,
        },
        (None, None) => "no controller".into(),
    };
    vec!["simulated".into(), stand_in, who]
}

/// What a verdict names.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Named {
    /// The case of the worst result.
    pub(super) case: CaseNumber,
    /// Its gravest violation; within spec the deviation, or where that is not limited what came nearest to its limit;
    /// in the units that it is told in.
    pub(super) value: Violation,
    /// Share of rotor-time at a limit, 0 … 1, on that leg or run.
    saturation: Option<f64>,
}

/// The worst result, and what is said of it.
///
/// By [`Gravity`]. `None` where nothing was measured, or nothing is limited and nothing violated.
pub(super) fn named(setup: &Setup, results: &[CaseResult]) -> Option<Named> {
    let limits = setup.scenario.head().terms.limits;
    let has_deviation = |measures: &Measures| limits.deviation.is_some() && measures.deviation().is_some();
    let of_others = |measures: &Measures| if has_deviation(measures) { None } else { nearest(measures, &limits) };
    let mut worst: Option<(&CaseResult, &Measures)> = None;
    let gravity = |result: &CaseResult, measures: &Measures| {
        let within = of_others(measures).map_or(measures.max_deviation, |one| one.relative_excess());
        Gravity::of((&result.violations, &result.ended), measures.max_deviation, within)
    };
    for result in results {
        let Some(measures) = &result.measures else { continue };
        if worst.is_none_or(|(so_far, old)| gravity(result, measures) > gravity(so_far, old)) {
            worst = Some((result, measures));
        }
    }
    let (result, measures) = worst?;
    let deviation = || {
        limits.deviation.filter(|_| has_deviation(measures)).map(|limit| Violation {
            what: "deviation".into(),
            value: measures.max_deviation,
            limit,
            unit: "m".into(),
            at: measures.t_worst,
            leg: measures.leg_worst,
        })
    };
    let programs = setup.kind().programs();
    let told = |violation| match programs {
        Some(programs) => programs.in_their_units(violation),
        None => violation,
    };
    let value = result.violations.first().cloned().or_else(|| deviation().or_else(|| of_others(measures)).map(told))?;
    let saturation = measures.legs.get(value.leg).and_then(|leg| leg.saturation_share).or(measures.saturation_share);
    Some(Named { case: result.case, value, saturation })
}

/// The verdict of exit 5 on a search that a time limit ended too soon: that nothing is feasible was not found out.
fn nothing_found(setup: &Setup, tally: &Tally, asked: usize) -> Verdict {
    let searched = format!("{} graphs searched", tally.graphs);
    let how = [searched.as_str(), setup.scenario.reach()];
    let failed = tally.failures_in_words().map_or(String::new(), |failed| format!("; {failed}"));
    let why = tally.nothing.as_ref().map_or(String::new(), |reason| format!(": {reason}")) + &failed;
    let what = format!("stopped before the first trajectory was found{why}");
    judgement::inconclusive(&format!("0/{asked}"), &how, &what)
}

/// The verdict of exit 5 on a search whose executions had nothing of what was searched for: what is feasible was found,
/// and of how stressful it is nothing is known.
fn nothing_measured(setup: &Setup, tally: &Tally, asked: usize) -> Verdict {
    let executed: u64 = tally.curves.iter().map(|curve| curve.executions).sum();
    let executed = format!("{} executed", grouped(executed));
    judgement::inconclusive(&format!("0/{asked}"), &[&executed, setup.scenario.reach()], UNMEASURED)
}

/// The verdict of exit 3 (5 where it rests on nothing but estimates), with what it rests on, and the smallest change
/// that helps where that was looked for.
///
/// "proof" where every graph was proven empty.
pub(super) fn nothing_feasible(setup: &Setup, tally: &Tally, change: Option<&str>) -> Verdict {
    let is_proven = tally.proven_empty > 0 && tally.proven_empty == tally.graphs;
    let rests_on = if is_proven { "proof".into() } else { format!("{} graphs searched", tally.graphs) };
    let mut chain = setup.kind().facts().nothing;
    if is_proven && !setup.has_programs() {
        // Others, drawn for more cases, may have one.
        chain +=
            &format!(" in {} {} that were drawn", tally.graphs, if tally.graphs == 1 { "graph" } else { "graphs" });
    }
    let what = match &tally.nothing {
        Some(reason) => format!("{chain}: {reason}"),
        None => chain,
    };
    if let Some(open) = setup.kind().programs().and_then(|programs| programs.not_found_out()) {
        return judgement::inconclusive("0", &[&rests_on, setup.scenario.reach()], &format!("{what}; {open}"));
    }
    judgement::nothing_feasible(&[&rests_on, setup.scenario.reach()], &what, change)
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;

    #[test]
    fn a_failed_executor_is_told_with_its_case() {
        let told = |case, status, message: &str| CaseResult {
            message: Some(message.to_owned()),
            ..CaseResult::bare(CaseNumber(case), status)
        };
        let open = told(0, Status::Inconclusive, "run 0: a gap");
        assert_eq!(trouble(std::slice::from_ref(&open)), None);
        let failed = told(1, Status::ExecutorFailed, "sim, run 0: no licence");
        assert_eq!(trouble(&[open, failed]).as_deref(), Some("0001, sim, run 0: no licence"));
    }

    #[test]
    fn reruns_without_chance_are_told_to_be_the_same_run() {
        let reruns = Some(Reruns { violated: 3, of: 3 });
        let results = [CaseResult { reruns, ..CaseResult::bare(CaseNumber(0), Status::Fail) }];
        let words = |the_same| rerun_words(&results, 0.95, the_same).expect("they were run again");
        assert_eq!(words(None), "violations run again 3 times each: 1 of 1 violate every time");
        assert!(words(Some("no gusts")).ends_with("violate every time, each the same run: no gusts"));
    }
}
