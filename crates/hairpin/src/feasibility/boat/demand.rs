//! From a motion to the forces that sail it.
//!
//! One formula, three kinds of number: `f64` for a moment, `f64x4` for four, [`Enclosure`] for four intervals of time.
//! So what is proven between samples is the same expression as what is sampled.
//!
//! ```text
//! (u, v) = R(ψ)ᵀ (ṗ − c)       u̇ = (R(ψ)ᵀ p̈)_x + r v       v̇ = (R(ψ)ᵀ p̈)_y − r u
//! τ = M ν̇ + C(ν) ν + D(ν) ν
//! ```

use wide::f64x4;

use crate::math::interval::{Enclosure, Smooth};
use crate::math::power::square;
use crate::robot::boat::Boat;

/// What the formula needs of its numbers beside [`Smooth`].
pub trait Turning: Smooth {
    /// |x|.
    fn abs(self) -> Self;
    /// (sin x, cos x).
    fn sine_and_cosine(self) -> (Self, Self);
}

impl Turning for f64 {
    #[inline(always)]
    fn abs(self) -> Self {
        f64::abs(self)
    }

    #[inline(always)]
    fn sine_and_cosine(self) -> (Self, Self) {
        libm::sincos(self)
    }
}

impl Turning for f64x4 {
    #[inline(always)]
    fn abs(self) -> Self {
        f64x4::abs(self)
    }

    #[inline(always)]
    fn sine_and_cosine(self) -> (Self, Self) {
        let both = self.to_array().map(libm::sincos);
        (f64x4::new(both.map(|(sin, _)| sin)), f64x4::new(both.map(|(_, cos)| cos)))
    }
}

impl Turning for Enclosure {
    /// Where the sign is known a line stays a line; else ||m + δ| − |m|| ≤ |δ|.
    #[inline(always)]
    fn abs(self) -> Self {
        let positive = self.lower().simd_ge(f64x4::ZERO);
        let negative = self.upper().simd_le(f64x4::ZERO);
        let spread = self.slope.abs() + self.rest;
        Self {
            middle: self.middle.abs(),
            slope: positive.select(self.slope, negative.select(-self.slope, f64x4::ZERO)),
            rest: (positive | negative).select(self.rest, spread),
        }
    }

    /// sin(m + δ) = sin m + δ cos m − ½ δ² sin ξ, and |sin ξ| ≤ 1; the cosine likewise.
    #[inline(always)]
    fn sine_and_cosine(self) -> (Self, Self) {
        let (sin, cos) = self.middle.sine_and_cosine();
        let spread = self.slope.abs() + self.rest;
        let curved = spread * spread * 0.5;
        (
            Self { middle: sin, slope: self.slope * cos, rest: self.rest * cos.abs() + curved },
            Self { middle: cos, slope: -(self.slope * sin), rest: self.rest * sin.abs() + curved },
        )
    }
}

/// Velocity and acceleration of place and heading, world frame, SI.
#[derive(Debug, Clone, Copy)]
pub struct BoatMotion<N> {
    /// ẋ, ẏ over ground, m/s.
    pub velocity: [N; 2],
    /// ẍ, ÿ, m/s².
    pub acceleration: [N; 2],
    /// ψ, rad.
    pub heading: N,
    /// r = ψ̇, rad/s.
    pub rate: N,
    /// ψ̈, rad/s².
    pub turning: N,
}

/// What a motion demands.
///
/// Forces in the body frame: ahead, to port, and the moment that turns to port.
#[derive(Debug, Clone, Copy)]
pub struct BoatDemand<N> {
    /// Speed over ground, m/s.
    pub speed: N,
    /// X, Y, N: N, N, N·m.
    pub forces: [N; 3],
}

