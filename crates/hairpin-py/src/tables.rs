//! Tables of a campaign's folder: as Arrow's C streams for whoever takes these, and as plain columns for NumPy.

use std::path::PathBuf;

use arrow_array::cast::AsArray;
use arrow_array::ffi::FFI_ArrowSchema;
use arrow_array::ffi_stream::FFI_ArrowArrayStream;
use arrow_array::types::{Float64Type, Int64Type, UInt64Type};
use arrow_array::{Array, RecordBatchReader};
use arrow_schema::DataType;
use hairpin::campaign::CaseNumber;
use hairpin_formats::folder::CampaignFolder;
use hairpin_formats::parquet::rows::{Only, Rows};
use hairpin_jobs::Problem;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyCapsule, PyDict, PyList};

use crate::problem::{raised, wrong};

/// A table, read whenever somebody asks for it.
#[pyclass(frozen, module = "hairpin._native")]
pub(crate) struct Table {
    folder: PathBuf,
    name: String,
    only: Only,
}

#[pymethods]
impl Table {
    #[new]
    fn new(py: Python<'_>, folder: PathBuf, name: String, only: (Option<usize>, Option<usize>)) -> PyResult<Self> {
        let only = Only { case: only.0.map(CaseNumber), run: only.1 };
        let table = Self { folder, name, only };
        table.rows(py).map(|_| table)
    }

    /// The stream, as Arrow's PyCapsule interface has it.
    #[pyo3(signature = (requested_schema = None))]
    fn __arrow_c_stream__<'py>(
        &self,
        py: Python<'py>,
        requested_schema: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyCapsule>> {
        // Whoever wants other types converts them: so the interface has it.
        drop(requested_schema);
        let stream = FFI_ArrowArrayStream::new(Box::new(self.rows(py)?));
        PyCapsule::new_with_value(py, stream, c"arrow_array_stream")
    }

    /// Its schema.
    fn __arrow_c_schema__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyCapsule>> {
        let schema = FFI_ArrowSchema::try_from(&*self.rows(py)?.schema()).map_err(|error| no_table(py, &error))?;
        PyCapsule::new_with_value(py, schema, c"arrow_schema")
    }

    /// Names of its columns.
    #[getter]
    fn names(&self, py: Python<'_>) -> PyResult<Vec<String>> {
        Ok(self.rows(py)?.schema().fields().iter().map(|field| field.name().clone()).collect())
    }

    /// Its columns by name: of `f64` the bytes, `NaN` where there is none; of others a list of numbers, texts, lists,
    /// `None`.
    fn columns<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let rows = self.rows(py)?;
        let (schema, batches) = (rows.schema(), py.detach(|| rows.collect::<Result<Vec<_>, _>>()));
        let batches = batches.map_err(|error| no_table(py, &error))?;
        let columns = PyDict::new(py);
        for (place, field) in schema.fields().iter().enumerate() {
            let parts = batches.iter().map(|batch| batch.column(place).as_ref());
            columns.set_item(field.name(), column(py, field.data_type(), parts)?)?;
        }
        Ok(columns)
    }
}

impl Table {
    fn rows(&self, py: Python<'_>) -> PyResult<Rows> {
        let Self { folder, name, only } = self;
        let found = py.detach(|| -> Result<_, Problem> {
            let folder = CampaignFolder::open(folder)?;
            Ok(folder.rows(name, *only)?.ok_or(folder.tables()?))
        });
        found.map_err(|problem| raised(py, &problem))?.map_err(|known| {
            let bound = format!("one of {}", known.join(", "));
            wrong(py, &format!("`table` = {name:?}: must be {bound}"), "table", name, &bound)
        })
    }
}

fn no_table(py: Python<'_>, error: &dyn std::fmt::Display) -> PyErr {
    raised(py, &Problem::input(error.to_string()))
}

/// A column in parts, as [`Table::columns`] has it.
fn column<'py, 'a>(
    py: Python<'py>,
    kind: &DataType,
    parts: impl Iterator<Item = &'a dyn Array>,
) -> PyResult<Bound<'py, PyAny>> {
    if kind == &DataType::Float64 {
        let numbers = parts.flat_map(|part| part.as_primitive::<Float64Type>());
        let bytes: Vec<u8> = numbers.flat_map(|number| number.unwrap_or(f64::NAN).to_ne_bytes()).collect();
        return Ok(PyBytes::new(py, &bytes).into_any());
    }
    let list = PyList::empty(py);
    for part in parts {
        list.call_method1("extend", (values(py, part)?,))?;
    }
    Ok(list.into_any())
}

/// The values of a column.
fn values<'py>(py: Python<'py>, array: &dyn Array) -> PyResult<Bound<'py, PyList>> {
    match array.data_type() {
        DataType::Float64 => PyList::new(py, array.as_primitive::<Float64Type>()),
        DataType::Int64 => PyList::new(py, array.as_primitive::<Int64Type>()),
        DataType::UInt64 => PyList::new(py, array.as_primitive::<UInt64Type>()),
        DataType::Boolean => PyList::new(py, array.as_boolean()),
        DataType::Utf8 => PyList::new(py, array.as_string::<i32>()),
        DataType::List(_) => {
            let list = PyList::empty(py);
            for items in array.as_list::<i32>().iter() {
                list.append(items.map(|items| values(py, &items)).transpose()?)?;
            }
            Ok(list)
        }
        other => Err(PyTypeError::new_err(format!("a column of {other}: take the table by Arrow"))),
    }
}
