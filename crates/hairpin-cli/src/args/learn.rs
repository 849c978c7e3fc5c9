//! `hairpin learn`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

/// Learns per-leg stress from the executed legs of a campaign, as a polynomial of what the search saw of them. Degree and penalty
/// are chosen by 10-fold cross-validation over trajectories; the quality told is that on trajectories that took no part.
#[derive(Debug, Args)]
pub(crate) struct Learn {
    /// Campaign folder
    #[arg(value_name = "OUT")]
    pub(crate) folder: PathBuf,
    /// The model file
    #[arg(long, value_name = "MODEL", default_value = "score-model.json")]
    pub(crate) out: PathBuf,
    /// What is learned
    #[arg(long, value_enum, default_value_t = LearnedStress::MaxDeviation)]
    pub(crate) stress: LearnedStress,
    /// One JSON object on stdout
    #[arg(long)]
    pub(crate) json: bool,
}

/// What can be learned of a leg.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum LearnedStress {
    MaxDeviation,
    MeanDeviation,
    MaxAcceleration,
    Time,
    Overshoot,
    Saturation,
    Tilt,
}
