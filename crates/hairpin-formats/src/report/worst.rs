//! The worst cases in full: what was found of each, the 3D view with its slider, and drawings that need no script.

use hairpin::campaign::digits::{number, signed_digits};
use hairpin::campaign::report::{Length, ReportData, Shown, violation};
use hairpin::judgement::Statistics;

use super::escape::escape;
use super::svg;
use hairpin::trajectory::ATTITUDE_UNKNOWN;
use serde_json::Value;

/// Cases that are drawn without the script at most.
const DRAWN: usize = 20;

/// The section; none if no case is shown in full.
pub(super) fn section(data: &ReportData) -> String {
    let Some(worst) = data.shown.first() else { return String::new() };
    let open = data.shown.iter().find(|shown| Some(shown.result.case) == data.opens).unwrap_or(worst);
    let about: String = data.shown.iter().enumerate().map(|(i, shown)| findings(data, shown, i)).collect();
    let views: String = data.shown.iter().take(DRAWN).map(|shown| figure(data, shown)).collect();
    let id = escape(&data.name(open.result.case));
    let is_of_logs = !data.logs.is_empty();
    let heights = if data.drawing.relief.is_some() { HEIGHTS } else { "<select id=\"high\" hidden></select>" };
    format!(
        "<section class=\"panel\" id=\"flight\"><div class=\"head\"><h2>{what} <span id=\"case-id\">{id}</span> \
         <span id=\"case-status\" class=\"status {status}\">{status}</span></h2>\
         <div class=\"pick js\"><button type=\"button\" id=\"before\" aria-label=\"previous case\">‹</button>\
         <label for=\"pick\">worst first</label><select id=\"pick\">{}</select>\
         <button type=\"button\" id=\"after\" aria-label=\"next case\">›</button></div></div>\
         <div class=\"js\"><p id=\"told\" class=\"told\"></p>{PICTURE}{legend}\
         <div class=\"tools\">{TOOLS}{heights}<button type=\"button\" id=\"png\">PNG</button></div>\
         <p class=\"note\" id=\"drawn-how\"></p>{KEYS}</div>{about}\
         <div class=\"js\">{commands}<code id=\"command\"></code> \
         <span id=\"copied\" class=\"note\" role=\"status\"></span>\
         <div id=\"series\" class=\"plot\"></div></div>\
         <p class=\"notice\">Tracks are <b>not aligned</b>: {clock}.</p>\
         {ground}{views}</section>",
        data.shown.iter().enumerate().map(|(i, shown)| option(data, shown, i)).collect::<String>(),
        status = open.result.status.word(),
        what = if is_of_logs { "Log" } else { "Case" },
        commands = if is_of_logs { "" } else { COMMANDS },
        clock = if is_of_logs {
            OF_LOGS
        } else {
            "what was planned and what was run stand in one frame and on one clock, as they were"
        },
        legend = legend(data),
        ground = svg::ground(&data.drawing),
    )
}

/// The canvases, and what moves in time.
const PICTURE: &str = "<div id=\"space\"><canvas id=\"gl\" tabindex=\"0\" role=\"img\" aria-label=\"The case in space; keys turn it, see below\"></canvas>\
    <canvas id=\"ink\" aria-hidden=\"true\"></canvas><p id=\"tip\" hidden></p></div>\
    <div class=\"slider\"><button type=\"button\" id=\"play\" aria-label=\"play\">▶</button>\
    <select id=\"speed\" aria-label=\"speed\"><option value=\"0.1\">0.1 ×</option><option value=\"0.25\">0.25 ×</option>\
    <option value=\"1\" selected>1 ×</option><option value=\"2\">2 ×</option><option value=\"5\">5 ×</option><option value=\"20\">20 ×</option></select>\
    <input type=\"range\" id=\"time\" min=\"0\" max=\"0\" value=\"0\" step=\"any\" aria-label=\"time\">\
    <button type=\"button\" id=\"worst-moment\">worst moment</button><output id=\"moment\" for=\"time\"></output></div>";

const TOOLS: &str = "<button type=\"button\" id=\"fit\">all of it</button><button type=\"button\" id=\"from-above\">from above</button>\
    <button type=\"button\" id=\"from-side\">from the side</button><label><input type=\"checkbox\" id=\"follow\"> follow</label>\
    <label><input type=\"checkbox\" id=\"ghost\" checked> plan’s ghost</label>";

/// Ground that is nearly flat shows nothing at its own heights.
const HEIGHTS: &str = "<label>heights <select id=\"high\"><option value=\"1\">as they are</option><option value=\"2\">2 ×</option>\
    <option value=\"5\">5 ×</option><option value=\"10\">10 ×</option></select></label>";

const KEYS: &str = "<details><summary>Mouse and keys</summary><p class=\"note\">Drag to turn, with shift or the right button to move, wheel or two \
    fingers to zoom; a click on the path goes to that moment. With the picture in focus: arrows turn, shift and arrows move, + and − zoom, 0 all \
    of it, t from above, s from the side, space plays, comma and full stop step, w worst moment, n and p next and previous case, f follow, g the \
    plan’s ghost.</p></details>";

/// What stands beside a log has a clock of its own.
const OF_LOGS: &str = "all stand in one frame, as they were; plan and simulation have clocks of their own, and are drawn from the first \
    judged moment of the log on";

