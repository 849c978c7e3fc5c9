//! Controllers of the user's on our plants: a Python function, or a program that answers line by line.
//!
//! ```text
//! > {"type":"reset","mission":{"waypoints_m":[[x,y,z],…],"accept_m":1.0,"robot":{"name":…},"planned_s":27.1}}
//! < {}
//! > {"type":"control","t_s":0.01,"state":{"p_m":[…],"v_m_s":[…],"q_wxyz":[…],"w_rad_s":[…]},
//!    "reference":{"waypoints_m":[…],"next":1,"p_m":[…],"v_m_s":[…],"a_m_s2":[…],"yaw_rad":0.0}}
//! < {"v_m_s":[…]}
//! ```
//!
//! SI, world frame, in lockstep: the plant waits. The last four of `reference` are of the planned motion at that time,
//! null where there is none. A program may leave `reset` unanswered.
//!
//! | robot | state | answers |
//! | --- | --- | --- |
//! | quadrotor | `p_m`, `v_m_s`, `q_wxyz`, `w_rad_s` | `v_m_s`; `a_m_s2`; `thrust_n` with `q_wxyz`, or with `w_rad_s` |
//! | rover, car | `p_m`, `yaw_rad`, `v_m_s`, `curvature_1_m` | `v_m_s` with `curvature_1_m`, and `turn_rad_s`, `direction_rad` |
//! | arm | `q_rad`, `dq_rad_s`; `reference` has `q_rad`, `dq_rad_s` of the plan | `dq_rad_s` |
//! | boat | `p_m`, `yaw_rad`, `v_m_s`, `w_rad_s` | `force_n` (ahead, to port) with `moment_n_m` |
//!
//! Whatever goes wrong at a turn ends that run, and its process with it; the next run has a new one.

mod arm;
mod boat;
mod drive;
mod flight;
mod helm;
mod steersman;
mod turn;

use std::sync::Arc;

use hairpin::campaign::own_controller::AnyController;
use hairpin::robot::arm::Arm;
use hairpin::robot::boat::Boat;
use hairpin::robot::quadrotor::Quadrotor;
use hairpin::robot::rover::Rover;
use hairpin::simulation::OwnController;

use helm::{AtTheHelm, Steered};
pub(crate) use steersman::{Source, Steersman};

/// `steersman` for each kind of robots that it can be asked to steer.
pub(crate) fn controllers(steersman: &Arc<Steersman>) -> Vec<AnyController> {
    vec![of::<Quadrotor>(steersman), of::<Rover>(steersman), of::<Boat>(steersman), of::<Arm>(steersman)]
}

fn of<R: Steered>(steersman: &Arc<Steersman>) -> AnyController {
    let steersman = steersman.clone();
    let name = steersman.name().to_owned();
    OwnController::<R>::new(&name, move |robot| AtTheHelm::new(&steersman, robot)).into()
}
