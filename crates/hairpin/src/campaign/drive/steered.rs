//! What drives, as code of the user's that steers it knows it.
//!
//! What a program of the user's is handed and what it answers, as JSON: SI units with the unit in the key, world frame
//! of the map, headings from x towards y.

use std::f64::consts::TAU;

use nalgebra::{Isometry3, Vector3};
use serde::Deserialize;
use serde_json::{Value, json};

use crate::campaign::own_controller::{Planned, Steered, keys};
use crate::math::rotation::euler_from_quaternion;
use crate::robot::rover::Rover;
use crate::simulation::ground::{DriveCommand, DriveState};
use crate::trajectory::Track;

/// `v_m_s` below 0 is in reverse; `turn_rad_s` is meant for turning in place; `direction_rad` is the direction of
/// travel in the body. What is left out is 0; keys that are not known are refused.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Answer {
    v_m_s: f64,
    curvature_1_m: f64,
    #[serde(default)]
    turn_rad_s: f64,
    #[serde(default)]
    direction_rad: f64,
}

/// ψ of `world_from_body`, rad.
fn yaw(pose: &Isometry3<f64>) -> f64 {
    let q = &pose.rotation;
    euler_from_quaternion(&[q.w, q.i, q.j, q.k])[2]
}

impl Steered for Rover {
    const WANTED: &'static str =
        "{\"v_m_s\",\"curvature_1_m\"}, with \"turn_rad_s\" and \"direction_rad\" if wanted, of finite numbers";

    fn numbers(&self) -> Value {
        // JSON has no infinity: what has no bound is null.
        let bound = |value: f64| value.is_finite().then_some(value);
        json!({
            "kind": "ground",
            "name": self.name,
            "max_speed_m_s": bound(self.limits.speed),
            "max_acceleration_m_s2": bound(self.limits.acceleration),
            "max_curvature_1_m": bound(self.limits.curvature),
            "default_speed_m_s": self.default_speed,
        })
    }

    fn state(state: &DriveState) -> (f64, Value) {
        let [roll, pitch] = state.lean;
        let state_of = json!({
            "p_m": [state.at.x, state.at.y, state.height],
            "yaw_rad": state.at.yaw,
            "v_m_s": state.speed,
            "curvature_1_m": state.at.curvature,
            "roll_rad": roll,
            "pitch_rad": pitch,
            "turn_rad_s": state.turn_rate,
            "direction_rad": state.direction,
        });
        (state.t, state_of)
    }

    /// Velocities are the planned speeds; past the end it rests.
    ///
    /// Position and speeds by even accelerations between stamps, ψ linear between them the shorter way round. `None`
    /// for a plan without stamps.
    fn planned(plan: &Track, t: f64) -> Option<Planned> {
        let (times, poses) = (plan.times(), plan.poses());
        let last = times.len().checked_sub(1)?;
        let at = times.partition_point(|stamp| *stamp <= t).clamp(1, last.max(1)) - 1;
        let next = (at + 1).min(last);
        let span = times[next] - times[at];
        let share = if span > 0.0 { ((t - times[at]) / span).clamp(0.0, 1.0) } else { 0.0 };
        // The shorter way round.
        let turn = libm::remainder(yaw(&poses[next]) - yaw(&poses[at]), TAU);
        let (place, v, a) = plan.motion_at(t)?;
        let moves = t <= times[last];
        let still = |vector: Vector3<f64>| if moves { vector } else { Vector3::zeros() };
        Some(Planned {
            p_m: Some(place.coords.into()),
            v_m_s: Some(still(v).into()),
            a_m_s2: Some(still(a).into()),
            yaw_rad: Some(yaw(&poses[at]) + share * turn),
            ..Planned::default()
        })
    }

    fn planned_s(plan: &Track) -> f64 {
        plan.times().last().copied().unwrap_or_default()
    }

    fn command(answer: &Value) -> Result<DriveCommand, String> {
        let Answer { v_m_s, curvature_1_m, turn_rad_s, direction_rad } = keys::<Self, Answer>(answer)?;
        Ok(DriveCommand { speed: v_m_s, curvature: curvature_1_m, turn_rate: turn_rad_s, direction: direction_rad })
    }
}
