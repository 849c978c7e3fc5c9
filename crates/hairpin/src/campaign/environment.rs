//! What a case met beside its waypoints, where that was searched for: wind, a gust, a steady force, obstacles. It is
//! part of the case.

use serde::{Deserialize, Serialize};

use super::Scenario;
use super::digits::number;
use super::scenario::{DiscreteGustSection, KeepOutSection, Mistake, ObstacleSection};

/// Found with the waypoints of a flight or drive; keys and units are those of `[world]`, those of the force of
/// `[execute]`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Environment {
    /// Constant wind.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub wind_m_s: Option<[f64; 3]>,
    /// One gust.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub discrete_gust: Option<DiscreteGustSection>,
    /// Obstacles of a flight beside the world's own; the plan is clear of them.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub obstacles: Vec<ObstacleSection>,
    /// Places on the ground beside the world's own; the planned drive is clear of them.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub keep_out: Vec<KeepOutSection>,
    /// Steady force on what drives, east, north, up.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub external_force_n: Option<[f64; 3]>,
}

impl Environment {
    /// `scenario` with this in its world, and nothing left to be searched for there. Arms have no environments.
    pub(super) fn around(&self, scenario: &Scenario) -> Scenario {
        let mut around = scenario.clone();
        match &mut around {
            Scenario::Flight(flight) => {
                flight.world.wind_m_s = self.wind_m_s.or(flight.world.wind_m_s);
                flight.world.discrete_gust = self.discrete_gust.or(flight.world.discrete_gust);
                flight.world.obstacles.extend(self.obstacles.iter().cloned());
                flight.generate.environment = None;
            }
            Scenario::Drive(drive) => {
                drive.execute.external_force_n = self.external_force_n.or(drive.execute.external_force_n);
                drive.world.keep_out.extend(self.keep_out.iter().cloned());
                drive.generate.environment = None;
            }
            Scenario::Arm(_) => {}
        }
        around
    }

    /// The first thing wrong with it in `scenario`: what is not for its kind of robot, or a value out of bounds.
    pub(super) fn mistake(&self, scenario: &Scenario) -> Option<Mistake> {
        let Self { wind_m_s, discrete_gust, obstacles, keep_out, external_force_n } = self;
        let of_flights = [
            ("wind_m_s", wind_m_s.is_some()),
            ("discrete_gust", discrete_gust.is_some()),
            ("obstacles", !obstacles.is_empty()),
        ];
        let of_drives = [("keep_out", !keep_out.is_empty()), ("external_force_n", external_force_n.is_some())];
        let foreign: Vec<(&str, bool)> = match scenario {
            Scenario::Flight(_) => of_drives.into(),
            Scenario::Drive(_) => of_flights.into(),
            Scenario::Arm(_) => [&of_flights[..], &of_drives].concat(),
        };
        let mistake = |(key, _): (&str, bool)| Mistake {
            key: key.into(),
            value: "given".into(),
            bound: "left out: nothing of the kind acts on this robot".into(),
        };
        let foreign = foreign.into_iter().find(|(_, given)| *given).map(mistake);
        let checked = || {
            let there = |mistake: &Mistake| {
                mistake.key.starts_with("world.") || mistake.key.starts_with("execute.external_force_n")
            };
            self.around(scenario).check().into_iter().find(there)
        };
        foreign.or_else(checked)
    }

    /// Whether something was placed in the way.
    pub(super) fn is_furnished(&self) -> bool {
        !self.obstacles.is_empty() || !self.keep_out.is_empty()
    }

    /// What it is, for people.
    pub fn words(&self) -> Vec<String> {
        let vector = |v: &[f64]| format!("({})", v.iter().map(|x| number(Some(*x))).collect::<Vec<_>>().join(", "));
        let mut words = Vec::new();
        words.extend(self.wind_m_s.map(|wind| format!("wind {} m/s", vector(&wind))));
        words.extend(self.discrete_gust.map(|gust| {
            let [from, to] = [gust.start_s, gust.start_s + gust.duration_s].map(|t| number(Some(t)));
            format!("gust {} m/s, t = {from} … {to} s", vector(&gust.velocity_m_s))
        }));
        words.extend(self.obstacles.iter().map(|obstacle| {
            let ball = obstacle.sphere.map(|ball| {
                format!("ball of radius {} m at {} m", number(Some(ball.radius_m)), vector(&ball.center_m))
            });
            let cuboid = obstacle
                .cuboid
                .map(|cuboid| format!("box of {} m at {} m", vector(&cuboid.size_m), vector(&cuboid.center_m)));
            format!("{}: {}", obstacle.name, ball.or(cuboid).unwrap_or_default())
        }));
        words.extend(self.external_force_n.map(|force| format!("steady force {} N", vector(&force))));
        words.extend(self.keep_out.iter().map(|place| {
            let disc = place.circle.map(|circle| {
                format!("disc of radius {} m at {} m", number(Some(circle.radius_m)), vector(&circle.center_m))
            });
            format!("{}: {}", place.name, disc.unwrap_or_default())
        }));
        words
    }
}

/// Takes `vector` back to length 1 where it is longer, along itself.
pub(super) fn into_unit_ball(vector: &mut [f64]) {
    let norm = vector.iter().map(|x| x * x).sum::<f64>().sqrt().max(1.0);
    vector.iter_mut().for_each(|x| *x /= norm);
}
