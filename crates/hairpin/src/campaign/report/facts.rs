//! What a report says in words and numbers beside its pictures.

use super::data::{Metric, Pieces, worst_first};
use super::length::length;
use super::text::leg;
use crate::campaign::digits::grouped;
use crate::campaign::kind::{Facts, word};
use crate::campaign::scenario::{Asked, SearchMethod};
use crate::campaign::verdict::{Named, named};
use crate::campaign::{CaseResult, Setup, Status, Tally};
use crate::judgement::{Chosen, Measures, Stress};

/// Largest deviation and its case, the violations among judged cases, with their share's interval at the scenario's
/// confidence (0.95 if none is given) where cases were drawn at random, and the number of cases.
pub(super) fn key_numbers(pieces: &Pieces) -> Vec<[String; 3]> {
    let of = |a: &str, b: String, c: String| [a.to_owned(), b, c];
    let judged =
        pieces.results.iter().filter(|r| matches!(r.status, Status::Pass | Status::Fail | Status::Unjudged)).count();
    let failed = pieces.results.iter().filter(|r| r.status == Status::Fail).count();
    let mut numbers = Vec::new();
    let told = length(pieces.setup);
    if let Some(Named { case, value, .. }) = named(pieces.setup, pieces.results) {
        let what = format!("worst: {}", value.what.replace('-', " "));
        match value.event() {
            Some(event) => numbers.push(of("worst", event, format!("at t = {:.2} s", value.at))),
            None => {
                let (number, limit) = value.printed();
                numbers.push(of(&what, number, format!("limit {limit}")));
            }
        }
        numbers.push(of("in case", case.to_string(), format!("t = {:.2} s, leg {}", value.at, leg(value.leg))));
    }
    // The verdict may name something else, in another case.
    if let Some((worst, measures)) = largest_deviation(pieces.results)
        && named(pieces.setup, pieces.results).is_none_or(|named| named.value.what != "deviation")
    {
        let limit = told.limit_beside(measures.max_deviation);
        let limit = limit.map_or("no limit set".into(), |limit| format!("limit {limit}"));
        let place = format!("case {}, t = {:.2} s, {limit}", worst.case, measures.t_worst);
        numbers.push(of("largest deviation", told.told(measures.max_deviation), place));
    }
    if let Some(random) = &pieces.baseline {
        let setup = pieces.setup;
        let interval =
            random.interval_in_words(setup).map_or(String::new(), |interval| format!("{interval} in the mean, 95 %; "));
        let stress = random.stress_percent(pieces.results);
        let stress = stress.map_or(String::new(), |percent| format!("; these cases {percent:+.0} %"));
        let all = format!("{}{}", random.cases, random.others_in_words());
        let note = format!("{interval}{} at worst of {all}{stress}", random.told(setup, random.worst));
        let what = match random.stress {
            Stress::MaxDeviation => "random feasible cases".to_owned(),
            other => format!("random feasible cases: {}", other.word().replace('-', " ")),
        };
        numbers.push(of(&what, random.told(setup, random.mean), note));
    }
    // What was not searched for has no search to be counted.
    let Some(tally) = pieces.tally else { return numbers };
    let confidence = pieces.setup.scenario.confidence_of_intervals();
    let chosen = tally.chosen(&pieces.setup.scenario.search());
    let share = match (chosen.share(failed, judged, confidence), chosen) {
        _ if pieces.setup.scenario.asked() != Asked::Limits => "crashes alone: spec = \"none\"".into(),
        _ if judged == 0 => "none judged".into(),
        (Some(share), _) => {
            format!("{:.1} % [{:.1}, {:.1}]", 100.0 * share.value, 100.0 * share.low, 100.0 * share.high)
        }
        (None, Chosen::Searched) => "of cases that were searched: no estimate of how often others do".into(),
        (None, _) => "of these cases: no estimate of how often others do".into(),
    };
    numbers.push(of("violations", format!("{failed} of {judged}"), share));
    numbers.push(of("cases", pieces.cases.len().to_string(), origin(pieces.setup, tally)));
    numbers
}

/// How the cases were come by.
///
/// By what the tally says: missions, selected cases, the worst that were executed, or one a graph.
fn origin(setup: &Setup, tally: &Tally) -> String {
    let search = setup.scenario.search();
    let (asked, graphs) = (search.cases, grouped(tally.graphs));
    match search.method {
        _ if !tally.missions.is_empty() => "missions made elsewhere".into(),
        _ if tally.selected => "selected from those of another campaign".into(),
        SearchMethod::Worst => {
            let executed: u64 = tally.curves.iter().map(|curve| curve.executions).sum();
            let of = format!("{asked} asked for: the worst of {} that were executed", grouped(executed));
            format!("{of}; {} of these were drawn at random, the others made from bad ones", grouped(tally.drawn))
        }
        _ => {
            format!("{asked} asked for; {} of {graphs} sampled graphs had a feasible trajectory", grouped(tally.solved))
        }
    }
}

