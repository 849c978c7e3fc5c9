//! The loops that every controller flies on: attitude to body rates, body rates to moments, moments to rotor speeds.

use nalgebra::{Vector3, Vector4};

use super::controllers::Demand;
use super::mixer::{Mixed, Mixer};
use super::plant::{ATTITUDE, PlantState, RATES};
use super::step::body_z;
use crate::robot::quadrotor::Quadrotor;

/// Bandwidth of the closed rate loop, rad/s. FlightGoggles' own rate loop, 9 e + 3 ∫e − 0.3 ω̇, closes at 7 rad/s, which
/// leaves the position loop three loops above it too slow to settle a 10 m step within 6 s: this is three times as fast.
const RATE_BANDWIDTH: f64 = 21.0;
/// Integral over proportional gain, 1/s: as in FlightGoggles.
const INTEGRAL_RATIO: f64 = 1.0 / 3.0;
/// Where the loop gain of the damping term −d ω̇ falls to one behind the rotor lag, rad/s, so that d = this · lag. It
/// shortens the lag to 1/(1 + d) of itself, and half of the gyro filter's corner leaves it 45° of phase.
const DAMPING_CROSSOVER: f64 = 100.0;
/// Bound of the integral, as in FlightGoggles, rad/s².
const INTEGRAL_BOUND: f64 = 1000.0;
/// Corner of the gyro low-pass, Hz: second order, Butterworth.
const GYRO_CORNER: f64 = 30.0;
/// Attitude gain over rate bandwidth: three loops apart a factor of three keeps them from disturbing each other.
const ATTITUDE_OVER_RATE: f64 = 0.35;
/// The attitude loop runs at every fourth tick of the rate loop, 250 Hz: far above its bandwidth of 7 rad/s.
const ATTITUDE_EVERY: u32 = 4;
/// Yaw is turned by drag moments alone, an order of magnitude weaker: its error is weighed less.
const YAW_WEIGHT: f64 = 0.4;
/// Largest body rate asked for, rad/s: tilt, yaw.
const MAX_RATES: (f64, f64) = (12.0, 2.0);

/// Attitude and rate loop of one robot, with the mixer below them.
#[derive(Debug, Clone)]
pub(crate) struct InnerLoop {
    mixer: Mixer,
    inertia: Vector3<f64>,
    mass: f64,
    period: f64,
    per_second: f64,
    least_thrust: f64,
    /// What the attitude loop last asked for: body rates, rad/s, and thrust, N; and ticks until its next turn.
    wanted: Vector3<f64>,
    thrust: f64,
    to_attitude: u32,
    attitude: f64,
    p: f64,
    i: f64,
    d: f64,
    integral: Vector3<f64>,
    gyro: LowPass,
    saturated: bool,
}

impl InnerLoop {
    /// Runs every `period` s. `None` for a rotor layout that cannot be flown ([`Mixer::new`]).
    pub(crate) fn new(robot: &Quadrotor, period: f64) -> Option<Self> {
        let d = DAMPING_CROSSOVER * robot.rotor_time_constant;
        let filter = std::f64::consts::SQRT_2 / (std::f64::consts::TAU * GYRO_CORNER);
        let lag = robot.rotor_time_constant / (1.0 + d) + filter;
        // A loop faster than a third of its remaining lag allows would ring.
        let bandwidth = RATE_BANDWIDTH.min(1.0 / (3.0 * lag));
        // Damped, the body answers a demand like 1/(1 + d).
        let p = bandwidth * (1.0 + d);
        Some(Self {
            mixer: Mixer::new(robot)?,
            inertia: robot.inertia,
            mass: robot.mass,
            period,
            per_second: 1.0 / period,
            wanted: Vector3::zeros(),
            thrust: robot.mass * robot.gravity,
            to_attitude: 0,
            least_thrust: 0.05 * robot.mass * robot.gravity,
            attitude: ATTITUDE_OVER_RATE * bandwidth,
            p,
            i: p * INTEGRAL_RATIO,
            d,
            integral: Vector3::zeros(),
            gyro: LowPass::new(GYRO_CORNER, period),
            saturated: false,
        })
    }

