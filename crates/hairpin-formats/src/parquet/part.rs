//! A part of a table, read case by case: row groups whose statistics name one case and run alone are read by
//! themselves; what another program made of them is read whole, and its rows told apart by their columns.

use std::collections::BTreeMap;
use std::fs::File;
use std::path::{Path, PathBuf};

use ::parquet::arrow::arrow_reader::ArrowReaderMetadata;
use ::parquet::file::metadata::RowGroupMetaData;
use ::parquet::file::statistics::Statistics;
use arrow_array::UInt64Array;
use arrow_select::take::take_record_batch;
use hairpin::campaign::CaseNumber;

use super::Key;
use super::guard::{most_decoded, read_footer};
use super::piece::Piece;
use super::table::{CASE, PERIOD, RUN, Table, TableError, decode_groups, notes_of};
use crate::bounds;
use crate::foreign;

/// Bytes of a part at most: only what is asked for is read of it.
const MOST_BYTES: u64 = 64_000_000_000;

/// A part that is open.
#[derive(Debug)]
pub(crate) struct Part {
    path: PathBuf,
    metadata: ArrowReaderMetadata,
    /// Row groups of one case and run each; none where others are.
    groups: BTreeMap<Key, Vec<usize>>,
    /// All rows, where groups mix them.
    loose: Option<(Table, BTreeMap<Key, Vec<usize>>)>,
    /// Time between the samples of which only some rows are there, s.
    period: Option<f64>,
}

impl Part {
    /// Opens the part at `path`: its footer alone is read.
    ///
    /// # Errors
    /// It is none.
    pub(crate) fn open(path: &Path) -> Result<Self, TableError> {
        let metadata = footer(path)?;
        let count = metadata.metadata().num_row_groups();
        let keys: Option<Vec<Key>> = metadata.metadata().row_groups().iter().map(key_of).collect();
        let mut groups: BTreeMap<Key, Vec<usize>> = BTreeMap::new();
        let is_mixed = keys.is_none();
        keys.into_iter().flatten().enumerate().for_each(|(group, key)| groups.entry(key).or_default().push(group));
        let period = notes_of(&metadata).into_iter().find(|(key, _)| key == PERIOD);
        let period = period.and_then(|(_, value)| value.parse().ok()).filter(|period: &f64| *period > 0.0);
        let mut part = Self { path: path.into(), metadata, groups, loose: None, period };
        if is_mixed {
            let table = part.decoded(&(0..count).collect::<Vec<_>>())?;
            let cases = table.cases()?;
            let runs = if table.has(RUN) { table.counts(RUN)? } else { vec![0; table.rows()] };
            let mut rows: BTreeMap<_, Vec<usize>> = BTreeMap::new();
            cases.into_iter().zip(runs).enumerate().for_each(|(row, key)| rows.entry(key).or_default().push(row));
            part.loose = Some((table, rows));
        }
        Ok(part)
    }

    /// What is in it, in order.
    pub(crate) fn keys(&self) -> impl Iterator<Item = Key> {
        self.groups.keys().chain(self.loose.iter().flat_map(|(_, rows)| rows.keys())).copied()
    }

    /// Whether a case or a run of it is in it.
    pub(crate) fn has(&self, key: Key) -> bool {
        self.groups.contains_key(&key) || self.loose.as_ref().is_some_and(|(_, rows)| rows.contains_key(&key))
    }

    /// The first and the last of its cases; `None` where it has no rows.
    pub(crate) fn cases(&self) -> Option<(CaseNumber, CaseNumber)> {
        let own = self.groups.first_key_value().zip(self.groups.last_key_value()).map(|(a, b)| (a.0.0, b.0.0));
        let loose = self.loose.as_ref().map(|(_, rows)| rows);
        let loose = loose.and_then(|rows| Some((rows.first_key_value()?.0.0, rows.last_key_value()?.0.0)));
        let both = own.zip(loose).map(|(a, b)| (a.0.min(b.0), a.1.max(b.1)));
        both.or(own).or(loose)
    }

