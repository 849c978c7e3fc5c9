//! What can be typed after `hairpin max-load`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::{LARGEST_SEED, Threads, seconds};

/// The path through a graph that costs most, in which no point comes twice. Points may be left out; ends are free unless fixed.
///
/// The answer tells cost, upper bound, gap, and whether it is proven. A time limit or Ctrl-C gives the best so far. Exit code 3:
/// there is no such path, 5: none was found yet.
#[derive(Debug, Args)]
pub(crate) struct MaxLoad {
    /// Costs of the arcs: N lines of N numbers ≥ 0, empty where there is no arc; row = from
    #[arg(long, value_name = "COSTS.csv")]
    pub(crate) graph: PathBuf,
    /// First point, counted from 0
    #[arg(long, value_name = "I")]
    pub(crate) start: Option<usize>,
    /// Last point, counted from 0
    #[arg(long, value_name = "J")]
    pub(crate) end: Option<usize>,
    /// Paths below this cost are not wanted
    #[arg(long, value_name = "C", allow_negative_numbers = true)]
    pub(crate) min_cost: Option<String>,
    /// How many pairwise different paths, the heaviest first
    #[arg(long, value_name = "K", default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..=1000))]
    pub(crate) programs: u16,
    /// How to search
    #[arg(long, value_enum, default_value_t = SearchMethod::Auto)]
    pub(crate) method: SearchMethod,
    /// Seconds after which the best so far is the answer
    #[arg(long, value_name = "S", value_parser = seconds, allow_negative_numbers = true)]
    pub(crate) time_limit: Option<f64>,
    /// Problems that each of up to 32 parts of branch and bound looks at: a limit that gives the same answer everywhere
    #[arg(long, value_name = "N")]
    pub(crate) nodes: Option<u64>,
    /// Seed of the local search
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u64).range(..=LARGEST_SEED), allow_negative_numbers = true)]
    pub(crate) seed: u64,
    /// Write the proof of the answer
    #[arg(long, value_name = "OUT.json", conflicts_with = "programs")]
    pub(crate) certificate: Option<PathBuf>,
    /// Check a certificate against the graph by independent code instead of searching; exit code 1 if it does not hold
    #[arg(long, value_name = "CERTIFICATE.json", conflicts_with = "certificate")]
    pub(crate) verify: Option<PathBuf>,
    /// One JSON object on stdout
    #[arg(long)]
    pub(crate) json: bool,
    #[command(flatten)]
    pub(crate) threads: Threads,
}

/// Ways to search.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum SearchMethod {
    /// Subsets up to 16 points, else branch
    Auto,
    /// Dynamic programming over subsets: exact, 2^N states
    Subsets,
    /// Branch and bound on Lagrangian bounds: exact
    Branch,
    /// Local search under a bound
    Local,
    /// Depth-first search over all paths, the published baseline
    Dfs,
}
