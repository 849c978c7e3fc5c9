//! Values while a program is executed, and the data of robots made of them.

use hairpin::trajectory::program::{External, JointTarget, PoseTarget, Speed, Tool, WorkObject, Zone, unit_quaternion};
use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};

use super::kinds::DataKind;

/// A value; `Unknown` is one that depends on what happens in the cell.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Value {
    Unknown,
    /// A `num`, single on a controller: whatever is computed or compared is rounded then ([`single`]).
    Num(f64),
    /// A `dnum`.
    Double(f64),
    Bool(bool),
    Text(String),
    /// A record, or an aggregate that has no kind yet.
    Record {
        kind: Option<DataKind>,
        parts: Vec<Value>,
    },
    Array(Vec<Value>),
}

/// A variable, constant or persistent.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Variable {
    /// As it was declared.
    pub(super) name: String,
    /// `None`: a kind that is not followed.
    pub(super) kind: Option<DataKind>,
    pub(super) value: Value,
    /// Whether it holds what it was declared with.
    pub(super) untouched: bool,
    /// Why no program that assigns to it is loaded, in words that follow its name.
    pub(super) fixed: Option<&'static str>,
    /// Whether an interrupt may change it at any time: what it holds is never known.
    pub(super) volatile: bool,
}

impl Variable {
    /// One that nothing is known of but its kind.
    pub(super) fn unknown(name: &str, kind: Option<DataKind>) -> Self {
        Self { name: name.into(), kind, value: Value::Unknown, untouched: false, fixed: None, volatile: false }
    }
}

/// Why a value is not what it should be, in words that follow a name.
pub(super) type Unfit = String;

/// External axes from here on are not in use (9E9).
const NOT_IN_USE: f64 = 8.9e9;

impl Value {
    /// What a variable of the kind holds before anything is assigned.
    pub(super) fn initial(kind: DataKind) -> Self {
        match kind {
            DataKind::Num => Self::Num(0.0),
            DataKind::Dnum => Self::Double(0.0),
            DataKind::Bool => Self::Bool(false),
            DataKind::Text => Self::Text(String::new()),
            record => Self::Record {
                kind: Some(record),
                parts: record.components().iter().map(|(_, part)| Self::initial(*part)).collect(),
            },
        }
    }

    /// A record of numbers.
    pub(super) fn numbers(kind: DataKind, numbers: &[f64]) -> Self {
        Self::Record { kind: Some(kind), parts: numbers.iter().map(|number| Self::Num(*number)).collect() }
    }

    /// The same value as one of `kind`: aggregates get it, anything else must have it.
    pub(super) fn into_kind(self, kind: DataKind) -> Result<Self, Unfit> {
        let expected = kind.components();
        match (self, kind) {
            (Self::Unknown, _) => Ok(Self::Unknown),
            // Literals are of either kind.
            (Self::Num(value) | Self::Double(value), DataKind::Num) => Ok(Self::Num(value)),
            (Self::Num(value) | Self::Double(value), DataKind::Dnum) => Ok(Self::Double(value)),
            (value @ Self::Bool(_), DataKind::Bool) | (value @ Self::Text(_), DataKind::Text) => Ok(value),
            (Self::Record { kind: own, parts }, _) if own == Some(kind) => Ok(Self::Record { kind: own, parts }),
            (Self::Record { kind: None, parts }, _) if !expected.is_empty() && parts.len() == expected.len() => {
                let parts = parts.into_iter().zip(expected).map(|(part, (_, kind))| part.into_kind(*kind));
                Ok(Self::Record { kind: Some(kind), parts: parts.collect::<Result<_, _>>()? })
            }
            (Self::Record { kind: None, parts }, _) if !expected.is_empty() => {
                Err(format!("has {} components, a {} has {}", parts.len(), kind.name(), expected.len()))
            }
            _ => Err(format!("is no {}", kind.name())),
        }
    }

