//! The tables as EXPERIMENTS.md shows them.

use std::fmt::Write;

use super::lifts::{CellLifts, Lifts, WayLifts};
use super::size::Size;
use super::statistics::Lift;
use super::tables::{default_of, met};

/// Columns of a table, and a row of it for a cell.
type Rows<'a> = (&'a [&'a str], &'a dyn Fn(&CellLifts) -> Option<Vec<String>>);

/// All tables, each with a sentence before it; what was not measured at the end.
pub(super) fn markdown(lifts: &Lifts, size: &Size, refused: &[String]) -> String {
    let mut text = format!(
        "{} independent runs a cell, {} cases a run, {} executions a case (fewer where a cell says so); seeds from `{}`. What is kept was executed \
         {} times afresh, with noise and draws of its own. Lifts are ratios of geometric means with 95 % bootstrap intervals over runs.\n",
        size.runs,
        size.cases,
        size.executions,
        size.seed_of(),
        size.fresh
    );
    let summary = [
        "cell",
        "single random one",
        "best of as many random executions",
        "default",
        "default over the best of as many, %",
        "the same, ended by themselves",
        "p (Holm)",
        "Â₁₂",
        "over single ones, %",
        "the same, ended by themselves",
        "met",
    ];
    put(
        &mut text,
        lifts,
        "The default over random trajectories.",
        (&summary, &|cell| {
            let own = default_of(cell)?;
            let mut row = vec![number(cell.single.level)];
            row.push(format!("{} (of {})", number(cell.best.level), cell.best_of));
            row.extend([number(own.side.level), lift(own.over_best), lift(own.over_best_ended)]);
            row.push(own.p.map_or("–".into(), |p| format!("{p:.4}")));
            row.push(format!("{:.2}", own.a12));
            row.extend([lift(own.over_single), lift(own.over_single_ended)]);
            row.push(if met(own) { "yes" } else { "**no**" }.into());
            Some(row)
        }),
    );
    let ways = ["cell", "each way over the best of as many random executions, % (Â₁₂; executions a case)"];
    put(
        &mut text,
        lifts,
        "All ways.",
        (&ways, &|cell| {
            let one = |own: &WayLifts| match &own.refused {
                Some(why) if own.over_best.is_none() => format!("{}: {why}", own.way.word()),
                _ => format!("{}: {} ({:.2}; {:.0})", own.way.word(), lift(own.over_best), own.a12, own.executions),
            };
            Some(vec![cell.ways.iter().map(one).collect::<Vec<_>>().join("; ")])
        }),
    );
    put(
        &mut text,
        lifts,
        "The default over other ways, at equal executions.",
        (&["cell", "default over …, %"], &|cell| {
            let told = cell.behind.iter().map(|(way, over)| format!("{}: {}", way.word(), lift(*over)));
            let told: Vec<String> = told.collect();
            (!told.is_empty()).then(|| vec![told.join("; ")])
        }),
    );
    let ends = ["cell", "single", "best of as many", "default"];
    put(
        &mut text,
        lifts,
        "Crashes and time-outs, % of the fresh executions.",
        (&ends, &|cell| {
            let share = |[crashed, timed_out]: [f64; 2]| format!("{:.1}, {:.1}", 100.0 * crashed, 100.0 * timed_out);
            let own = default_of(cell)?;
            Some([&cell.single, &cell.best, &own.side].map(|side| share(side.ends)).to_vec())
        }),
    );
    let default_run = [
        "cell",
        "runs whose worst is ahead of ten times their executions by chance",
        "first violation at execution (by chance)",
        "processor time over that of as many random executions (of kept ones)",
    ];
    put(
        &mut text,
        lifts,
        "A default run. The limit of the first violation is what 5 % of its random executions break.",
        (&default_run, &|cell| {
            let [ahead, pairs] = cell.pairs;
            let at = |at: f64| if at.is_finite() { format!("{at:.0}") } else { "never".into() };
            let first =
                cell.first_violation.map_or("–".into(), |[own, chance]| format!("{} ({})", at(own), at(chance)));
            let cost = cell.cost.map_or("–".into(), |[random, kept]| format!("{random:.2} ({kept:.2})"));
            Some(vec![if pairs == 0 { "–".into() } else { format!("{ahead} of {pairs}") }, first, cost])
        }),
    );
    for mean in &lifts.means {
        let told = |[value, low, high]: [f64; 3]| interval(value, low, high);
        let _ = write!(
            text,
            "\nMean of {} cells, {}, `{}` over single random trajectories: {} %; ended by themselves: {} %.\n",
            mean.cells,
            mean.name,
            mean.way.word(),
            told(mean.over_single),
            told(mean.over_single_ended)
        );
    }
    for why in refused {
        let _ = write!(text, "\n{why}\n");
    }
    text
}

/// A table under `title`, if it has a row.
fn put(text: &mut String, lifts: &Lifts, title: &str, (columns, row): Rows) {
    let rows = lifts.cells.iter().filter_map(|cell| Some((cell, row(cell)?)));
    let rows: Vec<String> = rows.map(|(cell, row)| format!("| {} | {} |\n", cell.name, row.join(" | "))).collect();
    if rows.is_empty() {
        return;
    }
    let rule = columns.iter().map(|_| "---").collect::<Vec<_>>().join(" | ");
    let _ = write!(text, "\n{title}\n\n| {} |\n| {rule} |\n{}", columns.join(" | "), rows.concat());
}

/// `+41 (20 to 60)`.
fn lift(lift: Option<Lift>) -> String {
    lift.map_or("–".into(), |lift| interval(lift.value, lift.interval[0], lift.interval[1]))
}

fn interval(value: f64, low: f64, high: f64) -> String {
    let percent = |share: f64| format!("{:.0}", 100.0 * share).replace('-', "−");
    let sign = if value >= 0.0 { "+" } else { "" };
    format!("{sign}{} ({} to {})", percent(value), percent(low), percent(high))
}

/// Three digits.
fn number(value: f64) -> String {
    if !value.is_finite() {
        return "–".into();
    }
    let digits = (2.0 - libm::floor(libm::log10(value.abs().max(1e-3)))).max(0.0);
    format!("{value:.*}", digits as usize)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_told_as_in_the_document() {
        assert_eq!(interval(0.412, 0.2, 0.6), "+41 (20 to 60)");
        assert_eq!(interval(-0.03, -0.14, 0.08), "−3 (−14 to 8)");
        assert_eq!([4.083, 0.1234, 12.34, f64::NAN].map(number), ["4.08", "0.123", "12.3", "–"]);
        assert_eq!(lift(None), "–");
    }
}
