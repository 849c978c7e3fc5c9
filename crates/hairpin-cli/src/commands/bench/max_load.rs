//! Heaviest paths: the time until the optimum is proven, and the gap that is left when time is up.
//!
//! Instances are of the published kind, 580 mm around (0, 0, 290) mm without a core of 190 mm; each row is the median over
//! some of them, from seeds that follow each other.

use hairpin::math::random::{named_seed, stream, unit};
use hairpin::search::heaviest::{Arcs, Ends, HeaviestSettings, Workspace, heaviest};

use super::clock::{Stopwatch, alone, median, median_time};
use super::{Row, Target};
use crate::problem::Problem;

/// Points of the variants.
const VARIED: usize = 50;
/// Costs of the two directions of an arc differ by up to so much from the distance, each on its own.
const SKEW: f64 = 0.3;

pub(super) fn rows() -> Vec<Row> {
    let at_most = |name, unit, bound, measure| Row { name, unit, target: Some(Target::AtMost(bound)), measure };
    vec![
        at_most("max-load-15", "ms", 1.0, |_| proven(11, |seed| published(15, seed))),
        at_most("max-load-16", "ms", 1.0, |_| proven(11, |seed| published(16, seed))),
        at_most("max-load-30", "ms", 10.0, |_| proven(11, |seed| published(30, seed))),
        at_most("max-load-50", "ms", 50.0, |_| proven(11, |seed| published(50, seed))),
        at_most("max-load-100", "ms", 120.0, |_| proven(11, |seed| published(100, seed))),
        at_most("max-load-200", "ms", 2000.0, |_| proven(9, |seed| published(200, seed))),
        at_most("max-load-200-gap", "%", 0.03, |_| gap(3, 1.0, |seed| published(200, seed))),
        at_most("max-load-1000-gap", "%", 0.15, |_| gap(3, 5.0, |seed| published(1000, seed))),
        at_most("max-load-fixed", "ms", 1000.0, |_| proven(11, fixed)),
        at_most("max-load-asymmetric", "ms", 1000.0, |_| proven(11, asymmetric)),
        at_most("max-load-sparse", "ms", 1000.0, |_| proven(11, sparse)),
    ]
}

/// What is asked.
struct Question {
    arcs: Arcs,
    settings: HeaviestSettings,
}

impl Question {
    fn new(arcs: Arcs) -> Self {
        Self { arcs, settings: HeaviestSettings::default() }
    }
}

fn published(points: usize, seed: u64) -> Result<Question, Problem> {
    within(Workspace::PUBLISHED, points, seed).map(Question::new)
}

fn within(workspace: Workspace, points: usize, seed: u64) -> Result<Arcs, Problem> {
    workspace.arcs(&workspace.points(points, seed)).map_err(Problem::input)
}

/// Both ends are given.
fn fixed(seed: u64) -> Result<Question, Problem> {
    let mut question = published(VARIED, seed)?;
    question.settings.ends = Ends { start: Some(0), end: Some(VARIED - 1) };
    Ok(question)
}

/// There and back cost different: the distance times 1 ± [`SKEW`].
fn asymmetric(seed: u64) -> Result<Question, Problem> {
    let straight = within(Workspace::PUBLISHED, VARIED, seed)?;
    let mut random = stream(named_seed(seed, "bench skew", 0));
    let mut skew = |cost: i64| (cost as f64 * (1.0 + SKEW * (2.0 * unit(&mut random) - 1.0))).round() as i64;
    let costs: Vec<Option<i64>> =
        (0..VARIED * VARIED).map(|index| straight.cost(index / VARIED, index % VARIED).map(&mut skew)).collect();
    Arcs::new(VARIED, &costs).map(Question::new).map_err(Problem::input)
}

/// Three arcs of ten: most often no path meets all points.
fn sparse(seed: u64) -> Result<Question, Problem> {
    within(Workspace::HOLLOW, VARIED, seed).map(Question::new)
}

fn questions(count: u64, draw: impl Fn(u64) -> Result<Question, Problem>) -> Result<Vec<Question>, Problem> {
    (0..count).map(|index| draw(named_seed(1, "bench points", index))).collect()
}

/// Median time until the optimum is proven, ms.
fn proven(count: u64, draw: impl Fn(u64) -> Result<Question, Problem>) -> Result<f64, Problem> {
    let questions = questions(count, draw)?;
    let (mut times, mut all) = (Vec::new(), true);
    for Question { arcs, settings } in &questions {
        let search = || all &= heaviest(arcs, settings, &|| false).is_ok_and(|found| found.proven);
        times.push(1e3 * alone(|| median_time(1, search)));
    }
    if !all {
        return Err(Problem::input("an instance of the bench is not proven"));
    }
    Ok(median(times.into_iter()))
}

/// Median gap between bound and path after `limit` seconds on a processor, %; a search that ends before has none.
fn gap(count: u64, limit: f64, draw: impl Fn(u64) -> Result<Question, Problem>) -> Result<f64, Problem> {
    let mut gaps = Vec::new();
    for Question { arcs, settings } in &questions(count, draw)? {
        let watch = Stopwatch::start();
        let found = alone(|| heaviest(arcs, settings, &|| watch.passed(limit))).map_err(Problem::input)?;
        gaps.push(found.gap_percent().ok_or_else(|| Problem::input("an instance of the bench has no path"))?);
    }
    Ok(median(gaps.into_iter()))
}
