//! What the run met beside its waypoints: drawn values, wind, gusts, forces, noise, obstacles, keep-outs, each left out
//! where it violates without.

use super::Job;
use crate::campaign::Scenario;
use crate::campaign::scenario::{DriveScenario, FlightScenario};
use crate::judgement::Stress;
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
        match &self.setup.scenario {
            Scenario::Flight(flight) => {
                let (wind, gusts) = (flight.world.wind_m_s, flight.world.gusts.is_some());
                let discrete_gust = flight.world.discrete_gust.is_some();
                let (noise, obstacles) = (flight.execute.noise, flight.world.obstacles.len());
                if gusts {
                    self.without("no gusts", &in_flight(|flight| flight.world.gusts = None));
                }
                if discrete_gust {
                    self.without("no discrete gust", &in_flight(|flight| flight.world.discrete_gust = None));
                }
                if wind.is_some_and(|wind| wind != [0.0; 3]) {
                    self.without("no wind", &in_flight(|flight| flight.world.wind_m_s = None));
                }
                if noise {
                    self.without("no noise", &in_flight(|flight| flight.execute.noise = false));
                }
                if obstacles > 0 {
                    self.fewer(&OBSTACLES);
                }
            }
            Scenario::Drive(drive) => {
                let (force, noise) = (drive.execute.external_force_n.is_some(), drive.execute.noise);
                let keep_outs = drive.world.keep_out.len();
                if force {
                    self.without("no external force", &in_drive(|drive| drive.execute.external_force_n = None));
                }
                if noise {
                    self.without("no noise", &in_drive(|drive| drive.execute.noise = false));
                }
                if keep_outs > 0 {
                    self.fewer(&KEEP_OUTS);
                }
            }
            Scenario::Arm(_) => {}
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
    fn fewer(&mut self, kind: &Standing) {
        let all: Vec<usize> = (0..(kind.count)(&self.setup.scenario)).collect();
        let before = self.best.simplified.len();
        let words = kind.words;
        self.without(&format!("no {words}"), &|scenario| (kind.keep)(scenario, &[]));
        // What is varied is named by its place in the list.
        let by_place = self.setup.scenario.vary().keys().any(|key| key.starts_with(kind.key));
        if self.stopped || all.len() < 2 || by_place || self.best.simplified.len() > before {
            return;
        }
        let whole = self.setup.scenario.clone();
        let route = self.route.clone();
        let left = ddmin(&all, &mut |part| {
            let mut scenario = whole.clone();
            (kind.keep)(&mut scenario, part);
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

/// What stands in a world, one beside the other.
struct Standing {
    words: &'static str,
    /// Its key in scenarios.
    key: &'static str,
    count: fn(&Scenario) -> usize,
    /// Leaves only those at some places of the list.
    keep: fn(&mut Scenario, &[usize]),
}

const OBSTACLES: Standing = Standing {
    words: "obstacles",
    key: "world.obstacles",
    count: |scenario| if let Scenario::Flight(flight) = scenario { flight.world.obstacles.len() } else { 0 },
    keep: |scenario, part| {
        if let Scenario::Flight(flight) = scenario {
            keep(&mut flight.world.obstacles, part, &mut flight.generate.search.stress);
        }
    },
};

const KEEP_OUTS: Standing = Standing {
    words: "keep-outs",
    key: "world.keep_out",
    count: |scenario| if let Scenario::Drive(drive) = scenario { drive.world.keep_out.len() } else { 0 },
    keep: |scenario, part| {
        if let Scenario::Drive(drive) = scenario {
            keep(&mut drive.world.keep_out, part, &mut drive.generate.search.stress);
        }
    },
};

/// Leaves only those of `list` at the places `part`.
fn keep<T: Clone>(list: &mut Vec<T>, part: &[usize], stress: &mut Stress) {
    *list = part.iter().map(|place| list[*place].clone()).collect();
    if list.is_empty() {
        // What the search looked for is nothing to a run, and cannot be looked for where there are none.
        *stress = Stress::default();
    }
}

fn in_flight(change: impl Fn(&mut FlightScenario)) -> impl Fn(&mut Scenario) {
    move |scenario| {
        if let Scenario::Flight(flight) = scenario {
            change(flight);
        }
    }
}

fn in_drive(change: impl Fn(&mut DriveScenario)) -> impl Fn(&mut Scenario) {
    move |scenario| {
        if let Scenario::Drive(drive) = scenario {
            change(drive);
        }
    }
}
