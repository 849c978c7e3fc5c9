//! Waypoints as CSV, one file a case: `x_m,y_m,z_m`, start first. Written for others, and read from others.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use hairpin::campaign::Environment;
use hairpin::campaign::bounds::{FARTHEST_M, MOST_WAYPOINTS};
use nalgebra::Point3;
use thiserror::Error;

use crate::atomic::{self, WriteError};
use crate::delimited::{Cut, Table};
use crate::geodetic;

const COLUMNS: [&str; 3] = ["x_m", "y_m", "z_m"];

/// Why a file is no list of waypoints.
#[derive(Debug, Error)]
pub enum WaypointsError {
    /// The file or folder cannot be read.
    #[error("cannot read {}: {cause}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// The system's answer.
        cause: io::Error,
    },
    /// The header has no such column.
    #[error("{}, line 1: no column `{column}` in the header `{header}`; needed: x_m,y_m,z_m", path.display())]
    Header {
        /// The file.
        path: PathBuf,
        /// The missing column.
        column: &'static str,
        /// The header found.
        header: String,
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
    /// A folder without any mission.
    #[error("{}: no .csv file in it", path.display())]
    Empty {
        /// The folder.
        path: PathBuf,
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

/// A mission made elsewhere.
#[derive(Debug, Clone, PartialEq)]
pub struct Mission {
    /// Name of its file, without the ending.
    pub name: String,
    /// Start first, m.
    pub waypoints: Vec<Point3<f64>>,
    /// What it meets beside them, of the file [`environment_path`] where there is one.
    pub environment: Option<Environment>,
}

/// `NAME.environment.json` in the folder of missions.
pub fn environment_path(folder: &Path, name: &str) -> PathBuf {
    folder.join(format!("{name}.environment.json"))
}

fn read_environment(path: &Path) -> Result<Option<Environment>, WaypointsError> {
    let refuse = |cause| WaypointsError::Unreadable { path: path.into(), cause };
    match fs::read_to_string(path) {
        Err(cause) if cause.kind() == io::ErrorKind::NotFound => Ok(None),
        // Read as a list, its values would be taken for keys in their order.
        text => text
            .and_then(|text| serde_json::from_str::<serde_json::Map<_, _>>(&text).map_err(io::Error::from))
            .and_then(|keys| serde_json::from_value(keys.into()).map_err(io::Error::from))
            .map(Some)
            .map_err(refuse),
    }
}

/// Reads the `.csv` files of a folder, sorted by name, and the environments beside them. Files in degrees
/// ([`crate::geodetic`]), which `export` puts beside those in metres, are passed over.
///
/// # Errors
/// As [`read`]; a folder that cannot be read or has no such file; an environment that is none.
pub fn read_folder(folder: &Path) -> Result<Vec<Mission>, WaypointsError> {
    read_folder_within(folder, FARTHEST_M)
}

/// The same of a world whose coordinates lie within `farthest` m of its origin.
///
/// # Errors
/// As [`read_folder`].
pub fn read_folder_within(folder: &Path, farthest: f64) -> Result<Vec<Mission>, WaypointsError> {
    let refuse = |cause| WaypointsError::Unreadable { path: folder.into(), cause };
    let entries = fs::read_dir(folder).map_err(refuse)?;
    let mut paths = entries.map(|entry| entry.map(|e| e.path())).collect::<Result<Vec<_>, _>>().map_err(refuse)?;
    paths.retain(|path| path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("csv")));
    paths.retain(|path| !path.to_string_lossy().ends_with(geodetic::ENDING));
    paths.sort();
    if paths.is_empty() {
        return Err(WaypointsError::Empty { path: folder.into() });
    }
    let one = |path: &PathBuf| {
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let environment = read_environment(&environment_path(folder, &name))?;
        Ok(Mission { waypoints: read_within(path, farthest)?, name, environment })
    };
    paths.iter().map(one).collect()
}

/// Reads one file. Columns may stand in any order and others beside them; blank lines count and are skipped.
///
/// # Errors
/// The first thing wrong, with line, column and value.
pub fn read(path: &Path) -> Result<Vec<Point3<f64>>, WaypointsError> {
    read_within(path, FARTHEST_M)
}

fn read_within(path: &Path, farthest: f64) -> Result<Vec<Point3<f64>>, WaypointsError> {
    let bytes = fs::read(path).map_err(|cause| WaypointsError::Unreadable { path: path.into(), cause })?;
    // Bytes that are no UTF-8 stay visible in the message of the cell that they stand in.
    parse(path, &String::from_utf8_lossy(&bytes), farthest)
}

fn parse(path: &Path, text: &str, farthest: f64) -> Result<Vec<Point3<f64>>, WaypointsError> {
    let Table { header, names, rows } = Table::of(text, Cut::COMMAS);
    let mut places = [0; 3];
    for (place, column) in places.iter_mut().zip(COLUMNS) {
        let found = names.place(column);
        *place = found.ok_or_else(|| WaypointsError::Header { path: path.into(), column, header: header.into() })?;
    }
    let mut waypoints: Vec<Point3<f64>> = Vec::new();
    for row in rows {
        let line = row.line;
        if row.len() != names.len() {
            return Err(WaypointsError::Width { path: path.into(), line, found: row.len(), expected: names.len() });
        }
        let mut point = Point3::origin();
        for (axis, place) in places.into_iter().enumerate() {
            let value = row.cell(place);
            let number = value.parse::<f64>().ok().filter(|number| number.abs() <= farthest);
            point[axis] = number.ok_or_else(|| WaypointsError::Value {
                path: path.into(),
                line,
                column: COLUMNS[axis].into(),
                value: value.into(),
                farthest,
            })?;
        }
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
