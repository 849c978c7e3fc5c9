//! Heaviest paths: the time until the optimum is proven, and the gap that is left when time is up.
//!
//! Instances are of the published kind, 580 mm around (0, 0, 290) mm without a core of 190 mm; each row is the median over
//! some of them, from seeds that follow each other.

use std::path::Path;

use hairpin::math::random::{named_seed, stream, unit};
use hairpin::search::heaviest::{Arcs, Ends, HeaviestSettings, Method, Outcome, Workspace, heaviest};

use hairpin_formats::atomic::{self, make_folder};
use serde_json::json;

use super::clock::{Stopwatch, alone, median, median_time};
use super::{Row, Target};
use crate::args::Bench;
use crate::console;
use crate::problem::Problem;

/// Points of the variants.
const VARIED: usize = 50;
/// Costs of the two directions of an arc differ by up to so much from the distance, each on its own.
const SKEW: f64 = 0.3;

/// Draws for a question without a path through all of its points.
const MOST_DRAWS: u64 = 1000;
/// Splits after which another draw is taken.
const SOON: u64 = 4;

/// Questions of one kind, by seed.
struct Family {
    /// Its bench.
    name: &'static str,
    draw: fn(u64) -> Result<Question, Problem>,
}

/// Those whose optimum is proven.
const FAMILIES: [Family; 10] = [
    Family { name: "max-load-15", draw: |seed| published(15, seed) },
    Family { name: "max-load-16", draw: |seed| published(16, seed) },
    Family { name: "max-load-30", draw: |seed| published(30, seed) },
    Family { name: "max-load-50", draw: |seed| published(50, seed) },
    Family { name: "max-load-100", draw: |seed| published(100, seed) },
    Family { name: "max-load-200", draw: |seed| published(200, seed) },
    Family { name: "max-load-fixed", draw: fixed },
    Family { name: "max-load-asymmetric", draw: asymmetric },
    Family { name: "max-load-sparse-30", draw: |seed| sparse(30, seed) },
    Family { name: "max-load-sparse-50", draw: |seed| sparse(VARIED, seed) },
];

pub(super) fn rows() -> Vec<Row> {
    let at_most = |name, unit, bound, measure| Row { name, unit, target: Some(Target::AtMost(bound)), measure };
    vec![
        at_most(FAMILIES[0].name, "ms", 1.0, |_| proven(11, FAMILIES[0].draw)),
        at_most(FAMILIES[1].name, "ms", 1.0, |_| proven(11, FAMILIES[1].draw)),
        at_most(FAMILIES[2].name, "ms", 10.0, |_| proven(11, FAMILIES[2].draw)),
        at_most(FAMILIES[3].name, "ms", 50.0, |_| proven(11, FAMILIES[3].draw)),
        at_most(FAMILIES[4].name, "ms", 120.0, |_| proven(11, FAMILIES[4].draw)),
        at_most(FAMILIES[5].name, "ms", 2000.0, |_| proven(9, FAMILIES[5].draw)),
        at_most("max-load-200-gap", "%", 0.03, |_| gap(3, 1.0, |seed| published(200, seed))),
        at_most("max-load-1000-gap", "%", 0.15, |_| gap(3, 5.0, |seed| published(1000, seed))),
        at_most(FAMILIES[6].name, "ms", 1000.0, |_| proven(11, FAMILIES[6].draw)),
        at_most(FAMILIES[7].name, "ms", 1000.0, |_| proven(11, FAMILIES[7].draw)),
        at_most(FAMILIES[8].name, "ms", 1000.0, |_| proven(11, FAMILIES[8].draw)),
        at_most(FAMILIES[9].name, "ms", 1000.0, |_| proven(11, FAMILIES[9].draw)),
    ]
}

/// Writes the questions as tables of costs, and an index of them: file, bench, fixed ends. 0 when all are written.
pub(super) fn write(bench: &Bench, folder: &Path) -> Result<u8, Problem> {
    let wanted = |family: &&Family| bench.name.as_ref().is_none_or(|name| family.name.starts_with(name.as_str()));
    let families: Vec<&Family> = FAMILIES.iter().filter(wanted).collect();
    if families.is_empty() {
        let names = FAMILIES.map(|family| family.name);
        return Err(Problem::input(format!("no questions of a bench that begins so; there are {}", names.join(", "))));
    }
    make_folder(folder)?;
    let mut index = Vec::new();
    for Family { name, draw } in families {
        for (number, Question { arcs, settings }) in questions(bench.questions, draw)?.iter().enumerate() {
            let file = format!("{name}-{number:03}.csv");
            atomic::write(&folder.join(&file), table(arcs).as_bytes())?;
            let ends = settings.ends;
            index.push(json!({ "file": file, "bench": name, "start": ends.start, "end": ends.end }));
        }
    }
    let path = folder.join("questions.json");
    let object = json!({ "questions": index, "exit_code": 0 });
    atomic::write(&path, format!("{object:#}\n").as_bytes())?;
    console::say(&if bench.json { object.to_string() } else { path.display().to_string() });
    Ok(0)
}

/// A table of costs as `max-load --graph` reads it.
fn table(arcs: &Arcs) -> String {
    let n = arcs.points();
    let cell = |from, to| arcs.cost(from, to).map_or(String::new(), |cost: i64| cost.to_string());
    let line =
        |from| (0..n).map(|to| if from == to { "0".into() } else { cell(from, to) }).collect::<Vec<_>>().join(",");
    (0..n).map(|from| line(from) + "\n").collect()
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

/// Three arcs of ten, and proven: no path meets all points.
fn sparse(points: usize, seed: u64) -> Result<Question, Problem> {
    for draw in 0..MOST_DRAWS {
        let arcs = within(Workspace::HOLLOW, points, named_seed(seed, "bench sparse", draw))?;
        if misses_points(&arcs)? {
            return Ok(Question::new(arcs));
        }
    }
    Err(Problem::input(format!(
        "{MOST_DRAWS} draws of {points} points, of none is it soon proven that no path meets all"
    )))
}

/// Whether it is soon proven that every path leaves a point out: where each arc costs 1, none costs n − 1.
fn misses_points(arcs: &Arcs) -> Result<bool, Problem> {
    let n = arcs.points();
    let units: Vec<Option<i64>> = (0..n * n).map(|index| arcs.cost(index / n, index % n).map(|_| 1)).collect();
    let units = Arcs::new(n, &units).map_err(Problem::input)?;
    let settings = HeaviestSettings {
        min_cost: Some(n as i64 - 1),
        method: Method::Branch,
        most_nodes: Some(SOON),
        ..HeaviestSettings::default()
    };
    Ok(heaviest(&units, &settings, &|| false).map_err(Problem::input)?.outcome == Outcome::BelowMinCost)
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
