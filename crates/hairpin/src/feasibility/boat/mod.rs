//! Boats: which legs a hull with three forces can sail in a current, and the roadmap of them.
//!
//! A leg is a polynomial of degree 7 for x, y and ψ, so that its controls follow in closed form: with three forces for
//! three degrees of freedom every smooth motion has exactly one τ(t). A leg counts if that keeps the thrusters' limits,
//! the speed and the waters at every instant of it, proven as for flights.
//!
//! | file | is |
//! | --- | --- |
//! | [`demand`] | from a motion to its forces, for numbers and enclosures alike |
//! | [`proof`] | forces and speed between samples |
//! | [`space`] | walls and places to keep out of between samples |
//! | [`leg`] | the leg between two waypoint states, judged cheapest test first |
//! | [`roadmap`] | waypoint states of a graph and the legs between them |
//!
//! Sound for the model in the current given: without lag of the thrusters, wind or waves. Complete for nothing: a leg
//! has one shape for a given time.
//!
//! Data flow of a leg: ends → polynomial ([`BoatJudge::connect`]) → instants → forces between samples ([`demand`],
//! `proof`) → waters between samples (`space`) → a leg, or [`BoatInfeasible`] with limit, time and margin. World
//! frame: x east, y north, m; ψ from x towards y; body: surge ahead, sway to port.

pub mod demand;
pub mod leg;
pub mod limits;
pub mod proof;
pub mod roadmap;
pub mod space;
#[cfg(feature = "unit-tests")]
mod tests;
pub mod waters;

pub use demand::{BoatDemand, BoatMotion, ForceMap, Turning};
pub use leg::{BoatEnd, BoatJudge};
pub use limits::{BoatInfeasible, BoatLimit, BoatLimits};
pub use roadmap::{BoatRoadmap, BoatRoadmapSettings};
pub use waters::BoatWaters;
