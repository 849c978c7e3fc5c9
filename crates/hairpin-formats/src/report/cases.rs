//! The table of cases, the worst first.

use hairpin::campaign::CaseResult;
use hairpin::campaign::report::{COLUMNS, ReportData, cells};

use super::escape::escape;

/// Rows of the table at most; the rest is in `results.parquet`.
const ROWS: usize = 2000;

/// The section.
pub(super) fn section(data: &ReportData) -> String {
    let head: String = COLUMNS
        .iter()
        .chain(&["evidence"])
        .map(|name| format!("<th scope=\"col\" aria-sort=\"none\"><button type=\"button\">{name}</button></th>"))
        .collect();
    let rows: String = data.results.iter().take(ROWS).map(|result| row(data, result)).collect();
    let left = data.results.len().saturating_sub(ROWS);
    let more =
        if left == 0 { String::new() } else { format!(" The other {left} are in <code>results.parquet</code>.") };
    let shown = data.shown.len();
    format!(
        "<section class=\"panel\" id=\"cases\"><h2>Cases, the worst first</h2><p class=\"note\">Each row is a case's worst \
         run. The {shown} worst can be selected and are drawn above.{more}</p>\
         <div class=\"scroll\"><table class=\"cases\"><thead><tr>{head}</tr></thead><tbody>{rows}</tbody></table></div></section>"
    )
}

fn row(data: &ReportData, result: &CaseResult) -> String {
    let shown = data.shown.iter().position(|shown| shown.result.case == result.case);
    let cells = cells(result);
    let text: String = cells
        .iter()
        .enumerate()
        .map(|(column, cell)| match (column, shown) {
            (0, Some(index)) => {
                format!("<td><button type=\"button\" data-index=\"{index}\">{}</button></td>", escape(cell))
            }
            (1, _) => format!("<td><span class=\"status {cell}\">{cell}</span></td>"),
            _ => format!("<td>{}</td>", escape(cell)),
        })
        .collect();
    let class = if shown.is_some() { " class=\"shown\"" } else { "" };
    let claim = data.claims.get(&result.case).map_or("–", String::as_str);
    format!("<tr{class} data-case=\"{}\">{text}<td>{}</td></tr>", cells[0], escape(claim))
}
