//! Plain values, there and back: what JSON has is what Python has.

use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyList, PyString};
use serde_json::{Map, Number, Value};

/// Lists in lists deeper than this are no answer.
const DEEPEST: usize = 32;

/// A value as a Python object.
pub(crate) fn object<'py>(py: Python<'py>, value: &Value) -> PyResult<Bound<'py, PyAny>> {
    Ok(match value {
        Value::Null => py.None().into_bound(py),
        Value::Bool(value) => PyBool::new(py, *value).to_owned().into_any(),
        Value::Number(number) => match (number.as_u64(), number.as_i64()) {
            (Some(whole), _) => whole.into_pyobject(py)?.into_any(),
            (None, Some(whole)) => whole.into_pyobject(py)?.into_any(),
            (None, None) => PyFloat::new(py, number.as_f64().unwrap_or(f64::NAN)).into_any(),
        },
        Value::String(text) => PyString::new(py, text).into_any(),
        Value::Array(values) => {
            let list = PyList::empty(py);
            for value in values {
                list.append(object(py, value)?)?;
            }
            list.into_any()
        }
        Value::Object(keys) => {
            let dict = PyDict::new(py);
            for (key, value) in keys {
                dict.set_item(key, object(py, value)?)?;
            }
            dict.into_any()
        }
    })
}

/// A Python object as a value: numbers, texts, lists and tuples of such, dictionaries with texts for keys, and whatever
/// has a `tolist`, as arrays of NumPy have.
///
/// # Errors
/// A number that is not finite; anything else.
pub(crate) fn value(found: &Bound<'_, PyAny>) -> PyResult<Value> {
    at_depth(found, 0)
}

fn at_depth(found: &Bound<'_, PyAny>, depth: usize) -> PyResult<Value> {
    if depth > DEEPEST {
        return Err(PyValueError::new_err("lists in lists without end"));
    }
    if found.is_none() {
        return Ok(Value::Null);
    }
    if found.is_instance_of::<PyBool>() {
        return Ok(Value::Bool(found.extract()?));
    }
    if found.is_instance_of::<PyFloat>() {
        return number(found.extract()?);
    }
    if found.is_instance_of::<PyInt>() {
        return found.extract::<i64>().map(Value::from).or_else(|_| number(found.extract()?));
    }
    if found.is_instance_of::<PyString>() {
        return Ok(Value::String(found.extract()?));
    }
    if let Ok(dict) = found.cast::<PyDict>() {
        let mut keys = Map::new();
        for (key, value) in dict.iter() {
            keys.insert(key.extract()?, at_depth(&value, depth + 1)?);
        }
        return Ok(Value::Object(keys));
    }
    if found.hasattr("tolist")? {
        return at_depth(&found.call_method0("tolist")?, depth + 1);
    }
    match found.try_iter() {
        Ok(values) => values.map(|value| at_depth(&value?, depth + 1)).collect::<PyResult<Vec<_>>>().map(Value::Array),
        Err(_) => Err(PyTypeError::new_err(format!("{} is no number, text, list or dictionary", found.repr()?))),
    }
}

fn number(found: f64) -> PyResult<Value> {
    let number = Number::from_f64(found).ok_or_else(|| PyValueError::new_err(format!("{found} is no finite number")));
    number.map(Value::Number)
}
