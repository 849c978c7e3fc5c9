//! The threats that the authors named, as sweeps: obstacles that thin the graph out, clusters, costs that are no
//! distances.

use hairpin::judgement::Statistics;
use hairpin::search::heaviest::HeaviestSettings;
use hairpin_formats::figure::{Axis, Cell, Figure, Marks, Scale, Series, Spread, Table};
use hairpin_jobs::{Problem, Watch};
use serde::Deserialize;

use super::question::{Costs, Question};
use super::timed::timed;
use crate::experiment::outcome::Outcome;
use crate::experiment::sheet::Sheet;
use crate::experiment::watched::go_on;

/// What all sweeps are told.
#[derive(Debug, Deserialize)]
struct Size {
    points: Vec<usize>,
    instances: u64,
    seed: u64,
    /// Processor seconds that a proof gets.
    proof_limit_s: f64,
    #[serde(flatten)]
    along: Along,
}

/// What is swept; each sweep asks for its own keys, and none for others.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Along {
    obstacles: Option<Vec<usize>>,
    clusters: Option<usize>,
    spreads_mm: Option<Vec<f64>>,
}

/// One place of a sweep: its name, and its instances by points and seed.
struct Place {
    name: String,
    draw: Box<dyn Fn(usize, u64) -> Result<Question, Problem>>,
    costs: Costs,
}

/// Density by obstacles.
pub(in super::super) fn obstacles(sheet: &Sheet, watch: &dyn Watch) -> Result<Outcome, Problem> {
    let size: Size = sheet.size()?;
    let places = size.along.obstacles.iter().flatten().map(|&count| Place {
        name: count.to_string(),
        draw: Box::new(move |points, seed| Question::among_obstacles(points, count, seed)),
        costs: Costs::Distance,
    });
    swept(&size, places.collect(), "obstacles", "obstacles in the workspace", watch)
}

/// Points in clusters, the narrowest first, and uniform ones.
pub(in super::super) fn clusters(sheet: &Sheet, watch: &dyn Watch) -> Result<Outcome, Problem> {
    let size: Size = sheet.size()?;
    let clusters = size.along.clusters.unwrap_or(1);
    let places = size.along.spreads_mm.iter().flatten().map(|&spread| Place {
        name: format!("{spread} mm"),
        draw: Box::new(move |points, seed| Question::clustered(points, clusters, 1e-3 * spread, seed)),
        costs: Costs::Distance,
    });
    let uniform = Place { name: "uniform".into(), draw: Box::new(Question::published), costs: Costs::Distance };
    let places = places.chain([uniform]);
    swept(&size, places.collect(), "clusters", "deviation of a cluster", watch)
}

/// Kinds of costs.
pub(in super::super) fn costs(sheet: &Sheet, watch: &dyn Watch) -> Result<Outcome, Problem> {
    let size: Size = sheet.size()?;
    let kinds = [
        ("distance", Costs::Distance),
        ("squared", Costs::Squared),
        ("random", Costs::Random),
        ("skewed 30 %", Costs::Skewed(0.3)),
        ("random, directed", Costs::RandomDirected),
        ("equal", Costs::Equal),
    ];
    let places = kinds.map(|(name, costs)| Place { name: name.into(), draw: Box::new(Question::published), costs });
    swept(&size, places.into(), "costs", "costs of arcs", watch)
}

/// What is measured of all instances at one place.
#[derive(Default)]
struct Measured {
    densities: Vec<f64>,
    /// s.
    times: Vec<f64>,
    proven: usize,
    /// %.
    gaps: Vec<f64>,
    left_out: Vec<f64>,
}

impl Measured {
    /// The instances of `points` points at `place`.
    fn of(size: &Size, points: usize, place: &Place, watch: &dyn Watch) -> Result<Self, Problem> {
        let mut measured = Self::default();
        for index in 0..size.instances {
            go_on(watch)?;
            let seed = Question::seed(size.seed, points, index);
            let graph = (place.draw)(points, seed)?.graph();
            let arcs = place.costs.of(&graph, seed)?;
            let (time, found) = timed(&arcs, &HeaviestSettings::default(), size.proof_limit_s, watch)?;
            measured.densities.push(graph.density());
            measured.times.push(time);
            measured.proven += usize::from(found.proven);
            measured.gaps.push(found.gap_percent().unwrap_or(f64::INFINITY));
            measured.left_out.push((points - found.paths.first().map_or(0, |path| path.1.len())) as f64);
        }
        Ok(measured)
    }

    fn row(&self, points: usize, place: &Place) -> Vec<Cell> {
        let (times, gaps) = (Statistics::of(&self.times), Statistics::of(&self.gaps));
        vec![
            points.into(),
            place.name.as_str().into(),
            Statistics::of(&self.densities).map(|s| s.mean).into(),
            times.map(|s| s.median).into(),
            times.map(|s| s.min).into(),
            times.map(|s| s.max).into(),
            self.proven.into(),
            self.times.len().into(),
            gaps.map(|s| s.median).into(),
            gaps.map(|s| s.max).into(),
            Statistics::of(&self.left_out).map(|s| s.mean).into(),
        ]
    }
}

/// Density, time of the proof and gap at every place, for every number of points.
fn swept(
    size: &Size,
    places: Vec<Place>,
    name: &'static str,
    label: &str,
    watch: &dyn Watch,
) -> Result<Outcome, Problem> {
    let mut table = Table::new(&[
        "points",
        name,
        "density",
        "proof_s",
        "proof_s_least",
        "proof_s_most",
        "proven",
        "instances",
        "gap_percent",
        "gap_percent_most",
        "left_out",
    ]);
    let mut series = Vec::new();
    for &points in &size.points {
        let mut boxes = Vec::new();
        for (at, place) in places.iter().enumerate() {
            let measured = Measured::of(size, points, place, watch)?;
            table.push(measured.row(points, place));
            boxes.extend(Spread::of(at as f64, &measured.times));
        }
        series.push(Series { name: format!("{points} points"), marks: Marks::Boxes(boxes) });
    }
    let figure = Figure {
        title: format!("Time until the optimum is proven: {label}"),
        x: Axis { label: label.into(), scale: Scale::Names(places.into_iter().map(|place| place.name).collect()) },
        y: Axis { label: "processor time, s".into(), scale: Scale::Logarithmic },
        series,
    };
    let notes = vec![format!(
        "Medians over {} instances, one thread, processor time, at most {} s each; left_out is the mean number of points that the \
         heaviest path leaves out.",
        size.instances, size.proof_limit_s
    )];
    Ok(Outcome { tables: vec![(name, table)], figures: vec![(name.into(), figure)], notes })
}
