//! `profiles/` of drives: their commands, one row per segment:
//! `case,leg,segment,kind,direction,length_m,turn_rad,a0…a5`, `from_x_m,from_y_m,from_yaw_rad,from_curvature_1_m`,
//! `to_x_m,…`.
//!
//! The leg's ends stand in each of its rows, and its speeds: `profile` (constant, ramp, trapezoid) with
//! `start_speed_m_s`, `cruise_speed_m_s`, `end_speed_m_s`, `acceleration_m_s2`, NaN where a profile has none; and the
//! direction of travel in the body there, `travel_direction_rad` and `travel_direction_end_rad`. The highest speed and
//! the turn rate stand in every row.

use std::io;
use std::path::Path;
use std::sync::Arc;

use arrow_array::{Float64Array, Int64Array, StringArray};
use hairpin::campaign::CaseNumber;
use hairpin::trajectory::drive::{Gear, MOST_SEGMENTS, Motion, Planar, Segment};
use hairpin::trajectory::{Direction, Drive, DriveLeg, SpeedProfile};

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

/// A number of a leg's speeds.
type Of = fn(&SpeedProfile) -> f64;
/// The columns of a leg's speeds.
const SPEEDS: [(&str, Of); 4] = [
    ("start_speed_m_s", SpeedProfile::start),
    ("cruise_speed_m_s", SpeedProfile::top),
    ("end_speed_m_s", SpeedProfile::end),
    ("acceleration_m_s2", |profile| match profile {
        SpeedProfile::Trapezoid { acceleration, .. } => *acceleration,
        SpeedProfile::Constant { .. } | SpeedProfile::Ramp { .. } => f64::NAN,
    }),
];
const CONSTANT: &str = "constant";
const RAMP: &str = "ramp";
const TRAPEZOID: &str = "trapezoid";

fn profile_word(profile: &SpeedProfile) -> &'static str {
    match profile {
        SpeedProfile::Constant { .. } => CONSTANT,
        SpeedProfile::Ramp { .. } => RAMP,
        SpeedProfile::Trapezoid { .. } => TRAPEZOID,
    }
}

/// The speeds of each row's leg.
fn read_speeds(table: &Table) -> Result<Vec<SpeedProfile>, TableError> {
    let words = table.texts("profile")?;
    let [starts, cruises, ends] = [0, 1, 2].map(|i| table.numbers(SPEEDS[i].0));
    let (starts, cruises, ends) = (starts?, cruises?, ends?);
    let accelerations = table.optional_numbers(SPEEDS[3].0)?;
    let profile = |row: usize| {
        let (start, cruise, end) = (starts[row], cruises[row], ends[row]);
        let profile = match words[row].as_str() {
            CONSTANT => SpeedProfile::Constant { speed: cruise },
            RAMP => SpeedProfile::Ramp { start, end },
            TRAPEZOID => {
                SpeedProfile::Trapezoid { start, cruise, end, acceleration: accelerations[row].unwrap_or(f64::NAN) }
            }
            other => return Err(table.refuse("profile", row, format!("`{other}`"), "constant, ramp or trapezoid")),
        };
        profile.checked().map_err(|error| table.refuse("profile", row, error, "speeds that make a profile"))
    };
    (0..table.rows()).map(profile).collect()
}

/// Whether a witness is a drive's: it has segments.
pub(crate) fn is_drive(table: &Table) -> bool {
    table.has("segment")
}

/// Reads a drive, its rows in any order.
///
/// # Errors
/// Missing columns, values out of bounds, a leg or segment that is missing or twice there.
pub fn read(path: &Path) -> Result<Drive, TableError> {
    from_table(&Table::read(path)?)
}

pub(crate) fn from_table(table: &Table) -> Result<Drive, TableError> {
    let (legs, segments) = (table.counts("leg")?, table.counts("segment")?);
    let (kinds, directions) = (table.texts("kind")?, table.numbers("direction")?);
    let (lengths, turns) = (table.numbers("length_m")?, table.numbers("turn_rad")?);
    let polynomial = (0..6).map(|i| table.numbers(&format!("a{i}"))).collect::<Result<Vec<_>, _>>()?;
    let end = |end: &str| -> Result<Vec<Planar>, TableError> {
        let [x, y, yaw, curvature] = ["x_m", "y_m", "yaw_rad", "curvature_1_m"].map(|name| format!("{end}_{name}"));
        let (x, y) = (table.numbers(&x)?, table.numbers(&y)?);
        let (yaw, curvature) = (table.numbers(&yaw)?, table.numbers(&curvature)?);
        Ok((0..table.rows()).map(|i| Planar { x: x[i], y: y[i], yaw: yaw[i], curvature: curvature[i] }).collect())
    };
    let (from, to) = (end("from")?, end("to")?);
    let (speeds, turn_rates) = (table.numbers("speed_m_s")?, table.numbers("turn_rate_rad_s")?);
    // Folders of before directions could turn have the first alone.
    let (travel, travel_end) =
        (table.numbers("travel_direction_rad")?, table.numbers_or_none("travel_direction_end_rad")?);
    let profiles = read_speeds(table)?;
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
    for row in order {
        if segments[row] == 0 {
            let direction = Direction { start: travel[row], end: travel_end[row].unwrap_or(travel[row]) };
            let (from, to, speed) = (from[row], to[row], profiles[row]);
            drive.legs.push(DriveLeg { from, to, segments: Vec::new(), speed, direction });
        }
        let number = drive.legs.len();
        let Some(leg) =
            drive.legs.last_mut().filter(|leg| legs[row] + 1 == number && segments[row] == leg.segments.len())
        else {
            let found = format!("{} (segment {})", legs[row], segments[row]);
            return Err(table.refuse("leg", row, found, "legs from 0 on, each with segments from 0 on, each once"));
        };
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
}
