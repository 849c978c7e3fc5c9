//! Data that every controller has, as values: they stand wherever a value may.

use hairpin::trajectory::program::{Speed, Zone};

use super::kinds::DataKind;
use super::value::Value;

/// The value of predefined data; `name` in lower case.
pub(super) fn value(name: &str) -> Option<Value> {
    if let Some(speed) = Speed::predefined(name) {
        // vmax has no number: it stays infinite, and what is computed from it is not known.
        let numbers = [
            speed.tcp * 1000.0,
            speed.orientation.to_degrees(),
            speed.linear_external * 1000.0,
            speed.rotating_external.to_degrees(),
        ];
        return Some(Value::numbers(DataKind::SpeedData, &numbers.map(tidy)));
    }
    if let Some(zone) = Zone::predefined(name) {
        let numbers = [
            zone.tcp * 1000.0,
            zone.path_orientation * 1000.0,
            zone.path_external * 1000.0,
            zone.orientation.to_degrees(),
            zone.linear_external * 1000.0,
            zone.rotating_external.to_degrees(),
        ];
        let numbers = numbers.map(|number| Value::Num(tidy(number)));
        let parts = std::iter::once(Value::Bool(zone.fine)).chain(numbers).collect();
        return Some(Value::Record { kind: Some(DataKind::ZoneData), parts });
    }
    Some(match name {
        "tool0" => record(DataKind::ToolData, vec![Value::Bool(true), identity(), load0()]),
        "wobj0" => record(
            DataKind::WobjData,
            vec![Value::Bool(false), Value::Bool(true), Value::Text(String::new()), identity(), identity()],
        ),
        "load0" => load0(),
        "pi" => Value::Num(std::f64::consts::PI),
        _ => external_speed(name)?,
    })
}

/// `vrot1` … `vrot100` and `vlin10` … `vlin1000`, of external axes alone.
fn external_speed(name: &str) -> Option<Value> {
    let of = |digits: &str, known: &[u32]| {
        known.iter().find(|speed| speed.to_string() == digits).map(|speed| f64::from(*speed))
    };
    let numbers = if let Some(digits) = name.strip_prefix("vrot") {
        [0.0, 0.0, 0.0, of(digits, &[1, 2, 5, 10, 20, 50, 100])?]
    } else {
        [0.0, 0.0, of(name.strip_prefix("vlin")?, &[10, 20, 50, 100, 200, 500, 1000])?, 0.0]
    };
    Some(Value::numbers(DataKind::SpeedData, &numbers))
}

/// Steps out of SI and back leave no trace in the last digits: 200, not 200.00000000000003.
fn tidy(number: f64) -> f64 {
    if number.is_finite() { (number * 1e9).round() / 1e9 } else { number }
}

fn record(kind: DataKind, parts: Vec<Value>) -> Value {
    Value::Record { kind: Some(kind), parts }
}

fn identity() -> Value {
    let orient = Value::numbers(DataKind::Orient, &[1.0, 0.0, 0.0, 0.0]);
    record(DataKind::Pose, vec![Value::numbers(DataKind::Pos, &[0.0; 3]), orient])
}

fn load0() -> Value {
    let centre = Value::numbers(DataKind::Pos, &[0.0, 0.0, 0.001]);
    let axes = Value::numbers(DataKind::Orient, &[1.0, 0.0, 0.0, 0.0]);
    let inertia = [0.0; 3].map(Value::Num);
    record(DataKind::LoadData, [Value::Num(0.001), centre, axes].into_iter().chain(inertia).collect())
}
