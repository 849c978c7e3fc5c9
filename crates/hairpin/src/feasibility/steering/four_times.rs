//! The leg between two states at four durations at once: which of them cannot be, told without making any.
//!
//! Of the durations of a ladder nearly all are none, and nearly all of these for what the body would have to do at a
//! few instants. With u = τ/T and e the residues of [`crate::math::polynomial::septic`], an axis is
//!
//! ```text
//! p = c₀ + c₁u + c₂u² + c₃u³ + Σ_{k=4}^{7} b_k uᵏ,      b = M e
//! T ṗ = c₁ + 2c₂u + 3c₃u² + Σ_j V_j(u) e_j              V_j = Σ_k k M_kj uᵏ⁻¹
//! T² p̈ = 2c₂ + 6c₃u + Σ_j A_j(u) e_j                    A_j = Σ_k k (k−1) M_kj uᵏ⁻²
//! ```
//!
//! where V and A are numbers at a given u, so that an instant of four durations costs what the leg itself would.
//!
//! The limits asked are those of [`super::LegJudge::judge`], which holds them at every instant, with 10⁻⁷ of room,
//! since the same quantities come out of other formulas here: a leg that is refused here is refused there, while one
//! that passes here may still fail there. Walls and obstacles are not asked.

use nalgebra::Vector3;
use wide::f64x4;

use super::flatness::Flatness;
use super::leg_end::LegEnd;
use super::proof::BodyLimits;
use crate::math::interval::unrolled;
use crate::math::minimum_snap::HIGH_ORDERS as M;
use crate::math::simd::at_every_level;

/// More than rounding can make of a demand, as a share of its limit.
const ROUNDING: f64 = 1e-7;
/// The instants at which a leg is looked at, those first at which most are refused. At the last five the judge looks
/// only in its proof, which costs more than all of these.
const INSTANTS: [Instant; 9] = [
    Instant::at(0.4),
    Instant::at(0.8),
    Instant::at(0.2),
    Instant::at(0.6),
    Instant::at(0.3),
    Instant::at(0.7),
    Instant::at(0.5),
    Instant::at(0.1),
    Instant::at(0.9),
];

at_every_level! {
    /// Which of one to four durations (s, > 0) are refused by more than rounding, for what `body`, of that mass, would
    /// have to do at the ends or at nine instants: bit i for duration number i.
    ///
    /// What is left need not be a leg; what is refused is none by [`super::LegJudge::judge`].
    ///
    /// `few` must not be empty; more than four are cut to four. Lanes that repeat the last duration repeat its bit,
    /// which the caller does not read. A duration that gives NaN is not refused, and is left to the judge.
    pub(super) fn refused(body: (&Flatness, &BodyLimits, f64), from: &LegEnd, to: &LegEnd, few: &[f64]) -> u32 {
        const ALL: u32 = 0b1111;
        let (flatness, limits, mass) = body;
        let legs = FourTimes::new(from, to, few);
        let mut refused = legs.at_ends(flatness, limits, mass);
        for instant in &INSTANTS {
            if refused == ALL {
                break;
            }
            refused |= legs.at(instant, flatness, limits);
        }
        refused
    }
}

/// An instant u, and V(u) and A(u).
struct Instant {
    /// Share of the duration, in (0, 1).
    u: f64,
    /// V_j(u): T ṗ by the residue e_j.
    velocity: [f64; 4],
    /// A_j(u): T² p̈ by the residue e_j.
    acceleration: [f64; 4],
}

impl Instant {
    const fn at(u: f64) -> Self {
        let (mut velocity, mut acceleration) = ([0.0; 4], [0.0; 4]);
        let mut j = 0;
        while j < 4 {
            let m = [M[0][j], M[1][j], M[2][j], M[3][j]];
            velocity[j] = u * u * u * (4.0 * m[0] + u * (5.0 * m[1] + u * (6.0 * m[2] + u * 7.0 * m[3])));
            acceleration[j] = u * u * (12.0 * m[0] + u * (20.0 * m[1] + u * (30.0 * m[2] + u * 42.0 * m[3])));
            j += 1;
        }
        Self { u, velocity, acceleration }
    }
}

/// One axis: c₁, c₂, c₃ and e₀ … e₃.
#[derive(Clone, Copy)]
struct Axis {
    /// Coefficients of u, u², u³, m: velocity T, half the acceleration T², a sixth of the jerk T³ at the start.
    c: [f64x4; 3],
    /// What the cubic that leaves the start misses at the end, of value and first three derivatives by u, m.
    e: [f64x4; 4],
}

/// The legs from one state to another in four durations.
struct FourTimes<'a> {
    /// Durations, s.
    t: f64x4,
    /// x, y, z of the world.
    axes: [Axis; 3],
    /// Second time derivatives of the drag at both ends, N/s².
    drag_second: [&'a Vector3<f64>; 2],
}

