//! Values drawn for `[vary]` as columns `vary:KEY`, arrays elementwise as `vary:KEY[0]`, `vary:KEY[1]`, …; of an array
//! one element that is drawn alone is `vary:KEY.1`, which is not read back as an array of one.

use std::sync::Arc;

use arrow_array::{ArrayRef, BooleanArray, Float64Array, Int64Array, StringArray};
use serde_json::{Number, Value};

use super::table::{Columns, Table, TableError};

/// The drawn values of one row: key and value.
pub(super) type Drawn = Vec<(String, Value)>;

const PREFIX: &str = "vary:";

/// The columns' names and values for `drawn`: scalars as they are, arrays of scalars elementwise, all else as JSON
/// text.
pub fn flatten(drawn: &[(String, Value)]) -> Vec<(String, Value)> {
    let mut flat = Vec::new();
    for (key, value) in drawn {
        match value {
            Value::Array(items) if !items.is_empty() && items.iter().all(is_scalar) => {
                flat.extend(items.iter().enumerate().map(|(i, item)| (format!("{PREFIX}{key}[{i}]"), item.clone())));
            }
            _ if is_scalar(value) => flat.push((format!("{PREFIX}{}", dotted(key)), value.clone())),
            _ => flat.push((format!("{PREFIX}{key}"), Value::String(value.to_string()))),
        }
    }
    flat
}

/// Appends one column per drawn key of any row, in the order of first appearance.
pub(super) fn push(columns: &mut Columns, rows: &[&[(String, Value)]]) {
    let flat: Vec<Drawn> = rows.iter().map(|drawn| flatten(drawn)).collect();
    let mut names: Vec<&str> = Vec::new();
    for (name, _) in flat.iter().flatten() {
        if !names.contains(&name.as_str()) {
            names.push(name);
        }
    }
    for name in names {
        let values: Vec<Option<&Value>> =
            flat.iter().map(|row| row.iter().find(|(key, _)| key == name).map(|(_, value)| value)).collect();
        columns.push(name, column(&values));
    }
}

/// The drawn values of every row.
pub(super) fn read(table: &Table) -> Result<Vec<Drawn>, TableError> {
    let mut rows: Vec<Drawn> = vec![Vec::new(); table.rows()];
    for name in table.names().iter().filter(|name| name.starts_with(PREFIX)) {
        let name_of = &name[PREFIX.len()..];
        let (key, index) = split(name_of);
        let alone = bracketed(name_of);
        for (row, value) in rows.iter_mut().zip(cells(table, name)?) {
            match (value, index) {
                (None, _) => {}
                (Some(value), None) => row.push((alone.clone(), value)),
                (Some(value), Some(_)) => match row.iter_mut().find(|(known, _)| known == key) {
                    Some((_, Value::Array(items))) => items.push(value),
                    _ => row.push((key.into(), Value::Array(vec![value]))),
                },
            }
        }
    }
    Ok(rows)
}

fn is_scalar(value: &Value) -> bool {
    matches!(value, Value::Number(_) | Value::String(_) | Value::Bool(_))
}

fn column(values: &[Option<&Value>]) -> ArrayRef {
    let all = |test: &dyn Fn(&Value) -> bool| values.iter().flatten().all(|value| test(value));
    if all(&|value| value.is_i64()) {
        Arc::new(values.iter().map(|value| value.and_then(Value::as_i64)).collect::<Int64Array>())
    } else if all(&Value::is_number) {
        Arc::new(values.iter().map(|value| value.and_then(Value::as_f64)).collect::<Float64Array>())
    } else if all(&Value::is_boolean) {
        Arc::new(values.iter().map(|value| value.and_then(Value::as_bool)).collect::<BooleanArray>())
    } else {
        let text = |value: &Value| value.as_str().map_or_else(|| value.to_string(), str::to_owned);
        Arc::new(values.iter().map(|value| value.map(text)).collect::<StringArray>())
    }
}

fn cells(table: &Table, name: &str) -> Result<Vec<Option<Value>>, TableError> {
    if table.is_boolean(name) {
        return Ok(table.optional_integers(name)?.into_iter().map(|v| v.map(|v| Value::Bool(v != 0))).collect());
    }
    if table.is_integer(name) {
        return Ok(table.optional_integers(name)?.into_iter().map(|v| v.map(Value::from)).collect());
    }
    if table.is_text(name) {
        let value = |text: String| match serde_json::from_str(&text) {
            Ok(value @ (Value::Object(_) | Value::Array(_))) => value,
            _ => Value::String(text),
        };
        return Ok(table.optional_texts(name)?.into_iter().map(|text| text.map(value)).collect());
    }
    let number = |v: f64| Number::from_f64(v).map(Value::Number);
    Ok(table.optional_numbers(name)?.into_iter().map(|v| v.and_then(number)).collect())
}

/// `world.wind_m_s[1]` is element 1 of `world.wind_m_s`.
fn split(name: &str) -> (&str, Option<usize>) {
    let element = name.strip_suffix(']').and_then(|rest| rest.rsplit_once('['));
    match element.and_then(|(key, index)| index.parse().ok().map(|index| (key, index))) {
        Some((key, index)) => (key, Some(index)),
        None => (name, None),
    }
}

/// `world.wind_m_s[1]` as `world.wind_m_s.1`; every other key as it is.
fn dotted(key: &str) -> String {
    match split(key) {
        (whole, Some(index)) => format!("{whole}.{index}"),
        (key, None) => key.to_owned(),
    }
}

/// The opposite of [`dotted`].
fn bracketed(name: &str) -> String {
    match name.rsplit_once('.').and_then(|(whole, index)| Some((whole, index.parse::<usize>().ok()?))) {
        Some((whole, index)) => format!("{whole}[{index}]"),
        None => name.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use serde_json::json;

    use super::*;

    #[test]
    fn an_element_that_is_drawn_alone_comes_back_as_one() {
        let rows: [Drawn; 2] = [
            vec![("world.wind_m_s[1]".into(), json!(0.5)), ("robot.mass_kg".into(), json!(1.25))],
            vec![
                ("execute.external_force_n".into(), json!([1.0, 2.0, 3.0])),
                ("world.wind_m_s[1]".into(), json!(0.25)),
            ],
        ];
        let mut columns = Columns::default();
        push(&mut columns, &[&rows[0], &rows[1]]);
        let table = Table::of(Path::new("drawn"), columns.into_batch());
        assert_eq!(table.names()[0], "vary:world.wind_m_s.1");
        let mut back = read(&table).unwrap();
        back.iter_mut().for_each(|row| row.sort_by(|a, b| a.0.cmp(&b.0)));
        let mut rows = rows;
        rows.iter_mut().for_each(|row| row.sort_by(|a, b| a.0.cmp(&b.0)));
        assert_eq!(back, rows);
    }
}
