//! One leg between two waypoint states, level and without rates at both, judged cheapest test first.
//!
//! ```text
//! p(τ) of degree 7 on each axis, 0 ≤ τ ≤ T, with p, ṗ, p̈, p⃛ given at both ends
//! level at an end:  F = m g e₃, Ḟ = 0    ⇔    p̈ = −D(v)/m, p⃛ = −(∂D/∂v) p̈/m
//! ```
//!
//! So a waypoint is a place and a velocity, and a leg is two of them and a time. Legs that meet at a waypoint join with
//! continuous acceleration and jerk, whatever their times; their snap jumps there. No optimisation takes part: a leg is
//! what its data make of it, and is refused where that breaks a limit, though another shape between the same ends might
//! not.

use nalgebra::{Point3, Vector3};
use wide::f64x4;

use super::eight_ends::{Open, refuse};
use super::flatness::{DependentRotors, Flatness};
use super::halving::ProofSettings;
use super::leg_end::LegEnd;
use super::proof::BodyLimits;
use crate::feasibility::collision::FreeSpace;
use crate::feasibility::limits::{Infeasible, Limit, Limits};
use crate::math::interval::unrolled;
use crate::math::polynomial::septic;
use crate::robot::quadrotor::Quadrotor;
use crate::trajectory::ProfileLeg;
use crate::world::World;

/// Judges legs of one robot in one world under one set of limits.
///
/// Sound for its model (rigid body, drag, no lag, no wind) and not complete: legs have one shape for a given time,
/// level at both ends.
#[derive(Debug, Clone)]
pub struct LegJudge {
    /// Demands of the body.
    flatness: Flatness,
    body: BodyLimits,
    /// Where the centre may be.
    space: FreeSpace,
    limits: Limits,
    mass: f64,
    /// m/s; may be infinite.
    top_speed: f64,
    /// m/s².
    most_acceleration: f64,
}

impl LegJudge {
    /// The judge for `robot` in `world`. The robot's clearance radius is kept to obstacles, the world's keep-in margin
    /// to walls.
    ///
    /// `limits` come on top of the robot's own rotor limits.
    ///
    /// # Errors
    /// [`DependentRotors`].
    pub fn new(
        robot: &Quadrotor,
        world: &World,
        limits: Limits,
        settings: ProofSettings,
    ) -> Result<Self, DependentRotors> {
        Ok(Self {
            flatness: Flatness::new(robot)?,
            body: BodyLimits::new(robot, limits, settings),
            space: FreeSpace::new(world, robot.clearance_radius),
            limits,
            mass: robot.mass,
            top_speed: robot.max_speed.min(limits.max_speed),
            most_acceleration: most_acceleration(robot, limits.max_tilt),
        })
    }

    /// The robot's flatness map.
    pub fn flatness(&self) -> &Flatness {
        &self.flatness
    }

    /// The task's limits.
    pub fn limits(&self) -> &Limits {
        &self.limits
    }

    /// The speed that waypoint velocities are drawn up to, m/s: the task's limit or the robot's top speed.
    ///
    /// min of both.
    pub fn top_speed(&self) -> f64 {
        self.top_speed
    }

    /// No thrust within the limits changes the velocity by more than this, m/s²; drag only takes from the speed.
    pub fn most_acceleration(&self) -> f64 {
        self.most_acceleration
    }

    /// The space that legs keep to.
    pub fn space(&self) -> &FreeSpace {
        &self.space
    }

    /// The level state at `position` with `velocity`.
    ///
    /// World frame; m and m/s. A speed above the limits is not refused here: [`Self::judge`] does that.
    pub fn end(&self, position: Point3<f64>, velocity: Vector3<f64>) -> LegEnd {
        let [acceleration, jerk, drag_second] = self.flatness.level(&velocity);
        LegEnd { position, velocity, acceleration, jerk, drag_second }
    }

