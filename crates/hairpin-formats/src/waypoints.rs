//! Waypoints as CSV, one file a case: `x_m,y_m,z_m`, start first. Written for others, and read from others, who may
//! also say where on Earth they are: `lat_deg,lon_deg,alt_amsl_m`.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use hairpin::campaign::bounds::{FARTHEST_M, MOST_WAYPOINTS};
use hairpin::campaign::{Environment, Scenario};
use nalgebra::Point3;
use thiserror::Error;

use crate::atomic::{self, WriteError};
use crate::bounds::{self, MOST_BYTES};
use crate::delimited::{Cut, Row, Table};
use crate::folder::is_of_a_motion;
use crate::frames::Geodetic;
use crate::geodetic;
use crate::placement::Placement;

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
    #[error("{}, line 1: no column `{column}` in the header `{header}`; needed: x_m,y_m,z_m, or lat_deg,lon_deg,alt_amsl_m", path.display())]
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
    /// Whether they were given in degrees, whose last digit is some hundredths of a millimetre.
    pub rounded: bool,
    /// What it meets beside them, of the file [`environment_path`] where there is one.
    pub environment: Option<Environment>,
}

/// `NAME.environment.json` in the folder of missions.
pub fn environment_path(folder: &Path, name: &str) -> PathBuf {
    folder.join(format!("{name}.environment.json"))
}

fn read_environment(path: &Path) -> Result<Option<Environment>, WaypointsError> {
    let refuse = |cause| WaypointsError::Unreadable { path: path.into(), cause };
    match bounds::read_text(path, MOST_BYTES) {
        Err(cause) if cause.kind() == io::ErrorKind::NotFound => Ok(None),
        // Read as a list, its values would be taken for keys in their order.
        text => text
            .and_then(|text| serde_json::from_str::<serde_json::Map<_, _>>(&text).map_err(io::Error::from))
            .and_then(|keys| serde_json::from_value(keys.into()).map_err(io::Error::from))
            .map(Some)
            .map_err(refuse),
    }
}

/// Reads the `.csv` files of a folder, sorted by name, and the environments beside them. A file in degrees is placed
/// by `scenario`, and passed over where the same waypoints lie beside it in metres, as `export` writes both; so are the
/// motions that it writes.
///
/// # Errors
/// As [`read`]; a folder that cannot be read or has no such file; an environment that is none; a world that is nowhere
/// on Earth.
pub fn read_folder(folder: &Path, scenario: &Scenario, farthest: f64) -> Result<Vec<Mission>, WaypointsError> {
    let refuse = |cause| WaypointsError::Unreadable { path: folder.into(), cause };
    let entries = fs::read_dir(folder).map_err(refuse)?;
    let mut paths = entries.map(|entry| entry.map(|e| e.path())).collect::<Result<Vec<_>, _>>().map_err(refuse)?;
    paths.retain(|path| path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("csv")) && !is_motion(path));
    let in_metres = |path: &PathBuf| in_metres(path).is_some_and(|twin| paths.contains(&twin));
    let mut kept: Vec<&PathBuf> = paths.iter().filter(|path| !in_metres(path)).collect();
    kept.sort();
    if kept.is_empty() {
        return Err(WaypointsError::Empty { path: folder.into() });
    }
    let one = |path: &PathBuf| {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let stem = path.file_stem().unwrap_or_default().to_string_lossy();
        let name = name.strip_suffix(geodetic::ENDING).unwrap_or(&stem).to_owned();
        let environment = read_environment(&environment_path(folder, &name))?;
        let (waypoints, rounded) = read(path, scenario, farthest)?;
        Ok(Mission { waypoints, rounded, name, environment })
    };
    kept.into_iter().map(one).collect()
}

/// Whether a file is a motion that `export` wrote: by its name and, as a mission may be called so too, its first column.
fn is_motion(path: &Path) -> bool {
    let named = path.file_name().and_then(|name| name.to_str()).is_some_and(is_of_a_motion);
    let first = |bytes: Vec<u8>| bytes.split(|byte| *byte == b',').next().map(<[u8]>::to_vec);
    named
        && bounds::read_table(path)
            .ok()
            .and_then(first)
            .is_some_and(|column| [&b"t"[..], b"Duration"].contains(&&column[..]))
}

/// The file in metres that a file in degrees may have beside it.
fn in_metres(path: &Path) -> Option<PathBuf> {
    let name = path.file_name()?.to_str()?;
    Some(path.with_file_name(format!("{}.csv", name.strip_suffix(geodetic::ENDING)?)))
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
    let header = Table::of(&text, Cut::COMMAS).names;
    let degrees = header.place(COLUMNS[0]).is_none() && geodetic::PLACE[..2].iter().all(|c| header.place(c).is_some());
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
    let Table { header, names, rows } = Table::of(text, Cut::COMMAS);
    let mut places = [0; 3];
    for (place, column) in places.iter_mut().zip(columns) {
        let missing = || WaypointsError::Header { path: path.into(), column, header: header.into() };
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
