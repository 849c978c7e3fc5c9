//! `results.parquet` back into cases and results, every value checked.

use std::path::Path;

use hairpin::campaign::{Case, CaseResult, Draws, Environment, Evidence, Reruns, Status};
use hairpin::judgement::Violation;
use hairpin::judgement::measures::{AccelerationSource, LegSource};
use hairpin::judgement::{Late, LegMeasures, Measures};

use super::super::drawn;
use super::super::table::{Table, TableError};
use super::{GENERATED, Row, acceleration_source_word, leg_source_word};

const CERTIFIED: [&str; 3] = ["yes", "no", "unknown"];

/// Reads the rows, in the file's order.
///
/// # Errors
/// Missing columns, values out of bounds, a case that is twice there.
pub fn read(path: &Path) -> Result<Vec<Row>, TableError> {
    let table = Table::read(path)?;
    let cases = read_cases(&table)?;
    let results = read_results(&table, &cases)?;
    let lengths = table.counts("length")?;
    let rows = cases.into_iter().zip(lengths).zip(results);
    Ok(rows.map(|((case, length), result)| Row { case, length, result }).collect())
}

fn read_cases(table: &Table) -> Result<Vec<Case>, TableError> {
    let numbers = table.cases()?;
    let seeds = table.unsigned("seed")?;
    let graphs = table.unsigned("graph")?;
    let scores = table.numbers("score")?;
    let bounds = table.optional_numbers("bound")?;
    let evidence = table.texts("evidence")?;
    let certified = table.optional_texts("certified")?;
    let environments = read_environments(table)?;
    let mut seen = std::collections::BTreeSet::new();
    (0..table.rows())
        .map(|row| {
            if !seen.insert(numbers[row]) {
                return Err(table.refuse("case", row, numbers[row].to_string(), "there once"));
            }
            let word = |column: &str, text: &str, bound: &str| table.refuse(column, row, format!("`{text}`"), bound);
            let known = |text: &String| {
                let found = CERTIFIED.into_iter().find(|word| word == text);
                found.ok_or_else(|| word("certified", text, "yes, no or unknown"))
            };
            Ok(Case {
                number: numbers[row],
                seed: seeds[row],
                graph: graphs[row],
                waypoints: Vec::new(),
                leg_times: Vec::new(),
                seen: Vec::new(),
                score: scores[row],
                bound: bounds[row],
                evidence: Evidence::from_word(&evidence[row])
                    .ok_or_else(|| word("evidence", &evidence[row], "unchecked, hull-feasible or witnessed"))?,
                certified: certified[row].as_ref().map(known).transpose()?,
                witness: None,
                environment: environments[row].clone(),
            })
        })
        .collect()
}

/// What cases have beside their waypoints; tables without such cases do not say.
fn read_environments(table: &Table) -> Result<Vec<Option<Environment>>, TableError> {
    if !table.names().iter().any(|name| name == "environment") {
        return Ok(vec![None; table.rows()]);
    }
    let texts = table.optional_texts("environment")?.into_iter().enumerate();
    let one = |(row, text): (usize, Option<String>)| {
        let read = text.as_ref().map(|text| serde_json::from_str(text)).transpose();
        read.map_err(|error| {
            let found = text.clone().unwrap_or_default();
            table.refuse("environment", row, found, format!("an environment as JSON: {error}"))
        })
    };
    texts.map(one).collect()
}

fn read_results(table: &Table, cases: &[Case]) -> Result<Vec<Option<CaseResult>>, TableError> {
    let status = table.texts("status")?;
    let runs = table.optional_counts("run")?;
    let ended = table.optional_texts("ended")?;
    let left = table.optional_numbers("left_world_s")?;
    let messages = table.optional_texts("message")?;
    let measures = read_measures(table)?;
    let reruns = read_counts(table, ["reruns", "rerun_violations"])?;
    let draws = read_counts(table, ["draws", "draw_violations"])?;
    let violations = read_violations(table)?;
    let drawn = drawn::read(table)?;
    let rows = measures.into_iter().zip(violations).zip(messages).zip(drawn).enumerate();
    rows.map(|(row, (((measures, violations), message), drawn))| {
        if status[row] == GENERATED {
            return Ok(None);
        }
        let bound = "generated, pass, fail, executor-failed or inconclusive";
        let status = Status::from_word(&status[row])
            .ok_or_else(|| table.refuse("status", row, format!("`{}`", status[row]), bound))?;
        let run = runs[row].ok_or_else(|| table.refuse("run", row, "empty", "the number of the worst run"))?;
        let ended = ended[row].clone().unwrap_or_default();
        Ok(Some(CaseResult {
            case: cases[row].number,
            status,
            run,
            measures,
            ended,
            left_world: left[row],
            violations,
            drawn,
            message,
            reruns: reruns[row].map(|[violated, of]| Reruns { violated, of }),
            draws: draws[row].map(|[violated, of]| Draws { violated, of }),
        }))
    })
    .collect()
}

