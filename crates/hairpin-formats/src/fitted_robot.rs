//! A robot's file after a fit: the table that it was, with the numbers that logs told, each marked `estimated` twice,
//! for people in a comment and for readers in `[estimated]`.

use serde_json::{Map, Value, json};

/// A number that logs told.
#[derive(Debug, Clone, PartialEq)]
pub struct FittedNumber {
    /// Key of the robot's file.
    pub key: String,
    /// In the key's unit.
    pub value: f64,
    /// 95 %, in the key's unit; `None` for one that was derived and is kept, though the logs do not tell it.
    pub interval: Option<[f64; 2]>,
}

/// A robot file as TOML: `robot`, the table of a resolved scenario, with `numbers` in it. `head` are lines of comment;
/// `from` says what the numbers are estimated from, and `name` is the robot's.
///
/// # Errors
/// A table that TOML cannot hold, in a sentence's part.
pub fn text(
    robot: &Value,
    (name, head, from): (&str, &[String], &str),
    numbers: &[FittedNumber],
) -> Result<String, String> {
    let mut table = robot.as_object().cloned().ok_or("the robot is no table")?;
    let mut estimated = match table.remove("estimated") {
        Some(Value::Object(before)) => before,
        _ => Map::new(),
    };
    table.insert("name".into(), json!(name));
    for number in numbers {
        put(&mut table, &number.key, four_digits(number.value))?;
        let from = if number.interval.is_some() { from } else { "derived, and not told by the logs" };
        let mut entry = Map::from_iter([("from".to_owned(), json!(from))]);
        if let Some(interval) = number.interval {
            entry.insert("interval".into(), json!(interval.map(four_digits)));
        }
        estimated.insert(number.key.clone(), Value::Object(entry));
    }
    table.retain(|_, value| !value.is_null() && value.as_object().is_none_or(|part| !part.is_empty()));
    let mut text: String = head.iter().map(|line| format!("# {line}\n")).collect();
    let rotors = table.remove("rotors");
    for (key, value) in &table {
        text.push_str(&on_a_line(key, value)?);
        let said: Vec<String> = numbers.iter().filter_map(|number| told(key, number, from)).collect();
        if !said.is_empty() {
            text.push_str(&format!("   # estimated: {}", said.join("; ")));
        }
        text.push('\n');
    }
    if let Some(Value::Array(rotors)) = rotors {
        text.push_str("rotors = [\n");
        for rotor in &rotors {
            text.push_str(&format!("  {},\n", inline(rotor)?));
        }
        text.push_str("]\n");
    }
    if !estimated.is_empty() {
        text.push_str("\n[estimated]\n");
        for (key, entry) in &estimated {
            let key = if key.contains(['.', '[']) { format!("\"{key}\"") } else { key.clone() };
            text.push_str(&on_a_line(&key, entry)?);
            text.push('\n');
        }
    }
    Ok(text)
}

/// Puts `value` where a dotted key says: into tables within tables, of which the last may be made, and at the places of
/// lists.
fn put(table: &mut Map<String, Value>, key: &str, value: f64) -> Result<(), String> {
    let nowhere = || format!("`{key}` is no key of the robot");
    match key.split_once('.') {
        Some((outer, inner)) => {
            let inside = table.entry(outer).or_insert_with(|| json!({}));
            put(inside.as_object_mut().ok_or_else(nowhere)?, inner, value)
        }
        None => match key.strip_suffix(']').and_then(|key| key.split_once('[')) {
            Some((list, place)) => {
                let place: usize = place.parse().map_err(|_| nowhere())?;
                *table.get_mut(list).and_then(|list| list.get_mut(place)).ok_or_else(nowhere)? = json!(value);
                Ok(())
            }
            None => {
                table.insert(key.to_owned(), json!(value));
                Ok(())
            }
        },
    }
}

/// What is said of `number` behind the line of the key `key`, if it is in it.
fn told(key: &str, number: &FittedNumber, from: &str) -> Option<String> {
    let inner = number.key.strip_prefix(key)?;
    let named = match inner.strip_prefix('.') {
        Some(inner) => format!("{inner} "),
        None if inner.is_empty() => String::new(),
        None => return None,
    };
    Some(match number.interval.map(|interval| interval.map(four_digits)) {
        Some([low, high]) => format!("{named}{low} to {high} (95 %), from {from}"),
        None => format!("{named}derived, and not told by the logs"),
    })
}

