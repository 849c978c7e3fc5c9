//! What the run met beside its waypoints: drawn values, wind, gusts, noise, obstacles, each left out where it violates without.

use super::Job;
use crate::campaign::Scenario;
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
                    self.fewer_obstacles();
                }
            }
            Scenario::Drive(drive) if drive.execute.noise => self.without("no noise", &|scenario| {
                if let Scenario::Drive(drive) = scenario {
                    drive.execute.noise = false;
                }
            }),
            Scenario::Drive(_) | Scenario::Arm(_) => {}
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

    fn fewer_obstacles(&mut self) {
        let Scenario::Flight(flight) = &self.setup.scenario else { return };
        let all = flight.world.obstacles.clone();
        let before = self.best.simplified.len();
        let none = in_flight(|flight| {
            flight.world.obstacles.clear();
            // What the search looked for is nothing to a run, and cannot be looked for where there are none.
            flight.generate.search.stress = Stress::default();
        });
        self.without("no obstacles", &none);
        // Varied obstacles are named by their place in the list.
        let by_place = self.setup.scenario.vary().keys().any(|key| key.starts_with("world.obstacles"));
        if self.stopped || all.len() < 2 || by_place || self.best.simplified.len() > before {
            return;
        }
        let places: Vec<usize> = (0..all.len()).collect();
        let route = self.route.clone();
        let left = ddmin(&places, &mut |part| {
            let mut scenario = self.setup.scenario.clone();
            if let Scenario::Flight(flight) = &mut scenario {
                flight.world.obstacles = part.iter().map(|place| all[*place].clone()).collect();
            }
            match self.setup.of_draw(scenario) {
                Ok(setup) => self.holds(Some(&setup), &route),
                Err(_) => Some(false),
            }
        });
        if left.len() < all.len() {
            self.best.simplified.push(format!("{} of {} obstacles", left.len(), all.len()));
        }
    }
}

fn in_flight(change: impl Fn(&mut crate::campaign::scenario::FlightScenario)) -> impl Fn(&mut Scenario) {
    move |scenario| {
        if let Scenario::Flight(flight) = scenario {
            change(flight);
        }
    }
}
