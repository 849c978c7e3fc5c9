//! What a motion prediction is asked: what is driven on what, and how finely.

use crate::robot::rover::{Kinematics, Rover};
use crate::trajectory::{Direction, SpeedProfile};

/// Share of the steps that exact kinematics take: their rates change as the ground bends, the source's as it slopes.
const EXACT: f64 = 1.0 / 3.0;

/// How commands are integrated.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Steps {
    /// Longest step of an arc, m; exact kinematics take three for each.
    pub length: f64,
    /// Longest step of a turn in place, rad.
    pub angle: f64,
    /// Fewest steps of a segment.
    pub least: u32,
}

impl Default for Steps {
    /// 6 cm and 3°: the ground of elevation maps for wheels is not finer.
    fn default() -> Self {
        Self { length: 0.06, angle: 0.05, least: 8 }
    }
}

impl Steps {
    /// These for paths whose curvature changes by up to `most_rate` (1/m²): where that is more than 1, shorter in
    /// proportion, so that it changes by no more a step; a tenth at most, for vehicles whose wheels are turned at once.
    ///
    /// `most_rate` of the paths to be driven, not of the vehicle if that is larger.
    #[must_use]
    pub fn for_rate(self, most_rate: f64) -> Self {
        Self { length: self.length / most_rate.clamp(1.0, 10.0), ..self }
    }

    /// These for steering that takes `metres` of the way to follow a jump, its time constant times the speed: no more
    /// than a third of that, where it is any; a tenth at most.
    ///
    /// `metres` ≥ 0: time constant times top speed.
    #[must_use]
    pub fn for_lag(self, metres: f64) -> Self {
        let length = if metres > 0.0 { self.length.min((metres / 3.0).max(0.1 * self.length)) } else { self.length };
        Self { length, ..self }
    }
}

/// What stays the same along a prediction.
///
/// Everything that E depends on beside the commands; the same for all predictions of one solve.
pub struct Course<'a, T> {
    /// The vehicle.
    pub rover: &'a Rover,
    /// What it drives on.
    pub terrain: &'a T,
    /// Speed along what is driven; time matters only to latency and lag.
    pub speed: SpeedProfile,
    /// Direction of travel in the body: 0 straight on, otherwise crab.
    pub direction: Direction,
    /// How finely.
    pub steps: Steps,
}

impl<T> Course<'_, T> {
    /// Longest step of an arc, m.
    pub(super) fn step(&self) -> f64 {
        match self.rover.kinematics {
            Kinematics::Source => self.steps.length,
            Kinematics::Exact => EXACT * self.steps.length,
        }
    }
}
