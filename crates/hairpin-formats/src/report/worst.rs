//! The worst cases in full: what was found of each, the 3D view with its slider, and drawings that need no script.

use hairpin::campaign::digits::number;
use hairpin::campaign::report::{ReportData, Shown, violation};
use hairpin::judgement::Statistics;

use super::escape::escape;
use super::svg;
use hairpin::trajectory::ATTITUDE_UNKNOWN;

/// The section; none if no case is shown in full.
pub(super) fn section(data: &ReportData) -> String {
    let Some(worst) = data.shown.first() else { return String::new() };
    let about: String = data.shown.iter().enumerate().map(|(i, shown)| findings(shown, i == 0)).collect();
    let views: String = data.shown.iter().enumerate().map(|(i, shown)| figure(data, shown, i == 0)).collect();
    let id = worst.result.case.to_string();
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
    format!("<option value=\"{index}\">{} · {deviation} · {status}</option>", shown.result.case)
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
        "<div class=\"findings\" data-case=\"{}\"{}><ul>{list}</ul>\
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
        "<figure class=\"case\" data-case=\"{}\"{}>{}\
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
