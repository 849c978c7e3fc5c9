//! What the columns of a CSV log mean, by their names: hairpin's own, and others' as far as they say it unmistakably.
//!
//! A unit stands behind a name (`x_m`, `x [m]`, `x (mm)`); what has none is refused where it would be needed, for a
//! log of millimetres that is read as metres judges another flight.

use super::super::error::Fault;
use crate::delimited::Row;
use crate::quote;

/// A column that is read: where it is, its name, and what its numbers are multiplied by.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Column {
    pub(super) index: usize,
    pub(super) name: String,
    pub(super) scale: f64,
}

/// The columns of a log, by what they mean.
#[derive(Debug, Default)]
pub(super) struct Columns {
    pub(super) time: Option<Column>,
    pub(super) position: [Option<Column>; 3],
    /// w, x, y, z.
    pub(super) quaternion: [Option<Column>; 4],
    pub(super) yaw: Option<Column>,
    pub(super) velocity: [Option<Column>; 3],
    /// Horizontal, vertical.
    pub(super) accuracy: [Option<Column>; 2],
    pub(super) leg: Option<Column>,
    pub(super) level: Option<Column>,
    /// Joints with their numbers.
    pub(super) joints: Vec<(u32, Column)>,
    /// Names that are not understood.
    pub(super) others: Vec<String>,
}

#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Time,
    Length,
    Speed,
    Angle,
    None,
}

const TIMES: &[(&str, f64)] = &[("s", 1.0), ("sec", 1.0), ("ms", 1e-3), ("us", 1e-6), ("ns", 1e-9)];
const LENGTHS: &[(&str, f64)] = &[("m", 1.0), ("cm", 1e-2), ("mm", 1e-3)];
/// Of other lengths, which are not read: a column of a position in one is no other column.
const OTHER_LENGTHS: &[&str] = &[
    "ft", "feet", "foot", "usft", "us_ft", "in", "inch", "inches", "yd", "yard", "yards", "mi", "miles", "nm", "nmi",
    "km", "dm", "um", "px", "pixel", "pixels",
];
const SPEEDS: &[(&str, f64)] =
    &[("m_s", 1.0), ("m/s", 1.0), ("m s^-1", 1.0), ("mps", 1.0), ("mm_s", 1e-3), ("mm/s", 1e-3)];
const ANGLES: &[(&str, f64)] = &[("rad", 1.0), ("deg", std::f64::consts::PI / 180.0)];

impl Kind {
    fn units(self) -> &'static [(&'static str, f64)] {
        match self {
            Self::Time => TIMES,
            Self::Length => LENGTHS,
            Self::Speed => SPEEDS,
            Self::Angle => ANGLES,
            Self::None => &[],
        }
    }
}

/// A name without its unit, and what is in brackets behind it.
fn in_brackets(name: &str) -> (&str, Option<&str>) {
    for (open, close) in [('[', ']'), ('(', ')')] {
        if let Some((base, unit)) = name.strip_suffix(close).and_then(|name| name.rsplit_once(open)) {
            return (base.trim(), Some(unit.trim()));
        }
    }
    (name, None)
}

/// The scale of the unit that stands behind `base` in a name, if `base` with some unit, or none, is the name.
enum Unit {
    Scale(f64),
    /// The name is this one, and has no unit.
    Untold,
    /// It has one that is not read.
    Unread(String),
    /// Another name.
    Other,
}

fn unit(name: &str, base: &str, kind: Kind) -> Unit {
    let (plain, bracket) = in_brackets(name);
    let plain = plain.replace(['.', ' '], "_");
    let known = |unit: &str| kind.units().iter().find(|(known, _)| *known == unit).map(|(_, scale)| *scale);
    match (plain.strip_prefix(base), bracket) {
        (Some(""), None | Some("")) if kind == Kind::None => Unit::Scale(1.0),
        (Some(""), None) => Unit::Untold,
        (Some(""), Some("")) => Unit::Untold,
        (Some(""), Some(bracket)) => known(bracket).map_or_else(|| Unit::Unread(bracket.into()), Unit::Scale),
        (Some(rest), None) => match rest.strip_prefix('_').map(|unit| (unit, known(unit))) {
            Some((_, Some(scale))) => Unit::Scale(scale),
            Some((unit, None)) if kind == Kind::Length && OTHER_LENGTHS.contains(&unit) => Unit::Unread(unit.into()),
            _ => Unit::Other,
        },
        _ => Unit::Other,
    }
}

const AXES: [&str; 3] = ["x", "y", "z"];

