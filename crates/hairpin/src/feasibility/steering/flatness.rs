//! From a path to the rotor speeds that fly it: the quadrotor's differential flatness, drag included.
//!
//! The claim's model is the rigid body of `robot::quadrotor` with drag c₁v + c₂|v|v and aerodynamic moment
//! c_ω|ω|ω; no rotor lag, no wind. Thrust demand: Mellinger, Kumar, "Minimum snap trajectory generation and control
//! for quadrotors" (ICRA 2011); with drag: Faessler, Franchi, Scaramuzza (RA-L 2018), here isotropic, so that the
//! attitude follows from the force alone.
//!
//! One formula, three kinds of number: `f64` for a moment, `f64x4` for four, [`crate::math::interval::Enclosure`] for
//! four intervals of time. So what is proven between samples is the same expression as what is sampled.
//!
//! ```text
//! F = m (v̇ + g e₃) + c₁ v + c₂ |v| v      tan θ = Fx/Fz      sin φ = −Fy/|F|      ψ = 0
//! (p, q, r) = (φ̇, θ̇ cos φ, −θ̇ sin φ)      τ = I ω̇ + ω × Iω + c_ω |ω| ω      w² = M⁻¹ (|F|, τ)
//! ```
//!
//! Neglected: rotor lag, gyroscopic torque of the rotors, ground effect, wind, blade flapping. The inertia is diagonal
//! in the body frame, drag acts at the centre of mass and does not depend on the attitude.

use nalgebra::{Matrix4, UnitQuaternion, Vector3};
use thiserror::Error;

use crate::math::interval::{Smooth, unrolled};
use crate::math::rotation::{quaternion_from_euler, unit_quaternion};
use crate::robot::quadrotor::Quadrotor;
use crate::trajectory::ProfileLeg;

/// Least vertical thrust, as a share of the weight. At 0 the body is in free fall or its x axis is vertical; there
/// attitude or yaw are undefined and rates grow without bound.
pub const LEAST_VERTICAL_THRUST: f64 = 0.02;

/// Velocity, acceleration, jerk and snap of a path, SI, world frame.
///
/// Order four is needed: rotor speeds depend on snap through ω̇.
///
/// A state that is flown needs all four to be of one path: nothing here checks that acceleration is the derivative of
/// velocity. Position is no part of it, for forces do not depend on place.
#[derive(Debug, Clone, Copy)]
pub struct FlatState<N> {
    /// m/s.
    pub velocity: [N; 3],
    /// m/s².
    pub acceleration: [N; 3],
    /// m/s³.
    pub jerk: [N; 3],
    /// m/s⁴.
    pub snap: [N; 3],
}

/// What a flat state demands of the body.
///
/// Thrust is that of all rotors together. Negative squares of rotor speeds are demands that cannot be met; they stay
/// visible.
#[derive(Debug, Clone, Copy)]
pub struct Demand<N> {
    /// Speed, m/s.
    pub speed: N,
    /// Thrust vector m(v̇ + g e₃) + D(v), N, world frame.
    pub force: [N; 3],
    /// Its length, N.
    pub thrust: N,
    /// Body rates p, q, r, rad/s.
    pub rates: [N; 3],
    /// Squares of the rotor speeds, rad²/s².
    pub rotors: [N; 4],
}

/// Attitude, rates and rotor speeds at one instant of a leg.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BodyState {
    /// `world_from_body`, yaw 0.
    pub attitude: UnitQuaternion<f64>,
    /// Body rates, rad/s.
    pub rates: Vector3<f64>,
    /// Rotor speeds, rad/s; 0 where the demand is negative.
    pub rotors: [f64; 4],
}

/// Four rotors whose thrusts and moments do not span (total thrust, three moments) cannot fly any given path.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[error("the rotors' positions and spins leave a moment that no combination of speeds produces")]
pub struct DependentRotors;