    /// The one 7th-order leg from `from` to `to` in `duration` (s, > 0), not judged.
    ///
    /// A duration that is 0, negative or not finite gives coefficients that are no numbers, without a panic.
    #[inline]
    pub fn connect(from: &LegEnd, to: &LegEnd, duration: f64) -> ProfileLeg {
        let data = |end: &LegEnd, axis: usize| {
            [end.position[axis], end.velocity[axis], end.acceleration[axis], end.jerk[axis]]
        };
        let coefficients = unrolled!(|axis| septic(&data(from, axis), &data(to, axis), duration));
        ProfileLeg { duration, coefficients }
    }

    /// The leg from `from` to `to` in `duration`, if every limit holds at every instant of it.
    ///
    /// Necessary tests come first: mean speed; rotor speeds at both ends, in closed form from the end snap; speed,
    /// thrust, tilt and walls at four instants. What passes is proven by [`Self::prove`].
    ///
    /// A duration that is not finite and positive is [`Limit::Duration`]. Most infeasible legs end at the tests before
    /// the proof.
    ///
    /// Limits are asked cheapest first, so the one named is the first that fails in that order, not the one that is
    /// missed by most. Nothing is allocated.
    ///
    /// # Errors
    /// The limit that fails, where, and by how much.
    pub fn judge(&self, from: &LegEnd, to: &LegEnd, duration: f64) -> Result<ProfileLeg, Infeasible> {
        let leg = self.unproven(from, to, duration)?;
        self.body.prove(&self.flatness, &leg)?;
        Ok(leg)
    }

    /// The leg from `from` to `to` in `duration`, of which all is settled but the proof of the body's limits.
    ///
    /// # Errors
    /// As [`Self::judge`].
    #[inline]
    pub(super) fn unproven(&self, from: &LegEnd, to: &LegEnd, duration: f64) -> Result<ProfileLeg, Infeasible> {
        if !(duration > 0.0 && duration.is_finite()) {
            return Err(Infeasible::Violates { limit: Limit::Duration, part: 0, at: 0.0, margin: -duration.abs() });
        }
        let mean_speed = (to.position - from.position).norm() / duration;
        if mean_speed > self.limits.max_speed {
            let margin = self.limits.max_speed - mean_speed;
            return Err(Infeasible::Violates { limit: Limit::Speed, part: 0, at: 0.0, margin });
        }
        let leg = Self::connect(from, to, duration);
        self.ends_allowed(from, to, &leg)?;
        self.instants_allowed(&leg)?;
        self.space.contains(&leg)?;
        Ok(leg)
    }

