//! Typed access to a table's columns: another writer may have changed widths, dictionaries and nulls, not meanings.

use arrow_array::cast::AsArray;
use arrow_array::types::{Float64Type, Int64Type, UInt64Type};
use arrow_array::{Array, ArrayRef};
use arrow_cast::cast;
use arrow_schema::DataType;
use hairpin::campaign::CaseNumber;

use super::table::{Table, TableError};

impl Table {
    /// Whether the column holds truth values.
    pub(crate) fn is_boolean(&self, column: &str) -> bool {
        self.column(column).is_ok_and(|array| array.data_type() == &DataType::Boolean)
    }

    /// Whether the column holds integers.
    pub(crate) fn is_integer(&self, column: &str) -> bool {
        self.column(column).is_ok_and(|array| array.data_type().is_integer())
    }

    /// Whether nothing stands in the column, while there are rows.
    pub(crate) fn is_empty(&self, column: &str) -> bool {
        self.column(column).is_ok_and(|array| !array.is_empty() && array.logical_null_count() == array.len())
    }

    /// Whether the column holds texts.
    pub(crate) fn is_text(&self, column: &str) -> bool {
        self.column(column).is_ok_and(|array| is_text(array.data_type()))
    }

    /// Finite numbers without gaps.
    pub(crate) fn numbers(&self, column: &str) -> Result<Vec<f64>, TableError> {
        self.all(column, self.optional_numbers(column)?, "a finite number")
    }

    /// Finite numbers; null and NaN (what data frames make of null) are `None`.
    pub(crate) fn optional_numbers(&self, column: &str) -> Result<Vec<Option<f64>>, TableError> {
        let array = self.array(column, &DataType::Float64, "numbers")?;
        let values = array.as_primitive::<Float64Type>();
        let there = |row: usize| values.nulls().is_none_or(|nulls| nulls.is_valid(row));
        let number = |(row, &value): (usize, &f64)| Some(value).filter(|v| !v.is_nan() && there(row));
        let found: Vec<_> = values.values().iter().enumerate().map(number).collect();
        match found.iter().position(|value| value.is_some_and(f64::is_infinite)) {
            Some(row) => Err(self.refuse(column, row, "infinity", "a finite number")),
            None => Ok(found),
        }
    }

    /// As [`Self::optional_numbers`]; all `None` where there is no such column.
    pub(crate) fn numbers_or_none(&self, column: &str) -> Result<Vec<Option<f64>>, TableError> {
        if self.names().iter().any(|name| name == column) {
            self.optional_numbers(column)
        } else {
            Ok(vec![None; self.rows()])
        }
    }

    /// Counts: integers ≥ 0 without gaps.
    pub(crate) fn counts(&self, column: &str) -> Result<Vec<usize>, TableError> {
        self.all(column, self.optional_counts(column)?, "an integer ≥ 0")
    }

    /// Counts; null and NaN are `None`.
    pub(crate) fn optional_counts(&self, column: &str) -> Result<Vec<Option<usize>>, TableError> {
        let integers = self.optional_integers(column)?;
        let count = |(row, value): (usize, Option<i64>)| match value {
            Some(v) => usize::try_from(v).map(Some).map_err(|_| self.refuse(column, row, v, "an integer ≥ 0")),
            None => Ok(None),
        };
        integers.into_iter().enumerate().map(count).collect()
    }

    /// Integers; floating-point columns are taken if every value is whole.
    pub(crate) fn optional_integers(&self, column: &str) -> Result<Vec<Option<i64>>, TableError> {
        if self.column(column)?.data_type().is_floating() {
            let whole = |(row, value): (usize, Option<f64>)| match value {
                Some(v) if v.fract() == 0.0 && v.abs() < 9.0e15 => Ok(Some(v as i64)),
                Some(v) => Err(self.refuse(column, row, v, "an integer")),
                None => Ok(None),
            };
            return self.optional_numbers(column)?.into_iter().enumerate().map(whole).collect();
        }
        let array = self.array(column, &DataType::Int64, "integers")?;
        Ok(array.as_primitive::<Int64Type>().iter().collect())
    }

    /// 64-bit patterns such as seeds: integers ≥ 0 without gaps.
    pub(crate) fn unsigned(&self, column: &str) -> Result<Vec<u64>, TableError> {
        if self.column(column)?.data_type().is_floating() {
            // Above 2^53 a float has lost bits, so `counts` refuses it rather than giving another seed.
            return Ok(self.counts(column)?.into_iter().map(|v| v as u64).collect());
        }
        let array = self.array(column, &DataType::UInt64, "integers ≥ 0")?;
        self.all(column, array.as_primitive::<UInt64Type>().iter().collect(), "an integer from 0 to 2^64 − 1")
    }

    /// Texts without gaps.
    pub(crate) fn texts(&self, column: &str) -> Result<Vec<String>, TableError> {
        self.all(column, self.optional_texts(column)?, "a text")
    }

    /// Texts.
    pub(crate) fn optional_texts(&self, column: &str) -> Result<Vec<Option<String>>, TableError> {
        let array = self.array(column, &DataType::Utf8, "texts")?;
        Ok(array.as_string::<i32>().iter().map(|text| text.map(str::to_owned)).collect())
    }

    /// Case ids as numbers: `0007`, or 7 where a data frame has turned the column into integers.
    pub(crate) fn cases(&self) -> Result<Vec<CaseNumber>, TableError> {
        if self.column("case")?.data_type().is_numeric() {
            return Ok(self.counts("case")?.into_iter().map(CaseNumber).collect());
        }
        let texts = self.texts("case")?;
        let number = |(row, text): (usize, &String)| {
            text.parse().map_err(|_| self.refuse("case", row, format!("`{text}`"), "a case such as `0007`"))
        };
        texts.iter().enumerate().map(number).collect()
    }

