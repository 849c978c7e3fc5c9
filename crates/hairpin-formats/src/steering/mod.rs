//! Boundary-value queries of ground vehicles in, and the drives that answer them out: CSV, one query or segment a row.

mod answer;
mod blocks;
mod kept;
mod plot;
mod queries;
mod query;
mod start_table;
mod states;
mod stored;

pub use answer::{Answer, Drive, Errors, Piece, Status, head, objects, rows};
pub use blocks::{Block, Blocks};
pub use kept::{KeptAnswer, kept_answers};
pub use plot::{Stretch, svg};
pub use queries::{Queries, QueryFile, parse};
pub use query::{Asked, BrokenFile, Columns, Frame, Row, Wrong};
pub use start_table::{BrokenTable, START_TABLE_BYTES, read_start_table, start_table_bytes};
pub use states::{path_table, wheel_table};
pub use stored::{Implausible, Stored, parse_stored, stored_text};
