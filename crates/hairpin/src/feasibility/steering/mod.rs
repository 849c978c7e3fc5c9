//! Steering: one leg from one state to another, with the controls that fly it.
//!
//! | for | file | unknowns | ends |
//! | --- | --- | --- | --- |
//! | flights | [`leg`], [`proof`], [`flatness`] | none: one polynomial of degree 7 an axis | level, without rates |
//! | drives in the plane | [`shooting`] | a curve of κ(s) | pose and curvature |
//! | drives on the ground | [`shooting::rough`] | the flat goal | predicted pose and curvature |
//! | drives around places | [`clear`] | the same, and which way round | the same, clear all along |
//!
//! A leg of a flight is judged, not searched: value, velocity, acceleration and jerk at both ends fix the polynomial,
//! and a time is all that is chosen ([`timing`]). A leg of a drive is searched: bounds on κ and κ′ leave a family of
//! curves, and the boundary-value problem picks one. Nothing here knows of graphs or of more than one leg; what is
//! answered is either a leg with its proof or the evidence against it.

pub mod clear;
pub(in crate::feasibility) mod eight_ends;
pub(in crate::feasibility) mod firsts;
pub mod flatness;
pub mod halving;
pub mod leg;
pub mod leg_end;
pub mod proof;
pub mod shooting;
pub mod timing;
mod together;

#[cfg(feature = "unit-tests")]
pub(crate) mod tests;

pub use flatness::{BodyState, Demand, DependentRotors, FlatState, Flatness};
pub use halving::ProofSettings;
pub use leg::LegJudge;
pub use leg_end::LegEnd;
pub use timing::LegTiming;
