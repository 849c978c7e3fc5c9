//! The laboratory: the speeds that hairpin promises, the papers' experiments, and the requirements of a generator, each
//! measured here and now. Plain settings in, [`Findings`] out; nothing is printed.

#![cfg_attr(not(test), deny(clippy::unwrap_used))] // tests may, what meets users' data may not

pub mod bench;
mod clock;
mod drives;
pub mod experiment;
mod findings;
mod memory;
pub mod requirements;

pub use findings::{Findings, Words};
