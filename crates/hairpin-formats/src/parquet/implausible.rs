//! What no robot of its kind does, as columns of `runs/`: of runs that were looked at, which are those of programs.

use std::sync::Arc;

use arrow_array::{ArrayRef, BooleanArray, Float64Array};
use hairpin::campaign::implausible::{Implausible, Impossible, Overturned};

use super::table::{Table, TableError};

/// Whether a run was looked at; what was found stands beside it, and where nothing does nothing was.
const LOOKED_AT: &str = "motion_looked_at";
const THROUGHOUT: &str = "overturned_throughout";

type Figure = fn(&Implausible) -> Option<f64>;

/// What is faster than the robot can be: all of it, or nothing.
const TOO_FAST: [(&str, Figure); 4] = [
    ("too_fast_from_s", |found| Some(found.speed?.from_s)),
    ("too_fast_over_s", |found| Some(found.speed?.over_s)),
    ("too_fast_way_m", |found| Some(found.speed?.way_m)),
    ("too_fast_bound_m_s", |found| Some(found.speed?.bound_m_s)),
];

/// Where its up axis is too far from the vertical, likewise.
const OVERTURNED: [(&str, Figure); 2] = [
    ("overturned_at_s", |found| Some(found.attitude?.at_s)),
    ("overturned_tilt_rad", |found| Some(found.attitude?.tilt_rad)),
];

/// The columns of what was found, a row each; none where nobody looked at any run.
pub(super) fn columns(rows: &[Option<Implausible>]) -> Vec<(&'static str, ArrayRef)> {
    if rows.iter().all(Option::is_none) {
        return Vec::new();
    }
    let looked: ArrayRef = Arc::new(rows.iter().map(|row| Some(row.is_some())).collect::<BooleanArray>());
    let number = |(name, value): (&'static str, Figure)| -> (&'static str, ArrayRef) {
        (name, Arc::new(rows.iter().map(|row| row.as_ref().and_then(value)).collect::<Float64Array>()))
    };
    let throughout = rows.iter().map(|row| Some(row.as_ref()?.attitude?.throughout));
    let throughout: ArrayRef = Arc::new(throughout.collect::<BooleanArray>());
    let numbers = TOO_FAST.into_iter().chain(OVERTURNED).map(number);
    [(LOOKED_AT, looked)].into_iter().chain(numbers).chain([(THROUGHOUT, throughout)]).collect()
}

/// Reads what was found; `None` of runs that nobody looked at, as those of tables of earlier versions.
///
/// # Errors
/// Missing columns; a part of what was found, or what no motion can have.
pub(super) fn read(table: &Table) -> Result<Vec<Option<Implausible>>, TableError> {
    if !table.has(LOOKED_AT) {
        return Ok(vec![None; table.rows()]);
    }
    let looked = table.optional_integers(LOOKED_AT)?;
    let speed = TOO_FAST.map(|(name, _)| table.optional_numbers(name));
    let speed = speed.into_iter().collect::<Result<Vec<_>, _>>()?;
    let attitude = OVERTURNED.map(|(name, _)| table.optional_numbers(name));
    let attitude = attitude.into_iter().collect::<Result<Vec<_>, _>>()?;
    let throughout = table.optional_integers(THROUGHOUT)?;
    let whole = |names: &[(&'static str, Figure)], columns: &[Vec<Option<f64>>], row: usize| {
        let there = columns.iter().filter(|column| column[row].is_some()).count();
        let empty = columns.iter().position(|column| column[row].is_none());
        match empty.filter(|_| there > 0) {
            Some(one) => Err(table.refuse(names[one].0, row, "empty", "a number beside the others of what was found")),
            None => Ok(there > 0),
        }
    };
    let positive = |name: &str, row: usize, value: f64| match value > 0.0 {
        true => Ok(value),
        false => Err(table.refuse(name, row, value, "> 0")),
    };
    let found = |(row, looked): (usize, Option<i64>)| {
        if looked.is_none_or(|looked| looked == 0) {
            return Ok(None);
        }
        let number = |columns: &[Vec<Option<f64>>], column: usize| columns[column][row].unwrap_or_default();
        let speed = match whole(&TOO_FAST, &speed, row)? {
            true => Some(Impossible {
                from_s: number(&speed, 0),
                over_s: positive(TOO_FAST[1].0, row, number(&speed, 1))?,
                way_m: positive(TOO_FAST[2].0, row, number(&speed, 2))?,
                bound_m_s: positive(TOO_FAST[3].0, row, number(&speed, 3))?,
            }),
            false => None,
        };
        let attitude = whole(&OVERTURNED, &attitude, row)?.then(|| Overturned {
            at_s: number(&attitude, 0),
            tilt_rad: number(&attitude, 1),
            throughout: throughout[row].is_some_and(|flag| flag != 0),
        });
        Ok(Some(Implausible { speed, attitude }))
    };
    looked.into_iter().enumerate().map(found).collect()
}
