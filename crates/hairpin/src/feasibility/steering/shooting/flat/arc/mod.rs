//! One arc: curvature as a polynomial of arc length, of third or fifth order.
//!
//! ```text
//! κ(s) = Σ aᵢ sⁱ = θ_t(s/L)/L     θ of `heading`: both ends' headings and curvatures are met by construction
//! unknown (c₀, c₁, c₂, L), two equations for the place; the rest keeps |κ|, |κ′| within bounds and lowers a cost
//! ```
//!
//! `newton` is one step, `descent` follows them to a goal, `limits` are the bounds, `refine` lowers ∫κ² or ∫κ′²
//! afterwards.

mod descent;
mod heading;
mod limits;
mod newton;
mod refine;

pub(super) use descent::descend;
pub(super) use heading::Free;
pub(super) use limits::bends;
pub(super) use refine::refine;
