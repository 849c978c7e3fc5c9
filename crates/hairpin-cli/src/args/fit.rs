//! `hairpin fit`.

use std::path::PathBuf;

use clap::{ArgGroup, Args};

use super::keys::Keys;
use super::numbers::small_share;
use super::resources::{Kernels, Threads};

/// Estimates a robot's numbers (of flights thrust to weight, drag, rotor lag, latency and the controller's bandwidth;
/// of drives latency, lags, scales and slips; of arms the servos' lags and delay) from logs of what a controller of
/// ours did or one that is taken for it, by output error with profile likelihood; what the logs do not show
/// is told as `not identifiable`. Writes a robot file. Exit code 0; 5 where nothing is told, or the fit is no better on
/// logs that it has not seen.
#[derive(Debug, Args)]
#[command(group(ArgGroup::new("flown").required(true).args(["mission", "campaign"])))]
pub(crate) struct Fit {
    /// Logs, in the world's frame; of a campaign's cases called CASE-RUN.csv or CASE.exec.tum, as `export` does
    #[arg(required = true, value_name = "LOGS")]
    pub(crate) logs: Vec<PathBuf>,
    /// Robot file or a shipped robot's name, to begin with
    #[arg(long, value_name = "ROBOT")]
    pub(crate) robot: String,
    /// Robot file to write
    #[arg(long, value_name = "FILE")]
    pub(crate) out: PathBuf,
    /// The mission that all logs are flights of: QGC .plan, QGC WPL 110 (.waypoints), CSV (x_m,y_m,z_m)
    #[arg(long, value_name = "FILE")]
    pub(crate) mission: Option<PathBuf>,
    /// Campaign folder whose cases the logs are flights of; its scenario says who steers
    #[arg(long, value_name = "DIR")]
    pub(crate) campaign: Option<PathBuf>,
    /// Share of the logs, the last ones, that the fit does not see and is tried on; each by a fit to the others if not
    /// given
    #[arg(long, value_name = "P", value_parser = small_share, allow_negative_numbers = true)]
    pub(crate) holdout: Option<f64>,
    #[command(flatten)]
    pub(crate) keys: Keys,
    /// One JSON object on stdout
    #[arg(long)]
    pub(crate) json: bool,
    #[command(flatten)]
    pub(crate) threads: Threads,
    #[command(flatten)]
    pub(crate) kernels: Kernels,
}
