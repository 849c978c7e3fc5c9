//! Recordings of arms as CSV, whoever wrote them: columns by name, units by name, decimal points or commas.

use std::io;
use std::path::{Path, PathBuf};

use hairpin::campaign::bounds::SHORTEST_STEP_S;
use hairpin::math::rotation::{quaternion_from_euler, rotation_vector, unit_quaternion};
use hairpin::robot::arm::{AXES, Arm, Joints};
use hairpin::trajectory::{Channel, Track, TrackError};
use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};
use thiserror::Error;

use crate::bounds;
use crate::delimited::{Cut, Row as Cells, Table};
use crate::quote;

/// Farther from the base no arm's tool is, m.
const FARTHEST_M: f64 = 100.0;
/// More than a hundred turns is another unit, rad.
const MOST_RAD: f64 = 700.0;
/// How far from 1 the length of a quaternion may be: logs round to three decimals.
const QUATERNION: f64 = 1e-2;

/// So far a place that is told may be from where the joints put the tool, m: the arm's file has the dimensions of its
/// type, and those of each arm are some millimetres off.
const OFF_M: f64 = 5e-3;
/// The same of orientations, rad.
const TURNED: f64 = 2.0 * std::f64::consts::PI / 180.0;

/// A recording as it was read.
#[derive(Debug, Clone, PartialEq)]
pub struct ControllerLog {
    /// `base_from_tcp` over time, with `move` and `q1_rad` … `q6_rad` where the file has them.
    pub track: Track,
    /// Whether the file tells orientations; where not, they are the identity and nothing is to be made of them.
    pub orientation_known: bool,
    /// Whether poses were computed from joint angles.
    pub from_joints: bool,
    /// The line of the last sample.
    pub last_line: usize,
    /// Its columns of joints; `None` without.
    pub joints: Option<JointColumns>,
}

/// Which columns of a file are joints, by their names in lower case.
#[derive(Debug, Clone, PartialEq)]
pub struct JointColumns {
    /// Axes 1 to 6.
    pub axes: [String; AXES],
    /// The same in the order in which the file has them.
    pub order: Vec<String>,
    /// What is called as joints are and is none of the six: `q7_rad`.
    pub others: Vec<String>,
}

/// Why a file is no recording. Lines count from 1.
#[derive(Debug, Error)]
pub enum ControllerLogError {
    /// The file cannot be read.
    #[error("cannot read {}: {cause}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// The system's answer.
        cause: io::Error,
    },
    /// The header lacks what is needed.
    #[error("{}, line 1: {what}; the header is `{header}`", path.display())]
    Header {
        /// The file.
        path: PathBuf,
        /// What is missing or given twice.
        what: String,
        /// The header.
        header: String,
    },
    /// A cell is not the number it must be.
    #[error("{}, line {line}, column `{column}`: `{value}`: must be {bound}", path.display())]
    Value {
        /// The file.
        path: PathBuf,
        /// Line.
        line: usize,
        /// Column.
        column: String,
        /// The text found.
        value: String,
        /// What it must be.
        bound: String,
    },
    /// A row is longer or shorter than the header.
    #[error("{}, line {line}: {found} values, the header has {expected}", path.display())]
    Width {
        /// The file.
        path: PathBuf,
        /// Line.
        line: usize,
        /// Values in the row.
        found: usize,
        /// Columns of the header.
        expected: usize,
    },
    /// Fewer than two samples.
    #[error("{}: {found} samples, must be at least 2", path.display())]
    Short {
        /// The file.
        path: PathBuf,
        /// Samples found.
        found: usize,
    },
    /// The place that it tells is not where its joints put the tool.
    #[error(
        "{}, line {line}: the tool is told {off_mm:.1} mm and {turned_deg:.1}° from where the joints of the same line put it \
         ({allowed_mm:.1} mm and {allowed_deg:.1}° are allowed, with what it moves from line to line): joints in another unit \
         or order, places of another tool or in another frame; take out the columns that are wrong",
        path.display()
    )]
    Contradiction {
        /// The file.
        path: PathBuf,
        /// Line.
        line: usize,
        /// How far both are apart, mm.
        off_mm: f64,
        /// By how much they are turned against each other, degrees; 0 where orientations are not told.
        turned_deg: f64,
        /// What may be, mm.
        allowed_mm: f64,
        /// What may be, degrees.
        allowed_deg: f64,
    },
    /// What a track refuses.
    #[error("{}: {cause}", path.display())]
    Track {
        /// The file.
        path: PathBuf,
        /// Its reason.
        cause: TrackError,
    },
}

