//! What a report shows, as plain data and plain words; how it looks is the format's business.
//!
//! ```text
//! judged campaign ─▶ Pieces ─▶ assemble (facts, text, length) ─▶ ReportData ─▶ a format
//! cases to show   ─▶ shown ──▶ Shown ─┘
//! ```
//!
//! Plain data in SI; a verdict's lengths are told in [`Length`]'s unit, and [`Metric`]s in the specification's.

mod assemble;
mod data;
mod facts;
mod length;
mod text;

pub use assemble::{assemble, in_order};
pub use data::{Beside, Drawn, Metric, Moment, OtherRun, Pieces, ReportData, Shown, shown, surroundings, worst_first};
pub use length::{Length, length};
pub use text::{COLUMNS, attitude, cells_in, columns_in, leg, violation};
