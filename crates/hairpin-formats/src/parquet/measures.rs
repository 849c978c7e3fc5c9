//! What was measured of runs, as columns: of the worst run of a case in `results.parquet`, of every run in `runs/`.

use std::sync::Arc;

use arrow_array::builder::{Float64Builder, ListBuilder};
use arrow_array::{ArrayRef, BooleanArray, Float64Array, Int64Array, StringArray};
use hairpin::judgement::{AccelerationSource, Late, LegMeasures, LegSource, Measures, Missing, Unresolved};

use super::possible;
use super::table::{Table, TableError};

/// The columns of what was measured, a row each; of joints where any run told them.
pub(super) fn columns(rows: &[Option<&Measures>]) -> Vec<(&'static str, ArrayRef)> {
    let number = |value: &dyn Fn(&Measures) -> Option<f64>| -> ArrayRef {
        Arc::new(rows.iter().map(|row| row.and_then(value)).collect::<Float64Array>())
    };
    let count = |value: &dyn Fn(&Measures) -> Option<usize>| -> ArrayRef {
        Arc::new(rows.iter().map(|row| row.and_then(value).map(|v| v as i64)).collect::<Int64Array>())
    };
    let word = |value: &dyn Fn(&Measures) -> &'static str| -> ArrayRef {
        Arc::new(rows.iter().map(|row| row.map(value)).collect::<StringArray>())
    };
    let list = |value: &dyn Fn(&Measures) -> Vec<Option<f64>>| -> ArrayRef {
        let mut lists = ListBuilder::new(Float64Builder::new());
        rows.iter().for_each(|row| lists.append_option(row.map(value)));
        Arc::new(lists.finish())
    };
    let legs = |value: fn(&LegMeasures) -> Option<f64>| list(&|m| m.legs.iter().map(value).collect());
    let mut all = vec![
        ("max_deviation_m", number(&|m| Some(m.max_deviation))),
        ("mean_deviation_m", number(&|m| Some(m.mean_deviation))),
        ("t_worst_s", number(&|m| Some(m.t_worst))),
        ("leg_worst", count(&|m| Some(m.leg_worst))),
        ("max_acceleration_m_s2", number(&|m| Some(m.max_acceleration))),
        ("total_time_s", number(&|m| Some(m.total_time))),
        ("min_clearance_m", number(&|m| m.min_clearance)),
        ("saturation_share", number(&|m| m.saturation_share)),
        ("max_overshoot_m", number(&|m| Some(m.max_overshoot()))),
        ("max_speed_rate_m_s2", number(&|m| Some(m.max_speed_rate))),
        ("t_acceleration_s", number(&|m| Some(m.t_acceleration))),
        ("t_overshoot_s", number(&|m| Some(m.t_overshoot))),
        ("t_clearance_s", number(&|m| Some(m.t_clearance))),
        ("min_tip_over_margin_deg", number(&|m| m.min_tip_over_margin)),
        ("t_tip_over_margin_s", number(&|m| m.min_tip_over_margin.map(|_| m.t_tip_over_margin))),
        ("max_tilt_deg", number(&|m| m.max_tilt)),
        ("t_tilt_s", number(&|m| m.max_tilt.map(|_| m.t_tilt))),
        ("max_late_s", number(&|m| m.latest.map(|late| late.by))),
        ("t_late_s", number(&|m| m.latest.map(|late| late.at))),
        ("leg_late", count(&|m| Some(m.latest?.leg))),
        ("leg_source", word(&|m| leg_source_word(m.leg_source))),
        ("acceleration_source", word(&|m| acceleration_source_word(m.acceleration_source))),
        ("overshoots_m", list(&|m| m.overshoots.iter().copied().map(Some).collect())),
        ("leg_max_deviation_m", legs(|leg| Some(leg.max_deviation))),
        ("leg_mean_deviation_m", legs(|leg| Some(leg.mean_deviation))),
        ("leg_max_acceleration_m_s2", legs(|leg| Some(leg.max_acceleration))),
        ("leg_time_s", legs(|leg| Some(leg.time))),
        ("leg_overshoot_m", legs(|leg| Some(leg.overshoot))),
        ("leg_min_clearance_m", legs(|leg| leg.min_clearance)),
        ("leg_min_tip_over_margin_deg", legs(|leg| leg.min_tip_over_margin)),
        ("leg_max_tilt_deg", legs(|leg| leg.max_tilt)),
        ("leg_saturation_share", legs(|leg| leg.saturation_share)),
    ];
    if rows.iter().flatten().any(|measures| measures.joint_effort.is_some()) {
        all.push(("joint_effort_rad2_s3", number(&|m| m.joint_effort)));
        all.push(("leg_joint_effort_rad2_s3", legs(|leg| leg.joint_effort)));
    }
    if rows.iter().flatten().any(|measures| measures.most_between.is_some()) {
        all.push((BETWEEN, number(&|m| m.most_between)));
    }
    for (name, value) in BETWEEN_TOO {
        if rows.iter().flatten().any(|measures| value(measures).is_some()) {
            all.push((name, number(&value)));
        }
    }
    if rows.iter().flatten().any(|measures| !measures.waypoints_within.is_empty()) {
        all.push((WITHIN, list(&|m| m.waypoints_within.iter().copied().map(Some).collect())));
    }
    if rows.iter().flatten().any(|measures| measures.missing != Missing::default()) {
        let flag = |of: fn(&Missing) -> bool| -> ArrayRef {
            Arc::new(rows.iter().map(|row| row.map(|m| of(&m.missing))).collect::<BooleanArray>())
        };
        all.push((NO_DEVIATION, flag(|missing| missing.deviation)));
        all.push((NO_ACCELERATION, flag(|missing| missing.acceleration)));
    }
    all
}