/// A column that is read: where it is, its name, and what its numbers are multiplied by.
#[derive(Debug, Clone)]
struct Column {
    index: usize,
    name: String,
    scale: f64,
}

#[derive(Debug, Clone)]
enum Turn {
    /// w, x, y, z.
    Quaternion([Column; 4]),
    /// About x, y, z: R = Rz Ry Rx.
    Euler([Column; 3]),
    Unknown,
}

struct Layout {
    time: Column,
    /// Without it poses come from joints.
    position: Option<[Column; 3]>,
    turn: Turn,
    joints: Option<[Column; AXES]>,
    /// Of joints that are none of the six.
    others: Vec<String>,
    order: Option<Column>,
    width: usize,
    /// Whether a comma is a decimal point.
    comma: bool,
}

const SECONDS: &[(&str, f64)] = &[("_s", 1.0), ("_ms", 1e-3), ("_us", 1e-6), ("_ns", 1e-9)];
const METRES: &[(&str, f64)] = &[("_m", 1.0), ("_mm", 1e-3)];
const RADIANS: &[(&str, f64)] = &[("_rad", 1.0), ("_deg", std::f64::consts::PI / 180.0)];
/// What joints are called before their number.
const JOINTS: &[&str] = &["q", "j", "joint", "joint_", "axis", "axis_"];

/// Reads a recording. Columns stand in any order, others beside them; names in any case:
///
/// | what | names |
/// | --- | --- |
/// | time | `t` (s), `t_s`, `time_s`, `…_ms`, `…_us`, `…_ns` |
/// | position | `x_m`, `y_m`, `z_m`, or `x_mm`, `y_mm`, `z_mm` |
/// | orientation | `qw` … `qz`; `q1` … `q4` (w first); or `rx_deg`, `ry_deg`, `rz_deg` (or `_rad`; R = Rz Ry Rx) |
/// | joints | `q1_rad` … `q6_rad`, or `j`, `joint`, `joint_`, `axis` for `q`, or `_deg` |
/// | move | `move`, from 0 |
///
/// Cells are separated by commas, tabs, or semicolons, and with the latter two a decimal comma is understood. Without
/// positions the joints go through `arm`: base_from_tcp = base_from_flange(q) · flange_from_tcp. Stamps are taken as
/// they are, however far apart. With both, each row's place must be where its joints put the tool.
///
/// # Errors
/// The first thing wrong, with line, column and value; stamps that do not rise; fewer than two samples.
pub fn read(path: &Path, arm: Option<(&Arm, &Isometry3<f64>)>) -> Result<ControllerLog, ControllerLogError> {
    let bytes =
        bounds::read_table(path).map_err(|cause| ControllerLogError::Unreadable { path: path.into(), cause })?;
    // Bytes that are no UTF-8 stay visible in the message of the cell that they stand in.
    parse(path, &String::from_utf8_lossy(&bytes), arm)
}

/// Whether the first line of `path` has the columns of a recording of an arm, its joints or its tool's places.
pub fn is_headed(path: &Path) -> bool {
    bounds::read_table(path).is_ok_and(|bytes| {
        let text = String::from_utf8_lossy(&bytes);
        let (names, comma) = headed(&text);
        Layout::of(&names, comma, true).is_ok()
    })
}

/// The names of columns, and whether a comma is a decimal point.
fn headed(text: &str) -> (Cells, bool) {
    let delimiter = delimiter(text);
    (Table::of(text, Cut { delimiter, ..Cut::COMMAS }).names, delimiter != b',')
}

/// Where cells are separated by semicolons or tabs a comma is a decimal point.
fn delimiter(text: &str) -> u8 {
    let first = text.lines().next().unwrap_or_default();
    [b';', b'\t'].into_iter().find(|separator| first.as_bytes().contains(separator)).unwrap_or(b',')
}

