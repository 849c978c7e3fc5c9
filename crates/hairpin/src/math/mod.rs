//! Floor 1: numbers without robots or time stamps.

pub mod circular;
pub mod fresnel;
pub mod integrate;
pub mod interval;
pub mod minimum_snap;
pub mod outward;
pub mod polynomial;
pub mod power;
pub mod quadrature;
pub mod random;
pub mod ridge;
pub mod rotation;
pub mod segment;
pub mod simd;
