//! One run to be carried out, and whether what comes of it can be had again.

use hairpin::campaign::{Case, Mission, Mistake, Run, Setup, execute_again, execute_run, mission, mission_again};

/// Whether a run can be had again to the bit: one of our own simulator is a function of its scenario, seed and number,
/// unless code of the user's steers.
pub(crate) fn comes_again(setup: &Setup) -> bool {
    let ours = setup.scenario.executor().command.is_none() && setup.steering_code().is_none();
    ours && setup.recordings().is_none()
}

/// What is flown: run number `run` of a case or, where it violated, that run for the time number `again`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Job<'a> {
    pub(super) case: &'a Case,
    pub(super) run: usize,
    pub(super) again: Option<usize>,
}

impl Job<'_> {
    pub(super) fn mission(&self, setup: &Setup) -> Result<Mission, Mistake> {
        match self.again {
            None => mission(setup, self.case, self.run),
            Some(again) => mission_again(setup, self.case, self.run, again),
        }
    }

    pub(super) fn simulate(&self, setup: &Setup) -> Run {
        match self.again {
            None => execute_run(setup, self.case, self.run),
            Some(again) => execute_again(setup, self.case, self.run, again),
        }
    }
}
