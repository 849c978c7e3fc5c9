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
        table.insert(number.key.clone(), json!(four_digits(number.value)));
        let from = if number.interval.is_some() { from } else { "derived, and not told by the logs" };
        let mut entry = Map::from_iter([("from".to_owned(), json!(from))]);
        if let Some(interval) = number.interval {
            entry.insert("interval".into(), json!(interval.map(four_digits)));
        }
        estimated.insert(number.key.clone(), Value::Object(entry));
    }
    table.retain(|_, value| !value.is_null());
    let mut text: String = head.iter().map(|line| format!("# {line}\n")).collect();
    let rotors = table.remove("rotors");
    for (key, value) in &table {
        text.push_str(&on_a_line(key, value)?);
        if let Some(number) = numbers.iter().find(|number| number.key == *key) {
            let said = match number.interval.map(|interval| interval.map(four_digits)) {
                Some([low, high]) => format!("   # estimated: {low} to {high} (95 %), from {from}"),
                None => "   # estimated: derived, and not told by the logs".to_owned(),
            };
            text.push_str(&said);
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
            text.push_str(&on_a_line(key, entry)?);
            text.push('\n');
        }
    }
    Ok(text)
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
