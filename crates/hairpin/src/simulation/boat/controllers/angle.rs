//! Angles between headings, which whole turns do not tell apart.

/// The angle in [−π, π] that points the same way.
pub(super) fn wrap(angle: f64) -> f64 {
    libm::remainder(angle, std::f64::consts::TAU)
}
