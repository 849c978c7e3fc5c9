//! The loops that every controller flies on: velocity to thrust, attitude to body rates, body rates to moments, moments
//! to rotor speeds. A command enters at its own.
//!
//! ```text
//! attitude, 250 Hz   ω* = ω_ff + 2 k_a sgn(e_w) e,   e = q* ⊗ q_wanted,   yaw weighed 0.4
//! rates, ≈ 1 kHz     ω̇* = p (ω* − ω_f) + ∫ i (ω* − ω_f) − d ω̇_f + (1 + d) ω̇_ff + gyroscopic terms
//! mixer              w² = M⁻¹ (m a, I ω̇*), roll and pitch first, then thrust, then yaw
//! ```
//!
//! ω_f is the gyro behind a Butterworth low-pass of 30 Hz. With the damping −d ω̇ the rotor lag T acts as T/(1 + d),
//! and the rate loop closes at 21 rad/s, or at a third of what lag and filter leave.

use nalgebra::{UnitQuaternion, Vector3, Vector4};
use wide::f64x4;

use super::command::{Demand, FlightCommand, FlightState};
use super::controllers::{Cascade, stable_waypoint};
use super::lanes::{coupled, lanes, vector};
use super::mixer::{Mixed, Mixer};
use super::step::Motion;
use crate::robot::quadrotor::Quadrotor;

/// Bandwidth of the closed rate loop, rad/s. FlightGoggles' own rate loop, 9 e + 3 ∫e − 0.3 ω̇, closes at 7 rad/s,
/// which leaves the position loop three loops above it too slow to settle a 10 m step within 6 s: this is three times
/// as fast.
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
/// Least thrust asked for, in g: without any there is no moment either.
const LEAST_THRUST: f64 = 0.05;
/// Largest body rate that the attitude loop asks for, rad/s: tilt, yaw.
const MAX_RATES: (f64, f64) = (12.0, 2.0);

/// What the attitude loop follows.
#[derive(Debug, Clone, Copy)]
enum Followed {
    Force(Demand),
    /// Thrust per mass, m/s², and `world_from_body`.
    Attitude(f64, UnitQuaternion<f64>),
    /// Nothing: the rates were asked for themselves.
    Rates,
}