const COMMANDS: &str = "<div class=\"tools\" id=\"commands\"><span>copy the command:</span><button type=\"button\" data-verb=\"replay\">replay</button>\
    <button type=\"button\" data-verb=\"shrink\">shrink</button><button type=\"button\" data-verb=\"export\">export</button>\
    <button type=\"button\" data-verb=\"report\">report of this case</button></div>";

/// A line's look and what it is, which a narrow page does not part.
fn key(look: &str, words: &str) -> String {
    format!("<span class=\"named\"><span class=\"key {look}\"></span>{words}</span>")
}

/// Under the picture, never over a curve.
fn legend(data: &ReportData) -> String {
    let others = data.shown.iter().any(|shown| !shown.others.is_empty());
    let others = if others { format!(" {}", key("other", data.beside.runs)) } else { String::new() };
    let scale = format!("{}, deviation 0 to <span id=\"scale-top\">–</span>", data.drawing.done);
    format!(
        "<p class=\"keys\">{} {}{others} {}</p>",
        key("scale", &scale),
        key("planned", "planned"),
        key("worst", "worst moment")
    )
}

fn option(data: &ReportData, shown: &Shown, index: usize) -> String {
    let mark = shown.moment.as_ref().map_or(shown.result.ended.as_str(), |moment| moment.mark.as_str());
    let status = shown.result.status.word();
    format!(
        "<option value=\"{index}\">{} · {} · {status}</option>",
        escape(&data.name(shown.result.case)),
        escape(mark)
    )
}

/// What is known of a case in words and numbers. Those that are not drawn without the script wait for it.
fn findings(data: &ReportData, shown: &Shown, index: usize) -> String {
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
    let drawn: Vec<String> =
        shown.result.drawn.iter().map(|(key, value)| format!("{key} = {}", short(value))).collect();
    let drawn = if drawn.is_empty() { "nominal values".to_owned() } else { drawn.join(", ") };
    let of = if data.logs.is_empty() {
        format!(
            "run {} ({}), {}, score {}",
            shown.result.run,
            escape(&drawn),
            escape(&shown.claim),
            number(Some(shown.score))
        )
    } else {
        format!("its plan: {}", escape(&shown.claim))
    };
    let list: String = findings.iter().map(|finding| format!("<li>{}</li>", escape(finding))).collect();
    format!(
        "<div class=\"findings\" data-case=\"{}\"{}><ul>{list}</ul>\
         <p class=\"note\">{of}</p>{}</div>",
        escape(&data.name(shown.result.case)),
        if index < DRAWN { "" } else { " hidden" },
        statistics(shown.statistics.as_ref(), &data.length)
    )
}

/// A value that was drawn, with the digits that people write.
fn short(value: &Value) -> String {
    match value {
        Value::Number(one) if !(one.is_i64() || one.is_u64()) => one.as_f64().map_or(one.to_string(), signed_digits),
        Value::Array(parts) => format!("[{}]", parts.iter().map(short).collect::<Vec<_>>().join(", ")),
        other => other.to_string(),
    }
}

/// A file of its own with top and side view of the case that the page opens with; nothing where no case is shown.
pub fn picture(data: &ReportData) -> Option<String> {
    let shown = data.shown.iter().find(|shown| Some(shown.result.case) == data.opens)?;
    let told = shown.moment.as_ref().map_or("", |moment| moment.told.as_str());
    let name = format!("case {}", data.name(shown.result.case));
    let title = escape(&format!("{}, {name}: {told}", data.title));
    Some(svg::picture(shown, &escape(&name), [&title, data.drawing.done], &data.drawing))
}

fn figure(data: &ReportData, shown: &Shown) -> String {
    let (what, id) = (if data.logs.is_empty() { "case" } else { "log" }, escape(&data.name(shown.result.case)));
    format!(
        "<figure class=\"case\" data-case=\"{id}\">{}<figcaption>{what} {id}: {} {} {} {}</figcaption></figure>",
        svg::views(shown, &format!("{what} {id}"), &data.drawing),
        key("flown", data.drawing.done),
        key("planned", "planned"),
        key("legs", "straight legs"),
        key("worst", "worst moment")
    )
}

fn statistics(found: Option<&Statistics>, length: &Length) -> String {
    let Some(s) = found else { return String::new() };
    let names = ["max", "mean", "median", "min", "rmse", "sse", "std"];
    // A sum of squares has a factor more, and digits of its own.
    let sse = number(Some(length.in_metre * length.in_metre * s.sse));
    let [max, mean, median, min, rmse, std] =
        [s.max, s.mean, s.median, s.min, s.rmse, s.std].map(|value| length.number(value));
    let values = [max, mean, median, min, rmse, sse, std];
    let head: String = names.iter().map(|name| format!("<th scope=\"col\">{name}</th>")).collect();
    let row: String = values.iter().map(|value| format!("<td>{value}</td>")).collect();
    format!(
        "<table class=\"statistics\"><caption>deviation of this run, {unit} (sse {unit}²), over its judged samples, each counting alike, not aligned</caption>\
         <thead><tr>{head}</tr></thead><tbody><tr>{row}</tr></tbody></table>",
        unit = length.unit
    )
}
