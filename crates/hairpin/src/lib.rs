//! hairpin finds the trajectories a robot handles worst, and proves that they are ones it could have flown.
//!
//! This crate is the numerics: no files, no clock, no global random state, no printing. Its rooms stand on
//! floors, and a room imports only from floors below its own (`tests/layers.rs` holds them to it):
//!
//! | floor | rooms |
//! | --- | --- |
//! | 1 | [`math`] |
//! | 2 | [`world`] |
//! | 3 | [`robot`] |
//! | 4 | [`trajectory`] |
//! | 5 | [`feasibility`], the claim · [`simulation`], the act · [`judgement`], the verdict: none knows the other two |
//! | 6 | [`search`] · [`verification`], the proof, which shares nothing with what it proves |
//! | 7 | [`campaign`] |
//!
//! Inside, everything is SI and radians, z up, body frame x forward, y left, z up.

#![cfg_attr(not(feature = "unit-tests"), deny(clippy::unwrap_used))] // tests may, what meets users' data may not

#[cfg(feature = "unit-tests")]
#[macro_use]
extern crate hairpin_test;

pub mod campaign;
pub mod feasibility;
pub mod judgement;
pub mod math;
pub mod robot;
pub mod search;
pub mod simulation;
pub mod trajectory;
#[cfg(feature = "unit-tests")]
pub mod unit_tests;
pub mod verification;
pub mod world;
