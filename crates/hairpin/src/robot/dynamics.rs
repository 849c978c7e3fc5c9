//! The trait that a new kind of robot implements: x' = f(x, u), with names and units for every component.

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
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds<V> {
    /// Smallest admissible value of each component.
    pub min: V,
    /// Largest admissible value of each component.
    pub max: V,
}

/// A robot as a differential equation x' = f(x, u), SI units.
pub trait Dynamics: Sync {
    /// State x.
    type State: Vector;
    /// Control u.
    type Control: Vector;
    /// Name and unit of every component of the state, in order.
    const STATE: &'static [Quantity];
    /// f(x, u).
    fn derivative(&self, state: &Self::State, control: &Self::Control) -> Self::State;
    /// The limits of u.
    fn control_bounds(&self) -> Bounds<Self::Control>;
    /// `world_from_body` of a state.
    fn pose(&self, state: &Self::State) -> Isometry3<f64>;
    /// Brings a state back onto its manifold after an integration step (unit quaternions); identity by default.
    fn normalize(&self, _state: &mut Self::State) {}
}