impl<'a> FourTimes<'a> {
    /// Lanes beyond the last of `few` durations repeat it.
    #[inline(always)]
    fn new(from: &'a LegEnd, to: &'a LegEnd, few: &[f64]) -> Self {
        let t = f64x4::new(unrolled!([0, 1, 2, 3], |i| few[i.min(few.len() - 1)]));
        let (t2, t3) = (t * t, t * t * t);
        let axes = unrolled!(|i| {
            let c1 = t * from.velocity[i];
            let (c2, c3) = (t2 * (0.5 * from.acceleration[i]), t3 * (from.jerk[i] / 6.0));
            let e0 = f64x4::splat(to.position[i] - from.position[i]) - c1 - c2 - c3;
            let e1 = t * to.velocity[i] - c1 - c2 * 2.0 - c3 * 3.0;
            let e2 = t2 * to.acceleration[i] - c2 * 2.0 - c3 * 6.0;
            let e3 = t3 * to.jerk[i] - c3 * 6.0;
            Axis { c: [c1, c2, c3], e: [e0, e1, e2, e3] }
        });
        Self { t, axes, drag_second: [&from.drag_second, &to.drag_second] }
    }

    /// Rotor speeds at the ends: p⁗ T⁴ = 840 e₀ − 360 e₁ + 60 e₂ − 4 e₃ at the first, and −840 e₀ + 480 e₁ − 120 e₂ +
    /// 16 e₃ at the last.
    ///
    /// Snap is p⁗ = (…)/T⁴, so that F̈ = m p⁗ + D̈ (N/s²), of which x and y turn the body.
    #[inline(always)]
    fn at_ends(&self, flatness: &Flatness, body: &BodyLimits, mass: f64) -> u32 {
        let t2 = self.t * self.t;
        let mass = f64x4::splat(mass) / (t2 * t2);
        let ends = unrolled!([0, 1], |i| {
            let [e0, e1, e2, e3] = self.axes[i].e;
            let (first, last) =
                (e0 * 840.0 - e1 * 360.0 + e2 * 60.0 - e3 * 4.0, e1 * 480.0 - e0 * 840.0 - e2 * 120.0 + e3 * 16.0);
            let [from, to] = self.drag_second;
            [mass * first + f64x4::splat(from[i]), mass * last + f64x4::splat(to[i])]
        });
        let [x, y] = ends;
        let beyond = |end: usize| body.rotors_beyond(&flatness.level_rotors(&[x[end], y[end]]), ROUNDING);
        beyond(0) | beyond(1)
    }

    /// Speed, thrust and tilt at one instant.
    #[inline(always)]
    fn at(&self, instant: &Instant, flatness: &Flatness, body: &BodyLimits) -> u32 {
        let (u, per_s) = (instant.u, f64x4::ONE / self.t);
        let (v, a) = (&instant.velocity, &instant.acceleration);
        let velocity = unrolled!(|i| {
            let Axis { c, e } = &self.axes[i];
            let of_cubic = c[0] + (c[1] * 2.0 + c[2] * (3.0 * u)) * u;
            (of_cubic + e[0] * v[0] + e[1] * v[1] + e[2] * v[2] + e[3] * v[3]) * per_s
        });
        let acceleration = unrolled!(|i| {
            let Axis { c, e } = &self.axes[i];
            let of_cubic = c[1] * 2.0 + c[2] * (6.0 * u);
            (of_cubic + e[0] * a[0] + e[1] * a[1] + e[2] * a[2] + e[3] * a[3]) * per_s * per_s
        });
        let speed = Flatness::speed(&velocity);
        let force = flatness.force(&velocity, &acceleration, speed);
        body.force_beyond(speed, force[2], Flatness::speed(&force), ROUNDING)
    }
}

#[cfg(test)]
mod tests {
    use rand::RngExt;

    use super::super::tests::{flightgoggles, judge_of, plus, random_ends};
    use crate::feasibility::limits::Limits;
    use crate::feasibility::steering::LegTiming;
    use crate::math::random::stream;

    /// Legs are those that are judged one by one, and nearly all that are none are not judged.
    #[test]
    fn what_is_refused_is_no_leg() {
        let limits = |max_speed, max_tilt| Limits { max_speed, max_tilt };
        for (seed, (robot, limits)) in [flightgoggles(), plus()]
            .iter()
            .flat_map(|robot| {
                [limits(18.0, 1.2), limits(5.0, 0.6), limits(f64::INFINITY, 1.5)].map(|limits| (robot, limits))
            })
            .enumerate()
        {
            let judge = judge_of(robot, limits);
            let mut random = stream(seed as u64);
            let (mut legs, mut none, mut refused) = (0, 0, 0);
            for _ in 0..400 {
                let (from, to) = random_ends(&judge, &mut random, 4.0, 8.0);
                let shortest = random.random_range(0.2..1.0);
                let durations = LegTiming::ladder(shortest, 5.0 * shortest).rungs();
                let are_legs: Vec<bool> = durations.iter().map(|t| judge.judge(&from, &to, *t).is_ok()).collect();
                for (few, are_legs) in durations.chunks(4).zip(are_legs.chunks(4)) {
                    let mask = judge.refused(&from, &to, few);
                    for (i, is_leg) in are_legs.iter().enumerate() {
                        let is_refused = mask >> i & 1 == 1;
                        assert!(!(is_refused && *is_leg), "{} s of {robot:?}, {limits:?}", few[i]);
                        (legs, none) = (legs + usize::from(*is_leg), none + usize::from(!is_leg));
                        refused += usize::from(is_refused);
                    }
                }
                assert_eq!(judge.first(&from, &to, &durations), are_legs.iter().position(|is_leg| *is_leg));
            }
            assert!(legs > 50 && 100 * refused > 85 * none, "{legs} legs, {refused} of {none} refused at once");
        }
    }
}
