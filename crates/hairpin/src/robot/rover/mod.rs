//! Rovers and other wheeled vehicles on rough ground: numbers, suspension, motion.
//!
//! Body frame: x forward, y left, z up (REP-103). Roll φ > 0 lifts the left side, pitch θ > 0 lowers the nose, yaw ψ
//! turns left; R = Rz(ψ) Ry(θ) Rx(φ).

mod body;
mod contact;
mod description;
mod error;
mod forces;
mod four_wheel;
mod motion;
mod rest;
mod rocker_bogie;
mod solve;
mod stability;
mod suspension;
mod wheels;

#[cfg(test)]
mod tests;

pub use body::{Belly, BellyDescription, Body};
pub use description::{RoverDescription, RoverKind};
pub use error::RoverError;
pub(super) use error::within;
pub use forces::{Effort, ForcesDescription, Weight};
pub use four_wheel::FourWheel;
pub use motion::{Kinematics, RateSlopes, Rates, Slip, rate_slopes, rates, slip_share};
pub use rest::{Gradient, Settled, Unsettled};
pub use rocker_bogie::RockerBogie;
pub use suspension::Suspension;
pub use wheels::{Steering, Twist, WheelMotion, Wheels, WheelsDescription};

/// A rover's numbers, SI, all checked and finite. Built by [`RoverDescription::build`].
#[derive(Debug, Clone, PartialEq)]
pub struct Rover {
    /// Name, as in `data/robots`.
    pub name: String,
    /// What must be said wherever the robot is named; empty if nothing.
    pub caveat: String,
    /// Where the numbers come from.
    pub source: String,
    /// How the body rests on its wheels.
    pub suspension: Suspension,
    /// What the wheels carry.
    pub body: Body,
    /// How the wheels move it.
    pub wheels: Wheels,
    /// What it may do.
    pub limits: Limits,
    /// How commands become motion.
    pub response: Response,
    /// How the ground gives way.
    pub slip: Slip,
    /// What the wheels carry and overcome; `None` where no force is asked for.
    pub weight: Option<Weight>,
    /// Which rates the motion has; not a robot's own number, but asked for with what is to be driven.
    pub kinematics: Kinematics,
    /// Speed where none is given, m/s.
    pub default_speed: f64,
    /// Names of the numbers that were derived here, not given.
    pub estimated: Vec<&'static str>,
}

/// Bounds of a rover's motion; infinite where there is none.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// Largest |κ|, 1/m.
    pub curvature: f64,
    /// Largest |dκ/ds|, 1/m².
    pub curvature_rate: f64,
    /// Largest speed, m/s.
    pub speed: f64,
    /// Largest acceleration, m/s².
    pub acceleration: f64,
    /// Largest angle between the body's z axis and the vertical, rad.
    pub tilt: f64,
    /// Largest |rocker or bogie angle|, rad.
    pub joint: f64,
    /// Whether the vehicle can turn in place.
    pub turns_in_place: bool,
}

/// How the steering follows its command.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Response {
    /// A command acts this much later, s.
    pub latency: f64,
    /// Time constant of the first-order lag of steering, s; 0: none.
    pub steering_time_constant: f64,
    /// Largest rate of the steering angle, rad/s.
    pub steering_rate: f64,
    /// Distance of the steered axle from the line through the turning centre, m: κ = tan(δ) / it.
    pub steered_axle: f64,
}

impl Response {
    /// Whether the wheels take time to steer.
    pub fn lags(&self) -> bool {
        self.steering_time_constant > 0.0 || self.steering_rate.is_finite()
    }
}

impl Default for Response {
    /// At once and exactly.
    fn default() -> Self {
        Self { latency: 0.0, steering_time_constant: 0.0, steering_rate: f64::INFINITY, steered_axle: 1.0 }
    }
}
