//! `profiles/` of drives: their commands, one row per segment:
//! `case,leg,segment,kind,direction,length_m,turn_rad,a0…a5`, `from_x_m,from_y_m,from_yaw_rad,from_curvature_1_m`,
//! `to_x_m,…`.
//!
//! The leg's ends stand in each of its rows, and its speeds: `profile` (constant, ramp, trapezoid) with
//! `start_speed_m_s`, `cruise_speed_m_s`, `end_speed_m_s`, `acceleration_m_s2`, NaN where a profile has none; and the
//! direction of travel in the body there, `travel_direction_rad` and `travel_direction_end_rad`. The highest speed and
//! the turn rate stand in every row. Rows that differ in what is their leg's are refused: who reads another row than we
//! do would have another drive.

use std::io;
use std::path::Path;
use std::sync::Arc;

use arrow_array::{Float64Array, Int64Array, StringArray};
use hairpin::campaign::CaseNumber;
use hairpin::trajectory::drive::{Gear, MOST_SEGMENTS, Motion, Planar, Segment};
use hairpin::trajectory::{Drive, DriveLeg};

use super::drive_legs::{OfLegs, SPEEDS, profile_word};
use super::piece::Piece;
use super::table::{CASE, Columns, Table, TableError};

const ARC: &str = "arc";
const TURN: &str = "turn";

/// The rows of `drive`: curvature of a segment is Σ aᵢ sⁱ (1/m), s from 0 in each; ψ̇ = direction · v · κ.
///
/// # Errors
/// There is no room for them.
pub fn piece(case: CaseNumber, drive: &Drive) -> io::Result<Piece> {
    let rows: Vec<(usize, usize, &DriveLeg, &Segment)> = (drive.legs.iter().enumerate())
        .flat_map(|(number, leg)| leg.segments.iter().enumerate().map(move |(i, segment)| (number, i, leg, segment)))
        .collect();
    let mut columns = Columns::default();
    columns.push(CASE, Arc::new(StringArray::from(vec![case.to_string(); rows.len()])));
    let mut counts = |name: &str, of: fn(&(usize, usize, &DriveLeg, &Segment)) -> i64| {
        columns.push(name, Arc::new(rows.iter().map(of).collect::<Int64Array>()));
    };
    counts("leg", |row| row.0 as i64);
    counts("segment", |row| row.1 as i64);
    counts("direction", |row| row.3.gear.sign() as i64);
    let kind = |segment: &Segment| match segment.motion {
        Motion::Arc { .. } => ARC,
        Motion::Turn { .. } => TURN,
    };
    columns.push("kind", Arc::new(rows.iter().map(|row| Some(kind(row.3))).collect::<StringArray>()));
    let mut numbers = |name: String, of: &dyn Fn(&DriveLeg, &Segment) -> f64| {
        columns.push(name, Arc::new(rows.iter().map(|row| of(row.2, row.3)).collect::<Float64Array>()));
    };
    numbers("length_m".into(), &|_, segment| segment.length_m());
    numbers("turn_rad".into(), &|_, segment| match segment.motion {
        Motion::Arc { .. } => 0.0,
        Motion::Turn { angle_rad } => angle_rad,
    });
    for i in 0..6 {
        numbers(format!("a{i}"), &|_, segment| match segment.motion {
            Motion::Arc { curvature, .. } => curvature[i],
            Motion::Turn { .. } => 0.0,
        });
    }
    for (end, of) in [("from", (|leg| &leg.from) as fn(&DriveLeg) -> &Planar), ("to", |leg| &leg.to)] {
        numbers(format!("{end}_x_m"), &|leg, _| of(leg).x);
        numbers(format!("{end}_y_m"), &|leg, _| of(leg).y);
        numbers(format!("{end}_yaw_rad"), &|leg, _| of(leg).yaw);
        numbers(format!("{end}_curvature_1_m"), &|leg, _| of(leg).curvature);
    }
    for (name, of) in SPEEDS {
        numbers(name.into(), &|leg, _| of(&leg.speed));
    }
    numbers("speed_m_s".into(), &|_, _| drive.speed);
    numbers("turn_rate_rad_s".into(), &|_, _| drive.turn_rate);
    numbers("travel_direction_rad".into(), &|leg, _| leg.direction.start);
    numbers("travel_direction_end_rad".into(), &|leg, _| leg.direction.end);
    let profiles = rows.iter().map(|row| Some(profile_word(&row.2.speed))).collect::<StringArray>();
    columns.push("profile", Arc::new(profiles));
    Piece::of(columns)
}

/// Whether a witness is a drive's: it has segments.
pub(crate) fn is_drive(table: &Table) -> bool {
    table.has("segment")
}

