//! From one velocity to another with bounded acceleration and jerk, one axis or several together.
//!
//! The jerk is +j, 0, −j for times T₁, T₂, T₃ (all signs turned where the velocity is to fall):
//!
//! ```text
//! peak of the acceleration     a_p = a₀ + j T₁,     T₃ = a_p/j
//! Δv = (2 a_p² − a₀²)/2j + a_p T₂                   from (v₀, a₀) to (v₀ + Δv, 0)
//! as fast as possible          a_p = min(√(j Δv + a₀²/2), a_max),  T₂ from the line above
//! in the time T                a_p² − (j T + a₀) a_p + j Δv + a₀²/2 = 0, the smaller root;  T₂ = T − T₁ − T₃
//! ```
//!
//! An acceleration that is above that peak already is held, and let go of last.
//!
//! Biagiotti and Melchiorri, "Trajectory Planning for Automatic Machines and Robots" (2008), ch. 3, have such profiles
//! for motions from rest.

use nalgebra::Vector3;

/// Bounds of one axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AxisLimits {
    /// Largest speed asked for, m/s.
    pub speed: f64,
    /// Largest acceleration, m/s².
    pub acceleration: f64,
    /// Largest jerk, m/s³.
    pub jerk: f64,
}

/// A point that moves so along three axes, m and s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JerkLimited {
    /// m.
    pub position: Vector3<f64>,
    /// m/s.
    pub velocity: Vector3<f64>,
    /// m/s².
    pub acceleration: Vector3<f64>,
}

impl JerkLimited {
    /// At rest.
    pub fn at_rest(position: Vector3<f64>) -> Self {
        Self { position, velocity: Vector3::zeros(), acceleration: Vector3::zeros() }
    }

    /// Moves on by `dt` s, each axis for its own share of that (0 … 1), towards the velocity `wanted` (m/s).
    ///
    /// The axes come there together, in the time of the slowest, or before it where they accelerate already. `wanted`
    /// is cut to each axis's speed, which is passed by no more than the acceleration of one turn; what is above its
    /// bound comes down within the jerk.
    pub fn follow(&mut self, wanted: &Vector3<f64>, limits: &[AxisLimits; 3], dt: f64) {
        let bound: [f64; 3] = std::array::from_fn(|i| wanted[i].min(limits[i].speed).max(-limits[i].speed));
        let fastest: [Ramp; 3] =
            std::array::from_fn(|i| Ramp::fastest(self.velocity[i], self.acceleration[i], bound[i], &limits[i]));
        let slowest = fastest.iter().map(Ramp::duration).fold(0.0, f64::max);
        for i in 0..3 {
            let ramp = if fastest[i].duration() < slowest {
                Ramp::within(slowest, self.velocity[i], self.acceleration[i], bound[i], &limits[i])
            } else {
                fastest[i]
            };
            let state = [self.position[i], self.velocity[i], self.acceleration[i]];
            [self.position[i], self.velocity[i], self.acceleration[i]] = ramp.advance(state, dt);
        }
    }
}

/// A change of velocity: the signed jerk of its first part, and the times of its three.
#[derive(Debug, Clone, Copy)]
struct Ramp {
    jerk: f64,
    times: [f64; 3],
}

/// A peak below this, m/s², holds no velocity to speak of.
const NO_PEAK: f64 = 1e-12;

impl Ramp {
    /// `d` turns the axis so that the velocity is to rise; the acceleration and Δv along it.
    fn turned(v: f64, a: f64, wanted: f64, jerk: f64) -> (f64, f64, f64) {
        // Where letting go of the acceleration at once would lead.
        let coasted = v + a * a.abs() / (2.0 * jerk);
        let d = if wanted >= coasted { 1.0 } else { -1.0 };
        (d, d * a, d * (wanted - v))
    }

    /// The quickest change from velocity `v` (m/s) and acceleration `a` (m/s²) to `wanted` and none.
    fn fastest(v: f64, a: f64, wanted: f64, limits: &AxisLimits) -> Self {
        let j = limits.jerk;
        let (d, a, change) = Self::turned(v, a, wanted, j);
        let peak = (j * change + 0.5 * a * a).max(0.0).sqrt().min(limits.acceleration);
        let first = ((peak - a) / j).max(0.0);
        let peak = a + j * first;
        let last = (peak / j).max(0.0);
        let rest = change - (2.0 * peak * peak - a * a) / (2.0 * j);
        let held = if peak > NO_PEAK { (rest / peak).max(0.0) } else { 0.0 };
        Self { jerk: d * j, times: [first, held, last] }
    }

