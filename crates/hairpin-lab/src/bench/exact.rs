//! `exact` and `uniform` on the graphs of the beam's benches.

use hairpin::feasibility::reach::{Hull, HullSettings, StepNode, StepReach, StepSettings};
use hairpin::math::random::{named_seed, stream};
use hairpin::search::uniform::Sampler;
use hairpin::search::{ExactSettings, LegGraph, Score, exact};
use hairpin::world::{Sampling, World, sample_free};
use hairpin_jobs::Problem;
use nalgebra::{Point3, Vector3};

use super::flyer::robot;
use super::row::Row;
use crate::clock::{median_rate, median_time};

/// Graphs per run.
const GRAPHS: u64 = 5;
/// The longest trajectories.
const LENGTH: usize = 50;

pub(super) fn rows() -> Vec<Row> {
    vec![
        Row::at_most("exact-legs-and-counts-to-50", "ms", 60.0, |_| legs_and_counts()),
        Row::at_most("exact-best-of-50-on-top", "ms", 25.0, |_| best()),
        Row::at_least("uniform-samples-10", "1/s", 3e6, |_| samples(10)),
        Row::at_least("uniform-samples-50", "1/s", 2e5, |_| samples(LENGTH)),
    ]
}

struct Graphs {
    hull: Hull,
    graphs: Vec<Vec<Point3<f64>>>,
}

const START: StepNode = StepNode { previous: 0, current: 0 };

impl Graphs {
    fn new() -> Result<Self, Problem> {
        let hull = Hull::new(&robot("flightgoggles")?, &HullSettings::default()).map_err(Problem::input)?;
        let world = World::new(Vector3::repeat(30.0), 0.0, Vec::new()).map_err(Problem::input)?;
        let sample = |graph| {
            let free = sample_free(&world, 250, 0.0, Sampling::Uniform, named_seed(1, "bench graph", graph));
            let mut points = vec![Point3::new(10.0, 10.0, 10.0)];
            points.extend(free.map_err(Problem::input)?);
            points.push(Point3::new(20.0, 20.0, 20.0));
            Ok(points)
        };
        Ok(Self { hull, graphs: (0..GRAPHS).map(sample).collect::<Result<_, Problem>>()? })
    }

    fn legs<'a>(&self, points: &'a [Point3<f64>]) -> LegGraph<'a, StepNode> {
        let reach = StepReach::new(&self.hull, points, StepSettings::default());
        LegGraph::explore(START, points, &reach, LENGTH)
    }
}

/// All feasible triples, and the number of trajectories of every length, per graph.
fn legs_and_counts() -> Result<f64, Problem> {
    let graphs = Graphs::new()?;
    let all = || graphs.graphs.iter().map(|points| graphs.legs(points).counts_by_length(LENGTH).len()).sum::<usize>();
    Ok(1e3 * median_time(7, all) / GRAPHS as f64)
}

/// The trajectory of maximal stress, given the legs.
fn best() -> Result<f64, Problem> {
    let graphs = Graphs::new()?;
    let built: Vec<_> = graphs.graphs.iter().map(|points| graphs.legs(points)).collect();
    let score = Score::named("high-velocity-90", 0, graphs.hull.farthest() / graphs.hull.step());
    let score = score.map_err(Problem::input)?;
    let settings = ExactSettings { length: LENGTH, revisits: true, ..Default::default() };
    let all = || built.iter().map(|graph| exact(graph, &score, &settings).proven).sum::<usize>();
    Ok(1e3 * median_time(7, all) / GRAPHS as f64)
}

/// Exactly uniform samples with replacement.
fn samples(length: usize) -> Result<f64, Problem> {
    let graphs = Graphs::new()?;
    let graph = graphs.legs(&graphs.graphs[0]);
    let sampler = Sampler::new(&graph, length)
        .ok_or_else(|| Problem::input(format!("the bench's graph has no trajectory of length {length}")))?;
    let (mut random, mut legs) = (stream(1), Vec::new());
    Ok(median_rate(7, || {
        for _ in 0..200_000 {
            sampler.draw(&mut random, &mut legs);
        }
        200_000
    }))
}
