//! What the laboratory found, told.

use hairpin_lab::{Findings, Words};

use crate::console;
use crate::exit::{DONE, FINDING};

/// Tells it, as one object where it is for machines: 0, or 1 where something had to be met and was not.
pub(super) fn tell(findings: &Findings, json: bool) -> u8 {
    if json {
        console::say(&findings.object.to_string());
    } else {
        findings.words.iter().for_each(|words| match words {
            Words::Text(text) => console::say_lines(text),
            Words::Table(rows) => console::say_lines(&console::table(rows)),
        });
    }
    if findings.met { DONE } else { FINDING }
}