/// The flatness map of one robot.
///
/// Yaw 0 throughout: the body's x axis stays in the plane of world x and z.
///
/// ```
/// use hairpin::feasibility::steering::Flatness;
/// use hairpin::robot::quadrotor::QuadrotorDescription;
/// use hairpin::trajectory::ProfileLeg;
///
/// let file = serde_json::json!({
///     "kind": "quadrotor", "name": "toy", "mass_kg": 0.5, "thrust_to_weight": 2.0,
///     "rotors": [{ "x_m": 0.1, "y_m": 0.1, "spin": 1.0 }, { "x_m": -0.1, "y_m": 0.1, "spin": -1.0 },
///                { "x_m": -0.1, "y_m": -0.1, "spin": 1.0 }, { "x_m": 0.1, "y_m": -0.1, "spin": -1.0 }],
/// });
/// let robot = serde_json::from_value::<QuadrotorDescription>(file)?.build()?;
/// // Standing still asks for hover; accelerating ahead at g asks for a nose 45° down.
/// let mut leg = ProfileLeg { duration: 1.0, coefficients: [[0.0; 8]; 3] };
/// let flat = Flatness::new(&robot)?;
/// assert!((flat.body_state(&leg, 0.0).rotors[0] - robot.hover_speed()).abs() < 1e-9);
/// leg.coefficients[0][2] = 0.5 * robot.gravity;
/// let wind_free = Flatness::new(&hairpin::robot::quadrotor::Quadrotor { drag_quadratic: 0.0, ..robot })?;
/// let (_, pitch, _) = wind_free.body_state(&leg, 0.5).attitude.euler_angles();
/// assert!((pitch - std::f64::consts::FRAC_PI_4).abs() < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct Flatness {
    /// kg.
    mass: f64,
    /// m/s², > 0, along −z of the world.
    gravity: f64,
    /// About x, y, z of the body, kg·m².
    inertia: [f64; 3],
    /// c₁, N·s/m.
    drag_linear: f64,
    /// c₂, N·s²/m²; 0 takes a shorter way in [`Self::drag`], which has no direction of a velocity that vanishes.
    drag_quadratic: f64,
    /// c_ω, N·m·s²: opposes body rates, squared.
    aerodynamic_moment: f64,
    /// Rotor speeds squared from (thrust, moments).
    unmix: [[f64; 4]; 4],
}

impl Flatness {
    /// The map for `robot`.
    ///
    /// With f the thrusts of the four rotors (N), at (xᵢ, yᵢ) and of spin ±1,
    ///
    /// ```text
    /// (|F|, τx, τy, τz) = M f     row i of Mᵀ = (1, yᵢ, −xᵢ, spinᵢ k_m/k_f)     w² = M⁻¹ (|F|, τ) / k_f
    /// ```
    ///
    /// Rotors in a line or of one spin make M singular.
    ///
    /// # Errors
    /// [`DependentRotors`].
    pub fn new(robot: &Quadrotor) -> Result<Self, DependentRotors> {
        let (kf, km) = (robot.thrust_coefficient, robot.moment_coefficient);
        // Columns in units of one rotor's thrust, so that the inverse is well scaled.
        let mix = Matrix4::from_fn(|row, i| {
            let rotor = &robot.rotors[i];
            [1.0, rotor.y, -rotor.x, rotor.spin * km / kf][row]
        });
        let inverse = mix.try_inverse().filter(|m| m.iter().all(|e| e.is_finite())).ok_or(DependentRotors)?;
        Ok(Self {
            mass: robot.mass,
            gravity: robot.gravity,
            inertia: [robot.inertia.x, robot.inertia.y, robot.inertia.z],
            drag_linear: robot.drag_linear,
            drag_quadratic: robot.drag_quadratic,
            aerodynamic_moment: robot.aerodynamic_moment,
            unmix: std::array::from_fn(|i| std::array::from_fn(|j| inverse[(i, j)] / kf)),
        })
    }

    /// The robot's weight, N.
    #[inline(always)]
    pub fn weight(&self) -> f64 {
        self.mass * self.gravity
    }

    /// Drag and its first and second time derivative, N, N/s, N/s², given the speed.
    ///
    /// With n = v/|v|: |v|˙ = n·a, and (|v|˙˙) v = (a·a − (n·a)² + v·j) n, which stays bounded as v → 0 though n does
    /// not settle: |v|v is once differentiable at v = 0 and the second derivative jumps there. An enclosure takes n in
    /// [−1, 1]³ then, which holds both sides of the jump; a point takes the mean, which at a rest end (a = j = 0) is
    /// exact.
    ///
    /// Rows: D, Ḋ, D̈, each in the world frame. D = c₁v + c₂|v|v, Ḋ = c₁a + c₂(|v| a + |v|˙ v), D̈ = c₁j + c₂(|v| j +
    /// 2|v|˙ a + |v|¨ v). `speed` must be |v|, in the same kind of number: it is not computed again.
    #[inline(always)]
    fn drag<N: Smooth>(&self, v: &[N; 3], a: &[N; 3], j: &[N; 3], speed: N) -> [[N; 3]; 3] {
        let linear = self.drag_linear;
        if self.drag_quadratic == 0.0 {
            return [unrolled!(|i| v[i] * linear), unrolled!(|i| a[i] * linear), unrolled!(|i| j[i] * linear)];
        }
        let n = unrolled!(|i| v[i].direction(speed));
        let speed_rate = dot(&n, a);
        let bend = dot(a, a) - speed_rate.square() + dot(v, j);
        let c = self.drag_quadratic;
        [
            unrolled!(|i| v[i] * linear + v[i] * speed * c),
            unrolled!(|i| a[i] * linear + (a[i] * speed + v[i] * speed_rate) * c),
            unrolled!(|i| j[i] * linear + (j[i] * speed + a[i] * speed_rate * 2.0 + n[i] * bend) * c),
        ]
    }

