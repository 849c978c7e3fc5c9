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

    /// Whether it can be searched as it asks for: what executes in the loop is a controller of ours. Trajectories that
    /// are there already are anybody's to execute.
    ///
    /// # Errors
    /// The method of search, or the score.
    pub fn check_search(&self) -> Result<(), Mistake> {
        if !self.executes() || self.controller().is_some() {
            return Ok(());
        }
        let method = self.search().method;
        let (key, value) = match method.executes() {
            true => ("generate.search.method", serde_json::to_string(&method).unwrap_or_default()),
            false => (self.score_key(), format!("\"{}\"", self.score())),
        };
        let bound = "another one, or execute.controller given: a command is not executed in the loop";
        Err(Mistake { key: key.into(), value, bound: bound.into() })
    }

    /// Whether trajectories are executed while they are searched for.
    pub(in crate::campaign) fn executes(&self) -> bool {
        self.search().executes(self.score())
    }

    /// The key of [`Scenario::score`].
    pub fn score_key(&self) -> &'static str {
        match self {
            Self::Flight(_) => "generate.score",
            Self::Drive(_) => "generate.search.score",
            Self::Arm(_) => "generate.cost",
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

    /// The scenario with its generated ground made, which draws of `[vary]` then share; as it is where there is none to
    /// make.
    pub(in crate::campaign) fn with_ground(mut self) -> Self {
        if let Self::Drive(scenario) = &mut self {
            scenario.make_ground();
        }
        self
    }
}
