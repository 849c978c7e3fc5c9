//! Feasible and stressful trajectories of mobile robots: how many a reach set gives (figure 6), how their stress is
//! spread (figure 7), what scores, learning and executions in the loop lift (figure 8), the follow-up on the Anafi
//! (figures 9 to 11), and what a learned score comes to in another simulator.
//!
//! Source: Hildebrandt, Elbaum, Bezzo & Dwyer, "Feasible and stressful trajectory generation for mobile robots" (ISSTA
//! 2020).

mod cell;
mod follow_up;
mod lift;
mod metrics;
mod scores;
mod transfer;
mod yields;

pub(super) use follow_up::follow_up;
pub(super) use metrics::metrics;
pub(super) use scores::scores;
pub(super) use transfer::transfer;
pub(super) use yields::yields;
