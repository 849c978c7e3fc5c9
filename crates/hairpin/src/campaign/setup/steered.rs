//! Who steers: a controller of ours, one of the caller's, or the one that the scenario names.

use serde_json::Value;

use super::Setup;
use crate::campaign::own_controller::AnyController;
use crate::campaign::scenario::{COMMAND, CONTROLLER_KEY, Mistake, PYTHON};
use crate::campaign::user_code::UserCode;
use crate::campaign::user_controller::UserController;

impl Setup {
    /// The same executed by a controller of the caller's own, wherever the scenario's would execute: runs, searches
    /// that execute, re-runs, candidates of a shrinking. What is told of the campaign names it.
    ///
    /// The scenario's own keys stay as they are. A folder keeps a scenario and no code, so one that is written of this
    /// names the controller in its report and verdict only, and is resumed and replayed by those who have the code.
    ///
    /// # Errors
    /// A controller of another kind of robot, or without a name; a scenario that has a command executed, or varies what
    /// only ours have.
    pub fn with_controller(self, controller: impl Into<AnyController>) -> Result<Self, Mistake> {
        let controller = controller.into();
        if let Some(mistake) = controller.mistake(&self.scenario) {
            return Err(mistake);
        }
        let kind = self.kind.with(self.simd, Some(&controller)).ok_or_else(|| controller.foreign())?;
        Ok(Self { kind, own_controller: Some(controller), ..self })
    }

    /// The controller of the caller's own.
    pub(in crate::campaign) fn own_controller(&self) -> Option<&AnyController> {
        self.own_controller.as_ref()
    }

    /// Itself with the controller that its scenario names, where that is the user's and no caller's takes its place.
    pub(super) fn steered(mut self) -> Result<Self, Vec<Mistake>> {
        if self.own_controller.as_ref().is_some_and(|own| !own.is_named()) {
            return Ok(self);
        }
        if let Some(named) = self.user_controller().map(AnyController::named) {
            return self.with_controller(named).map_err(|mistake| vec![mistake]);
        }
        // One that an earlier scenario named is none of this one's.
        if self.own_controller.take().is_some() {
            let simd = self.simd;
            self = self.with_simd(simd);
        }
        let word = self.scenario.controller().unwrap_or_default();
        if !word.starts_with(PYTHON) && !word.starts_with(COMMAND) {
            return Ok(self);
        }
        let (key, value) = (CONTROLLER_KEY.into(), format!("\"{word}\""));
        Err(vec![Mistake { key, value, bound: "read with its scenario".into() }])
    }

    /// The code that steers where the user's does, by its key.
    pub fn steering_code(&self) -> Option<(&'static str, &dyn UserCode)> {
        Some((CONTROLLER_KEY, &*self.user_controller()?.code))
    }

    /// The controller of the user's own that its scenario names.
    pub fn user_controller(&self) -> Option<&UserController> {
        self.attachments.user_controller(self.scenario.controller())
    }

    /// What of ours carries out what the caller's or the user's controller asks for.
    pub(in crate::campaign) fn loops(&self) -> Option<&'static str> {
        self.own_controller().and(self.robot_words().loops)
    }

    /// The word of the controller that executes, the caller's or ours; `None` where a command does.
    pub fn controller(&self) -> Option<&str> {
        self.own_controller().map(AnyController::name).or(self.scenario.controller())
    }

    /// The same with what `[vary]` draws in its place, as runs are told: run 0 is the scenario's own, and others need
    /// not be.
    ///
    /// `stanley or pure-pursuit, as drawn`.
    pub(in crate::campaign) fn controllers(&self) -> Option<String> {
        let nominal = self.controller()?;
        let drawn = self.scenario.vary().get(CONTROLLER_KEY).filter(|_| self.scenario.executor().repeat > 1);
        let mut words = vec![nominal];
        for word in drawn.into_iter().flat_map(|drawn| drawn.choice.iter().flatten()).filter_map(Value::as_str) {
            // An arm's own is told as `virtual controller`, and its key has `virtual`.
            let is_known = |known: &&str| *known == word || known.strip_suffix(" controller") == Some(word);
            if !words.iter().any(is_known) {
                words.push(word);
            }
        }
        Some(if words.len() > 1 { format!("{}, as drawn", words.join(" or ")) } else { nominal.into() })
    }
}
