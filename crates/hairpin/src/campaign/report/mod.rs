//! What a report shows, as plain data and plain words; how it looks is the format's business.

mod assemble;
mod data;
mod facts;
mod length;
mod text;

pub use assemble::{assemble, in_order};
pub use data::{Beside, Drawn, Metric, Moment, OtherRun, Pieces, ReportData, Shown, shown, surroundings, worst_first};
pub use length::{Length, length};
pub use text::{COLUMNS, attitude, cells_in, columns_in, leg, violation};
