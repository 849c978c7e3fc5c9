//! All rows of a table as its files have them, some groups at a time, for whoever takes them elsewhere.

use std::collections::VecDeque;
use std::path::PathBuf;
use std::sync::Arc;

use ::parquet::arrow::arrow_reader::ArrowReaderMetadata;
use arrow_array::{BooleanArray, RecordBatch, RecordBatchReader, new_null_array};
use arrow_schema::{ArrowError, DataType, Schema, SchemaRef};
use arrow_select::filter::filter_record_batch;
use hairpin::campaign::CaseNumber;

use super::part::{decoded, footer, key_of};
use super::table::{RUN, Table, TableError};

/// Rows that are decoded at a time, where a group has fewer.
const AT_ONCE: i64 = 1 << 16;

/// Of which rows a table is read.
#[derive(Debug, Clone, Copy, Default)]
pub struct Only {
    /// Those of one case.
    pub case: Option<CaseNumber>,
    /// Those of one run.
    pub run: Option<usize>,
}

impl Only {
    fn has(&self, (case, run): (CaseNumber, usize)) -> bool {
        self.case.is_none_or(|only| only == case) && self.run.is_none_or(|only| only == run)
    }

    /// The rows of `table` that are wanted.
    fn rows(&self, table: &Table) -> Result<RecordBatch, TableError> {
        if self.case.is_none() && self.run.is_none() {
            return Ok(table.batch.clone());
        }
        let runs = if table.has(RUN) { table.optional_counts(RUN)? } else { vec![self.run; table.rows()] };
        let keys = table.cases()?.into_iter().zip(runs);
        let wanted: BooleanArray = keys.map(|(case, run)| Some(self.has((case, run.unwrap_or(usize::MAX))))).collect();
        let broken = |error: ArrowError| TableError::Broken { path: table.path.clone(), cause: error.to_string() };
        filter_record_batch(&table.batch, &wanted).map_err(broken)
    }
}

/// Some row groups of a file.
struct Groups {
    path: PathBuf,
    metadata: ArrowReaderMetadata,
    groups: Vec<usize>,
}

/// The rows of a table, read while they are asked for. Columns that only some of its files have are empty in the rows
/// of the others.
pub struct Rows {
    schema: SchemaRef,
    left: VecDeque<Groups>,
    only: Only,
}

impl Rows {
    /// Of the table in `files`: their footers alone are read.
    ///
    /// # Errors
    /// A file that is no table; files whose columns contradict each other.
    pub(crate) fn open(files: Vec<PathBuf>, only: Only) -> Result<Self, TableError> {
        let (mut schemas, mut left) = (Vec::new(), VecDeque::new());
        let last = files.last().cloned().unwrap_or_default();
        for path in files {
            let metadata = footer(&path)?;
            schemas.push(Schema::new(metadata.schema().fields().clone()));
            for groups in at_once(&metadata, only) {
                left.push_back(Groups { path: path.clone(), metadata: metadata.clone(), groups });
            }
        }
        let schema = Schema::try_merge(schemas);
        let schema = schema.map_err(|error| TableError::Broken { path: last, cause: error.to_string() })?;
        Ok(Self { schema: Arc::new(schema), left, only })
    }

    fn read(&self, groups: &Groups) -> Result<RecordBatch, ArrowError> {
        let read = decoded(&groups.path, &groups.metadata, &groups.groups).and_then(|table| self.only.rows(&table));
        let batch = read.map_err(|error| ArrowError::ExternalError(Box::new(error)))?;
        let column = |name: &str, kind: &DataType| {
            batch.column_by_name(name).cloned().unwrap_or_else(|| new_null_array(kind, batch.num_rows()))
        };
        let columns = self.schema.fields().iter().map(|field| column(field.name(), field.data_type()));
        RecordBatch::try_new(self.schema.clone(), columns.collect())
    }
}

/// The groups of a file that may have wanted rows, as many at a time as are decoded together.
fn at_once(metadata: &ArrowReaderMetadata, only: Only) -> Vec<Vec<usize>> {
    let has_runs = metadata.schema().column_with_name(RUN).is_some();
    let only = Only { run: only.run.filter(|_| has_runs), ..only };
    let (mut all, mut rows): (Vec<Vec<usize>>, i64) = (Vec::new(), AT_ONCE);
    for (number, group) in metadata.metadata().row_groups().iter().enumerate() {
        if key_of(group).is_some_and(|key| !only.has(key)) {
            continue;
        }
        match all.last_mut().filter(|_| rows < AT_ONCE) {
            Some(groups) => groups.push(number),
            None => {
                all.push(vec![number]);
                rows = 0;
            }
        }
        rows = rows.saturating_add(group.num_rows());
    }
    all
}

impl Iterator for Rows {
    type Item = Result<RecordBatch, ArrowError>;

    fn next(&mut self) -> Option<Self::Item> {
        let groups = self.left.pop_front()?;
        Some(self.read(&groups))
    }
}

impl RecordBatchReader for Rows {
    fn schema(&self) -> SchemaRef {
        self.schema.clone()
    }
}
