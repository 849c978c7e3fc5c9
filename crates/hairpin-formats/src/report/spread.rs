//! How measures are spread over all cases, and which of the parameters that vary did it.

use hairpin::campaign::Influence;
use hairpin::campaign::digits::number;
use hairpin::campaign::report::ReportData;
use hairpin::judgement::Statistics;

use super::escape::escape;

/// Distribution of every metric.
pub(super) fn distributions(data: &ReportData) -> String {
    if data.metrics.is_empty() {
        return String::new();
    }
    let head = "<tr><th scope=\"col\">measure</th><th scope=\"col\">limit</th><th scope=\"col\">max</th><th scope=\"col\">mean</th>\
                <th scope=\"col\">median</th><th scope=\"col\">min</th><th scope=\"col\">rmse</th><th scope=\"col\">sse</th><th scope=\"col\">std</th></tr>";
    let rows: String = data
        .metrics
        .iter()
        .filter_map(|metric| Statistics::of(&metric.values).map(|statistics| (metric, statistics)))
        .map(|(metric, s)| {
            let values = [
                metric.limit,
                Some(s.max),
                Some(s.mean),
                Some(s.median),
                Some(s.min),
                Some(s.rmse),
                Some(s.sse),
                Some(s.std),
            ];
            let values: String = values.iter().map(|value| format!("<td>{}</td>", number(*value))).collect();
            format!(
                "<tr><th scope=\"row\">{} <span class=\"note\">{}</span></th>{values}</tr>",
                metric.name, metric.unit
            )
        })
        .collect();
    format!(
        "<section class=\"panel\" id=\"distributions\"><h2>Over all cases</h2>\
         <div class=\"js\"><div id=\"share\" class=\"plot\"></div><div id=\"spread\" class=\"plot\"></div></div>\
         <div class=\"scroll\"><table class=\"spread\"><thead>{head}</thead><tbody>{rows}</tbody></table></div></section>"
    )
}

/// Which parameter did it.
pub(super) fn influences(data: &ReportData) -> String {
    if data.influences.is_empty() {
        return String::new();
    }
    let row = |found: &Influence| {
        let (rank, runs) = (found.rank_correlation, found.runs);
        format!("<tr><th scope=\"row\">{}</th><td>{rank:+.2}</td><td>{runs}</td></tr>", escape(&found.key))
    };
    format!(
        "<section class=\"panel\" id=\"influences\"><h2>Which parameter did it</h2><p class=\"note\">Spearman's rank \
         correlation of what was varied with the run's largest deviation, over all runs: +1 where more of it always gave \
         a larger deviation, −1 where less of it did, 0 where it did not matter.</p><div class=\"scroll\">\
         <table class=\"spread\"><thead><tr><th scope=\"col\">parameter</th><th scope=\"col\">ρ</th>\
         <th scope=\"col\">runs</th></tr></thead><tbody>{}</tbody></table></div></section>",
        data.influences.iter().map(row).collect::<String>()
    )
}
