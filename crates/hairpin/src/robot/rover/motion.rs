//! The body's velocity over the ground, from what is commanded and how it stands.

use super::Settled;

/// How much the ground gives way, in proportion to the sine of the slope.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Slip {
    /// Share of the speed that is lost climbing 20°; gained going down.
    pub at_20_deg: f64,
    /// Drift downhill across a slope of 20°, as a share of the speed.
    pub side_at_20_deg: f64,
}

/// sin 20°.
const SIN_20: f64 = 0.342_020_143_325_668_7;

/// Rates of the planar pose per metre of commanded travel, in the heading's frame:
/// ẋ = cosψ · ahead − sinψ · left, ẏ = sinψ · ahead + cosψ · left.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rates {
    /// Over the ground along the heading.
    pub ahead: f64,
    /// Over the ground to its left.
    pub left: f64,
    /// dψ/ds, rad/m.
    pub yaw: f64,
}

/// Rates of a body that stands as `pose` and drives with `sign` (±1) along the direction δ (`direction`: sine and
/// cosine) of its body with curvature κ.
///
/// ẋ = cosψ cosθ vx + (cosψ sinθ sinφ − sinψ cosφ) vy, ẏ = sinψ cosθ vx + (sinψ sinθ sinφ + cosψ cosφ) vy,
/// ψ̇ = (cosφ / cosθ) κ v (Howard & Kelly 2007; vz, ωx, ωy left out, which is exact on planes).
/// Slip: v (1 − s₂₀ sin(climb)/sin 20°), drift −s′₂₀ sin(side)/sin 20°; the wheels keep the path's curvature, so slip
/// shortens the turn as well.
#[inline]
pub fn rates(pose: &Settled, direction: (f64, f64), sign: f64, curvature: f64, slip: &Slip) -> Rates {
    let ((sf, cf), (st, ct)) = (libm::sincos(pose.roll), libm::sincos(pose.pitch));
    // Rise per metre along the body's x and y axes.
    let (rise_x, rise_y) = (-st, ct * sf);
    let climb = sign * (direction.1 * rise_x + direction.0 * rise_y);
    let side = direction.1 * rise_y - direction.0 * rise_x;
    let progress = sign * (1.0 - slip.at_20_deg * climb / SIN_20);
    let drift = -slip.side_at_20_deg * side / SIN_20;
    let vx = progress * direction.1 - drift * direction.0;
    let vy = progress * direction.0 + drift * direction.1;
    Rates { ahead: ct * vx + st * sf * vy, left: cf * vy, yaw: cf / ct * curvature * progress }
}