/// Columns: what was not measured and reads 0, of tables in which some of it was not.
const NO_DEVIATION: &str = "deviation_missing";
const NO_ACCELERATION: &str = "acceleration_missing";

/// Column: what may hide between samples, of runs of which that is asked.
pub(super) const BETWEEN: &str = "max_deviation_between_m";

/// Column: how near each waypoint was come to, of runs of which that is asked.
const WITHIN: &str = "waypoints_within_m";

type Figure = fn(&Measures) -> Option<f64>;

/// The same of other limits, the longest time that an acceleration is a mean over, and what the step in which rows are
/// told (m, or m/s where velocities are) leaves open of the largest, and of places.
pub(super) const BETWEEN_TOO: [(&str, Figure); 8] = [
    ("max_overshoot_between_m", |m| m.overshoot_between),
    ("min_clearance_between_m", |m| m.clearance_between),
    ("acceleration_over_s", |m| m.acceleration_over),
    ("min_edge_between_m", |m| m.edge_between),
    ("acceleration_unresolved_m_s2", |m| Some(m.acceleration_unresolved?.by)),
    ("acceleration_step", |m| Some(m.acceleration_unresolved?.step)),
    ("acceleration_step_over_s", |m| Some(m.acceleration_unresolved?.over)),
    ("place_unresolved_m", |m| m.place_unresolved),
];

fn leg_source_word(source: LegSource) -> &'static str {
    match source {
        LegSource::Executor => "executor",
        LegSource::Assigned => "assigned",
    }
}

fn acceleration_source_word(source: AccelerationSource) -> &'static str {
    match source {
        AccelerationSource::Velocity => "velocity",
        AccelerationSource::Position => "position",
    }
}

/// How columns of the worst of each measure over all runs of a case begin.
const OF_RUNS: &str = "runs_";
/// Of these measures there are such columns, a number each.
const WORST_OF_RUNS: [(&str, Figure); 14] = [
    ("max_deviation_m", |m| Some(m.max_deviation)),
    ("mean_deviation_m", |m| Some(m.mean_deviation)),
    ("t_worst_s", |m| Some(m.t_worst)),
    ("max_acceleration_m_s2", |m| Some(m.max_acceleration)),
    ("max_speed_rate_m_s2", |m| Some(m.max_speed_rate)),
    ("total_time_s", |m| Some(m.total_time)),
    ("max_overshoot_m", |m| Some(m.max_overshoot())),
    ("min_clearance_m", |m| m.min_clearance),
    ("min_tip_over_margin_deg", |m| m.min_tip_over_margin),
    ("max_tilt_deg", |m| m.max_tilt),
    ("saturation_share", |m| m.saturation_share),
    ("joint_effort_rad2_s3", |m| m.joint_effort),
    ("max_late_s", |m| m.latest.map(|late| late.by)),
    ("t_late_s", |m| m.latest.map(|late| late.at)),
];