    /// The same value for a variable of `kind` with the extents `extents`.
    pub(super) fn into_declared(self, kind: DataKind, extents: &[usize]) -> Result<Self, Unfit> {
        let Some((count, inner)) = extents.split_first() else { return self.into_kind(kind) };
        match self {
            Self::Unknown => Ok(Self::Unknown),
            Self::Array(parts) | Self::Record { kind: None, parts } if parts.len() == *count => {
                let parts = parts.into_iter().map(|part| part.into_declared(kind, inner));
                Ok(Self::Array(parts.collect::<Result<_, _>>()?))
            }
            Self::Array(parts) | Self::Record { kind: None, parts } => {
                Err(format!("has {} elements, must have {count}", parts.len()))
            }
            _ => Err("is no array".into()),
        }
    }

    pub(super) fn number(&self) -> Option<f64> {
        if let Self::Num(value) | Self::Double(value) = self { Some(*value) } else { None }
    }

    pub(super) fn truth(&self) -> Option<bool> {
        if let Self::Bool(value) = self { Some(*value) } else { None }
    }

    pub(super) fn parts(&self) -> &[Self] {
        if let Self::Record { parts, .. } | Self::Array(parts) = self { parts } else { &[] }
    }

    /// Whether both are equal, whatever kind an aggregate has yet; `None` where that is not known.
    pub(super) fn same(&self, other: &Self) -> Option<bool> {
        match (self, other) {
            (Self::Num(a), Self::Num(b)) => Some(single(*a) == single(*b)),
            (Self::Num(a) | Self::Double(a), Self::Num(b) | Self::Double(b)) => Some(a == b),
            (Self::Bool(a), Self::Bool(b)) => Some(a == b),
            (Self::Text(a), Self::Text(b)) => Some(a == b),
            (Self::Record { parts: a, .. }, Self::Record { parts: b, .. }) | (Self::Array(a), Self::Array(b))
                if a.len() == b.len() =>
            {
                // One pair that differs decides alone.
                a.iter()
                    .zip(b)
                    .map(|(a, b)| a.same(b))
                    .try_fold(Some(true), |all, same| match same {
                        Some(false) => Err(Some(false)),
                        None => Ok(None),
                        Some(true) => Ok(all),
                    })
                    .unwrap_or_else(|decided| decided)
            }
            _ => None,
        }
    }

    /// Its component of that name (lower case).
    pub(super) fn component(&mut self, name: &str) -> Option<&mut Self> {
        let Self::Record { kind: Some(kind), parts } = self else { return None };
        let place = kind.components().iter().position(|(known, _)| *known == name)?;
        parts.get_mut(place)
    }

    /// How many values it is made of.
    pub(super) fn size(&self) -> usize {
        1 + self.parts().iter().map(Self::size).sum::<usize>()
    }

    /// All its numbers in order; `None` where one is not known.
    fn all<const N: usize>(&self) -> Result<[f64; N], Unfit> {
        let numbers: Option<Vec<f64>> = self.parts().iter().map(Self::number).collect();
        numbers.and_then(|all| all.try_into().ok()).ok_or_else(|| UNKNOWN.into())
    }
}

/// The `num` nearest to it: IEEE 754 single precision.
pub(super) fn single(value: f64) -> f64 {
    f64::from(value as f32)
}

const UNKNOWN: &str = "is not known from this file";

/// The part at `place` of a record.
fn part(value: &Value, place: usize) -> Result<&Value, Unfit> {
    value.parts().get(place).ok_or_else(|| UNKNOWN.into())
}

fn number(value: &Value, place: usize) -> Result<f64, Unfit> {
    part(value, place)?.number().ok_or_else(|| UNKNOWN.into())
}

fn truth(value: &Value, place: usize) -> Result<bool, Unfit> {
    part(value, place)?.truth().ok_or_else(|| UNKNOWN.into())
}

/// A `pos`, mm, in m.
fn position(value: &Value) -> Result<Vector3<f64>, Unfit> {
    Ok(Vector3::from(value.all::<3>()?) / 1000.0)
}

