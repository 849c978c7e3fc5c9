//! Steering: one leg from one state to another, with the controls that fly it.

pub mod clear;
pub mod flatness;
pub mod leg;
pub mod proof;
pub mod shooting;
pub mod timing;

#[cfg(test)]
pub(crate) mod tests;

pub use flatness::{BodyState, Demand, DependentRotors, FlatState, Flatness};
pub use leg::{LegEnd, LegJudge};
pub use proof::ProofSettings;
pub use timing::LegTiming;
