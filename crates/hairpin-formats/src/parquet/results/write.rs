//! The columns of `results.parquet`, in their order.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use arrow_array::builder::{Float64Builder, Int64Builder, ListBuilder, StringBuilder};
use arrow_array::{ArrayRef, Float64Array, Int64Array, StringArray, UInt64Array};
use hairpin::campaign::{Case, CaseResult, Draws, Reruns};
use hairpin::judgement::Share;
use hairpin::judgement::Violation;

use super::super::drawn;
use super::super::measures::{self, BETWEEN, BETWEEN_TOO};
use super::super::table::Columns;
use super::{CONFIDENCE, ELSEWHERE, GENERATED};
use crate::atomic::WriteError;

/// Writes one row per case; `results` may be missing for cases that were not judged, and stands in any order.
///
/// # Errors
/// The file cannot be written.
pub fn write(path: &Path, cases: &[Case], results: &[CaseResult]) -> Result<(), WriteError> {
    columns_of(cases, results).write(path, "results")
}

/// The same of cases that stand in no other file: how many they are goes with them.
///
/// # Errors
/// As of [`write()`].
pub fn write_counted(path: &Path, cases: &[Case], results: &[CaseResult]) -> Result<(), WriteError> {
    columns_of(cases, results).write_counted(path, "results")
}

fn columns_of(cases: &[Case], results: &[CaseResult]) -> Columns {
    let results: BTreeMap<_, _> = results.iter().rev().map(|result| (result.case, result)).collect();
    let rows: Vec<(&Case, Option<&CaseResult>)> =
        cases.iter().map(|case| (case, results.get(&case.number).copied())).collect();
    let measured: Vec<_> = rows.iter().map(|(_, result)| result.and_then(|r| r.measures.as_ref())).collect();
    let measured = measures::columns(&measured);
    let mut columns = Columns::default();
    push_contract(&mut columns, &rows, &measured);
    push_rest(&mut columns, &rows, &measured);
    for name in OF_LEGS {
        push_measured(&mut columns, &measured, name);
    }
    push_violations(&mut columns, &rows);
    let drawn: Vec<_> = rows.iter().map(|(_, result)| result.map_or(&[][..], |r| r.drawn.as_slice())).collect();
    drawn::push(&mut columns, &drawn);
    let of_runs: Vec<_> = rows.iter().map(|(_, result)| result.and_then(|r| r.of_runs.as_deref())).collect();
    measures::columns_of_runs(&of_runs).into_iter().for_each(|(name, column)| columns.push(name, column));
    if rows.iter().any(|(_, result)| result.is_some_and(|result| !result.elsewhere.is_empty())) {
        let mut lists = ListBuilder::new(StringBuilder::new());
        rows.iter().for_each(|(_, result)| lists.append_option(result.map(|r| r.elsewhere.iter().map(Some))));
        columns.push(ELSEWHERE, Arc::new(lists.finish()));
    }
    columns
}

type Rows<'a> = [(&'a Case, Option<&'a CaseResult>)];

fn push_contract(columns: &mut Columns, rows: &Rows, measured: &Measured) {
    let case_texts = |value: &dyn Fn(&Case) -> String| texts(rows.iter().map(|(case, _)| Some(value(case))));
    columns.push("case", case_texts(&Case::id));
    columns.push("seed", Arc::new(rows.iter().map(|(case, _)| case.seed).collect::<UInt64Array>()));
    columns.push("status", texts(rows.iter().map(|(_, r)| Some(r.map_or(GENERATED, |r| r.status.word()).into()))));
    columns.push("evidence", case_texts(&|case| case.evidence.word().into()));
    columns.push("length", integers(rows.iter().map(|(case, _)| Some(case.waypoints.len()))));
    columns.push("score", numbers(rows.iter().map(|(case, _)| Some(case.score))));
    push_measured(columns, measured, "max_deviation_m");
    push_measured(columns, measured, "mean_deviation_m");
    push_measured(columns, measured, "t_worst_s");
    push_measured(columns, measured, "leg_worst");
    push_measured(columns, measured, "max_acceleration_m_s2");
    push_measured(columns, measured, "total_time_s");
    push_measured(columns, measured, "min_clearance_m");
    push_measured(columns, measured, "saturation_share");
    columns.push("ended", texts(rows.iter().map(|(_, result)| result.map(|r| r.ended.clone()))));
}

fn push_rest(columns: &mut Columns, rows: &Rows, measured: &Measured) {
    let gap =
        |case: &Case| case.bound.filter(|_| case.score != 0.0).map(|b| 100.0 * (b - case.score) / case.score.abs());
    columns.push("run", integers(rows.iter().map(|(_, result)| result.map(|r| r.run))));
    columns.push("bound", numbers(rows.iter().map(|(case, _)| case.bound)));
    columns.push("gap_percent", numbers(rows.iter().map(|(case, _)| gap(case))));
    columns.push("certified", texts(rows.iter().map(|(case, _)| case.certified.map(str::to_owned))));
    push_measured(columns, measured, "max_overshoot_m");
    push_measured(columns, measured, "max_speed_rate_m_s2");
    push_measured(columns, measured, "t_acceleration_s");
    push_measured(columns, measured, "t_overshoot_s");
    push_measured(columns, measured, "t_clearance_s");
    push_measured(columns, measured, "min_tip_over_margin_deg");
    push_measured(columns, measured, "t_tip_over_margin_s");
    push_measured(columns, measured, "max_tilt_deg");
    push_measured(columns, measured, "t_tilt_s");
    push_measured(columns, measured, "joint_effort_rad2_s3");
    push_measured(columns, measured, BETWEEN);
    BETWEEN_TOO.iter().for_each(|(name, _)| push_measured(columns, measured, name));
    push_measured(columns, measured, "max_late_s");
    push_measured(columns, measured, "t_late_s");
    for name in ["leg_late", "leg_source", "acceleration_source"] {
        push_measured(columns, measured, name);
    }
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

/// What was measured, leg by leg.
const OF_LEGS: [&str; 11] = [
    "overshoots_m",
    "leg_max_deviation_m",
    "leg_mean_deviation_m",
    "leg_max_acceleration_m_s2",
    "leg_time_s",
    "leg_overshoot_m",
    "leg_min_clearance_m",
    "leg_min_tip_over_margin_deg",
    "leg_max_tilt_deg",
    "leg_saturation_share",
    "leg_joint_effort_rad2_s3",
];

/// Columns of what was measured, by name.
type Measured = [(&'static str, ArrayRef)];

/// Appends one of them, where it is there.
fn push_measured(columns: &mut Columns, measured: &Measured, name: &str) {
    if let Some((name, column)) = measured.iter().find(|(known, _)| *known == name) {
        columns.push(*name, column.clone());
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

fn numbers(values: impl Iterator<Item = Option<f64>>) -> ArrayRef {
    Arc::new(values.collect::<Float64Array>())
}

fn integers(values: impl Iterator<Item = Option<usize>>) -> ArrayRef {
    Arc::new(values.map(|value| value.map(|v| v as i64)).collect::<Int64Array>())
}

fn texts(values: impl Iterator<Item = Option<String>>) -> ArrayRef {
    Arc::new(values.collect::<StringArray>())
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
