//! Quadrotors: numbers, checks, and the 12-state model behind a quaternion.
//!
//! ```text
//! ṗ = v                                q̇ = ½ q ⊗ (0, ω)
//! m v̇ = u₁ R(q) e₃ − m g e₃ − (c₁ + c₂|v|) v
//! I ω̇ = (u₂, u₃, u₄) − c|ω|ω − ω × I ω
//! u₁ = kf Σ wᵢ²    u₂ = kf Σ yᵢ wᵢ²    u₃ = −kf Σ xᵢ wᵢ²    u₄ = km Σ spinᵢ wᵢ²
//! ```
//!
//! The paper's 12-state model (Hildebrandt et al., ISSTA 2020, eqs. 1-4) with a quaternion in place of its angles, any
//! layout of four rotors, and drag. Rotors answer at once here; their lag, wind and noise are the plant's
//! (`simulation`).

mod derived;
mod description;
mod model;
pub mod published;

use nalgebra::Vector3;

pub use description::{QuadrotorDescription, QuadrotorError, QuadrotorKind, RotorDescription};
pub use model::{EulerState, QuadrotorState, from_euler_state, level_rest, to_euler_state};

use crate::math::power::square;

/// One rotor: thrust kf·w² along body z at (x, y), reaction moment spin·km·w² about body z.
///
/// Clockwise from above the blades push air round with them and the body the other way: counter-clockwise, +z.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rotor {
    /// Forward of the centre of mass, m.
    pub x: f64,
    /// Left of the centre of mass, m.
    pub y: f64,
    /// +1: turns clockwise seen from above (reaction +z); −1: counter-clockwise.
    pub spin: f64,
}

/// A quadrotor's numbers, SI, all checked and finite. Built by [`QuadrotorDescription::build`].
///
/// The inertia is diagonal in the body frame and the centre of mass the body's origin. The drag of the claim and of the
/// act is the same; a hull of reachable points leaves it out and says so.
///
/// ```
/// use hairpin::robot::quadrotor::{QuadrotorDescription, level_rest};
/// use nalgebra::Vector4;
///
/// let file = serde_json::json!({
///     "kind": "quadrotor", "name": "toy", "mass_kg": 0.5, "thrust_to_weight": 2.0, "max_speed_m_s": 12.0,
///     "rotors": [{ "x_m": 0.1, "y_m": 0.1, "spin": 1.0 }, { "x_m": -0.1, "y_m": 0.1, "spin": -1.0 },
///                { "x_m": -0.1, "y_m": -0.1, "spin": 1.0 }, { "x_m": 0.1, "y_m": -0.1, "spin": -1.0 }],
/// });
/// let robot = serde_json::from_value::<QuadrotorDescription>(file)?.build()?;
/// assert!(robot.estimated.iter().any(|key| key == "inertia_kg_m2")); // what it had to derive
/// let rest = robot.derivative(&level_rest(), &Vector4::repeat(robot.hover_speed()));
/// assert!(rest.norm() < 1e-9); // hovers
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Quadrotor {
    /// Name, as in `data/robots`.
    pub name: String,
    /// Mass m, kg.
    pub mass: f64,
    /// Principal moments of inertia (Ixx, Iyy, Izz), kg·m².
    pub inertia: Vector3<f64>,
    /// The four rotors.
    pub rotors: [Rotor; 4],
    /// kf, N/(rad/s)².
    pub thrust_coefficient: f64,
    /// km, N·m/(rad/s)².
    pub moment_coefficient: f64,
    /// Smallest and largest rotor speed, rad/s.
    pub rotor_speed: (f64, f64),
    /// Time constant of the first-order rotor lag, s; 0: none.
    pub rotor_time_constant: f64,
    /// Linear drag, N·s/m: force −c v.
    pub drag_linear: f64,
    /// Quadratic drag, N·s²/m²: force −c |v| v.
    pub drag_quadratic: f64,
    /// Aerodynamic moment, N·m·s²: −c |ω| ω.
    pub aerodynamic_moment: f64,
    /// Power spectral density of the force noise per axis, N²·s.
    pub force_noise: f64,
    /// Power spectral density of the moment noise per axis, N²·m²·s.
    pub moment_noise: f64,
    /// Top speed, m/s.
    pub max_speed: f64,
    /// Radius of the ball that holds the whole body, m.
    pub clearance_radius: f64,
    /// Gravity g, m/s².
    pub gravity: f64,
    /// Keys whose values hairpin derived rather than read: evidence word `estimated`.
    pub estimated: Vec<String>,
    /// What must be said wherever the robot is named, such as "a stand-in for …"; empty: nothing.
    pub caveat: String,
}

impl Quadrotor {
    /// Largest total thrust, N.
    ///
    /// 4 kf w_max², level flight or not: the rotors are taken to push the same at every speed through the air.
    pub fn max_thrust(&self) -> f64 {
        4.0 * self.thrust_coefficient * square(self.rotor_speed.1)
    }

    /// The rotor speed at which the four rotors carry the weight, rad/s.
    ///
    /// √(m g/(4 kf)). Exact for layouts whose rotors share the weight evenly.
    pub fn hover_speed(&self) -> f64 {
        (self.mass * self.gravity / (4.0 * self.thrust_coefficient)).sqrt()
    }
}
