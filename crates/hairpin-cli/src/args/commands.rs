//! What of a folder from elsewhere may run.

use clap::Args;

/// Commands and Python files of a folder.
#[derive(Debug, Args)]
pub(crate) struct Commands {
    /// Let the folder or file run what it asks for: its execute.command, its Python. A folder that you were given is
    /// data: without this, only what you have run in it yourself runs
    #[arg(long)]
    pub(crate) allow_commands: bool,
}
