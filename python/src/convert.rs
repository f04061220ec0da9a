//! Conversion of Python values to TOML, and of JSON to Python values.

use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyList, PyString, PyTuple};
use serde_json::Value as Json;
use toml::Value as Toml;

use crate::errors::Failure;

/// Converts a dict to a TOML table. `at` is the key path of the dict.
///
/// # Errors
/// The key path of a value that TOML cannot represent.
pub(crate) fn table(dict: &Bound<'_, PyDict>, at: &str) -> Result<toml::Table, Failure> {
    let mut table = toml::Table::new();
    for (key, value) in dict {
        let Ok(key) = key.extract::<String>() else {
            return Err(Failure::of_key(at, format!("the key {key} is no string")));
        };
        let at = match at {
            "" => key.clone(),
            _ => format!("{at}.{key}"),
        };
        table.insert(key, value_of(&value, &at)?);
    }
    Ok(table)
}

/// Maximum depth of tables and arrays in a scene [-]; its own tables take ten.
const DEPTH_MAX: usize = 100;

fn value_of(value: &Bound<'_, PyAny>, at: &str) -> Result<Toml, Failure> {
    if at.matches(['.', '[']).count() > DEPTH_MAX {
        return Err(Failure::of_key(
            at,
            "too many tables or arrays within each other".into(),
        ));
    }
    if let Ok(truth) = value.cast::<PyBool>() {
        return Ok(Toml::Boolean(truth.is_true()));
    }
    if value.is_instance_of::<PyInt>() {
        let number = value.extract::<i64>();
        let beyond = |_| Failure::of_key(at, format!("{value} is beyond a 64-bit whole number"));
        return number.map(Toml::Integer).map_err(beyond);
    }
    if let Ok(number) = value.cast::<PyFloat>() {
        return Ok(Toml::Float(number.value()));
    }
    if let Ok(text) = value.cast::<PyString>() {
        return Ok(Toml::String(text.to_string()));
    }
    if let Ok(dict) = value.cast::<PyDict>() {
        return Ok(Toml::Table(table(dict, at)?));
    }
    if value.is_instance_of::<PyList>() || value.is_instance_of::<PyTuple>() {
        let elements = value.try_iter().map_err(|_| no_value(value, at))?;
        let elements = elements.enumerate().map(|(index, element)| {
            let at = format!("{at}[{index}]");
            value_of(&element.map_err(|_| no_value(value, &at))?, &at)
        });
        return Ok(Toml::Array(elements.collect::<Result<_, _>>()?));
    }
    // numpy arrays and numbers; paths
    for way in ["tolist", "__fspath__"] {
        if let Ok(plain) = value.call_method0(way) {
            return value_of(&plain, at);
        }
    }
    Err(no_value(value, at))
}

fn no_value(value: &Bound<'_, PyAny>, at: &str) -> Failure {
    if value.is_none() {
        return Failure::of_key(at, "None is no value: leave the key out".to_string());
    }
    let kind = value.get_type();
    let kind = kind
        .name()
        .map_or_else(|_| "?".to_string(), |name| name.to_string());
    let problem =
        format!("a value of type {kind} has no meaning in a scene: numbers, strings, lists and dicts have");
    Failure::of_key(at, problem)
}

/// Converts JSON to dicts, lists and numbers.
pub(crate) fn json<'py>(py: Python<'py>, value: &Json) -> PyResult<Bound<'py, PyAny>> {
    Ok(match value {
        Json::Null => py.None().into_bound(py),
        Json::Bool(truth) => PyBool::new(py, *truth).to_owned().into_any(),
        Json::Number(number) => match number.as_u64() {
            Some(whole) => whole.into_pyobject(py)?.into_any(),
            None => number.as_f64().unwrap_or(f64::NAN).into_pyobject(py)?.into_any(),
        },
        Json::String(text) => PyString::new(py, text).into_any(),
        Json::Array(elements) => {
            let elements = elements.iter().map(|element| json(py, element));
            PyList::new(py, elements.collect::<PyResult<Vec<_>>>()?)?.into_any()
        }
        Json::Object(entries) => {
            let dict = PyDict::new(py);
            for (key, value) in entries {
                dict.set_item(key, json(py, value)?)?;
            }
            dict.into_any()
        }
    })
}
