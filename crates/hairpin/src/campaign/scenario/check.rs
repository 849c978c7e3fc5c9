//! Whether a scenario can be run: its nominal values, and what `[vary]` may make of them.

use super::{Mistake, Scenario, vary};

impl Scenario {
    /// Every key whose value is out of bounds, in the order of the file. Empty: the scenario can be run.
    ///
    /// The scenario must be resolved: robot inline, meshes and elevation maps read, world base merged.
    pub fn check(&self) -> Vec<Mistake> {
        match self {
            Self::Drive(scenario) if scenario.world.terrain.map.is_none() => {
                self.clone().with_ground().check_as_it_is()
            }
            _ => self.check_as_it_is(),
        }
    }

    fn check_as_it_is(&self) -> Vec<Mistake> {
        let mut mistakes = self.check_nominal();
        if mistakes.is_empty() {
            mistakes = vary::check(self);
        }
        mistakes
    }

    /// [`Scenario::check`] without `[vary]`, whose own check asks this of what it draws.
    pub(super) fn check_nominal(&self) -> Vec<Mistake> {
        match self {
            Self::Flight(scenario) => scenario.check(),
            Self::Drive(scenario) => scenario.check(),
            Self::Arm(scenario) => scenario.check(),
        }
    }

    /// The scenario with its generated ground made, which draws of `[vary]` then share; as it is where there is none to make.
    pub(in crate::campaign) fn with_ground(mut self) -> Self {
        if let Self::Drive(scenario) = &mut self {
            scenario.make_ground();
        }
        self
    }
}
