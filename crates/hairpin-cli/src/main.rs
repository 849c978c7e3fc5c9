//! The binary; all that it does is in the library.

#![cfg_attr(not(test), deny(clippy::unwrap_used))] // tests may, what meets users' data may not

fn main() -> std::process::ExitCode {
    hairpin_cli::run(std::env::args_os()).into()
}
