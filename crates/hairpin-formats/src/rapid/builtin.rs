//! Functions that every controller has, as far as positions are made with them. Angles are in degrees.

use hairpin::math::rotation::{euler_from_quaternion, quaternion_from_euler};
use hairpin::trajectory::program::unit_quaternion;
use nalgebra::{Quaternion, UnitQuaternion, Vector3};

use super::kinds::DataKind;
use super::value::{Value, pose, single};

/// Evaluated arguments of a function.
pub(super) struct Arguments {
    pub(super) placed: Vec<Value>,
    /// Names in lower case; a switch is TRUE.
    pub(super) named: Vec<(String, Value)>,
}

impl Arguments {
    fn number(&self, place: usize) -> Option<f64> {
        self.placed.get(place)?.number()
    }

    fn numbers<const N: usize>(&self, from: usize) -> Option<[f64; N]> {
        let all: Option<Vec<f64>> = (from..from + N).map(|place| self.number(place)).collect();
        all?.try_into().ok()
    }

    fn named(&self, name: &str) -> Option<&Value> {
        self.named.iter().find(|(known, _)| known == name).map(|(_, value)| value)
    }

    /// A named number; 0 where it is not given, `None` where it is not known.
    fn optional(&self, name: &str) -> Option<f64> {
        self.named(name).map_or(Some(0.0), Value::number)
    }

    fn record(&self, place: usize, kind: DataKind) -> Option<Value> {
        self.placed.get(place)?.clone().into_kind(kind).ok().filter(|value| *value != Value::Unknown)
    }
}

/// Whether the name (lower case) is a function of ABB's that is computed here.
pub(super) fn is_known(name: &str) -> bool {
    NAMES.contains(&name)
}

const NAMES: [&str; 26] = [
    "abs",
    "acos",
    "asin",
    "atan",
    "atan2",
    "cos",
    "dim",
    "distance",
    "dotprod",
    "eulerzyx",
    "exp",
    "norient",
    "offs",
    "orientzyx",
    "poseinv",
    "posemult",
    "posevect",
    "pow",
    "reltool",
    "round",
    "sin",
    "sqrt",
    "tan",
    "trunc",
    "vectmagn",
    "strlen",
];

/// The function's value; `Unknown` where an argument is unknown or unfit, or the function is not computed here.
pub(super) fn call(name: &str, arguments: &Arguments) -> Value {
    let value = match name {
        "offs" => offs(arguments),
        "reltool" => rel_tool(arguments),
        "orientzyx" => arguments.numbers::<3>(0).map(|[z, y, x]| {
            let [x, y, z] = [x, y, z].map(f64::to_radians);
            Value::numbers(DataKind::Orient, &quaternion_from_euler(x, y, z))
        }),
        "eulerzyx" => euler_zyx(arguments),
        "norient" => arguments.record(0, DataKind::Orient).and_then(|value| {
            let turn = UnitQuaternion::try_new(quaternion(&value)?, 1e-9)?;
            Some(Value::numbers(DataKind::Orient, &[turn.w, turn.i, turn.j, turn.k]))
        }),
        "posemult" | "poseinv" | "posevect" => poses(name, arguments),
        "dotprod" | "distance" | "vectmagn" => vectors(name, arguments),
        "dim" => dim(arguments),
        "strlen" => match arguments.placed.first() {
            Some(Value::Text(text)) => Some(Value::Num(text.chars().count() as f64)),
            _ => None,
        },
        _ => scalar(name, arguments).filter(|value| value.is_finite()).map(Value::Num),
    };
    value.unwrap_or(Value::Unknown)
}

fn scalar(name: &str, arguments: &Arguments) -> Option<f64> {
    let a = single(arguments.number(0)?);
    Some(match name {
        "abs" => a.abs(),
        "sqrt" => a.sqrt(),
        "exp" => libm::exp(a),
        "sin" => libm::sin(a.to_radians()),
        "cos" => libm::cos(a.to_radians()),
        "tan" => libm::tan(a.to_radians()),
        "asin" => libm::asin(a).to_degrees(),
        "acos" => libm::acos(a).to_degrees(),
        "atan" => libm::atan(a).to_degrees(),
        "atan2" => libm::atan2(a, arguments.number(1)?).to_degrees(),
        "pow" => libm::pow(a, arguments.number(1)?),
        "round" | "trunc" => {
            let scale = libm::pow(10.0, arguments.optional("dec")?);
            let scaled = a * scale;
            (if name == "round" { scaled.round() } else { scaled.trunc() }) / scale
        }
        _ => return None,
    })
}

