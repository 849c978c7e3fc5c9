//! The bounds of every key. What a number must be is said once, here; the parser adds line and caret.
//!
//! Upper bounds are there to refuse what would fill the memory or never end, so they stand far above what is useful.

mod environment;
mod execute;
mod generate;
mod spec;
mod task;
#[cfg(test)]
mod tests;
mod world;

use super::FlightScenario;
use crate::campaign::flight::{robot_of, world_of};
use crate::campaign::scenario::Mistake;
use crate::campaign::scenario::findings::Findings;

impl FlightScenario {
    /// Every nominal value that is out of bounds, in the order of the file.
    pub(in crate::campaign::scenario) fn check(&self) -> Vec<Mistake> {
        let mut found = Findings::default();
        found.head(self.hairpin, self.seed);
        let robot = robot_of(&self.robot).map_err(|mistake| found.add(mistake)).ok();
        let before = found.0.len();
        world::check(&self.world, &mut found);
        let mut space = None;
        if found.0.len() == before {
            space = world_of(&self.world).map_err(|mistake| found.add(mistake)).ok();
        }
        task::check(&self.task, space.as_ref(), robot.as_ref(), &mut found);
        generate::check(self, &mut found);
        let given = self.generate.model.as_ref().map_or(&self.generate.score, |kept| &kept.given);
        let score = ("generate.score", given.as_str());
        found.rounds(self.generate.search.method, score, self.vary.keys());
        environment::check(self, &mut found);
        execute::check(&self.execute, &mut found);
        spec::check(&self.spec, &mut found);
        found.0
    }
}
