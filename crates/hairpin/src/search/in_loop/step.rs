//! The step of a (1+1) evolution strategy: it grows by half on success and shrinks so that one success in five keeps
//! it.
//!
//! Source: Rechenberg, Evolutionsstrategie, 1973.

const GROWTH: f64 = 1.5;

/// `step` after an execution that was a success, or not.
///
/// × 1.5, or × 1.5^(−1/4): in balance at p = 1/5.
/// (1.5^p · 1.5^(−(1 − p)/4) = 1.) Bounds are the caller's.
pub(super) fn after(step: f64, success: bool) -> f64 {
    step * if success { GROWTH } else { libm::pow(GROWTH, -0.25) }
}
