//! The table of cases, the worst first.

use hairpin::campaign::CaseResult;
use hairpin::campaign::report::{ReportData, cells_in, columns_in, violation};

use super::escape::escape;

/// Rows of the table at most; the rest is in `results.parquet`.
const ROWS: usize = 2000;

/// The section.
pub(super) fn section(data: &ReportData) -> String {
    let head: String = columns_in(&data.length)
        .into_iter()
        .chain(["finding".to_owned(), "evidence".to_owned()])
        .map(|name| format!("<th scope=\"col\" aria-sort=\"none\"><button type=\"button\">{name}</button></th>"))
        .collect();
    let rows: String = data.results.iter().take(ROWS).map(|result| row(data, result)).collect();
    let left = data.results.len().saturating_sub(ROWS);
    let more =
        if left == 0 { String::new() } else { format!(" The other {left} are in <code>results.parquet</code>.") };
    let open = match data.results.len() - data.shown.len() {
        0 => "Each opens above.".to_owned(),
        _ => format!("{} of them open above; the command of the others makes a report with them.", data.shown.len()),
    };
    let (what, row) = match data.logs.is_empty() {
        true => (
            "Cases, the worst first",
            "Each row is a case: of several runs each measure is the worst of all, the rest is of the worst run. Mean deviations are over time.",
        ),
        false => ("Logs, the worst first", "Each row is a log. Mean deviations are over time."),
    };
    format!(
        "<section class=\"panel\" id=\"cases\"><h2>{what}</h2><p class=\"note\">{row} {open}{more}</p>\
         <p id=\"chosen\" hidden><span id=\"chosen-words\"></span> <button type=\"button\" id=\"all-cases\">all cases</button></p>\
         <div class=\"scroll\"><table class=\"cases\"><thead><tr>{head}</tr></thead><tbody>{rows}</tbody></table></div></section>"
    )
}

fn row(data: &ReportData, result: &CaseResult) -> String {
    let shown = data.shown.iter().find(|shown| shown.result.case == result.case);
    let mut cells = cells_in(&data.length, result);
    cells[0] = data.name(result.case);
    let text: String = cells
        .iter()
        .enumerate()
        .map(|(column, cell)| match (column, shown) {
            (0, Some(_)) => format!("<td><a href=\"#{0}\">{0}</a></td>", escape(cell)),
            (0, None) => format!(
                "<td>{0} <button type=\"button\" class=\"js\" data-verb=\"report\" data-of=\"{0}\">copy: report --case {0}</button></td>",
                escape(cell)
            ),
            (1, _) => format!("<td><span class=\"status {cell}\">{cell}</span></td>"),
            _ => format!("<td>{}</td>", escape(cell)),
        })
        .collect();
    // What is open has a reason; of an executor's message the first line tells.
    let reason = || result.message.as_deref().and_then(|why| why.lines().next()).map_or("–".to_owned(), str::to_owned);
    let finding = result.violations.first().map_or_else(reason, violation);
    let class = if shown.is_some() { " class=\"shown\"" } else { "" };
    let claim = data.claims.get(&result.case).map_or("–", String::as_str);
    let id = escape(&cells[0]);
    format!("<tr{class} data-case=\"{id}\">{text}<td>{}</td><td>{}</td></tr>", escape(&finding), escape(claim))
}
