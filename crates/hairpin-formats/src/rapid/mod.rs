//! ABB's RAPID, out and in: programs as modules that controllers load, and modules from cells as programs.
//!
//! The subset is in `docs/rapid.md`. What is written reads back to the same program, and that is written as the same
//! bytes.

mod builtin;
mod clock;
mod instructions;
mod kinds;
mod lex;
mod lines;
mod names;
mod parse;
mod read;
mod run;
mod syntax;
mod text;
mod value;
mod write;

#[cfg(test)]
mod tests;

pub use clock::{ArcTimes, Clocked, Clocking, LogError, arc_clock, is_log, read_log};
pub use lex::At;
pub use lines::{Class, Line};
pub use names::{LONGEST_NAME, NameError, as_name, check_name};
pub use read::{Declared, Found, Frames, Module, NoModule, Options, Procedure, read};
pub use write::{FIRST_RUN, RapidError, module, program_file, slow, write};
