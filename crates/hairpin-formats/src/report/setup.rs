//! How it was tested: the facts, the robot as it is understood, assumptions and limits of this run.

use hairpin::campaign::digits::number;
use hairpin::campaign::report::ReportData;

use super::escape::escape;
use super::layout;

/// A sentence in which what stands in backticks is a name of a file or a scenario.
fn with_code(line: &str) -> String {
    let part = |(place, part): (usize, &str)| match place % 2 {
        0 => escape(part),
        _ => format!("<code>{}</code>", escape(part)),
    };
    line.split('`').enumerate().map(part).collect()
}

/// The section.
pub(super) fn section(data: &ReportData) -> String {
    let facts: String = data
        .facts
        .iter()
        .map(|[label, value]| format!("<dt>{}</dt><dd>{}</dd>", escape(label), escape(value)))
        .collect();
    let assumptions: String = data.assumptions.iter().map(|line| format!("<li>{}</li>", with_code(line))).collect();
    let assumptions = if assumptions.is_empty() {
        String::new()
    } else {
        format!(
            "<section class=\"panel\" id=\"assumptions\"><h2>Assumptions and limits of this run</h2><ul>{assumptions}</ul></section>"
        )
    };
    let caption = if data.drawing.rotors.is_empty() {
        format!("seen from above; all wheels inside a circle of {} m", number(Some(data.drawing.radius)))
    } else {
        format!(
            "<span class=\"key cw\"></span>clockwise <span class=\"key ccw\"></span>counter-clockwise, seen from above; all \
             inside a ball of {} m",
            number(Some(data.drawing.radius))
        )
    };
    // Of an arm, and of a vehicle of whose wheels nobody said where they are, the 3D view shows all there is.
    let wheels = data.drawing.radius > 0.0 && !data.drawing.wheels.is_empty();
    let drawn = !data.drawing.rotors.is_empty() || wheels;
    let robot = if drawn {
        format!("<figure>{}<figcaption>{caption}</figcaption></figure>", layout::robot(&data.drawing))
    } else {
        String::new()
    };
    format!(
        "<section class=\"panel\" id=\"setup\"><h2>How it was tested</h2><div class=\"columns\"><dl>{facts}</dl>{robot}</div></section>\n{assumptions}"
    )
}
