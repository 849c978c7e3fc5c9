//! Simulation in the loop: trajectories are scored by executing them, under a budget of executions.
//!
//! [`evolve`] changes waypoint sequences within the legs of a graph, from the best that scores know of; [`shift`] then
//! moves the waypoints themselves, as far as the reach set lets them; [`climb`] searches a few numbers beside them.
//! They know executions only as a closure, which is told the [`Rank`] from which on a trial is of use. [`Executed`]
//! scores the partial trajectories of a beam by executing them leg by leg.
//!
//! Data flow: optima under scores and uniform draws → executed → [`evolve`] over sequences → [`shift`] of waypoints →
//! [`climb`] over wind, gust or force, each given its share of one budget of executions. All randomness is seeded, each
//! search is serial within a graph, and graphs are independent: a campaign is the same on any number of threads.
//!
//! A search for a maximum of a noisy function also finds luck; [`Trial::executions`] counts more than one where what
//! would be kept is executed again.

mod climb;
mod evolve;
mod nearby;
mod partial;
mod rank;
mod regrow;
mod shift;
mod step;
#[cfg(feature = "unit-tests")]
mod tests;

pub use climb::{Climbed, climb};
pub use evolve::{EvolveSettings, Evolved, Tested, evolve};
pub use partial::{Execute, Executed, PartialSettings, Path, Ran, Step};
pub use rank::Rank;
pub use shift::{ShiftSettings, Shifted, shift};

/// What an execution came to.
///
/// An execution that came to no run is no trial: closures then answer `None`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Trial {
    /// The stress that is searched for; larger is worse for the robot.
    pub stress: f64,
    /// Whether it came to an end that is worse than any stress; its stress is that of the way until then, −∞ where
    /// nothing of that was measured ([`Rank::of`]).
    pub fails: bool,
    /// The leg that it is owed to.
    pub worst_leg: usize,
    /// Executions that it took: more than one where what would be kept is executed again.
    pub executions: u64,
}

impl Trial {
    /// What trials are compared by.
    pub fn rank(&self) -> Rank {
        Rank { fails: self.fails, stress: self.stress }
    }

    /// Whether it is as grave as `least`, and its stress was measured.
    pub fn reaches(&self, least: Rank) -> bool {
        !self.stress.is_nan() && self.rank() >= least
    }
}
