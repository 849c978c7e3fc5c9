//! A controller of the caller's own in the place of the scenario's.

use std::any::Any;
use std::sync::Arc;

use super::scenario::{CONTROLLER_KEY, Mistake, Scenario};
use crate::simulation::{Controlled, OwnController};

/// Keys that say of our controllers what no other knows.
const OF_OURS: [&str; 4] =
    [CONTROLLER_KEY, "execute.fixed_velocity_m_s", "execute.segment_times", "execute.goto_speed_m_s"];

/// A controller of the caller's own, for whatever kind of robot.
#[derive(Debug, Clone)]
pub struct AnyController {
    name: String,
    /// What its robots do.
    does: &'static str,
    /// What of ours carries its commands out.
    loops: Option<&'static str>,
    /// Whether it came with the scenario that names it.
    named: bool,
    controller: Arc<dyn Any + Send + Sync>,
}

impl<R: Controlled + 'static> From<OwnController<R>> for AnyController {
    fn from(controller: OwnController<R>) -> Self {
        let (name, loops) = (controller.name().into(), R::LOOPS);
        Self { name, does: R::DOES, loops, named: false, controller: Arc::new(controller) }
    }
}

impl AnyController {
    /// Its name in reports.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Itself as what a scenario names: where that names another, it goes.
    pub(super) fn named(&self) -> Self {
        Self { named: true, ..self.clone() }
    }

    /// Whether it came with the scenario that names it.
    pub(super) fn is_named(&self) -> bool {
        self.named
    }

    /// What of ours carries its commands out.
    pub(super) fn loops(&self) -> Option<&'static str> {
        self.loops
    }

    /// Itself, if it is for robots of the kind `R`.
    pub(super) fn of<R: Controlled + 'static>(&self) -> Option<&OwnController<R>> {
        self.controller.downcast_ref()
    }

    /// Why nobody could execute `scenario` with it.
    pub(super) fn mistake(&self, scenario: &Scenario) -> Option<Mistake> {
        if self.name.trim().is_empty() {
            return Some(self.refused("a name for reports"));
        }
        let wrong =
            |key: &str, value: String, bound: &str| Some(Mistake { key: key.into(), value, bound: bound.into() });
        if let (Some(command), None) = (scenario.executor().command, scenario.controller()) {
            let bound = "left out where a controller of the caller's executes: one of the two";
            return wrong("execute.command", format!("\"{command}\""), bound);
        }
        let varied = OF_OURS.into_iter().find(|key| scenario.vary().contains_key(*key))?;
        wrong(&format!("vary.\"{varied}\""), "given".into(), "left out where a controller of the caller's executes")
    }

    /// That it is one for another kind of robot.
    pub(super) fn foreign(&self) -> Mistake {
        self.refused(&format!("one of what the scenario is about: {}", self.does))
    }

    fn refused(&self, bound: &str) -> Mistake {
        Mistake { key: CONTROLLER_KEY.into(), value: format!("\"{}\"", self.name), bound: bound.into() }
    }
}
