//! What a vehicle is at one moment of a drive, and a drive's moments at even times.

use crate::robot::rover::{Effort, Settled};
use crate::trajectory::drive::Planar;

/// One moment of a drive.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VehicleState {
    /// Since the drive began, s; turns in place take their time.
    pub time: f64,
    /// Metres driven.
    ///
    /// Turns in place add none.
    pub s: f64,
    /// Over the ground; the curvature is the steering's.
    pub at: Planar,
    /// How the body stands: height, roll, pitch, joints.
    pub settled: Settled,
    /// Speed along the path, m/s; negative in reverse, 0 in turns in place.
    pub speed: f64,
    /// Direction of travel in the body, rad.
    pub direction: f64,
    /// Angle of the body's z axis from the vertical, rad.
    ///
    /// 0 … π; acos(cos roll · cos pitch).
    pub tilt: f64,
    /// Height of the underside over the ground, m; infinite without wheels, negative where it would touch.
    pub clearance: f64,
    /// Angle by which the body must lean further to tip over, rad; π/2 without wheels.
    ///
    /// NaN where the ground tells nothing.
    pub tip_over_margin: f64,
    /// What the wheels push or brake with; `None` without a weight.
    pub effort: Option<Effort>,
    /// Steer angle (rad) and rolling speed (rad/s) of each wheel.
    ///
    /// Those beyond the vehicle's count are 0.
    pub wheels: [WheelState; 6],
}

/// One wheel at one moment.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct WheelState {
    /// rad, left positive.
    pub steer: f64,
    /// rad/s, forward positive.
    pub speed: f64,
}

/// `states` at every `step` seconds, linear between, and at both ends; `jumps`: speeds of different sign are not
/// passed between.
///
/// O(states + samples). Times are i · step and the end; no states, no samples. `step` > 0, s.
pub(super) fn sampled(states: &[VehicleState], step: f64, jumps: bool) -> Vec<VehicleState> {
    let (Some(first), Some(last)) = (states.first(), states.last()) else { return Vec::new() };
    let mut sampled = vec![*first];
    let mut pairs = states.windows(2).peekable();
    // Rows that would come within rounding of the end are the end.
    let count = (last.time / step - 1e-6).ceil().max(1.0) as usize;
    for i in 1..count {
        let time = i as f64 * step;
        while pairs.next_if(|pair| pair[1].time < time).is_some() {}
        let Some(pair) = pairs.peek() else { break };
        sampled.push(between(&pair[0], &pair[1], time, jumps));
    }
    sampled.push(*last);
    sampled
}

/// Linear in all but, where it `jumps`, speeds of different sign, which are the later one then. Yaw is continuous, not
/// wrapped.
fn between(a: &VehicleState, b: &VehicleState, time: f64, jumps: bool) -> VehicleState {
    let share = if b.time > a.time { (time - a.time) / (b.time - a.time) } else { 0.0 };
    let mix = |a: f64, b: f64| a + share * (b - a);
    let at = Planar {
        x: mix(a.at.x, b.at.x),
        y: mix(a.at.y, b.at.y),
        yaw: mix(a.at.yaw, b.at.yaw),
        curvature: mix(a.at.curvature, b.at.curvature),
    };
    let settled = Settled {
        z: mix(a.settled.z, b.settled.z),
        roll: mix(a.settled.roll, b.settled.roll),
        pitch: mix(a.settled.pitch, b.settled.pitch),
        joints: std::array::from_fn(|i| mix(a.settled.joints[i], b.settled.joints[i])),
    };
    let wheel = |i: usize| WheelState {
        steer: mix(a.wheels[i].steer, b.wheels[i].steer),
        speed: mix(a.wheels[i].speed, b.wheels[i].speed),
    };
    VehicleState {
        time,
        s: mix(a.s, b.s),
        at,
        settled,
        // What stops by an even acceleration starts by the same: its speed is linear through rest.
        speed: if !jumps || a.speed * b.speed > 0.0 { mix(a.speed, b.speed) } else { b.speed },
        direction: mix(a.direction, b.direction),
        tilt: mix(a.tilt, b.tilt),
        clearance: if a.clearance.is_finite() { mix(a.clearance, b.clearance) } else { b.clearance },
        tip_over_margin: mix(a.tip_over_margin, b.tip_over_margin),
        effort: a
            .effort
            .zip(b.effort)
            .map(|(a, b)| Effort { traction: mix(a.traction, b.traction), torque: mix(a.torque, b.torque) }),
        wheels: std::array::from_fn(wheel),
    }
}
