//! `hairpin calibrate`.

use clap::Args;

use super::commands::Commands;
use super::keys::Keys;
use super::numbers::small_share;
use super::resources::{Kernels, Threads};

/// Flies random feasible cases of the scenario, 200 at least and none of its campaign's, and proposes for every limit
/// of its [spec] (for the deviation where it has none) the one that the share of them breaks, with its 95 % interval.
/// Nothing is written. Exit code 0, 3 where nothing is feasible, 5 where no limit follows.
#[derive(Debug, Args)]
pub(crate) struct Calibrate {
    /// Scenario file, the name of a shipped scenario or robot, or a campaign folder's scenario.toml
    pub(crate) scenario: String,
    /// Share of random feasible cases that is to break each limit
    #[arg(long, value_name = "P", default_value_t = 0.05, value_parser = small_share, allow_negative_numbers = true)]
    pub(crate) share: f64,
    /// Cases that are flown; as many as the share takes, 200 at least, if not given
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=100_000), allow_negative_numbers = true)]
    pub(crate) cases: Option<u64>,
    #[command(flatten)]
    pub(crate) keys: Keys,
    /// Who flies: a program that speaks the executor protocol, instead of the scenario's executor
    #[arg(long, value_name = "CMD")]
    pub(crate) executor: Option<String>,
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
