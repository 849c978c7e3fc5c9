//! Arms.

use hairpin::robot::arm::{AXES, Arm};
use hairpin::simulation::arm::{ArmCommand, ArmState, JointPlan};
use serde::Deserialize;
use serde_json::{Value, json};

use super::helm::Steered;
use super::turn::{Planned, keys};

const WANTED: &str = "{\"dq_rad_s\"}, six finite numbers";

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Answer {
    dq_rad_s: [f64; AXES],
}

impl Steered for Arm {
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

    fn command(answer: &[u8]) -> Result<ArmCommand, String> {
        keys(answer, WANTED).map(|Answer { dq_rad_s: rates }| ArmCommand { rates })
    }
}