fn parse(path: &Path, text: &str, arm: Option<(&Arm, &Isometry3<f64>)>) -> Result<ControllerLog, ControllerLogError> {
    let delimiter = delimiter(text);
    let Table { header, names, rows: lines } = Table::of(text, Cut { delimiter, ..Cut::COMMAS });
    let layout = Layout::of(&names, delimiter != b',', arm.is_some()).map_err(|what| ControllerLogError::Header {
        path: path.into(),
        what,
        header: header.into(),
    })?;
    let (times, poses, joints, moves, lines_of) = Default::default();
    let mut rows = Rows { path, layout: &layout, times, poses, joints, moves, lines: lines_of };
    for cells in lines {
        rows.push(&cells, arm)?;
    }
    if let Some(arm) = arm {
        rows.agree(arm)?;
    }
    let Rows { times, poses, joints, moves, lines, .. } = rows;
    let last_line = lines.last().copied().unwrap_or(1);
    if times.len() < 2 {
        return Err(ControllerLogError::Short { path: path.into(), found: times.len() });
    }
    let mut channels = Vec::new();
    if layout.order.is_some() {
        channels.push(Channel { name: "move".into(), values: moves });
    }
    if layout.joints.is_some() {
        channels.extend(joint_channels(&joints));
    }
    let track = Track::new(times, poses, channels);
    let track = track.map_err(|cause| ControllerLogError::Track { path: path.into(), cause })?;
    let from_joints = layout.position.is_none();
    let orientation_known = from_joints || !matches!(layout.turn, Turn::Unknown);
    Ok(ControllerLog { track, orientation_known, from_joints, last_line, joints: JointColumns::of(&layout) })
}

/// A recording of joints (rad, by the arm's axes) at `times` (s); `path` is what refusals name.
///
/// # Errors
/// Stamps that do not rise; fewer than two samples.
pub fn of_joints(
    path: &Path,
    times: Vec<f64>,
    joints: &[Joints],
    arm: (&Arm, &Isometry3<f64>),
) -> Result<ControllerLog, ControllerLogError> {
    if times.len() < 2 {
        return Err(ControllerLogError::Short { path: path.into(), found: times.len() });
    }
    let poses = joints.iter().map(|joints| pose(joints, arm)).collect();
    let track = Track::new(times, poses, joint_channels(joints).collect());
    let track = track.map_err(|cause| ControllerLogError::Track { path: path.into(), cause })?;
    Ok(ControllerLog { track, orientation_known: true, from_joints: true, last_line: 0, joints: None })
}

/// base_from_tcp.
fn pose(joints: &Joints, (arm, tcp): (&Arm, &Isometry3<f64>)) -> Isometry3<f64> {
    arm.forward(joints) * tcp
}

fn joint_channels(joints: &[Joints]) -> impl Iterator<Item = Channel> {
    (0..AXES).map(|k| Channel { name: format!("q{}_rad", k + 1), values: joints.iter().map(|q| q[k]).collect() })
}

impl Layout {
    fn of(names: &Cells, comma: bool, arm: bool) -> Result<Self, String> {
        let names: Vec<String> = names.cells().map(str::to_ascii_lowercase).collect();
        for (index, name) in names.iter().enumerate() {
            if !name.is_empty() && names[..index].contains(name) {
                return Err(format!("column `{name}` twice"));
            }
        }
        let exactly = |name: &str, scale: f64| {
            let index = names.iter().position(|found| found == name)?;
            Some(Column { index, name: name.into(), scale })
        };
        let one = |stems: &[String], units: &[(&str, f64)]| {
            let all =
                stems.iter().flat_map(|stem| units.iter().map(move |(unit, scale)| (format!("{stem}{unit}"), *scale)));
            let mut found: Vec<Column> = all.filter_map(|(name, scale)| exactly(&name, scale)).collect();
            if found.len() > 1 {
                return Err(format!("`{}` and `{}` say the same", found[0].name, found[1].name));
            }
            Ok(found.pop())
        };
        let stems = |names: &[&str]| -> Vec<String> { names.iter().map(|name| (*name).to_owned()).collect() };
        let time = one(&stems(&["t", "time"]), SECONDS)?.or_else(|| exactly("t", 1.0));
        let time = time.ok_or("no column of times, such as `t_s` or `time_ms`")?;
        let position = triple(|axis| one(&stems(&[axis]), METRES))?;
        let axis = |k: usize| {
            let stems: Vec<String> = JOINTS.iter().map(|stem| format!("{stem}{k}")).collect();
            one(&stems, RADIANS)
        };
        let joints: Vec<Column> = (1..=AXES).map(axis).filter_map(Result::transpose).collect::<Result<_, _>>()?;
        let is_other = |name: &&String| is_joint(name) && joints.iter().all(|own| own.name != **name);
        let others = names.iter().filter(is_other).cloned().collect();
        let joints = match joints.len() {
            0 => None,
            AXES => joints.try_into().ok(),
            some => return Err(format!("{some} joints: six or none")),
        };
        let quaternion = [["qw", "qx", "qy", "qz"], ["q1", "q2", "q3", "q4"]].into_iter().find_map(|names| {
            let found: Vec<Column> = names.into_iter().filter_map(|name| exactly(name, 1.0)).collect();
            found.try_into().ok()
        });
        let turn = match quaternion {
            Some(quaternion) => Turn::Quaternion(quaternion),
            None => triple(|axis| one(&stems(&[&format!("r{axis}")]), RADIANS))?.map_or(Turn::Unknown, Turn::Euler),
        };
        match (&position, &joints) {
            (Some(_), _) => {}
            (None, Some(_)) if arm => {}
            (None, Some(_)) => return Err("joints without positions need an arm".into()),
            (None, None) => return Err("no `x_m`, `y_m`, `z_m` (or `_mm`), and no six joints such as `q1_deg`".into()),
        }
        Ok(Self { time, position, turn, joints, others, order: exactly("move", 1.0), width: names.len(), comma })
    }
}

