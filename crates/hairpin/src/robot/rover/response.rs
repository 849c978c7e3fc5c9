//! How commands become motion.

use super::error::{RoverError, within};

/// How the wheels follow their commands, and the vehicle its wheels.
///
/// A commanded κ waits for the latency, then steers: τ δ̇ = δ_commanded − δ with |δ̇| bounded, κ = tan(δ)/steered_axle;
/// a commanded speed likewise, T v̇ = v_commanded − v. Over the ground the vehicle goes by `speed_scale` of the wheels'
/// way, on a curvature of `turn_scale` of theirs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Response {
    /// A command acts this much later, s.
    pub latency: f64,
    /// Time constant of the first-order lag of steering, s; 0: none.
    pub steering_time_constant: f64,
    /// Largest rate of the steering angle, rad/s.
    ///
    /// Infinite where it is not bounded.
    pub steering_rate: f64,
    /// Distance of the steered axle from the line through the turning centre, m: κ = tan(δ) / it.
    pub steered_axle: f64,
    /// Time constant of the first-order lag of the speed, s; 0: none.
    pub speed_time_constant: f64,
    /// Way over the ground by that of the wheels.
    pub speed_scale: f64,
    /// Curvature over the ground by that of the wheels.
    pub turn_scale: f64,
}

impl Response {
    /// Whether the wheels take time to steer.
    pub fn lags(&self) -> bool {
        self.steering_time_constant > 0.0 || self.steering_rate.is_finite()
    }

    /// As plans have it: without latency and the speed's lag, which a leg's end cannot hand to the next one, and on
    /// wheels that do as they are taken to.
    pub fn as_planned(&self) -> Self {
        let Self { steering_time_constant, steering_rate, steered_axle, .. } = *self;
        Self { steering_time_constant, steering_rate, steered_axle, ..Self::default() }
    }
}

impl Default for Response {
    /// At once and exactly.
    fn default() -> Self {
        Self {
            latency: 0.0,
            steering_time_constant: 0.0,
            steering_rate: f64::INFINITY,
            steered_axle: 1.0,
            speed_time_constant: 0.0,
            speed_scale: 1.0,
            turn_scale: 1.0,
        }
    }
}

/// What of a response files have and plans leave out, beside the latency.
#[derive(Debug, Clone, Copy)]
pub(in crate::robot) struct Unplanned {
    pub(in crate::robot) speed_time_constant: Option<f64>,
    pub(in crate::robot) speed_scale: Option<f64>,
    pub(in crate::robot) turn_scale: Option<f64>,
}

impl Unplanned {
    /// `response` with it.
    ///
    /// Time constants 0 … 60 s, scales 0.1 … 10.
    pub(in crate::robot) fn build(self, response: Response) -> Result<Response, RoverError> {
        let lag = self.speed_time_constant.unwrap_or(0.0);
        let scale = |key: &str, value: Option<f64>| within(key, value.unwrap_or(1.0), 0.1, 10.0);
        Ok(Response {
            speed_time_constant: within("response.speed_time_constant_s", lag, 0.0, 60.0)?,
            speed_scale: scale("response.speed_scale", self.speed_scale)?,
            turn_scale: scale("response.turn_scale", self.turn_scale)?,
            ..response
        })
    }
}
