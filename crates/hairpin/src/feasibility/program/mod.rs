//! Whether an arm can execute a program: every move followed in joints, with the number that refuses it.

mod finding;
mod follow;
mod posture;
mod walk;

#[cfg(test)]
mod tests;

pub use finding::{Fault, Finding, Fit};
pub use follow::FollowSettings;
pub use walk::{Checked, check};