fn on_a_line(key: &str, value: &Value) -> Result<String, String> {
    Ok(format!("{key} = {}", inline(value)?))
}

fn inline(value: &Value) -> Result<String, String> {
    toml::Value::try_from(value).map(|value| value.to_string()).map_err(|error| error.to_string())
}

/// `value` with its first four digits.
pub fn four_digits(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use hairpin::robot::quadrotor::QuadrotorDescription;

    use super::*;

    /// Numbers within tables, and those of lists.
    #[test]
    fn numbers_deep_in_a_file_are_put_there() {
        let before = json!({ "kind": "differential-drive", "name": "x", "track_m": 0.4, "response": {},
            "limits": { "wheel_speed_m_s": 1.0, "wheel_acceleration_m_s2": 1.0 } });
        let number =
            |key: &str, value| FittedNumber { key: key.into(), value, interval: Some([0.9 * value, 1.1 * value]) };
        let told = [number("response.latency_s", 0.2), number("response.turn_scale", 0.9)];
        let written = text(&before, ("mine", &[], "2 logs"), &told).unwrap();
        let after: hairpin::robot::ground::DifferentialDriveDescription = toml::from_str(&written).unwrap();
        let built = after.build().unwrap();
        assert_eq!((built.response.latency, built.response.turn_scale, built.response.speed_scale), (0.2, 0.9, 1.0));
        assert_eq!(after.estimated["response.turn_scale"].interval, Some([0.81, 0.99]));
        assert!(built.estimated.contains(&"response.latency_s"), "{:?}", built.estimated);
        let line =
            "   # estimated: latency_s 0.18 to 0.22 (95 %), from 2 logs; turn_scale 0.81 to 0.99 (95 %), from 2 logs";
        assert!(written.contains(line), "{written}");

        let shipped = crate::library::arms().next().unwrap();
        let arm: hairpin::robot::arm::ArmDescription = toml::from_str(shipped.text).unwrap();
        let mut robot = serde_json::to_value(&arm).unwrap();
        robot["joints"]["lag_s"] = json!(vec![0.02; 6]);
        let written = text(&robot, ("mine", &[], "2 logs"), &[number("joints.lag_s[4]", 0.03)]).unwrap();
        let after: hairpin::robot::arm::ArmDescription = toml::from_str(&written).unwrap();
        assert_eq!(after.joints.lag_s, Some([0.02, 0.02, 0.02, 0.02, 0.03, 0.02]));
        assert!(after.build().unwrap().estimated.contains(&"joints.lag_s[4]".to_owned()));
    }

    #[test]
    fn what_is_written_is_read_again() {
        let shipped = crate::library::quadrotors().find(|robot| robot.name == "anafi-real").unwrap();
        let before: QuadrotorDescription = toml::from_str(shipped.text).unwrap();
        let robot = serde_json::to_value(&before).unwrap();
        let drag =
            FittedNumber { key: "drag_quadratic_n_s2_m2".into(), value: 0.123_456, interval: Some([0.11, 0.13]) };
        let lag = FittedNumber { key: "rotor_time_constant_s".into(), value: 0.03, interval: None };
        let written = text(&robot, ("mine", &["From logs.".to_owned()], "5 logs"), &[drag, lag]).unwrap();
        let after: QuadrotorDescription = toml::from_str(&written).unwrap();
        assert!(written.starts_with("# From logs.\n"), "{written}");
        let line = "drag_quadratic_n_s2_m2 = 0.1235   # estimated: 0.11 to 0.13 (95 %), from 5 logs\n";
        assert!(written.contains(line), "{written}");
        assert_eq!((after.name.as_str(), after.drag_quadratic_n_s2_m2, after.mass_kg), ("mine", Some(0.1235), 0.5));
        assert_eq!((after.rotors.len(), after.rotors[1]), (4, before.rotors[1]));
        assert_eq!(after.estimated["drag_quadratic_n_s2_m2"].interval, Some([0.11, 0.13]));
        assert_eq!(after.estimated["rotor_time_constant_s"].interval, None);
        let built = after.build().unwrap();
        assert!(built.estimated.contains(&"drag_quadratic_n_s2_m2".to_owned()), "{:?}", built.estimated);
    }
}
