//! The columns of `results.parquet`, in their order.

use std::path::Path;
use std::sync::Arc;

use arrow_array::builder::{Float64Builder, Int64Builder, ListBuilder, StringBuilder};
use arrow_array::{ArrayRef, Float64Array, Int64Array, StringArray, UInt64Array};
use hairpin::campaign::{Case, CaseResult, Draws, Reruns};
use hairpin::judgement::Violation;
use hairpin::judgement::{LegMeasures, Measures, Share};

use super::super::drawn;
use super::super::table::Columns;
use super::{CONFIDENCE, GENERATED, acceleration_source_word, leg_source_word};
use crate::atomic::WriteError;

/// Writes one row per case; `results` may be missing for cases that were not judged, and stands in any order.
///
/// # Errors
/// The file cannot be written.
pub fn write(path: &Path, cases: &[Case], results: &[CaseResult]) -> Result<(), WriteError> {
    let rows: Vec<(&Case, Option<&CaseResult>)> =
        cases.iter().map(|case| (case, results.iter().find(|result| result.case == case.number))).collect();
    let mut columns = Columns::default();
    push_contract(&mut columns, &rows);
    push_rest(&mut columns, &rows);
    push_legs(&mut columns, &rows);
    push_violations(&mut columns, &rows);
    let drawn: Vec<_> = rows.iter().map(|(_, result)| result.map_or(&[][..], |r| r.drawn.as_slice())).collect();
    drawn::push(&mut columns, &drawn);
    columns.write(path, "results")
}

type Rows<'a> = [(&'a Case, Option<&'a CaseResult>)];

fn push_contract(columns: &mut Columns, rows: &Rows) {
    let case_texts = |value: &dyn Fn(&Case) -> String| texts(rows.iter().map(|(case, _)| Some(value(case))));
    let measured = |value: &dyn Fn(&Measures) -> Option<f64>| measured(rows, value);
    columns.push("case", case_texts(&Case::id));
    columns.push("seed", Arc::new(rows.iter().map(|(case, _)| case.seed).collect::<UInt64Array>()));
    columns.push("status", texts(rows.iter().map(|(_, r)| Some(r.map_or(GENERATED, |r| r.status.word()).into()))));
    columns.push("evidence", case_texts(&|case| case.evidence.word().into()));
    columns.push("length", integers(rows.iter().map(|(case, _)| Some(case.waypoints.len()))));
    columns.push("score", numbers(rows.iter().map(|(case, _)| Some(case.score))));
    columns.push("max_deviation_m", measured(&|m| Some(m.max_deviation)));
    columns.push("mean_deviation_m", measured(&|m| Some(m.mean_deviation)));
    columns.push("t_worst_s", measured(&|m| Some(m.t_worst)));
    let leg_worst = |(_, result): &(_, Option<&CaseResult>)| result.and_then(|r| Some(r.measures.as_ref()?.leg_worst));
    columns.push("leg_worst", integers(rows.iter().map(leg_worst)));
    columns.push("max_acceleration_m_s2", measured(&|m| Some(m.max_acceleration)));
    columns.push("total_time_s", measured(&|m| Some(m.total_time)));
    columns.push("min_clearance_m", measured(&|m| m.min_clearance));
    columns.push("saturation_share", measured(&|m| m.saturation_share));
    columns.push("ended", texts(rows.iter().map(|(_, result)| result.map(|r| r.ended.clone()))));
}

