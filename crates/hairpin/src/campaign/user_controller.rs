//! Controllers of the user's own that a scenario names: whatever steers outside of hairpin.

use std::fmt;
use std::sync::Arc;

use serde_json::Value;

use super::user_code::UserCode;

/// Name of a controller's file in a campaign folder, where the user's own cannot stay.
pub const NAME: &str = "controller.py";

/// Code that `execute.controller` names.
#[derive(Clone)]
pub struct UserController {
    /// As a resolved scenario has it: `python:pd.py`.
    pub word: String,
    /// What the scenario called it before.
    pub given: String,
    /// What is asked.
    pub code: Arc<dyn UserSteering>,
    /// Name and contents of the copy that a campaign keeps; of a program none.
    pub file: Option<(String, Arc<[u8]>)>,
}

impl fmt::Debug for UserController {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("UserController").field("word", &self.word).field("given", &self.given).finish_non_exhaustive()
    }
}

/// Steers runs, each by itself, from any thread. Numbers are in SI; their names are those that the user's code knows.
pub trait UserSteering: UserCode {
    /// Time between two turns, s.
    /// > 0; the same in all runs.
    fn period(&self) -> f64;

    /// Begins a run; `mission` says where it is to go, and with what.
    ///
    /// # Errors
    /// Why it cannot be steered.
    fn begin(self: Arc<Self>, mission: Value) -> Result<Box<dyn Turns>, String>;
}

/// A run that is being steered. Whoever lets go of it without [finishing](Self::finish) it gives up on what steers.
pub trait Turns {
    /// The command at `t_s` s, a table of its keys.
    ///
    /// # Errors
    /// Why there is none.
    fn turn(&mut self, t_s: f64, state: &Value, reference: &Value) -> Result<Value, String>;

    /// The run is over, and nothing was wrong.
    fn finish(self: Box<Self>);
}
