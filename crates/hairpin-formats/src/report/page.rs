//! The page around the data: everything inline, and a policy that lets nothing else run or load.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use hairpin::campaign::report::ReportData;
use sha2::{Digest, Sha256};

use super::escape::escape;
use super::more::{coverage, reruns};
use super::spread::{distributions, influences};
use super::{cases, data, progress, regression, setup, worst};

const STYLE: &str = include_str!("page.css");
const SCRIPT: &str = include_str!("page.js");

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
        0 if !data.verdict.sentence.starts_with("UNJUDGED") => ("pass", "✓"),
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
        worst::section(data),
        cases::section(data),
        distributions(data),
        progress::section(data),
        influences(data),
        regression::section(data),
        reruns(data),
        coverage(data),
        setup::section(data),
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
