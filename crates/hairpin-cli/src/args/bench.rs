//! What can be typed after `hairpin bench`.

use std::path::PathBuf;

use clap::{Args, Subcommand};

#[derive(Debug, Args)]
#[command(args_conflicts_with_subcommands = true)]
pub(crate) struct Bench {
    #[command(subcommand)]
    pub(crate) whole: Option<Whole>,
    /// Only those whose name begins so, such as beam; rover-worst is the table of the worst queries of the rover
    /// generator
    pub(crate) name: Option<String>,
    /// Flat queries of each family of rover-worst; a hundredth of it on the ground
    #[arg(long, value_name = "N", default_value_t = 1_000_000, value_parser = clap::value_parser!(u64).range(1..=100_000_000))]
    pub(crate) queries: u64,
    /// Length of the campaign whose memory is measured
    #[arg(long, value_name = "M", default_value_t = 0.2)]
    pub(crate) minutes: f64,
    /// Write the questions of the max-load benches as tables of costs into DIR instead, with DIR/questions.json, for
    /// other solvers
    #[arg(long, value_name = "DIR")]
    pub(crate) write: Option<PathBuf>,
    /// How many questions of each bench --write writes
    #[arg(long, value_name = "N", default_value_t = 11, value_parser = clap::value_parser!(u64).range(1..=10_000), requires = "write")]
    pub(crate) questions: u64,
    /// One JSON object on stdout
    #[arg(long)]
    pub(crate) json: bool,
}

/// Benches of more than kernels.
#[derive(Debug, Subcommand)]
pub(crate) enum Whole {
    /// Measure whole commands as they are typed, beside their kernels
    Commands(BenchCommands),
}

/// Each command runs as a process of its own, with inputs that are frozen in hairpin's repository: run it in a
/// checkout. Its time is that on processors. Targets decide nothing: the exit code is 0 whatever was measured. For one
/// core: taskset -c 0 hairpin bench commands.
#[derive(Debug, Args)]
pub(crate) struct BenchCommands {
    /// Only rows whose names begin so, such as steer select-1000; without any, all that take less than two minutes
    #[arg(value_name = "ROW")]
    pub(crate) rows: Vec<String>,
    /// Tell the rows and what is typed for them; measure nothing
    #[arg(long)]
    pub(crate) list: bool,
    /// How often each command runs, the median counts; a row that has taken a minute is not repeated
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = clap::value_parser!(u32).range(1..=100))]
    pub(crate) repeats: u32,
    /// The frozen inputs
    #[arg(long, value_name = "DIR", default_value = "bench/commands")]
    pub(crate) inputs: PathBuf,
    /// Where the folder is made, and removed, in which commands run; needs up to a gigabyte [default: the system's
    /// place]
    #[arg(long, value_name = "DIR")]
    pub(crate) scratch: Option<PathBuf>,
    /// One JSON object on stdout
    #[arg(long)]
    pub(crate) json: bool,
}

impl Bench {
    /// Whether stdout is for machines.
    pub(crate) fn json(&self) -> bool {
        match &self.whole {
            Some(Whole::Commands(commands)) => commands.json,
            None => self.json,
        }
    }
}
