//! What a report shows, as plain data and plain words; how it looks is the format's business.

mod text;

pub use text::{COLUMNS, cells, leg, number, percent, violation};
