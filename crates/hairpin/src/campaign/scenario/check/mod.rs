//! The bounds of every key. What a number must be is said once, here; the parser adds line and caret.
//!
//! Upper bounds are there to refuse what would fill the memory or never end, so they stand far above what is useful.

mod execute;
mod generate;
mod spec;
mod task;
#[cfg(test)]
mod tests;
mod vary;
mod world;

use super::{Mistake, Scenario};
use crate::campaign::setup::{robot_of, world_of};

impl Scenario {
    /// Every key whose value is out of bounds, in the order of the file. Empty: the scenario can be run.
    ///
    /// The scenario must be resolved: robot inline, meshes read, world base merged.
    pub fn check(&self) -> Vec<Mistake> {
        let mut mistakes = self.check_nominal();
        if mistakes.is_empty() {
            mistakes = vary::check(self);
        }
        mistakes
    }

    /// [`Scenario::check`] without `[vary]`, whose own check asks this of what it draws.
    fn check_nominal(&self) -> Vec<Mistake> {
        let mut found = Findings::default();
        found.require(self.hairpin == 1, "hairpin", self.hairpin, "1, the only scenario format there is");
        // TOML's whole numbers end here: a campaign's scenario file must hold its seed.
        found.count("seed", self.seed, 0, i64::MAX as u64);
        let robot = robot_of(&self.robot).map_err(|mistake| found.add(mistake)).ok();
        let before = found.0.len();
        world::check(&self.world, &mut found);
        let mut space = None;
        if found.0.len() == before {
            space = world_of(&self.world).map_err(|mistake| found.add(mistake)).ok();
        }
        task::check(&self.task, space.as_ref(), robot.as_ref(), &mut found);
        generate::check(&self.generate, &mut found);
        execute::check(&self.execute, &mut found);
        spec::check(&self.spec, &mut found);
        found.0
    }
}

/// The mistakes found so far, with the few questions that most keys are asked.
#[derive(Default)]
struct Findings(Vec<Mistake>);

impl Findings {
    fn add(&mut self, mistake: Mistake) {
        self.0.push(mistake);
    }

    fn require(&mut self, fine: bool, key: &str, value: impl ToString, bound: &str) {
        if !fine {
            self.add(Mistake { key: key.into(), value: value.to_string(), bound: bound.into() });
        }
    }

    fn count(&mut self, key: &str, value: u64, least: u64, most: u64) {
        self.require((least..=most).contains(&value), key, value, &format!("{least} … {}", grouped(most)));
    }

    /// `least` itself is allowed.
    fn from(&mut self, key: &str, value: f64, least: f64, most: f64, unit: &str) {
        let bound = format!("≥ {least} and ≤ {most}{unit}");
        self.require(value >= least && value <= most, key, value, &bound);
    }

    /// `least` itself is not allowed.
    fn above(&mut self, key: &str, value: f64, least: f64, most: f64, unit: &str) {
        let bound = format!("> {least} and ≤ {most}{unit}");
        self.require(value > least && value <= most, key, value, &bound);
    }
}

/// `1000000` as `1 000 000`, which can be read.
fn grouped(n: u64) -> String {
    let digits = n.to_string();
    let mut text = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push(' ');
        }
        text.push(digit);
    }
    text
}