/// The columns of the worst of each measure over the runs of a case ([`Measures::worst_of_each`]), a row each; none
/// where no case has several runs.
pub(super) fn columns_of_runs(rows: &[Option<&Measures>]) -> Vec<(String, ArrayRef)> {
    if rows.iter().all(Option::is_none) {
        return Vec::new();
    }
    let name = |name: &str| format!("{OF_RUNS}{name}");
    let number =
        |value: Figure| -> ArrayRef { Arc::new(rows.iter().map(|row| row.and_then(value)).collect::<Float64Array>()) };
    let count = |value: fn(&Measures) -> Option<usize>| -> ArrayRef {
        Arc::new(rows.iter().map(|row| row.and_then(value).map(|v| v as i64)).collect::<Int64Array>())
    };
    let flag = |value: fn(&Missing) -> bool| -> ArrayRef {
        Arc::new(rows.iter().map(|row| row.map(|m| value(&m.missing))).collect::<BooleanArray>())
    };
    let numbers = WORST_OF_RUNS.into_iter().map(|(of, value)| (name(of), number(value)));
    let counts =
        [(name("leg_worst"), count(|m| Some(m.leg_worst))), (name("leg_late"), count(|m| Some(m.latest?.leg)))];
    let flags = [
        (name(NO_DEVIATION), flag(|missing| missing.deviation)),
        (name(NO_ACCELERATION), flag(|missing| missing.acceleration)),
    ];
    numbers.chain(counts).chain(flags).collect()
}

/// Reads the worst of each measure over the runs of a case, beside what the worst of them measured: no run can have
/// more than that. Tables of cases of one run, and of earlier versions, do not say.
///
/// # Errors
/// Missing columns, values that no runs can have, or less than the `worst` run measured.
pub(super) fn read_of_runs(
    table: &Table,
    worst: &[Option<Measures>],
) -> Result<Vec<Option<Box<Measures>>>, TableError> {
    let name = |name: &str| format!("{OF_RUNS}{name}");
    let [(first, _), ..] = WORST_OF_RUNS;
    if !table.has(&name(first)) {
        return Ok(vec![None; table.rows()]);
    }
    let values = WORST_OF_RUNS.map(|(of, _)| table.optional_numbers(&name(of)));
    let values = values.into_iter().collect::<Result<Vec<_>, _>>()?;
    let legs = [table.optional_counts(&name("leg_worst"))?, table.optional_counts(&name("leg_late"))?];
    let no_deviation = flags(table, &name(NO_DEVIATION))?;
    let no_acceleration = flags(table, &name(NO_ACCELERATION))?;
    (0..table.rows())
        .map(|row| {
            let Some(max_deviation) = values[0][row] else { return Ok(None) };
            let mut given = [None; WORST_OF_RUNS.len()];
            given.iter_mut().zip(&values).for_each(|(value, column)| *value = column[row]);
            let [_, mean, at, acceleration, speed_rate, time, overshoot, ..] = given;
            let [.., min_clearance, min_tip_over_margin, max_tilt, saturation_share, joint_effort, late, late_at] =
                given;
            let missing = Missing { deviation: no_deviation[row], acceleration: no_acceleration[row] };
            let found = Measures {
                max_deviation,
                mean_deviation: mean.unwrap_or_default(),
                t_worst: at.unwrap_or_default(),
                leg_worst: legs[0][row].unwrap_or_default(),
                max_acceleration: acceleration.unwrap_or_default(),
                max_speed_rate: speed_rate.unwrap_or_default(),
                total_time: time.unwrap_or_default(),
                overshoots: vec![overshoot.unwrap_or_default()],
                min_clearance,
                min_tip_over_margin,
                max_tilt,
                saturation_share,
                joint_effort,
                latest: late.map(|by| Late {
                    by,
                    at: late_at.unwrap_or_default(),
                    leg: legs[1][row].unwrap_or_default(),
                }),
                missing,
                ..Measures::default()
            };
            let of_one = worst[row].as_ref().map(|worst| (worst, worst.worst_of_each(worst)));
            if let Some((worst, of_one)) = of_one {
                let all = found.worst_of_each(worst);
                let less = WORST_OF_RUNS
                    .into_iter()
                    .filter(|(of, _)| !of.starts_with("t_"))
                    .find(|(_, value)| value(&all) != value(&found));
                if let Some((of, value)) = less {
                    let told = value(&found).map_or("empty".into(), |value| value.to_string());
                    let own = value(&of_one).map_or("a number".into(), |value| value.to_string());
                    let bound = format!("no better than {own}, what the worst run has as `{of}`");
                    return Err(table.refuse(&name(of), row, told, bound));
                }
            }
            Ok(Some(Box::new(found)))
        })
        .collect()
}

