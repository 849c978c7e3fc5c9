//! What can be typed of files from elsewhere.

use std::path::PathBuf;

use clap::Args;

#[derive(Debug, Args)]
pub(crate) struct Import {
    /// RAPID module (.mod); docs/rapid.md says which RAPID is understood
    pub(crate) file: PathBuf,
    /// Follow every move in the joints of an arm: reach, limits, singularities, configurations, by line
    #[arg(long)]
    pub(crate) check: bool,
    /// The arm: a shipped name, an arm's file or a URDF
    #[arg(long, value_name = "ARM", default_value = "irb120", requires = "check")]
    pub(crate) robot: String,
    /// The procedure to execute; `main` if there is one, else the first that no other calls
    #[arg(long, value_name = "NAME")]
    pub(crate) procedure: Option<String>,
    /// Tell every line's class: understood, harmless to motion, changes motion, not reached
    #[arg(long)]
    pub(crate) lines: bool,
    /// One JSON object on stdout
    #[arg(long)]
    pub(crate) json: bool,
}
