//! What is said at a turn, and what is answered.

use hairpin::robot::arm::AXES;
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::{Map, Value};

/// What hairpin says.
#[derive(Debug, Serialize)]
#[serde(tag = "type", rename_all = "lowercase")]
pub(super) enum ToController<'a> {
    /// Before the first turn of a run.
    Reset {
        /// Where it is to go.
        mission: MissionLine<'a>,
    },
    /// At every turn.
    Control {
        /// When, s.
        t_s: f64,
        /// What is measured.
        state: Value,
        /// Where to go.
        reference: Box<ReferenceLine<'a>>,
    },
}

/// A run.
#[derive(Debug, Serialize)]
pub(super) struct MissionLine<'a> {
    pub(super) waypoints_m: &'a [[f64; 3]],
    pub(super) accept_m: f64,
    pub(super) planned_s: Option<f64>,
    pub(super) robot: &'a Value,
}

/// Where to go.
#[derive(Debug, Serialize)]
pub(super) struct ReferenceLine<'a> {
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) waypoints_m: Option<&'a [[f64; 3]]>,
    pub(super) next: usize,
    #[serde(flatten)]
    pub(super) planned: Planned,
}

/// The planned motion at a time; nothing where there is none.
#[derive(Debug, Clone, Copy, Default, Serialize)]
pub(super) struct Planned {
    pub(super) p_m: Option<[f64; 3]>,
    pub(super) v_m_s: Option<[f64; 3]>,
    pub(super) a_m_s2: Option<[f64; 3]>,
    pub(super) yaw_rad: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) q_rad: Option<[f64; AXES]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) dq_rad_s: Option<[f64; AXES]>,
}

/// The keys of an answer, but for `type`, which is not looked at.
///
/// # Errors
/// What it must be: `wanted`.
pub(super) fn keys<A: DeserializeOwned>(answer: &[u8], wanted: &str) -> Result<A, String> {
    let read = serde_json::from_slice::<Map<String, Value>>(answer).and_then(|mut keys| {
        keys.remove("type");
        serde_json::from_value(Value::Object(keys))
    });
    read.map_err(|error| format!("must be {wanted} ({error})"))
}
