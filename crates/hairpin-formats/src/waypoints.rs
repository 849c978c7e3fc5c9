//! Waypoints as CSV, one file a case: `x_m,y_m,z_m`, start first. Written for others, and read from others, who may
//! also say where on Earth they are: `lat_deg,lon_deg,alt_amsl_m`.

use std::io;
use std::path::{Path, PathBuf};

use hairpin::campaign::Scenario;
use hairpin::campaign::bounds::{FARTHEST_M, MOST_WAYPOINTS};
use nalgebra::Point3;
use thiserror::Error;

use crate::atomic::{self, WriteError};
use crate::bounds;
use crate::delimited::{Cut, Row, Table};
use crate::frames::Geodetic;
use crate::geodetic;
use crate::placement::Placement;
use crate::quote::cell;

const COLUMNS: [&str; 3] = ["x_m", "y_m", "z_m"];

/// Why a file is no list of waypoints.
#[derive(Debug, Error)]
pub enum WaypointsError {
    /// The file cannot be read.
    #[error("cannot read {}: {cause}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// The system's answer.
        cause: io::Error,
    },
    /// The header has no such column.
    #[error("{}, line 1: no column `{column}` in the header `{header}`; needed: x_m,y_m,z_m, or lat_deg,lon_deg,alt_amsl_m", path.display())]
    Header {
        /// The file.
        path: PathBuf,
        /// The missing column.
        column: &'static str,
        /// The header found, as much of it as a message holds.
        header: String,
    },
    /// It is no table.
    #[error(
        "{}: a ground station's mission, which `hairpin check` takes; here a table is needed: x_m,y_m,z_m, or \
         lat_deg,lon_deg,alt_amsl_m",
        path.display()
    )]
    Station {
        /// The file.
        path: PathBuf,
    },
    /// A cell is not a number, not finite, or too far away.
    #[error(
        "{}, line {line}, column `{column}`: `{value}`, must be a finite number in m, {farthest} at most either way",
        path.display()
    )]
    Value {
        /// The file.
        path: PathBuf,
        /// Line, counted from 1.
        line: usize,
        /// Column.
        column: String,
        /// The text found.
        value: String,
        /// Farthest from the origin, m.
        farthest: f64,
    },
    /// A cell is no place on Earth.
    #[error("{}, line {line}, column `{column}`: `{value}`, must be {bound}", path.display())]
    Degrees {
        /// The file.
        path: PathBuf,
        /// Line, counted from 1.
        line: usize,
        /// Column.
        column: &'static str,
        /// The text found.
        value: String,
        /// What it must be.
        bound: &'static str,
    },
    /// The world does not say where on Earth it stands, or the place is not in it.
    #[error("{}: {why}", path.display())]
    Placed {
        /// The file.
        path: PathBuf,
        /// Why its places are none of the world's.
        why: String,
    },
    /// A row is longer or shorter than the header.
    #[error("{}, line {line}: {found} values, the header has {expected}", path.display())]
    Width {
        /// The file.
        path: PathBuf,
        /// Line, counted from 1.
        line: usize,
        /// Values in the row.
        found: usize,
        /// Columns of the header.
        expected: usize,
    },
    /// A trajectory has a start and an end.
    #[error("{}: {found} waypoints, must be at least 2", path.display())]
    TooFew {
        /// The file.
        path: PathBuf,
        /// Waypoints found.
        found: usize,
    },
    /// More than can be flown.
    #[error("{}, line {line}: more than {MOST_WAYPOINTS} waypoints", path.display())]
    TooMany {
        /// The file.
        path: PathBuf,
        /// Line, counted from 1.
        line: usize,
    },
    /// Two successive waypoints are one point.
    #[error("{}, line {line}: the waypoint of line {} again", path.display(), line - 1)]
    Repeated {
        /// The file.
        path: PathBuf,
        /// Line, counted from 1.
        line: usize,
    },
}

/// The text of a list of waypoints, m. Numbers read back to the same bits.
pub fn text(waypoints: &[Point3<f64>]) -> String {
    let rows = waypoints.iter().map(|p| format!("{},{},{}\n", p.x, p.y, p.z));
    std::iter::once("x_m,y_m,z_m\n".to_owned()).chain(rows).collect()
}

/// Writes [`text`].
///
/// # Errors
/// The file cannot be written.
pub fn write(path: &Path, waypoints: &[Point3<f64>]) -> Result<(), WriteError> {
    atomic::write(path, text(waypoints).as_bytes())
}

/// Reads one file, and whether it is in degrees, which `scenario` places. Columns may stand in any order and others
/// beside them; blank lines count and are skipped.
///
/// # Errors
/// The first thing wrong, with line, column and value.
pub fn read(path: &Path, scenario: &Scenario, farthest: f64) -> Result<(Vec<Point3<f64>>, bool), WaypointsError> {
    let unreadable = |cause| WaypointsError::Unreadable { path: path.into(), cause };
    let bytes = bounds::read_table(path).map_err(unreadable)?;
    // Bytes that are no UTF-8 stay visible in the message of the cell that they stand in.
    let text = String::from_utf8_lossy(&bytes);
    let header = Table::of(&text, Cut::told_by(&text)).names;
    let degrees = has_degrees(&header);
    if !degrees {
        return Ok((parse(path, &text, COLUMNS, |row, places| metres(path, row, places, farthest))?, false));
    }
    let placed = |why: String| WaypointsError::Placed { path: path.into(), why };
    let world = Placement::of(scenario).map_err(placed)?.ok_or_else(|| {
        placed(
            "its waypoints are in degrees, and the scenario has no world.origin and no map whose plane is known \
             (world.terrain.epsg)"
                .into(),
        )
    })?;
    let waypoints = parse(path, &text, geodetic::PLACE, |row, places| {
        let place = degrees_of(path, row, places)?;
        let point = world.from_geodetic(&place).map_err(|why| placed(format!("line {}: {why}", row.line)))?;
        match (0..3).find(|axis| !(-farthest..=farthest).contains(&point[*axis])) {
            Some(_) => {
                let far = (point - Point3::origin()).norm() / 1000.0;
                let most = farthest / 1000.0;
                Err(placed(format!("line {}: {far:.1} km from the world's origin, {most} at most", row.line)))
            }
            None => Ok(point),
        }
    })?;
    Ok((waypoints, true))
}

