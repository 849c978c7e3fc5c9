//! The section on a baseline: which moves are outside its band, and how moves went from release to release.

use hairpin::campaign::report::ReportData;
use hairpin::judgement::moves::{Metric, MoveComparison, Outcome, ProgramComparison, Regression, Trend};

use super::escape::escape;

/// Rows of each table at most; all are in the answer of `judge --json`.
const ROWS: usize = 100;

/// The section; nothing where nothing was compared.
pub(super) fn section(data: &ReportData) -> String {
    let Some(regression) = &data.regression else { return String::new() };
    let (worse, better) = (regression.count(Outcome::Worse), regression.count(Outcome::Better));
    let baseline = regression.programs.first().map_or("", |one| one.comparison.baseline.as_str());
    format!(
        "<section class=\"panel\" id=\"regression\"><h2>Against {}</h2><p class=\"note\">{worse} of {} moves are worse than the \
         baseline's band, {better} better. The band is the spread of the repeats on both sides; times are from arrival to arrival.</p>{}{}</section>",
        escape(baseline),
        regression.moves(),
        outside(regression),
        trends(regression)
    )
}

/// In ms or mm.
fn small(metric: Metric, value: f64) -> String {
    match metric {
        Metric::Duration => format!("{:.1} ms", 1e3 * value),
        Metric::Deviation => format!("{:.3} mm", 1e3 * value),
    }
}

fn what(metric: Metric) -> &'static str {
    match metric {
        Metric::Duration => "time",
        Metric::Deviation => "deviation",
    }
}

fn outside(regression: &Regression) -> String {
    let programs = regression.programs.iter();
    let compared = programs.flat_map(|one| one.comparison.compared.iter().map(move |compared| (one, compared)));
    let mut found: Vec<_> = compared.filter(|(_, compared)| compared.outcome != Outcome::Same).collect();
    let beyond = |one: &MoveComparison| one.difference() / one.band;
    found.sort_by(|a, b| beyond(b.1).total_cmp(&beyond(a.1)));
    if found.is_empty() {
        return "<p>No move is outside the baseline's band.</p>".into();
    }
    let row = |(one, compared): &(&ProgramComparison, &MoveComparison)| {
        let of = |value| small(compared.metric, value);
        format!(
            "<tr><td>{}</td><th scope=\"row\">{}</th><td>{}</td><td>{}</td><td>{}</td><td>±{}</td><td>{}</td></tr>",
            escape(&one.program),
            escape(&compared.name),
            what(compared.metric),
            of(compared.baseline),
            of(compared.new),
            of(compared.band),
            if compared.outcome == Outcome::Worse { "worse" } else { "better" }
        )
    };
    format!(
        "<div class=\"scroll\"><table class=\"spread\"><thead><tr><th scope=\"col\">case</th><th scope=\"col\">move</th><th scope=\"col\">what</th>\
         <th scope=\"col\">baseline</th><th scope=\"col\">now</th><th scope=\"col\">band</th><th scope=\"col\"></th></tr></thead><tbody>{}</tbody></table></div>",
        found.iter().take(ROWS).map(row).collect::<String>()
    )
}

/// The moves that change most from release to release, by the share of themselves.
fn trends(regression: &Regression) -> String {
    let programs = regression.programs.iter();
    let all = programs.flat_map(|one| one.trends.iter().map(move |trend| (one, trend)));
    let share = |trend: &Trend| {
        let known: Vec<f64> = trend.means.iter().flatten().copied().collect();
        let mean = known.iter().sum::<f64>() / known.len().max(1) as f64;
        trend.slope.map_or(0.0, |slope| slope.abs() / mean.max(f64::MIN_POSITIVE))
    };
    let mut found: Vec<_> = all.filter(|(_, trend)| share(trend) > 0.0).collect();
    if found.is_empty() {
        return String::new();
    }
    found.sort_by(|a, b| share(b.1).total_cmp(&share(a.1)));
    let row = |(one, trend): &(&ProgramComparison, &Trend)| {
        let means = trend.means.iter().map(|mean| mean.map_or("–".into(), |mean| small(trend.metric, mean)));
        format!(
            "<tr><td>{}</td><th scope=\"row\">{}</th><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>",
            escape(&one.program),
            escape(&trend.name),
            what(trend.metric),
            means.collect::<Vec<_>>().join(" · "),
            trend.slope.map_or("–".into(), |slope| small(trend.metric, slope)),
            trend.correlation.map_or("–".into(), |correlation| format!("{correlation:+.2}"))
        )
    };
    format!(
        "<h3>From release to release</h3><p class=\"note\">{}: means, oldest first; median slope between all pairs of releases (Theil, Sen); \
         Spearman's correlation with the number of the release.</p><div class=\"scroll\"><table class=\"spread\"><thead><tr>\
         <th scope=\"col\">case</th><th scope=\"col\">move</th><th scope=\"col\">what</th><th scope=\"col\">means</th>\
         <th scope=\"col\">a release</th><th scope=\"col\">ρ</th></tr></thead><tbody>{}</tbody></table></div>",
        escape(&regression.releases.join(" · ")),
        found.iter().take(ROWS).map(row).collect::<String>()
    )
}