/// Reads a drive, its rows in any order.
///
/// # Errors
/// Missing columns, values out of bounds, a leg or segment that is missing or twice there, rows of one leg that differ
/// in what is the leg's.
pub fn read(path: &Path) -> Result<Drive, TableError> {
    from_table(&Table::read(path)?)
}

pub(crate) fn from_table(table: &Table) -> Result<Drive, TableError> {
    let (legs, segments) = (table.counts("leg")?, table.counts("segment")?);
    let (kinds, directions) = (table.texts("kind")?, table.numbers("direction")?);
    let (lengths, turns) = (table.numbers("length_m")?, table.numbers("turn_rad")?);
    let polynomial = (0..6).map(|i| table.numbers(&format!("a{i}"))).collect::<Result<Vec<_>, _>>()?;
    let (speeds, turn_rates) = (table.numbers("speed_m_s")?, table.numbers("turn_rate_rad_s")?);
    let of_legs = OfLegs::read(table)?;
    if table.rows() == 0 {
        return Err(table.refuse("leg", 0, "missing", "one row for each segment"));
    }
    let mut order: Vec<usize> = (0..table.rows()).collect();
    order.sort_by_key(|&row| (legs[row], segments[row]));
    let mut drive = Drive { legs: Vec::new(), speed: speeds[0], turn_rate: turn_rates[0] };
    for (name, values) in [("speed_m_s", &speeds), ("turn_rate_rad_s", &turn_rates)] {
        if let Some(row) = values.iter().position(|value| *value <= 0.0 || *value != values[0]) {
            return Err(table.refuse(name, row, values[row], "> 0, and the same in every row"));
        }
    }
    let mut first = order[0];
    for row in order {
        if segments[row] == 0 {
            first = row;
            drive.legs.push(of_legs.leg(row));
        }
        let number = drive.legs.len();
        let Some(leg) =
            drive.legs.last_mut().filter(|leg| legs[row] + 1 == number && segments[row] == leg.segments.len())
        else {
            let found = format!("{} (segment {})", legs[row], segments[row]);
            return Err(table.refuse("leg", row, found, "legs from 0 on, each with segments from 0 on, each once"));
        };
        of_legs.check(table, row, first)?;
        let gear = match directions[row] {
            1.0 => Gear::Forward,
            -1.0 => Gear::Reverse,
            other => return Err(table.refuse("direction", row, other, "1 or -1")),
        };
        if lengths[row] < 0.0 {
            return Err(table.refuse("length_m", row, lengths[row], "≥ 0"));
        }
        let motion = match kinds[row].as_str() {
            ARC => Motion::Arc { length_m: lengths[row], curvature: std::array::from_fn(|i| polynomial[i][row]) },
            TURN => Motion::Turn { angle_rad: turns[row] },
            other => return Err(table.refuse("kind", row, format!("`{other}`"), "arc or turn")),
        };
        if leg.segments.len() == MOST_SEGMENTS {
            return Err(table.refuse("segment", row, segments[row], format!("less than {MOST_SEGMENTS}")));
        }
        leg.segments.push(Segment { motion, gear });
    }
    Ok(drive)
}

#[cfg(test)]
mod tests {
    use arrow_array::ArrayRef;
    use arrow_array::cast::AsArray;
    use arrow_array::types::Float64Type;
    use hairpin::trajectory::{Direction, SpeedProfile};

    use super::*;
    use crate::parquet::part_writer::write_one;

    fn write(path: &Path, drive: &Drive) -> io::Result<()> {
        write_one(path, "drive", piece(CaseNumber(0), drive)?).map_err(|error| error.cause)
    }

