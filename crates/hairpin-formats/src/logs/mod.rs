//! Logs of robots that moved, whichever program wrote them, in one shape: metres, seconds, bodies forward, left, up.
//!
//! Readers convert axes at this door and nowhere else, and align nothing: what a log's frame is, whose stamps it has
//! and who estimated its poses is told beside them.

mod accuracy;
mod attitude;
mod axes;
mod bag;
mod dataflash;
mod detect;
mod error;
mod invalid;
mod late;
mod log;
mod modes;
mod planned;
mod samples;
mod text;
mod turns;
mod twice;
mod ulog;

use std::io::Read;
use std::path::Path;

pub use error::{LogError, MOST_SAMPLES, Place};
pub use log::{
    Clock, Event, EventKind, Joints, LogFrame, Logged, LoggedMotion, Progress, Reset, Sample, Source, Span, ToldTo,
};

pub use planned::is_planned;

use crate::bounds;
use detect::Format;
use error::Fault;

/// Bytes of a log at most: hours of all that a vehicle logs.
pub const MOST_LOG_BYTES: u64 = 1_000_000_000;
/// By so many of the first ones formats are told apart.
const FIRST_BYTES: u64 = 4_096;

/// The log at `path`, whose format is told by its content; among texts, a name that ends in `.tum` or `.csv` decides.
///
/// # Errors
/// The file cannot be read, is of no format that is known, or breaks its format, with the byte or line where
/// it does; it holds no motion, or more samples than [`MOST_SAMPLES`].
pub fn read(path: &Path) -> Result<Logged, LogError> {
    let bytes =
        bounds::read(path, MOST_LOG_BYTES).map_err(|cause| LogError::Unreadable { path: path.into(), cause })?;
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    parse(&bytes, &name).map_err(|fault| fault.of(path))
}

/// Whether the log at `path` is text, and so, of an arm, a table as its controller writes it.
///
/// # Errors
/// As of [`read`], for what its first bytes and its name say.
pub fn is_text(path: &Path) -> Result<bool, LogError> {
    let unreadable = |cause| LogError::Unreadable { path: path.into(), cause };
    let mut first = Vec::new();
    let file = bounds::open(path, MOST_LOG_BYTES).map_err(unreadable)?;
    file.take(FIRST_BYTES).read_to_end(&mut first).map_err(unreadable)?;
    // Whatever its name is, for tables of controllers have others.
    let format = if first.contains(&0) { Format::of(&first, "") } else { Format::of(&first, ".csv") };
    format.map(|format| matches!(format, Format::Tum | Format::Csv)).map_err(|fault| fault.of(path))
}

fn parse(bytes: &[u8], name: &str) -> Result<Logged, Fault> {
    let logged = match Format::of(bytes, name)? {
        Format::Ulog => ulog::read_ulog(bytes),
        Format::Mcap => bag::read_mcap(bytes),
        Format::DataFlash => dataflash::read_dataflash(bytes),
        Format::Tum => text::read_tum(text::decode(bytes)?, name),
        Format::Csv => text::read_csv(text::decode(bytes)?, name),
    }?;
    if logged.motions.is_empty() && logged.joints.is_empty() {
        let notes = if logged.notes.is_empty() { String::new() } else { format!(" ({})", logged.notes.join("; ")) };
        return Err(Fault::Nothing(format!("a {} log without any motion{notes}", logged.format)));
    }
    Ok(logged)
}

#[cfg(test)]
mod tests;
