//! What a report shows, as plain data and plain words; how it looks is the format's business.

mod data;
mod solid;
mod text;

pub use data::{Drawing, Metric, Pieces, ReportData, Rotor, Shown, assemble, shown, worst_first};
pub use solid::{Surface, surface};
pub(in crate::campaign) use text::percent_digits;
pub use text::{COLUMNS, attitude, cells, leg, number, percent, violation};