/// How many runs violated, and of how many, from the columns of all and of those; tables without such runs, or of older
/// versions, do not say.
fn read_counts(table: &Table, [all, those]: [&str; 2]) -> Result<Vec<Option<[usize; 2]>>, TableError> {
    if !has_column(table, all) {
        return Ok(vec![None; table.rows()]);
    }
    let (of, violated) = (table.optional_counts(all)?, table.optional_counts(those)?);
    let both = |(row, (of, violated)): (usize, (Option<usize>, Option<usize>))| match (of, violated) {
        (Some(of), Some(violated)) if violated <= of => Ok(Some([violated, of])),
        (None, None) => Ok(None),
        (of, violated) => {
            let found = violated.map_or("empty".into(), |violated| violated.to_string());
            Err(table.refuse(those, row, found, format!("at most {}", of.unwrap_or(0))))
        }
    };
    of.into_iter().zip(violated).enumerate().map(both).collect()
}

fn read_measures(table: &Table) -> Result<Vec<Option<Measures>>, TableError> {
    // A row has all of these measures or none: `max_deviation_m` tells which.
    let names = ["max_deviation_m", "t_worst_s", "mean_deviation_m", "max_acceleration_m_s2", "t_acceleration_s"];
    let more = ["max_speed_rate_m_s2", "total_time_s", "t_overshoot_s", "t_clearance_s"];
    let names: Vec<&str> = names.into_iter().chain(more).collect();
    let values = names.iter().map(|name| table.optional_numbers(name)).collect::<Result<Vec<_>, _>>()?;
    let leg_worst = table.optional_counts("leg_worst")?;
    let clearance = table.optional_numbers("min_clearance_m")?;
    let margin = table.optional_numbers("min_tip_over_margin_deg")?;
    let t_margin = table.optional_numbers("t_tip_over_margin_s")?;
    let tilt = optional_column(table, "max_tilt_deg")?;
    let t_tilt = optional_column(table, "t_tilt_s")?;
    let saturation = table.optional_numbers("saturation_share")?;
    let effort = optional_column(table, "joint_effort_rad2_s3")?;
    let late = [table.optional_numbers("max_late_s")?, table.optional_numbers("t_late_s")?];
    let leg_late = table.optional_counts("leg_late")?;
    let leg_source = words(table, "leg_source", [LegSource::Executor, LegSource::Assigned], leg_source_word)?;
    let sources = [AccelerationSource::Velocity, AccelerationSource::Position];
    let acceleration_source = words(table, "acceleration_source", sources, acceleration_source_word)?;
    let overshoots = complete_lists(table, "overshoots_m")?;
    let legs = read_legs(table)?;
    (0..table.rows())
        .map(|row| {
            if values[0][row].is_none() {
                return Ok(None);
            }
            let mut given = [0.0; 9];
            for (value, (column, name)) in given.iter_mut().zip(values.iter().zip(&names)) {
                let bound = "a number where max_deviation_m is one";
                *value = column[row].ok_or_else(|| table.refuse(name, row, "empty", bound))?;
            }
            let [max_deviation, t_worst, mean_deviation, max_acceleration, t_acceleration, ..] = given;
            let [.., max_speed_rate, total_time, t_overshoot, t_clearance] = given;
            Ok(Some(Measures {
                max_deviation,
                t_worst,
                leg_worst: leg_worst[row].ok_or_else(|| table.refuse("leg_worst", row, "empty", "a leg's number"))?,
                mean_deviation,
                max_acceleration,
                t_acceleration,
                max_speed_rate,
                total_time,
                overshoots: overshoots[row].clone(),
                t_overshoot,
                min_clearance: clearance[row],
                t_clearance,
                min_tip_over_margin: margin[row],
                t_tip_over_margin: t_margin[row].unwrap_or_default(),
                max_tilt: tilt[row],
                t_tilt: t_tilt[row].unwrap_or_default(),
                saturation_share: saturation[row],
                joint_effort: effort[row],
                latest: late[0][row].map(|by| Late {
                    by,
                    at: late[1][row].unwrap_or_default(),
                    leg: leg_late[row].unwrap_or_default(),
                }),
                leg_source: leg_source[row].unwrap_or_default(),
                acceleration_source: acceleration_source[row].unwrap_or_default(),
                legs: legs[row].clone(),
            }))
        })
        .collect()
}

/// A column of words as the values that they stand for.
fn words<T: Copy, const N: usize>(
    table: &Table,
    column: &str,
    all: [T; N],
    word: fn(T) -> &'static str,
) -> Result<Vec<Option<T>>, TableError> {
    let value = |(row, text): (usize, Option<String>)| {
        let Some(text) = text else { return Ok(None) };
        let bound = || all.map(word).join(" or ");
        let found = all.into_iter().find(|value| word(*value) == text);
        found.map(Some).ok_or_else(|| table.refuse(column, row, format!("`{text}`"), bound()))
    };
    table.optional_texts(column)?.into_iter().enumerate().map(value).collect()
}

fn has_column(table: &Table, column: &str) -> bool {
    table.names().iter().any(|name| name == column)
}

