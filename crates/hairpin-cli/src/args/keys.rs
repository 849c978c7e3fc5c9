//! Scenario keys that are typed.

use clap::Args;
use hairpin_jobs::bounds::LARGEST_SEED;

/// What is changed of a scenario.
#[derive(Debug, Args)]
pub(crate) struct Keys {
    /// Override one scenario key: dotted key, TOML value; repeatable
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub(crate) sets: Vec<String>,
    /// Root seed, instead of the scenario's
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(..=LARGEST_SEED), allow_negative_numbers = true)]
    pub(crate) seed: Option<u64>,
}
