//! Comments are wrapped where code is: rustfmt leaves them as they are.

use super::text::Text;

/// Columns of a line, as rustfmt has it.
const WIDTH: usize = 120;

/// The lines of `text` that hold a comment and are longer.
pub(crate) fn too_long(text: &str) -> Vec<usize> {
    let comments = Text::new(text).comments;
    let long = text.lines().enumerate().filter(|(_, line)| line.chars().count() > WIDTH);
    long.map(|(at, _)| at + 1).filter(|line| comments.contains(line)).collect()
}
