//! What can be typed after `hairpin steer`.

mod effort;
mod keep_out;
mod names;

use std::path::PathBuf;

use clap::Args;

use super::numbers::{finite, milliseconds, not_negative, positive, steps};
use super::resources::Threads;
use super::terrain::{MapFlags, NoData};
use effort::Effort;
pub(crate) use effort::StartTable;
pub(crate) use keep_out::KeepOutFlags;
pub(crate) use names::SteerFrame;
use names::{SteerControl, SteerCost, SteerKinematics};

/// What asks one question.
const ONE: [&str; 2] = ["from", "to"];

/// Every answer is replayed by an integration of its own; `ok` means that the replay ends in the goal within 1 cm,
/// 0.01 rad and 0.01 1/m and keeps the vehicle's curvature and curvature rate.
///
/// Q.csv: id,x,y,yaw,k0,kf (from the start, m, rad, 1/m) or id,sx,sy,syaw,x,y,yaw,k0,kf; optional columns v0, vf,
/// direction, direction_end, frame, max_curvature, tolerance_m. R.csv has one row a segment: its curvature is a0 + a1 s
/// + … + a5 s^5.
#[derive(Debug, Args)]
pub(crate) struct Steer {
    /// Vehicle: a shipped rover's name, such as generic, a robot file, or a scenario, of which the robot alone is taken
    pub(crate) rover: String,
    /// Start in the map: X,Y,YAW or X,Y,YAW,CURVATURE; the origin if not given
    #[arg(long, value_name = "STATE", allow_hyphen_values = true, conflicts_with = "queries")]
    pub(crate) from: Option<String>,
    /// Goal in the map: X,Y,YAW or X,Y,YAW,CURVATURE
    #[arg(long, value_name = "STATE", allow_hyphen_values = true, conflicts_with = "queries")]
    pub(crate) to: Option<String>,
    /// Frame of --from and --to; files have a column for it
    #[arg(long, value_enum, default_value_t = SteerFrame::Enu, conflicts_with = "queries")]
    pub(crate) frame: SteerFrame,
    /// What curvature is a function of
    #[arg(long, value_enum, default_value_t = SteerControl::Quintic, value_name = "NAME")]
    pub(crate) control: SteerControl,
    /// Speed at the start, m/s; files have a column for it, which goes first
    #[arg(long, value_name = "M_S", value_parser = not_negative, allow_hyphen_values = true)]
    pub(crate) v0: Option<f64>,
    /// Speed at the goal, m/s; between different ones the speed is a ramp
    #[arg(long, value_name = "M_S", value_parser = not_negative, allow_hyphen_values = true)]
    pub(crate) vf: Option<f64>,
    /// Speed between, m/s: a trapezoid from v0 over this to vf
    #[arg(long, value_name = "M_S", value_parser = positive, allow_hyphen_values = true)]
    pub(crate) cruise: Option<f64>,
    /// Largest acceleration, m/s^2, where it is to be less than the vehicle's
    #[arg(long, value_name = "M_S2", value_parser = positive, allow_hyphen_values = true)]
    pub(crate) acceleration: Option<f64>,
    /// Direction of travel in the body, rad, for crabbing
    #[arg(long, value_name = "RAD", default_value_t = 0.0, value_parser = finite, allow_hyphen_values = true, conflicts_with = "queries")]
    pub(crate) direction: f64,
    /// Direction of travel at the goal, rad, where it turns evenly along the drive
    #[arg(long, value_name = "RAD", value_parser = finite, allow_hyphen_values = true, conflicts_with = "queries")]
    pub(crate) direction_end: Option<f64>,
    /// Largest |curvature|, 1/m, where it is to be less than the vehicle's
    #[arg(long, value_name = "K", value_parser = positive, allow_hyphen_values = true, conflicts_with = "queries")]
    pub(crate) max_curvature: Option<f64>,
    /// Distance from the goal that counts as there, m; 0.01 if not given
    #[arg(long, value_name = "M", value_parser = positive, allow_hyphen_values = true, conflicts_with = "queries")]
    pub(crate) tolerance_m: Option<f64>,
    /// File of queries
    #[arg(long, value_name = "Q.csv")]
    pub(crate) queries: Option<PathBuf>,
    /// Where the answers to --queries go; stdout if not given, with --json as `answers` of its object
    #[arg(long, value_name = "R.csv", requires = "queries", conflicts_with_all = ONE)]
    pub(crate) out: Option<PathBuf>,
    /// Go on behind the answers that --out has, of a run with the same arguments that was stopped
    #[arg(long, requires = "out", conflicts_with_all = ONE)]
    pub(crate) resume: bool,
    /// Elevation map to drive on
    #[arg(long, value_name = "DEM")]
    pub(crate) terrain: Option<PathBuf>,
    /// What moves the body on --terrain
    #[arg(long, value_enum, default_value_t = SteerKinematics::Source, value_name = "NAME", requires = "terrain")]
    pub(crate) kinematics: SteerKinematics,
    #[command(flatten)]
    pub(crate) map: MapFlags,
    /// What cells without data are; what is kept out of is driven around
    #[arg(long, value_enum, default_value_t = NoData::Error, requires = "terrain")]
    pub(crate) no_data: NoData,
    #[command(flatten)]
    pub(crate) keep_out: KeepOutFlags,
    /// What becomes small along the drive once it meets its goal: of quintics in the plane any, curvature or rate; on
    /// the ground any
    #[arg(long, value_enum, default_value_t = SteerCost::Any, value_name = "NAME")]
    pub(crate) cost: SteerCost,
    #[command(flatten)]
    pub(crate) effort: Effort,
    /// Time for each query; 0 gives the solver's start value
    #[arg(long, value_name = "N", value_parser = milliseconds, allow_negative_numbers = true)]
    pub(crate) time_limit_ms: Option<f64>,
    /// Allow changes of direction
    #[arg(long)]
    pub(crate) reversals: bool,
    /// Allow turns in place
    #[arg(long)]
    pub(crate) turns: bool,
    /// Draw the drives, seen from above, each from its start
    #[arg(long, value_name = "F.svg")]
    pub(crate) plot: Option<PathBuf>,
    /// Write the path of states, a row a time step
    #[arg(long, value_name = "F.csv", conflicts_with = "queries")]
    pub(crate) path: Option<PathBuf>,
    /// Write steer angles and speeds of the wheels, a row a time step
    #[arg(long, value_name = "F.csv", conflicts_with = "queries")]
    pub(crate) wheels: Option<PathBuf>,
    /// Time between rows of --path and --wheels; a thousandth of the drive's, at least 0.001 s, if not given
    #[arg(long, value_name = "S", value_parser = positive, allow_hyphen_values = true, conflicts_with = "queries")]
    pub(crate) time_step_s: Option<f64>,
    /// Steps of --path and --wheels at most; they are longer where there would be more
    #[arg(long, value_name = "N", default_value_t = 10_000, value_parser = steps)]
    pub(crate) max_steps: usize,
    /// One JSON object on stdout; its replay_steps are the replay's panels in the plane, and its strides on --terrain
    #[arg(long)]
    pub(crate) json: bool,
    #[command(flatten)]
    pub(crate) threads: Threads,
}
