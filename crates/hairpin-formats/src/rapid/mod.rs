//! ABB's RAPID, out and in: programs as modules that controllers load, and modules from cells as programs.
//!
//! The subset is in `docs/rapid.md`. What is written reads back to the same program, and that is written as the same
//! bytes.

mod builtin;
mod clock;
mod instructions;
mod kinds;
mod lex;
mod names;
mod outputs;
mod parse;
mod predefined;
mod program_file;
mod read;
mod run;
mod syntax;
mod text;
mod unmodelled;
mod value;
mod walk;
mod write;

#[cfg(test)]
mod tests;

pub use clock::{ArcTimes, Clocked, Clocking, LogError, arc_clock, is_log, read_log};
pub use names::{LONGEST_NAME, NameError, as_name, check_name};
pub use program_file::{ProgramFileError, modules_of};
pub use read::{Frames, NoModule, Options, read, read_all};
pub use write::{FIRST_RUN, RapidError, check_names, module, program_file, slow};
