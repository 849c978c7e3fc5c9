//! Boundary-value queries of ground vehicles in, and the drives that answer them out: CSV, one query or segment a row.

mod answer;
mod plot;
mod query;
mod start_table;
mod states;
mod stored;

pub use answer::{Answer, Drive, Errors, Piece, Status, table};
pub use plot::{Stretch, svg};
pub use query::{Asked, BrokenFile, Frame, Queries, Row, Wrong, parse, read};
pub use start_table::{BrokenTable, START_TABLE_BYTES, read_start_table, start_table_bytes};
pub use states::{path_table, wheel_table};
pub use stored::{Implausible, Stored, parse_stored, stored_text};
