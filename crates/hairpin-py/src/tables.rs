//! Tables of a campaign's folder: as Arrow's C streams for whoever takes these, and as plain columns for NumPy.

use std::path::PathBuf;

use arrow_array::cast::AsArray;
use arrow_array::ffi::FFI_ArrowSchema;
use arrow_array::ffi_stream::FFI_ArrowArrayStream;
use arrow_array::types::{Float64Type, Int64Type, UInt64Type};
use arrow_array::{Array, ArrayRef, ArrowPrimitiveType, RecordBatchReader};
use arrow_cast::cast;
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

    /// Its columns by name: of numbers what NumPy calls their type, and their bytes, `NaN` where there is none; of
    /// others, and of whole numbers of which some are missing, a list of texts, lists, numbers, `None`.
    fn columns<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let rows = self.rows(py)?;
        let (schema, batches) = (rows.schema(), py.detach(|| rows.collect::<Result<Vec<_>, _>>()));
        let batches = batches.map_err(|error| no_table(py, &error))?;
        let columns = PyDict::new(py);
        for (place, field) in schema.fields().iter().enumerate() {
            let parts: Vec<_> = batches.iter().map(|batch| batch.column(place)).collect();
            columns.set_item(field.name(), column(py, field.data_type(), &parts)?)?;
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
fn column<'py>(py: Python<'py>, kind: &DataType, parts: &[&ArrayRef]) -> PyResult<Bound<'py, PyAny>> {
    let plain: Result<Vec<_>, _> = parts.iter().map(|part| cast(part, &plain(kind))).collect();
    let plain = plain.map_err(|error| no_table(py, &error))?;
    let full = plain.iter().all(|part| part.null_count() == 0);
    let (name, bytes): (_, Vec<u8>) = match plain.first().map(|part| part.data_type()) {
        Some(DataType::Float64) => ("f8", plain.iter().flat_map(floats).collect()),
        Some(DataType::Int64) if full => ("i8", plain.iter().flat_map(raw::<Int64Type>).copied().collect()),
        Some(DataType::UInt64) if full => ("u8", plain.iter().flat_map(raw::<UInt64Type>).copied().collect()),
        None if kind.is_numeric() => ("f8", Vec::new()),
        _ => return listed(py, &plain),
    };
    Ok((name, PyBytes::new(py, &bytes)).into_pyobject(py)?.into_any())
}

/// The bytes of numbers, `NaN` where there is none.
fn floats(part: &ArrayRef) -> Vec<u8> {
    let numbers = part.as_primitive::<Float64Type>();
    numbers.iter().flat_map(|number| number.unwrap_or(f64::NAN).to_ne_bytes()).collect()
}

/// The bytes of numbers that are all there.
fn raw<T: ArrowPrimitiveType>(part: &ArrayRef) -> &[u8] {
    part.as_primitive::<T>().values().inner().as_slice()
}

fn listed<'py>(py: Python<'py>, parts: &[ArrayRef]) -> PyResult<Bound<'py, PyAny>> {
    let list = PyList::empty(py);
    for part in parts {
        list.call_method1("extend", (values(py, part)?,))?;
    }
    Ok(list.into_any())
}

/// The type that stands for those like `kind`.
fn plain(kind: &DataType) -> DataType {
    match kind {
        DataType::Dictionary(_, value) => plain(value),
        DataType::LargeUtf8 | DataType::Utf8View => DataType::Utf8,
        DataType::UInt64 => DataType::UInt64,
        kind if kind.is_floating() => DataType::Float64,
        kind if kind.is_integer() => DataType::Int64,
        other => other.clone(),
    }
}

/// The values of a column of a plain type.
fn values<'py>(py: Python<'py>, array: &dyn Array) -> PyResult<Bound<'py, PyList>> {
    match array.data_type() {
        DataType::Float64 => PyList::new(py, array.as_primitive::<Float64Type>()),
        DataType::Int64 => PyList::new(py, array.as_primitive::<Int64Type>()),
        DataType::UInt64 => PyList::new(py, array.as_primitive::<UInt64Type>()),
        DataType::Boolean => PyList::new(py, array.as_boolean()),
        DataType::Utf8 => PyList::new(py, array.as_string::<i32>()),
        DataType::List(items) => {
            let list = PyList::empty(py);
            for own in array.as_list::<i32>().iter() {
                let own = own.map(|own| cast(&own, &plain(items.data_type()))).transpose();
                let own = own.map_err(|error| no_table(py, &error))?;
                list.append(own.map(|own| values(py, &own)).transpose()?)?;
            }
            Ok(list)
        }
        other => Err(PyTypeError::new_err(format!("a column of {other}: take the table by Arrow"))),
    }
}
