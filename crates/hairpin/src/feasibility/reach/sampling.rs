//! End points of constant rotor-speed runs from level rest: many runs at once, in the lanes of the vector unit.
//!
//! Position does not act back on attitude, so only attitude and rates are integrated; the end point is a quadrature
//! of the thrust direction: x(T) = ∫ φ(T−t) (u1/m) e₃(t) dt − g ∫ φ(T−t) dt, φ(s) = (1 − e^{−ks})/k for linear drag
//! k = c₁/m (φ(s) = s without). Rates go by the classical Runge-Kutta method; attitude by the fourth-order Magnus
//! expansion, whose exponential is exact for a fixed axis however fast the turn. From rest under constant torque
//! rates grow like t, so the nodes of a common grid lie at equal steps of phase rather than of time.
//!
//! No product is fused with a sum and no lane depends on another: every SIMD level gives the same bits.

use nalgebra::{Vector3, Vector4};

use crate::math::power::square;
use crate::math::simd::{Simd, kernel};
use crate::robot::quadrotor::Quadrotor;

const LANES: usize = 16;

/// Steps per radian of αT² (twice the phase that the largest angular acceleration α turns through), measured: at this
/// density every shipped robot ends within 5 mm of where a tenth of the step puts it, which a test holds it to;
/// `hairpin bench reach-error` tells how much nearer.
const STEPS_PER_RADIAN: f64 = 0.35;

/// Where the even spacing in phase begins, as a share of the time: t = T (√(a² + s(1+2a)) − a), s ∈ [0, 1].
const GRID_START: f64 = 0.3;

/// The res⁴ rotor-speed combinations, each rotor at `resolution` evenly spaced speeds between its limits, rad/s.
///
/// Rotor 1 varies slowest. With a resolution of 1 only the least speeds.
pub fn constant_speeds(robot: &Quadrotor, resolution: usize) -> Vec<Vector4<f64>> {
    let (low, high) = robot.rotor_speed;
    let gaps = resolution.saturating_sub(1).max(1) as f64;
    let level = |i: usize| low + (high - low) * (i % resolution) as f64 / gaps;
    let (n, n2, n3) = (resolution, resolution * resolution, resolution * resolution * resolution);
    (0..n3 * n).map(|i| Vector4::new(level(i / n3), level(i / n2), level(i / n), level(i))).collect()
}

/// φ(s): how far a unit of velocity carries in `time` s against the linear drag, s.
pub fn carry(robot: &Quadrotor, time: f64) -> f64 {
    let k = robot.drag_linear / robot.mass;
    // Below, the series' first three terms are exact to the last digit.
    if k * time < 1e-5 {
        return time * (1.0 - k * time / 2.0 + square(k * time) / 6.0);
    }
    -libm::expm1(-k * time) / k
}

/// Even number of steps for runs of `time` s at full accuracy.
///
/// 2 ⌈0.175 α T²⌉, at least 32, α the largest angular acceleration over all combinations of the rotors' extremes. Tests
/// hold the ends of every shipped robot to 5 mm of a tenth of the step.
pub fn steps(robot: &Quadrotor, time: f64) -> usize {
    let max = robot.rotor_speed.1;
    let fastest = (0..16u32)
        .map(|on| {
            let u = robot.wrench(&Vector4::from_fn(|i, _| if on >> i & 1 == 1 { max } else { robot.rotor_speed.0 }));
            Vector3::new(u[1], u[2], u[3]).component_div(&robot.inertia).norm()
        })
        .fold(0.0, f64::max);
    let half = 0.5 * STEPS_PER_RADIAN * fastest * time * time;
    2 * (half.ceil().clamp(16.0, 1e6) as usize)
}

