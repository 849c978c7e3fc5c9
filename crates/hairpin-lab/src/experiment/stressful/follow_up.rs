//! Figures 9 to 11: the Anafi's stand-in. Trajectories without a score beside those of a score that was learned from
//! them and those of executions in the loop: how far they deviate, how many of them break a limit, and the worst of
//! them from above and from the side.

use hairpin::campaign::{Case, Setup, execute_run};
use hairpin::judgement::Stress;
use hairpin::math::random::named_seed;
use hairpin_formats::figure::{Axis, Figure, Marks, Point, Scale, Series, Spread, Table};
use hairpin_jobs::{Problem, Watch};
use nalgebra::Point3;
use serde::Deserialize;

use super::cell::{self, ANAFI, Set, text, with};
use super::lift::{Flown, lift};
use crate::experiment::outcome::Outcome;
use crate::experiment::sheet::Sheet;
use crate::experiment::watched::go_on;

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Size {
    /// Trajectories per way, each from a graph of its own.
    graphs: u64,
    /// Executions of other graphs' trajectories that the score is learned from.
    training: u64,
    /// Runs with noise of every trajectory.
    runs: u64,
    /// Executions per graph of the search in the loop.
    executions: u64,
    length: u64,
    seed: u64,
    reach: String,
    /// What deviations are measured from: leg | nearest-leg.
    from: String,
    /// The baseline's share over the limit at which ways are compared, %.
    baseline_over_percent: f64,
}

#[derive(Debug, Deserialize)]
struct Printed {
    learned_lift_percent: f64,
    over_percent: f64,
}

/// The way whose score is learned.
const LEARNED: &str = "learned";

/// A way to generate and what it came to.
struct Way {
    name: &'static str,
    cases: Vec<Case>,
    flown: Flown,
}

/// Figures 9, 10 and 11.
pub(in super::super) fn follow_up(sheet: &Sheet, watch: &dyn Watch) -> Result<Outcome, Problem> {
    let (size, printed): (Size, Printed) = (sheet.size()?, sheet.printed()?);
    let base = [
        ("seed", size.seed.to_string()),
        ("task.length", size.length.to_string()),
        ("generate.reach", text(&size.reach)),
        ("generate.search.cases", size.graphs.to_string()),
        ("spec.deviation.from", text(&size.from)),
    ];
    let judge = cell::with_noise(ANAFI, &base, size.runs)?;
    let ways = ways(&size, &base, &judge, watch)?;
    // The paper's trajectories without a score are those of its beam.
    let baseline = &ways[1].flown;
    let limit = limit_over(&baseline.stresses, size.baseline_over_percent);
    let table = table(&size, &printed, &ways, limit);
    let mut figures = vec![("figure-9".into(), boxes(&ways, baseline.mean())), ("figure-11".into(), shares(&ways))];
    if let Some((name, case)) = worst(&ways) {
        figures.extend(views(&judge, name, case));
    }
    let notes = vec![
        format!(
            "Feasible set `{}`, length {}, {} graphs a way, each trajectory flown {} times with noise, deviation from `{}`; lifts are over the \
             beam with random scores, which is the paper's set without a score. Robot and controller are stand-ins.",
            size.reach, size.length, size.graphs, size.runs, size.from
        ),
        format!("{limit:.3} m is the limit that {} % of that baseline break.", size.baseline_over_percent),
    ];
    Ok(Outcome { tables: vec![("follow-up", table)], figures, notes })
}

/// The trajectories of every way, and what they come to under `judge`.
fn ways(size: &Size, base: &[Set], judge: &Setup, watch: &dyn Watch) -> Result<Vec<Way>, Problem> {
    let model = cell::learned(ANAFI, base, size.training, size.seed, watch)?;
    let method = |name: &str| ("generate.search.method", text(name));
    let random = ("generate.score", text("random"));
    let aggregate = ("generate.search.aggregate", text("max"));
    let asked: [(&str, Vec<Set>); 4] = [
        ("uniform", vec![method("uniform")]),
        ("random beam", vec![method("beam"), random]),
        (LEARNED, vec![method("exact"), aggregate]),
        ("in the loop", vec![method("in-loop"), ("generate.search.executions", size.executions.to_string())]),
    ];
    let mut ways = Vec::new();
    for (name, sets) in asked {
        go_on(watch)?;
        let setup = cell::setup(ANAFI, &with(base, &sets), (name == LEARNED).then_some(&model))?;
        let cases = cell::cases(&setup, watch)?;
        let [flown] = cell::flown(judge, &cases, [Stress::MaxDeviation], watch)?;
        ways.push(Way { name, cases, flown });
    }
    Ok(ways)
}

