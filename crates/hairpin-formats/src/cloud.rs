//! Clouds of points for arms: CSV in mm with orientation and configuration, or the robtargets of a RAPID module.

use std::collections::{HashMap, HashSet};
use std::fmt;

use hairpin::trajectory::program::{NO_EXTERNAL, PoseTarget};
use nalgebra::{Isometry3, Point3, Quaternion, Translation3, UnitQuaternion};
use thiserror::Error;

use crate::decimal::decimal;
use crate::delimited::{Cut, Row, Table};
use crate::quote;

/// A point of a cloud.
#[derive(Debug, Clone, PartialEq)]
pub struct CloudPoint {
    /// Line of the file, from 1.
    pub line: usize,
    /// Name of a robtarget.
    pub name: Option<String>,
    /// Position, m, in the frame that the scenario names.
    pub position: Point3<f64>,
    /// Orientation of the tool; the scenario's default where the file says none.
    pub orientation: Option<UnitQuaternion<f64>>,
    /// \[cf1, cf4, cf6, cfx\]
    pub configuration: Option<[i32; 4]>,
}

/// Which way a cloud's size is off.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Suspicion {
    /// As if metres had been given.
    Small,
    /// As if something finer than millimetres had been given.
    Large,
}

/// Why a file is no cloud.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum CloudError {
    /// The header has no such column.
    #[error(
        "line 1: no column `{column}` in the header `{header}`; needed: x_mm,y_mm,z_mm[,q1,q2,q3,q4[,cf1,cf4,cf6,cfx]]"
    )]
    Header {
        /// The missing column.
        column: &'static str,
        /// The header found.
        header: String,
    },
    /// A column twice: nobody knows which is meant.
    #[error("line 1: column `{column}` twice")]
    Twice {
        /// The column.
        column: String,
    },
    /// Orientations under other names.
    #[error(
        "line 1: column `{column}`: orientations are read from q1,q2,q3,q4 (a unit quaternion, scalar first) alone; \
         write them as these, or take the column out"
    )]
    Orientation {
        /// The column found.
        column: String,
    },
    /// A row is longer or shorter than the header.
    #[error("line {line}: {found} values, the header has {expected}")]
    Width {
        /// Line, from 1.
        line: usize,
        /// Values in the row.
        found: usize,
        /// Columns of the header.
        expected: usize,
    },
    /// A cell is no number, or out of its bound.
    #[error("line {line}, column `{column}`: `{value}`: must be {bound}")]
    Value {
        /// Line, from 1.
        line: usize,
        /// Column.
        column: &'static str,
        /// The text found.
        value: String,
        /// What it must be.
        bound: &'static str,
    },
    /// Four numbers that are no rotation.
    #[error("line {line}: q1,q2,q3,q4 = {value:?} of length {length:.6}: must be 1 within {UNIT}")]
    Quaternion {
        /// Line, from 1.
        line: usize,
        /// The numbers.
        value: [f64; 4],
        /// Their length.
        length: f64,
    },
    /// A robtarget that is none.
    #[error("line {line}: robtarget `{name}` {why}")]
    Target {
        /// Line, from 1.
        line: usize,
        /// Its name.
        name: String,
        /// Why.
        why: String,
    },
    /// The same pose twice.
    #[error("line {line}: the point of line {first} again")]
    Repeated {
        /// Line, from 1.
        line: usize,
        /// Line of the first.
        first: usize,
    },
    /// Nothing in it.
    #[error("no points in it")]
    Empty,
    /// More than can be taken.
    #[error("line {line}: more than {MOST} points")]
    TooMany {
        /// Line, from 1.
        line: usize,
    },
    /// A size that no cell has.
    #[error("the points lie within {} mm: {}", decimal(*extent_mm, 6), question(*suspicion))]
    Extent {
        /// Longest edge of the box around all points, mm.
        extent_mm: f64,
        /// Which way it is off.
        suspicion: Suspicion,
    },
}

