//! The legs from one state to eight others at one duration: which of them cannot be, told without making any.
//!
//! Of all pairs of states and durations of a ladder nearly all are none, and nearly all of these for what the body
//! would have to do at a few instants. With u = τ/T and e the residues of [`crate::math::polynomial::septic`], an axis
//! is
//!
//! ```text
//! p = c₀ + c₁u + c₂u² + c₃u³ + Σ_{k=4}^{7} b_k uᵏ,      b = M e
//! T ṗ = c₁ + 2c₂u + 3c₃u² + Σ_j V_j(u) e_j              V_j = Σ_k k M_kj uᵏ⁻¹
//! T² p̈ = 2c₂ + 6c₃u + Σ_j A_j(u) e_j                    A_j = Σ_k k (k−1) M_kj uᵏ⁻²
//! ```
//!
//! where V and A are numbers at a given u, and all that the first state decides is one number for all eight.
//!
//! The limits asked are those of [`super::LegJudge::judge`], which holds them at every instant, with 10⁻⁷ of room,
//! since the same quantities come out of other formulas here: a leg that is refused here is refused there, while one
//! that passes here may still fail there. Walls and obstacles are not asked.

use super::flatness::Flatness;
use super::leg_end::LegEnd;
use super::proof::BodyLimits;
use crate::math::interval::unrolled;
use crate::math::minimum_snap::HIGH_ORDERS as M;
use crate::math::simd::at_every_level;

/// States that are looked at together.
pub(super) const LANES: usize = 8;
/// More than rounding can make of a demand, as a share of its limit.
const ROUNDING: f64 = 1e-7;
/// Instants that are looked at before the ends, which refuse few that these do not.
const AT_ENDS: usize = 2;
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

/// Demands, limits and mass of a body.
type Body<'a> = (&'a Flatness, &'a BodyLimits, f64);

at_every_level! {
    /// Which of the legs from one state to eight others in a `duration` (s, > 0) are refused by more than rounding, for
    /// what `body` would have to do at the ends or at nine instants: bit i for state number i.
    ///
    /// What is left need not be a leg; what is refused is none by [`super::LegJudge::judge`]. A duration that gives NaN
    /// is not refused, and is left to the judge. Nothing more is looked at where all of `open` are refused.
    ///
    /// `left` is what is left of the open ones of each of `to`.
    pub(super) fn refuse(body: Body<'_>, from: &LegEnd, to: &[Open<'_>], duration: f64, left: &mut [u32]) {
        let leaving = Leaving::new(from, duration);
        let speed = leaving.speed(&INSTANTS[0]);
        for (Open { ends, open }, left) in to.iter().zip(left) {
            *left = *open;
            if *left == 0 {
                continue;
            }
            *left &= !speed.too_fast(body.1, from, ends);
            if *left == 0 {
                continue;
            }
            let e = leaving.residues(from, ends);
            for (number, instant) in INSTANTS.iter().enumerate() {
                if number == AT_ENDS {
                    *left &= !leaving.at_ends(body, from, ends, &e);
                }
                *left &= !leaving.at(instant, body, &e);
                if *left == 0 {
                    break;
                }
            }
        }
    }
}

/// Eight states, and which of them are asked: bit i for state number i.
#[derive(Clone, Copy)]
pub(super) struct Open<'e> {
    pub(super) ends: &'e Ends,
    pub(super) open: u32,
}

