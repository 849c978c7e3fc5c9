//! What flies, as code of the user's that steers it knows it.
//!
//! What a program of the user's is handed and what it answers, as JSON: SI units with the unit in the key, world frame
//! of the cage, quaternions of `world_from_body` as w, x, y, z, rates in the body's frame.

use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use serde::Deserialize;
use serde_json::{Value, json};

use crate::campaign::own_controller::{Planned, Steered, keys};
use crate::robot::quadrotor::Quadrotor;
use crate::simulation::{FlightCommand, FlightState};
use crate::trajectory::Profile;

/// By how much the norm of a quaternion may differ from 1: whoever rounds to three digits is understood.
///
/// What passes is made a unit quaternion.
const NORM: f64 = 0.01;

/// Exactly one of four sets of keys; the more is asked for, the less of hairpin's own loops is in between: velocity,
/// acceleration, thrust with attitude, thrust with rates. Thrust is in N.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Answer {
    v_m_s: Option<[f64; 3]>,
    a_m_s2: Option<[f64; 3]>,
    thrust_n: Option<f64>,
    q_wxyz: Option<[f64; 4]>,
    w_rad_s: Option<[f64; 3]>,
}

impl Steered for Quadrotor {
    const WANTED: &'static str = "one of {\"v_m_s\"}, {\"a_m_s2\"}, {\"thrust_n\",\"q_wxyz\"}, {\"thrust_n\",\"w_rad_s\"}, of finite \
                      numbers";

    fn numbers(&self) -> Value {
        json!({
            "kind": "quadrotor",
            "name": self.name,
            "mass_kg": self.mass,
            "inertia_kg_m2": <[f64; 3]>::from(self.inertia),
            "max_thrust_n": self.max_thrust(),
            "max_speed_m_s": self.max_speed,
            "gravity_m_s2": self.gravity,
        })
    }

    fn state(state: &FlightState) -> (f64, Value) {
        let q = state.attitude;
        let state_of = json!({
            "p_m": <[f64; 3]>::from(state.position),
            "v_m_s": <[f64; 3]>::from(state.velocity),
            "q_wxyz": [q.w, q.i, q.j, q.k],
            "w_rad_s": <[f64; 3]>::from(state.rates),
        });
        (state.t, state_of)
    }

    /// Plans have yaw 0. From the end on the plan is at rest; `None` for a plan without legs.
    fn planned(plan: &Profile, t: f64) -> Option<Planned> {
        let (_, motion) = plan.motion(t)?;
        let [p_m, v_m_s, a_m_s2] = motion.map(|part| Some(part.into()));
        Some(Planned { p_m, v_m_s, a_m_s2, yaw_rad: Some(0.0), ..Planned::default() })
    }

    fn planned_s(plan: &Profile) -> f64 {
        plan.duration()
    }

    /// # Errors
    /// Keys that go with no command, or a quaternion whose norm is off, in a sentence.
    fn command(answer: &Value) -> Result<FlightCommand, String> {
        let Answer { v_m_s, a_m_s2, thrust_n, q_wxyz, w_rad_s } = keys::<Self, Answer>(answer)?;
        match (v_m_s, a_m_s2, thrust_n, q_wxyz, w_rad_s) {
            (Some(v), None, None, None, None) => Ok(FlightCommand::Velocity(Vector3::from(v))),
            (None, Some(a), None, None, None) => Ok(FlightCommand::Acceleration(Vector3::from(a))),
            (None, None, Some(thrust), Some([w, x, y, z]), None) => {
                let q = Quaternion::new(w, x, y, z);
                if (q.norm() - 1.0).abs() <= NORM {
                    return Ok(FlightCommand::Attitude { thrust, attitude: UnitQuaternion::new_normalize(q) });
                }
                Err(format!("q_wxyz must have the norm 1, not {}", q.norm()))
            }
            (None, None, Some(thrust), None, Some(w)) => Ok(FlightCommand::Rates { thrust, rates: Vector3::from(w) }),
            _ => Err(format!("must be {}", Self::WANTED)),
        }
    }
}
