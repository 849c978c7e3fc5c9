//! The six joints of an arm: their angles, and what each may do.

/// Joints of every arm here.
pub const AXES: usize = 6;

/// Joint angles, rad, from the base on.
///
/// q₁ … q₆. Angles may be on any turn within the limits: q and q + 2π are different postures of an arm.
pub type Joints = [f64; AXES];

/// What one joint may do.
///
/// The bounds are the joint's own; a parallel rod's are not modelled
/// ([`Coupling`](super::Coupling) is of what controllers tell).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JointLimit {
    /// Least angle, rad.
    pub lower: f64,
    /// Largest angle, rad.
    pub upper: f64,
    /// Largest |q̇|, rad/s.
    pub speed: f64,
    /// Largest |q̈|, rad/s².
    pub acceleration: f64,
}

impl JointLimit {
    /// How far `angle` lies inside the bounds, rad; negative outside.
    pub fn margin(&self, angle: f64) -> f64 {
        (angle - self.lower).min(self.upper - angle)
    }
}
