//! Sections that only some campaigns have: violations that were run again, and what the test set exercised.

use hairpin::campaign::kind::Axis;
use hairpin::campaign::report::ReportData;

use super::escape::escape;

/// How often violations came again.
pub(super) fn reruns(data: &ReportData) -> String {
    let again = data.results.iter().filter_map(|result| Some((result.case, result.reruns?)));
    let rows: String = again
        .filter_map(|(case, reruns)| {
            let share = reruns.share(data.confidence)?;
            let [value, low, high] = [share.value, share.low, share.high].map(|share| 100.0 * share);
            let (k, n) = (reruns.violated, reruns.of);
            Some(format!(
                "<tr><th scope=\"row\">{case}</th><td>{k} of {n}</td><td>{value:.1} %</td><td>[{low:.1}, {high:.1}]</td></tr>"
            ))
        })
        .collect();
    if rows.is_empty() {
        return String::new();
    }
    let sure = (1000.0 * data.confidence).round() / 10.0;
    format!(
        "<section class=\"panel\" id=\"reruns\"><h2>Do violations come again?</h2><p class=\"note\">Each violating run was run again \
         with what was drawn for it and other noise; the share that violates, with its {sure} % interval \
         (Clopper-Pearson).</p><div class=\"scroll\"><table class=\"spread\"><thead><tr><th scope=\"col\">case</th>\
         <th scope=\"col\">violate</th><th scope=\"col\">share</th><th scope=\"col\">{sure} %</th></tr></thead>\
         <tbody>{rows}</tbody></table></div></section>"
    )
}

/// Which cells of the grid of motion were met, along each axis.
pub(super) fn coverage(data: &ReportData) -> String {
    let Some(coverage) = &data.coverage else { return String::new() };
    let axes = &coverage.grid.axes;
    let row = |(number, axis): (usize, &Axis)| {
        let cells = coverage.cells / axis.cells();
        let bars: String = (0..axis.cells())
            .map(|place| {
                let met = coverage.cases.keys().filter(|cell| coverage.grid.places(**cell)[number] == place).count();
                format!("<td>{}: {met} of {cells}</td>", escape(&axis.in_words(place)))
            })
            .collect();
        let unit = if axis.unit.is_empty() { String::new() } else { format!(", {}", axis.unit) };
        format!("<tr><th scope=\"row\">{}{}</th>{bars}</tr>", escape(&axis.name), escape(&unit))
    };
    let names: Vec<&str> = axes.iter().map(|axis| axis.name.as_str()).collect();
    format!(
        "<section class=\"panel\" id=\"coverage\"><h2>What was exercised</h2><p class=\"note\">{} of {} cells of {} were met by at \
         least one case; below, for every range of one of them, how many of its cells. All cells are in coverage.tsv.</p>\
         <div class=\"scroll\"><table class=\"spread\"><tbody>{}</tbody></table></div></section>",
        coverage.hit,
        coverage.cells,
        escape(&names.join(" × ")),
        axes.iter().enumerate().map(row).collect::<String>()
    )
}
