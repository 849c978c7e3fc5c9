//! The body's velocity over the ground, from what is commanded and how it stands.
//!
//! ```text
//! vx = ± v (1 − s₂₀ sin(climb)/sin 20°) cosδ − drift sinδ      drift = −s′₂₀ sin(side)/sin 20° · v
//! vy = ± v (1 − s₂₀ sin(climb)/sin 20°) sinδ + drift cosδ      ωz = κ · (vx cosδ + vy sinδ)
//! source   ẋ, ẏ, ψ̇ from R with vz = ωx = ωy = 0; ψ̇ = (cosφ/cosθ) ωz
//! exact    vz and ψ̇ from the suspension's gradient: two linear equations
//! ```
//!
//! Rates are per metre of commanded travel, so that a path is integrated over its length and the clock is laid over it
//! afterwards. Slip in proportion to the sine of the slope is a fit for loose soil up to about 20°, not a law.

use super::{Gradient, Kinematics, Rover, Settled, Slip};

/// sin 20°.
const SIN_20: f64 = 0.342_020_143_325_668_7;
/// The least determinant of the exact rates: as it nears 0 the ground turns the body by as much as it is driven, and
/// less is the foot of a wall.
const LEAST: f64 = 0.05;

/// Rates of the planar pose per metre of commanded travel, or per radian of a turn in place, in the heading's frame:
/// ẋ = cosψ · ahead − sinψ · left, ẏ = sinψ · ahead + cosψ · left.
///
/// Pure numbers ahead and left; 1/m for `yaw` (of a turn in place: m/rad, m/rad, rad/rad).
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Rates {
    /// Over the ground along the heading.
    pub ahead: f64,
    /// Over the ground to its left.
    pub left: f64,
    /// dψ/ds, rad/m.
    pub yaw: f64,
}

/// How [`rates`] change.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RateSlopes {
    /// By roll, 1/rad.
    pub roll: Rates,
    /// By pitch, 1/rad.
    pub pitch: Rates,
    /// By the curvature, m.
    pub curvature: Rates,
}

/// What is commanded, in the body: vx and vy per metre of travel, ωz in 1/m; of a turn in place 0, 0, 1.
#[derive(Debug, Clone, Copy)]
struct Commanded([f64; 3]);

/// Sines and cosines of roll and pitch.
struct Lean {
    /// sin φ, cos φ, sin θ, cos θ, in this order.
    sf: f64,
    cf: f64,
    st: f64,
    ct: f64,
}

impl Lean {
    fn of(pose: &Settled) -> Self {
        // A vehicle without a suspension is level at every step.
        let of = |angle: f64| if angle == 0.0 { (angle, 1.0) } else { libm::sincos(angle) };
        let ((sf, cf), (st, ct)) = (of(pose.roll), of(pose.pitch));
        Self { sf, cf, st, ct }
    }

    /// With slip: v (1 − s₂₀ sin(climb)/sin 20°), drift −s′₂₀ sin(side)/sin 20°; the wheels keep the path's curvature,
    /// so slip shortens the turn as well. A force that pulls by the share `pull` of the weight along the body's x and y
    /// axes is a slope by as much less.
    ///
    /// `direction` = (sin δ, cos δ). What is not slipped is `progress`, signed: vx = progress cos δ − drift sin δ, vy =
    /// progress sin δ + drift cos δ, ωz = κ · progress, all per metre of commanded travel.
    fn commanded(&self, direction: (f64, f64), sign: f64, curvature: f64, slip: &Slip, pull: [f64; 2]) -> Commanded {
        // Rise per metre along the body's x and y axes.
        let (rise_x, rise_y) = (-self.st - pull[0], self.ct * self.sf - pull[1]);
        let climb = sign * (direction.1 * rise_x + direction.0 * rise_y);
        let side = direction.1 * rise_y - direction.0 * rise_x;
        let progress = sign * (1.0 - slip.at_20_deg * climb / SIN_20);
        let drift = -slip.side_at_20_deg * side / SIN_20;
        let vx = progress * direction.1 - drift * direction.0;
        let vy = progress * direction.0 + drift * direction.1;
        Commanded([vx, vy, curvature * progress])
    }

