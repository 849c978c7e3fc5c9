//! `hairpin shrink`.

use std::path::PathBuf;

use clap::Args;
use hairpin_jobs::shrink::ShrinkSettings;

use super::commands::Commands;
use super::numbers::seconds;
use super::resources::Kernels;

/// Drops waypoints, leaves out wind, gusts, noise, obstacles and varied values, and shortens legs, as long as the run
/// violates the same limit. Every candidate is feasible by the same claim as the case before it is executed.
/// Interrupted or out of budget, it writes the smallest so far, and the same command goes on.
#[derive(Debug, Args)]
pub(crate) struct Shrink {
    /// Judged campaign folder
    #[arg(value_name = "OUT")]
    pub(crate) folder: PathBuf,
    /// The violating case: its number
    #[arg(long, value_name = "ID")]
    pub(crate) case: usize,
    /// Executions of this command at most
    #[arg(long, value_name = "N", default_value_t = ShrinkSettings::default().budget, value_parser = clap::value_parser!(u64).range(1..))]
    pub(crate) budget: u64,
    /// Seconds after which it stops with the smallest so far
    #[arg(long, value_name = "S", value_parser = seconds, allow_negative_numbers = true)]
    pub(crate) time_limit: Option<f64>,
    /// File to write; repro/CASE-shrunk.json in OUT if not given
    #[arg(long, value_name = "FILE")]
    pub(crate) out: Option<PathBuf>,
    /// One JSON object on stdout
    #[arg(long)]
    pub(crate) json: bool,
    #[command(flatten)]
    pub(crate) kernels: Kernels,
    #[command(flatten)]
    pub(crate) commands: Commands,
}
