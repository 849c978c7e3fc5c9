//! A scenario as a tree of values, in which keys are looked up and put.

use serde_json::{Map, Value};

use crate::campaign::scenario::{KeyPath, SECTIONS, Scenario};

/// The sections of a scenario, each made into values when it is first asked for: worlds may hold whole meshes.
pub(in crate::campaign) struct Tree<'a> {
    scenario: &'a Scenario,
    made: Value,
}

impl<'a> Tree<'a> {
    pub(in crate::campaign) fn new(scenario: &'a Scenario) -> Self {
        Self { scenario, made: Value::Object(Map::new()) }
    }

    /// The value at `path`, if the scenario has one.
    /// Costs the section's serialisation once.
    pub(in crate::campaign) fn get(&mut self, path: &KeyPath) -> Option<&Value> {
        self.make(path);
        path.get(&self.made)
    }

    /// Puts `new` at `path`.
    ///
    /// # Errors
    /// As [`KeyPath::put`].
    pub(super) fn put(&mut self, path: &KeyPath, new: Value) -> Result<(), String> {
        self.make(path);
        path.put(&mut self.made, new)
    }

    /// What was asked for, in the order of the file; what no scenario has last.
    pub(super) fn sections(self) -> Vec<(String, Value)> {
        let Value::Object(made) = self.made else { unreachable!("it began as a table") };
        let mut made: Vec<(String, Value)> = made.into_iter().collect();
        let place = |name: &str| SECTIONS.iter().position(|section| *section == name).unwrap_or(SECTIONS.len());
        made.sort_by_key(|(name, _)| place(name));
        made
    }

    fn make(&mut self, path: &KeyPath) {
        let Value::Object(made) = &mut self.made else { return };
        let name = &path.segments()[0];
        if !made.contains_key(name)
            && let Some(value) = self.scenario.section(name)
        {
            made.insert(name.clone(), value);
        }
    }
}