    /// ẋ = cosψ cosθ vx + (cosψ sinθ sinφ − sinψ cosφ) vy, ẏ = sinψ cosθ vx + (sinψ sinθ sinφ + cosψ cosφ) vy,
    /// ψ̇ = (cosφ / cosθ) ωz.
    ///
    /// θ of ±π/2 divides by 0; predictions end before it.
    fn source(&self, Commanded([vx, vy, turn]): Commanded) -> Rates {
        let Self { sf, cf, st, ct } = self;
        Rates { ahead: ct * vx + st * sf * vy, left: cf * vy, yaw: cf / ct * turn }
    }

    /// All rates of the body, from two equations for vz and ψ̇: the third row of ṗ = R v is the height's rate, and
    /// ωz = cosφ cosθ ψ̇ − sinφ θ̇,
    ///
    /// ```text
    /// ż = z_a a + z_l l + z_ψ ψ̇ + ż₀     a = cosθ vx + sinθ sinφ vy + sinθ cosφ vz
    /// θ̇ = θ_a a + θ_l l + θ_ψ ψ̇ + θ̇₀     l = cosφ vy − sinφ vz
    /// ```
    ///
    /// with the suspension's gradient along the heading (a), across it (l) and by ψ, and `beyond` = (ż₀, θ̇₀) what it
    /// leaves out.
    ///
    /// Unknowns are vz and ψ̇. With its determinant held at 0.05 or more the rates stay finite at the foot of a wall,
    /// where they mean nothing any more.
    fn exact(&self, gradient: &Gradient, yaw: f64, commanded: Commanded, beyond: [f64; 2]) -> Rates {
        let Self { sf, cf, st, ct } = self;
        let Commanded([vx, vy, turn]) = commanded;
        let (sin, cos) = libm::sincos(yaw);
        let by = |row: [f64; 3]| [cos * row[0] + sin * row[1], cos * row[1] - sin * row[0], row[2]];
        let (height, pitch) = (by(gradient.by_place[0]), by(gradient.pitch()));
        // Without vz, and what vz adds.
        let (ahead, left, up) = (ct * vx + st * sf * vy, cf * vy, ct * sf * vy - st * vx);
        let (lean_ahead, lean_left, lean_up) = (st * cf, -sf, ct * cf);
        let rows = [
            [lean_up - height[0] * lean_ahead - height[1] * lean_left, -height[2]],
            [-sf * (pitch[0] * lean_ahead + pitch[1] * lean_left), cf * ct - sf * pitch[2]],
        ];
        let right = [
            height[0] * ahead + height[1] * left + beyond[0] - up,
            turn + sf * (pitch[0] * ahead + pitch[1] * left + beyond[1]),
        ];
        let determinant = (rows[0][0] * rows[1][1] - rows[0][1] * rows[1][0]).max(LEAST);
        let rise = (right[0] * rows[1][1] - rows[0][1] * right[1]) / determinant;
        let yaw = (rows[0][0] * right[1] - rows[1][0] * right[0]) / determinant;
        Rates { ahead: ahead + lean_ahead * rise, left: left + lean_left * rise, yaw }
    }
}

/// Rates of a body that stands as `pose` and drives with `sign` (±1) along the direction δ (`direction`: sine and
/// cosine) of its body with curvature κ: the source's.
///
/// ẋ = cosψ cosθ vx + (cosψ sinθ sinφ − sinψ cosφ) vy, ẏ = sinψ cosθ vx + (sinψ sinθ sinφ + cosψ cosφ) vy,
/// ψ̇ = (cosφ / cosθ) κ v (Howard & Kelly 2007; vz, ωx, ωy left out, which is exact on planes).
///
/// `curvature` in 1/m, left positive, as the wheels stand; ψ̇ has the sign of the gear.
#[inline]
pub fn rates(pose: &Settled, direction: (f64, f64), sign: f64, curvature: f64, slip: &Slip) -> Rates {
    let lean = Lean::of(pose);
    lean.source(lean.commanded(direction, sign, curvature, slip, [0.0; 2]))
}

/// Share of the commanded way that slip takes along it, s₂₀ sin(climb)/sin 20°, of a body that stands as `pose`, drives
/// with `sign` (±1) along `direction` (sine and cosine) of itself, and is pulled by `pull` (x and y of the body, as a
/// share of its weight); negative where it gains.
pub fn slip_share(pose: &Settled, direction: (f64, f64), sign: f64, slip: &Slip, pull: [f64; 2]) -> f64 {
    let Commanded([vx, vy, _]) = Lean::of(pose).commanded(direction, sign, 0.0, slip, pull);
    1.0 - sign * (vx * direction.1 + vy * direction.0)
}

