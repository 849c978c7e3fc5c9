//! `hairpin judge LOG|FOLDER`: a header and a sentence for each log, a line with counts for a folder.

use hairpin::campaign::report::violation;
use hairpin::campaign::{Doubt, Flown, Why};
use hairpin::judgement::{AccelerationSource, finding};
use hairpin_formats::junit::{Outcome, OutcomeKind, outcomes_text};
use hairpin_jobs::judge_log::{
    Against, Altitude, Cut, Found, FoundProgram, FrameSettings, JudgedLog, JudgedLogs, LogSettings, Matched,
    SourceTold, judge_log,
};
use hairpin_jobs::{Problem, Watch};
use serde_json::{Value, json};

use super::junit;
use crate::args::{AltitudeName, Judge};
use crate::{console, settings};

/// Runs the command.
pub(super) fn run(asked: &Judge, against: Against, watch: &dyn Watch) -> Result<u8, Problem> {
    let settings = LogSettings {
        path: asked.path.clone(),
        against,
        world: asked.world.clone(),
        sets: settings::split(&asked.sets)?,
        case: asked.case.clone(),
        frame: FrameSettings {
            turn_deg: asked.turn,
            offset_m: asked.offset,
            altitude: match asked.altitude {
                AltitudeName::Relative => Altitude::Relative,
                AltitudeName::Amsl => Altitude::Amsl,
            },
        },
        source: asked.source.clone(),
        from_s: asked.from,
        to_s: asked.to,
        page: asked.page.clone(),
    };
    let judged = judge_log(&settings, watch)?;
    if let Some(path) = asked.junit.path() {
        junit::write(path, junit_text(&judged).as_bytes())?;
    }
    if asked.json {
        console::say(&object(&judged).to_string());
    } else {
        lines(&judged).iter().for_each(|line| console::say(line));
    }
    Ok(judged.exit_code())
}

/// A test for each log.
fn junit_text(judged: &JudgedLogs) -> String {
    let outcomes: Vec<Outcome> = judged
        .logs
        .iter()
        .map(|log| Outcome {
            name: log.file.display().to_string(),
            kind: match (log.outcome.word(), log.verdict.exit_code) {
                ("unjudged", _) => OutcomeKind::Skipped,
                (_, 0) => OutcomeKind::Pass,
                (_, 1) => OutcomeKind::Violation,
                _ => OutcomeKind::Open,
            },
            sentence: log.verdict.sentence.clone(),
            more: Vec::new(),
        })
        .collect();
    let verdict = judged.count.iter().map(|count| ("verdict".to_owned(), count.sentence.clone()));
    outcomes_text("logs", &verdict.collect::<Vec<_>>(), &outcomes)
}

/// Each log's header, an empty line and its sentence; behind those of a folder the line with counts.
pub fn lines(judged: &JudgedLogs) -> Vec<String> {
    let of_log = |log: &JudgedLog| {
        let found = log.found.as_ref().map(Found::lines).or_else(|| log.program.as_ref().map(FoundProgram::lines));
        let header = found.map(|lines| lines.into_iter().map(|[label, value]| format!("{label}: {value}")));
        let header = header.into_iter().flat_map(|lines| lines.chain([String::new()]));
        header.chain([log.verdict.sentence.clone()]).collect::<Vec<_>>()
    };
    judged.logs.iter().flat_map(of_log).chain(judged.count.iter().map(|count| count.sentence.clone())).collect()
}

/// What `judge LOG --json` says.
pub fn object(judged: &JudgedLogs) -> Value {
    let only = judged.logs.first().map(|log| &log.verdict);
    let whole = judged.count.as_ref().or(only);
    let count = |word: &str| judged.logs.iter().filter(|log| log.outcome.word() == word).count();
    json!({
        "verdict": whole.map(|verdict| &verdict.sentence),
        "exit_code": judged.exit_code(),
        "counts": {
            "logs": judged.logs.len(), "pass": count("pass"), "fail": count("fail"),
            "inconclusive": count("inconclusive"), "invalid": count("invalid"), "unjudged": count("unjudged"),
        },
        "logs": judged.logs.iter().map(log).collect::<Vec<_>>(),
        "left_out": judged.left_out, "copies": judged.copies,
    })
}

fn log(log: &JudgedLog) -> Value {
    let mut object = json!({
        "file": log.file, "verdict": log.verdict.sentence, "exit_code": log.verdict.exit_code,
        "status": log.outcome.word(), "evidence": log.evidence(), "aligned": false,
    });
    let found = log.found.as_ref().map(found_object).or_else(|| log.program.as_ref().map(program_object));
    if let (Some(Value::Object(more)), Value::Object(all)) = (found, &mut object) {
        all.extend(more);
    }
    object
}

fn program_object(found: &FoundProgram) -> Value {
    json!({
        "case": found.case,
        "matched": matched(found.matched.as_ref()),
        "source": source(&found.source),
        "joints": found.joints.as_ref().map(|joints| json!({
            "unit": joints.unit, "axes": joints.names, "order": joints.order, "by_name": joints.by_name, "others": joints.others,
        })),
        "program_begins_s": found.begins_s,
        "clock_offset_s": found.offset.map(|(offset, _)| offset.seconds),
        "clock_offset_removed": found.offset.map(|(offset, _)| offset.removed),
        "finished": found.short.is_none(),
        "measures": found.result.measures.as_ref().map(|m| json!({
            "max_deviation_m": m.max_deviation,
            "mean_deviation_m": m.mean_deviation,
            "t_worst_s": m.t_worst,
            "leg_worst": m.leg_worst,
            "latest": m.latest.map(|late| json!({ "late_s": late.by, "t_s": late.at, "leg": late.leg })),
            "late_s": m.legs.iter().map(|leg| leg.lateness).collect::<Vec<_>>(),
            "late_between_s": found.late_between,
            "not_excluded_m": found.not_excluded_m,
            "total_time_s": m.total_time,
            "violations": found.result.violations.iter().map(violation).collect::<Vec<_>>(),
        })),
        "open": found.result.message,
        "simulated_max_deviation_m": found.simulated_m,
        "gap_m": found.result.measures.as_ref().zip(found.simulated_m).map(|(m, simulated)| m.max_deviation - simulated),
        "notes": found.notes,
    })
}