impl CloudError {
    /// The line that it is on, from 1; `None` of what is wrong with all of it.
    pub fn line(&self) -> Option<usize> {
        match self {
            Self::Header { .. } | Self::Twice { .. } | Self::Orientation { .. } => Some(1),
            Self::Width { line, .. }
            | Self::Value { line, .. }
            | Self::Quaternion { line, .. }
            | Self::Target { line, .. }
            | Self::Repeated { line, .. }
            | Self::TooMany { line } => Some(*line),
            Self::Empty | Self::Extent { .. } => None,
        }
    }
}

fn question(suspicion: Suspicion) -> impl fmt::Display {
    match suspicion {
        Suspicion::Small => "less than 5 mm; are they in m?",
        Suspicion::Large => "more than 50 m; are they in another unit?",
    }
}

/// Lengths of quaternions in CSV may be this far from 1: some write four decimals.
const UNIT: f64 = 1e-3;
/// Points at most; graphs of that many are as many squared.
const MOST: usize = 100_000;
const SMALLEST_MM: f64 = 5.0;
const LARGEST_MM: f64 = 50_000.0;
const COLUMNS: [&str; 11] = ["x_mm", "y_mm", "z_mm", "q1", "q2", "q3", "q4", "cf1", "cf4", "cf6", "cfx"];

/// The points of a CSV. Columns may stand in any order and others beside them; blank lines count and are skipped; a row
/// without any of q1 … q4, or of cf1 … cfx, says nothing about them.
///
/// # Errors
/// The first thing wrong, with its line. Sizes are asked about by [`check_extent`].
pub fn parse(text: &str) -> Result<Vec<CloudPoint>, CloudError> {
    let Table { header, names, rows } = Table::of(text, Cut::told_by(text));
    let place = |column: &str| names.place(column);
    let refuse = |column| CloudError::Header { column, header: header.into() };
    let mut known = HashSet::new();
    if let Some(column) = names.cells().find(|name| !name.is_empty() && !known.insert(name.to_ascii_lowercase())) {
        return Err(CloudError::Twice { column: quote::cell(column) });
    }
    let mut places = [None; COLUMNS.len()];
    for (index, column) in COLUMNS.into_iter().enumerate() {
        places[index] = place(column);
        // A group is there as a whole or not at all.
        let group = if index < 3 {
            0..3
        } else if index < 7 {
            3..7
        } else {
            7..11
        };
        let wanted = index < 3 || COLUMNS[group].iter().any(|other| place(other).is_some());
        if wanted && places[index].is_none() {
            return Err(refuse(column));
        }
    }
    if let Some(column) = names.cells().find(|name| places[3].is_none() && is_orientation(name)) {
        return Err(CloudError::Orientation { column: quote::cell(column) });
    }
    let mut points = Points::default();
    for row in rows {
        if row.len() != names.len() {
            return Err(CloudError::Width { line: row.line, found: row.len(), expected: names.len() });
        }
        points.push(PointRow { line: row.line, row, places: &places }.point()?)?;
    }
    points.done()
}

/// Whether a column is called as orientations are elsewhere: `qw`, `rx_deg`, `yaw`.
fn is_orientation(column: &str) -> bool {
    const NAMES: [&str; 11] = ["q0", "qw", "qx", "qy", "qz", "rx", "ry", "rz", "roll", "pitch", "yaw"];
    let name = column.to_ascii_lowercase();
    let stem = ["_deg", "_rad"].iter().find_map(|unit| name.strip_suffix(unit)).unwrap_or(&name);
    NAMES.contains(&stem)
}