/// The map of one boat in one current.
///
/// ```
/// use hairpin::feasibility::boat::{BoatMotion, ForceMap};
/// use hairpin::robot::boat::BoatDescription;
///
/// let file = serde_json::json!({
///     "kind": "boat", "name": "toy", "mass_kg": 20.0, "yaw_inertia_kg_m2": 2.0, "length_m": 1.2, "beam_m": 0.3,
///     "hydrodynamics": { "x_u_kg_s": -2.0, "y_v_kg_s": -7.0, "n_r_kg_m2_s": -0.5 },
///     "thrust": { "ahead_n": 2.0, "sway_n": 1.0, "yaw_n_m": 1.0 },
/// });
/// let boat = serde_json::from_value::<BoatDescription>(file)?.build()?;
/// // Lying still with the bow to the north, in a current to the north: held against 0.1 m/s at 2 N s/m.
/// let still = BoatMotion {
///     velocity: [0.0; 2], acceleration: [0.0; 2], heading: std::f64::consts::FRAC_PI_2, rate: 0.0, turning: 0.0,
/// };
/// let [surge, sway, _] = ForceMap::new(&boat, [0.0, 0.1]).demand(&still).forces;
/// assert!((surge + 0.2).abs() < 1e-12 && sway.abs() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct ForceMap {
    boat: Boat,
    current: [f64; 2],
}

impl ForceMap {
    /// The map of `boat` in a `current` (m/s, east and north).
    pub fn new(boat: &Boat, current: [f64; 2]) -> Self {
        Self { boat: boat.clone(), current }
    }

    /// Everything that a motion demands. No branch on N, so that lanes never part.
    #[inline(always)]
    pub fn demand<N: Turning>(&self, motion: &BoatMotion<N>) -> BoatDemand<N> {
        let BoatMotion { velocity: [vx, vy], acceleration: [ax, ay], heading, rate: r, turning } = *motion;
        let (sin, cos) = heading.sine_and_cosine();
        let [flow_x, flow_y] = [vx - N::constant(self.current[0]), vy - N::constant(self.current[1])];
        let (u, v) = (cos * flow_x + sin * flow_y, cos * flow_y - sin * flow_x);
        let (surging, swaying) = (cos * ax + sin * ay + r * v, cos * ay - sin * ax - r * u);

        let m = &self.boat.inertia;
        let (ahead, aside) = (u * m.surge, v * m.sway + r * m.sway_yaw);
        let [x, y, n] = self.damping(u, v, r);
        BoatDemand {
            speed: (vx.square() + vy.square()).sqrt(),
            forces: [
                surging * m.surge - aside * r + x,
                swaying * m.sway + turning * m.sway_yaw + ahead * r + y,
                swaying * m.sway_yaw + turning * m.yaw + aside * u - ahead * v + n,
            ],
        }
    }

    /// D(ν) ν.
    #[inline(always)]
    fn damping<N: Turning>(&self, u: N, v: N, r: N) -> [N; 3] {
        let d = &self.boat.damping;
        let [linear, quadratic, cubic] = d.surge;
        let surge = N::constant(-linear) - u.abs() * quadratic - u.square() * cubic;
        let (drift, turn) = (v.abs(), r.abs());
        let of = |k: &[f64; 3]| N::constant(-k[0]) - drift * k[1] - turn * k[2];
        [u * surge, v * of(&d.sway_by_sway) + r * of(&d.sway_by_yaw), v * of(&d.yaw_by_sway) + r * of(&d.yaw_by_yaw)]
    }

    /// Largest speed that thrust ahead keeps up over ground, with the current behind it, m/s.
    ///
    /// Where damping ahead equals the largest thrust, plus the current's speed.
    pub fn fastest(&self) -> f64 {
        self.boat.top_speed + (square(self.current[0]) + square(self.current[1])).sqrt()
    }

    /// Velocity through the water of a velocity over ground.
    pub fn through_water(&self, velocity: [f64; 2]) -> [f64; 2] {
        [velocity[0] - self.current[0], velocity[1] - self.current[1]]
    }
}
