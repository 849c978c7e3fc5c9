//! What flies: quadrotors in a cage.

mod assumptions;
mod blocking;
mod certificates;
mod check;
mod deaths;
mod fly;
mod graph;
mod legs;
mod place;
mod plan;
mod replan;
mod setup;
mod solve;
mod stepwise;
mod surround;
mod verify;
mod witness;

pub(super) use assumptions::{act, claim, searched_beside, verdict};
pub(super) use deaths::deaths;
pub(super) use fly::{Order, at_start, fly, goes_on};
pub(super) use place::place;
pub(super) use plan::{timed, track};
pub(super) use replan::replan;
pub use setup::FlightSetup;
pub(super) use setup::Flyer;
pub(super) use solve::Solver;
pub(super) use verify::{verify, verify_environment};