/// Speed at an instant: what the first state and the duration decide of it.
struct Speed {
    /// m/s.
    own: [f64; 3],
    /// By way, velocity, acceleration and jerk of the other state.
    by: [f64; 4],
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

/// States that legs lead to, one a lane.
#[derive(Debug)]
pub(crate) struct Ends {
    position: [[f64; LANES]; 3],
    velocity: [[f64; LANES]; 3],
    acceleration: [[f64; LANES]; 3],
    jerk: [[f64; LANES]; 3],
    /// Of x and y.
    drag_second: [[f64; LANES]; 2],
}

impl Ends {
    /// One to eight states; lanes beyond the last repeat it.
    pub(super) fn new(ends: &[LegEnd]) -> Self {
        let none = [0.0; LANES];
        let mut lanes = Self {
            position: [none; 3],
            velocity: [none; 3],
            acceleration: [none; 3],
            jerk: [none; 3],
            drag_second: [none; 2],
        };
        for lane in 0..LANES {
            let end = &ends[lane.min(ends.len() - 1)];
            for axis in 0..3 {
                lanes.position[axis][lane] = end.position[axis];
                lanes.velocity[axis][lane] = end.velocity[axis];
                lanes.acceleration[axis][lane] = end.acceleration[axis];
                lanes.jerk[axis][lane] = end.jerk[axis];
            }
            lanes.drag_second[0][lane] = end.drag_second[0];
            lanes.drag_second[1][lane] = end.drag_second[1];
        }
        lanes
    }
}

/// What the cubic that leaves the start misses at the ends, of value and first three derivatives by u, m: e₀ … e₃ of
/// every axis.
type Residues = [[[f64; LANES]; 4]; 3];

/// The legs from one state in one duration.
struct Leaving {
    /// Duration, s.
    t: f64,
    /// c₁, c₂, c₃ of every axis: coefficients of u, u², u³, m: velocity T, half the acceleration T², a sixth of the
    /// jerk T³ at the start.
    c: [[f64; 3]; 3],
}

impl Leaving {
    #[inline(always)]
    fn new(from: &LegEnd, t: f64) -> Self {
        let (t2, t3) = (t * t, t * t * t);
        let c = unrolled!(|i| [t * from.velocity[i], t2 * (0.5 * from.acceleration[i]), t3 * (from.jerk[i] / 6.0)]);
        Self { t, c }
    }

    /// The residues of the legs to `to`.
    #[inline(always)]
    #[expect(clippy::needless_range_loop, reason = "lanes of several arrays, which become one vector each")]
    fn residues(&self, from: &LegEnd, to: &Ends) -> Residues {
        let (t, t2, t3) = (self.t, self.t * self.t, self.t * self.t * self.t);
        let mut e = [[[0.0; LANES]; 4]; 3];
        for (axis, e) in e.iter_mut().enumerate() {
            let ([c1, c2, c3], start) = (self.c[axis], from.position[axis]);
            for lane in 0..LANES {
                e[0][lane] = to.position[axis][lane] - start - c1 - c2 - c3;
                e[1][lane] = t * to.velocity[axis][lane] - c1 - c2 * 2.0 - c3 * 3.0;
                e[2][lane] = t2 * to.acceleration[axis][lane] - c2 * 2.0 - c3 * 6.0;
                e[3][lane] = t3 * to.jerk[axis][lane] - c3 * 6.0;
            }
        }
        e
    }

    /// Speed alone at one instant, which refuses most.
    #[inline(always)]
    fn speed(&self, instant: &Instant) -> Speed {
        let (u, t, v) = (instant.u, self.t, &instant.velocity);
        let own = unrolled!(|i| {
            let [c1, c2, c3] = self.c[i];
            let of_cubic = c1 + (c2 * 2.0 + c3 * (3.0 * u)) * u;
            let missed = [-c1 - c2 - c3, -c1 - c2 * 2.0 - c3 * 3.0, -c2 * 2.0 - c3 * 6.0, -c3 * 6.0];
            (of_cubic + dot(&missed, v)) / t
        });
        Speed { own, by: [v[0] / t, v[1], v[2] * t, v[3] * t * t] }
    }

    /// Rotor speeds at the ends: p⁗ T⁴ = 840 e₀ − 360 e₁ + 60 e₂ − 4 e₃ at the first, and −840 e₀ + 480 e₁ − 120 e₂ +
    /// 16 e₃ at the last.
    ///
    /// Snap is p⁗ = (…)/T⁴, so that F̈ = m p⁗ + D̈ (N/s²), of which x and y turn the body.
    #[inline(always)]
    fn at_ends(&self, body: Body, from: &LegEnd, to: &Ends, e: &Residues) -> u32 {
        let (flatness, limits, mass) = body;
        let mass = mass / (self.t * self.t * self.t * self.t);
        let mut beyond = [0; LANES];
        for (lane, beyond) in beyond.iter_mut().enumerate() {
            let ends = unrolled!([0, 1], |i| {
                let [e0, e1, e2, e3] = unrolled!([0, 1, 2, 3], |j| e[i][j][lane]);
                let first = e0 * 840.0 - e1 * 360.0 + e2 * 60.0 - e3 * 4.0;
                let last = e1 * 480.0 - e0 * 840.0 - e2 * 120.0 + e3 * 16.0;
                [mass * first + from.drag_second[i], mass * last + to.drag_second[i][lane]]
            });
            let [x, y] = ends;
            let first = limits.rotors_beyond(&flatness.level_rotors(&[x[0], y[0]]), ROUNDING);
            *beyond = u64::from(first | limits.rotors_beyond(&flatness.level_rotors(&[x[1], y[1]]), ROUNDING));
        }
        mask(&beyond)
    }