/// Velocity, attitude and rate loop of one robot, with the mixer below them. Vectors have a spare lane for the thrust.
#[derive(Debug, Clone)]
pub(crate) struct InnerLoop {
    mixer: Mixer,
    /// (Izz − Iyy)/Ixx and its cyclic kin.
    gyroscopic: f64x4,
    gravity: f64,
    inverse_mass: f64,
    velocity: Cascade,
    followed: Followed,
    /// The command's angular acceleration as the damping lets it through.
    fed_forward: f64x4,
    /// What the rate loop follows: body rates, rad/s; thrust per mass, m/s², in the last lane, alone; and ticks until
    /// the attitude loop's next turn.
    wanted: f64x4,
    thrust: f64x4,
    to_attitude: u32,
    attitude: f64,
    /// Gains in every lane: a broadcast costs an instruction. The integral's is per tick.
    p: f64x4,
    i: f64x4,
    /// Damping, as it is and per tick.
    d: f64,
    damping: f64x4,
    integral: f64x4,
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
        let i = robot.inertia;
        Some(Self {
            mixer: Mixer::new(robot)?,
            gyroscopic: lanes(&Vector3::new((i.z - i.y) / i.x, (i.x - i.z) / i.y, (i.y - i.x) / i.z)),
            gravity: robot.gravity,
            inverse_mass: 1.0 / robot.mass,
            velocity: stable_waypoint::cascade(robot),
            followed: Followed::Force(Demand::along(Vector3::z() * robot.gravity)),
            fed_forward: f64x4::ZERO,
            wanted: f64x4::ZERO,
            thrust: f64x4::new([0.0, 0.0, 0.0, robot.gravity]),
            to_attitude: 0,
            attitude: ATTITUDE_OVER_RATE * bandwidth,
            p: f64x4::splat(p),
            i: f64x4::splat(p * INTEGRAL_RATIO * period),
            d,
            damping: f64x4::splat(d / period),
            integral: f64x4::ZERO,
            gyro: LowPass::new(GYRO_CORNER, period),
            saturated: false,
        })
    }

    /// The command from now on, for `dt` s, as it was given in `state`.
    pub(crate) fn follow(&mut self, dt: f64, state: &FlightState, command: &FlightCommand) {
        if !matches!(command, FlightCommand::Velocity(_)) {
            self.velocity.restart();
        }
        let demand = match command {
            FlightCommand::Velocity(wanted) => self.velocity.follow(dt, state, wanted),
            FlightCommand::Acceleration(wanted) => Demand::along(wanted + Vector3::z() * self.gravity),
            FlightCommand::Force(demand) => *demand,
            FlightCommand::Attitude { thrust, attitude } => {
                self.fed_forward = f64x4::ZERO;
                self.followed = Followed::Attitude(thrust * self.inverse_mass, *attitude);
                return;
            }
            FlightCommand::Rates { thrust, rates } => {
                self.fed_forward = f64x4::ZERO;
                self.wanted = lanes(rates);
                self.push(thrust * self.inverse_mass);
                self.followed = Followed::Rates;
                return;
            }
        };
        self.fed_forward = lanes(&(demand.angular_acceleration * (1.0 + self.d)));
        self.followed = Followed::Force(demand);
    }

    /// Rotor speeds for the command in force, from the measured motion.
    #[inline(always)]
    pub(crate) fn command(&mut self, motion: &Motion) -> Mixed {
        if self.to_attitude == 0 {
            self.to_attitude = ATTITUDE_EVERY;
            self.turn(motion);
        }
        self.to_attitude -= 1;
        let measured = motion.rates;
        let before = self.gyro.out;
        let filtered = self.gyro.next(measured);
        let error = self.wanted - filtered;
        if !self.saturated {
            let bound = f64x4::splat(INTEGRAL_BOUND);
            self.integral = (self.integral + error * self.i).fast_min(bound).fast_max(-bound);
        }
        // The moment ω × Iω that keeps the rates' products from coupling the axes is the gyroscopic term.
        let asked = (error * self.p - (filtered - before) * self.damping)
            + (self.integral + self.fed_forward + self.thrust)
            + coupled(measured) * self.gyroscopic;
        let mixed = self.mixer.mix(asked);
        self.saturated = mixed.at_limit > 0;
        mixed
    }

    /// The attitude loop's turn.
    fn turn(&mut self, motion: &Motion) {
        let (thrust, rates) = match &self.followed {
            Followed::Force(demand) => {
                let thrust = demand.force.dot(&vector(motion.up));
                (thrust, demand.rates + self.towards(&demand.attitude, &motion.quaternion()))
            }
            Followed::Attitude(thrust, attitude) => (*thrust, self.towards(attitude, &motion.quaternion())),
            Followed::Rates => return,
        };
        self.wanted = lanes(&rates);
        self.push(thrust);
    }

    /// Thrust per mass from now on, m/s².
    fn push(&mut self, thrust: f64) {
        self.thrust = f64x4::new([0.0, 0.0, 0.0, thrust.max(LEAST_THRUST * self.gravity)]);
    }

    /// ω = 2 k sgn(e_w) e for the error quaternion e = q* ⊗ q_wanted, yaw weighed less, bounded.
    fn towards(&self, wanted: &UnitQuaternion<f64>, q: &[f64; 4]) -> Vector3<f64> {
        let ([w, x, y, z], [a, b, c, d]) = (*q, [wanted.w, wanted.i, wanted.j, wanted.k]);
        let scalar = w * a + x * b + y * c + z * d;
        let error =
            Vector3::new(w * b - x * a - y * d + z * c, w * c + x * d - y * a - z * b, w * d - x * c + y * b - z * a);
        let gain = if scalar < 0.0 { -2.0 * self.attitude } else { 2.0 * self.attitude };
        let turn = error * gain;
        let (tilt, yaw) = MAX_RATES;
        Vector3::new(turn.x.min(tilt).max(-tilt), turn.y.min(tilt).max(-tilt), (YAW_WEIGHT * turn.z).min(yaw).max(-yaw))
    }

    /// The rotor speeds of level hover, as far as the limits allow.
    pub(crate) fn hover(&self, robot: &Quadrotor) -> Vector4<f64> {
        let hover = f64x4::new([0.0, 0.0, 0.0, robot.gravity]);
        Vector4::from(self.mixer.mix(hover).speeds.to_array())
    }
}

/// Second-order Butterworth low-pass, bilinear with the corner prewarped, transposed direct form II.
#[derive(Debug, Clone)]
struct LowPass {
    b: f64x4,
    a1: f64x4,
    a2: f64x4,
    s1: f64x4,
    s2: f64x4,
    out: f64x4,
}

impl LowPass {
    /// `corner_hz` below half of the sampling rate; from rest.
    fn new(corner_hz: f64, period: f64) -> Self {
        let k = libm::tan(std::f64::consts::PI * corner_hz * period);
        let norm = 1.0 / (1.0 + std::f64::consts::SQRT_2 * k + k * k);
        Self {
            b: f64x4::splat(k * k * norm),
            a1: f64x4::splat(2.0 * (k * k - 1.0) * norm),
            a2: f64x4::splat((1.0 - std::f64::consts::SQRT_2 * k + k * k) * norm),
            s1: f64x4::ZERO,
            s2: f64x4::ZERO,
            out: f64x4::ZERO,
        }
    }

    /// One sample in, one out; all lanes alike.
    #[inline(always)]
    fn next(&mut self, input: f64x4) -> f64x4 {
        let x = input * self.b;
        self.out = x + self.s1;
        self.s1 = (x + x + self.s2) - self.out * self.a1;
        self.s2 = x - self.out * self.a2;
        self.out
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;

    #[test]
    fn the_gyro_filter_passes_what_is_slow_and_halves_the_power_at_its_corner() {
        for (hz, expected) in [(1.0, 1.0), (30.0, 0.5f64.sqrt()), (300.0, 0.0)] {
            let mut filter = LowPass::new(30.0, 0.001);
            let mut peak: f64 = 0.0;
            for i in 0..4000 {
                let out = filter.next(f64x4::splat((std::f64::consts::TAU * hz * i as f64 * 0.001).sin()));
                if i > 2000 {
                    peak = peak.max(out.to_array()[0].abs());
                }
            }
            assert!((peak - expected).abs() < 0.01, "{hz} Hz: {peak}");
        }
    }
}
