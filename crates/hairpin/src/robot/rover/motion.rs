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

/// Rates of the planar pose per metre of commanded travel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rates {
    /// dx/ds.
    pub x: f64,
    /// dy/ds.
    pub y: f64,
    /// dψ/ds, rad/m.
    pub yaw: f64,
}

/// Rates at yaw ψ (sine and cosine `yaw`) for a body that stands as `pose` and drives with `sign` (±1) along the
/// direction δ (`direction`: sine and cosine) of its body with curvature κ.
///
/// ẋ = cosψ cosθ vx + (cosψ sinθ sinφ − sinψ cosφ) vy, ẏ = sinψ cosθ vx + (sinψ sinθ sinφ + cosψ cosφ) vy,
/// ψ̇ = (cosφ / cosθ) κ v (Howard & Kelly 2007; vz, ωx, ωy left out, which is exact on planes).
/// Slip: vx (1 − s₂₀ sin(climb)/sin 20°), drift −s′₂₀ sin(φ)/sin 20°; the wheels keep the path's curvature, so slip shortens the turn as
/// well.
#[inline]
pub fn rates(pose: &Settled, yaw: (f64, f64), direction: (f64, f64), sign: f64, curvature: f64, slip: &Slip) -> Rates {
    let ((sf, cf), (st, ct)) = (libm::sincos(pose.roll), libm::sincos(pose.pitch));
    let (sp, cp) = yaw;
    // Climb along the direction of travel: −z of the travelled axis, nose up positive.
    let climb = sign * (-st * direction.1 + ct * sf * direction.0);
    let progress = sign * (1.0 - slip.at_20_deg * climb / SIN_20);
    let drift = -slip.side_at_20_deg * sf / SIN_20;
    let (vx, vy) = (progress * direction.1, progress * direction.0 + drift);
    Rates {
        x: cp * ct * vx + (cp * st * sf - sp * cf) * vy,
        y: sp * ct * vx + (sp * st * sf + cp * cf) * vy,
        yaw: cf / ct * curvature * progress,
    }
}