fn matched(matched: Option<&Matched>) -> Option<Value> {
    matched.map(|matched| {
        json!({
            "by": if matched.by_targets { "targets" } else { "track" },
            "mean_m": matched.mean_m,
            "next": matched.next.as_ref().map(|(case, mean_m)| json!({ "case": case, "mean_m": mean_m })),
        })
    })
}

fn source(source: &SourceTold) -> Value {
    json!({
        "format": source.format, "topic": source.topic, "who": source.words, "clock": source.clock,
        "samples": source.samples, "rate_hz": finite(source.rate_hz), "accuracy": source.has_accuracy,
        "others": source.others,
    })
}

fn found_object(found: &Found) -> Value {
    let frame = &found.frame;
    json!({
        "case": found.case,
        "matched": matched(found.matched.as_ref()),
        "source": source(&found.source),
        "frame": {
            "log": frame.log, "how": frame.how, "by_earth": frame.by_earth,
            "heights": if frame.heights_by_map { "map" } else { "log" },
            "altitude_difference_m": frame.altitude_difference_m, "altitude_applied": frame.altitude_applied,
            "turn_deg": frame.named.turn_deg, "offset_m": frame.named.offset_m,
        },
        "span_s": found.span_s,
        "legs_by": found.legs_by.word(),
        "ended": found.ended,
        "finished": found.finished,
        "missed": found.missed.map(|missed| json!({
            "waypoint": missed.waypoint, "nearest_m": finite(missed.nearest_m), "accept_m": missed.accept_m,
        })),
        "legs_left_out": found.left_out.map(|left_out| json!({
            "first_judged": left_out.first_leg, "is_cut": left_out.cuts_leg, "began_s": left_out.began_s,
            "lost_s": left_out.lost_s,
        })),
        "never_began": found.never_began,
        "cuts": found.cuts.iter().map(cut).collect::<Vec<_>>(),
        "measures": found.flown.as_ref().map(measures),
        "open": found.asked,
        "simulated_max_deviation_m": found.simulated_m,
        "gap_m": found.flown.as_ref().zip(found.simulated_m).map(|(flown, m)| flown.measures.max_deviation - m),
        "notes": found.notes,
    })
}

fn cut(cut: &Cut) -> Value {
    json!({ "t_s": cut.t_s, "what": cut.words, "lost_s": cut.lost_s, "to_the_end": cut.to_the_end })
}

fn measures(flown: &Flown) -> Value {
    let m = &flown.measures;
    json!({
        "max_deviation_m": m.deviation(),
        "mean_deviation_m": m.deviation().map(|_| m.mean_deviation),
        "t_worst_s": m.t_worst,
        "leg_worst": m.leg_worst,
        "between_samples_m": finite(flown.most_between),
        "max_speed_bound_m_s": flown.swiftness.speed,
        "max_acceleration_bound_m_s2": flown.swiftness.acceleration,
        "exceeded": flown.exceeded.map(|exceeded| json!({
            "what": exceeded.what, "seen": exceeded.seen, "bound": exceeded.bound, "unit": exceeded.unit,
        })),
        "max_overshoot_m": m.max_overshoot(),
        "max_acceleration_m_s2": m.acceleration(),
        "acceleration_unresolved_m_s2": m.acceleration_unresolved.map(|unresolved| unresolved.by),
        "place_unresolved_m": m.place_unresolved,
        "min_clearance_m": m.min_clearance,
        "total_time_s": m.total_time,
        "statistics": flown.statistics.map(|s| json!({
            "max": s.max, "mean": s.mean, "median": s.median, "min": s.min, "rmse": s.rmse, "sse": s.sse, "std": s.std,
        })),
        "violations": flown.violations.iter().map(violation).collect::<Vec<_>>(),
        "unmeasured": flown.limits.unmeasured(m),
        "doubts": flown.doubts.iter().map(doubt).collect::<Vec<_>>(),
    })
}

fn doubt(doubt: &Doubt) -> Value {
    let why = match doubt.why {
        Why::Between { most, rate_hz } => json!({ "between_samples": finite(most), "needed_rate_hz": rate_hz }),
        Why::Begin { before } => json!({ "begin_not_seen": true, "left_out_s": before }),
        Why::End(after) => json!({ "end_not_seen": true, "left_out_s": after }),
        Why::Impossible(found) => json!({ "impossible": true, "way_m": found.way_m, "over_s": found.over_s }),
        Why::Overturned(found) => json!({ "overturned": true, "throughout": found.throughout }),
        Why::Resolution(unresolved, source) => json!({
            "told_in_steps_of": unresolved.step, "of_velocities": source == AccelerationSource::Velocity,
            "over_s": unresolved.over, "unresolved_m_s2": unresolved.by,
        }),
        Why::Mean(span) => json!({ "mean_over_s": span }),
        Why::Digits(moved) => json!({ "moved_by_digits_m": moved }),
        Why::Accuracy { which, sigma } => json!({ "accuracy": which, "sigma_m": sigma }),
    };
    json!({ "value": finding(&doubt.value), "t_s": doubt.value.at, "leg": doubt.value.leg, "why": why })
}

/// Infinite is `null`.
fn finite(number: f64) -> Option<f64> {
    Some(number).filter(|number| number.is_finite())
}
