//! In which keys two scenarios differ.

use hairpin::campaign::Scenario;
use serde_json::Value;

/// The dotted keys in which two scenarios differ, in the order of the first one's.
pub fn differences(a: &Scenario, b: &Scenario) -> Vec<String> {
    let value = |scenario| serde_json::to_value(scenario).unwrap_or_default();
    let mut found = Vec::new();
    differ("", &value(a), &value(b), &mut found);
    found
}

fn differ(key: &str, a: &Value, b: &Value, found: &mut Vec<String>) {
    match (a.as_object(), b.as_object()) {
        (Some(a), Some(b)) => {
            let null = Value::Null;
            for name in a.keys().chain(b.keys().filter(|key| !a.contains_key(*key))) {
                let dotted = if key.is_empty() { name.to_owned() } else { format!("{key}.{name}") };
                differ(&dotted, a.get(name).unwrap_or(&null), b.get(name).unwrap_or(&null), found);
            }
        }
        _ if a != b => found.push(key.to_owned()),
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use hairpin_formats::scenario::setup_for;

    use super::*;

    #[test]
    fn keys_are_told_with_their_tables() {
        let scenario = |sets: &[(&str, &str)]| {
            let sets: Vec<_> = sets.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect();
            setup_for("demo-quadrotor", &sets).unwrap().scenario
        };
        let (a, b) = (scenario(&[]), scenario(&[("seed", "77"), ("execute.repeat", "9")]));
        assert_eq!(differences(&a, &a), Vec::<String>::new());
        assert_eq!(differences(&a, &b), ["seed", "execute.repeat"]);
    }
}