/// Reads what was measured; a row has all of it or nothing.
///
/// # Errors
/// Missing columns, values that contradict each other, or that no run can have.
pub(super) fn read(table: &Table) -> Result<Vec<Option<Measures>>, TableError> {
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
    let between = optional_column(table, BETWEEN)?;
    let [over_between, clear_between, mean_over, edge_between, unresolved, step, step_over, place] =
        BETWEEN_TOO.map(|(name, _)| optional_column(table, name));
    let (over_between, clear_between) = (over_between?, clear_between?);
    let (mean_over, edge_between) = (mean_over?, edge_between?);
    let (unresolved, step, step_over, place) = (unresolved?, step?, step_over?, place?);
    let no_deviation = flags(table, NO_DEVIATION)?;
    let no_acceleration = flags(table, NO_ACCELERATION)?;
    let late = [table.optional_numbers("max_late_s")?, table.optional_numbers("t_late_s")?];
    let leg_late = table.optional_counts("leg_late")?;
    let leg_source = words(table, "leg_source", [LegSource::Executor, LegSource::Assigned], leg_source_word)?;
    let sources = [AccelerationSource::Velocity, AccelerationSource::Position];
    let acceleration_source = words(table, "acceleration_source", sources, acceleration_source_word)?;
    let overshoots = complete_lists(table, "overshoots_m")?;
    let within = match table.has(WITHIN) {
        true => complete_lists(table, WITHIN)?,
        false => vec![Vec::new(); table.rows()],
    };
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
            let measures = Measures {
                max_deviation,
                t_worst,
                leg_worst: leg_worst[row].ok_or_else(|| table.refuse("leg_worst", row, "empty", "a leg's number"))?,
                most_between: between[row],
                overshoot_between: over_between[row],
                clearance_between: clear_between[row],
                acceleration_over: mean_over[row],
                edge_between: edge_between[row],
                place_unresolved: place[row],
                waypoints_within: within[row].clone(),
                mean_deviation,
                max_acceleration,
                t_acceleration,
                acceleration_unresolved: unresolved[row]
                    .zip(step[row])
                    .zip(step_over[row])
                    .map(|((by, step), over)| Unresolved { by, step, over }),
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
                missing: Missing { deviation: no_deviation[row], acceleration: no_acceleration[row] },
                leg_source: leg_source[row].unwrap_or_default(),
                acceleration_source: acceleration_source[row].unwrap_or_default(),
                legs: legs[row].clone(),
            };
            possible::check(table, row, &measures)?;
            Ok(Some(measures))
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

/// A column that tables of other robots, or of older versions, do not have.
fn optional_column(table: &Table, column: &str) -> Result<Vec<Option<f64>>, TableError> {
    match table.has(column) {
        true => table.optional_numbers(column),
        false => Ok(vec![None; table.rows()]),
    }
}

/// A column of flags that tables have where one is set.
fn flags(table: &Table, column: &str) -> Result<Vec<bool>, TableError> {
    let given = if table.has(column) { table.optional_integers(column)? } else { vec![None; table.rows()] };
    Ok(given.into_iter().map(|flag| flag.is_some_and(|flag| flag != 0)).collect())
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
    let or_none = |column| match table.has(column) {
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

pub(super) fn complete_lists(table: &Table, column: &str) -> Result<Vec<Vec<f64>>, TableError> {
    let complete = |(row, list): (usize, Option<Vec<Option<f64>>>)| {
        let numbers = list.unwrap_or_default().into_iter().map(|v| v.filter(|v| v.is_finite()));
        let numbers: Option<Vec<f64>> = numbers.collect();
        numbers.ok_or_else(|| table.refuse(column, row, "a list with gaps", "finite numbers"))
    };
    table.number_lists(column)?.into_iter().enumerate().map(complete).collect()
}

pub(super) fn same_lengths<A, B>(
    table: &Table,
    column: &str,
    lists: &[Vec<A>],
    first: &[Vec<B>],
) -> Result<(), TableError> {
    match (0..lists.len()).find(|&row| lists[row].len() != first[row].len()) {
        Some(row) => {
            let found = format!("{} values", lists[row].len());
            Err(table.refuse(column, row, found, format!("{}, as in its sibling columns", first[row].len())))
        }
        None => Ok(()),
    }
}
