//! `profiles/`: the control witness, one row per leg and axis: `case,leg,axis,t0_s,duration_s,c0…c7`.

use std::io;
use std::path::Path;
use std::sync::Arc;

use arrow_array::{Float64Array, Int64Array, StringArray};
use hairpin::campaign::CaseNumber;
use hairpin::trajectory::{Profile, ProfileLeg};

use super::piece::Piece;
use super::table::{CASE, Columns, Table, TableError};

const AXES: [&str; 3] = ["x", "y", "z"];

/// The rows of `profile`: position along `axis` on `leg` is Σ c_i τ^i in m, τ = t − `t0_s` ∈ [0, `duration_s`].
///
/// # Errors
/// There is no room for them.
pub fn piece(case: CaseNumber, profile: &Profile) -> io::Result<Piece> {
    let rows = || profile.legs.iter().enumerate().flat_map(|(number, leg)| (0..3).map(move |axis| (number, leg, axis)));
    let starts: Vec<f64> = profile
        .legs
        .iter()
        .scan(0.0, |t, leg| {
            let start = *t;
            *t += leg.duration;
            Some(start)
        })
        .collect();
    let mut columns = Columns::default();
    columns.push(CASE, Arc::new(StringArray::from(vec![case.to_string(); 3 * profile.legs.len()])));
    columns.push("leg", Arc::new(rows().map(|(number, ..)| number as i64).collect::<Int64Array>()));
    columns.push("axis", Arc::new(rows().map(|(_, _, axis)| Some(AXES[axis])).collect::<StringArray>()));
    columns.push("t0_s", Arc::new(rows().map(|(number, ..)| starts[number]).collect::<Float64Array>()));
    columns.push("duration_s", Arc::new(rows().map(|(_, leg, _)| leg.duration).collect::<Float64Array>()));
    for i in 0..8 {
        let values = rows().map(|(_, leg, axis)| leg.coefficients[axis][i]).collect::<Float64Array>();
        columns.push(format!("c{i}"), Arc::new(values));
    }
    Piece::of(columns)
}

/// Reads a profile, its rows in any order. `t0_s` is derived and not read.
///
/// # Errors
/// Missing columns, values out of bounds, a leg or axis that is missing, twice there, or has another duration.
pub fn read(path: &Path) -> Result<Profile, TableError> {
    from_table(&Table::read(path)?)
}

pub(crate) fn from_table(table: &Table) -> Result<Profile, TableError> {
    let legs = table.counts("leg")?;
    let axes = table.texts("axis")?;
    let durations = table.numbers("duration_s")?;
    let coefficients = (0..8).map(|i| table.numbers(&format!("c{i}"))).collect::<Result<Vec<_>, _>>()?;
    let count = table.rows() / 3;
    let mut found: Vec<[Option<usize>; 3]> = vec![[None; 3]; count];
    for row in 0..table.rows() {
        let axis = AXES.iter().position(|name| *name == axes[row]);
        let axis = axis.ok_or_else(|| table.refuse("axis", row, format!("`{}`", axes[row]), "x, y or z"))?;
        let slot = found.get_mut(legs[row]).map(|leg| &mut leg[axis]).filter(|slot| slot.is_none());
        let bound = format!("each of 0…{} once for each axis", count.saturating_sub(1));
        *slot.ok_or_else(|| table.refuse("leg", row, format!("{} (axis {})", legs[row], axes[row]), bound))? =
            Some(row);
        if durations[row] <= 0.0 {
            return Err(table.refuse("duration_s", row, durations[row], "> 0"));
        }
    }
    let leg = |(number, found): (usize, &[Option<usize>; 3])| -> Result<ProfileLeg, TableError> {
        let missing =
            |axis: usize| table.refuse("leg", table.rows(), "missing", format!("{number} for {}", AXES[axis]));
        let mut leg = ProfileLeg { duration: 0.0, coefficients: [[0.0; 8]; 3] };
        for (axis, row) in found.iter().enumerate() {
            let row = row.ok_or_else(|| missing(axis))?;
            if axis > 0 && durations[row] != leg.duration {
                let bound = format!("{} s, as for this leg's axis x", leg.duration);
                return Err(table.refuse("duration_s", row, durations[row], bound));
            }
            leg.duration = durations[row];
            leg.coefficients[axis] = std::array::from_fn(|i| coefficients[i][row]);
        }
        Ok(leg)
    };
    if !table.rows().is_multiple_of(3) {
        return Err(table.refuse("leg", table.rows(), "missing", "three rows, x, y and z, for each leg"));
    }
    Ok(Profile { legs: found.iter().enumerate().map(leg).collect::<Result<_, _>>()? })
}