    /// Of each of `to` what is left of the open ones without those that [`Self::judge`] would refuse by the cheapest of
    /// its tests.
    pub(super) fn refuse(&self, from: &LegEnd, to: &[Open<'_>], duration: f64, left: &mut [u32]) {
        refuse((&self.flatness, &self.body, self.mass), from, to, duration, left);
    }

    /// The body's limits.
    pub(super) fn body(&self) -> &BodyLimits {
        &self.body
    }

    /// Proves that every limit holds at every instant of `leg`, which need not be level at its ends.
    ///
    /// Space first, then the body.
    ///
    /// Proven between samples, up to rounding, as [`super::proof`] and `feasibility::collision` describe.
    ///
    /// # Errors
    /// As [`Self::judge`].
    pub fn prove(&self, leg: &ProfileLeg) -> Result<(), Infeasible> {
        self.space.contains(leg)?;
        self.body.prove(&self.flatness, leg)
    }

    /// Rotor speeds at the ends, where F = m g e₃, Ḟ = 0 and F̈ = m p⁗ + D̈.
    ///
    /// Snap at the start is 24 c₄, at the end 24 c₄ + 120 c₅ T + 360 c₆ T² + 840 c₇ T³. Without tolerance: rounding at
    /// a limit may refuse what is exactly on it.
    #[inline]
    fn ends_allowed(&self, from: &LegEnd, to: &LegEnd, leg: &ProfileLeg) -> Result<(), Infeasible> {
        let t = leg.duration;
        let mut second = [[0.0; 2]; 2];
        for (axis, c) in leg.coefficients[..2].iter().enumerate() {
            let last = ((840.0 * c[7] * t + 360.0 * c[6]) * t + 120.0 * c[5]) * t + 24.0 * c[4];
            second[0][axis] = self.mass * 24.0 * c[4] + from.drag_second[axis];
            second[1][axis] = self.mass * last + to.drag_second[axis];
        }
        for (second, at) in second.iter().zip([0.0, t]) {
            if let Some((limit, part, margin)) = self.body.rotor_violation(&self.flatness.level_rotors(second)) {
                return Err(Infeasible::at(limit, part, at, margin));
            }
        }
        Ok(())
    }

    /// Walls, speed, thrust and tilt at a fifth, two fifths, … of the leg.
    ///
    /// A wall may be passed by 1 µm here, which the proof then decides; speed, thrust and tilt have no tolerance.
    /// Obstacles are not asked: they cost more than the proof's first look.
    #[inline]
    fn instants_allowed(&self, leg: &ProfileLeg) -> Result<(), Infeasible> {
        const INSTANTS: [f64; 4] = [0.2, 0.4, 0.6, 0.8];
        let tau = f64x4::new(INSTANTS) * leg.duration;
        let d = unrolled!(|axis| low_derivatives(&leg.coefficients[axis], tau));
        let velocity = unrolled!(|axis| d[axis][1]);
        let speed = Flatness::speed(&velocity);
        let force = self.flatness.force(&velocity, &unrolled!(|axis| d[axis][2]), speed);
        let thrust = Flatness::speed(&force);
        if let Some((lane, limit, margin)) = self.body.force_violation(speed, force[2], thrust) {
            return Err(Infeasible::at(limit, 0, INSTANTS[lane] * leg.duration, margin));
        }
        let (low, high) = self.space.walls();
        for axis in 0..3 {
            let margin = (d[axis][0] - f64x4::splat(low[axis])).min(f64x4::splat(high[axis]) - d[axis][0]);
            let bits = margin.simd_lt(f64x4::splat(-1e-6)).to_bitmask();
            if bits != 0 {
                let lane = bits.trailing_zeros() as usize;
                let (at, margin) = (INSTANTS[lane] * leg.duration, margin.to_array()[lane]);
                return Err(Infeasible::Violates { limit: Limit::World, part: axis as u16, at, margin });
            }
        }
        Ok(())
    }
}

/// max |F e/m − g e₃| over thrusts F from none to all and directions e within the tilt limit, m/s². Its square,
/// (F/m)² − 2 (F/m) g cos θ + g², is convex in F and grows with θ: the largest is at an end of both.
///
/// Drag left out. A `max_tilt` beyond a right angle counts as one. At least g: no thrust at all is always among them.
fn most_acceleration(robot: &Quadrotor, max_tilt: f64) -> f64 {
    let (thrust, gravity) = (robot.max_thrust() / robot.mass, robot.gravity);
    let cos_tilt = libm::cos(max_tilt.clamp(0.0, std::f64::consts::FRAC_PI_2));
    let square = thrust * (thrust - 2.0 * gravity * cos_tilt) + gravity * gravity;
    square.sqrt().max(gravity)
}

/// Position, velocity and acceleration of one axis at four times.
///
/// Horner's scheme with its derivatives; the second one comes out halved.
#[inline(always)]
fn low_derivatives(c: &[f64; 8], tau: f64x4) -> [f64x4; 3] {
    let (mut p, mut v, mut a) = (f64x4::ZERO, f64x4::ZERO, f64x4::ZERO);
    for coefficient in c.iter().rev() {
        a = a * tau + v;
        v = v * tau + p;
        p = p * tau + f64x4::splat(*coefficient);
    }
    [p, v, a * 2.0]
}
