//! What a case met beside its waypoints, where that was searched for: wind, a gust, obstacles. It is part of the case.

use serde::{Deserialize, Serialize};

use super::Scenario;
use super::report::number;
use super::scenario::{DiscreteGustSection, ObstacleSection};

/// Found with the waypoints of a flight; keys and units are those of `[world]`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Environment {
    /// Constant wind.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub wind_m_s: Option<[f64; 3]>,
    /// One gust.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub discrete_gust: Option<DiscreteGustSection>,
    /// Obstacles beside the world's own; the plan is clear of them.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub obstacles: Vec<ObstacleSection>,
}

impl Environment {
    /// `scenario` with this in its world, and nothing left to be searched for there. Only flights have environments.
    pub(super) fn around(&self, scenario: &Scenario) -> Scenario {
        let mut around = scenario.clone();
        if let Scenario::Flight(flight) = &mut around {
            flight.world.wind_m_s = self.wind_m_s.or(flight.world.wind_m_s);
            flight.world.discrete_gust = self.discrete_gust.or(flight.world.discrete_gust);
            flight.world.obstacles.extend(self.obstacles.iter().cloned());
            flight.generate.environment = None;
        }
        around
    }

    /// What it is, for people.
    pub fn words(&self) -> Vec<String> {
        let vector = |v: [f64; 3]| format!("({})", v.map(|x| number(Some(x))).join(", "));
        let mut words = Vec::new();
        words.extend(self.wind_m_s.map(|wind| format!("wind {} m/s", vector(wind))));
        words.extend(self.discrete_gust.map(|gust| {
            let [from, to] = [gust.start_s, gust.start_s + gust.duration_s].map(|t| number(Some(t)));
            format!("gust {} m/s, t = {from} … {to} s", vector(gust.velocity_m_s))
        }));
        words.extend(self.obstacles.iter().map(|obstacle| {
            let ball = obstacle.sphere.map(|ball| format!("ball at {} m", vector(ball.center_m)));
            let cuboid = obstacle.cuboid.map(|cuboid| format!("box at {} m", vector(cuboid.center_m)));
            format!("{}: {}", obstacle.name, ball.or(cuboid).unwrap_or_default())
        }));
        words
    }
}