    /// Time between the samples of which only some rows are there, s.
    pub(crate) fn period(&self) -> Option<f64> {
        self.period
    }

    /// The rows of a case, or of a run of it.
    ///
    /// # Errors
    /// They cannot be read.
    pub(crate) fn table(&self, key: Key) -> Result<Option<Table>, TableError> {
        if let Some(groups) = self.groups.get(&key) {
            return self.decoded(groups).map(Some);
        }
        let Some((table, rows)) = &self.loose else { return Ok(None) };
        let Some(rows) = rows.get(&key) else { return Ok(None) };
        let rows: UInt64Array = rows.iter().map(|row| *row as u64).collect();
        let batch = take_record_batch(&table.batch, &rows).map_err(|error| self.broken(error.to_string()))?;
        Ok(Some(Table::of(&self.path, batch)))
    }

    /// A case or a run of it to be written elsewhere.
    ///
    /// # Errors
    /// As [`Self::table`].
    pub(crate) fn piece(&self, key: Key) -> Result<Option<Piece>, TableError> {
        let Some(table) = self.table(key)? else { return Ok(None) };
        // Columns that only other pieces of the part have.
        let own = table.without_empty_columns();
        Piece::of_batch(&own, self.period).map(Some).map_err(|error| self.broken(error.to_string()))
    }

    fn decoded(&self, groups: &[usize]) -> Result<Table, TableError> {
        decoded(&self.path, &self.metadata, groups)
    }

    fn broken(&self, cause: String) -> TableError {
        TableError::Broken { path: self.path.clone(), cause }
    }
}

/// What the file at `path` says of its rows: its footer alone is read.
pub(super) fn footer(path: &Path) -> Result<ArrowReaderMetadata, TableError> {
    let mut file = open_file(path)?;
    let loaded =
        foreign::call(|| read_footer(&mut file)).unwrap_or_else(|_| Err("its bytes contradict each other".into()));
    loaded.map_err(|cause| TableError::Broken { path: path.into(), cause })
}

/// The rows of `groups` of the file at `path`.
pub(super) fn decoded(path: &Path, metadata: &ArrowReaderMetadata, groups: &[usize]) -> Result<Table, TableError> {
    let file = open_file(path)?;
    let packed = groups.iter().map(|group| metadata.metadata().row_group(*group).compressed_size());
    let most = most_decoded(packed.map(|bytes| bytes.max(0) as u64).sum());
    let decoded = foreign::call(|| decode_groups(&file, metadata, groups, most));
    let decoded = decoded.unwrap_or_else(|_| Err("its bytes contradict each other".into()));
    Ok(Table::of(path, decoded.map_err(|cause| TableError::Broken { path: path.into(), cause })?))
}

fn open_file(path: &Path) -> Result<File, TableError> {
    bounds::open(path, MOST_BYTES).map_err(|cause| TableError::Unreadable { path: path.into(), cause })
}

/// The case and run that a row group is of, if its statistics name one alone.
pub(super) fn key_of(group: &RowGroupMetaData) -> Option<Key> {
    let column = |name: &str| group.columns().iter().find(|column| column.column_path().parts() == [name]);
    let case = match column(CASE)?.statistics()? {
        Statistics::ByteArray(found) => {
            let (least, most) = (found.min_opt()?, found.max_opt()?);
            let exact = least == most && found.min_is_exact() && found.max_is_exact();
            std::str::from_utf8(least.data()).ok().filter(|_| exact)?.parse().ok()?
        }
        found => CaseNumber(number_of(found)?),
    };
    match column(RUN) {
        Some(run) => Some((case, number_of(run.statistics()?)?)),
        None => Some((case, 0)),
    }
}

fn number_of(found: &Statistics) -> Option<usize> {
    let (least, most) = match found {
        Statistics::Int32(found) => (i64::from(*found.min_opt()?), i64::from(*found.max_opt()?)),
        Statistics::Int64(found) => (*found.min_opt()?, *found.max_opt()?),
        _ => return None,
    };
    usize::try_from(least).ok().filter(|_| least == most)
}