/// `Offs(p, x, y, z)`: moved in the work object.
fn offs(arguments: &Arguments) -> Option<Value> {
    let mut target = arguments.record(0, DataKind::RobTarget)?;
    let by = arguments.numbers::<3>(1)?;
    shift(&mut target, &Vector3::from(by))?;
    Some(target)
}

/// `RelTool(p, x, y, z \Rx \Ry \Rz)`: moved in the tool, then turned about its x, its new y and its new z.
fn rel_tool(arguments: &Arguments) -> Option<Value> {
    let mut target = arguments.record(0, DataKind::RobTarget)?;
    let by = Vector3::from(arguments.numbers::<3>(1)?);
    let turn = quaternion(target.component("rot")?)?;
    let turn = unit_quaternion([turn.w, turn.i, turn.j, turn.k]).ok()?;
    shift(&mut target, &(turn * by))?;
    let mut turned = turn.into_inner();
    for (axis, name) in [Vector3::x(), Vector3::y(), Vector3::z()].iter().zip(["rx", "ry", "rz"]) {
        let (sin, cos) = libm::sincos(0.5 * arguments.optional(name)?.to_radians());
        turned *= Quaternion::from_parts(cos, axis * sin);
    }
    *target.component("rot")? = Value::numbers(DataKind::Orient, &[turned.w, turned.i, turned.j, turned.k]);
    Some(target)
}

/// Moves a robtarget by mm.
fn shift(target: &mut Value, by: &Vector3<f64>) -> Option<()> {
    let place = target.component("trans")?;
    for (name, by) in ["x", "y", "z"].into_iter().zip(by.iter()) {
        let coordinate = place.component(name)?;
        let from = coordinate.number()?;
        // Left where it is, it stays as it is written.
        *coordinate = Value::Num(if *by == 0.0 { from } else { single(single(from) + single(*by)) });
    }
    Some(())
}

fn quaternion(orient: &Value) -> Option<Quaternion<f64>> {
    let all: Option<Vec<f64>> = orient.parts().iter().map(Value::number).collect();
    let [w, x, y, z]: [f64; 4] = all?.try_into().ok()?;
    Some(Quaternion::new(w, x, y, z))
}

fn euler_zyx(arguments: &Arguments) -> Option<Value> {
    let turn = quaternion(&arguments.record(0, DataKind::Orient)?)?;
    let turn = unit_quaternion([turn.w, turn.i, turn.j, turn.k]).ok()?;
    let [x, y, z] = euler_from_quaternion(&[turn.w, turn.i, turn.j, turn.k]);
    let asked = ["x", "y", "z"].into_iter().zip([x, y, z]).find(|(name, _)| arguments.named(name).is_some());
    asked.map(|(_, angle)| Value::Num(angle.to_degrees()))
}

fn poses(name: &str, arguments: &Arguments) -> Option<Value> {
    let first = pose(&arguments.record(0, DataKind::Pose)?).ok()?;
    let result = match name {
        "poseinv" => first.inverse(),
        "posemult" => first * pose(&arguments.record(1, DataKind::Pose)?).ok()?,
        _ => {
            let point = vector(&arguments.record(1, DataKind::Pos)?)? / 1000.0;
            let moved = first.transform_point(&point.into()) * 1000.0;
            return Some(Value::numbers(DataKind::Pos, moved.coords.as_slice()));
        }
    };
    let (p, q) = (result.translation.vector * 1000.0, result.rotation);
    let parts =
        vec![Value::numbers(DataKind::Pos, p.as_slice()), Value::numbers(DataKind::Orient, &[q.w, q.i, q.j, q.k])];
    Some(Value::Record { kind: Some(DataKind::Pose), parts })
}

fn vector(pos: &Value) -> Option<Vector3<f64>> {
    let all: Option<Vec<f64>> = pos.parts().iter().map(Value::number).collect();
    Some(Vector3::from(<[f64; 3]>::try_from(all?).ok()?))
}

fn vectors(name: &str, arguments: &Arguments) -> Option<Value> {
    let first = vector(&arguments.record(0, DataKind::Pos)?)?;
    if name == "vectmagn" {
        return Some(Value::Num(first.norm()));
    }
    let second = vector(&arguments.record(1, DataKind::Pos)?)?;
    Some(Value::Num(if name == "dotprod" { first.dot(&second) } else { (first - second).norm() }))
}

/// `Dim(array, n)`: elements in its n-th dimension.
fn dim(arguments: &Arguments) -> Option<Value> {
    let wanted = arguments.number(1)?;
    let mut value = arguments.placed.first()?;
    for _ in 1..wanted.clamp(1.0, 4.0) as usize {
        value = value.parts().first()?;
    }
    matches!(value, Value::Array(_)).then(|| Value::Num(value.parts().len() as f64))
}
