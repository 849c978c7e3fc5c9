//! Whether an arm can execute a program: every move followed in joints, proven between samples, with the number that
//! refuses it.
//!
//! A program is data of somebody else's: moves may begin where nothing is known of the arm, targets may demand
//! configurations that cannot be met, and what is refused is told with the number and, where one exists, a
//! configuration that fits. Whether blends stay clear is not looked at here.

mod finding;
mod posture;
mod walk;

#[cfg(feature = "unit-tests")]
mod tests;

pub use finding::{Checked, Finding, Fit};
pub use walk::{Surroundings, check};
