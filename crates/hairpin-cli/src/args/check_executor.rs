//! `hairpin check-executor`.

use clap::Args;

use super::commands::Commands;
use super::keys::Keys;
use super::numbers::seconds;

/// Takes a program through the executor protocol and tells what was said: handshake, a mission, the same again by
/// the same process and by a new one, a mission that nobody can fly, one that is ended amid its flight, speed, and bye;
/// with a sentence for each mistake. Nothing is written. Exit code 0 if it is sound, 4 if not.
#[derive(Debug, Args)]
pub(crate) struct CheckExecutor {
    /// The program's command line, as --executor takes it
    #[arg(value_name = "CMD")]
    pub(crate) command: String,
    /// Scenario file, or the name of a shipped scenario or robot, whose robot and missions it gets; a small flight of a
    /// quadrotor if not given
    #[arg(long, value_name = "FILE")]
    pub(crate) scenario: Option<String>,
    /// Seconds that a mission may take, and the handshake; the scenario's execute.timeout_s if not given
    #[arg(long, value_name = "S", value_parser = seconds, allow_negative_numbers = true)]
    pub(crate) timeout: Option<f64>,
    #[command(flatten)]
    pub(crate) keys: Keys,
    /// One JSON object on stdout, with all lines as they were
    #[arg(long)]
    pub(crate) json: bool,
    #[command(flatten)]
    pub(crate) commands: Commands,
}