/// Of equals the case of the smallest number.
fn largest_deviation(results: &[CaseResult]) -> Option<(&CaseResult, &Measures)> {
    let measured = results.iter().filter_map(|result| result.measured().map(|m| (result, m)));
    let measured = measured.filter(|(_, measures)| measures.deviation().is_some());
    measured.max_by(|a, b| a.1.max_deviation.total_cmp(&b.1.max_deviation).then(b.0.case.cmp(&a.0.case)))
}

/// How the campaign was set up, label and value, in the order that it is shown in.
pub(super) fn facts(pieces: &Pieces) -> Vec<[String; 2]> {
    let setup = pieces.setup;
    let scenario = &setup.scenario;
    let caveat = if setup.caveat().is_empty() { String::new() } else { format!(" ({})", setup.caveat()) };
    let executor = match (setup.controllers(), setup.program()) {
        (Some(controller), _) => format!("{controller}, simulated"),
        (None, Some(program)) => program,
        (None, None) => setup.recordings().map_or("none".into(), |logs| format!("logs `{logs}`, hardware")),
    };
    let Facts { world, task, search, proven, .. } = setup.kind().facts();
    let search = search.unwrap_or_else(|| {
        let search = scenario.search();
        let method = word(&search.method);
        match search.method {
            SearchMethod::Worst => {
                let budget = match search.seconds {
                    Some(seconds) => format!("{seconds} s"),
                    None => format!("{} executions for each case", search.executions),
                };
                format!("{method}, {budget}, in one pool")
            }
            _ => format!(
                "{method}, width {}, {} waypoints per graph, score {}",
                search.width,
                search.waypoints,
                scenario.score()
            ),
        }
    });
    let fact = |label: &str, value: String| [label.to_owned(), value];
    vec![
        fact("robot", format!("{}{caveat}", setup.robot_name())),
        fact("world", world),
        fact("task", task),
        fact(proven, scenario.reach().into()),
        fact("search", search),
        fact("executor", executor),
        fact("runs", format!("{} per case, the worst counts", scenario.executor().repeat)),
        fact("root seed", scenario.seed().to_string()),
    ]
}

/// Of each case the worst over its runs; measures that no case has are left out. Limits are in the metric's unit: ms of
/// the latest arrival, else as the specification has them.
pub(super) fn metrics(pieces: &Pieces) -> Vec<Metric> {
    let limits = pieces.setup.scenario.head().terms.limits;
    let told = length(pieces.setup);
    let ordered = worst_first(pieces.results);
    let metric = |name, unit, limit: Option<f64>, of: fn(&Measures) -> Option<f64>| {
        let (unit, factor) = if unit == "m" { (told.unit, told.in_metre) } else { (unit, 1.0) };
        let value = |result: &CaseResult| Some(factor * result.measured().and_then(of)?);
        Metric {
            name,
            unit,
            limit: limit.map(|limit| factor * limit),
            lower_is_worse: matches!(name, "clearance" | "tip-over margin"),
            values: ordered.iter().map(|result| value(result)).collect(),
            random: pieces.random.iter().filter_map(value).collect(),
        }
    };
    let all = vec![
        metric("max deviation", "m", limits.deviation, Measures::deviation),
        metric("mean deviation", "m", None, |m| m.deviation().map(|_| m.mean_deviation)),
        metric("overshoot", "m", limits.overshoot, |m| Some(m.max_overshoot())),
        metric("acceleration", "m/s²", limits.acceleration, Measures::acceleration),
        metric("total time", "s", limits.total_time, |m| Some(m.total_time)),
        metric("clearance", "m", limits.clearance, |m| m.min_clearance),
        metric("tip-over margin", "°", limits.tip_over_margin, |m| m.min_tip_over_margin),
        metric("tilt", "°", None, |m| m.max_tilt),
        metric("latest arrival", "ms", limits.late.map(|late| 1e3 * late), |m| m.latest.map(|late| 1e3 * late.by)),
        metric("saturation", "%", None, |m| m.saturation_share.map(|share| 100.0 * share)),
        metric("joint effort", "rad²/s³", None, |m| m.joint_effort),
    ];
    all.into_iter().filter(|metric| metric.values.iter().any(Option::is_some)).collect()
}
