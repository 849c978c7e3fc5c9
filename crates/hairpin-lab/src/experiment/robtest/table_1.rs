//! Table I: seconds for the graph, depth-first search, and the proof of the optimum.

use hairpin::judgement::Statistics;
use hairpin::search::heaviest::{Heaviest, HeaviestSettings, Method};
use hairpin_formats::figure::{Axis, Cell, Figure, Marks, Point, Scale, Series, Table};
use hairpin_jobs::{Problem, Watch};
use serde::Deserialize;

use super::question::{Costs, Question};
use super::timed::timed;
use crate::clock::{alone, median_time};
use crate::experiment::outcome::Outcome;
use crate::experiment::sheet::Sheet;
use crate::experiment::watched::go_on;

/// Sizes of table I.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct TableSize {
    points: Vec<usize>,
    instances: u64,
    seed: u64,
    /// Processor seconds that depth-first search gets on an instance.
    dfs_limit_s: f64,
    /// The same for the proof.
    proof_limit_s: f64,
}

/// Table I as it was printed: mean and deviation, s.
#[derive(Debug, Deserialize)]
struct PrintedTable {
    limit_s: f64,
    rows: Vec<PrintedRow>,
}

#[derive(Debug, Deserialize)]
struct PrintedRow {
    points: usize,
    graph_s: [f64; 2],
    density: [f64; 2],
    dfs_s: Option<[f64; 2]>,
    proof_s: Option<[f64; 2]>,
}

/// What is measured of all instances of one size, s; of searches, of those that ended.
#[derive(Default)]
struct Measured {
    graph: Vec<f64>,
    density: Vec<f64>,
    dfs: Vec<f64>,
    proof: Vec<f64>,
}

/// Mean and deviation.
type Spread = Option<[f64; 2]>;

impl Measured {
    fn of(size: &TableSize, points: usize, watch: &dyn Watch) -> Result<Self, Problem> {
        let mut measured = Self::default();
        for index in 0..size.instances {
            go_on(watch)?;
            measured.add(size, points, Question::seed(size.seed, points, index), watch)?;
        }
        Ok(measured)
    }

    /// Adds one instance.
    fn add(&mut self, size: &TableSize, points: usize, seed: u64, watch: &dyn Watch) -> Result<(), Problem> {
        let question = Question::published(points, seed)?;
        let graph = question.graph();
        self.density.push(graph.density());
        self.graph.push(alone(|| median_time(1, || question.graph())));
        let arcs = Costs::Distance.of(&graph, seed)?;
        let search =
            |method, limit| timed(&arcs, &HeaviestSettings { method, ..HeaviestSettings::default() }, limit, watch);
        let (proof, found) = search(Method::Auto, size.proof_limit_s)?;
        self.proof.extend(found.proven.then_some(proof));
        let (dfs, walked) = search(Method::Dfs, size.dfs_limit_s)?;
        self.dfs.extend(walked.proven.then_some(dfs));
        let cost = |found: &Heaviest| found.paths.first().map(|path| path.0);
        assert!(
            !(found.proven && walked.proven) || cost(&found) == cost(&walked),
            "two proven searches of {points} points, seed {seed}, differ"
        );
        Ok(())
    }

    /// Of the graph, depth-first search and the proof. A mean over those that ended would call the slow ones fast.
    fn times(&self) -> [Spread; 3] {
        [&self.graph, &self.dfs, &self.proof].map(|times| (times.len() == self.graph.len()).then(|| spread(times))?)
    }

    fn row(&self, points: usize, paper: Option<&PrintedRow>) -> Vec<Cell> {
        let [graph, dfs, proof] = self.times();
        let both = |value: Spread| [Cell::from(value.map(|v| v[0])), Cell::from(value.map(|v| v[1]))];
        let mut row = vec![points.into()];
        row.extend([both(spread(&self.density)), both(graph), both(dfs)].concat());
        row.push(self.dfs.len().into());
        row.extend(both(proof));
        row.push(self.proof.len().into());
        row.extend([
            paper.map(|row| row.density[0]).into(),
            paper.map(|row| row.graph_s[0]).into(),
            paper.and_then(|row| row.dfs_s).map(|v| v[0]).into(),
            paper.and_then(|row| row.proof_s).map(|v| v[0]).into(),
        ]);
        row
    }
}

fn spread(values: &[f64]) -> Spread {
    Statistics::of(values).map(|s| [s.mean, s.std])
}

/// Seconds for the graph, depth-first search and the proof of the optimum, mean ± deviation, beside the paper's.
pub(in super::super) fn table_1(sheet: &Sheet, watch: &dyn Watch) -> Result<Outcome, Problem> {
    let (size, printed): (TableSize, PrintedTable) = (sheet.size()?, sheet.printed()?);
    let mut table = Table::new(&[
        "points",
        "density",
        "density_dev",
        "graph_s",
        "graph_s_dev",
        "dfs_s",
        "dfs_s_dev",
        "dfs_ended",
        "proof_s",
        "proof_s_dev",
        "proven",
        "paper_density",
        "paper_graph_s",
        "paper_dfs_s",
        "paper_proof_s",
    ]);
    let mut curves: [Vec<Point>; 3] = Default::default();
    for &points in &size.points {
        let measured = Measured::of(&size, points, watch)?;
        table.push(measured.row(points, printed.rows.iter().find(|row| row.points == points)));
        for (curve, time) in curves.iter_mut().zip(measured.times()) {
            curve.extend(time.map(|[mean, dev]| Point::between(points as f64, mean, mean - dev, mean + dev)));
        }
    }
    let notes = vec![
        format!(
            "{} instances a row, one thread, processor time; depth-first search got {} s an instance, the proof {} s; a mean is \
             given where all ended.",
            size.instances, size.dfs_limit_s, size.proof_limit_s
        ),
        format!("The paper's numbers are from an Intel i7 at 2.6 GHz, a limit of {} s.", printed.limit_s),
    ];
    Ok(Outcome { tables: vec![("table-1", table)], figures: vec![("table-1".into(), drawn(curves, &printed))], notes })
}

/// The three curves beside the paper's.
fn drawn([graph, dfs, proof]: [Vec<Point>; 3], printed: &PrintedTable) -> Figure {
    let of_paper = |value: fn(&PrintedRow) -> Spread| -> Vec<Point> {
        printed.rows.iter().filter_map(|row| Some(Point::new(row.points as f64, value(row)?[0]))).collect()
    };
    let series = [
        ("graph (CCBG)", graph),
        ("depth-first search", dfs),
        ("proven optimum (TCO)", proof),
        ("paper: CCBG", of_paper(|row| Some(row.graph_s))),
        ("paper: DFS", of_paper(|row| row.dfs_s)),
        ("paper: TCO", of_paper(|row| row.proof_s)),
    ];
    Figure {
        title: "RobTest, table I: mean and deviation over the instances of a size".into(),
        x: Axis { label: "points".into(), scale: Scale::Linear },
        y: Axis { label: "processor time, s".into(), scale: Scale::Logarithmic },
        series: series.map(|(name, points)| Series { name: name.into(), marks: Marks::Line(points) }).into(),
    }
}
