//! Proof that a leg keeps to the body's limits at every instant: enclosures of everything demanded, halved until
//! they decide.
//!
//! On an interval of time every demanded quantity is middle ± slope ± rest; upper(f) within the limit for all of them
//! is a proof on the whole interval, a violation at a centre is a refusal with evidence, anything else is halved. A
//! violation of 1 ms between samples cannot be missed. Accepting is proven up to rounding, refusing may be conservative
//! by the shortest interval.
//!
//! What is compared, each with a margin that is ≥ 0 where the limit holds:
//!
//! ```text
//! speed    v_max − |v|            thrust   Fz − 0.02 m g          tilt   Fz − |F| cos(tilt_max)
//! rotors   wᵢ² − w_min²           w_max² − wᵢ²                    i = 0 … 3
//! ```
//!
//! Tilt is compared without an angle, since acos has no bounded slope at 0. A leg that touches a limit exactly is
//! refused: its margin never clears the room for rounding.

use wide::f64x4;

use super::flatness::{Demand, FlatState, Flatness, LEAST_VERTICAL_THRUST, flat_state};
use super::halving::{ProofSettings, prove_by_halving};
use crate::feasibility::limits::{Infeasible, Limit, Limits};
use crate::math::interval::{Enclosure, Smooth, unrolled};
use crate::math::polynomial::derivatives;
use crate::math::power::square;
use crate::math::simd::at_every_level;
use crate::robot::quadrotor::Quadrotor;
use crate::trajectory::ProfileLeg;

/// Room for rounding, as a share of each limit: every bound must clear its limit by this much. Four orders above
/// what the formulas lose.
const ROUNDING: f64 = 1e-9;

/// The body's limits as numbers to compare with.
///
/// What is compared is free of roots and angles: squares of rotor speeds, cos of the tilt.
#[derive(Debug, Clone)]
pub(super) struct BodyLimits {
    /// As the task has them, for what is told.
    limits: Limits,
    /// N.
    least_vertical: f64,
    /// m g, N.
    weight: f64,
    /// Of the largest tilt, which is cut to a right angle.
    cos_tilt: f64,
    /// Least and largest, rad/s.
    rotor_speed: (f64, f64),
    /// Square of the least, rad²/s².
    rotor_low: f64,
    /// Square of the largest, rad²/s².
    rotor_high: f64,
    settings: ProofSettings,
}

impl BodyLimits {
    /// Rotor speeds are compared by their squares.
    ///
    /// `settings.first` is brought into 4 … 64: fewer waste lanes, more might not fit beside their halves.
    pub(super) fn new(robot: &Quadrotor, limits: Limits, settings: ProofSettings) -> Self {
        let weight = robot.mass * robot.gravity;
        Self {
            limits,
            least_vertical: LEAST_VERTICAL_THRUST * weight,
            weight,
            cos_tilt: libm::cos(limits.max_tilt.clamp(0.0, std::f64::consts::FRAC_PI_2)),
            rotor_speed: robot.rotor_speed,
            rotor_low: square(robot.rotor_speed.0),
            rotor_high: square(robot.rotor_speed.1),
            settings: ProofSettings { first: settings.first.clamp(4, 64), ..settings },
        }
    }

    /// How hard the proof tries.
    pub(super) fn settings(&self) -> &ProofSettings {
        &self.settings
    }

    /// Signed margins of speed, vertical thrust and tilt, and what rounding may take from each.
    ///
    /// In m/s, N and N; `vertical` is Fz and `thrust` |F|. A speed limit that is infinite or huge counts as 1000 m/s
    /// for rounding, so that the room stays finite.
    #[inline(always)]
    pub(super) fn force_margins<N: Smooth>(&self, speed: N, vertical: N, thrust: N) -> [(N, f64); 3] {
        [
            (N::constant(self.limits.max_speed) - speed, ROUNDING * self.limits.max_speed.min(1e3)),
            (vertical - N::constant(self.least_vertical), ROUNDING * self.weight),
            (vertical - thrust * self.cos_tilt, ROUNDING * self.weight),
        ]
    }

    /// The first of four squared rotor speeds that is out of its limits, with its margin in rad/s. NaN is.
    ///
    /// The margin is w_max − w or w − w_min, negative; NaN demands come back as −∞ below the least speed. `part` is the
    /// rotor's index. No room for rounding: at a sample, being at the limit is allowed.
    #[inline]
    pub(super) fn rotor_violation(&self, squares: &[f64; 4]) -> Option<(Limit, usize, f64)> {
        let (low, high) = (self.rotor_low, self.rotor_high);
        let part = squares.iter().position(|w2| !(*w2 >= low && *w2 <= high))?;
        let speed = signed_root(squares[part]);
        if squares[part] > high {
            return Some((Limit::RotorMax, part, self.rotor_speed.1 - speed));
        }
        Some((Limit::RotorMin, part, if speed.is_nan() { f64::NEG_INFINITY } else { speed - self.rotor_speed.0 }))
    }