    /// Speed, thrust and tilt at one instant.
    #[inline(always)]
    fn at(&self, instant: &Instant, body: Body, e: &Residues) -> u32 {
        let (flatness, limits, _) = body;
        let (u, per_s) = (instant.u, 1.0 / self.t);
        let (v, a) = (&instant.velocity, &instant.acceleration);
        let cubic = unrolled!(|i| {
            let [c1, c2, c3] = self.c[i];
            [c1 + (c2 * 2.0 + c3 * (3.0 * u)) * u, c2 * 2.0 + c3 * (6.0 * u)]
        });
        let mut beyond = [0; LANES];
        for (lane, beyond) in beyond.iter_mut().enumerate() {
            let e = unrolled!(|i| unrolled!([0, 1, 2, 3], |j| e[i][j][lane]));
            let velocity = unrolled!(|i| (cubic[i][0] + dot(&e[i], v)) * per_s);
            let acceleration = unrolled!(|i| (cubic[i][1] + dot(&e[i], a)) * per_s * per_s);
            let speed = Flatness::speed(&velocity);
            let force = flatness.force(&velocity, &acceleration, speed);
            *beyond = u64::from(limits.force_beyond(speed, force[2], Flatness::speed(&force), ROUNDING));
        }
        mask(&beyond)
    }
}

impl Speed {
    #[inline(always)]
    fn too_fast(&self, limits: &BodyLimits, from: &LegEnd, to: &Ends) -> u32 {
        let Self { own, by } = self;
        let mut beyond = [0; LANES];
        for (lane, beyond) in beyond.iter_mut().enumerate() {
            let velocity = unrolled!(|i| {
                let way = to.position[i][lane] - from.position[i];
                own[i] + dot(&[way, to.velocity[i][lane], to.acceleration[i][lane], to.jerk[i][lane]], by)
            });
            let square = velocity[0] * velocity[0] + velocity[1] * velocity[1] + velocity[2] * velocity[2];
            *beyond = u64::from(limits.is_faster(square, ROUNDING));
        }
        mask(&beyond)
    }
}

#[inline(always)]
fn dot(a: &[f64; 4], b: &[f64; 4]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]
}

/// Bit i for lane number i: lanes are numbers, so that the loops over them have no branch and are compiled to vectors.
#[inline(always)]
pub(super) fn mask(&[a, b, c, d, e, f, g, h]: &[u64; LANES]) -> u32 {
    (a | b << 1 | c << 2 | d << 3 | e << 4 | f << 5 | g << 6 | h << 7) as u32
}

#[cfg(feature = "unit-tests")]
mod tests {
    use rand::RngExt;

    use super::super::leg_end::LegEnd;
    use super::super::tests::{flightgoggles, judge_of, plus, random_ends};
    use super::{Ends, Open};
    use crate::feasibility::limits::Limits;
    use crate::feasibility::steering::LegTiming;
    use crate::math::random::stream;

    /// What is refused is no leg, whatever lies beside it, and nearly all that are none are refused.
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
            for draw in 0..400 {
                let (from, to) = random_ends(&judge, &mut random, 4.0, 8.0);
                let others = (0..draw % 5).map(|_| random_ends(&judge, &mut random, 4.0, 8.0).1);
                let to: Vec<LegEnd> = std::iter::once(to).chain(others).collect();
                let shortest = random.random_range(0.2..1.0);
                let durations = LegTiming::ladder(shortest, 5.0 * shortest).rungs();
                let is_leg = |to: &LegEnd, t: f64| judge.judge(&from, to, t).is_ok();
                for &t in &durations {
                    let mut left = [0];
                    judge.refuse(&from, &[Open { ends: &Ends::new(&to), open: u32::MAX }], t, &mut left);
                    for (i, to) in to.iter().enumerate() {
                        let (is_leg, is_refused) = (is_leg(to, t), left[0] >> i & 1 == 0);
                        assert!(!(is_refused && is_leg), "{t} s of {robot:?}, {limits:?}");
                        (legs, none) = (legs + usize::from(is_leg), none + usize::from(!is_leg));
                        refused += usize::from(is_refused);
                    }
                }
            }
            assert!(legs > 50 && 100 * refused > 85 * none, "{legs} legs, {refused} of {none} refused at once");
        }
    }
}
