//! What arms are to controllers of the caller's own: joints that turn as they are told, beside a plan in time.

use nalgebra::Point3;

use crate::robot::arm::{AXES, Arm, Joints};
use crate::simulation::SimulationError;
use crate::simulation::controller::{Controlled, Controller, Misbehaviour, OwnController, Reference};

/// Time between two turns where the controller says none, s.
const PERIOD: f64 = 0.01;

/// What is measured of an arm: its own joints, exactly.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ArmState {
    /// When, s.
    pub t: f64,
    /// Angles q, rad.
    pub joints: Joints,
    /// q̇, rad/s.
    pub rates: Joints,
}

/// What a controller asks of the servos until its next turn: their set points turn at these rates, rad/s, and the
/// joints follow with their lag, no faster than they may.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ArmCommand {
    /// Of the set points, rad/s.
    pub rates: Joints,
}

/// Joint angles of a program in the time that the virtual controller plans for it.
#[derive(Debug, Clone, PartialEq)]
pub struct JointPlan {
    /// Time between two samples, s.
    pub(super) period: f64,
    /// Angles, rad, from t = 0.
    pub(super) joints: Vec<Joints>,
}

impl JointPlan {
    /// Angles (rad) and rates (rad/s) at `t` s, linear between samples; beyond its ends it stands.
    pub fn at(&self, t: f64) -> (Joints, Joints) {
        let last = self.joints.len() - 1;
        let place = (t / self.period).clamp(0.0, last as f64);
        let before = (place as usize).min(last.saturating_sub(1));
        let (from, to) = (self.joints[before], self.joints[(before + 1).min(last)]);
        let share = place - before as f64;
        let moves = t >= 0.0 && t < self.duration();
        let rate = |k: usize| if moves { (to[k] - from[k]) / self.period } else { 0.0 };
        (std::array::from_fn(|k| from[k] + share * (to[k] - from[k])), std::array::from_fn(rate))
    }

    /// Until it stands still, s.
    pub fn duration(&self) -> f64 {
        (self.joints.len() - 1) as f64 * self.period
    }
}

impl Controlled for Arm {
    const DOES: &'static str = "it is an arm";
    const LOOPS: Option<&'static str> = Some("hairpin's servos");

    type State = ArmState;
    type Plan = JointPlan;
    type Command = ArmCommand;

    fn is_finite(command: &ArmCommand) -> bool {
        command.rates.iter().all(|rate| rate.is_finite())
    }
}

/// Who steers an arm through a program, and where to.
#[derive(Debug, Clone, Copy)]
pub struct Steering<'a> {
    /// The controller.
    pub controller: &'a OwnController<Arm>,
    /// The program's points, m, base frame, the start included.
    pub waypoints: &'a [Point3<f64>],
}

/// The set points of a run that a controller of the caller's own gives.
pub(super) struct Steersman<'a> {
    name: &'a str,
    controller: Box<dyn Controller<Arm>>,
    waypoints: &'a [Point3<f64>],
    plan: JointPlan,
    /// Set points from turn to turn.
    every: usize,
    count: usize,
    period: f64,
    rates: Joints,
}

impl<'a> Steersman<'a> {
    /// At the beginning of a run with a set point every `step` s.
    pub(super) fn new(arm: &Arm, steering: Steering<'a>, plan: JointPlan, step: f64) -> Result<Self, SimulationError> {
        let Steering { controller: own, waypoints } = steering;
        let controller = own.make(arm);
        let period = controller.period().unwrap_or(PERIOD);
        if !(0.001..=1.0).contains(&period) {
            let value = format!("{period} ({})", own.name());
            return Err(SimulationError::new("controller.period", value, "from 0.001 to 1 s"));
        }
        let every = ((period / step).round() as usize).max(1);
        let period = every as f64 * step;
        let mut new =
            Self { name: own.name(), controller, waypoints, plan, every, count: 0, period, rates: [0.0; AXES] };
        let reference = Reference { waypoints, next: 1, accept: 0.0, plan: Some(&new.plan) };
        match new.controller.reset(&reference) {
            Ok(()) => Ok(new),
            Err(fault) => Err(new.failed(0.0, fault.into())),
        }
    }

    /// The set point after `from`, which stood at `t` s while the joints were measured as `state`; `next` is the point
    /// that the program's time is on the way to.
    pub(super) fn set_point(
        &mut self,
        from: &Joints,
        step: f64,
        state: ArmState,
        next: usize,
    ) -> Result<Joints, SimulationError> {
        if self.count == 0 {
            let reference = Reference { waypoints: self.waypoints, next, accept: 0.0, plan: Some(&self.plan) };
            self.rates = match self.controller.control(self.period, &state, &reference) {
                Err(fault) => return Err(self.failed(state.t, fault.into())),
                Ok(command) if !Arm::is_finite(&command) => {
                    return Err(self.failed(state.t, Misbehaviour::NotFinite { command: format!("{command:?}") }));
                }
                Ok(command) => command.rates,
            };
        }
        self.count = (self.count + 1) % self.every;
        Ok(std::array::from_fn(|k| from[k] + step * self.rates[k]))
    }

    fn failed(&self, t: f64, why: Misbehaviour) -> SimulationError {
        SimulationError::Controller { name: self.name.into(), t, why }
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;

    #[test]
    fn plans_are_linear_and_stand_beyond_their_ends() {
        let plan = JointPlan { period: 0.5, joints: vec![[0.0; AXES], [1.0; AXES], [1.0; AXES]] };
        assert_eq!(plan.at(0.25), ([0.5; AXES], [2.0; AXES]));
        assert_eq!(plan.at(0.75), ([1.0; AXES], [0.0; AXES]));
        assert_eq!(plan.at(7.0), ([1.0; AXES], [0.0; AXES]));
        let alone = JointPlan { period: 0.5, joints: vec![[3.0; AXES]] };
        assert_eq!(alone.at(0.1), ([3.0; AXES], [0.0; AXES]));
    }
}
