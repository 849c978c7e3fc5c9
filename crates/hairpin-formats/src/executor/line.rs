//! One line of a program's, as a message or as what is wrong with it.

use super::failure::{Failure, excerpt};
use super::heard::FromExecutor;
use crate::delimited::BYTE_ORDER_MARK;

/// The message in line number `number`.
pub(super) fn parse(bytes: &[u8], number: u64) -> Result<FromExecutor, Failure> {
    let line = || excerpt(&String::from_utf8_lossy(bytes), 120);
    let garbage = |cause: String| Failure::Garbage { number, cause, line: line() };
    let text = std::str::from_utf8(bytes).map_err(|error| garbage(format!("not UTF-8: {error}")))?;
    text.parse().map_err(|error: serde_json::Error| {
        // Whole as a table, and so meant for us; a banner is none.
        if error.is_data() && text.trim_start().starts_with('{') {
            return Failure::NotUnderstood { number, cause: error.to_string(), line: line() };
        }
        if text.starts_with(BYTE_ORDER_MARK) {
            return garbage("it begins with a byte order mark, as the stream alone may".into());
        }
        // Python's json writes these; they are no JSON.
        let infinite = ["NaN", "Infinity"].into_iter().find(|word| text.contains(word));
        garbage(infinite.map_or_else(|| error.to_string(), |word| format!("{word} is no JSON number: must be finite")))
    })
}

/// What is wrong with a line after the end.
pub(super) fn after(line: &[u8]) -> Failure {
    Failure::After { line: excerpt(&String::from_utf8_lossy(line), 80) }
}

/// Whether a line answers a mission.
pub(super) fn is_an_answer(line: &[u8]) -> bool {
    let message = std::str::from_utf8(line).map(str::parse::<FromExecutor>);
    message.is_ok_and(|message| message.is_ok_and(|message| !matches!(message, FromExecutor::Ready(_))))
}
