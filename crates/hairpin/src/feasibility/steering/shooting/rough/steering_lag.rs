//! Steering that follows its command late: first order, with a bounded rate.
//!
//! Near rest steps in metres are long in seconds: they are parted until each is short beside the time constant.

use crate::robot::rover::Response;

/// The actual curvature of a vehicle whose steering lags.
#[derive(Debug, Clone, Copy)]
pub(super) struct SteeringLag {
    /// δ of the steered axle, rad.
    angle: f64,
    response: Response,
    /// No time constant and no bound of the rate: the command is the curvature, without a tangent of its arc tangent.
    follows_at_once: bool,
}

impl SteeringLag {
    /// Steering that stands at `curvature` (1/m).
    ///
    /// `curvature` is that of the wheels now; they stand at δ = atan(κ · axle).
    pub(super) fn new(response: &Response, curvature: f64) -> Self {
        let follows_at_once = response.steering_time_constant == 0.0 && response.steering_rate.is_infinite();
        let angle = if follows_at_once { 0.0 } else { libm::atan(curvature * response.steered_axle) };
        Self { angle, response: *response, follows_at_once }
    }

    /// Parts into which a step of `time` seconds is divided, so that the lag of each is short beside its time constant:
    /// from rest the first of n equal lengths takes the share 1/√n of the time.
    pub(super) fn substeps(&self, time: f64) -> u32 {
        let constant = self.response.steering_time_constant;
        if self.follows_at_once || constant == 0.0 {
            return 1;
        }
        let ratio = 4.0 * time / constant;
        (ratio * ratio).ceil().clamp(1.0, 32.0) as u32
    }

    /// The curvature after `time` seconds in which the command runs through `commanded` (1/m, from share 0 to 1).
    ///
    /// δ̇ = (δ_c − δ)/T within ± the largest rate, δ = atan(κ · axle); exact for a constant command, second order
    /// otherwise. Without a time constant it comes to the command, as far as the rate allows.
    ///
    /// δ moves by (δ_c − δ)(1 − e^(−t/T)), with the command at the middle of the step, cut to ± rate · t.
    pub(super) fn follow(&mut self, commanded: impl Fn(f64) -> f64, time: f64) -> f64 {
        if self.follows_at_once {
            return commanded(1.0);
        }
        let Response { steering_time_constant, steering_rate, steered_axle, .. } = self.response;
        let seen = if steering_time_constant > 0.0 { 0.5 } else { 1.0 };
        let wanted = libm::atan(commanded(seen) * steered_axle) - self.angle;
        let share = if steering_time_constant > 0.0 { -libm::expm1(-time / steering_time_constant) } else { 1.0 };
        let most = steering_rate * time;
        self.angle += (wanted * share).clamp(-most, most);
        libm::tan(self.angle) / steered_axle
    }
}
