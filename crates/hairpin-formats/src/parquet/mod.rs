//! The tables of a campaign folder as Parquet files: snappy, schema name and version in the metadata, equal bytes for
//! equal contents. Whatever is essential stands in columns, so files survive being rewritten by another program.

pub mod cases;
pub mod drawn;
pub mod drive;
mod guard;
pub mod profile;
pub mod results;
pub mod runs;
mod table;
mod thrift;
pub mod track;
mod values;

pub use table::{SCHEMA_VERSION, TableError};
