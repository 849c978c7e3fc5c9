//! `hairpin compare`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

/// Pairs have the same case number, seed and waypoints. Exit code 1 where a case fails in B that passes in A; with
/// `--fail-on regression` also where a metric got worse: Wilcoxon's signed-rank test, corrected for the number of
/// metrics (Holm), below 0.05. Exit code 5 where pairs there are and none could be compared: executors failed, or data
/// are inconclusive.
#[derive(Debug, Args)]
pub(crate) struct Compare {
    /// Judged campaign folder: before
    #[arg(value_name = "OUT_A")]
    pub(crate) a: PathBuf,
    /// Judged campaign folder: after
    #[arg(value_name = "OUT_B")]
    pub(crate) b: PathBuf,
    /// What exit code 1 is for
    #[arg(long, value_enum, default_value_t = FailOn::NewlyFailing)]
    pub(crate) fail_on: FailOn,
    /// Deviations that differ by no more than this are unchanged, m; runs of another program are never equal to the
    /// last digit
    #[arg(long, value_name = "M", default_value_t = 1e-6, value_parser = super::numbers::not_negative, allow_negative_numbers = true)]
    pub(crate) tolerance_m: f64,
    /// Write a page with the runs of B over those of A, newly failing cases first
    #[arg(long, value_name = "FILE")]
    pub(crate) page: Option<PathBuf>,
    /// Write a JUnit file: newly failing cases are failures, those that failed before are skipped
    #[arg(long, value_name = "PATH")]
    pub(crate) junit: Option<PathBuf>,
    /// One JSON object on stdout
    #[arg(long)]
    pub(crate) json: bool,
}

/// What makes a comparison fail.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum FailOn {
    /// A case that fails in B and passes in A
    NewlyFailing,
    /// That, or a metric that got worse beyond chance
    Regression,
}
