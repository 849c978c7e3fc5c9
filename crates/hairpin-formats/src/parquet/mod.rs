//! The tables of a campaign folder as Parquet files: snappy, schema name and version in the metadata, equal bytes for
//! equal contents. Whatever is essential stands in columns, so files survive being rewritten by another program.

pub mod cases;
mod compressed;
pub mod drawn;
pub mod drive;
mod drive_legs;
mod groups;
mod guard;
mod implausible;
mod measures;
pub(crate) mod part;
pub mod part_writer;
pub mod piece;
mod possible;
pub mod profile;
pub(crate) mod program;
pub mod results;
pub mod rows;
pub mod runs;
pub(crate) mod table;
mod thrift;
pub mod track;
mod values;

use hairpin::campaign::CaseNumber;

pub use table::{SCHEMA_VERSION, TableError};

/// The number of a case, and of its run.
pub(crate) type Key = (CaseNumber, usize);
