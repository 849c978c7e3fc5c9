//! What can be typed of files from elsewhere.

use std::path::PathBuf;

use clap::Args;

#[derive(Debug, Args)]
pub(crate) struct Import {
    /// RAPID modules that are one program (.mod, .sys; docs/rapid.md says which RAPID is understood) or the program
    /// file (.pgf) that names them, KRL (.src), URScript (.script), or the log that arc_clock.mod wrote; a robot's log
    /// (.ulg, .bin, .mcap, .tum, .csv); a mission (.plan, .waypoints, .csv): which of them is told by the content
    #[arg(required = true, value_name = "FILE")]
    pub(crate) files: Vec<PathBuf>,
    /// Follow every move in the joints of an arm: reach, limits, singularities, configurations, collisions, by line
    #[arg(long)]
    pub(crate) check: bool,
    /// The arm: a shipped name, an arm's file or a URDF
    #[arg(long, value_name = "ARM", default_value = "irb120", requires = "check")]
    pub(crate) robot: String,
    /// What stands around it: a scenario of an arm, by file or name, with its arm, obstacles, clearance and the tool's
    /// radius
    #[arg(long, value_name = "CELL", requires = "check", conflicts_with = "robot")]
    pub(crate) cell: Option<String>,
    /// Of a URDF: the link that is the flange
    #[arg(long, value_name = "LINK", requires = "check", conflicts_with = "cell")]
    pub(crate) tip: Option<String>,
    /// Of a URDF: a folder in which the packages of its meshes lie (package://NAME/…); repeatable
    #[arg(long, value_name = "DIR", requires = "check", conflicts_with = "cell")]
    pub(crate) packages: Vec<String>,
    /// Of a URDF: the SRDF that says which links are not held against each other
    #[arg(long, value_name = "FILE", requires = "check", conflicts_with = "cell")]
    pub(crate) srdf: Option<String>,
    /// Override one key of the cell's scenario, or of the arm (robot.KEY): dotted key, TOML value; repeatable
    #[arg(long = "set", value_name = "KEY=VALUE", requires = "check")]
    pub(crate) sets: Vec<String>,
    /// The procedure to execute; `main` if there is one, else the first that no other calls
    #[arg(long, value_name = "NAME")]
    pub(crate) procedure: Option<String>,
    /// Tell every line's class: understood, harmless to motion, changes motion, not reached
    #[arg(long)]
    pub(crate) lines: bool,
    /// Of an arc clock's log: where the table of costs goes; arc_ms.csv beside the log if not given
    #[arg(long, value_name = "CSV", conflicts_with_all = ["check", "lines", "procedure"])]
    pub(crate) out: Option<PathBuf>,
    /// One JSON object on stdout
    #[arg(long)]
    pub(crate) json: bool,
}