    /// Rotor speeds for the demand in force, from the measured state.
    #[inline(always)]
    pub(crate) fn command(&mut self, demand: &Demand, state: &PlantState) -> Mixed {
        if self.to_attitude == 0 {
            self.to_attitude = ATTITUDE_EVERY;
            self.turn(demand, state);
        }
        self.to_attitude -= 1;
        let s = state.as_slice();
        let measured = Vector3::new(s[RATES], s[RATES + 1], s[RATES + 2]);

        let before = self.gyro.value();
        let filtered = self.gyro.next(&measured);
        let angular = (filtered - before) * self.per_second;
        let error = self.wanted - filtered;
        if !self.saturated {
            let bound = INTEGRAL_BOUND;
            self.integral = (self.integral + error * (self.i * self.period)).map(|c| c.min(bound).max(-bound));
        }
        let acceleration =
            error * self.p + self.integral - angular * self.d + demand.angular_acceleration * (1.0 + self.d);
        let momentum = self.inertia.component_mul(&measured);
        let moments = self.inertia.component_mul(&acceleration) + measured.cross(&momentum);
        let mixed = self.mixer.mix(self.thrust, &moments);
        self.saturated = mixed.at_limit > 0;
        mixed
    }

    /// The attitude loop's turn.
    fn turn(&mut self, demand: &Demand, state: &PlantState) {
        let s = state.as_slice();
        let q = [s[ATTITUDE], s[ATTITUDE + 1], s[ATTITUDE + 2], s[ATTITUDE + 3]];
        self.wanted = self.rates(demand, &q);
        // The part of the wanted force along the thrust axis: a robot that is still turning does not push sideways.
        self.thrust = (self.mass * demand.force.dot(&body_z(&q))).max(self.least_thrust);
    }

    /// ω = ω_ff + 2 k sgn(e_w) e for the error quaternion e = q* ⊗ q_wanted, yaw weighed less, bounded.
    fn rates(&self, demand: &Demand, q: &[f64; 4]) -> Vector3<f64> {
        let ([w, x, y, z], [a, b, c, d]) = (*q, demand.attitude);
        let scalar = w * a + x * b + y * c + z * d;
        let error =
            Vector3::new(w * b - x * a - y * d + z * c, w * c + x * d - y * a - z * b, w * d - x * c + y * b - z * a);
        let gain = if scalar < 0.0 { -2.0 * self.attitude } else { 2.0 * self.attitude };
        let turn = error * gain;
        let (tilt, yaw) = MAX_RATES;
        demand.rates
            + Vector3::new(
                turn.x.min(tilt).max(-tilt),
                turn.y.min(tilt).max(-tilt),
                (YAW_WEIGHT * turn.z).min(yaw).max(-yaw),
            )
    }

    /// The rotor speeds of level hover, as far as the limits allow.
    pub(crate) fn hover(&self, robot: &Quadrotor) -> Vector4<f64> {
        self.mixer.mix(robot.mass * robot.gravity, &Vector3::zeros()).speeds
    }
}

/// Second-order Butterworth low-pass, bilinear with the corner prewarped, transposed direct form II.
#[derive(Debug, Clone)]
struct LowPass {
    b: f64,
    a1: f64,
    a2: f64,
    s1: Vector3<f64>,
    s2: Vector3<f64>,
    out: Vector3<f64>,
}

impl LowPass {
    fn new(corner_hz: f64, period: f64) -> Self {
        let k = (std::f64::consts::PI * corner_hz * period).tan();
        let norm = 1.0 / (1.0 + std::f64::consts::SQRT_2 * k + k * k);
        Self {
            b: k * k * norm,
            a1: 2.0 * (k * k - 1.0) * norm,
            a2: (1.0 - std::f64::consts::SQRT_2 * k + k * k) * norm,
            s1: Vector3::zeros(),
            s2: Vector3::zeros(),
            out: Vector3::zeros(),
        }
    }

    fn value(&self) -> Vector3<f64> {
        self.out
    }

    #[inline(always)]
    fn next(&mut self, input: &Vector3<f64>) -> Vector3<f64> {
        let x = input * self.b;
        self.out = x + self.s1;
        self.s1 = x * 2.0 - self.out * self.a1 + self.s2;
        self.s2 = x - self.out * self.a2;
        self.out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_gyro_filter_passes_what_is_slow_and_halves_the_power_at_its_corner() {
        for (hz, expected) in [(1.0, 1.0), (30.0, 0.5f64.sqrt()), (300.0, 0.0)] {
            let mut filter = LowPass::new(30.0, 0.001);
            let mut peak: f64 = 0.0;
            for i in 0..4000 {
                let out = filter.next(&Vector3::repeat((std::f64::consts::TAU * hz * i as f64 * 0.001).sin()));
                if i > 2000 {
                    peak = peak.max(out.x.abs());
                }
            }
            assert!((peak - expected).abs() < 0.01, "{hz} Hz: {peak}");
        }
    }
}
