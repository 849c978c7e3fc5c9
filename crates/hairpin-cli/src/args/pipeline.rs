//! The pipeline's own commands: `stress`, and each of its steps alone.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::commands::Commands;
use super::junit::Junit;
use super::keys::Keys;
use super::numbers::{duration, seconds};
use super::resources::{Kernels, Threads};

/// What every command that begins a campaign takes.
#[derive(Debug, Args)]
pub(crate) struct Campaign {
    /// Scenario file, or the name of a shipped scenario or robot
    pub(crate) scenario: String,
    /// Campaign folder; out/NAME of the scenario if not given
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) keys: Keys,
    /// Go on with an interrupted campaign (same arguments, same --out)
    #[arg(long, conflicts_with = "force")]
    pub(crate) resume: bool,
    /// Replace the campaign in --out
    #[arg(long)]
    pub(crate) force: bool,
    /// Seconds after which generation stops and keeps what exists
    #[arg(long, value_name = "S", value_parser = seconds, allow_negative_numbers = true)]
    pub(crate) time_limit: Option<f64>,
    /// One JSON object on stdout
    #[arg(long)]
    pub(crate) json: bool,
    #[command(flatten)]
    pub(crate) threads: Threads,
    #[command(flatten)]
    pub(crate) kernels: Kernels,
    #[command(flatten)]
    pub(crate) commands: Commands,
}

#[derive(Debug, Args)]
pub(crate) struct Stress {
    #[command(flatten)]
    pub(crate) campaign: Campaign,
    /// Program that flies the missions (sets execute.command); see examples/executors
    #[arg(long, value_name = "COMMAND")]
    pub(crate) executor: Option<String>,
    /// Judge these missions (QGC .plan, QGC WPL 110, CSV) and compare them with what the search finds, which is not
    /// judged
    #[arg(long, value_name = "DIR|FILE")]
    pub(crate) missions: Option<PathBuf>,
    /// Time for the whole of it, such as 90s, 5m or 1h: search, runs and judgement end within it, and what is not done
    /// by then is told and is no pass
    #[arg(long, value_name = "TIME", value_parser = duration)]
    pub(crate) budget: Option<f64>,
    #[command(flatten)]
    pub(crate) junit: Junit,
    #[command(flatten)]
    pub(crate) kept: Kept,
    #[command(flatten)]
    pub(crate) saved: Saved,
}

/// Of which runs the motion is kept.
#[derive(Debug, Args)]
pub(crate) struct Kept {
    /// Runs whose motion is kept (sets execute.record); the measures and the verdict of all stay either way
    #[arg(long, value_enum, value_name = "RUNS")]
    pub(crate) keep: Option<Keep>,
}

/// What `--keep` takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Keep {
    /// Every run (the default)
    All,
    /// The worst run of each of the ten worst cases
    Worst,
    /// No run
    None,
}

/// Saved violations that are run first.
#[derive(Debug, Args)]
pub(crate) struct Saved {
    /// Run the repro files of this folder first, by this campaign's robot, execute and spec; without it those that the
    /// campaign folder has
    #[arg(long, value_name = "DIR")]
    pub(crate) repro: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct Generate {
    #[command(flatten)]
    pub(crate) campaign: Campaign,
}

#[derive(Debug, Args)]
pub(crate) struct Execute {
    /// Campaign folder
    #[arg(value_name = "OUT")]
    pub(crate) folder: PathBuf,
    /// Keep OUT as it is, and the runs in a campaign of their own with the same cases: two programs' side by side
    #[arg(long, value_name = "DIR", conflicts_with = "logs")]
    pub(crate) out: Option<PathBuf>,
    /// Replace a campaign in --out
    #[arg(long, requires = "out", conflicts_with = "resume")]
    pub(crate) force: bool,
    /// Fly these missions (QGC .plan, QGC WPL 110, CSV) instead of the folder's cases
    #[arg(long, value_name = "DIR|FILE")]
    pub(crate) missions: Option<PathBuf>,
    /// Program that flies the missions (sets execute.command); see examples/executors
    #[arg(long, value_name = "COMMAND")]
    pub(crate) executor: Option<String>,
    #[command(flatten)]
    pub(crate) kept: Kept,
    #[command(flatten)]
    pub(crate) saved: Saved,
    /// Of arms: logs of a real controller instead of runs of ours, `*` for CASE-RUN (sets execute.logs):
    /// 'nightly/*.csv'
    #[arg(long, value_name = "PATTERN", conflicts_with_all = ["missions", "executor"])]
    pub(crate) logs: Option<String>,
    /// Run every violation N times again with other noise (sets execute.flaky.reruns): how often does it come again?
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=100_000))]
    pub(crate) rerun_violations: Option<u32>,
    /// Override one key of execute, vary or spec; repeatable
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub(crate) sets: Vec<String>,
    /// Keep the runs that are there
    #[arg(long, conflicts_with = "missions")]
    pub(crate) resume: bool,
    /// One JSON object on stdout
    #[arg(long)]
    pub(crate) json: bool,
    #[command(flatten)]
    pub(crate) threads: Threads,
    #[command(flatten)]
    pub(crate) kernels: Kernels,
    #[command(flatten)]
    pub(crate) commands: Commands,
}

