//! Dotted keys: how mistakes, `[vary]` and `--set` name one value of a scenario.

use std::fmt;

use serde_json::{Map, Value};

/// A key such as `world.obstacles[0].box.size_m`, `world.obstacles.0.box.size_m` or `vary."world.wind_m_s"`.
///
/// At least one part. Whether there is such a value in a scenario is asked of the scenario.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct KeyPath {
    segments: Vec<String>,
}

impl KeyPath {
    /// Takes a key apart. `None` where it is none: an empty segment, a bracket without a whole number, an open quote.
    ///
    /// Bare parts are letters, digits, `_` and `-`; anything but `"` stands in quotes. White space around the key is
    /// left out. O(length).
    pub fn parse(key: &str) -> Option<Self> {
        let mut segments = Vec::new();
        let mut rest = key.trim();
        loop {
            let (segment, after) = first_segment(rest)?;
            segments.push(segment);
            rest = after;
            while let Some(inner) = rest.strip_prefix('[') {
                let (index, after) = inner.split_once(']')?;
                let index: usize = index.trim().parse().ok()?;
                segments.push(index.to_string());
                rest = after;
            }
            match rest.strip_prefix('.') {
                Some(after) => rest = after,
                None if rest.is_empty() => return Some(Self { segments }),
                None => return None,
            }
        }
    }

    /// The key with these parts.
    pub fn of(segments: &[&str]) -> Self {
        Self { segments: segments.iter().map(|&segment| segment.to_owned()).collect() }
    }

    /// The parts; an index stands as its digits.
    pub fn segments(&self) -> &[String] {
        &self.segments
    }

    /// The value at this key.
    ///
    /// `None` where there is none, or a part names an element of what is no array.
    pub fn get<'v>(&self, root: &'v Value) -> Option<&'v Value> {
        self.segments.iter().try_fold(root, |value, segment| match value {
            Value::Object(table) => table.get(segment),
            Value::Array(items) => items.get(segment.parse::<usize>().ok()?),
            _ => None,
        })
    }

    /// Puts `new` at this key; tables on the way that are missing are made, arrays are not.
    ///
    /// # Errors
    /// The part of the key (`world.obstacles[3]`) that is no element or lies in something that is no table, and of an
    /// element how many there are.
    pub fn put(&self, root: &mut Value, new: Value) -> Result<(), String> {
        let mut place = root;
        for (depth, segment) in self.segments.iter().enumerate() {
            let part = || format!("`{}`", joined(&self.segments[..=depth]));
            let whole = || joined(&self.segments[..depth]);
            if place.is_null() {
                if is_index(segment) {
                    return Err(format!("{}: there is no `{}` to take an element of", part(), whole()));
                }
                *place = Value::Object(Map::new());
            }
            place = match place {
                Value::Object(table) => table.entry(segment.clone()).or_insert(Value::Null),
                Value::Array(items) => {
                    let count = items.len();
                    let element = segment.parse::<usize>().ok().and_then(|index| items.get_mut(index));
                    let elements = if count == 1 { "1 element" } else { &format!("{count} elements") };
                    element.ok_or_else(|| format!("{}: `{}` has {elements}, counted from 0", part(), whole()))?
                }
                _ => return Err(part()),
            };
        }
        *place = new;
        Ok(())
    }
}

impl fmt::Display for KeyPath {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&joined(&self.segments))
    }
}

/// The first part of `key`, bare or in quotes, and what follows it.
fn first_segment(key: &str) -> Option<(String, &str)> {
    if let Some(quoted) = key.strip_prefix('"') {
        let (segment, after) = quoted.split_once('"')?;
        return (!segment.is_empty()).then(|| (segment.to_owned(), after));
    }
    let end = key.find(['.', '[']).unwrap_or(key.len());
    let bare = &key[..end];
    let valid = !bare.is_empty() && bare.chars().all(|c| c.is_alphanumeric() || c == '_' || c == '-');
    valid.then(|| (bare.to_owned(), &key[end..]))
}

fn is_index(segment: &str) -> bool {
    segment.bytes().all(|b| b.is_ascii_digit())
}

/// Digits are indices but at the beginning; parts with a dot or a bracket are put in quotes.
fn joined(segments: &[String]) -> String {
    let mut key = String::new();
    for segment in segments {
        if !key.is_empty() && is_index(segment) {
            key.push_str(&format!("[{segment}]"));
            continue;
        }
        if !key.is_empty() {
            key.push('.');
        }
        if segment.contains(['.', '[']) { key.push_str(&format!("\"{segment}\"")) } else { key.push_str(segment) }
    }
    key
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn both_ways_to_write_an_index_name_the_same_value() {
        let value = json!({ "world": { "obstacles": [{ "box": { "size_m": [1.0, 2.0, 3.0] } }] } });
        for key in ["world.obstacles[0].box.size_m[2]", "world.obstacles.0.box.size_m.2"] {
            let path = KeyPath::parse(key).unwrap();
            assert_eq!(path.get(&value), Some(&json!(3.0)));
            assert_eq!(path.to_string(), "world.obstacles[0].box.size_m[2]");
        }
        assert_eq!(KeyPath::parse("vary.\"world.wind_m_s\"").unwrap().segments(), ["vary", "world.wind_m_s"]);
        for broken in ["", ".", "a.", "a..b", "a[", "a[x]", "a[1]b", "a b", "\"a", "a[-1]", "\"\""] {
            assert_eq!(KeyPath::parse(broken), None, "{broken}");
        }
    }

    #[test]
    fn put_makes_tables_but_no_elements() {
        let mut value = json!({ "generate": {}, "world": { "obstacles": [] }, "seed": 1 });
        KeyPath::parse("generate.timing.step_s").unwrap().put(&mut value, json!(1.0)).unwrap();
        assert_eq!(value["generate"]["timing"]["step_s"], json!(1.0));
        let element = KeyPath::parse("world.obstacles[0].name").unwrap().put(&mut value, json!("mast"));
        assert_eq!(element, Err("`world.obstacles[0]`: `world.obstacles` has 0 elements, counted from 0".into()));
        let missing = KeyPath::parse("world.wind_m_s[0]").unwrap().put(&mut value, json!(1.0));
        assert_eq!(missing, Err("`world.wind_m_s[0]`: there is no `world.wind_m_s` to take an element of".into()));
        assert_eq!(KeyPath::parse("seed.x").unwrap().put(&mut value, json!(1)), Err("`seed.x`".into()));
    }
}
