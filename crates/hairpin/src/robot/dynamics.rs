//! The trait that a new kind of robot implements: x' = f(x, u), with names and units for every component.
//!
//! Whatever integrates, samples or steers needs no more of a robot than this. States are flat vectors, so that one
//! Runge-Kutta step serves all; attitude is carried as a unit quaternion and brought back onto the sphere by
//! [`Dynamics::normalize`].
//!
//! ```
//! use hairpin::math::integrate::rk4_step;
//! use hairpin::robot::{Bounds, Dynamics, Quantity};
//! use nalgebra::{Isometry3, Vector1, Vector2};
//!
//! /// A cart on a rail: x″ = u, |u| ≤ 1 m/s².
//! struct Cart;
//!
//! impl Dynamics for Cart {
//!     type State = Vector2<f64>;
//!     type Control = Vector1<f64>;
//!     const STATE: &'static [Quantity] = &[Quantity::new("x", "m"), Quantity::new("vx", "m_s")];
//!     fn derivative(&self, state: &Self::State, control: &Self::Control) -> Self::State {
//!         Vector2::new(state[1], control[0])
//!     }
//!     fn control_bounds(&self) -> Bounds<Self::Control> {
//!         Bounds { min: Vector1::new(-1.0), max: Vector1::new(1.0) }
//!     }
//!     fn pose(&self, state: &Self::State) -> Isometry3<f64> {
//!         Isometry3::translation(state[0], 0.0, 0.0)
//!     }
//! }
//!
//! let end = rk4_step(|x| Cart.derivative(x, &Vector1::new(0.5)), &Vector2::zeros(), 2.0);
//! assert!((Cart.pose(&end).translation.x - 1.0).abs() < 1e-12); // ½ · 0.5 · 2²
//! ```

use nalgebra::Isometry3;

pub use crate::math::integrate::Vector;

/// Name and unit of one component of a state or control.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Quantity {
    /// The field's name, as in columns: `vx`.
    pub name: &'static str,
    /// SI unit as in column names: `m_s`; empty for pure numbers.
    pub unit: &'static str,
}

impl Quantity {
    /// `name` in `unit`.
    pub const fn new(name: &'static str, unit: &'static str) -> Self {
        Self { name, unit }
    }
}

/// Component-wise limits of a control.
///
/// A box; limits that couple components (wheels that share what they can do) are the robot's own to clamp in
/// [`Dynamics::normalize`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds<V> {
    /// Smallest admissible value of each component.
    pub min: V,
    /// Largest admissible value of each component.
    pub max: V,
}

/// A robot as a differential equation x' = f(x, u), SI units.
///
/// `derivative` is a pure function of x and u: time, wind and noise belong to a plant, whose u and parameters they are.
/// Columns of logs are [`Dynamics::STATE`], name and unit joined.
pub trait Dynamics: Sync {
    /// State x.
    type State: Vector;
    /// Control u.
    type Control: Vector;
    /// Name and unit of every component of the state, in order.
    const STATE: &'static [Quantity];
    /// f(x, u).
    ///
    /// Component k has the unit of [`Dynamics::STATE`]`[k]` per second. Defined, if not meaningful, beyond the bounds
    /// of u.
    fn derivative(&self, state: &Self::State, control: &Self::Control) -> Self::State;
    /// The limits of u.
    fn control_bounds(&self) -> Bounds<Self::Control>;
    /// `world_from_body` of a state.
    fn pose(&self, state: &Self::State) -> Isometry3<f64>;
    /// Brings a state back onto its manifold after an integration step (unit quaternions); identity by default.
    ///
    /// Projects, never steers: |q| = 1, and states that stop at a limit stopped there.
    fn normalize(&self, _state: &mut Self::State) {}
}
