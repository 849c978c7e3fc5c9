//! The trait that a new kind of robot implements: x' = f(x, u), with names and units for every component.

use nalgebra::{Isometry3, SVector};

/// Name and unit of one component of a state or control.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Quantity {
    /// The field's name, as in columns: `vx`.
    pub name: &'static str,
    /// SI unit as in column names: `m_s`; empty for pure numbers.
    pub unit: &'static str,
}

/// A fixed-size real vector: all that integrators and planners ask of states and controls.
pub trait Vector: Copy + Send + Sync + 'static {
    /// Number of components.
    const LEN: usize;
    /// The zero vector.
    fn zero() -> Self;
    /// `self + factor·other`.
    fn add_scaled(self, other: &Self, factor: f64) -> Self;
    /// The components, in the order of [`Dynamics::STATE`].
    fn as_slice(&self) -> &[f64];
    /// The components, to be written.
    fn as_mut_slice(&mut self) -> &mut [f64];
}

impl<const N: usize> Vector for SVector<f64, N> {
    const LEN: usize = N;
    fn zero() -> Self {
        Self::zeros()
    }
    fn add_scaled(self, other: &Self, factor: f64) -> Self {
        self + other * factor
    }
    fn as_slice(&self) -> &[f64] {
        self.as_slice()
    }
    fn as_mut_slice(&mut self) -> &mut [f64] {
        self.as_mut_slice()
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
