//! What sails, as code of the user's that steers it knows it.
//!
//! Told: place and velocity over ground (map frame, m, m/s), heading (rad), rate of turn (rad/s), and the plan's at
//! that time. Answered: surge and sway force in the boat's frame, N, and the yaw moment, N·m.

use serde::Deserialize;
use serde_json::{Value, json};

use crate::campaign::own_controller::{Planned, Steered, keys};
use crate::robot::boat::Boat;
use crate::simulation::boat::{BoatCommand, BoatState};
use crate::trajectory::Profile;

/// Surge and sway, N, ahead and to the left in the boat's frame; the moment is positive to the left. Other keys are
/// refused.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Answer {
    force_n: [f64; 2],
    moment_n_m: f64,
}

impl Steered for Boat {
    const WANTED: &'static str = "{\"force_n\",\"moment_n_m\"}, of finite numbers";

    fn numbers(&self) -> Value {
        json!({
            "kind": "boat",
            "name": self.name,
            "max_speed_m_s": self.top_speed,
            "default_speed_m_s": self.default_speed,
        })
    }

    fn state(state: &BoatState) -> (f64, Value) {
        let v = state.over_ground();
        let state_of = json!({
            "p_m": [state.position.x, state.position.y, 0.0],
            "yaw_rad": state.heading,
            "v_m_s": [v.x, v.y, 0.0],
            "w_rad_s": [0.0, 0.0, state.velocity.z],
        });
        (state.t, state_of)
    }

    /// Of its plan the third coordinate is the heading.
    fn planned(plan: &Profile, t: f64) -> Option<Planned> {
        let (_, motion) = plan.motion(t)?;
        let [p_m, v_m_s, a_m_s2] = motion.map(|part| Some([part.x, part.y, 0.0]));
        Some(Planned { p_m, v_m_s, a_m_s2, yaw_rad: Some(motion[0].z), ..Planned::default() })
    }

    fn planned_s(plan: &Profile) -> f64 {
        plan.duration()
    }

    fn command(answer: &Value) -> Result<BoatCommand, String> {
        let Answer { force_n: [surge, sway], moment_n_m: yaw } = keys::<Self, Answer>(answer)?;
        Ok(BoatCommand { surge, sway, yaw })
    }
}
