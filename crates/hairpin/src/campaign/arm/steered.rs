//! An arm as code of the user's that steers it knows it.
//!
//! Told: the joints' bounds (rad) and top speeds (rad/s); at every step the angles (rad) and rates (rad/s), and what
//! the plan has for them. Answered: rates, rad/s, one a joint.

use serde::Deserialize;
use serde_json::{Value, json};

use crate::campaign::own_controller::{Planned, Steered, keys};
use crate::robot::arm::{AXES, Arm};
use crate::simulation::arm::{ArmCommand, ArmState, JointPlan};

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Answer {
    dq_rad_s: [f64; AXES],
}

impl Steered for Arm {
    const WANTED: &'static str = "{\"dq_rad_s\"}, six finite numbers";

    fn numbers(&self) -> Value {
        json!({
            "kind": "arm",
            "name": self.name,
            "lower_rad": self.limits.map(|limit| limit.lower),
            "upper_rad": self.limits.map(|limit| limit.upper),
            "speed_rad_s": self.limits.map(|limit| limit.speed),
        })
    }

    fn state(state: &ArmState) -> (f64, Value) {
        (state.t, json!({ "q_rad": state.joints, "dq_rad_s": state.rates }))
    }

    fn planned(plan: &JointPlan, t: f64) -> Option<Planned> {
        let (joints, rates) = plan.at(t);
        Some(Planned { q_rad: Some(joints), dq_rad_s: Some(rates), ..Planned::default() })
    }

    fn planned_s(plan: &JointPlan) -> f64 {
        plan.duration()
    }

    fn command(answer: &Value) -> Result<ArmCommand, String> {
        keys::<Self, Answer>(answer).map(|Answer { dq_rad_s: rates }| ArmCommand { rates })
    }
}
