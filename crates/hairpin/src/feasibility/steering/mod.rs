//! Steering: one leg from one state to another, with the controls that fly it.
//!
//! | for | file | unknowns | ends |
//! | --- | --- | --- | --- |
//! | flights | [`leg`], [`proof`], [`flatness`] | none: one polynomial of degree 7 an axis | level, without rates |
//! | drives in the plane | [`shooting`] | a curve of κ(s) | pose and curvature |
//! | drives on the ground | [`shooting::rough`] | the flat goal | predicted pose and curvature |
//! | drives around places | [`clear`] | the same, and which way round | the same, clear all along |

pub mod clear;
pub mod flatness;
mod four_times;
pub mod halving;
pub mod leg;
pub mod leg_end;
pub mod proof;
pub mod shooting;
pub mod timing;

#[cfg(test)]
pub(crate) mod tests;

pub use flatness::{BodyState, Demand, DependentRotors, FlatState, Flatness};
pub use halving::ProofSettings;
pub use leg::LegJudge;
pub use leg_end::LegEnd;
pub use timing::LegTiming;