    #[test]
    fn a_drive_comes_back_as_it_was() {
        let at = |x: f64| Planar { x, y: -x, yaw: 0.3 * x, curvature: 0.1 };
        let arc = Motion::Arc { length_m: 2.5, curvature: [0.1, -0.2, 0.3, 0.0, 1e-3, -1e-4] };
        let segments = vec![
            Segment { motion: arc, gear: Gear::Reverse },
            Segment { motion: Motion::Turn { angle_rad: -0.7 }, gear: Gear::Forward },
        ];
        let leg = |x: f64, segments: &[Segment], speed| DriveLeg {
            from: at(x),
            to: at(x + 1.0),
            segments: segments.to_vec(),
            speed,
            direction: Direction { start: 0.2 - 0.1 * x, end: 0.1 - 0.1 * x },
        };
        let legs = vec![
            leg(0.0, &segments, SpeedProfile::Ramp { start: 0.0, end: 0.05 }),
            leg(
                1.0,
                &segments[..1],
                SpeedProfile::Trapezoid { start: 0.05, cruise: 0.06, end: 0.0, acceleration: 0.1 },
            ),
            leg(2.0, &segments[..1], SpeedProfile::Constant { speed: 0.06 }),
        ];
        let drive = Drive { legs, speed: 0.06, turn_rate: 0.1 };
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("0000.parquet");
        write(&path, &drive).unwrap();
        assert_eq!(read(&path).unwrap(), drive);
        // Without its end, as older folders are, a direction stays as it begins.
        let mut constant = drive.clone();
        constant.legs.iter_mut().for_each(|leg| leg.direction.end = f64::NAN);
        write(&path, &constant).unwrap();
        assert!(read(&path).unwrap().legs.iter().all(|leg| leg.direction.end == leg.direction.start));
        let broken = Drive { speed: 0.0, ..drive.clone() };
        write(&path, &broken).unwrap();
        assert!(read(&path).unwrap_err().to_string().contains("speed_m_s"));
        let mut long = drive.clone();
        long.legs[1].segments = vec![segments[0]; MOST_SEGMENTS];
        write(&path, &long).unwrap();
        assert_eq!(read(&path).unwrap(), long);
        long.legs[1].segments.push(segments[0]);
        write(&path, &long).unwrap();
        let told = read(&path).unwrap_err().to_string();
        assert!(told.contains("segment") && told.contains("40") && told.contains("less than 40"), "{told}");
        let mut broken = drive;
        broken.legs[0].speed = SpeedProfile::Ramp { start: 0.0, end: 0.0 };
        write(&path, &broken).unwrap();
        assert!(read(&path).unwrap_err().to_string().contains("profile"));
    }

    /// Three segments of one leg: its own numbers stand in each of the rows, and another reader may take them from any.
    #[test]
    fn rows_that_differ_in_what_is_their_legs_are_refused() {
        let at = |x: f64| Planar { x, y: 0.0, yaw: 0.0, curvature: 0.0 };
        let straight = Segment { motion: Motion::Arc { length_m: 1.0, curvature: [0.0; 6] }, gear: Gear::Forward };
        let speed = SpeedProfile::Trapezoid { start: 0.0, cruise: 0.5, end: 0.0, acceleration: 1.0 };
        let direction = Direction { start: 0.0, end: 0.0 };
        let leg = DriveLeg { from: at(0.0), to: at(3.0), segments: vec![straight; 3], speed, direction };
        let drive = Drive { legs: vec![leg], speed: 0.5, turn_rate: 0.1 };
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("0000.parquet");
        let of_leg = [
            ("from_yaw_rad", 0.01, "0, as in the leg's first row"),
            ("to_x_m", 2.0, "3, as in the leg's first row"),
            ("travel_direction_rad", 0.1, "0, as in the leg's first row"),
            ("travel_direction_end_rad", 0.1, "0, as in the leg's first row"),
            ("cruise_speed_m_s", 0.4, "0.5, as in the leg's first row"),
            ("end_speed_m_s", 0.1, "0, as in the leg's first row"),
            ("acceleration_m_s2", 2.0, "1, as in the leg's first row"),
        ];
        for (column, value, bound) in of_leg {
            write_changed(&path, &drive, column, value);
            let told = read(&path).unwrap_err().to_string();
            let place = [path.to_str().unwrap(), column, "row 2", &value.to_string(), bound];
            assert!(place.iter().all(|part| told.contains(part)), "{column}: {told}");
        }
        let mut steady = drive;
        steady.legs[0].speed = SpeedProfile::Constant { speed: 0.5 };
        write_changed(&path, &steady, "start_speed_m_s", 0.2);
        let told = read(&path).unwrap_err().to_string();
        assert!(
            told.contains("start_speed_m_s") && told.contains("0.5, as the leg's profile, constant, has it"),
            "{told}"
        );
    }

    /// `drive` with `value` in the last row of `column`.
    fn write_changed(path: &Path, drive: &Drive, column: &str, value: f64) {
        write_one(path, "drive", piece(CaseNumber(0), drive).unwrap()).unwrap();
        let batch = Table::read(path).unwrap().batch;
        let mut columns = Columns::default();
        for (field, array) in batch.schema().fields().iter().zip(batch.columns()) {
            let array: ArrayRef = match field.name() == column {
                true => {
                    let mut numbers = array.as_primitive::<Float64Type>().values().to_vec();
                    *numbers.last_mut().unwrap() = value;
                    Arc::new(Float64Array::from(numbers))
                }
                false => array.clone(),
            };
            columns.push(field.name(), array);
        }
        columns.write(path, "drive").unwrap();
    }
}