    /// Acceleration and jerk (m/s², m/s³) with which the robot is level and without rates at velocity `v`:
    /// a = −D(v)/m, j = −(∂D/∂v) a/m; and the second time derivative of the drag there, N/s².
    ///
    /// With these a leg begins and ends level and without rates whatever its velocity: F = m g e₃, Ḟ = 0. Without drag
    /// all three are 0.
    ///
    /// World frame.
    ///
    /// From F = m(a + g e₃) + D = m g e₃, and its first derivative. The second derivative is not made 0: that would
    /// take the snap, which the leg's other end decides.
    pub fn level(&self, velocity: &Vector3<f64>) -> [Vector3<f64>; 3] {
        let v = [velocity.x, velocity.y, velocity.z];
        let (zero, speed) = ([0.0; 3], velocity.norm());
        let [drag, ..] = self.drag(&v, &zero, &zero, speed);
        let a = drag.map(|d| -d / self.mass);
        let [_, rate, _] = self.drag(&v, &a, &zero, speed);
        let j = rate.map(|d| -d / self.mass);
        let [_, _, second] = self.drag(&v, &a, &j, speed);
        [Vector3::from(a), Vector3::from(j), Vector3::from(second)]
    }

    /// Squares of the rotor speeds for a thrust (N) and moments (N·m).
    ///
    /// Signed: below 0 where the rotor would have to pull downwards, which no speed does.
    #[inline(always)]
    fn rotors<N: Smooth>(&self, thrust: N, moments: &[N; 3]) -> [N; 4] {
        unrolled!([0, 1, 2, 3], |i| {
            let [t, x, y, z] = self.unmix[i];
            thrust * t + moments[0] * x + moments[1] * y + moments[2] * z
        })
    }

    /// Squares of the rotor speeds at a level end without rates, given F̈ (N/s², x and y) there: ω̇ = (−F̈y, F̈x, 0)/(m
    /// g).
    ///
    /// At such an end θ̈ = F̈x/(m g) and φ̈ = −F̈y/(m g); ω = 0 takes gyroscopic and aerodynamic moments away, and
    /// F̈z does not turn the body. Exact, without the quotients of [`Self::demand`].
    #[inline(always)]
    pub(super) fn level_rotors<N: Smooth>(&self, second: &[N; 2]) -> [N; 4] {
        let inverse = 1.0 / self.weight();
        let roll = -second[1] * inverse * self.inertia[0];
        let pitch = second[0] * inverse * self.inertia[1];
        self.rotors(N::constant(self.weight()), &[roll, pitch, N::constant(0.0)])
    }

    /// The thrust vector m(v̇ + g e₃) + D(v), N.
    #[inline(always)]
    pub(super) fn force<N: Smooth>(&self, v: &[N; 3], a: &[N; 3], speed: N) -> [N; 3] {
        let drag = speed * self.drag_quadratic + N::constant(self.drag_linear);
        let mut force = unrolled!(|i| a[i] * self.mass + v[i] * drag);
        force[2] = force[2] + N::constant(self.weight());
        force
    }

    /// The speed of a velocity.
    #[inline(always)]
    pub(super) fn speed<N: Smooth>(v: &[N; 3]) -> N {
        (v[0].square() + v[1].square() + v[2].square()).sqrt()
    }