/// Whether a column is called as a joint of any number is.
fn is_joint(name: &str) -> bool {
    let Some(stem) = RADIANS.iter().find_map(|(unit, _)| name.strip_suffix(unit)) else { return false };
    let is_number = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    JOINTS.iter().filter_map(|word| stem.strip_prefix(word)).any(is_number)
}

impl JointColumns {
    fn of(layout: &Layout) -> Option<Self> {
        let columns = layout.joints.as_ref()?;
        let mut order: Vec<&Column> = columns.iter().collect();
        order.sort_unstable_by_key(|column| column.index);
        Some(Self {
            axes: columns.each_ref().map(|column| column.name.clone()),
            order: order.into_iter().map(|column| column.name.clone()).collect(),
            others: layout.others.clone(),
        })
    }
}

/// Columns of x, y and z: all three or none.
fn triple(one: impl Fn(&str) -> Result<Option<Column>, String>) -> Result<Option<[Column; 3]>, String> {
    match (one("x")?, one("y")?, one("z")?) {
        (Some(x), Some(y), Some(z)) => Ok(Some([x, y, z])),
        (None, None, None) => Ok(None),
        (x, y, z) => {
            let found: Vec<String> = [x, y, z].into_iter().flatten().map(|column| column.name).collect();
            Err(format!("only `{}` of three coordinates", found.join("`, `")))
        }
    }
}

struct Rows<'a> {
    path: &'a Path,
    layout: &'a Layout,
    times: Vec<f64>,
    poses: Vec<Isometry3<f64>>,
    joints: Vec<Joints>,
    moves: Vec<f64>,
    /// Of each.
    lines: Vec<usize>,
}