    /// The same change in `time` s, at most as quick as the fastest.
    fn within(time: f64, v: f64, a: f64, wanted: f64, limits: &AxisLimits) -> Self {
        let j = limits.jerk;
        let (d, a, change) = Self::turned(v, a, wanted, j);
        let b = j * time + a;
        let root = b * b - 4.0 * (j * change + 0.5 * a * a);
        let peak = if root > 0.0 { 0.5 * (b - root.sqrt()) } else { a };
        let first = ((peak.min(limits.acceleration) - a) / j).max(0.0);
        let last = ((a + j * first) / j).max(0.0);
        Self { jerk: d * j, times: [first, (time - first - last).max(0.0), last] }
    }

    fn duration(&self) -> f64 {
        self.times.iter().sum()
    }

    /// Position, velocity and acceleration after `dt` s; beyond its end the velocity stays.
    fn advance(&self, [mut x, mut v, mut a]: [f64; 3], dt: f64) -> [f64; 3] {
        let mut left = dt;
        for (time, jerk) in self.times.into_iter().zip([self.jerk, 0.0, -self.jerk]) {
            let t = time.min(left);
            x += t * (v + t * (0.5 * a + t * jerk / 6.0));
            v += t * (a + 0.5 * t * jerk);
            a += t * jerk;
            left -= t;
        }
        if left > 0.0 { [x + left * v, v, 0.0] } else { [x, v, a] }
    }
}

/// The speed, m/s, from which `distance` m suffice to slow down to `end` m/s; no less than that.
///
/// v² − 2 a (d − v·2a/j) = v_end²: constant deceleration a, and 2a/j s flown at v until it is there, the time from
/// full acceleration to full deceleration.
pub fn braking_speed(distance: f64, end: f64, acceleration: f64, jerk: f64) -> f64 {
    let b = 4.0 * acceleration * acceleration / jerk;
    (0.5 * ((b * b + 4.0 * (2.0 * acceleration * distance + end * end)).sqrt() - b)).max(end)
}