/// The robtargets of a module, in the order of their declaration, by line, name and target.
///
/// # Errors
/// A robtarget that is none; as [`parse`].
pub fn from_targets<'a>(
    targets: impl IntoIterator<Item = (usize, &'a str, Result<&'a PoseTarget, &'a str>)>,
) -> Result<Vec<CloudPoint>, CloudError> {
    let mut points = Points::default();
    for (line, name, target) in targets {
        let refuse = |why: &str| CloudError::Target { line, name: name.into(), why: why.into() };
        let target = target.map_err(refuse)?;
        if target.external != NO_EXTERNAL {
            return Err(refuse("uses external axes, which are not modelled (9E9 is not in use)"));
        }
        points.push(CloudPoint {
            line,
            name: Some(name.into()),
            position: target.pose.translation.vector.into(),
            orientation: Some(target.pose.rotation),
            configuration: target.configuration,
        })?;
    }
    points.done()
}

/// Asks about clouds that are smaller than 5 mm or larger than 50 m: they are in another unit more often than not. One
/// point alone has no size.
///
/// # Errors
/// [`CloudError::Extent`].
pub fn check_extent(points: &[CloudPoint]) -> Result<(), CloudError> {
    let bounds = |axis: usize| {
        let values = points.iter().map(|point| point.position[axis]);
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)))
    };
    let extent_mm = (0..3).map(bounds).fold(0.0, |most: f64, (low, high)| most.max((high - low) * 1000.0));
    let suspicion = if extent_mm > LARGEST_MM {
        Suspicion::Large
    } else if extent_mm < SMALLEST_MM && points.len() > 1 {
        Suspicion::Small
    } else {
        return Ok(());
    };
    Err(CloudError::Extent { extent_mm, suspicion })
}

impl CloudPoint {
    /// The point as a target; `default` where it has no orientation.
    pub fn target(&self, default: UnitQuaternion<f64>) -> PoseTarget {
        let turn = self.orientation.unwrap_or(default);
        PoseTarget {
            name: self.name.clone(),
            pose: Isometry3::from_parts(Translation3::from(self.position), turn),
            configuration: self.configuration,
            external: NO_EXTERNAL,
        }
    }
}

/// Points so far, each pose once.
#[derive(Default)]
struct Points {
    all: Vec<CloudPoint>,
    seen: HashMap<[u64; 7], usize>,
}

impl Points {
    fn push(&mut self, point: CloudPoint) -> Result<(), CloudError> {
        if self.all.len() == MOST {
            return Err(CloudError::TooMany { line: point.line });
        }
        let (p, q) = (point.position, point.orientation.map_or([0.0; 4], |q| [q.w, q.i, q.j, q.k]));
        // Adding zero makes −0 the 0 that it equals.
        let key = [p.x, p.y, p.z, q[0], q[1], q[2], q[3]].map(|x| (x + 0.0).to_bits());
        if let Some(first) = self.seen.insert(key, point.line) {
            return Err(CloudError::Repeated { line: point.line, first });
        }
        self.all.push(point);
        Ok(())
    }

    fn done(self) -> Result<Vec<CloudPoint>, CloudError> {
        if self.all.is_empty() { Err(CloudError::Empty) } else { Ok(self.all) }
    }
}

struct PointRow<'a> {
    line: usize,
    row: Row,
    places: &'a [Option<usize>; COLUMNS.len()],
}

