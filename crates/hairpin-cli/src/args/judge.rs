//! What can be typed of `judge`: a campaign's folder, or logs and what they are judged against.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::junit::Junit;
use super::numbers::{finite, vector};
use super::resources::Threads;

#[derive(Debug, Args)]
pub(crate) struct Judge {
    /// Campaign folder; or a log, or a folder of logs: ULog, ArduPilot .bin, MCAP, TUM, CSV
    #[arg(value_name = "OUT|LOG|FOLDER")]
    pub(crate) path: PathBuf,
    /// Judge logs against the cases of this campaign
    #[arg(long, value_name = "OUT", conflicts_with_all = ["mission", "robot"])]
    pub(crate) campaign: Option<PathBuf>,
    /// Judge logs against this mission: QGC .plan, QGC WPL 110 (.waypoints), CSV (x_m,y_m,z_m)
    #[arg(long, value_name = "M")]
    pub(crate) mission: Option<PathBuf>,
    /// With --mission: who flew it, a robot's name or file
    #[arg(long, value_name = "R", requires = "mission")]
    pub(crate) robot: Option<String>,
    /// Judge logs in this world: a world's or scenario's file or name; its obstacles need not have been there
    #[arg(long, value_name = "W")]
    pub(crate) world: Option<String>,
    /// With --campaign: the case that was flown, instead of finding it out
    #[arg(long, value_name = "ID", requires = "campaign")]
    pub(crate) case: Option<String>,
    /// Of logs: the topic that poses or joints are from, instead of the best ranked
    #[arg(long, value_name = "TOPIC")]
    pub(crate) source: Option<String>,
    /// Of logs: turn their frame about z first, ° counter-clockwise seen from above
    #[arg(long, value_name = "DEG", value_parser = finite, allow_negative_numbers = true, default_value = "0")]
    pub(crate) turn: f64,
    /// Of logs: then move it, m
    #[arg(long, value_name = "X,Y,Z", value_parser = vector, allow_hyphen_values = true, default_value = "0,0,0")]
    pub(crate) offset: [f64; 3],
    /// Of logs with a place on Earth: whether heights above their own origin count, or those above the sea
    #[arg(long, value_enum, default_value = "relative")]
    pub(crate) altitude: AltitudeName,
    /// Of logs: judge from this moment of the log on, s
    #[arg(long, value_name = "S", value_parser = finite, allow_negative_numbers = true)]
    pub(crate) from: Option<f64>,
    /// Of logs: judge until this moment of the log, s
    #[arg(long, value_name = "S", value_parser = finite, allow_negative_numbers = true)]
    pub(crate) to: Option<f64>,
    /// Override one key of spec, or execute.log_clock of an arm's logs; repeatable
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub(crate) sets: Vec<String>,
    /// Of logs: write a page with what was planned, simulated and flown over each other
    #[arg(long, value_name = "FILE")]
    pub(crate) page: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) junit: Junit,
    /// One JSON object on stdout
    #[arg(long)]
    pub(crate) json: bool,
    #[command(flatten)]
    pub(crate) threads: Threads,
}

/// What `--altitude` takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum AltitudeName {
    /// Above the log's origin, and so above the world's
    Relative,
    /// Above the sea
    Amsl,
}