    /// Whether a squared rotor speed is out of its limits by more than `share` of the largest. NaN is not.
    #[inline(always)]
    pub(super) fn rotors_beyond(&self, squares: &[f64; 4], share: f64) -> bool {
        let room = share * self.rotor_high;
        let beyond = |square: f64| (square < self.rotor_low - room) | (square > self.rotor_high + room);
        let [a, b, c, d] = *squares;
        beyond(a) | beyond(b) | beyond(c) | beyond(d)
    }

    /// Whether a speed, given its square, is beyond its limit by more than `share` of it. NaN is not.
    #[inline(always)]
    pub(super) fn is_faster(&self, speed_square: f64, share: f64) -> bool {
        speed_square > square(self.limits.max_speed + share * self.limits.max_speed.min(1e3))
    }

    /// Whether speed, vertical thrust or tilt is beyond its limit by more than `share` of it. NaN is not.
    #[inline(always)]
    pub(super) fn force_beyond(&self, speed: f64, vertical: f64, thrust: f64, share: f64) -> bool {
        let [speed, least, tilt] = self.force_margins(speed, vertical, thrust);
        let beyond = |(margin, room): (f64, f64)| margin < -room * (share / ROUNDING);
        beyond(speed) | beyond(least) | beyond(tilt)
    }

    /// The first of four instants that violates speed, thrust or tilt, with the margin in the limit's unit.
    #[inline]
    pub(super) fn force_violation(&self, speed: f64x4, vertical: f64x4, thrust: f64x4) -> Option<(usize, Limit, f64)> {
        let limits = [Limit::Speed, Limit::Thrust, Limit::Tilt];
        for ((margin, _), limit) in self.force_margins(speed, vertical, thrust).into_iter().zip(limits) {
            let bits = margin.simd_lt(f64x4::ZERO).to_bitmask();
            if bits != 0 {
                let lane = bits.trailing_zeros() as usize;
                let margin = margin.to_array()[lane];
                return Some(match limit {
                    Limit::Speed => (lane, limit, margin),
                    Limit::Thrust => (lane, limit, margin / self.weight),
                    _ => (lane, limit, self.tilt_margin(vertical.to_array()[lane], thrust.to_array()[lane])),
                });
            }
        }
        None
    }

    /// Limit − acos(F_z/|F|), rad.
    ///
    /// `vertical` and `thrust` in N; NaN where both vanish.
    fn tilt_margin(&self, vertical: f64, thrust: f64) -> f64 {
        self.limits.max_tilt - libm::acos((vertical / thrust).clamp(-1.0, 1.0))
    }

    /// The least margin at one instant, with its limit and part, in the limit's unit.
    ///
    /// Least as a share of the limit, so that limits of different units compare.
    ///
    /// Scales: 1 for thrust as a share of the weight and for tilt in rad, the limit itself for speed (1000 m/s at
    /// most), the largest rotor speed for rotors. Below the least vertical thrust only that is told, for attitude and
    /// rates mean nothing.
    pub(super) fn worst(&self, flatness: &Flatness, leg: &ProfileLeg, tau: f64) -> (Limit, usize, f64) {
        let demand: Demand<f64> = flatness.demand(&flat_state(leg, tau));
        let vertical = demand.force[2] / self.weight - LEAST_VERTICAL_THRUST;
        if vertical.is_nan() || vertical < 0.0 {
            // Nothing else is defined.
            return (Limit::Thrust, 0, if vertical.is_nan() { f64::NEG_INFINITY } else { vertical });
        }
        let mut worst = (Limit::Thrust, 0, vertical, vertical);
        let mut consider = |limit, part, margin: f64, scale: f64| {
            if margin / scale < worst.3 {
                worst = (limit, part, margin, margin / scale);
            }
        };
        consider(Limit::Speed, 0, self.limits.max_speed - demand.speed, self.limits.max_speed.min(1e3));
        consider(Limit::Tilt, 0, self.tilt_margin(demand.force[2], demand.thrust), 1.0);
        for (part, square) in demand.rotors.into_iter().enumerate() {
            let speed = signed_root(square);
            consider(Limit::RotorMin, part, speed - self.rotor_speed.0, self.rotor_speed.1);
            consider(Limit::RotorMax, part, self.rotor_speed.1 - speed, self.rotor_speed.1);
        }
        (worst.0, worst.1, worst.2)
    }

