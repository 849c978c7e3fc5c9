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

use super::Flyer;
use crate::campaign::attachments::Attachments;
use crate::campaign::build::Build;
use crate::campaign::check::Findings;
use crate::campaign::scenario::{FlightScenario, Mistake};

impl Build for Flyer {
    type Keys = FlightScenario;

    fn build(keys: &FlightScenario, _: &Attachments, known: Option<(&FlightScenario, &Self)>) -> Result<Self, Mistake> {
        Ok(Self { robot: Self::robot(keys, known)?, world: Self::world(keys, known)? })
    }

    fn check(
        keys: &FlightScenario,
        files: &Attachments,
        known: Option<(&FlightScenario, &Self)>,
    ) -> Result<Self, Vec<Mistake>> {
        let mut found = Findings::default();
        found.head(keys.hairpin, keys.seed);
        let robot = found.take(Flyer::robot(keys, known));
        let before = found.0.len();
        world::check(&keys.world, &mut found);
        let world = if found.0.len() == before { found.take(Flyer::world(keys, known)) } else { None };
        task::check(&keys.task, world.as_deref(), robot.as_deref(), &mut found);
        generate::check(keys, files, &mut found);
        let score = &keys.generate.score;
        let given = files.model(score).map_or(score, |model| &model.given);
        found.rounds(keys.generate.search.method, ("generate.score", given), keys.vary.keys());
        environment::check(keys, &mut found);
        execute::check(&keys.execute, &mut found);
        spec::check(&keys.spec, &mut found);
        match (robot, world) {
            (Some(robot), Some(world)) if found.0.is_empty() => Ok(Flyer { robot, world }),
            _ => Err(found.0),
        }
    }
}
