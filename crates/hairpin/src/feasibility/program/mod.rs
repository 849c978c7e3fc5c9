//! Whether an arm can execute a program: every move followed in joints, proven between samples, with the number that refuses it.

mod finding;
mod posture;
mod walk;

#[cfg(test)]
mod tests;

pub use finding::{Finding, Fit};
pub use walk::{Checked, Surroundings, check};