    /// Whether (1 or 0) every limit is proven within `half` (s) of the centre of an interval, and whether one is
    /// violated at the centre; `d` are position and its derivatives of every axis there, SI.
    ///
    /// Comparisons with NaN are false, so what is undefined is never proven.
    #[inline(always)]
    pub(super) fn decide(&self, flatness: &Flatness, d: &[[f64; 8]; 3], half: f64) -> (u64, u64) {
        let demand = flatness.demand(&FlatState {
            velocity: unrolled!(|axis| Enclosure::taylor(&d[axis][1..], half)),
            acceleration: unrolled!(|axis| Enclosure::taylor(&d[axis][2..], half)),
            jerk: unrolled!(|axis| Enclosure::taylor(&d[axis][3..], half)),
            snap: unrolled!(|axis| Enclosure::taylor(&d[axis][4..], half)),
        });
        let (mut proven, mut violated) = (true, false);
        let mut require = |margin: Enclosure<f64>, room: f64| {
            proven &= margin.lower() >= room;
            violated |= margin.middle < 0.0;
        };
        let [speed, thrust, tilt] = self.force_margins(demand.speed, demand.force[2], demand.thrust);
        require(speed.0, speed.1);
        require(thrust.0, thrust.1);
        require(tilt.0, tilt.1);
        let (low, high) = (Enclosure::constant(self.rotor_low), Enclosure::constant(self.rotor_high));
        let mut rotor = |i: usize| {
            require(demand.rotors[i] - low, ROUNDING * self.rotor_high);
            require(high - demand.rotors[i], ROUNDING * self.rotor_high);
        };
        unrolled!([0, 1, 2, 3], |i| rotor(i));
        (u64::from(proven), u64::from(violated))
    }

    /// Proves speed, thrust, tilt and rotor limits on the whole leg.
    ///
    /// Four intervals at a time in lanes, each degree-1 Taylor models of all demands; halved in two where neither
    /// proven nor violated at its centre.
    ///
    /// Accepting costs two batches for legs that keep well clear; the worst case is the budget of [`ProofSettings`].
    ///
    /// # Errors
    /// A violation at an instant, or an interval that the settings do not let it decide.
    pub(super) fn prove(&self, flatness: &Flatness, leg: &ProfileLeg) -> Result<(), Infeasible> {
        let refuse = |tau: f64| {
            let (limit, part, margin) = self.worst(flatness, leg, tau);
            Err(Infeasible::at(limit, part, tau, margin))
        };
        prove_by_halving(leg.duration, &self.settings, |batch| evaluate(self, flatness, leg, batch)).or_else(refuse)
    }
}

at_every_level! {
    /// Bit masks of the intervals on which every limit is proven, and of those whose centre violates one.
    ///
    /// `batch` holds centre and half width, s. An interval may be in neither mask, and one whose centre violates is
    /// never in the first, since its lower bound is no higher than its centre.
    fn evaluate(body: &BodyLimits, flatness: &Flatness, leg: &ProfileLeg, batch: &[(f64, f64); 4]) -> (u32, u32) {
        let tau = f64x4::new(unrolled!([0, 1, 2, 3], |lane| batch[lane].0));
        let half = unrolled!([0, 1, 2, 3], |lane| batch[lane].1);
        let d = unrolled!(|axis| derivatives(&leg.coefficients[axis], tau));
        let d = unrolled!(|axis| unrolled!([0, 1, 2, 3, 4, 5, 6, 7], |order| d[axis][order].to_array()));
        let (mut proven, mut violated) = ([0; 4], [0; 4]);
        for lane in 0..4 {
            let d = unrolled!(|axis| unrolled!([0, 1, 2, 3, 4, 5, 6, 7], |order| d[axis][order][lane]));
            (proven[lane], violated[lane]) = body.decide(flatness, &d, half[lane]);
        }
        (mask(&proven), mask(&violated))
    }
}

/// Bit i for lane number i, each 1 or 0.
#[inline(always)]
fn mask(&[a, b, c, d]: &[u64; 4]) -> u32 {
    (a | b << 1 | c << 2 | d << 3) as u32
}

/// Root of |x| with the sign of x: a negative demand stays visible as a negative speed.
///
/// Only for what is told.
fn signed_root(square: f64) -> f64 {
    square.abs().sqrt().copysign(square)
}
