//! The bounds of every key. What a number must be is said once, here; the parser adds line and caret.
//!
//! Upper bounds are there to refuse what would fill the memory or never end, so they stand far above what is useful.

mod environment;
mod execute;
mod generate;
mod task;
#[cfg(feature = "unit-tests")]
mod tests;
mod world;

use std::sync::Arc;

use super::{FlightSetup, idle};
use crate::campaign::check::{Findings, check_spec};
use crate::campaign::kind::{Build, Given};
use crate::campaign::scenario::{FlightScenario, Mistake};
use crate::math::simd::Simd;
use crate::robot::quadrotor::Quadrotor;
use crate::world::World;

impl Build for FlightSetup {
    type Keys = FlightScenario;

    fn build(given: Given<'_, Self>) -> Result<Self, Mistake> {
        let (robot, world) = (Self::robot(given.keys, given.known)?, Self::world(given.keys, given.known)?);
        Ok(Self::of(given, robot, world))
    }

    fn check(given: Given<'_, Self>) -> Result<Self, Vec<Mistake>> {
        let Given { keys, files, known } = given;
        let mut found = Findings::default();
        found.head(keys.hairpin, keys.seed);
        let robot = found.take(Self::robot(keys, known));
        let before = found.0.len();
        world::check(&keys.world, &mut found);
        let world = if found.0.len() == before { found.take(Self::world(keys, known)) } else { None };
        task::check(&keys.task, world.as_deref(), robot.as_deref(), &mut found);
        generate::check(keys, files, &mut found);
        let score = &keys.generate.score;
        let named = files.model(score).map_or(score, |model| &model.given);
        found.rounds(keys.generate.search.method, ("generate.score", named), keys.vary.keys());
        environment::check(keys, &mut found);
        execute::check(&keys.execute, &mut found);
        idle::check_varied(keys, robot.as_deref(), &mut found);
        check_spec(&keys.spec, 1e6, &mut found);
        match (robot, world) {
            (Some(robot), Some(world)) if found.0.is_empty() => Ok(Self::of(given, robot, world)),
            _ => Err(found.0),
        }
    }
}

impl FlightSetup {
    /// Kernels and controller stay those of the setup that is known.
    fn of(given: Given<'_, Self>, robot: Arc<Quadrotor>, world: Arc<World>) -> Self {
        let Given { keys, files, known } = given;
        let controller = known.and_then(|known| known.controller.clone());
        let simd = known.map_or_else(Simd::default, |known| known.simd);
        Self { scenario: keys.clone(), attachments: files.clone(), robot, world, controller, simd }
    }
}