impl Columns {
    /// The columns of a header.
    pub(super) fn of(header: &Row) -> Result<Self, Fault> {
        let mut columns = Self::default();
        let names: Vec<String> =
            header.cells().map(|cell| cell.trim_start_matches('#').trim().to_ascii_lowercase()).collect();
        // EuRoC's ground truth, whose stamps are nanoseconds without saying so.
        let euroc = names.iter().any(|name| name.starts_with("p_rs_r_x"));
        for (index, name) in names.iter().enumerate() {
            let told = quote::cell(header.cell(index));
            let is_time = index == 0 && (name == "t" || euroc && name == "timestamp");
            if is_time {
                let scale = if euroc { 1e-9 } else { 1.0 };
                columns.time = Some(Column { index, name: told, scale });
            } else if !columns.place(index, name, &told)? {
                columns.others.push(told);
            }
        }
        Ok(columns)
    }

    /// Whether a column is understood, and then where it belongs.
    fn place(&mut self, index: usize, name: &str, told: &str) -> Result<bool, Fault> {
        let column = |base: &str, kind: Kind| match unit(name, base, kind) {
            Unit::Scale(scale) => Ok(Some(Column { index, name: told.into(), scale })),
            Unit::Other => Ok(None),
            untold => {
                let units: Vec<_> = kind.units().iter().map(|(unit, _)| format!("`{base}_{unit}`")).collect();
                let units = units.join(", ");
                let what = match untold {
                    Unit::Unread(unit) => format!("`{unit}` is no unit that is read"),
                    _ => "its unit is not in its name".into(),
                };
                Err(Fault::line(1, format!("column `{told}`: {what}, must be one of {units}")))
            }
        };
        let first = |bases: &[String], kind: Kind| {
            for base in bases {
                if let Some(found) = column(base, kind)? {
                    return Ok(Some(found));
                }
            }
            Ok::<_, Fault>(None)
        };
        let of = |patterns: &[&str], axis: &str| -> Vec<String> {
            patterns.iter().map(|pattern| pattern.replace('*', axis)).collect()
        };
        let mut found: Vec<(&mut Option<Column>, Option<Column>)> = Vec::new();
        found.push((&mut self.time, first(&of(&["time", "timestamp", "stamp", "t"], ""), Kind::Time)?));
        for (slot, axis) in self.position.iter_mut().zip(AXES) {
            let names = of(&["*", "p*", "p_*", "pos_*", "position_*", "pose_position_*", "p_rs_r_*"], axis);
            found.push((slot, first(&names, Kind::Length)?));
        }
        for (slot, axis) in self.velocity.iter_mut().zip(AXES) {
            let names = of(&["v*", "v_*", "vel_*", "velocity_*", "v_rs_r_*"], axis);
            found.push((slot, first(&names, Kind::Speed)?));
        }
        for (slot, axis) in self.quaternion.iter_mut().zip(["w", "x", "y", "z"]) {
            let names = of(&["q*", "q_*", "quat_*", "orientation_*", "pose_orientation_*", "q_rs_*"], axis);
            found.push((slot, first(&names, Kind::None)?));
        }
        for (slot, base) in self.accuracy.iter_mut().zip(["eph", "epv"]) {
            found.push((slot, first(&[base.into()], Kind::Length)?));
        }
        found.push((&mut self.yaw, first(&["yaw".into()], Kind::Angle)?));
        found.push((&mut self.leg, first(&["leg".into()], Kind::None)?));
        found.push((&mut self.level, first(&[hairpin::trajectory::ATTITUDE_UNKNOWN.into()], Kind::None)?));
        for (slot, column) in found {
            if let Some(column) = column {
                if let Some(before) = slot {
                    let what = format!("columns `{}` and `{told}` are the same thing twice", before.name);
                    return Err(Fault::line(1, what));
                }
                *slot = Some(column);
                return Ok(true);
            }
        }
        let Some((base, number)) = joint(name) else { return Ok(false) };
        let Some(column) = column(&base, Kind::Angle)? else { return Ok(false) };
        if self.joints.iter().any(|(other, _)| *other == number) {
            return Err(Fault::line(1, format!("column `{told}`: joint {number} twice")));
        }
        self.joints.push((number, column));
        self.joints.sort_by_key(|(number, _)| *number);
        Ok(true)
    }
}

/// `q1`, `joint_1` and the like at the beginning of a name with a unit of angles behind, and the number.
fn joint(name: &str) -> Option<(String, u32)> {
    let (base, bracket) = in_brackets(name);
    let base = if bracket.is_some() { base } else { base.rsplit_once('_').map_or(base, |(base, _)| base) };
    let number = ["joint_", "joint", "j", "q"].iter().find_map(|prefix| base.strip_prefix(prefix))?;
    let told = bracket.is_some() || ANGLES.iter().any(|(unit, _)| name.ends_with(unit));
    let number = number.parse().ok().filter(|_| told)?;
    Some((base.to_owned(), number))
}
