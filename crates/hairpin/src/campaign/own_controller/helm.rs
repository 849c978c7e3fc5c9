//! A run's controller whose turns are code of the user's.
//!
//! ```text
//! begin(mission) ─▶ turn(t, state, reference) ─▶ command … ─▶ finish, or dropped where something was wrong
//! ```
//!
//! One turn a period of the user's code; what lies between two turns is the last command, held by the loop.

use std::sync::Arc;

use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::{Value, json};

use crate::campaign::user_controller::{Turns, UserController, UserSteering};
use crate::robot::arm::AXES;
use crate::simulation::{Controlled, Controller, Fault, Reference};

/// Longest piece of an answer that is quoted, characters.
const QUOTED: usize = 120;

/// A kind of robot as the user's code knows it: keys with their units, SI, world frame.
pub(in crate::campaign) trait Steered: Controlled + 'static {
    /// What a command must be, in words.
    const WANTED: &'static str;

    /// The robot's numbers.
    fn numbers(&self) -> Value;

    /// When, s, and what is measured.
    fn state(state: &Self::State) -> (f64, Value);

    /// Where the planned motion is at `t` s.
    fn planned(plan: &Self::Plan, t: f64) -> Option<Planned>;

    /// How long the planned motion takes, s.
    fn planned_s(plan: &Self::Plan) -> f64;

    /// The command that an answer is.
    ///
    /// # Errors
    /// What it must be.
    fn command(answer: &Value) -> Result<Self::Command, String>;
}

/// The planned motion at a time; nothing where there is none.
///
/// m, m/s, m/s², rad, rad/s, by the names of its keys; world frame.
#[derive(Debug, Clone, Copy, Default, Serialize)]
pub(in crate::campaign) struct Planned {
    pub(in crate::campaign) p_m: Option<[f64; 3]>,
    pub(in crate::campaign) v_m_s: Option<[f64; 3]>,
    pub(in crate::campaign) a_m_s2: Option<[f64; 3]>,
    pub(in crate::campaign) yaw_rad: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in crate::campaign) q_rad: Option<[f64; AXES]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in crate::campaign) dq_rad_s: Option<[f64; AXES]>,
}

/// Where to go.
///
/// `next` is the number of the waypoint that is flown to, from 0.
#[derive(Serialize)]
struct Bearing {
    next: usize,
    #[serde(flatten)]
    planned: Planned,
}

/// The keys of an answer.
///
/// # Errors
/// That it must be what `R` wants.
pub(in crate::campaign) fn keys<R: Steered, A: DeserializeOwned>(answer: &Value) -> Result<A, String> {
    A::deserialize(answer).map_err(|error| format!("must be {} ({error})", R::WANTED))
}

/// See the file's first line.
///
/// An answer that is no command, or an error, ends its turns: whatever is asked after that is refused, and dropping
/// it gives up on the user's process without finishing it.
pub(super) struct AtTheHelm {
    code: Arc<dyn UserSteering>,
    robot: Value,
    /// What steers, as long as nothing was wrong with it.
    turns: Option<Box<dyn Turns>>,
}

impl AtTheHelm {
    /// Of a run of `robot` that `user` steers.
    pub(super) fn new<R: Steered>(user: &UserController, robot: &R) -> Self {
        Self { code: user.code.clone(), robot: robot.numbers(), turns: None }
    }
}

impl<R: Steered> Controller<R> for AtTheHelm {
    fn period(&self) -> Option<f64> {
        Some(self.code.period())
    }

    fn reset(&mut self, reference: &Reference<R>) -> Result<(), Fault> {
        let waypoints: Vec<[f64; 3]> = reference.waypoints.iter().map(|point| point.coords.into()).collect();
        let mission = json!({
            "waypoints_m": waypoints,
            "accept_m": reference.accept,
            "planned_s": reference.plan.map(R::planned_s),
            "robot": self.robot,
        });
        self.turns = Some(self.code.clone().begin(mission)?);
        Ok(())
    }

    fn control(&mut self, _dt: f64, now: &R::State, to: &Reference<R>) -> Result<R::Command, Fault> {
        let (t_s, state) = R::state(now);
        let planned = to.plan.and_then(|plan| R::planned(plan, t_s)).unwrap_or_default();
        let reference = json!(Bearing { next: to.next, planned });
        let Some(mut turns) = self.turns.take() else { return Err("it steers no more".into()) };
        let answer = turns.turn(t_s, &state, &reference)?;
        match R::command(&answer) {
            Ok(command) => {
                self.turns = Some(turns);
                Ok(command)
            }
            Err(bound) => {
                let said: String = answer.to_string().chars().take(QUOTED).collect();
                Err(format!("it answered `{said}`: {bound}").into())
            }
        }
    }
}

impl Drop for AtTheHelm {
    fn drop(&mut self) {
        if let Some(turns) = self.turns.take() {
            turns.finish();
        }
    }
}
