//! Figure 7: how the largest deviation, the largest acceleration and the time of feasible trajectories are spread,
//! generated without a score. The paper finds all three skewed to the right; here skewness is told with them.

use hairpin::judgement::{Statistics, Stress, skewness};
use hairpin_formats::figure::{Axis, Figure, Marks, Point, Scale, Series, Spread, Table};
use hairpin_jobs::{Problem, Watch};
use serde::Deserialize;

use super::cell::{self, FLIGHT_GOGGLES, text};
use crate::experiment::outcome::Outcome;
use crate::experiment::sheet::Sheet;
use crate::experiment::watched::go_on;

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Size {
    /// Trajectories per feasible set, each from a graph of its own.
    graphs: u64,
    length: u64,
    seed: u64,
    reach: Vec<String>,
    controller: String,
    /// What deviations are measured from: leg | nearest-leg.
    from: String,
    /// Bars of a histogram.
    bars: usize,
}

const METRICS: [(Stress, &str); 3] = [
    (Stress::MaxDeviation, "largest deviation, m"),
    (Stress::MaxAcceleration, "largest acceleration, m/s²"),
    (Stress::Time, "total time, s"),
];

/// How three metrics are spread over trajectories without a score.
pub(in super::super) fn metrics(sheet: &Sheet, watch: &dyn Watch) -> Result<Outcome, Problem> {
    let size: Size = sheet.size()?;
    let mut table = Table::new(&[
        "metric",
        "unit",
        "reach",
        "trajectories",
        "mean",
        "deviation",
        "least",
        "lower_quartile",
        "median",
        "upper_quartile",
        "greatest",
        "skewness",
    ]);
    let mut spreads: Vec<Vec<(String, Vec<f64>)>> = vec![Vec::new(); METRICS.len()];
    for reach in &size.reach {
        let sets = [
            ("seed", size.seed.to_string()),
            ("task.length", size.length.to_string()),
            ("generate.reach", text(reach)),
            cell::resolution(reach),
            ("generate.score", text("random")),
            ("generate.search.method", text("beam")),
            ("generate.search.cases", size.graphs.to_string()),
            ("execute.controller", text(&size.controller)),
            ("execute.segment_times", text("sqrt-length")),
            ("spec.deviation.from", text(&size.from)),
        ];
        let setup = cell::setup(FLIGHT_GOGGLES, &sets, None)?;
        go_on(watch)?;
        let flown = cell::flown(&setup, &cell::cases(&setup, watch)?, METRICS.map(|(stress, _)| stress), watch)?;
        for (spread, flown) in spreads.iter_mut().zip(flown) {
            spread.push((reach.clone(), flown.stresses));
        }
    }
    let mut figures = Vec::new();
    for (sets, (stress, label)) in spreads.iter().zip(METRICS) {
        for (reach, values) in sets {
            let Some(Spread { five, .. }) = Spread::of(0.0, values) else { continue };
            let told = Statistics::of(values);
            let mut row = vec![stress.word().into(), stress.unit().into(), reach.as_str().into(), values.len().into()];
            row.extend([told.map(|told| told.mean), told.map(|told| told.std)].map(Into::into));
            row.extend(five.map(Into::into));
            row.push(skewness(values).into());
            table.push(row);
        }
        figures.push((file(stress).into(), histogram(sets, label, size.bars)));
    }
    let notes = vec![
        format!(
            "{} trajectories of length {} per set at most, one per sampled graph, found by the beam with random scores as in the paper; \
             controller {}, one nominal flight each, deviation from `{}`.",
            size.graphs, size.length, size.controller, size.from
        ),
        "Skewness is the third standardised moment; above 0 the tail is on the stressful side.".into(),
    ];
    Ok(Outcome { tables: vec![("metrics", table)], figures, notes })
}

fn file(stress: Stress) -> &'static str {
    match stress {
        Stress::MaxDeviation => "deviation",
        Stress::MaxAcceleration => "acceleration",
        _ => "time",
    }
}

/// Shares of trajectories over equal ranges, the same for all sets.
fn histogram(sets: &[(String, Vec<f64>)], label: &str, bars: usize) -> Figure {
    let all = || sets.iter().flat_map(|(_, values)| values.iter().copied());
    let (least, greatest) = (all().fold(f64::INFINITY, f64::min), all().fold(f64::NEG_INFINITY, f64::max));
    let width = (greatest - least).max(f64::MIN_POSITIVE) / bars.max(1) as f64;
    let series = sets.iter().map(|(reach, values)| {
        let mut counts = vec![0_usize; bars.max(1)];
        for value in values {
            let bar = ((value - least) / width) as usize;
            counts[bar.min(bars.max(1) - 1)] += 1;
        }
        let share = |count: usize| 100.0 * count as f64 / values.len().max(1) as f64;
        let points = counts.into_iter().enumerate();
        let points = points.map(|(bar, count)| Point::new(least + (bar as f64 + 0.5) * width, share(count)));
        Series { name: reach.clone(), marks: Marks::Line(points.collect()) }
    });
    Figure {
        title: format!("Trajectories without a score: {label}"),
        x: Axis { label: label.into(), scale: Scale::Linear },
        y: Axis { label: "share of the trajectories, %".into(), scale: Scale::Linear },
        series: series.collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_trajectory_is_in_one_bar() {
        let sets = vec![("a".to_owned(), vec![0.0, 1.0, 2.0, 10.0]), ("b".to_owned(), vec![5.0])];
        for series in histogram(&sets, "x", 5).series {
            let Marks::Line(points) = series.marks else { panic!("lines") };
            assert!((points.iter().map(|point| point.y).sum::<f64>() - 100.0).abs() < 1e-9);
            assert_eq!((points[0].x, points[4].x), (1.0, 9.0));
        }
    }
}
