//! Controllers of the user's own that a scenario names: whatever steers outside of hairpin.

use std::fmt;
use std::sync::Arc;

use super::own_controller::AnyController;
use super::user_code::UserCode;

/// Name of a controller's file in a campaign folder, where the user's own cannot stay.
pub const NAME: &str = "controller.py";

/// Code that `execute.controller` names, and the controllers that it is.
pub struct UserController {
    /// As a resolved scenario has it: `python:pd.py`.
    pub word: String,
    /// What the scenario called it before.
    pub given: String,
    /// Itself, for each kind of robots that it may be asked to steer.
    pub controllers: Vec<AnyController>,
    /// What is asked.
    pub code: Arc<dyn UserCode>,
    /// Name and contents of the copy that a campaign keeps; of a program none.
    pub file: Option<(String, Arc<[u8]>)>,
}

impl fmt::Debug for UserController {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("UserController").field("word", &self.word).field("given", &self.given).finish_non_exhaustive()
    }
}
