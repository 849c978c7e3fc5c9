//! A drive as it is predicted, step by step: each moment's state, and what its wheels come to.

use nalgebra::Vector3;

use super::peaks::WheelPeaks;
use super::vehicle_state::{VehicleState, WheelState};
use crate::feasibility::steering::shooting::rough::{Driven, tilt};
use crate::robot::rover::{Effort, Rover, Twist, WheelMotion};
use crate::trajectory::{Direction, Timing};
use crate::world::terrain::Terrain;

/// A drive under way.
pub(super) struct Walk<'a, T> {
    pub(super) rover: &'a Rover,
    /// Of turns in place, rad/s.
    pub(super) turn_rate: f64,
    pub(super) direction: Direction,
    pub(super) timing: &'a Timing,
    pub(super) terrain: &'a T,
    pub(super) states: Vec<VehicleState>,
    /// What the wheels did a moment ago, and whether that was in the same stretch.
    ///
    /// The second is −1, 0 or 1: reverse, a turn in place, forward. Motions are handed on so that steer angles go on
    /// from where they were.
    pub(super) before: Option<([WheelMotion; 6], f64)>,
    pub(super) peaks: WheelPeaks,
}

impl<T: Terrain> Walk<'_, T> {
    /// time = t(s) + |turned| / ω; a wheel's rolling speed is its share of the body's twist times the pace over its
    /// radius.
    ///
    /// Called once for each step of the prediction, in order, with what holds in its middle. `Effort` in a turn in
    /// place is 0: no claim is made of what scrubbing takes.
    pub(super) fn add(&mut self, driven: &Driven) {
        let Self { rover, turn_rate, direction, .. } = *self;
        let time = self.timing.time_at(driven.s) + driven.turned / turn_rate;
        let sign = driven.step.signum();
        let delta = direction.at(driven.s, self.timing.length());
        let (twist, pace) = if driven.in_place {
            (Twist { turn: sign, ..Twist::IN_PLACE }, turn_rate)
        } else {
            (Twist::along(delta, driven.at.curvature, sign), self.timing.speed_at(driven.s))
        };
        let mode = if driven.in_place { 0.0 } else { sign };
        let last = self.before.as_ref().map(|(motions, _)| motions);
        let (motions, count) = rover.wheel_motions(&twist, &driven.settled.joints, last);
        let radius = rover.suspension.wheels(&[0.0; 3]).2;
        let mut wheels = [WheelState::default(); 6];
        for (wheel, motion) in wheels[..count].iter_mut().zip(&motions) {
            *wheel = WheelState { steer: motion.steer, speed: motion.rolls * pace / radius };
        }
        self.measure(&wheels[..count], time, mode);
        let at = [driven.at.x, driven.at.y, driven.at.yaw];
        // Turned in place nothing is climbed, and what scrubs is not known.
        let gains = self.timing.acceleration_at(driven.s);
        let effort = rover.effort(&driven.settled, libm::sincos(delta), sign, gains, &Vector3::zeros());
        let effort = effort.map(|effort| if driven.in_place { Effort::default() } else { effort });
        self.peaks.torque = self.peaks.torque.max(effort.map_or(0.0, |effort| effort.torque.abs()));
        self.states.push(VehicleState {
            time,
            s: driven.s,
            at: driven.at,
            settled: driven.settled,
            speed: mode * pace,
            direction: delta,
            tilt: tilt(&driven.settled),
            clearance: rover.belly_clearance(self.terrain, at, &driven.settled).unwrap_or(f64::NAN),
            tip_over_margin: rover.tip_over_margin(self.terrain, at, &driven.settled).unwrap_or(f64::NAN),
            effort,
            wheels,
        });
        self.before = Some((motions, mode));
    }

    /// Keeps the largest of what the wheels do; rates between moments of one stretch.
    ///
    /// ```text
    /// δ̇ ≈ |δ_i − δ_{i−1}| / Δt      dω/dt ≈ |ω_i − ω_{i−1}| / Δt      only within one stretch of one gear
    /// ```
    ///
    /// Where the gear changes or a turn begins the vehicle stands, and its wheels may swing at their own pace.
    fn measure(&mut self, wheels: &[WheelState], time: f64, mode: f64) {
        let peaks = &mut self.peaks;
        for wheel in wheels {
            peaks.steer = peaks.steer.max(wheel.steer.abs());
            peaks.speed = peaks.speed.max(wheel.speed.abs());
        }
        let same = self.before.as_ref().is_some_and(|(_, before)| *before == mode);
        let Some(last) = self.states.last().filter(|_| same && mode != 0.0) else { return };
        let elapsed = time - last.time;
        if elapsed <= 0.0 {
            return;
        }
        for (wheel, before) in wheels.iter().zip(&last.wheels) {
            peaks.steer_rate = peaks.steer_rate.max((wheel.steer - before.steer).abs() / elapsed);
            peaks.acceleration = peaks.acceleration.max((wheel.speed - before.speed).abs() / elapsed);
        }
    }
}
