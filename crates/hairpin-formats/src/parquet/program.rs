//! `programs/`: what arms run, a row a case: `case,module`, the RAPID module as a controller loads it.

use std::io;
use std::sync::Arc;

use arrow_array::StringArray;
use hairpin::campaign::CaseNumber;

use super::piece::Piece;
use super::table::{CASE, Columns, Table, TableError};

const MODULE: &str = "module";

/// The row of a case.
///
/// # Errors
/// There is no room for it.
pub(crate) fn piece(case: CaseNumber, module: &str) -> io::Result<Piece> {
    let mut columns = Columns::default();
    columns.push(CASE, Arc::new(StringArray::from(vec![case.to_string()])));
    columns.push(MODULE, Arc::new(StringArray::from(vec![module])));
    Piece::of(columns)
}

/// The module of a case.
pub(crate) fn from_table(table: &Table) -> Result<String, TableError> {
    let mut modules = table.texts(MODULE)?;
    match modules.pop() {
        Some(module) if modules.is_empty() => Ok(module),
        _ => Err(table.refuse(MODULE, 1, "another number of rows", "one row a case")),
    }
}