fn rotation(value: &Value) -> Result<UnitQuaternion<f64>, Unfit> {
    let components = value.all::<4>()?;
    unit_quaternion(components).map_err(|square| {
        format!("has the quaternion {components:?} with square {square:.6}: must be 1 within 0.00001")
    })
}

/// A `pose` in m.
pub(super) fn pose(value: &Value) -> Result<Isometry3<f64>, Unfit> {
    let (shift, turn) = (position(part(value, 0)?)?, rotation(part(value, 1)?)?);
    Ok(Isometry3::from_parts(Translation3::from(shift), turn))
}

fn external(value: &Value) -> Result<External, Unfit> {
    Ok(value.all::<6>()?.map(|axis| (axis < NOT_IN_USE).then_some(axis)))
}

/// A `robtarget`.
pub(super) fn pose_target(value: &Value, name: Option<&str>) -> Result<PoseTarget, Unfit> {
    let configuration = part(value, 2)?.all::<4>()?;
    let whole = configuration.iter().all(|cf| cf.abs() < 1e3 && cf.fract() == 0.0);
    Ok(PoseTarget {
        name: name.map(Into::into),
        pose: pose(value)?,
        configuration: whole.then(|| configuration.map(|cf| cf as i32)),
        external: external(part(value, 3)?)?,
    })
}

/// A `jointtarget`.
pub(super) fn joint_target(value: &Value, name: Option<&str>) -> Result<JointTarget, Unfit> {
    let degrees = part(value, 0)?.all::<6>()?;
    if degrees.iter().any(|angle| *angle >= NOT_IN_USE) {
        return Err("leaves an axis where it is (9E9)".into());
    }
    Ok(JointTarget {
        name: name.map(Into::into),
        joints: degrees.map(f64::to_radians),
        external: external(part(value, 1)?)?,
    })
}

/// A `speeddata`; with the predefined name where it is one by name.
pub(super) fn speed(value: &Value, name: Option<&str>) -> Result<Speed, Unfit> {
    let [tcp, orientation, linear, rotating] = value.all::<4>()?;
    Ok(Speed {
        name: name.map(Into::into),
        tcp: tcp / 1000.0,
        orientation: orientation.to_radians(),
        linear_external: linear / 1000.0,
        rotating_external: rotating.to_radians(),
    })
}

/// A `zonedata`.
pub(super) fn zone(value: &Value, name: Option<&str>) -> Result<Zone, Unfit> {
    Ok(Zone {
        name: name.map(Into::into),
        fine: truth(value, 0)?,
        tcp: number(value, 1)? / 1000.0,
        path_orientation: number(value, 2)? / 1000.0,
        path_external: number(value, 3)? / 1000.0,
        orientation: number(value, 4)?.to_radians(),
        linear_external: number(value, 5)? / 1000.0,
        rotating_external: number(value, 6)?.to_radians(),
    })
}

/// A `tooldata`.
pub(super) fn tool(value: &Value, name: &str) -> Result<Tool, Unfit> {
    let load = part(value, 2)?;
    Ok(Tool {
        name: name.into(),
        declare: true,
        held: truth(value, 0)?,
        tcp: pose(part(value, 1)?)?,
        mass: number(load, 0)?,
        centre_of_gravity: position(part(load, 1)?)?,
        axes_of_inertia: rotation(part(load, 2)?)?,
        inertia: [number(load, 3)?, number(load, 4)?, number(load, 5)?],
    })
}

/// A `wobjdata`.
pub(super) fn work_object(value: &Value, name: &str) -> Result<WorkObject, Unfit> {
    let unit = match part(value, 2)? {
        Value::Text(unit) => unit.clone(),
        _ => return Err(UNKNOWN.into()),
    };
    Ok(WorkObject {
        name: name.into(),
        declare: true,
        held: truth(value, 0)?,
        moved_by: if truth(value, 1)? { None } else { Some(unit) },
        user: pose(part(value, 3)?)?,
        object: pose(part(value, 4)?)?,
    })
}
