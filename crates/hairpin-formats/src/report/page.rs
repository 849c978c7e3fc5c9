//! The page around the data: everything inline, and a policy that lets nothing else run or load.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use hairpin::campaign::report::{COLUMNS, ReportData, Shown, cells, number, violation};
use hairpin::campaign::{CaseResult, Influence};
use hairpin::judgement::Statistics;
use sha2::{Digest, Sha256};

use super::more::{coverage, reruns};
use super::{data, progress, regression, svg};
use crate::executor::ATTITUDE_UNKNOWN;

const STYLE: &str = include_str!("page.css");
const SCRIPT: &str = include_str!("page.js");
/// Rows of the table at most; the rest is in `results.parquet`.
const ROWS: usize = 2000;

/// The whole file.
pub fn html(data: &ReportData) -> String {
    let plotly = plotly_source();
    // Plotly sets styles by script and makes an empty style sheet, which a policy can only allow as a whole; scripts
    // and loading are what could do harm, and none but these two run.
    let policy = format!(
        "default-src 'none'; script-src {} {}; style-src 'unsafe-inline'; img-src data: blob:; base-uri 'none'; form-action 'none'",
        hash(&plotly),
        hash(SCRIPT)
    );
    let body = body(data);
    let json = data::json(data);
    let title = escape(&format!("{} – {}", data.title, first_words(&data.verdict.sentence)));
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta http-equiv=\"Content-Security-Policy\" content=\"{policy}\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>{title}</title>\n<style>{STYLE}</style>\n</head>\n<body>\n{body}\n\
         <script type=\"application/json\" id=\"data\">{json}</script>\n\
         <script>{plotly}</script>\n<script>{SCRIPT}</script>\n</body>\n</html>\n"
    )
}

/// plotly.js as the plotly crate embeds it: the first of the script elements that it gives.
fn plotly_source() -> String {
    let sources = plotly::Plot::offline_js_sources();
    let start = sources.find('>').map_or(0, |at| at + 1);
    let end = sources[start..].find("</script>").map_or(sources.len(), |at| start + at);
    // A browser reads line ends as LF before it hashes.
    sources[start..end].replace("\r\n", "\n").replace('\r', "\n")
}

fn hash(script: &str) -> String {
    format!("'sha256-{}'", STANDARD.encode(Sha256::digest(script.as_bytes())))
}

fn body(data: &ReportData) -> String {
    let outcome = match data.verdict.exit_code {
        0 => ("pass", "✓"),
        1 => ("fail", "✕"),
        _ => ("open", "?"),
    };
    [
        format!(
            "<header class=\"verdict {}\"><p class=\"brand\">hairpin · stress test of <b>{}</b></p>\
             <h1><span class=\"mark\" aria-hidden=\"true\">{}</span>{}</h1><p class=\"frame\">{}</p></header>\n<main>",
            outcome.0,
            escape(&data.title),
            outcome.1,
            sentence(&data.verdict.sentence),
            frame(data)
        ),
        key_numbers(data),
        flight(data),
        table(data),
        distributions(data),
        progress::section(data),
        influences(data),
        regression::section(data),
        reruns(data),
        coverage(data),
        setup(data),
        "</main>\n<footer><p>hairpin is a test generator. What it writes is stressful by design and is no safety \
         certificate.</p></footer>"
            .into(),
    ]
    .join("\n")
}

/// The verdict with its first words apart, so that the outcome is read before the rest.
fn sentence(text: &str) -> String {
    let head = first_words(text);
    let rest = &text[head.len()..];
    format!("<span class=\"outcome\">{}</span> <span class=\"rest\">{}</span>", escape(head), escape(rest.trim_start()))
}

/// Frames and what is counted, before anything is read.
fn frame(data: &ReportData) -> String {
    let lines = data.frame.iter().map(|[label, value]| format!("<b>{}</b> {}", escape(label), escape(value)));
    lines.collect::<Vec<_>>().join(" · ")
}