/// End points R(u) relative to the start, m, of runs of `time` s from level rest under each of `speeds`, with linear
/// drag, without quadratic drag and aerodynamic moment, in `steps` (even) steps.
///
/// World frame, z up, level with yaw 0 at the start; in the order of `speeds`. O(runs · steps) in 16 lanes, without an
/// allocation a run.
pub fn end_points(
    simd: Simd,
    robot: &Quadrotor,
    speeds: &[Vector4<f64>],
    time: f64,
    steps: usize,
) -> Vec<Vector3<f64>> {
    let grid = Grid::new(robot, time, steps);
    let inertia = robot.inertia;
    // Rates are carried in half units (q' = q ⊗ W with W = ω/2), so the gyroscopic terms count twice.
    let gyration = [
        2.0 * (inertia.y - inertia.z) / inertia.x,
        2.0 * (inertia.z - inertia.x) / inertia.y,
        2.0 * (inertia.x - inertia.y) / inertia.z,
    ];
    let mixing = robot.mixing();
    let fall = robot.gravity * grid.weight_sum;
    let mut ends = Vec::with_capacity(speeds.len());
    for chunk in speeds.chunks(LANES) {
        let mut block = Block::level_rest();
        let wrenches: Vec<Vector4<f64>> = chunk.iter().map(|w| mixing * w.component_mul(w)).collect();
        for (lane, u) in wrenches.iter().enumerate() {
            for axis in 0..3 {
                block.acceleration[axis][lane] = 0.5 * u[axis + 1] / inertia[axis];
            }
        }
        integrate(simd, &mut block, &grid.steps, &grid.weights, gyration);
        ends.extend(wrenches.iter().enumerate().map(|(lane, u)| {
            let pull = u[0] / robot.mass;
            let [x, y, tilt] = block.direction.map(|component| 2.0 * component[lane]);
            Vector3::new(pull * x, pull * y, pull * (grid.weight_sum - tilt) - fall)
        }));
    }
    ends
}

/// Step lengths, and the weight of the thrust direction at the beginning of each (at the end it is φ(0) = 0).
struct Grid {
    steps: Vec<f64>,
    weights: Vec<f64>,
    weight_sum: f64,
}

impl Grid {
    /// Simpson's rule in the phase p, with t = T(√(a² + p(1 + 2a)) − a), p ∈ [0, 1]: its weights carry dt/dp = T(½ +
    /// a)/√(a² + p(1 + 2a)) and φ(T − t). The last node has φ(0) = 0 and is left out.
    fn new(robot: &Quadrotor, time: f64, steps: usize) -> Self {
        let (a, n) = (GRID_START, steps as f64);
        let root = |k: usize| (a * a + k as f64 / n * (1.0 + 2.0 * a)).sqrt();
        let node = |k: usize| time * (root(k) - a);
        let weight = |k: usize| {
            let simpson = match k {
                0 => 1.0,
                k if k % 2 == 1 => 4.0,
                _ => 2.0,
            };
            simpson / (3.0 * n) * (time * (0.5 + a) / root(k)) * carry(robot, time - node(k))
        };
        let weights: Vec<f64> = (0..steps).map(weight).collect();
        let weight_sum = weights.iter().sum();
        Self { steps: (0..steps).map(|k| node(k + 1) - node(k)).collect(), weights, weight_sum }
    }
}

/// The runs in flight: one component a row, one run a lane.
#[repr(align(64))]
struct Block {
    attitude: [[f64; LANES]; 4],
    half_rates: [[f64; LANES]; 3],
    acceleration: [[f64; LANES]; 3],
    /// Weighted sums of xz + wy, yz − wx and x² + y², half of the direction's components (the last from 1).
    direction: [[f64; LANES]; 3],
}

impl Block {
    fn level_rest() -> Self {
        let zeros = [[0.0; LANES]; 3];
        let attitude = [[1.0; LANES], [0.0; LANES], [0.0; LANES], [0.0; LANES]];
        Self { attitude, half_rates: zeros, acceleration: zeros, direction: zeros }
    }
}

/// Euler's equations in half rates: Ẇ = τ/2I + gyration · (products of the other two).
#[inline(always)]
fn turning(rates: [f64; 3], acceleration: [f64; 3], gyration: [f64; 3]) -> [f64; 3] {
    let [p, q, r] = rates;
    [
        acceleration[0] + gyration[0] * (q * r),
        acceleration[1] + gyration[1] * (p * r),
        acceleration[2] + gyration[2] * (p * q),
    ]
}

