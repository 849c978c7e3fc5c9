//! How measures are spread over all cases, and which of the parameters that vary did it.

use std::collections::BTreeSet;

use hairpin::campaign::Influence;
use hairpin::campaign::digits::number;
use hairpin::campaign::report::ReportData;
use hairpin::judgement::{Statistics, told};
use serde_json::Value;

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
        .filter_map(|metric| {
            Statistics::of(&metric.values.iter().copied().flatten().collect::<Vec<f64>>())
                .map(|statistics| (metric, statistics))
        })
        .map(|(metric, s)| {
            let values = [s.max, s.mean, s.median, s.min, s.rmse, s.sse, s.std];
            // With the digits of a limit: its own, or of lengths that of the deviation.
            let of_lengths = data.length.limit.filter(|_| metric.unit == data.length.unit);
            let digits = metric.limit.or(of_lengths);
            let digits = |value: f64| match digits {
                Some(limit) => told(value, Some(limit), metric.unit),
                None => number(Some(value)),
            };
            let values: String = values.map(|value| format!("<td>{}</td>", digits(value))).concat();
            let limit = metric.limit.map_or("–".into(), |limit| told(limit, Some(limit), metric.unit));
            format!(
                "<tr><th scope=\"row\">{} <span class=\"note\">{}</span></th><td>{limit}</td>{values}</tr>",
                metric.name, metric.unit
            )
        })
        .collect();
    let random = data.metrics.iter().any(|metric| !metric.random.is_empty());
    let (random, beside) = match random {
        true => (
            format!(" (grey: {})", data.beside.cases),
            format!(" Grey bars: {}, the shares of as many as there are.", data.beside.cases),
        ),
        false => (String::new(), String::new()),
    };
    let names: Vec<String> = data.metrics.iter().map(|metric| format!("{} {}", metric.name, metric.unit)).collect();
    let drawn: BTreeSet<String> =
        data.results.iter().flat_map(|result| result.drawn.iter().flat_map(numbers)).collect();
    let across = choice(&names, &drawn, 1.min(names.len() - 1));
    let upward = choice(&names, &drawn, 0);
    format!(
        "<section class=\"panel\" id=\"distributions\"><h2>Over all {}</h2>\
         <div class=\"js\"><p class=\"note\">Share of cases over a limit of the deviation{random}.</p><div id=\"share\" class=\"plot\"></div>\
         <p class=\"note\">One value per case; a bar chooses its cases in the table.{beside}</p><div id=\"spread\"></div>\
         <p class=\"tools\"><label>across <select id=\"across\">{across}</select></label> <label>upward <select id=\"upward\">{upward}</select></label> \
         <span class=\"note\">a dot is a case (a square violates) and opens it</span></p><div id=\"scatter\" class=\"plot\"></div></div>\
         <div class=\"scroll\"><table class=\"spread\"><thead>{head}</thead><tbody>{rows}</tbody></table></div></section>",
        if data.logs.is_empty() { "cases" } else { "logs" }
    )
}

/// The numbers in a drawn value, in the names that the page's data have for them.
fn numbers((key, value): &(String, Value)) -> Vec<String> {
    match value {
        Value::Number(_) => vec![key.clone()],
        Value::Array(parts) => {
            (0..parts.len()).filter(|i| parts[*i].is_number()).map(|i| format!("{key}[{i}]")).collect()
        }
        _ => Vec::new(),
    }
}

/// Measures and draws to choose from, by their place in the page's data.
fn choice(metrics: &[String], drawn: &BTreeSet<String>, chosen: usize) -> String {
    let option = |(i, name): (usize, &String)| {
        format!("<option value=\"{i}\"{}>{}</option>", if i == chosen { " selected" } else { "" }, escape(name))
    };
    metrics.iter().chain(drawn).enumerate().map(option).collect()
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
