//! What can be typed of what a project is begun with.

use std::path::PathBuf;

use clap::{Args, Subcommand, ValueEnum};

#[derive(Debug, Args)]
pub(crate) struct Init {
    #[command(subcommand)]
    pub(crate) what: Initial,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Initial {
    /// A build server's workflow: stress within a budget, saved violations first, JUnit, report and cache
    Ci(Ci),
}

#[derive(Debug, Args)]
pub(crate) struct Ci {
    /// The build server
    #[arg(value_enum)]
    pub(crate) server: Server,
    /// The scenario that it stresses
    #[arg(long, value_name = "SCENARIO", default_value = "quadrotor.toml")]
    pub(crate) scenario: String,
    /// Where hairpin is installed from: a Git address that `cargo install --git` takes
    #[arg(long, value_name = "URL")]
    pub(crate) source: Option<String>,
    /// File to write; where the server looks for it if not given
    #[arg(long, value_name = "FILE")]
    pub(crate) out: Option<PathBuf>,
    /// Overwrite the file
    #[arg(long)]
    pub(crate) force: bool,
    /// One JSON object on stdout
    #[arg(long)]
    pub(crate) json: bool,
}

/// Build servers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Server {
    /// GitHub Actions: .github/workflows/hairpin.yml
    Github,
    /// GitLab CI: .gitlab-ci.yml
    Gitlab,
    /// Jenkins: Jenkinsfile
    Jenkins,
}
