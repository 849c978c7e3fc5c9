//! Figure 7: the share of the optimum that is known after a time contract.

use std::time::{Duration, Instant};

use hairpin::judgement::Statistics;
use hairpin::search::heaviest::{Arcs, HeaviestSettings, heaviest};
use hairpin_formats::figure::{Axis, Figure, Marks, Point, Scale, Series, Table};
use hairpin_jobs::{Problem, Watch};
use serde::Deserialize;

use super::question::{Costs, Question};
use super::timed::timed;
use crate::clock::alone;
use crate::experiment::outcome::Outcome;
use crate::experiment::sheet::Sheet;
use crate::experiment::watched::go_on;

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Size {
    points: Vec<usize>,
    instances: u64,
    seed: u64,
    /// Seconds on the clock on the wall after which the best so far is the answer.
    cutoffs_s: Vec<f64>,
    /// Processor seconds that the proof gets on an instance.
    proof_limit_s: f64,
}

#[derive(Debug, Deserialize)]
struct Printed {
    rows: Vec<PrintedRow>,
}

#[derive(Debug, Deserialize)]
struct PrintedRow {
    points: usize,
    within_s: f64,
    /// Least and largest share of the optimum, %.
    share_percent: [f64; 2],
}

/// What is measured of all instances of one size; the lists are by cutoff.
struct Measured {
    /// Shares of the optimum, %.
    shares: Vec<Vec<f64>>,
    /// How many instances are proven by then.
    proven: Vec<usize>,
    /// How many instances have a proven optimum.
    known: usize,
}

impl Measured {
    fn of(size: &Size, points: usize, watch: &dyn Watch) -> Result<Self, Problem> {
        let cutoffs = size.cutoffs_s.len();
        let mut measured = Self { shares: vec![Vec::new(); cutoffs], proven: vec![0; cutoffs], known: 0 };
        for index in 0..size.instances {
            go_on(watch)?;
            // Those of table I.
            let seed = Question::seed(size.seed, points, index);
            let arcs = Costs::Distance.of(&Question::published(points, seed)?.graph(), seed)?;
            let (_, reference) = timed(&arcs, &HeaviestSettings::default(), size.proof_limit_s, watch)?;
            measured.known += usize::from(reference.proven);
            // Where the optimum is not proven its bound stands in: the shares are then no larger than they are.
            let Some(optimum) = reference.bound.filter(|bound| *bound > 0) else { continue };
            for (at, cutoff) in size.cutoffs_s.iter().enumerate() {
                let (cost, is_proven) = within(&arcs, *cutoff)?;
                measured.shares[at].push(100.0 * cost as f64 / optimum as f64);
                measured.proven[at] += usize::from(is_proven);
            }
        }
        Ok(measured)
    }
}

/// The share of the optimum within each cutoff, and the share of instances that are proven by then.
pub(in super::super) fn figure_7(sheet: &Sheet, watch: &dyn Watch) -> Result<Outcome, Problem> {
    let (size, printed): (Size, Printed) = (sheet.size()?, sheet.printed()?);
    let mut table = Table::new(&[
        "points",
        "within_s",
        "share_percent",
        "share_percent_least",
        "proven_percent",
        "reference_proven_percent",
        "paper_share_percent_least",
        "paper_share_percent_most",
    ]);
    let mut curves: Vec<Vec<Point>> = vec![Vec::new(); size.cutoffs_s.len()];
    for &points in &size.points {
        let measured = Measured::of(&size, points, watch)?;
        let percent = |count: usize| 100.0 * count as f64 / size.instances as f64;
        for (at, cutoff) in size.cutoffs_s.iter().enumerate() {
            let Some(shares) = Statistics::of(&measured.shares[at]) else { continue };
            let paper = printed.rows.iter().find(|row| row.points == points && row.within_s == *cutoff);
            table.push(vec![
                points.into(),
                (*cutoff).into(),
                shares.mean.into(),
                shares.min.into(),
                percent(measured.proven[at]).into(),
                percent(measured.known).into(),
                paper.map(|row| row.share_percent[0]).into(),
                paper.map(|row| row.share_percent[1]).into(),
            ]);
            curves[at].push(Point::between(points as f64, shares.mean, shares.min, shares.max));
        }
    }
    let notes = vec![format!(
        "{} instances a size, one thread, clock on the wall. Where the proof took more than {} s the bound stands in for the optimum.",
        size.instances, size.proof_limit_s
    )];
    let figures = vec![("figure-7".into(), drawn(&size.cutoffs_s, curves, &printed))];
    Ok(Outcome { tables: vec![("figure-7", table)], figures, notes })
}

/// A curve for each cutoff, and the paper's ranges.
fn drawn(cutoffs: &[f64], curves: Vec<Vec<Point>>, printed: &Printed) -> Figure {
    let ours = cutoffs
        .iter()
        .zip(curves)
        .map(|(cutoff, points)| Series { name: format!("within {cutoff} s"), marks: Marks::Line(points) });
    let of_paper = |seconds: f64| {
        let rows = printed.rows.iter().filter(|row| row.within_s == seconds);
        let point = |row: &PrintedRow| {
            let [low, high] = row.share_percent;
            Point::between(row.points as f64, 0.5 * (low + high), low, high)
        };
        Series { name: format!("paper: within {seconds} s"), marks: Marks::Scatter(rows.map(point).collect()) }
    };
    Figure {
        title: "RobTest, figure 7: the heaviest path known, mean and range over the instances of a size".into(),
        x: Axis { label: "points".into(), scale: Scale::Logarithmic },
        y: Axis { label: "share of the optimum, %".into(), scale: Scale::Linear },
        series: ours.chain([of_paper(5.0), of_paper(20.0)]).collect(),
    }
}

/// Cost of the heaviest path that is known after `seconds`, and whether it is proven by then.
fn within(arcs: &Arcs, seconds: f64) -> Result<(i64, bool), Problem> {
    let begun = Instant::now();
    let end = Duration::from_secs_f64(seconds);
    let stop = || begun.elapsed() >= end;
    let found = alone(|| heaviest(arcs, &HeaviestSettings::default(), &stop)).map_err(Problem::input)?;
    // Dynamic programming cannot be stopped, so an answer may come too late to count as a proof.
    Ok((found.paths.first().map_or(0, |path| path.0), found.proven && !stop()))
}
