//! Logs as text: one pose a line.

mod checks;
mod columns;
mod csv;
mod tum;

pub(super) use checks::decode;
pub(super) use csv::read_csv;
pub(super) use tum::read_tum;
