//! Paths of states and of wheels as CSV, a row a moment, in the frame of the question.

use hairpin::campaign::states::{States, VehicleState};

use super::Frame;
use crate::frames::other_yaw;

const STATE: [&str; 14] = [
    "t_s",
    "s_m",
    "x_m",
    "y_m",
    "z_m",
    "roll_rad",
    "pitch_rad",
    "yaw_rad",
    "curvature_1_m",
    "v_m_s",
    "direction_rad",
    "tilt_rad",
    "clearance_m",
    "tip_over_margin_rad",
];
/// Of rocker-bogies, which six wheels have.
const JOINTS: [&str; 3] = ["joint_rocker_rad", "joint_left_bogie_rad", "joint_right_bogie_rad"];
/// Of vehicles with a weight.
const EFFORT: [&str; 2] = ["traction_n", "wheel_torque_n_m"];

/// Where the vehicle is and how it heads, in the frame: x, y, yaw.
fn pose(state: &VehicleState, frame: Frame) -> [f64; 3] {
    let at = &state.at;
    match frame {
        Frame::Enu => [at.x, at.y, at.yaw],
        Frame::Ned => [at.y, at.x, other_yaw(at.yaw)],
    }
}

/// The path of states; without wheels there is no underside and nothing that tips, and their columns are empty. Joints
/// and forces have columns where the vehicle has them.
///
/// # Errors
/// Memory that cannot be had.
pub fn path_table(states: &States, frame: Frame) -> csv::Result<Vec<u8>> {
    let left = frame.left();
    let mut table = csv::Writer::from_writer(Vec::new());
    let weighs = states.states.first().is_some_and(|state| state.effort.is_some());
    let joints: &[&str] = if states.wheels == 6 { &JOINTS } else { &[] };
    let effort: &[&str] = if weighs { &EFFORT } else { &[] };
    table.write_record(STATE.iter().chain(joints).chain(effort))?;
    for state in &states.states {
        let [x, y, yaw] = pose(state, frame);
        let settled = &state.settled;
        let numbers = [
            state.time,
            state.s,
            x,
            y,
            left * settled.z,
            settled.roll,
            left * settled.pitch,
            yaw,
            left * state.at.curvature,
            state.speed,
            left * state.direction,
            state.tilt,
        ];
        let stands = |value: f64| if states.wheels > 0 && value.is_finite() { number(value) } else { String::new() };
        let joints = state.settled.joints.iter().take(joints.len()).map(|joint| number(left * joint));
        let effort = state.effort.iter().filter(|_| weighs).flat_map(|effort| [effort.traction, effort.torque]);
        let standing = [stands(state.clearance), stands(state.tip_over_margin)];
        table.write_record(numbers.map(number).into_iter().chain(standing).chain(joints).chain(effort.map(number)))?;
    }
    table.into_inner().map_err(|error| error.into_error().into())
}

/// Steer angles and rolling speeds of the wheels called `names`.
///
/// # Errors
/// Memory that cannot be had.
pub fn wheel_table(states: &States, names: &[&str], frame: Frame) -> csv::Result<Vec<u8>> {
    let left = frame.left();
    let mut table = csv::Writer::from_writer(Vec::new());
    let columns = names.iter().flat_map(|name| [format!("{name}_steer_deg"), format!("{name}_speed_rad_s")]);
    table.write_record(["t_s", "s_m", "x_m", "y_m", "yaw_rad"].map(str::to_owned).into_iter().chain(columns))?;
    for state in &states.states {
        let [x, y, yaw] = pose(state, frame);
        let wheels = state.wheels.iter().take(names.len());
        let wheels = wheels.flat_map(|wheel| [left * wheel.steer.to_degrees(), wheel.speed]);
        table.write_record([state.time, state.s, x, y, yaw].into_iter().chain(wheels).map(number))?;
    }
    table.into_inner().map_err(|error| error.into_error().into())
}

/// Digits that read back to the same bits; no minus before zero.
fn number(value: f64) -> String {
    (value + 0.0).to_string()
}