/// A row for each way, its lift over the second one's stress.
fn table(size: &Size, printed: &Printed, ways: &[Way], limit: f64) -> Table {
    let mut table = Table::new(&[
        "way",
        "trajectories",
        "mean_m",
        "median_m",
        "greatest_m",
        "lift_percent",
        "low_percent",
        "high_percent",
        "paper_lift_percent",
        "limit_m",
        "over_limit_percent",
        "paper_over_percent",
        "crashed_percent",
        "timed_out_percent",
    ]);
    for (number, way) in ways.iter().enumerate() {
        let stresses = &way.flown.stresses;
        let lift = lift(stresses, &ways[1].flown.stresses, named_seed(size.seed, "bootstrap", number as u64));
        let [value, low, high] = lift.percent();
        let learned = way.name == LEARNED;
        table.push(vec![
            way.name.into(),
            stresses.len().into(),
            way.flown.mean().into(),
            way.flown.median().into(),
            stresses.iter().copied().fold(f64::NAN, f64::max).into(),
            value.into(),
            low.into(),
            high.into(),
            learned.then_some(printed.learned_lift_percent).into(),
            limit.into(),
            over(stresses, limit).into(),
            learned.then_some(printed.over_percent).into(),
            (100.0 * way.flown.crashed).into(),
            (100.0 * way.flown.timed_out).into(),
        ]);
    }
    table
}

/// The limit that `percent` of `stresses` exceed, as nearly as their number allows.
fn limit_over(stresses: &[f64], percent: f64) -> f64 {
    let mut sorted = stresses.to_vec();
    sorted.sort_by(|a, b| b.total_cmp(a));
    let exceeding = (percent / 100.0 * sorted.len() as f64).round() as usize;
    sorted.get(exceeding).copied().unwrap_or(f64::NAN)
}

/// Share of `stresses` above `limit`, %.
fn over(stresses: &[f64], limit: f64) -> f64 {
    100.0 * stresses.iter().filter(|stress| **stress > limit).count() as f64 / stresses.len() as f64
}

/// Boxes over the `mean` of the baseline.
fn boxes(ways: &[Way], mean: f64) -> Figure {
    let spread = |(place, way): (usize, &Way)| {
        let relative: Vec<f64> = way.flown.stresses.iter().map(|stress| stress / mean).collect();
        Spread::of(place as f64, &relative)
    };
    let boxes = ways.iter().enumerate().filter_map(spread).collect();
    Figure {
        title: "Largest deviation over the mean of the beam with random scores".into(),
        x: Axis { label: "trajectories".into(), scale: Scale::Names(ways.iter().map(|way| way.name.into()).collect()) },
        y: Axis { label: "largest deviation, relative".into(), scale: Scale::Linear },
        series: vec![Series { name: String::new(), marks: Marks::Boxes(boxes) }],
    }
}

fn shares(ways: &[Way]) -> Figure {
    let greatest = ways.iter().flat_map(|way| &way.flown.stresses).copied().fold(0.0, f64::max);
    const STEPS: usize = 60;
    let series = ways.iter().map(|way| {
        let limits = (0..=STEPS).map(|k| greatest * k as f64 / STEPS as f64);
        let points = limits.map(|limit| Point::new(limit, over(&way.flown.stresses, limit))).collect();
        Series { name: way.name.into(), marks: Marks::Curve(points) }
    });
    Figure {
        title: "Tests that break a limit of the largest deviation".into(),
        x: Axis { label: "limit, m".into(), scale: Scale::Linear },
        y: Axis { label: "tests over the limit, %".into(), scale: Scale::Range(0.0, 100.0) },
        series: series.collect(),
    }
}

/// The way and the case that deviated most.
fn worst(ways: &[Way]) -> Option<(&'static str, &Case)> {
    let all = ways.iter().flat_map(|way| {
        let measured = way.flown.places.iter().map(|&place| &way.cases[place]);
        measured.zip(&way.flown.stresses).map(move |pair| (way.name, pair))
    });
    all.max_by(|(_, (_, a)), (_, (_, b))| a.total_cmp(b)).map(|(name, (case, _))| (name, case))
}

/// The flight of `case` beside its waypoints: from above, and from the side.
fn views(judge: &Setup, name: &str, case: &Case) -> Vec<(String, Figure)> {
    let Ok(flight) = execute_run(judge, case, 0).outcome else { return Vec::new() };
    let track = &flight.track;
    let flown: Vec<_> = (0..track.times().len()).map(|index| track.position(index)).collect();
    let view = |title: &str, [across, up]: [usize; 2]| {
        let seen = |points: &[Point3<f64>]| points.iter().map(|p| Point::new(p[across], p[up])).collect();
        let label = |axis: usize| format!("{}, m", ["x", "y", "z"][axis]);
        Figure {
            title: format!("Worst flight ({name}), {title}"),
            x: Axis { label: label(across), scale: Scale::Linear },
            y: Axis { label: label(up), scale: Scale::Linear },
            series: vec![
                Series { name: "waypoints".into(), marks: Marks::Line(seen(&case.waypoints)) },
                Series { name: "flown".into(), marks: Marks::Curve(seen(&flown)) },
            ],
        }
    };
    vec![("figure-10-top".into(), view("from above", [0, 1])), ("figure-10-side".into(), view("from the side", [0, 2]))]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_limit_is_the_one_that_so_many_break() {
        let stresses: Vec<f64> = (1..=10).map(f64::from).collect();
        let limit = limit_over(&stresses, 30.0);
        assert_eq!((limit, over(&stresses, limit)), (7.0, 30.0));
        assert_eq!(over(&stresses, 0.5), 100.0);
        assert!(limit_over(&[], 30.0).is_nan());
    }
}