#[derive(Debug, Args)]
pub(crate) struct Verify {
    /// Campaign folder
    #[arg(value_name = "OUT")]
    pub(crate) folder: PathBuf,
    /// One JSON object on stdout: checked, failed, worst
    #[arg(long)]
    pub(crate) json: bool,
    #[command(flatten)]
    pub(crate) threads: Threads,
}

#[derive(Debug, Args)]
pub(crate) struct Replay {
    /// repro/CASE.json of a campaign folder, or with --case the folder
    #[arg(value_name = "REPRO")]
    pub(crate) file: PathBuf,
    /// The worst run of this case of the campaign folder
    #[arg(long, value_name = "CASE")]
    pub(crate) case: Option<String>,
    /// One JSON object on stdout
    #[arg(long)]
    pub(crate) json: bool,
    #[command(flatten)]
    pub(crate) kernels: Kernels,
    #[command(flatten)]
    pub(crate) commands: Commands,
}

#[derive(Debug, Args)]
pub(crate) struct Export {
    /// Campaign folder
    #[arg(value_name = "OUT")]
    pub(crate) folder: PathBuf,
    /// Formats, separated by commas; the files go into OUT/export
    #[arg(long, value_enum, value_delimiter = ',', required_unless_present = "flights")]
    pub(crate) to: Vec<Format>,
    /// The day card (day-card.html) of the N cases worth flying today
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub(crate) flights: Option<u32>,
    /// This case alone; repeatable
    #[arg(long, value_name = "ID", conflicts_with = "worst")]
    pub(crate) case: Vec<usize>,
    /// The N worst cases alone
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub(crate) worst: Option<u32>,
    /// Whose missions plan and wpl are
    #[arg(long, value_enum, default_value_t = Autopilot::Px4)]
    pub(crate) autopilot: Autopilot,
    /// Write for hardware what leaves the keep-in margin all the same; the files record it
    #[arg(long)]
    pub(crate) accept_excursion: bool,
    /// One JSON object on stdout: the files
    #[arg(long)]
    pub(crate) json: bool,
}

/// Formats of `export`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Format {
    /// CASE.csv: x_m,y_m,z_m
    Waypoints,
    /// CASE.geodetic.csv: lat_deg,lon_deg,alt_amsl_m,relative_alt_m by world.origin or the map's EPSG code
    Geodetic,
    /// CASE.planned.csv and CASE-RUN.csv: poses in time, quaternions w first
    Csv,
    /// Of arms: CASE.mod, CASE_slow.mod for the first run, and CASE.pgf, which names the module
    Rapid,
    /// Of arms: CASE.script for Universal Robots
    Urscript,
    /// Of arms: CASE.src and CASE.dat for KUKA
    Krl,
    /// Of arms: CASE.joint_trajectory.json, the planned joints every 10 ms as a ROS 2 message
    JointTrajectory,
    /// Of arms: arc_clock.mod, which clocks every move of the graph on the controller; then `hairpin import arc_ms.log`
    ArcClock,
    /// CASE.ref.tum and CASE.exec.tum: planned motion and worst run on the same stamps, not aligned
    Tum,
    /// CASE.mcap: planned motion, runs and obstacles for Foxglove, protocol buffers
    Mcap,
    /// CASE.ros2.mcap: planned motion, runs and an arm's joints for ROS 2
    McapRos2,
    /// CASE.plan of QGroundControl, and CASE.params; by world.origin or the map's EPSG code
    Plan,
    /// CASE.waypoints (QGC WPL 110), and CASE.params; likewise
    Wpl,
    /// CASE.setpoints.csv: t, then place, velocity and acceleration north, east, down of home, and yaw; likewise
    Setpoints,
    /// CASE.poly4d.csv and CASE.poly4d.bin, polynomials of the Crazyflie's high-level commander
    Poly4d,
}

/// Whose missions are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Autopilot {
    /// PX4
    Px4,
    /// ArduPilot: Copter, or Rover
    Ardupilot,
}

#[derive(Debug, Args)]
pub(crate) struct ReportArguments {
    /// Campaign folder
    #[arg(value_name = "OUT")]
    pub(crate) folder: PathBuf,
    /// Have this case among those that open, and open the page at it; repeatable
    #[arg(long, value_name = "ID")]
    pub(crate) case: Vec<usize>,
    /// Write top and side view of the case that it opens with, for papers and pages
    #[arg(long, value_name = "FILE.svg")]
    pub(crate) picture: Option<PathBuf>,
    /// Open it in the browser
    #[arg(long)]
    pub(crate) open: bool,
    /// One JSON object on stdout
    #[arg(long)]
    pub(crate) json: bool,
}
