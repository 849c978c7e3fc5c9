//! What drives: rovers on elevation maps, cars and differential drives.

mod ask;
mod assumptions;
mod check;
mod deaths;
mod execute;
mod legs;
mod place;
mod plan;
mod replan;
mod setup;
mod site;
mod solve;
mod stepwise;
mod surround;
mod verify;

pub(super) use assumptions::{act, claim, searched_beside, verdict};
pub(super) use deaths::deaths;
pub(super) use execute::{Order, drive};
pub(super) use place::place;
pub(super) use plan::{timed, track};
pub(super) use replan::replan;
pub use setup::DriveSetup;
pub(super) use setup::Driver;
pub use site::{Site, drive_piece, flat_claim, replay_flat};
pub(super) use solve::Solver;
pub(super) use verify::{verify, verify_environment};
