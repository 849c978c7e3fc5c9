//! What executions in the loop came to, as they went on.

use hairpin::campaign::digits::number;
use hairpin::campaign::report::ReportData;
use hairpin::campaign::{Curve, RoundTally};
use hairpin::judgement::Stress;

use super::escape::escape;
use crate::figure::{Axis, Figure, Marks, Point, Scale, Series};

/// Places along the curves.
const PLACES: u64 = 240;

/// The best-so-far curve and, of adaptive campaigns, the rounds.
pub(super) fn section(data: &ReportData) -> String {
    let Some(figure) = figure(data) else { return String::new() };
    // A figure that cannot be drawn leaves the table, and the file.
    let drawn = figure.svg().unwrap_or_default();
    let place = match data.curves.len() {
        1 => "over executions".to_owned(),
        graphs => {
            format!("in each of {graphs} graphs, over executions in that graph; one that ended earlier keeps its last")
        }
    };
    format!(
        "<section class=\"panel\" id=\"progress\"><h2>Stress against executions</h2><p class=\"note\">The largest {} executed so far, \
         {place}. Every rise is in best-so-far.tsv.</p><figure>{drawn}</figure>{}</section>",
        in_words(data),
        rounds(&data.rounds)
    )
}

/// What the curves are of, in words; of a distance, whose least is the worst, with the sign that the numbers have.
fn in_words(data: &ReportData) -> String {
    match (data.told_in.as_str(), data.stress) {
        ("margin_in_spreads", _) => "margin to a limit (above 0: beyond it)".into(),
        ("target", _) => "value of your target".into(),
        (_, Stress::Clearance) => "negative clearance (above 0: so deep in an obstacle)".into(),
        (_, other) => other.word().replace('-', " "),
    }
}

/// The unit of the curves, behind a comma; empty where they have none.
fn unit(data: &ReportData) -> String {
    match (data.told_in.as_str(), data.stress.unit()) {
        ("margin_in_spreads", _) => ", spreads of random cases".into(),
        ("target", _) | (_, "") => String::new(),
        (_, unit) => format!(", {unit}"),
    }
}

fn figure(data: &ReportData) -> Option<Figure> {
    let last = data.curves.iter().map(|curve| curve.executions).max().filter(|last| *last > 0)?;
    let so_far = |curve: &Curve, at: u64| curve.after(at.min(curve.executions));
    let places: Vec<u64> = (1..=last).step_by(last.div_ceil(PLACES) as usize).chain([last]).collect();
    let series = |name: &str, of: fn(&[f64]) -> f64| {
        let point = |&at: &u64| {
            let values: Vec<f64> = data.curves.iter().filter_map(|curve| so_far(curve, at)).collect();
            (!values.is_empty()).then(|| Point::new(at as f64, of(&values)))
        };
        Series { name: name.into(), marks: Marks::Curve(places.iter().filter_map(point).collect()) }
    };
    let mean = series("mean of the graphs", |values| values.iter().sum::<f64>() / values.len() as f64);
    let largest = series("largest", |values| values.iter().copied().fold(f64::NEG_INFINITY, f64::max));
    let least = series("least", |values| values.iter().copied().fold(f64::INFINITY, f64::min));
    Some(Figure {
        title: String::new(),
        x: Axis { label: "executions in a graph".into(), scale: Scale::Linear },
        y: Axis { label: format!("largest {} so far{}", in_words(data), unit(data)), scale: Scale::Linear },
        series: if data.curves.len() > 1 { vec![mean, largest, least] } else { vec![mean] },
    })
}

fn rounds(rounds: &[RoundTally]) -> String {
    if rounds.is_empty() {
        return String::new();
    }
    let head = [
        "round",
        "executions",
        "of these drawn",
        "by hand",
        "R²",
        "ρ of the largest",
        "mean drawn",
        "mean by hand",
        "mean chosen",
        "largest so far",
        "mean of the graphs",
    ];
    let head: String = head.iter().map(|name| format!("<th scope=\"col\">{name}</th>")).collect();
    let row = |(place, round): (usize, &RoundTally)| {
        let means = [round.drawn_mean, round.by_hand_mean, round.chosen_mean];
        let numbers = [&[round.r2, round.rank_correlation][..], &means, &[round.largest, round.mean_largest]].concat();
        let numbers: String = numbers.iter().map(|value| format!("<td>{}</td>", number(*value))).collect();
        let note = round.unlearned.as_ref().map_or(String::new(), |why| format!(" (learned nothing: {})", escape(why)));
        format!(
            "<tr><th scope=\"row\">{place}{note}</th><td>{}</td><td>{}</td><td>{}</td>{numbers}</tr>",
            round.executions, round.drawn, round.by_hand
        )
    };
    format!(
        "<p class=\"note\">Each round but the first chose by a model of all executions before it; R² and ρ (Spearman's, of the largest \
         stress of a trajectory) are on trajectories that were held out.</p><div class=\"scroll\"><table class=\"spread\"><thead>\
         <tr>{head}</tr></thead><tbody>{}</tbody></table></div>",
        rounds.iter().enumerate().map(row).collect::<String>()
    )
}
