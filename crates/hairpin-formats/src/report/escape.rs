//! Text between tags.

use hairpin::judgement::is_command;

/// `text` with what HTML reads as its own written out; on one line, without control characters.
pub(super) fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            '\n' | '\t' => escaped.push(' '),
            c if is_command(c) => {}
            c => escaped.push(c),
        }
    }
    escaped
}
