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
const START: &str = "t0_s";

/// The rows of `profile`: position along `axis` on `leg` is Σ c_i τ^i in m, τ = t − `t0_s` ∈ [0, `duration_s`].
///
/// # Errors
/// There is no room for them.
pub fn piece(case: CaseNumber, profile: &Profile) -> io::Result<Piece> {
    let rows = || profile.legs.iter().enumerate().flat_map(|(number, leg)| (0..3).map(move |axis| (number, leg, axis)));
    let starts = starts(profile);
    let mut columns = Columns::default();
    columns.push(CASE, Arc::new(StringArray::from(vec![case.to_string(); 3 * profile.legs.len()])));
    columns.push("leg", Arc::new(rows().map(|(number, ..)| number as i64).collect::<Int64Array>()));
    columns.push("axis", Arc::new(rows().map(|(_, _, axis)| Some(AXES[axis])).collect::<StringArray>()));
    columns.push(START, Arc::new(rows().map(|(number, ..)| starts[number]).collect::<Float64Array>()));
    columns.push("duration_s", Arc::new(rows().map(|(_, leg, _)| leg.duration).collect::<Float64Array>()));
    for i in 0..8 {
        let values = rows().map(|(_, leg, axis)| leg.coefficients[axis][i]).collect::<Float64Array>();
        columns.push(format!("c{i}"), Arc::new(values));
    }
    Piece::of(columns)
}

/// Share by which a leg may begin off the end of the one before it: other writers may have kept single precision.
const BEGINS: f64 = 1e-6;

/// Reads a profile, its rows in any order. `t0_s` is derived, and may be left out; where it stands it must be what it
/// is derived from, to a millionth: others read it.
///
/// # Errors
/// Missing columns, values out of bounds, a leg or axis that is missing, twice there, or has another duration; a leg
/// that does not begin where the one before it ends.
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
    let profile = Profile { legs: found.iter().enumerate().map(leg).collect::<Result<_, _>>()? };
    check_starts(table, &legs, &profile)?;
    Ok(profile)
}

/// Whether each row says when its leg, of number `legs`, begins: Σ of the durations before it, s.
fn check_starts(table: &Table, legs: &[usize], profile: &Profile) -> Result<(), TableError> {
    if !table.has(START) {
        return Ok(());
    }
    let starts = starts(profile);
    for (row, told) in table.numbers(START)?.into_iter().enumerate() {
        let start = starts[legs[row]];
        if (told - start).abs() > BEGINS * start {
            return Err(table.refuse(START, row, told, format!("{start} s, where the leg before it ends")));
        }
    }
    Ok(())
}

/// When each leg begins, s.
fn starts(profile: &Profile) -> Vec<f64> {
    let begin = |t: &mut f64, leg: &ProfileLeg| {
        let start = *t;
        *t += leg.duration;
        Some(start)
    };
    profile.legs.iter().scan(0.0, begin).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parquet::part_writer::write_one;

    /// Of what was written `t0_s` alone is changed.
    #[test]
    fn legs_begin_where_those_before_them_end() {
        let leg = |duration: f64| ProfileLeg { duration, coefficients: [[0.0; 8]; 3] };
        let profile = Profile { legs: vec![leg(2.0), leg(3.0), leg(1.0)] };
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("0000.parquet");
        write_one(&path, "profile", piece(CaseNumber(0), &profile).unwrap()).unwrap();
        assert_eq!(read(&path).unwrap(), profile);
        let batch = Table::read(&path).unwrap().batch;
        let changed = |change: &dyn Fn(&mut Vec<f64>)| {
            let mut columns = Columns::default();
            for (field, array) in batch.schema().fields().iter().zip(batch.columns()) {
                let mut starts = vec![0.0, 0.0, 0.0, 2.0, 2.0, 2.0, 5.0, 5.0, 5.0];
                change(&mut starts);
                let is_start = field.name() == START;
                columns.push(field.name(), if is_start { Arc::new(Float64Array::from(starts)) } else { array.clone() });
            }
            columns.write(&path, "profile").unwrap();
            read(&path).map_err(|error| error.to_string())
        };
        assert_eq!(changed(&|starts| starts[8] *= 1.0 + 1e-7), Ok(profile.clone()), "single precision");
        for (row, value, start) in [(0, 0.5, 0.0), (3, 2.5, 2.0), (8, 4.9, 5.0)] {
            let told = changed(&|starts| starts[row] = value).unwrap_err();
            let bound = format!("{start} s, where the leg before it ends");
            let place = [path.to_str().unwrap(), START, &format!("row {row}"), &value.to_string(), &bound];
            assert!(place.iter().all(|part| told.contains(part)), "{told}");
        }
    }
}
