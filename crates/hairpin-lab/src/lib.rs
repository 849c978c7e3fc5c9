//! The laboratory: the speeds that hairpin promises, the papers' experiments, and the requirements of a generator, each
//! measured here and now. Plain settings in, [`Findings`] out; nothing is printed.

pub mod bench;
mod clock;
mod drives;
pub mod experiment;
mod findings;
mod memory;
pub mod requirements;

pub use findings::{Findings, Words};
