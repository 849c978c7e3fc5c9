//! What is told of recordings beside their verdict.

use super::measure::Offset;

/// The largest of runs' offsets, each with the time between samples (s): one that was taken off, or one that every
/// arrival of its run shares and that is told because it was not.
///
/// ms. An estimated offset is told where it is larger than the time between samples and known to half of itself.
pub fn offset_told(offsets: impl Iterator<Item = (Offset, f64)>) -> Option<String> {
    let (offset, sample) = offsets.max_by(|a, b| a.0.seconds.abs().total_cmp(&b.0.seconds.abs()))?;
    let milliseconds = 1e3 * offset.seconds;
    if offset.removed {
        Some(format!("time offset of {milliseconds:+.1} ms removed as asked"))
    } else if offset.seconds.abs() > sample && offset.spread < 0.5 * offset.seconds.abs() {
        Some(format!("times as recorded; an offset of {milliseconds:+.1} ms is estimated and not removed"))
    } else {
        None
    }
}
