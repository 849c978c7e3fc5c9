//! `hairpin check`.

use std::path::PathBuf;

use clap::Args;

use super::resources::Kernels;

/// Looks for a witness of a mission made elsewhere by the robot's own claim, at the speeds that the mission demands,
/// and tells leg by leg what is fastest and which limit is nearest; or tells the first limit that breaks, and by how
/// much. Exit code 0 where it is feasible, 1 where it is proven not to be, 5 where neither was found out. Nothing is
/// written.
#[derive(Debug, Args)]
pub(crate) struct Check {
    /// The mission: QGC .plan, QGC WPL 110 (.waypoints), CSV (x_m,y_m,z_m or lat_deg,lon_deg,alt_amsl_m)
    pub(crate) mission: PathBuf,
    /// A robot's name or file, or a scenario, whose world and limits then hold
    #[arg(long, value_name = "R")]
    pub(crate) robot: String,
    /// A world's name or file, a map, or a scenario whose world it is; nothing around a robot alone if not given
    #[arg(long, value_name = "W|SCENARIO")]
    pub(crate) world: Option<String>,
    /// Override one scenario key: dotted key, TOML value; repeatable
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub(crate) sets: Vec<String>,
    /// One JSON object on stdout: feasible, waypoint, limit, excess, and the legs
    #[arg(long)]
    pub(crate) json: bool,
    #[command(flatten)]
    pub(crate) kernels: Kernels,
}
