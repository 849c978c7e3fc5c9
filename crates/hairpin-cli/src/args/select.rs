//! `hairpin select`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::resources::Threads;

/// Cases keep their numbers and seeds, plans and runs, so that every other command takes the new folder. How stressful
/// and how different the chosen cases are is told beside the most stressful ones and all.
#[derive(Debug, Args)]
pub(crate) struct Select {
    /// Campaign folder
    #[arg(value_name = "OUT")]
    pub(crate) folder: PathBuf,
    /// How many cases to choose
    #[arg(long, value_name = "K", value_parser = clap::value_parser!(u32).range(1..))]
    pub(crate) cases: u32,
    /// What for
    #[arg(long, value_enum, default_value_t = SelectBy::Diverse)]
    pub(crate) by: SelectBy,
    /// The new campaign folder
    #[arg(long, value_name = "DIR")]
    pub(crate) out: PathBuf,
    /// Replace a campaign in --out
    #[arg(long)]
    pub(crate) force: bool,
    /// One JSON object on stdout
    #[arg(long)]
    pub(crate) json: bool,
    #[command(flatten)]
    pub(crate) threads: Threads,
}

/// What cases are chosen for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum SelectBy {
    /// The most stressful
    Stress,
    /// Stress and distance from each other, over waypoints and over behaviour
    Diverse,
    /// Cells of the grid of motion that are met: needs executed cases
    Coverage,
}
