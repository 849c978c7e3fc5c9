//! The binary; all that it does is in the library.

fn main() -> std::process::ExitCode {
    hairpin_cli::run(std::env::args_os()).into()
}
