//! Rovers and other wheeled vehicles on rough ground: numbers, suspension, motion.
//!
//! Body frame: x forward, y left, z up (REP-103). Roll φ > 0 lifts the left side, pitch θ > 0 lowers the nose, yaw ψ
//! turns left; R = Rz(ψ) Ry(θ) Rx(φ).
//!
//! The pose has six numbers and three are free: at a place (x, y, ψ) the ground and the suspension settle z, φ, θ and
//! the joints. So a drive is integrated in the plane, and at every step
//!
//! ```text
//! settle    F(z, φ, θ, joints; x, y, ψ) = 0              one gap for each wheel           (suspension)
//! rates     (ẋ, ẏ, ψ̇) from vx, vy, ωz and the lean       slip by the sine of the slope    (motion)
//! wheels    v_w = v + ω × r_w                             steer angles, rolling speeds     (rolling)
//! forces    F = m g (sin(climb) + c cosφ cosθ) + m v̇     torque of each wheel             (forces)
//! margins   tipping, underside                            by force-angle, by a grid        (stability)
//! ```
//!
//! | type | is |
//! | --- | --- |
//! | [`Rover`] | all numbers of a vehicle; built by [`RoverDescription::build`] |
//! | [`Suspension`] | level, [`FourWheel`] (least squares), [`RockerBogie`] (square Newton) |
//! | [`Settled`], [`Gradient`], [`Unsettled`] | a rest, how it changes with the place, or why there is none |
//! | [`Rates`], [`Slip`], [`Kinematics`] | the body's motion over the ground |
//! | [`Wheels`], [`Twist`], [`WheelMotion`] | the wheels' motion that belongs to it |
//! | [`Weight`], [`Effort`] | what it takes |
//! | [`Rims`] | what two driven wheels leave at a speed |
//! | [`Body`], [`Belly`] | centre of mass, underside |
//!
//! After T. Howard and A. Kelly, "Optimal rough terrain trajectory generation for wheeled mobile robots", IJRR 26(2),
//! 2007.
//!
//! Assumed: wheels are rigid balls that stay on the ground, the body is in static rest at every place, slip depends on
//! the slope alone. Neglected: dynamics of the suspension, sinkage, wheels that lift off or spin.

mod at_speed;
mod body;
mod contact;
mod description;
mod error;
mod forces;
mod four_wheel;
mod kinematics;
mod motion;
mod response;
mod rest;
mod rims;
mod rocker_bogie;
mod rolling;
mod stability;
mod suspension;
mod weight;
mod wheels;

#[cfg(feature = "unit-tests")]
mod tests;

pub use body::{Belly, BellyDescription, Body};
pub use description::{RoverDescription, RoverKind};
pub use error::RoverError;
pub(super) use error::within;
pub use forces::Effort;
pub use four_wheel::FourWheel;
pub use kinematics::{Kinematics, Slip};
pub use motion::{RateSlopes, Rates, rate_slopes, rates, slip_share};
pub use response::Response;
pub(super) use response::Unplanned;
pub use rest::{Gradient, Settled, Unsettled};
pub use rims::Rims;
pub use rocker_bogie::RockerBogie;
pub use rolling::{Twist, WheelMotion};
pub use suspension::Suspension;
pub use weight::{ForcesDescription, Weight};
pub use wheels::{Steering, Wheels, WheelsDescription};

/// Largest speed of any ground vehicle, m/s: faster ones are no kinematic ones.
pub const MOST_SPEED: f64 = 100.0;

/// A rover's numbers, SI, all checked and finite. Built by [`RoverDescription::build`].
///
/// Also what a car or a differential drive is planned as: then [`Suspension::Level`], and no weight.
///
/// ```
/// use hairpin::robot::rover::{RoverDescription, Settled, Twist};
/// use hairpin::world::terrain::Flat;
///
/// let file = serde_json::json!({
///     "kind": "rover", "name": "cart", "steering": "all-wheel",
///     "suspension": { "kind": "four-wheel", "wheel_radius_m": 0.1,
///         "front_m": [0.4, 0.3, 0.0], "rear_m": [-0.4, 0.3, 0.0] },
///     "centre_of_mass_m": [0.0, 0.0, 0.2],
///     "limits": { "curvature_1_m": 1.0 },
/// });
/// let cart = serde_json::from_value::<RoverDescription>(file)?.build()?;
/// let (rest, _) = cart.suspension.settle_cold(&Flat, [0.0, 0.0, 0.0])?;
/// assert!((rest.z - 0.1).abs() < 1e-9); // the body's origin is at the height of the axles
/// let margin = cart.tip_over_margin(&Flat, [0.0, 0.0, 0.0], &rest)?;
/// assert!((margin - f64::atan2(0.3, 0.3)).abs() < 1e-9); // half the track over the height of the mass
/// let (motions, count) = cart.wheel_motions(&Twist::along(0.0, 1.0, 1.0), &rest.joints, None);
/// assert!(count == 4 && motions[0].steer > 0.0 && motions[2].steer < 0.0); // turning left
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
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
    /// The two driven wheels of a differential drive, which bound how it turns at a speed; `None` of others.
    pub rims: Option<Rims>,
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
///
/// κ and κ′ bind the commanded path, tilt and joints every place where the body is settled.
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

impl Limits {
    /// The limit that a body breaks whose largest tilt and |angle of a joint| are these (rad), `tilt_rad` before
    /// `joint_rad`, and by how much.
    pub fn broken_at_rest(&self, tilt: f64, joint: f64) -> Option<(&'static str, f64)> {
        let over = [("tilt_rad", tilt - self.tilt), ("joint_rad", joint - self.joint)];
        over.into_iter().find(|(_, over)| *over > 0.0)
    }
}
