//! What no run can have measured: a table that says so was changed since it was written, or is damaged.
//!
//! | figure | bound |
//! | --- | --- |
//! | deviations, overshoots, accelerations, tilts, durations | ≥ 0 |
//! | mean deviation | ≤ the largest |
//! | the largest of a leg | ≤ that of the run; the smallest ≥ |
//! | the leg of the largest deviation | one of the legs |
//! | when something was measured | between the first and the last stamp |

use hairpin::campaign::FullRate;
use hairpin::judgement::{LegMeasures, Measures};

use super::table::{Table, TableError};

/// A mean, summed and divided, may be rounded beyond what it is a mean of.
const ROUNDING: f64 = 1e-9;
/// First stamps are known as the last less the duration, s.
const STAMP_S: f64 = 1e-6;

/// A column, its value, and the bound that it breaks.
type Broken = (&'static str, f64, String);

/// Checks what was measured of the run in `row`, by whatever rows.
///
/// # Errors
/// The first figure that no run can have.
pub(super) fn check(table: &Table, row: usize, measures: &Measures) -> Result<(), TableError> {
    let broken = negative(measures).or_else(|| no_leg(measures)).or_else(|| beyond_deviation(measures));
    broken.map_or(Ok(()), |broken| Err(refuse(table, row, broken)))
}

/// Checks beside it what was measured of all rows of a run whose last stamp is `end` (s), where that is known.
///
/// # Errors
/// As of [`check`].
pub(super) fn check_run(table: &Table, row: usize, (found, end): (&FullRate, Option<f64>)) -> Result<(), TableError> {
    let measures = &found.measures;
    let broken = beyond_whole(measures).or_else(|| beyond_stamps(measures, end?));
    broken.map_or(Ok(()), |broken| Err(refuse(table, row, broken)))
}

fn refuse(table: &Table, row: usize, (column, value, bound): Broken) -> TableError {
    let case = table.cases().ok().and_then(|cases| cases.get(row).copied());
    let run = table.optional_counts("run").ok().and_then(|runs| runs.get(row).copied().flatten());
    let of = match (case, run) {
        (Some(case), Some(run)) => format!(" in case {case}, run {run}"),
        _ => String::new(),
    };
    table.refuse(column, row, value, bound + &of)
}

fn negative(m: &Measures) -> Option<Broken> {
    let whole = [
        ("max_deviation_m", Some(m.max_deviation)),
        ("mean_deviation_m", Some(m.mean_deviation)),
        ("max_acceleration_m_s2", Some(m.max_acceleration)),
        ("max_speed_rate_m_s2", Some(m.max_speed_rate)),
        ("total_time_s", Some(m.total_time)),
        ("max_tilt_deg", m.max_tilt),
        ("joint_effort_rad2_s3", m.joint_effort),
    ];
    let of_leg = |leg: &LegMeasures| {
        [
            ("leg_max_deviation_m", Some(leg.max_deviation)),
            ("leg_mean_deviation_m", Some(leg.mean_deviation)),
            ("leg_max_acceleration_m_s2", Some(leg.max_acceleration)),
            ("leg_time_s", Some(leg.time)),
            ("leg_overshoot_m", Some(leg.overshoot)),
            ("leg_max_tilt_deg", leg.max_tilt),
        ]
    };
    let overshoots = m.overshoots.iter().map(|overshoot| ("overshoots_m", Some(*overshoot)));
    let mut all = whole.into_iter().chain(m.legs.iter().flat_map(of_leg)).chain(overshoots);
    all.find_map(|(column, value)| Some((column, value.filter(|value| *value < 0.0)?, "≥ 0".to_owned())))
}

fn no_leg(m: &Measures) -> Option<Broken> {
    let last = m.legs.len().checked_sub(1)?;
    (m.leg_worst > last).then(|| ("leg_worst", m.leg_worst as f64, format!("0 to {last}, one of the legs")))
}

fn beyond_deviation(m: &Measures) -> Option<Broken> {
    let of_leg = |leg: &LegMeasures| {
        at_most(("leg_max_deviation_m", leg.max_deviation), ("max_deviation_m", m.max_deviation))
            .or_else(|| at_most(("leg_mean_deviation_m", leg.mean_deviation), ("leg's largest", leg.max_deviation)))
    };
    at_most(("mean_deviation_m", m.mean_deviation), ("max_deviation_m", m.max_deviation))
        .or_else(|| m.legs.iter().find_map(of_leg))
}

/// Legs beyond what was measured of all of them: where both are of the same rows.
fn beyond_whole(m: &Measures) -> Option<Broken> {
    let of_leg = |leg: &LegMeasures| {
        at_most(("leg_max_acceleration_m_s2", leg.max_acceleration), ("max_acceleration_m_s2", m.max_acceleration))
            .or_else(|| at_most(("leg_max_tilt_deg", leg.max_tilt?), ("max_tilt_deg", m.max_tilt?)))
            .or_else(|| at_least(("leg_min_clearance_m", leg.min_clearance?), ("min_clearance_m", m.min_clearance?)))
            .or_else(|| {
                let least = ("min_tip_over_margin_deg", m.min_tip_over_margin?);
                at_least(("leg_min_tip_over_margin_deg", leg.min_tip_over_margin?), least)
            })
    };
    m.legs.iter().find_map(of_leg)
}

/// Times of what was measured: what was not reads 0, wherever the stamps begin.
fn beyond_stamps(m: &Measures, end: f64) -> Option<Broken> {
    let first = end - m.total_time;
    let times = [
        ("t_worst_s", m.deviation().map(|_| m.t_worst)),
        ("t_acceleration_s", (m.max_acceleration > 0.0).then_some(m.t_acceleration)),
        ("t_overshoot_s", (m.max_overshoot() > 0.0).then_some(m.t_overshoot)),
        ("t_clearance_s", m.min_clearance.map(|_| m.t_clearance)),
        ("t_tip_over_margin_s", m.min_tip_over_margin.map(|_| m.t_tip_over_margin)),
        ("t_tilt_s", m.max_tilt.map(|_| m.t_tilt)),
    ];
    let stamps = first - STAMP_S..=end + STAMP_S;
    let outside = |time: &f64| !stamps.contains(time);
    times.into_iter().find_map(|(column, time)| {
        Some((column, time.filter(outside)?, format!("{first} to {end} s, of which it has stamps")))
    })
}

fn at_most((column, value): (&'static str, f64), (whole, most): (&str, f64)) -> Option<Broken> {
    (value > most + ROUNDING * (1.0 + most.abs())).then(|| (column, value, format!("≤ {most}, the `{whole}`")))
}

fn at_least((column, value): (&'static str, f64), (whole, least): (&str, f64)) -> Option<Broken> {
    (value < least - ROUNDING * (1.0 + least.abs())).then(|| (column, value, format!("≥ {least}, the `{whole}`")))
}
