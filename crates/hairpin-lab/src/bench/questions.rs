//! The questions of the benches of heaviest paths, drawn by seed, and their tables of costs for other solvers.
//!
//! Instances are of the published kind, 580 mm around (0, 0, 290) mm without a core of 190 mm.

use std::path::Path;

use hairpin::math::random::{named_seed, stream, unit};
use hairpin::search::heaviest::{Arcs, Ends, HeaviestSettings, Method, Outcome, Workspace, heaviest};
use hairpin_formats::atomic::{self, make_folder};
use hairpin_jobs::Problem;
use serde_json::json;

use crate::findings::{Findings, Words};

/// Points of the variants.
const VARIED: usize = 50;
/// Costs of the two directions of an arc differ by up to so much from the distance, each on its own.
const SKEW: f64 = 0.3;

/// Draws for a question without a path through all of its points.
const MOST_DRAWS: u64 = 1000;
/// Splits after which another draw is taken.
const SOON: u64 = 4;

/// Questions of one kind, by seed.
pub(super) struct Family {
    /// Its bench.
    pub(super) name: &'static str,
    pub(super) draw: fn(u64) -> Result<Question, Problem>,
}

/// Those whose optimum is proven.
pub(super) const FAMILIES: [Family; 10] = [
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

/// What is asked.
pub(super) struct Question {
    pub(super) arcs: Arcs,
    pub(super) settings: HeaviestSettings,
}

impl Question {
    fn new(arcs: Arcs) -> Self {
        Self { arcs, settings: HeaviestSettings::default() }
    }
}

pub(super) fn published(points: usize, seed: u64) -> Result<Question, Problem> {
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

/// The first `count` questions of a family.
pub(super) fn questions(count: u64, draw: impl Fn(u64) -> Result<Question, Problem>) -> Result<Vec<Question>, Problem> {
    (0..count).map(|index| draw(nth_seed(index))).collect()
}

/// The seed of question `index` of a family.
pub(super) fn nth_seed(index: u64) -> u64 {
    named_seed(1, "bench points", index)
}

/// Writes `count` questions of each bench whose name begins with `name` into `folder`, as tables of costs, and
/// `questions.json`, an index of them: file, bench, fixed ends.
///
/// # Errors
/// No such bench has questions; a folder that cannot be written.
pub fn write_questions(name: Option<&str>, count: u64, folder: &Path) -> Result<Findings, Problem> {
    let wanted = |family: &&Family| name.is_none_or(|name| family.name.starts_with(name));
    let families: Vec<&Family> = FAMILIES.iter().filter(wanted).collect();
    if families.is_empty() {
        let names = FAMILIES.map(|family| family.name);
        return Err(Problem::input(format!("no questions of a bench that begins so; there are {}", names.join(", "))));
    }
    make_folder(folder)?;
    let mut index = Vec::new();
    for Family { name, draw } in families {
        for (number, Question { arcs, settings }) in questions(count, draw)?.iter().enumerate() {
            let file = format!("{name}-{number:03}.csv");
            atomic::write(&folder.join(&file), table(arcs).as_bytes())?;
            let ends = settings.ends;
            index.push(json!({ "file": file, "bench": name, "start": ends.start, "end": ends.end }));
        }
    }
    let path = folder.join("questions.json");
    let object = json!({ "questions": index, "exit_code": 0 });
    atomic::write(&path, format!("{object:#}\n").as_bytes())?;
    Ok(Findings::new(vec![Words::Text(path.display().to_string())], object))
}

/// A table of costs as `max-load --graph` reads it.
pub(super) fn table(arcs: &Arcs) -> String {
    let n = arcs.points();
    let cell = |from, to| arcs.cost(from, to).map_or(String::new(), |cost: i64| cost.to_string());
    let line =
        |from| (0..n).map(|to| if from == to { "0".into() } else { cell(from, to) }).collect::<Vec<_>>().join(",");
    (0..n).map(|from| line(from) + "\n").collect()
}