fn push_rest(columns: &mut Columns, rows: &Rows) {
    let gap =
        |case: &Case| case.bound.filter(|_| case.score != 0.0).map(|b| 100.0 * (b - case.score) / case.score.abs());
    columns.push("run", integers(rows.iter().map(|(_, result)| result.map(|r| r.run))));
    columns.push("bound", numbers(rows.iter().map(|(case, _)| case.bound)));
    columns.push("gap_percent", numbers(rows.iter().map(|(case, _)| gap(case))));
    columns.push("certified", texts(rows.iter().map(|(case, _)| case.certified.map(str::to_owned))));
    columns.push("max_overshoot_m", measured(rows, &|m| Some(m.max_overshoot())));
    columns.push("max_speed_rate_m_s2", measured(rows, &|m| Some(m.max_speed_rate)));
    columns.push("t_acceleration_s", measured(rows, &|m| Some(m.t_acceleration)));
    columns.push("t_overshoot_s", measured(rows, &|m| Some(m.t_overshoot)));
    columns.push("t_clearance_s", measured(rows, &|m| Some(m.t_clearance)));
    columns.push("min_tip_over_margin_deg", measured(rows, &|m| m.min_tip_over_margin));
    let when = |m: &Measures| m.min_tip_over_margin.map(|_| m.t_tip_over_margin);
    columns.push("t_tip_over_margin_s", measured(rows, &when));
    columns.push("max_tilt_deg", measured(rows, &|m| m.max_tilt));
    columns.push("t_tilt_s", measured(rows, &|m| m.max_tilt.map(|_| m.t_tilt)));
    if has_joints(rows) {
        columns.push("joint_effort_rad2_s3", measured(rows, &|m| m.joint_effort));
    }
    columns.push("max_late_s", measured(rows, &|m| m.latest.map(|late| late.by)));
    columns.push("t_late_s", measured(rows, &|m| m.latest.map(|late| late.at)));
    let leg_late = rows.iter().map(|(_, result)| Some(result.as_ref()?.measures.as_ref()?.latest?.leg));
    columns.push("leg_late", integers(leg_late));
    let measures = |result: Option<&CaseResult>| result.and_then(|r| r.measures.clone());
    let words = |word: fn(&Measures) -> &'static str| {
        texts(rows.iter().map(|(_, result)| measures(*result).map(|m| word(&m).into())))
    };
    columns.push("leg_source", words(|m| leg_source_word(m.leg_source)));
    columns.push("acceleration_source", words(|m| acceleration_source_word(m.acceleration_source)));
    columns.push("left_world_s", numbers(rows.iter().map(|(_, result)| result.and_then(|r| r.left_world))));
    columns.push("graph", Arc::new(rows.iter().map(|(case, _)| case.graph).collect::<UInt64Array>()));
    let again = |value: fn(&Reruns) -> usize| {
        integers(rows.iter().map(move |(_, result)| result.and_then(|r| r.reruns.as_ref()).map(value)))
    };
    let share = |value: fn(&Share) -> f64| {
        let of =
            |result: &CaseResult| result.reruns.and_then(|reruns| reruns.share(CONFIDENCE)).map(|share| value(&share));
        numbers(rows.iter().map(|(_, result)| result.and_then(of)))
    };
    columns.push("reruns", again(|reruns| reruns.of));
    columns.push("rerun_violations", again(|reruns| reruns.violated));
    columns.push("rerun_violation_share", share(|share| share.value));
    columns.push("rerun_violation_share_low", share(|share| share.low));
    columns.push("rerun_violation_share_high", share(|share| share.high));
    if rows.iter().any(|(case, _)| case.environment.is_some()) {
        let text = |case: &Case| case.environment.as_ref().and_then(|found| serde_json::to_string(found).ok());
        columns.push("environment", texts(rows.iter().map(|(case, _)| text(case))));
    }
    if rows.iter().any(|(_, result)| result.is_some_and(|result| result.draws.is_some())) {
        let drawn = |value: fn(&Draws) -> usize| {
            integers(rows.iter().map(move |(_, result)| result.and_then(|r| r.draws.as_ref()).map(value)))
        };
        columns.push("draws", drawn(|draws| draws.of));
        columns.push("draw_violations", drawn(|draws| draws.violated));
    }
    columns.push("violations", texts(rows.iter().map(|(_, result)| result.map(violations_text))));
    columns.push("message", texts(rows.iter().map(|(_, result)| result.and_then(|r| r.message.clone()))));
}

/// Whether any run told its joints.
fn has_joints(rows: &Rows) -> bool {
    let told = |result: &CaseResult| result.measures.as_ref().is_some_and(|m| m.joint_effort.is_some());
    rows.iter().any(|(_, result)| result.is_some_and(told))
}

