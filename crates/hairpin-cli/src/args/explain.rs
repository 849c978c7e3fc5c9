//! `hairpin explain`.

use clap::Args;
use hairpin_jobs::bounds;
use hairpin_jobs::explain::ExplainSettings;

use super::commands::Commands;
use super::keys::Keys;
use super::numbers::seconds;
use super::resources::{Kernels, Threads};

/// Searches a fixed number of graphs, counts where candidates for legs are lost, by limit, and where nothing is
/// feasible changes one key at a time, as little as helps. Exit code 3 where nothing is feasible, else 0. Nothing is
/// written.
#[derive(Debug, Args)]
pub(crate) struct Explain {
    /// Scenario file, the name of a shipped scenario or robot, or a campaign folder's scenario.toml
    pub(crate) scenario: String,
    #[command(flatten)]
    pub(crate) keys: Keys,
    /// Graphs that are sampled and searched; with every change the same ones
    #[arg(long, value_name = "N", default_value_t = ExplainSettings::default().graphs, value_parser = clap::value_parser!(u64).range(bounds::GRAPHS))]
    pub(crate) graphs: u64,
    /// Seconds after which no further change is tried [default: 60, of arms 3]
    #[arg(long, value_name = "S", value_parser = seconds, allow_negative_numbers = true)]
    pub(crate) time_limit: Option<f64>,
    /// One JSON object on stdout
    #[arg(long)]
    pub(crate) json: bool,
    #[command(flatten)]
    pub(crate) threads: Threads,
    #[command(flatten)]
    pub(crate) kernels: Kernels,
    #[command(flatten)]
    pub(crate) commands: Commands,
}