#[inline(always)]
fn along(from: [f64; 3], rate: [f64; 3], h: f64) -> [f64; 3] {
    [from[0] + h * rate[0], from[1] + h * rate[1], from[2] + h * rate[2]]
}

/// One step: the half-rate vector at its end, and the Magnus exponent
/// Ω = h/2 (W₀ + W₁) + h²/12 (Ẇ₀ − Ẇ₁) + h²/6 W₀ × W₁.
#[inline(always)]
fn turn(start: [f64; 3], acceleration: [f64; 3], gyration: [f64; 3], h: f64) -> ([f64; 3], [f64; 3]) {
    let k1 = turning(start, acceleration, gyration);
    let a = along(start, k1, 0.5 * h);
    let b = along(start, turning(a, acceleration, gyration), 0.5 * h);
    let c = along(start, turning(b, acceleration, gyration), h);
    let k4 = turning(c, acceleration, gyration);
    let (sixth, twelfth) = (h / 6.0, h * h / 12.0);
    let mut end = [0.0; 3];
    for i in 0..3 {
        // The stages already hold start + h·k: their mean is the method's.
        end[i] = (1.0 / 3.0) * (((a[i] - start[i]) + (b[i] + b[i])) + c[i]) + sixth * k4[i];
    }
    let last = turning(end, acceleration, gyration);
    let mut exponent = [0.0; 3];
    for i in 0..3 {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        exponent[i] = 0.5 * h * (start[i] + end[i])
            + (twelfth * (k1[i] - last[i]) + 2.0 * twelfth * (start[j] * end[k] - start[k] * end[j]));
    }
    (end, exponent)
}

/// cos √n and sin √n / √n for n = |Ω|² up to about 2 (Taylor to n⁶: below 1e-9).
#[inline(always)]
fn cos_sinc(n: f64) -> (f64, f64) {
    let cos = 1.0 / 40320.0 + n * (-1.0 / 3_628_800.0 + n * (1.0 / 479_001_600.0));
    let cos = 1.0 + n * (-0.5 + n * (1.0 / 24.0 + n * (-1.0 / 720.0 + n * cos)));
    let sinc = 1.0 / 362_880.0 + n * (-1.0 / 39_916_800.0 + n * (1.0 / 6_227_020_800.0));
    let sinc = 1.0 + n * (-1.0 / 6.0 + n * (1.0 / 120.0 + n * (-1.0 / 5040.0 + n * sinc)));
    (cos, sinc)
}

kernel! {
    /// One block of runs through all nodes: adds weight · (xz + wy, yz − wx, x² + y²), of which the thrust's direction
    /// is (2·, 2·, 1 − 2·), then turns the attitude by the step's Magnus exponent. Rates are halved ones, W = ω/2, as
    /// the quaternion's rate q ⊗ W takes them.
    fn integrate(block: &mut Block, steps: &[f64], weights: &[f64], gyration: [f64; 3]) {
        for (&h, &weight) in steps.iter().zip(weights) {
            for lane in 0..LANES {
                let [w, x, y, z] = [0, 1, 2, 3].map(|i| block.attitude[i][lane]);
                let rates = [0, 1, 2].map(|i| block.half_rates[i][lane]);
                let acceleration = [0, 1, 2].map(|i| block.acceleration[i][lane]);
                block.direction[0][lane] += weight * (x * z + w * y);
                block.direction[1][lane] += weight * (y * z - w * x);
                block.direction[2][lane] += weight * (x * x + y * y);
                let (end, [a, b, c]) = turn(rates, acceleration, gyration, h);
                let (cos, sinc) = cos_sinc(a * a + b * b + c * c);
                let (p, q, r) = (sinc * a, sinc * b, sinc * c);
                block.attitude[0][lane] = cos * w - x * p - y * q - z * r;
                block.attitude[1][lane] = cos * x + w * p + y * r - z * q;
                block.attitude[2][lane] = cos * y + w * q + z * p - x * r;
                block.attitude[3][lane] = cos * z + w * r + x * q - y * p;
                block.half_rates[0][lane] = end[0];
                block.half_rates[1][lane] = end[1];
                block.half_rates[2][lane] = end[2];
            }
        }
    }
}