/// The speed, m/s, at which a corner is rounded on the circle that touches both its legs at `reach` m from it.
///
/// v² = a r tan(α/2) with the lateral acceleration a and the angle α between the legs, given by its cosine `c`:
/// tan²(α/2) = (1 − c)/(1 + c). α = π is straight ahead, and no bound; α = 0, straight back, is rest.
pub fn corner_speed(c: f64, acceleration: f64, reach: f64) -> f64 {
    let tangent = ((1.0 - c).max(0.0) / (1.0 + c).max(0.0)).sqrt();
    (acceleration * reach * tangent).sqrt()
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;
    use crate::math::random::{named_seed, stream};
    use rand::RngExt;

    const LIMITS: AxisLimits = AxisLimits { speed: 5.0, acceleration: 3.0, jerk: 4.0 };

    /// From rest to v: v/a + a/j where the bound of the acceleration is met, 2 √(v/j) where it is not.
    #[test]
    fn from_rest_it_takes_the_time_of_the_closed_form() {
        for (v, time) in [(5.0, 5.0 / 3.0 + 3.0 / 4.0), (1.0, 1.0), (-1.0, 1.0), (0.0, 0.0)] {
            let ramp = Ramp::fastest(0.0, 0.0, v, &LIMITS);
            assert!((ramp.duration() - time).abs() < 1e-12, "{v}: {ramp:?}");
            let [x, end, a] = ramp.advance([0.0; 3], ramp.duration());
            // A symmetric change covers its distance at half the speed.
            assert!((end - v).abs() < 1e-12 && a.abs() < 1e-12 && (x - 0.5 * v * time).abs() < 1e-12, "{v}");
        }
    }

    #[test]
    fn from_anywhere_it_ends_where_it_was_asked_to() {
        let mut rng = stream(named_seed(1, "jerk limit", 0));
        for case in 0..20_000 {
            let (v, wanted) = (rng.random_range(-5.0..5.0), rng.random_range(-5.0..5.0));
            let a: f64 = rng.random_range(-3.0..3.0);
            let quick = Ramp::fastest(v, a, wanted, &LIMITS);
            let [_, end, left] = quick.advance([0.0, v, a], quick.duration());
            assert!((end - wanted).abs() < 1e-9 && left.abs() < 1e-9, "case {case}: {v} {a} {wanted} {quick:?}");
            // More time, the same end, and no more acceleration.
            let time = quick.duration() + rng.random_range(0.0..3.0);
            let slow = Ramp::within(time, v, a, wanted, &LIMITS);
            let [_, end, left] = slow.advance([0.0, v, a], time);
            // What is held would be too much by then: the next turn sees to that.
            let held = slow.times[0] == 0.0;
            assert!(held || ((end - wanted).abs() < 1e-9 && left.abs() < 1e-9), "case {case}: {slow:?} in {time} s");
            assert!(slow.times[0] <= quick.times[0] + 1e-12, "case {case}: {slow:?} {quick:?}");
        }
    }

    /// Whatever it is asked, turn by turn: jerk, acceleration and speed are never above their bounds.
    #[test]
    fn bounds_hold_while_what_is_asked_changes() {
        let mut rng = stream(named_seed(2, "jerk limit", 0));
        let limits = [LIMITS, LIMITS, AxisLimits { speed: 3.0, acceleration: 4.0, jerk: 4.0 }];
        let (mut point, dt) = (JerkLimited::at_rest(Vector3::zeros()), 0.01);
        let mut wanted = Vector3::zeros();
        for turn in 0..50_000 {
            if rng.random_range(0..60) == 0 {
                wanted = Vector3::from_fn(|_, _| rng.random_range(-8.0..8.0));
            }
            let before = point;
            point.follow(&wanted, &limits, dt);
            for (i, bound) in limits.iter().enumerate() {
                let jerk = (point.acceleration[i] - before.acceleration[i]) / dt;
                assert!(jerk.abs() < bound.jerk * (1.0 + 1e-9), "turn {turn}, axis {i}: jerk {jerk}");
                assert!(point.acceleration[i].abs() < bound.acceleration * (1.0 + 1e-9), "turn {turn}: {point:?}");
                assert!(point.velocity[i].abs() < bound.speed + bound.acceleration * dt, "turn {turn}: {point:?}");
                // Position and velocity are integrals of what is said of their rates.
                let moved = 0.5 * (before.velocity[i] + point.velocity[i]) * dt;
                let bend = bound.jerk * dt * dt * dt;
                assert!((point.position[i] - before.position[i] - moved).abs() < bend, "turn {turn}, axis {i}");
            }
        }
    }

    /// The slowest axis needs 4/3 + 3/4 s; a little before that none is there, and then all are.
    #[test]
    fn axes_arrive_together() {
        let wanted = Vector3::new(4.0, 1.0, -2.0);
        let mut point = JerkLimited::at_rest(Vector3::zeros());
        for turn in 1..=210 {
            point.follow(&wanted, &[LIMITS; 3], 0.01);
            let left = wanted - point.velocity;
            assert!(turn > 190 || left.iter().all(|v| v.abs() > 0.01), "turn {turn}: {left} m/s left");
        }
        assert!((point.velocity - wanted).norm() < 1e-6 && point.acceleration.norm() < 1e-3, "{point:?}");
    }

    #[test]
    fn braking_and_cornering_solve_their_equations() {
        for (d, end) in [(0.0f64, 0.0f64), (1.0, 0.0), (10.0, 1.5), (30.0, 4.0)] {
            let v = braking_speed(d, end, 3.0, 4.0);
            assert!((v * v - 6.0 * (d - v * 1.5) - end * end).abs() < 1e-9, "{d} {end}: {v}");
        }
        assert_eq!(braking_speed(0.5, 4.0, 3.0, 4.0), 4.0);
        // A right angle: r = reach, so that v² = a r. Straight on there is no bound, straight back no speed.
        assert!((corner_speed(0.0, 1.5, 2.0) - 3f64.sqrt()).abs() < 1e-12);
        assert_eq!((corner_speed(-1.0, 1.5, 2.0), corner_speed(1.0, 1.5, 2.0)), (f64::INFINITY, 0.0));
        // 120° between the legs, a turn of 60°: tan 60° = √3.
        assert!((corner_speed(-0.5, 1.5, 1.0).powi(2) - 1.5 * 3f64.sqrt()).abs() < 1e-12);
    }
}