    /// Lists of numbers; a null or NaN inside is `None`.
    pub(crate) fn number_lists(&self, column: &str) -> Result<Vec<Option<Vec<Option<f64>>>>, TableError> {
        self.lists(column, &DataType::Float64, "lists of numbers", |items| {
            items.as_primitive::<Float64Type>().iter().map(|v| v.filter(|v| !v.is_nan())).collect()
        })
    }

    /// Lists of texts; a null inside is the empty text.
    pub(crate) fn text_lists(&self, column: &str) -> Result<Vec<Option<Vec<String>>>, TableError> {
        self.lists(column, &DataType::Utf8, "lists of texts", |items| {
            items.as_string::<i32>().iter().map(|text| text.unwrap_or_default().to_owned()).collect()
        })
    }

    fn lists<T: Clone>(
        &self,
        column: &str,
        item: &DataType,
        expected: &str,
        take: impl Fn(&ArrayRef) -> Vec<T>,
    ) -> Result<Vec<Option<Vec<T>>>, TableError> {
        let array = self.array(column, &DataType::new_list(item.clone(), true), expected)?;
        let lists = array.as_list::<i32>();
        // All items at once: an array of its own for each row costs more than its numbers.
        let items = take(lists.values());
        let of_row = |(row, ends): (usize, &[i32])| {
            lists.is_valid(row).then(|| items[ends[0] as usize..ends[1] as usize].to_vec())
        };
        Ok(lists.value_offsets().windows(2).enumerate().map(of_row).collect())
    }

    /// The column converted to `wanted`. A value that the conversion loses is an error, not a null.
    fn array(&self, column: &str, wanted: &DataType, expected: &str) -> Result<ArrayRef, TableError> {
        let found = self.column(column)?;
        let refuse = || TableError::Column {
            path: self.path.clone(),
            column: column.into(),
            found: format!("has type {}", found.data_type()),
            expected: expected.into(),
        };
        // A column of nulls alone has no type that could be wrong.
        if found.logical_null_count() == found.len() {
            return Ok(arrow_array::new_null_array(wanted, found.len()));
        }
        // Arrow would also parse numbers out of texts and print numbers as texts: not the same meaning.
        if is_text(found.data_type()) != is_text(wanted) && !has_no_items(found.data_type()) {
            return Err(refuse());
        }
        let converted = cast(found, wanted).map_err(|_| refuse())?;
        // Nulls stay nulls: as many of them are the same ones.
        if converted.null_count() == found.null_count() {
            return Ok(converted);
        }
        match (0..found.len()).find(|&row| converted.is_null(row) && !found.is_null(row)) {
            Some(row) => Err(self.refuse(column, row, "a value that does not fit", expected)),
            None => Ok(converted),
        }
    }

    fn column(&self, column: &str) -> Result<&ArrayRef, TableError> {
        self.batch.column_by_name(column).ok_or_else(|| TableError::Column {
            path: self.path.clone(),
            column: column.into(),
            found: "is missing".into(),
            expected: "there".into(),
        })
    }

    fn all<T>(&self, column: &str, values: Vec<Option<T>>, bound: &str) -> Result<Vec<T>, TableError> {
        let given = |(row, value): (usize, Option<T>)| value.ok_or_else(|| self.refuse(column, row, "empty", bound));
        values.into_iter().enumerate().map(given).collect()
    }
}

/// Whether it is of lists in which nothing stands, which pandas writes of a column of empty lists: their items have no
/// type that could be wrong.
fn has_no_items(kind: &DataType) -> bool {
    match kind {
        DataType::List(item) | DataType::LargeList(item) => item.data_type().is_null(),
        _ => false,
    }
}

fn is_text(kind: &DataType) -> bool {
    match kind {
        DataType::Utf8 | DataType::LargeUtf8 | DataType::Utf8View => true,
        DataType::Dictionary(_, value) => is_text(value),
        DataType::List(item) | DataType::LargeList(item) => is_text(item.data_type()),
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;
    use std::sync::Arc;

    use arrow_array::builder::{ListBuilder, NullBuilder};
    use arrow_array::{NullArray, StringArray, new_null_array};

    use super::super::table::Columns;
    use super::*;

    /// As pandas writes columns without a single value: of no type, or lists without items.
    #[test]
    fn a_column_of_no_type_is_empty_whatever_it_should_be() {
        let mut lists = ListBuilder::new(NullBuilder::new());
        [true, false].into_iter().for_each(|there| lists.append(there));
        let mut columns = Columns::default();
        columns.push("none", Arc::new(NullArray::new(2)));
        columns.push("lists", Arc::new(lists.finish()));
        columns.push("texts", Arc::new(StringArray::from(vec!["a", "b"])));
        columns.push("words", new_null_array(&DataType::Utf8, 2));
        let table = Table::of(Path::new("t"), columns.into_batch());
        assert_eq!(table.optional_numbers("none").unwrap(), [None, None]);
        assert_eq!(table.optional_counts("none").unwrap(), [None, None]);
        assert_eq!(table.optional_texts("none").unwrap(), [None, None]);
        assert_eq!(table.text_lists("none").unwrap(), [None, None]);
        assert_eq!(table.text_lists("lists").unwrap(), [Some(Vec::new()), None]);
        assert_eq!(table.number_lists("lists").unwrap(), [Some(Vec::new()), None]);
        assert_eq!(table.optional_numbers("words").unwrap(), [None, None]);
        assert!(table.is_empty("none") && !table.is_empty("lists") && !table.is_empty("texts"));
        assert!(table.optional_numbers("texts").is_err());
    }
}
