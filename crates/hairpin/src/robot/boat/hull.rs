//! A boat's numbers, and how it accelerates.

use nalgebra::Vector3;

use super::model::{Damping, Inertia};

/// Largest forces of the thrusters together, at every speed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Thrust {
    /// Largest X ahead, N.
    pub ahead: f64,
    /// Largest −X, N.
    pub astern: f64,
    /// Largest |Y|, N.
    pub sway: f64,
    /// Largest |N|, N·m.
    pub yaw: f64,
}

impl Thrust {
    /// Least and largest X, Y, N.
    pub fn bounds(&self) -> [[f64; 2]; 3] {
        [[-self.astern, self.ahead], [-self.sway, self.sway], [-self.yaw, self.yaw]]
    }
}

/// A boat's numbers, SI, all checked and finite. Built by [`BoatDescription::build`](super::BoatDescription::build).
///
/// ```
/// use hairpin::robot::boat::BoatDescription;
/// use nalgebra::Vector3;
///
/// let file = serde_json::json!({
///     "kind": "boat", "name": "toy", "mass_kg": 20.0, "yaw_inertia_kg_m2": 2.0, "length_m": 1.2, "beam_m": 0.3,
///     "hydrodynamics": { "x_du_kg": -2.0, "y_dv_kg": -10.0, "n_dr_kg_m2": -1.0, "x_u_kg_s": -2.0, "y_v_kg_s": -7.0,
///                        "n_r_kg_m2_s": -0.5 },
///     "thrust": { "ahead_n": 2.0, "sway_n": 1.0, "yaw_n_m": 1.0 },
/// });
/// let boat = serde_json::from_value::<BoatDescription>(file)?.build()?;
/// assert!((boat.top_speed - 1.0).abs() < 1e-9); // 2 N against 2 N s/m
/// let held = boat.acceleration(&Vector3::new(1.0, 0.0, 0.0), &Vector3::new(2.0, 0.0, 0.0));
/// assert!(held.norm() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Boat {
    /// Name, as in `data/robots`.
    pub name: String,
    /// What must be said wherever the robot is named; empty if nothing.
    pub caveat: String,
    /// Where the numbers come from.
    pub source: String,
    /// Mass of hull and water.
    pub inertia: Inertia,
    /// What the water takes.
    pub damping: Damping,
    /// What the thrusters give.
    pub thrust: Thrust,
    /// Time constant of their first-order lag, s; 0: none.
    pub thrust_time_constant: f64,
    /// Radius of the disc about the body's origin that holds the hull, m.
    pub radius: f64,
    /// Speed through the water under full thrust ahead, m/s.
    pub top_speed: f64,
    /// Speed where none is given, m/s.
    pub default_speed: f64,
    /// Names of the numbers that no source gives: derived here, or estimated by whoever wrote the file.
    pub estimated: Vec<String>,
}

impl Boat {
    /// ν̇ = M⁻¹ (τ − C(ν) ν − D(ν) ν) at the velocity ν through the water, m/s², rad/s².
    pub fn acceleration(&self, nu: &Vector3<f64>, tau: &Vector3<f64>) -> Vector3<f64> {
        self.inertia.solve(&(tau - self.inertia.coriolis(nu) - self.damping.force(nu)))
    }
}
