//! What can be typed after `hairpin max-load`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use hairpin_jobs::bounds::{self, LARGEST_SEED};

use super::numbers::seconds;
use super::resources::Threads;

/// The path through a graph that costs most, in which no point comes twice (or --visits). Points may be left out; ends
/// are free unless fixed.
///
/// The answer tells cost, upper bound, gap, and whether it is proven. A time limit or Ctrl-C gives the best so far.
/// Exit code 3: there is no such path, 5: none was found yet.
#[derive(Debug, Args)]
pub(crate) struct MaxLoad {
    /// Arm, cell: a shipped arm's name, a robot file, or a scenario, whose own points are taken without --cloud
    #[arg(value_name = "CELL", conflicts_with = "graph")]
    pub(crate) cell: Option<String>,
    /// Costs of the arcs: N lines of N numbers ≥ 0, empty where there is no arc; row = from
    #[arg(long, value_name = "COSTS.csv", required_unless_present_any = ["cloud", "cell"], conflicts_with = "cloud")]
    pub(crate) graph: Option<PathBuf>,
    /// Points of an arm: x_mm,y_mm,z_mm, and if wanted q1 to q4 and cf1,cf4,cf6,cfx; or the robtargets of a RAPID
    /// module; needs CELL
    #[arg(long, value_name = "POINTS.csv", requires = "cell")]
    pub(crate) cloud: Option<PathBuf>,
    /// Campaign folder for the programs of CELL, with the graph and the reasons of refused moves; then `hairpin
    /// export OUT --to rapid`
    #[arg(long, value_name = "OUT", requires = "cell", conflicts_with = "graph")]
    pub(crate) out: Option<PathBuf>,
    /// Replace the campaign in --out
    #[arg(long, requires = "out", conflicts_with = "graph")]
    pub(crate) force: bool,
    /// Override one key of CELL's scenario, such as generate.mode=\"cartesian\"; repeatable
    #[arg(long = "set", value_name = "KEY=VALUE", requires = "cell", conflicts_with = "graph")]
    pub(crate) sets: Vec<String>,
    /// First point, counted from 0
    #[arg(long, value_name = "I")]
    pub(crate) start: Option<usize>,
    /// Last point, counted from 0
    #[arg(long, value_name = "J")]
    pub(crate) end: Option<usize>,
    /// Paths below this cost are not wanted
    #[arg(long, value_name = "C", allow_negative_numbers = true)]
    pub(crate) min_cost: Option<String>,
    /// How often a point may come; with more than once no move is used twice, there and back being two
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u16).range(bounds::VISITS))]
    pub(crate) visits: u16,
    /// How many pairwise different paths, the heaviest first
    #[arg(long, value_name = "K", default_value_t = 1, value_parser = clap::value_parser!(u16).range(bounds::PROGRAMS))]
    pub(crate) programs: u16,
    /// How to search
    #[arg(long, value_enum, default_value_t = SearchMethod::Auto, conflicts_with = "cell")]
    pub(crate) method: SearchMethod,
    /// Seconds after which the best so far is the answer
    #[arg(long, value_name = "S", value_parser = seconds, allow_negative_numbers = true)]
    pub(crate) time_limit: Option<f64>,
    /// Problems that each of up to 32 parts of branch and bound looks at: a limit that gives the same answer everywhere
    #[arg(long, value_name = "N", conflicts_with = "cell")]
    pub(crate) nodes: Option<u64>,
    /// Seed of the local search
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u64).range(..=LARGEST_SEED), allow_negative_numbers = true)]
    pub(crate) seed: u64,
    /// Write the proof of the answer
    #[arg(long, value_name = "OUT.json", conflicts_with_all = ["programs", "cell"])]
    pub(crate) certificate: Option<PathBuf>,
    /// Check a certificate against the graph by independent code instead of searching; exit code 1 if it does not hold
    #[arg(long, value_name = "CERTIFICATE.json", conflicts_with_all = ["certificate", "cell"])]
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
    /// Subsets up to 14 points, to 16 where branch does not end at once, else branch
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
