//! RobTest: table I, figure 7, and the threats that its authors named.
//!
//! Source: Collet, Gotlieb, Lazaar & Mossige, "Stress testing of single-arm robots through constraint-based generation
//! of continuous trajectories" (2019).

mod figure_7;
mod question;
mod sweep;
mod table_1;
mod timed;

pub(super) use figure_7::figure_7;
pub(super) use sweep::{clusters, costs, obstacles};
pub(super) use table_1::table_1;
