//! What a report shows, as plain data and plain words; how it looks is the format's business.

mod assemble;
mod data;
mod facts;
mod text;

pub use assemble::assemble;
pub use data::{Length, Metric, Moment, OtherRun, Pieces, ReportData, Shown, length, shown, surroundings, worst_first};
pub use text::{COLUMNS, attitude, cells, cells_in, columns_in, leg, violation};
