//! `day-card.html`: what a crew takes to the field, a page a flight, to be printed. No script, and nothing loaded.

use hairpin::campaign::kind::Drawing;
use hairpin::campaign::report::Shown;

use super::escape::escape;
use super::svg::views;

const STYLE: &str = include_str!("day_card.css");
const POLICY: &str =
    "default-src 'none'; style-src 'unsafe-inline'; img-src data:; base-uri 'none'; form-action 'none'";

/// The flights of a day.
#[derive(Debug, Clone, PartialEq)]
pub struct DayCard {
    /// What flies.
    pub title: String,
    /// How they were chosen, and what else is true of all of them, a sentence each.
    pub told: Vec<String>,
    /// When a flight is ended, a sentence each.
    pub abort: Vec<String>,
    /// In the order in which they are flown.
    pub flights: Vec<FlightCard>,
}

/// One of them.
#[derive(Debug, Clone, PartialEq)]
pub struct FlightCard {
    /// The case and its worst run.
    pub shown: Shown,
    /// What stands around it.
    pub drawing: Drawing,
    /// Label and value: what is to be expected and watched.
    pub rows: Vec<[String; 2]>,
}

/// The whole file.
pub fn day_card_html(card: &DayCard) -> String {
    let title = escape(&format!("Day card: {}", card.title));
    let pages: String = card.flights.iter().enumerate().map(|(index, flight)| page(card, index, flight)).collect();
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\" data-ready=\"1\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta http-equiv=\"Content-Security-Policy\" content=\"{POLICY}\">\n\
         <title>{title}</title>\n<style>{STYLE}</style>\n</head>\n<body>\n{pages}</body>\n</html>\n"
    )
}

fn page(card: &DayCard, index: usize, flight: &FlightCard) -> String {
    let FlightCard { shown, drawing, rows } = flight;
    let line = |[label, value]: &[String; 2]| format!("<tr><th>{}</th><td>{}</td></tr>", escape(label), escape(value));
    let rows: String = rows.iter().map(line).collect();
    let list = |sentences: &[String]| -> String {
        sentences.iter().map(|sentence| format!("<li>{}</li>", escape(sentence))).collect()
    };
    format!(
        "<section class=\"flight\" id=\"case-{case}\">\n<h1>{title}: flight {number} of {of}, case {case}</h1>\n{views}\n\
         <p class=\"key\">dotted: straight legs; dashed: plan; line: the worst run; ring: its worst moment</p>\n\
         <table>{rows}</table>\n<h2>End the flight when</h2>\n<ul>{abort}</ul>\n<h2>Known beforehand</h2>\n<ul>{told}</ul>\n\
         <p class=\"sign\">Flown at ________ by ________ &nbsp; log ________ &nbsp; ended ________</p>\n</section>\n",
        case = shown.result.case,
        title = escape(&card.title),
        number = index + 1,
        of = card.flights.len(),
        views = views(shown, &format!("case {}", shown.result.case), drawing),
        abort = list(&card.abort),
        told = list(&card.told),
    )
}
