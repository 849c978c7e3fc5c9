//! What the run met beside its waypoints: drawn values, wind, gusts, forces, noise, obstacles, keep-outs, each left out
//! where it violates without.

use super::Job;
use crate::campaign::Scenario;
use crate::campaign::kind::{Condition, Knobs, Standing};
use crate::search::ddmin;

impl Job<'_> {
    /// Leaves out whatever it violates without.
    pub(super) fn simplify(&mut self) {
        let keys: Vec<String> = self.setup.scenario.vary().keys().cloned().collect();
        if keys.len() > 1 {
            self.without("all varied values nominal", &|scenario| scenario.vary_mut().clear());
        }
        for key in &keys {
            if self.setup.scenario.vary().contains_key(key) {
                self.without(&format!("{key} nominal"), &|scenario| drop(scenario.vary_mut().remove(key)));
            }
        }
        let Knobs { conditions, standing, .. } = self.setup.kind().knobs();
        for Condition { words, without } in conditions {
            self.without(words, &without);
        }
        if let Some(standing) = standing {
            self.fewer(&standing);
        }
    }

    /// Keeps `change` if it still violates so.
    fn without(&mut self, words: &str, change: &dyn Fn(&mut Scenario)) {
        if self.stopped {
            return;
        }
        let mut scenario = self.setup.scenario.clone();
        change(&mut scenario);
        // A key that is varied may name an obstacle that is no longer there.
        let Ok(setup) = self.setup.of_draw(scenario) else { return };
        let route = self.route.clone();
        if self.holds(Some(&setup), &route) == Some(true) {
            self.best.simplified.push(words.into());
        }
    }

    /// As few of what stands in the world as it still violates among.
    fn fewer(&mut self, standing: &Standing) {
        let all: Vec<usize> = (0..standing.count).collect();
        let before = self.best.simplified.len();
        let words = standing.words;
        self.without(&format!("no {words}"), &|scenario| (standing.keep)(scenario, &[]));
        // What is varied is named by its place in the list.
        let by_place = self.setup.scenario.vary().keys().any(|key| key.starts_with(standing.key));
        if self.stopped || all.len() < 2 || by_place || self.best.simplified.len() > before {
            return;
        }
        let whole = self.setup.scenario.clone();
        let route = self.route.clone();
        let left = ddmin(&all, &mut |part| {
            let mut scenario = whole.clone();
            (standing.keep)(&mut scenario, part);
            match self.setup.of_draw(scenario) {
                Ok(setup) => self.holds(Some(&setup), &route),
                Err(_) => Some(false),
            }
        });
        if left.len() < all.len() {
            self.best.simplified.push(format!("{} of {} {words}", left.len(), all.len()));
        }
    }
}