fn has_degrees(header: &Row) -> bool {
    header.place(COLUMNS[0]).is_none() && geodetic::PLACE[..2].iter().all(|column| header.place(column).is_some())
}

/// Whether the waypoints in `path` are in degrees, and so need a world on Earth.
///
/// # Errors
/// The file cannot be read.
pub fn are_in_degrees(path: &Path) -> Result<bool, WaypointsError> {
    let bytes = bounds::read_table(path).map_err(|cause| WaypointsError::Unreadable { path: path.into(), cause })?;
    let text = String::from_utf8_lossy(&bytes);
    Ok(has_degrees(&Table::of(&text, Cut::told_by(&text)).names))
}

/// Columns of the table in `path` that are not read.
///
/// # Errors
/// The file cannot be read.
pub fn unread_columns(path: &Path) -> Result<Vec<String>, WaypointsError> {
    let bytes = bounds::read_table(path).map_err(|cause| WaypointsError::Unreadable { path: path.into(), cause })?;
    let text = String::from_utf8_lossy(&bytes);
    let header = Table::of(&text, Cut::told_by(&text)).names;
    let is_in = |columns: [&str; 3]| columns.iter().all(|column| header.place(column).is_some());
    let read = if is_in(COLUMNS) { COLUMNS } else { geodetic::PLACE };
    let others = header.cells().filter(|name| !name.is_empty() && !read.contains(name));
    Ok(others.map(str::to_owned).collect())
}

/// A row in metres.
fn metres(path: &Path, row: &Row, places: [usize; 3], farthest: f64) -> Result<Point3<f64>, WaypointsError> {
    let mut point = Point3::origin();
    for (axis, place) in places.into_iter().enumerate() {
        let value = row.cell(place);
        let number = value.parse::<f64>().ok().filter(|number| number.abs() <= farthest);
        point[axis] = number.ok_or_else(|| WaypointsError::Value {
            path: path.into(),
            line: row.line,
            column: COLUMNS[axis].into(),
            value: value.into(),
            farthest,
        })?;
    }
    Ok(point)
}

/// A row in degrees.
fn degrees_of(path: &Path, row: &Row, places: [usize; 3]) -> Result<Geodetic, WaypointsError> {
    let bounds = [
        (90.0, "a latitude, from -90 to 90°"),
        (180.0, "a longitude, from -180 to 180°"),
        (FARTHEST_M, "an altitude within 20000 m of the sea"),
    ];
    let number = |axis: usize| {
        let (value, (most, bound)) = (row.cell(places[axis]), bounds[axis]);
        let number = value.parse::<f64>().ok().filter(|number| number.abs() <= most);
        let (line, column) = (row.line, geodetic::PLACE[axis]);
        number.ok_or_else(|| WaypointsError::Degrees { path: path.into(), line, column, value: value.into(), bound })
    };
    Ok(Geodetic { lat_deg: number(0)?, lon_deg: number(1)?, alt_amsl_m: number(2)? })
}

fn parse(
    path: &Path,
    text: &str,
    columns: [&'static str; 3],
    point_of: impl Fn(&Row, [usize; 3]) -> Result<Point3<f64>, WaypointsError>,
) -> Result<Vec<Point3<f64>>, WaypointsError> {
    let Table { header, names, rows } = Table::of(text, Cut::told_by(text));
    let mut places = [0; 3];
    for (place, column) in places.iter_mut().zip(columns) {
        let missing = || match header.trim_start() {
            station if station.starts_with('{') || station.starts_with("QGC WPL") => {
                WaypointsError::Station { path: path.into() }
            }
            _ => WaypointsError::Header { path: path.into(), column, header: cell(header) },
        };
        *place = names.place(column).ok_or_else(missing)?;
    }
    let mut waypoints: Vec<Point3<f64>> = Vec::new();
    for row in rows {
        let line = row.line;
        if row.len() != names.len() {
            return Err(WaypointsError::Width { path: path.into(), line, found: row.len(), expected: names.len() });
        }
        let point = point_of(&row, places)?;
        if waypoints.last() == Some(&point) {
            return Err(WaypointsError::Repeated { path: path.into(), line });
        }
        if waypoints.len() == MOST_WAYPOINTS {
            return Err(WaypointsError::TooMany { path: path.into(), line });
        }
        waypoints.push(point);
    }
    if waypoints.len() < 2 {
        return Err(WaypointsError::TooFew { path: path.into(), found: waypoints.len() });
    }
    Ok(waypoints)
}
