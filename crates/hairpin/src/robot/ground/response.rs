//! How a vehicle without a suspension follows its commands.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::robot::rover::{Response, RoverError, Unplanned, within};

/// Delays, lags and scales of a car or a differential drive; none if not given.
///
/// All but the steering's lag are the act's: plans leave them out, and controllers meet them.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GroundResponse {
    /// A command acts this much later.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub latency_s: Option<f64>,
    /// First-order lag of the steering; of a differential drive that of the curvature.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub steering_time_constant_s: Option<f64>,
    /// First-order lag of the speed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub speed_time_constant_s: Option<f64>,
    /// Way over the ground by that of the wheels: wheels of another radius, or that slip; 1 if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub speed_scale: Option<f64>,
    /// Curvature over the ground by that of the wheels: wheels farther apart than they are taken for, or that scrub,
    /// turn less; 1 if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub turn_scale: Option<f64>,
}

impl GroundResponse {
    /// Of a vehicle whose wheels follow as `wheels` says but for what is given here.
    ///
    /// Times 0 … 60 s, scales 0.1 … 10.
    ///
    /// # Errors
    /// The first key out of bounds.
    pub(super) fn build(given: Option<&Self>, wheels: Response) -> Result<Response, RoverError> {
        let given = given.copied().unwrap_or_default();
        let time = |key: &str, value: Option<f64>| within(key, value.unwrap_or(0.0), 0.0, 60.0);
        let unplanned = Unplanned {
            speed_time_constant: given.speed_time_constant_s,
            speed_scale: given.speed_scale,
            turn_scale: given.turn_scale,
        };
        let response = Response {
            latency: time("response.latency_s", given.latency_s)?,
            steering_time_constant: time("response.steering_time_constant_s", given.steering_time_constant_s)?,
            ..wheels
        };
        unplanned.build(response)
    }

    /// Keys that logs may tell, and whether they are given.
    pub(super) fn numbers(given: Option<&Self>) -> [(&'static str, bool); 5] {
        let given = given.copied().unwrap_or_default();
        [
            ("response.latency_s", given.latency_s.is_some()),
            ("response.steering_time_constant_s", given.steering_time_constant_s.is_some()),
            ("response.speed_time_constant_s", given.speed_time_constant_s.is_some()),
            ("response.speed_scale", given.speed_scale.is_some()),
            ("response.turn_scale", given.turn_scale.is_some()),
        ]
    }
}