impl PointRow<'_> {
    fn point(&self) -> Result<CloudPoint, CloudError> {
        let mut position = Point3::origin();
        for axis in 0..3 {
            position[axis] = self.number(axis, 1e9, "a finite number in mm, 1e9 at most either way")? / 1000.0;
        }
        Ok(CloudPoint {
            line: self.line,
            name: None,
            position,
            orientation: self.orientation()?,
            configuration: self.configuration()?,
        })
    }

    fn orientation(&self) -> Result<Option<UnitQuaternion<f64>>, CloudError> {
        if self.says_nothing(3..7) {
            return Ok(None);
        }
        let mut value = [0.0; 4];
        for (index, component) in value.iter_mut().enumerate() {
            *component = self.number(3 + index, 1e9, "a finite number, 1e9 at most either way")?;
        }
        let quaternion = Quaternion::new(value[0], value[1], value[2], value[3]);
        let length = quaternion.norm();
        if (length - 1.0).abs() > UNIT {
            return Err(CloudError::Quaternion { line: self.line, value, length });
        }
        Ok(Some(UnitQuaternion::new_normalize(quaternion)))
    }

    fn configuration(&self) -> Result<Option<[i32; 4]>, CloudError> {
        if self.says_nothing(7..11) {
            return Ok(None);
        }
        let mut value = [0; 4];
        for (index, number) in value.iter_mut().enumerate() {
            let (text, column) = (self.text(7 + index), COLUMNS[7 + index]);
            let (bounds, bound) =
                if index == 3 { (0..=7, "from 0 to 7") } else { (-32..=31, "a whole number from -32 to 31") };
            let parsed = text.parse::<i32>().ok().filter(|number| bounds.contains(number));
            *number =
                parsed.ok_or_else(|| CloudError::Value { line: self.line, column, value: quote::cell(text), bound })?;
        }
        Ok(Some(value))
    }

    fn text(&self, column: usize) -> &str {
        self.places[column].map_or("", |place| self.row.cell(place))
    }

    fn says_nothing(&self, columns: std::ops::Range<usize>) -> bool {
        columns.into_iter().all(|column| self.text(column).is_empty())
    }

    fn number(&self, column: usize, largest: f64, bound: &'static str) -> Result<f64, CloudError> {
        let (text, name) = (self.text(column), COLUMNS[column]);
        let number = text.parse::<f64>().ok().filter(|number| number.abs() <= largest);
        number.ok_or_else(|| CloudError::Value { line: self.line, column: name, value: quote::cell(text), bound })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{listing, rapid};

    #[test]
    fn points_orientations_and_configurations_are_read() {
        let text = "\u{feff}x_mm,y_mm,z_mm,q1,q2,q3,q4,cf1,cf4,cf6,cfx,note\n\
                    300,-50.5,400,0,0.6,0,0.8,-1,0,1,4,a\n\n300,-50.5,401,,,,,,,,,b\n300,0,0,0.7071,0,0.7071,0,,,,,c\n";
        let points = parse(text).unwrap();
        assert_eq!(points.iter().map(|p| p.line).collect::<Vec<_>>(), [2, 4, 5]);
        assert_eq!(points[0].position, Point3::new(0.3, -0.0505, 0.4));
        let q = points[0].orientation.unwrap();
        assert_eq!([q.w, q.i, q.j, q.k], [0.0, 0.6, 0.0, 0.8]);
        assert_eq!((points[0].configuration, points[1].configuration), (Some([-1, 0, 1, 4]), None));
        assert_eq!(points[1].orientation, None);
        assert!((points[2].orientation.unwrap().norm() - 1.0).abs() < 1e-15);
        let down = UnitQuaternion::new_unchecked(Quaternion::new(0.0, 0.0, 1.0, 0.0));
        assert_eq!(points[1].target(down).pose.rotation, down);
        assert_eq!(points[0].target(down).pose.rotation, q);
        let shuffled = parse("z_mm,x_mm,y_mm\n3,1,2\n").unwrap();
        assert_eq!(shuffled[0].position, Point3::new(0.001, 0.002, 0.003));
    }

    #[test]
    fn mistakes_are_told_by_line() {
        for (text, words) in [
            ("", "line 1: no column `x_mm`"),
            ("x_m,y_m,z_m\n1,2,3\n", "no column `x_mm`"),
            ("x_mm,y_mm,z_mm,q1,q2,q3\n1,2,3,1,0,0\n", "no column `q4`"),
            ("x_mm,y_mm,z_mm,cfx\n1,2,3,1\n", "no column `cf1`"),
            ("x_mm,y_mm,z_mm,qw,qx,qy,qz\n1,2,3,1,0,0,0\n", "line 1: column `qw`: orientations are read from q1"),
            ("x_mm,y_mm,z_mm,Rx_deg\n1,2,3,90\n", "line 1: column `Rx_deg`"),
            ("x_mm,y_mm,z_mm\n", "no points"),
            ("x_mm,y_mm,z_mm\n1,2\n", "line 2: 2 values, the header has 3"),
            ("x_mm,y_mm,z_mm\n1,2,3\n1,NaN,3\n", "line 3, column `y_mm`: `NaN`"),
            ("x_mm,y_mm,z_mm\n1,2,3\n1,,3\n", "line 3, column `y_mm`: ``"),
            ("x_mm,y_mm,z_mm,q1,q2,q3,q4\n1,2,3,1,0,0.2,0\n", "of length 1.019804: must be 1"),
            ("x_mm,y_mm,z_mm,q1,q2,q3,q4\n1,2,3,1,,0,0\n", "line 2, column `q2`"),
            ("x_mm,y_mm,z_mm,cf1,cf4,cf6,cfx\n1,2,3,0,0,0,8\n", "column `cfx`: `8`: must be from 0 to 7"),
            ("x_mm,y_mm,z_mm\n1,0,3\n4,5,6\n1,-0,3\n", "line 4: the point of line 2 again"),
        ] {
            let error = parse(text).unwrap_err().to_string();
            assert!(error.contains(words), "{error}");
        }
    }

    #[test]
    fn cells_may_stand_between_commas_semicolons_or_tabs() {
        let table = "x_mm,y_mm,z_mm\n300,0,300\n0,-20.5,9\n";
        for delimiter in [";", "\t"] {
            assert_eq!(parse(&table.replace(',', delimiter)).unwrap(), parse(table).unwrap(), "{delimiter:?}");
        }
    }

    #[test]
    fn sizes_that_no_cell_has_are_asked_about() {
        let cloud = |a: &str, b: &str| parse(&format!("x_mm,y_mm,z_mm\n{a},0,0\n{b},0,0\n")).unwrap();
        assert!(check_extent(&cloud("0", "5")).is_ok() && check_extent(&cloud("0", "50000")).is_ok());
        let error = check_extent(&cloud("0.3", "0.5")).unwrap_err();
        assert!(
            matches!(error, CloudError::Extent { suspicion: Suspicion::Small, .. })
                && error.to_string().contains("in m?")
        );
        let error = check_extent(&cloud("300", "300.01")).unwrap_err().to_string();
        assert!(error.starts_with("the points lie within 0.01 mm: "), "{error}");
        let error = check_extent(&cloud("0", "50001")).unwrap_err();
        assert!(matches!(error, CloudError::Extent { suspicion: Suspicion::Large, .. }));
        assert!(check_extent(&cloud("0.3", "0.5")[..1]).is_ok(), "one point has no size");
    }

    #[test]
    fn robtargets_are_a_cloud() {
        let module = |second: &str| {
            let end = "[0,0,0,1],[9E9,9E9,9E9,9E9,9E9,9E9]];";
            let text = format!(
                "MODULE M\nCONST robtarget p1:=[[300,0,400],[0,0,1,0],{end}\nCONST robtarget p2:=[[300,9,400],{second},{end}\nENDMODULE"
            );
            rapid::read(text.as_bytes(), &rapid::Options::default()).unwrap()
        };
        let read = |module: &listing::Module| {
            from_targets(
                module.targets.iter().map(|t| (t.line, t.name.as_str(), t.target.as_ref().map_err(String::as_str))),
            )
        };
        let points = read(&module("[1,0,0,0]")).unwrap();
        assert_eq!((points[1].name.as_deref(), points[1].line), (Some("p2"), 3));
        assert_eq!(points[1].position, Point3::new(0.3, 0.009, 0.4));
        let error = read(&module("[1,0,1,0]")).unwrap_err().to_string();
        assert!(error.starts_with("line 3: robtarget `p2` has the quaternion [1.0, 0.0, 1.0, 0.0]"), "{error}");
    }
}