/// Which parameter did it.
fn influences(data: &ReportData) -> String {
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

fn first_words(text: &str) -> &str {
    text.split(['(', ':']).next().unwrap_or(text).trim_end()
}

fn key_numbers(data: &ReportData) -> String {
    let card = |[label, value, note]: &[String; 3]| {
        format!(
            "<div class=\"card\"><p class=\"label\">{}</p><p class=\"value\">{}</p><p class=\"note\">{}</p></div>",
            escape(label),
            escape(value),
            escape(note)
        )
    };
    format!("<section class=\"cards\">{}</section>", data.key_numbers.iter().map(card).collect::<String>())
}

fn flight(data: &ReportData) -> String {
    let Some(worst) = data.shown.first() else { return String::new() };
    let about: String = data.shown.iter().enumerate().map(|(i, shown)| findings(shown, i == 0)).collect();
    let views: String = data.shown.iter().enumerate().map(|(i, shown)| figure(data, shown, i == 0)).collect();
    let id = format!("{:04}", worst.result.case);
    format!(
        "<section class=\"panel\" id=\"flight\"><div class=\"head\"><h2>Case <span id=\"case-id\">{id}</span></h2>\
         <div class=\"pick js\"><button type=\"button\" id=\"before\" aria-label=\"one case less bad\">‹</button>\
         <label for=\"pick\">worst cases</label><select id=\"pick\">{}</select>\
         <button type=\"button\" id=\"after\" aria-label=\"next case\">›</button></div></div>{about}\
         <div class=\"js\"><div id=\"space\" class=\"plot\"></div>\
         <div class=\"slider\"><button type=\"button\" id=\"worst-moment\">worst moment</button>\
         <input type=\"range\" id=\"time\" min=\"0\" max=\"0\" value=\"0\" step=\"1\" aria-label=\"time\">\
         <output id=\"moment\" for=\"time\"></output></div>\
         <div id=\"series\" class=\"plot\"></div></div>\
         <p class=\"notice\">Tracks are <b>not aligned</b>: planned and flown positions stand in one frame and on one clock, as they were.</p>\
         {views}</section>",
        data.shown.iter().enumerate().map(|(i, shown)| option(shown, i)).collect::<String>()
    )
}

fn option(shown: &Shown, index: usize) -> String {
    let measured = shown.result.measures.as_ref().map(|m| m.max_deviation);
    let deviation = measured.map_or(shown.result.ended.clone(), |d| format!("{} m", number(Some(d))));
    let status = shown.result.status.word();
    format!("<option value=\"{index}\">{:04} · {deviation} · {status}</option>", shown.result.case)
}

/// What is known of a case in words and numbers. All but the first wait for the script to be selected.
fn findings(shown: &Shown, first: bool) -> String {
    let mut findings: Vec<String> = shown.result.violations.iter().map(violation).collect();
    findings.extend(shown.result.message.clone());
    if findings.is_empty() {
        findings.push("within the specification".into());
    }
    let unknown = shown.flown.as_ref().is_some_and(|track| track.channel(ATTITUDE_UNKNOWN).is_some());
    if let Some(attitude) = shown.attitude.as_ref().filter(|_| !unknown) {
        findings.push(format!("at the worst moment: {attitude}"));
    }
    findings.extend(shown.environment.iter().cloned());
    let drawn: Vec<String> = shown.result.drawn.iter().map(|(key, value)| format!("{key} = {value}")).collect();
    let drawn = if drawn.is_empty() { "nominal values".to_owned() } else { drawn.join(", ") };
    let list: String = findings.iter().map(|finding| format!("<li>{}</li>", escape(finding))).collect();
    format!(
        "<div class=\"findings\" data-case=\"{:04}\"{}><ul>{list}</ul>\
         <p class=\"note\">run {} ({}), {}, score {}</p>{}</div>",
        shown.result.case,
        if first { "" } else { " hidden" },
        shown.result.run,
        escape(&drawn),
        escape(&shown.claim),
        number(Some(shown.score)),
        statistics(shown.statistics.as_ref())
    )
}

fn figure(data: &ReportData, shown: &Shown, first: bool) -> String {
    format!(
        "<figure class=\"case\" data-case=\"{:04}\"{}>{}\
         <figcaption><span class=\"key flown\"></span>{} <span class=\"key planned\"></span>planned \
         <span class=\"key legs\"></span>straight legs <span class=\"key worst\"></span>worst moment</figcaption></figure>",
        shown.result.case,
        if first { "" } else { " hidden" },
        svg::views(shown, &data.drawing),
        if data.drawing.relief.is_some() { "driven" } else { "flown" }
    )
}

fn statistics(found: Option<&Statistics>) -> String {
    let Some(s) = found else { return String::new() };
    let names = ["max", "mean", "median", "min", "rmse", "sse", "std"];
    let values = [s.max, s.mean, s.median, s.min, s.rmse, s.sse, s.std];
    let head: String = names.iter().map(|name| format!("<th scope=\"col\">{name}</th>")).collect();
    let row: String = values.iter().map(|value| format!("<td>{}</td>", number(Some(*value)))).collect();
    format!(
        "<table class=\"statistics\"><caption>deviation of this run, m (sse m²), over its judged samples, not aligned</caption>\
         <thead><tr>{head}</tr></thead><tbody><tr>{row}</tr></tbody></table>"
    )
}

fn table(data: &ReportData) -> String {
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

fn distributions(data: &ReportData) -> String {
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

fn setup(data: &ReportData) -> String {
    let facts: String = data
        .facts
        .iter()
        .map(|[label, value]| format!("<dt>{}</dt><dd>{}</dd>", escape(label), escape(value)))
        .collect();
    let assumptions: String = data.assumptions.iter().map(|line| format!("<li>{}</li>", escape(line))).collect();
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
    // Of an arm the 3D view shows all there is.
    let drawn = !data.drawing.rotors.is_empty() || !data.drawing.wheels.is_empty() || data.drawing.relief.is_some();
    let robot = if drawn {
        format!("<figure>{}<figcaption>{caption}</figcaption></figure>", svg::robot(&data.drawing))
    } else {
        String::new()
    };
    format!(
        "<section class=\"panel\" id=\"setup\"><h2>How it was tested</h2><div class=\"columns\"><dl>{facts}</dl>{robot}</div></section>\n{assumptions}"
    )
}

pub(super) fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            '\n' | '\t' => escaped.push(' '),
            c if c.is_control() => {}
            c => escaped.push(c),
        }
    }
    escaped
}