fn push_legs(columns: &mut Columns, rows: &Rows) {
    let per_leg = |value: fn(&LegMeasures) -> Option<f64>| {
        lists(rows, &move |m: &Measures| m.legs.iter().map(value).collect::<Vec<_>>())
    };
    columns.push("overshoots_m", lists(rows, &|m: &Measures| m.overshoots.iter().copied().map(Some).collect()));
    columns.push("leg_max_deviation_m", per_leg(|leg| Some(leg.max_deviation)));
    columns.push("leg_mean_deviation_m", per_leg(|leg| Some(leg.mean_deviation)));
    columns.push("leg_max_acceleration_m_s2", per_leg(|leg| Some(leg.max_acceleration)));
    columns.push("leg_time_s", per_leg(|leg| Some(leg.time)));
    columns.push("leg_overshoot_m", per_leg(|leg| Some(leg.overshoot)));
    columns.push("leg_min_clearance_m", per_leg(|leg| leg.min_clearance));
    columns.push("leg_min_tip_over_margin_deg", per_leg(|leg| leg.min_tip_over_margin));
    columns.push("leg_max_tilt_deg", per_leg(|leg| leg.max_tilt));
    columns.push("leg_saturation_share", per_leg(|leg| leg.saturation_share));
    if has_joints(rows) {
        columns.push("leg_joint_effort_rad2_s3", per_leg(|leg| leg.joint_effort));
    }
}

fn push_violations(columns: &mut Columns, rows: &Rows) {
    let numbers = |value: fn(&Violation) -> f64| {
        let list = |result: &CaseResult| result.violations.iter().map(|violation| Some(value(violation))).collect();
        number_lists(rows.iter().map(|(_, result)| result.map(list)))
    };
    columns.push("violation_what", text_lists(rows, |violation| &violation.what));
    columns.push("violation_value", numbers(|violation| violation.value));
    columns.push("violation_limit", numbers(|violation| violation.limit));
    columns.push("violation_unit", text_lists(rows, |violation| &violation.unit));
    columns.push("violation_t_s", numbers(|violation| violation.at));
    let mut legs = ListBuilder::new(Int64Builder::new());
    for (_, result) in rows {
        match result {
            Some(result) => legs.append_value(result.violations.iter().map(|violation| Some(violation.leg as i64))),
            None => legs.append_null(),
        }
    }
    columns.push("violation_leg", Arc::new(legs.finish()));
}

fn violations_text(result: &CaseResult) -> String {
    result.violations.iter().map(hairpin::campaign::report::violation).collect::<Vec<_>>().join("; ")
}

fn measured(rows: &Rows, value: &dyn Fn(&Measures) -> Option<f64>) -> ArrayRef {
    numbers(rows.iter().map(|(_, result)| result.and_then(|r| r.measures.as_ref()).and_then(value)))
}

fn numbers(values: impl Iterator<Item = Option<f64>>) -> ArrayRef {
    Arc::new(values.collect::<Float64Array>())
}

fn integers(values: impl Iterator<Item = Option<usize>>) -> ArrayRef {
    Arc::new(values.map(|value| value.map(|v| v as i64)).collect::<Int64Array>())
}

fn texts(values: impl Iterator<Item = Option<String>>) -> ArrayRef {
    Arc::new(values.collect::<StringArray>())
}

fn lists(rows: &Rows, value: &dyn Fn(&Measures) -> Vec<Option<f64>>) -> ArrayRef {
    number_lists(rows.iter().map(|(_, result)| result.and_then(|r| r.measures.as_ref()).map(value)))
}

fn number_lists(lists: impl Iterator<Item = Option<Vec<Option<f64>>>>) -> ArrayRef {
    let mut builder = ListBuilder::new(Float64Builder::new());
    for list in lists {
        builder.append_option(list);
    }
    Arc::new(builder.finish())
}

fn text_lists(rows: &Rows, value: fn(&Violation) -> &str) -> ArrayRef {
    let mut builder = ListBuilder::new(StringBuilder::new());
    for (_, result) in rows {
        builder.append_option(result.map(|r| r.violations.iter().map(|violation| Some(value(violation)))));
    }
    Arc::new(builder.finish())
}