/// Derivatives of [`rates`] by roll, pitch and curvature; with ρ the rises −sinθ and cosθ sinφ of the body's axes,
///
/// ```text
/// ∂v = −s₂₀/sin 20° (along · ∂ρ) along + s′₂₀/sin 20° (across · ∂ρ) across
/// ```
///
/// For `source` kinematics; what Newton on the ground takes for the model's derivative along the predicted way.
pub fn rate_slopes(pose: &Settled, direction: (f64, f64), sign: f64, curvature: f64, slip: &Slip) -> RateSlopes {
    let lean = Lean::of(pose);
    let Lean { sf, cf, st, ct } = lean;
    let Commanded([vx, vy, turn]) = lean.commanded(direction, sign, curvature, slip, [0.0; 2]);
    let progress = vx * direction.1 + vy * direction.0;
    // Of the commanded twist, where the axes' rises change by `x` and `y`.
    let by_rises = |x: f64, y: f64| {
        let progress = -slip.at_20_deg / SIN_20 * (direction.1 * x + direction.0 * y);
        let drift = -slip.side_at_20_deg / SIN_20 * (direction.1 * y - direction.0 * x);
        let vx = progress * direction.1 - drift * direction.0;
        let vy = progress * direction.0 + drift * direction.1;
        Commanded([vx, vy, curvature * progress])
    };
    let (roll, pitch) = (lean.source(by_rises(0.0, ct * cf)), lean.source(by_rises(-ct, -st * sf)));
    RateSlopes {
        roll: Rates { ahead: roll.ahead + st * cf * vy, left: roll.left - sf * vy, yaw: roll.yaw - sf / ct * turn },
        pitch: Rates {
            ahead: pitch.ahead - st * vx + ct * sf * vy,
            left: pitch.left,
            yaw: pitch.yaw + cf * st / (ct * ct) * turn,
        },
        curvature: Rates { ahead: 0.0, left: 0.0, yaw: cf / ct * progress },
    }
}

impl Rover {
    /// Rates of the vehicle by its own kinematics and slip, where it stands as `pose`, whose gradient `gradient` is,
    /// heading for `yaw`; for the rest see [`rates`].
    #[inline]
    pub fn rates(
        &self,
        (pose, gradient): (&Settled, &Gradient),
        yaw: f64,
        direction: (f64, f64),
        sign: f64,
        curvature: f64,
    ) -> Rates {
        self.rates_under((pose, gradient), yaw, direction, (sign, curvature), [0.0; 2])
    }

    /// [`Self::rates`] while a force pulls along the body's x and y axes by `pull`, as a share of the weight: `way` is
    /// the sign and the curvature. The ground gives way to it as to a slope.
    #[inline]
    pub fn rates_under(
        &self,
        (pose, gradient): (&Settled, &Gradient),
        yaw: f64,
        direction: (f64, f64),
        (sign, curvature): (f64, f64),
        pull: [f64; 2],
    ) -> Rates {
        let lean = Lean::of(pose);
        let commanded = lean.commanded(direction, sign, curvature, &self.slip, pull);
        match self.kinematics {
            Kinematics::Source => lean.source(commanded),
            Kinematics::Exact => lean.exact(gradient, yaw, commanded, [0.0; 2]),
        }
    }

    /// Rates per radian of a turn in place: ψ̇ = cosφ/cosθ, and with exact kinematics what the rising body moves aside.
    ///
    /// Slip does not count in place. m/rad and rad/rad.
    #[inline]
    pub fn turning(&self, (pose, gradient): (&Settled, &Gradient), yaw: f64) -> Rates {
        let (lean, commanded) = (Lean::of(pose), Commanded([0.0, 0.0, 1.0]));
        match self.kinematics {
            Kinematics::Source => lean.source(commanded),
            Kinematics::Exact => lean.exact(gradient, yaw, commanded, [0.0; 2]),
        }
    }

    /// How the pose moves where the body rises by `beyond[0]` (m) and pitches by `beyond[1]` (rad) over what gradients
    /// foresaw, as it does at their kinks; `None` where the kinematics do not ask.
    pub fn moved_beyond(&self, (pose, gradient): (&Settled, &Gradient), yaw: f64, beyond: [f64; 2]) -> Option<Rates> {
        let exact = self.kinematics == Kinematics::Exact;
        exact.then(|| Lean::of(pose).exact(gradient, yaw, Commanded([0.0; 3]), beyond))
    }
}
