//! `hairpin plan`, `run-shard` and `merge`.

use std::path::PathBuf;

use clap::Args;

use super::commands::Commands;
use super::keys::Keys;
use super::pipeline::Kept;
use super::resources::{Kernels, Threads};

/// The parts are the same for any number of shards, and each case's seed follows from its number, never from the
/// machine: whatever is run where, in which order and how often, `merge` gives what `stress` gives on one machine.
#[derive(Debug, Args)]
pub(crate) struct Plan {
    /// Scenario file, or the name of a shipped scenario or robot
    pub(crate) scenario: String,
    /// Campaign folder, where all machines can read and write; out/NAME of the scenario if not given
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) keys: Keys,
    /// Cases asked for, instead of the scenario's
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    pub(crate) cases: Option<u64>,
    /// Program that flies the missions (sets execute.command); see examples/executors
    #[arg(long, value_name = "COMMAND")]
    pub(crate) executor: Option<String>,
    /// Parts that the work is divided into; 64, or as many as there are graphs or cases. More shards than parts have
    /// nothing to do
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    pub(crate) parts: Option<u64>,
    #[command(flatten)]
    pub(crate) kept: Kept,
    /// Take up the same plan again (same arguments, same --out)
    #[arg(long, conflicts_with = "force")]
    pub(crate) resume: bool,
    /// Replace the campaign in --out, and all parts that were made of it
    #[arg(long)]
    pub(crate) force: bool,
    /// One JSON object on stdout
    #[arg(long)]
    pub(crate) json: bool,
    #[command(flatten)]
    pub(crate) kernels: Kernels,
    #[command(flatten)]
    pub(crate) commands: Commands,
}

/// Makes the parts of one shard: every N-th of the plan, those that are there and whole left out. A part appears whole
/// or not at all, so that a shard that was killed is simply run again. A search that learns is shared round by round by
/// all shards that run.
#[derive(Debug, Args)]
#[command(
    override_usage = "hairpin run-shard [OPTIONS] <I/N> <DIR>\n       hairpin run-shard [OPTIONS] --shard from-env <DIR>"
)]
pub(crate) struct RunShard {
    /// The shard, such as 3/8, from 1 (unless --shard says it), and the folder of the plan
    #[arg(value_name = "I/N> <DIR", num_args = 1..=2, required = true)]
    pub(crate) words: Vec<String>,
    /// The shard, or `from-env`: the index of a Slurm array, a Kubernetes indexed Job or an AWS Batch array
    #[arg(long, value_name = "I/N|from-env")]
    pub(crate) shard: Option<String>,
    /// With from-env: how many shards there are, where the scheduler does not say it
    #[arg(long, value_name = "N", requires = "shard", value_parser = clap::value_parser!(u64).range(1..))]
    pub(crate) shards: Option<u64>,
    /// One JSON object on stdout
    #[arg(long)]
    pub(crate) json: bool,
    #[command(flatten)]
    pub(crate) threads: Threads,
    #[command(flatten)]
    pub(crate) commands: Commands,
}

/// Flies what no part has, judges and writes the report. Exit code 0 once all is put together, whatever the verdict;
/// `hairpin judge DIR` has the verdict's own. A part that is missing is exit code 2.
#[derive(Debug, Args)]
pub(crate) struct Merge {
    /// The folder of the plan
    #[arg(value_name = "DIR")]
    pub(crate) folder: PathBuf,
    /// Remove the plan and its parts once all is put together: what is left is an ordinary campaign
    #[arg(long)]
    pub(crate) remove_parts: bool,
    /// One JSON object on stdout: content_hash, parts, counts, verdict
    #[arg(long)]
    pub(crate) json: bool,
    #[command(flatten)]
    pub(crate) threads: Threads,
    #[command(flatten)]
    pub(crate) commands: Commands,
}