    /// Everything that a flat state demands.
    ///
    /// With yaw 0, R = Ry(θ) Rx(φ) and body z along F: tan θ = Fx/Fz, sin φ = −Fy/|F|; rates (φ̇, θ̇ cos φ, −θ̇ sin φ);
    /// moments I ω̇ + ω × I ω + c_ω|ω|ω; rotor speeds by the inverse of the mixing matrix. All derivatives are
    /// analytic. Meaningless unless Fz > 0, which the caller checks.
    ///
    /// No branch on N, so that lanes never part. Rates in rad/s and moments in N·m in the body frame.
    ///
    /// With s² = Fx² + Fz²:
    ///
    /// ```text
    /// θ̇ = (Ḟx Fz − Fx Ḟz)/s²                  θ̈ = ((F̈x Fz − Fx F̈z) − 2 θ̇ s ṡ)/s²
    /// φ̇ = −(Ḟy s² − Fy s ṡ)/(s |F|²)          φ̈ by the logarithmic derivative of s |F|²
    /// ṗ = φ̈    q̇ = θ̈ cos φ − φ̇ θ̇ sin φ    ṙ = −θ̈ sin φ − φ̇ θ̇ cos φ
    /// ```
    ///
    /// Quotients go by reciprocals of s² and |F|², the only two that an enclosure must prove positive. Where it cannot,
    /// `rest` of what is answered is infinite or NaN, and nothing that compares with a limit takes that for a proof.
    #[inline(always)]
    pub fn demand<N: Smooth>(&self, flat: &FlatState<N>) -> Demand<N> {
        let speed = Self::speed(&flat.velocity);
        let [d0, d1, d2] = self.drag(&flat.velocity, &flat.acceleration, &flat.jerk, speed);
        let m = self.mass;
        let [fx, fy, fz] =
            unrolled!(|i| flat.acceleration[i] * m + d0[i] + N::constant(if i == 2 { self.weight() } else { 0.0 }));
        let [dx, dy, dz] = unrolled!(|i| flat.jerk[i] * m + d1[i]);
        let [ddx, ddy, ddz] = unrolled!(|i| flat.snap[i] * m + d2[i]);

        // s² = Fx² + Fz², the squared length in the body's plane of symmetry.
        let s2 = fx.square() + fz.square();
        let f2 = s2 + fy.square();
        let (s, thrust) = (s2.sqrt(), f2.sqrt());
        let (inverse_s2, inverse_f2) = (s2.recip(), f2.recip());
        let inverse_thrust = thrust * inverse_f2;
        let (cos_roll, sin_roll) = (s * inverse_thrust, -(fy * inverse_thrust));

        // θ̇ = (Ḟx Fz − Fx Ḟz)/s², and s ṡ = Fx Ḟx + Fz Ḟz.
        let s_rate = fx * dx + fz * dz;
        let s_second = dx.square() + dz.square() + fx * ddx + fz * ddz;
        let pitch_rate = (dx * fz - fx * dz) * inverse_s2;
        let pitch_second = (ddx * fz - fx * ddz - pitch_rate * s_rate * 2.0) * inverse_s2;

        // φ̇ = −(Ḟy s² − Fy s ṡ)/(s |F|²).
        let inverse_sf2 = s * inverse_s2 * inverse_f2;
        let roll_rate = -((dy * s2 - fy * s_rate) * inverse_sf2);
        let logarithmic = s_rate * inverse_s2 + (s_rate + fy * dy) * inverse_f2 * 2.0;
        let roll_second = -((ddy * s2 + dy * s_rate - fy * s_second) * inverse_sf2) - roll_rate * logarithmic;

        let (p, q, r) = (roll_rate, pitch_rate * cos_roll, -(pitch_rate * sin_roll));
        let product = roll_rate * pitch_rate;
        let q_rate = pitch_second * cos_roll - product * sin_roll;
        let r_rate = -(pitch_second * sin_roll) - product * cos_roll;
        let [ix, iy, iz] = self.inertia;
        let mut moments =
            [roll_second * ix + q * r * (iz - iy), q_rate * iy + p * r * (ix - iz), r_rate * iz + p * q * (iy - ix)];
        if self.aerodynamic_moment != 0.0 {
            let opposing = (roll_rate.square() + pitch_rate.square()).sqrt() * self.aerodynamic_moment;
            moments = [moments[0] + p * opposing, moments[1] + q * opposing, moments[2] + r * opposing];
        }
        Demand { speed, force: [fx, fy, fz], thrust, rates: [p, q, r], rotors: self.rotors(thrust, &moments) }
    }

    /// Attitude, rates and rotor speeds `tau` seconds into a leg.
    ///
    /// Rotor speeds are not held to any limit.
    ///
    /// NaN where the force vanishes. For pictures, logs and references of controllers; limits are held by the judge.
    pub fn body_state(&self, leg: &ProfileLeg, tau: f64) -> BodyState {
        let demand = self.demand(&flat_state(leg, tau));
        let [fx, fy, fz] = demand.force;
        let pitch = libm::atan2(fx, fz);
        let roll = libm::atan2(-fy, libm::hypot(fx, fz));
        BodyState {
            attitude: unit_quaternion(&quaternion_from_euler(roll, pitch, 0.0)),
            rates: Vector3::from(demand.rates),
            rotors: demand.rotors.map(|w2| w2.max(0.0).sqrt()),
        }
    }
}

/// The flat state `tau` seconds into a leg.
///
/// `tau` in s since the leg's start.
pub fn flat_state(leg: &ProfileLeg, tau: f64) -> FlatState<f64> {
    let d = |order| <[f64; 3]>::from(leg.derivative(tau, order));
    FlatState { velocity: d(1), acceleration: d(2), jerk: d(3), snap: d(4) }
}

/// Σ aᵢ bᵢ, in this order of summation on every kind of number.
#[inline(always)]
fn dot<N: Smooth>(a: &[N; 3], b: &[N; 3]) -> N {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