impl Rows<'_> {
    /// That poses which are told stand where the joints of their rows put the tool: the worst row that does not.
    ///
    /// Both may be of moments up to a row apart, so as much is allowed as the tool moves from row to row.
    fn agree(&self, arm: (&Arm, &Isometry3<f64>)) -> Result<(), ControllerLogError> {
        let layout = self.layout;
        if layout.position.is_none() || layout.joints.is_none() {
            return Ok(());
        }
        let is_turned = !matches!(layout.turn, Turn::Unknown);
        let put: Vec<Isometry3<f64>> = self.joints.iter().map(|joints| pose(joints, arm)).collect();
        let apart = |a: &Isometry3<f64>, b: &Isometry3<f64>| {
            let turned = if is_turned { rotation_vector(&(a.rotation.inverse() * b.rotation)).norm() } else { 0.0 };
            [(a.translation.vector - b.translation.vector).norm(), turned]
        };
        // By the joints and by the places: one of both may stand still.
        let steps: Vec<[f64; 2]> = (1..put.len())
            .map(|i| {
                let [told, by_joints] = [&self.poses, &put].map(|all| apart(&all[i - 1], &all[i]));
                [told[0].max(by_joints[0]), told[1].max(by_joints[1])]
            })
            .collect();
        let row = |i: usize| {
            let off = apart(&self.poses[i], &put[i]);
            let beside = steps[i.saturating_sub(1)..(i + 1).min(steps.len())].iter();
            let allowed = beside
                .fold([OFF_M, TURNED], |most, step| [most[0].max(OFF_M + step[0]), most[1].max(TURNED + step[1])]);
            (i, off, allowed, (off[0] / allowed[0]).max(off[1] / allowed[1]))
        };
        let worst = (0..put.len()).map(row).reduce(|worst, one| if one.3 > worst.3 { one } else { worst });
        match worst {
            Some((i, off, allowed, times)) if times > 1.0 => Err(ControllerLogError::Contradiction {
                path: self.path.into(),
                line: self.lines[i],
                off_mm: 1e3 * off[0],
                turned_deg: off[1].to_degrees(),
                allowed_mm: 1e3 * allowed[0],
                allowed_deg: allowed[1].to_degrees(),
            }),
            _ => Ok(()),
        }
    }

    fn push(&mut self, cells: &Cells, arm: Option<(&Arm, &Isometry3<f64>)>) -> Result<(), ControllerLogError> {
        let layout = self.layout;
        if cells.len() != layout.width {
            return Err(ControllerLogError::Width {
                path: self.path.into(),
                line: cells.line,
                found: cells.len(),
                expected: layout.width,
            });
        }
        let row = Row { path: self.path, cells, comma: layout.comma };
        let time = row.number(&layout.time, f64::INFINITY, "finite")?;
        if let Some(before) = self.times.last()
            && time <= *before
        {
            return Err(row.error(&layout.time, format!("later than {before} s, the row before")));
        }
        if let Some(before) = self.times.last()
            && time - before < SHORTEST_STEP_S
        {
            let bound = format!("at least {SHORTEST_STEP_S:e} s after {before} s, the row before");
            return Err(row.error(&layout.time, bound));
        }
        let joints = match &layout.joints {
            Some(columns) => Some(row.numbers(columns, MOST_RAD, "an angle within a hundred turns")?),
            None => None,
        };
        let pose = match (&layout.position, &joints, arm) {
            (Some(position), ..) => {
                let place = row.numbers(position, FARTHEST_M, "a finite number, within 100 m")?;
                Isometry3::from_parts(Translation3::from(Vector3::from(place)), row.rotation(&layout.turn)?)
            }
            (None, Some(joints), Some(arm)) => pose(joints, arm),
            (None, ..) => unreachable!("a layout without positions has joints and an arm"),
        };
        if let Some(column) = &layout.order {
            let order = row.number(column, 1e9, "a move's number, from 0")?;
            if order < 0.0 || order.fract() != 0.0 {
                return Err(row.error(column, "a move's number, from 0".into()));
            }
            self.moves.push(order);
        }
        self.lines.push(cells.line);
        self.times.push(time);
        self.poses.push(pose);
        self.joints.extend(joints);
        Ok(())
    }
}

struct Row<'a> {
    path: &'a Path,
    cells: &'a Cells,
    /// Whether a comma is a decimal point.
    comma: bool,
}

impl Row<'_> {
    fn error(&self, column: &Column, bound: String) -> ControllerLogError {
        ControllerLogError::Value {
            path: self.path.into(),
            line: self.cells.line,
            column: column.name.clone(),
            value: quote::cell(self.cells.cell(column.index)),
            bound,
        }
    }

    fn number(&self, column: &Column, most: f64, bound: &str) -> Result<f64, ControllerLogError> {
        let cell = self.cells.cell(column.index);
        let parsed = if self.comma && !cell.contains('.') { cell.replacen(',', ".", 1).parse() } else { cell.parse() };
        let number = parsed.ok().map(|number: f64| number * column.scale);
        let number = number.filter(|number| number.is_finite() && number.abs() <= most);
        number.ok_or_else(|| self.error(column, bound.into()))
    }

    fn numbers<const N: usize>(
        &self,
        columns: &[Column; N],
        most: f64,
        bound: &str,
    ) -> Result<[f64; N], ControllerLogError> {
        let mut numbers = [0.0; N];
        for (number, column) in numbers.iter_mut().zip(columns) {
            *number = self.number(column, most, bound)?;
        }
        Ok(numbers)
    }

    fn rotation(&self, turn: &Turn) -> Result<UnitQuaternion<f64>, ControllerLogError> {
        match turn {
            Turn::Unknown => Ok(UnitQuaternion::identity()),
            Turn::Quaternion(columns) => {
                let wxyz = self.numbers(columns, 2.0, "a component of a unit quaternion")?;
                let length = wxyz.iter().map(|c| c * c).sum::<f64>().sqrt();
                if (length - 1.0).abs() > QUATERNION {
                    return Err(self.error(&columns[0], format!("of a quaternion of length 1, not {length:.4}")));
                }
                Ok(unit_quaternion(&wxyz))
            }
            Turn::Euler(columns) => {
                let [x, y, z] = self.numbers(columns, MOST_RAD, "an angle within a hundred turns")?;
                Ok(unit_quaternion(&quaternion_from_euler(x, y, z)))
            }
        }
    }
}

#[cfg(test)]
mod tests;
