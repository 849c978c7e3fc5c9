//! Feasible and stressful trajectories of mobile robots: how many a reach set gives (figure 6), and what scores, learning and
//! executions in the loop lift (figure 8).
//!
//! Source: Hildebrandt, Elbaum, Bezzo & Dwyer, "Feasible and stressful trajectory generation for mobile robots" (ISSTA 2020).

mod cell;
mod scores;
mod yields;

pub(super) use scores::scores;
pub(super) use yields::yields;
