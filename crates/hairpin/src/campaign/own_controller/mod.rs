//! A controller of the caller's own in the place of the scenario's.

mod helm;

use std::any::Any;
use std::sync::Arc;

use super::scenario::{CONTROLLER_KEY, Mistake, Scenario};
use super::user_controller::UserController;
use crate::simulation::{Controlled, OwnController};
use helm::AtTheHelm;
pub(super) use helm::{Planned, Steered, keys};

/// Keys that say of our controllers what no other knows.
const OF_OURS: [&str; 4] =
    [CONTROLLER_KEY, "execute.fixed_velocity_m_s", "execute.segment_times", "execute.goto_speed_m_s"];

/// A controller of the caller's own, for whatever kind of robot.
#[derive(Debug, Clone)]
pub struct AnyController {
    name: String,
    source: Source,
}

#[derive(Debug, Clone)]
enum Source {
    /// Code of the caller's, for one kind of robots, and what these do.
    Callers(Arc<dyn Any + Send + Sync>, &'static str),
    /// Code of the user's that a scenario names, for any kind.
    Users(UserController),
}

impl<R: Controlled + 'static> From<OwnController<R>> for AnyController {
    fn from(controller: OwnController<R>) -> Self {
        Self { name: controller.name().into(), source: Source::Callers(Arc::new(controller), R::DOES) }
    }
}

impl AnyController {
    /// The one that a scenario names.
    pub(super) fn named(user: &UserController) -> Self {
        Self { name: user.word.clone(), source: Source::Users(user.clone()) }
    }

    /// Whether it came with the scenario that names it: where that names another, it goes.
    pub(super) fn is_named(&self) -> bool {
        matches!(self.source, Source::Users(_))
    }

    /// Its name in reports.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Itself, if it is for robots of the kind `R`.
    /// `None` for a caller's code that is for another kind.
    pub(super) fn of<R: Steered>(&self) -> Option<OwnController<R>> {
        match &self.source {
            Source::Callers(controller, _) => controller.downcast_ref().cloned(),
            Source::Users(user) => {
                let user = user.clone();
                Some(OwnController::new(&self.name, move |robot: &R| AtTheHelm::new(&user, robot)))
            }
        }
    }

    /// Why nobody could execute `scenario` with it.
    ///
    /// `None` where nothing is in the way: a name that is not blank, no `execute.command`, and no key varied that is
    /// of our controllers alone.
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
        let does = if let Source::Callers(_, does) = self.source { does } else { "it is steered by hairpin's own" };
        self.refused(&format!("one of what the scenario is about: {does}"))
    }

    fn refused(&self, bound: &str) -> Mistake {
        Mistake { key: CONTROLLER_KEY.into(), value: format!("\"{}\"", self.name), bound: bound.into() }
    }
}
