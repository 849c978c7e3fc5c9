//! Code in the caller's own process that answers in place of the files that a scenario names.
//!
//! The scenario names the file all the same; a campaign that is resumed elsewhere, without the process, reads that.

use std::fmt;
use std::sync::Arc;

use super::Setup;
use super::scenario::Mistake;
use super::user_controller::{UserController, UserSteering};
use super::user_score::LegScorer;
use super::user_target::RunMeter;

/// Makes what steers of the time between two of its turns, s.
/// Called once, when the code takes the place of the file.
pub type MakeSteering = dyn Fn(f64) -> Arc<dyn UserSteering> + Send + Sync;

/// What answers in place of files; a scenario that names none is not changed by it. Files stay what a campaign keeps
/// and what it is resumed with, so they should say the same.
#[derive(Clone, Default)]
pub struct CallersCode {
    /// In place of the file of `generate.search.score`.
    pub score: Option<Arc<dyn LegScorer>>,
    /// In place of the file of `generate.search.target`.
    pub target: Option<Arc<dyn RunMeter>>,
    /// In place of the file or command of `execute.controller`.
    pub controller: Option<Arc<MakeSteering>>,
}

impl fmt::Debug for CallersCode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { score, target, controller } = self;
        let there = [score.is_some(), target.is_some(), controller.is_some()];
        f.debug_tuple("CallersCode").field(&there).finish()
    }
}

impl CallersCode {
    fn is_empty(&self) -> bool {
        self.score.is_none() && self.target.is_none() && self.controller.is_none()
    }
}

impl Setup {
    /// The same, of whose files the caller's `code` answers for those that it is there for.
    ///
    /// # Errors
    /// As of [`Self::changed`].
    ///
    /// Code for a key that the scenario does not have is left aside.
    pub fn answered_by(mut self, code: &CallersCode) -> Result<Self, Mistake> {
        if code.is_empty() {
            return Ok(self);
        }
        let mut files = (*self.attachments).clone();
        if let (Some(file), Some(score)) = (&mut files.user_score, &code.score) {
            file.read = score.clone();
        }
        if let (Some(file), Some(target)) = (&mut files.user_target, &code.target) {
            file.read = target.clone();
        }
        if let (Some(file), Some(make)) = (&mut files.user_controller, &code.controller) {
            *file = Arc::new(UserController { code: make(file.code.period()), ..UserController::clone(file) });
        }
        self.attachments = Arc::new(files);
        let scenario = self.scenario.clone();
        self.changed(scenario)
    }
}
