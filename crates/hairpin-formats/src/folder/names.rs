//! What the files of a campaign folder are called.

pub(crate) const SCENARIO: &str = "scenario.toml";
pub(super) const GENERATION: &str = "generation.json";
pub(super) const RESULTS: &str = "results.parquet";
pub(super) const WAYPOINTS: &str = "waypoints.parquet";
pub(super) const RUNS: &str = "runs.parquet";
pub(super) const INFLUENCE: &str = "influence.json";
/// The proof that an arm's first program is the heaviest.
pub const OPTIMUM: &str = "optimum.json";
/// The costs of an arm's graph.
pub const GRAPH: &str = "graph.csv";
/// Why moves are not in it.
pub const REASONS: &str = "reasons.csv";
/// The arcs of an arm's graph.
pub const ARCS: &str = "arcs.csv";
/// What every run of an arm did on every move.
pub const MOVES: &str = "moves.json";
/// The same of earlier releases, which this campaign is held against.
pub const BASELINE: &str = "baseline.json";
/// How the largest stress of a search that executes rose.
pub const BEST_SO_FAR: &str = "best-so-far.tsv";
pub(super) const COVERAGE: [&str; 2] = ["coverage.json", "coverage.tsv"];
