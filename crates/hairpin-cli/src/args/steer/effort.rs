//! How exactly and how long is looked for drives.

use std::path::PathBuf;

use clap::Args;

use crate::args::numbers::{count, positive, share};

#[derive(Debug, Args)]
pub(crate) struct Effort {
    /// Difference from the goal's heading that counts as there, rad; 0.01 if not given
    #[arg(long, value_name = "RAD", value_parser = positive, allow_hyphen_values = true)]
    pub(crate) tolerance_yaw_rad: Option<f64>,
    /// Difference from the goal's curvature that counts as there, 1/m; 0.01 if not given
    #[arg(long, value_name = "K", value_parser = positive, allow_hyphen_values = true)]
    pub(crate) tolerance_curvature_1_m: Option<f64>,
    /// Difference from the speeds at both ends that counts as there, m/s; 0.01 if not given
    #[arg(long, value_name = "M_S", value_parser = positive, allow_hyphen_values = true)]
    pub(crate) tolerance_speed_m_s: Option<f64>,
    /// Steps of each search at most; 20 in the plane (60 for knots and functions of time), 30 predictions on the ground
    /// if not given
    #[arg(long, value_name = "N", value_parser = count)]
    pub(crate) iterations: Option<u32>,
    /// Share of each step that is taken, from 0.01 to 1
    #[arg(long, value_name = "SHARE", default_value_t = 1.0, value_parser = share, allow_hyphen_values = true)]
    pub(crate) step_scale: f64,
    /// Look start values of quintics and cubics up in a table that `hairpin start-table` made for the vehicle
    #[arg(long, value_name = "FILE")]
    pub(crate) start_table: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct StartTable {
    /// Vehicle: a shipped rover's name, such as generic, a robot file, or a scenario with one
    pub(crate) rover: String,
    /// Where the table goes, 180 kB
    #[arg(long, value_name = "FILE")]
    pub(crate) out: PathBuf,
    /// One JSON object on stdout
    #[arg(long)]
    pub(crate) json: bool,
}
