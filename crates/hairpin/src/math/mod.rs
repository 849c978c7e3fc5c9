//! Floor 1: numbers without robots or time stamps.
//!
//! Nothing here has a frame or a unit of its own; callers bring both. What the rooms above build on:
//!
//! | file | solves | used for |
//! | --- | --- | --- |
//! | [`rotation`] | q̇ = ½ q ⊗ (0, ω); R = Rz(ψ) Ry(θ) Rx(φ) | attitude of every body |
//! | [`integrate`] | ẋ = f(x), one classical Runge-Kutta step | plants, sampled reach sets |
//! | [`quadrature`] | ∫₀¹ f(t) dt, Gauss-Legendre | end points of paths |
//! | [`fresnel`] | ∫ exp(iπt²/2) dt, and where a clothoid ends | closed-form drives |
//! | [`polynomial`] | degree 7 from both ends; Bernstein bounds | legs of a flight |
//! | [`minimum_snap`](mod@minimum_snap) | min ∫‖p⁗‖² dt through given points | references, start values |
//! | [`jerk_limit`] | from velocity to velocity within acceleration and jerk | set points |
//! | [`linear`] | A x = b on the stack, Gauss's elimination | rests on the ground, solvers' steps |
//! | [`interval`] | degree-1 Taylor models in four lanes | limits between samples |
//! | [`outward`] | intervals with directed rounding, centred forms | proofs of clearance |
//! | [`segment`] | nearest points of segments | solids, deviation |
//! | [`cubic`] | nearest points of Hermite's cubics | deviation from curved paths |
//! | [`convex`] | min ‖a − b‖ over two convex sets, bounded on both sides | links of arms |
//! | [`enclosing`] | few points and a radius around many | links of arms |
//! | [`circular`], [`power`] | sin, cos, xⁿ with the same bits everywhere | hot loops |
//! | [`ridge`] | polynomial ridge regression, cross-validated | learned scores |
//! | [`output_error`] | min −2 log L of a simulation's outputs, and how far it can rise | fits to logs |
//! | [`imitation`] | min (s − μ)ᵀ Σ⁻¹ (s − μ) of signs of a simulation by chance | fits to logs of loops that swing |
//! | [`decimals`] | the fewest that two numbers differ by | sentences |
//! | [`random`] | named streams | everything that draws |
//! | [`simd`] | which compiled version of a kernel runs | kernels |
//!
//! Two kinds of bounds, and they are not interchangeable: [`interval`] is fast and rounds to nearest, so that its
//! reader leaves room for rounding; [`outward`] rounds outward, so that what it decides is proven. Transcendental
//! functions come from `libm` or are made of + − · ÷ √ alone, because the standard library's may differ in the last bit
//! from machine to machine.

pub(crate) mod arc_tangent;
pub mod circular;
pub mod convex;
pub mod cubic;
pub mod decimals;
pub mod enclosing;
pub mod fresnel;
pub mod imitation;
pub mod integrate;
pub mod interval;
pub mod jerk_limit;
pub mod linear;
pub mod minimum_snap;
pub mod output_error;
pub mod outward;
pub mod polynomial;
pub mod power;
pub mod quadrature;
pub mod random;
pub mod ridge;
pub mod rotation;
pub mod segment;
pub mod simd;
