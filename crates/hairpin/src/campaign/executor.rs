//! Who carries runs out: our own simulator, or whatever a caller brings in its place.

use rayon::prelude::*;

use super::answers::Answer;
use super::kind::Order;
use super::{Case, Mission, Setup};
use crate::judgement::Measures;
use crate::simulation::SimulationError;
use crate::trajectory::Flight;

/// Executions that a search asks for at once: none depends on another.
#[derive(Clone, Copy)]
pub struct Batch<'a> {
    /// Of each the fingerprint of what is executed.
    pub names: &'a [[u8; 16]],
    /// Carries one out, by its place; `None` where the search is stopped before. What comes of it is all that the
    /// search reads.
    pub execute: &'a (dyn Fn(usize) -> Option<Answer> + Sync),
}

/// Who carries runs out.
///
/// A search that executes asks from many threads, and takes what it is told to be what the same mission comes to in a
/// judgement. Whoever can no longer carry anything out has the search's [`Stop`](super::Stop) say so.
///
/// The seam for simulators and hardware of the caller's: `hairpin-formats` puts a process behind it, Rust callers
/// whatever they have.
///
/// What it says is believed for the mission that it was asked for, and for no other. It is not verified: whatever
/// flies elsewhere is `flown`, never `witnessed`.
pub trait Executor: Sync {
    /// The flight of `mission`, a run of `case`, whose plan was made with `nominal`.
    ///
    /// # Errors
    /// Why there is none, in a sentence.
    ///
    /// Blocks until the run has ended. May be called for several missions at once.
    fn fly(&self, nominal: &Setup, case: &Case, mission: &Mission) -> Result<Flight, String>;

    /// Has a batch carried out, on all threads: what came of each, in their order, `None` where the search was stopped
    /// before. Who shares a search with others, that search alike, takes from them what they have executed.
    fn carry_out(&self, batch: &Batch) -> Vec<Option<Answer>> {
        (0..batch.names.len()).into_par_iter().map(|place| (batch.execute)(place)).collect()
    }

    /// Told of each run that a search asked for, once it is measured: what it came to, and whether it violates what the
    /// scenario limits.
    ///
    /// Called from the thread that asked. Does nothing by default.
    fn measured(&self, measures: &Measures, violates: bool) {
        let _ = (measures, violates);
    }

    /// Told of each run that a search asked for: that it came to a flight, or why not.
    ///
    /// Called from the thread that asked, also for what was not asked of [`Self::fly`]: a mission that cannot be made,
    /// a part of a flight in our own simulator. Does nothing by default.
    fn ended(&self, outcome: Result<(), &str>) {
        let _ = outcome;
    }

    /// Whether it is our own simulator, which can be left in the middle of a run and gone on with.
    fn is_ours(&self) -> bool {
        false
    }
}

/// Our own simulator.
///
/// Deterministic; needs no process and no clock.
#[derive(Debug, Clone, Copy, Default)]
pub struct OwnSimulator;

impl Executor for OwnSimulator {
    fn fly(&self, nominal: &Setup, case: &Case, mission: &Mission) -> Result<Flight, String> {
        carry_out(nominal, case, mission).map_err(|error| error.to_string())
    }

    fn is_ours(&self) -> bool {
        true
    }
}

/// `nominal` is what the plan was made with; the mission has its own setup.
fn carry_out(nominal: &Setup, case: &Case, mission: &Mission) -> Result<Flight, SimulationError> {
    let Mission { waypoints, accept, time_limit, seed, .. } = mission;
    let order = Order { waypoints, accept: *accept, time_limit: *time_limit, seed: *seed, obstacles: true };
    mission.setup.kind().run(nominal.kind().same(), case, &order)
}