/// A column that tables of other robots, or of older versions, do not have.
fn optional_column(table: &Table, column: &str) -> Result<Vec<Option<f64>>, TableError> {
    match has_column(table, column) {
        true => table.optional_numbers(column),
        false => Ok(vec![None; table.rows()]),
    }
}

fn read_legs(table: &Table) -> Result<Vec<Vec<LegMeasures>>, TableError> {
    let complete = |column| complete_lists(table, column);
    let optional = |column| {
        let lists = table.number_lists(column)?;
        Ok::<Vec<Vec<Option<f64>>>, TableError>(lists.into_iter().map(Option::unwrap_or_default).collect())
    };
    let maximum = complete("leg_max_deviation_m")?;
    let mean = complete("leg_mean_deviation_m")?;
    let acceleration = complete("leg_max_acceleration_m_s2")?;
    let time = complete("leg_time_s")?;
    let overshoot = complete("leg_overshoot_m")?;
    let clearance = optional("leg_min_clearance_m")?;
    let margin = optional("leg_min_tip_over_margin_deg")?;
    let saturation = optional("leg_saturation_share")?;
    let or_none = |column| match has_column(table, column) {
        true => optional(column),
        false => Ok(maximum.iter().map(|legs| vec![None; legs.len()]).collect()),
    };
    let tilt = or_none("leg_max_tilt_deg")?;
    let effort = or_none("leg_joint_effort_rad2_s3")?;
    same_lengths(table, "leg_mean_deviation_m", &mean, &maximum)?;
    same_lengths(table, "leg_max_acceleration_m_s2", &acceleration, &maximum)?;
    same_lengths(table, "leg_time_s", &time, &maximum)?;
    same_lengths(table, "leg_overshoot_m", &overshoot, &maximum)?;
    same_lengths(table, "leg_min_clearance_m", &clearance, &maximum)?;
    same_lengths(table, "leg_min_tip_over_margin_deg", &margin, &maximum)?;
    same_lengths(table, "leg_max_tilt_deg", &tilt, &maximum)?;
    same_lengths(table, "leg_saturation_share", &saturation, &maximum)?;
    same_lengths(table, "leg_joint_effort_rad2_s3", &effort, &maximum)?;
    let leg = |row: usize, i: usize| LegMeasures {
        max_deviation: maximum[row][i],
        mean_deviation: mean[row][i],
        max_acceleration: acceleration[row][i],
        time: time[row][i],
        overshoot: overshoot[row][i],
        min_clearance: clearance[row][i],
        min_tip_over_margin: margin[row][i],
        max_tilt: tilt[row][i],
        saturation_share: saturation[row][i],
        joint_effort: effort[row][i],
        lateness: None,
    };
    Ok((0..table.rows()).map(|row| (0..maximum[row].len()).map(|i| leg(row, i)).collect()).collect())
}

fn read_violations(table: &Table) -> Result<Vec<Vec<Violation>>, TableError> {
    let texts = |column| Ok(table.text_lists(column)?.into_iter().map(Option::unwrap_or_default).collect());
    let what: Vec<Vec<String>> = texts("violation_what")?;
    let unit: Vec<Vec<String>> = texts("violation_unit")?;
    let value = complete_lists(table, "violation_value")?;
    let limit = complete_lists(table, "violation_limit")?;
    let at = complete_lists(table, "violation_t_s")?;
    let leg = complete_lists(table, "violation_leg")?;
    same_lengths(table, "violation_unit", &unit, &what)?;
    for (column, lists) in
        [("violation_value", &value), ("violation_limit", &limit), ("violation_t_s", &at), ("violation_leg", &leg)]
    {
        same_lengths(table, column, lists, &what)?;
    }
    let violation = |row: usize, i: usize| Violation {
        what: what[row][i].clone(),
        value: value[row][i],
        limit: limit[row][i],
        unit: unit[row][i].clone(),
        at: at[row][i],
        leg: leg[row][i].max(0.0) as usize,
    };
    Ok((0..table.rows()).map(|row| (0..what[row].len()).map(|i| violation(row, i)).collect()).collect())
}

fn complete_lists(table: &Table, column: &str) -> Result<Vec<Vec<f64>>, TableError> {
    let complete = |(row, list): (usize, Option<Vec<Option<f64>>>)| {
        let numbers = list.unwrap_or_default().into_iter().map(|v| v.filter(|v| v.is_finite()));
        let numbers: Option<Vec<f64>> = numbers.collect();
        numbers.ok_or_else(|| table.refuse(column, row, "a list with gaps", "finite numbers"))
    };
    table.number_lists(column)?.into_iter().enumerate().map(complete).collect()
}

fn same_lengths<A, B>(table: &Table, column: &str, lists: &[Vec<A>], first: &[Vec<B>]) -> Result<(), TableError> {
    match (0..lists.len()).find(|&row| lists[row].len() != first[row].len()) {
        Some(row) => {
            let found = format!("{} values", lists[row].len());
            Err(table.refuse(column, row, found, format!("{}, as in its sibling columns", first[row].len())))
        }
        None => Ok(()),
    }
}
