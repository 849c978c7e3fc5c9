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
/// Checked for their types by tests/run (`view/tsconfig.json`).
const SCRIPTS: [&str; 3] =
    [include_str!("view/scene.js"), include_str!("view/charts.js"), include_str!("view/page.js")];

/// The whole file.
pub fn html(data: &ReportData) -> String {
    let script = script();
    // Nothing is loaded, no style but this one is taken, and no script but this one runs.
    let policy = format!(
        "default-src 'none'; script-src {}; style-src {}; img-src data:; base-uri 'none'; form-action 'none'",
        hash(&script),
        hash(STYLE)
    );
    let body = body(data);
    let json = data::json(data);
    let title = escape(&format!("{} – {}", data.title, first_words(&data.verdict.sentence)));
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta http-equiv=\"Content-Security-Policy\" content=\"{policy}\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <meta name=\"color-scheme\" content=\"light dark\">\n\
         <title>{title}</title>\n<style>{STYLE}</style>\n</head>\n<body>\n{body}\n\
         <script type=\"application/json\" id=\"data\">{json}</script>\n\
         <script>{script}</script>\n</body>\n</html>\n"
    )
}

/// Its three files share one scope, and leave nothing outside of it.
fn script() -> String {
    format!("\"use strict\";\n{{\n{}\n}}\n", SCRIPTS.concat())
}

fn hash(text: &str) -> String {
    format!("'sha256-{}'", STANDARD.encode(Sha256::digest(text.as_bytes())))
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
