//! Proven bounds of a function between samples: on a short interval a function is a line plus a bounded rest.
//!
//! A limit holds on a leg if it holds at every time of it, not at samples. A formula written against [`Smooth`] is
//! evaluated once on numbers, to see whether a sample violates, and once on enclosures of whole pieces, to see whether
//! anything between samples can: f > limit at a centre is a violation that is real; upper(f) ≤ limit is its absence,
//! proven up to rounding; else the piece is halved. The excess of upper(f) over the true maximum is O(h²), so that
//! pieces near no limit are settled at once. Four pieces are looked at together, one in each lane.

use std::ops::{Add, Div, Mul, Neg, Sub};

use wide::f64x4;

/// What a closed form needs of its numbers, so that one formula serves a point (`f64`), four points (`f64x4`) and
/// four intervals ([`Enclosure`]).
///
/// No division and no branch: quotients go through [`Smooth::recip`], whose answer says itself if it proves nothing, so
/// that lanes never part.
pub trait Smooth:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Mul<f64, Output = Self> + Neg<Output = Self>
{
    /// The constant function.
    fn constant(value: f64) -> Self;
    /// The square of the function.
    fn square(self) -> Self;
    /// Square root of a function that is nowhere negative.
    ///
    /// Of an enclosure by Taylor's formula with remainder where the function is bounded away from 0, and [0, √upper]
    /// where that is tighter: a norm that comes near 0 keeps a bound.
    fn sqrt(self) -> Self;
    /// Reciprocal; worthless (infinite or NaN) unless the function is proven positive.
    ///
    /// Of an enclosure: 1/(x₀ + δ) = 1/x₀ − δ/x₀² + δ²/(x₀²(x₀ + δ)), the last term bounded from below at x₀ + δ.
    fn recip(self) -> Self;
    /// `self / norm`, one component of the unit vector along a vector of length `norm`. Where the vector vanishes it
    /// has no direction: a point gives 0, the mean of all directions; an enclosure gives [−1, 1], which holds every
    /// one.
    fn direction(self, norm: Self) -> Self;
}

/// The numbers of an enclosure: one interval's (`f64`) or four intervals' (`f64x4`).
///
/// Loops over single intervals are compiled to vectors as wide as the machine's, where `f64x4` is two halves of it.
pub trait Lanes:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Mul<f64, Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// The same number on all lanes.
    fn splat(value: f64) -> Self;
    /// |x|.
    fn abs(self) -> Self;
    /// √x, NaN below 0.
    fn sqrt(self) -> Self;
    /// `yes` on the lanes that are greater than `limit`, `no` on the others, which includes NaN.
    fn above(self, limit: Self, yes: Self, no: Self) -> Self;
}

impl Lanes for f64 {
    #[inline(always)]
    fn splat(value: f64) -> Self {
        value
    }
    #[inline(always)]
    fn abs(self) -> Self {
        f64::abs(self)
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }
    #[inline(always)]
    fn above(self, limit: Self, yes: Self, no: Self) -> Self {
        if self > limit { yes } else { no }
    }
}

impl Lanes for f64x4 {
    #[inline(always)]
    fn splat(value: f64) -> Self {
        f64x4::splat(value)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        f64x4::abs(self)
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        f64x4::sqrt(self)
    }
    #[inline(always)]
    fn above(self, limit: Self, yes: Self, no: Self) -> Self {
        either(self.simd_gt(limit), yes, no)
    }
}

/// An interval, or four at once: on each the function is `middle + slope·u + r`, |u| ≤ 1, |r| ≤ `rest`.
///
/// A Taylor model of degree 1 (Makino, Berz, "Taylor models and other validated functional inclusion methods", 2003):
/// `middle` is the function's value at the interval's centre, so a violation there is real, and the bounds converge
/// with the square of the width. Rounding is not directed; who compares with a limit leaves room for it.
///
/// u = (t − t_c)/h for an interval of half width h around t_c. `middle` and `slope` are exact but for rounding, all
/// uncertainty is in `rest` ≥ 0; ∞ there is "no bound", which every comparison reads as "not proven".
///
/// ```
/// use hairpin::math::interval::{Enclosure, Smooth};
/// use wide::f64x4;
///
/// // t on [0.9, 1.1] in each of four lanes, and t² there: in truth [0.81, 1.21].
/// let t = Enclosure::taylor(&[f64x4::splat(1.0), f64x4::splat(1.0)], f64x4::splat(0.1));
/// let square = t.square();
/// assert!(square.lower().to_array()[0] <= 0.81 && square.upper().to_array()[0] >= 1.21);
/// assert!(square.upper().to_array()[0] < 1.22);
/// ```
#[derive(Debug, Clone, Copy)]
pub struct Enclosure<V = f64x4> {
    /// Value at the centre.
    pub middle: V,
    /// Slope times half the width.
    pub slope: V,
    /// Bound of what the line misses.
    pub rest: V,
}

impl<V: Lanes> Enclosure<V> {
    /// The enclosure of Σ d_k h^k/k! u^k, from the derivatives `d` at the centre and half the width `h`.
    ///
    /// Exact for polynomials whose derivatives are all given: `rest` = Σ_{k ≥ 2} |d_k| hᵏ/k!. `d[k]` has the unit of
    /// the value over sᵏ, `h` is in s and > 0. Of anything else the last derivative must be a bound over the whole
    /// interval, not its value at the centre.
    #[inline(always)]
    pub fn taylor(d: &[V], h: V) -> Self {
        let mut rest = V::splat(0.0);
        for k in (2..d.len()).rev() {
            rest = (rest + d[k].abs()) * h * (1.0 / k as f64);
        }
        // The loop nests |d₂| h/2 + |d₃| h²/(2·3) + …; one factor h is left.
        Self { middle: d[0], slope: d.get(1).map_or(V::splat(0.0), |d1| *d1 * h), rest: rest * h }
    }

    /// Lower bounds of the intervals.
    #[inline(always)]
    pub fn lower(&self) -> V {
        self.middle - self.slope.abs() - self.rest
    }

    /// Upper bounds of the intervals.
    #[inline(always)]
    pub fn upper(&self) -> V {
        self.middle + self.slope.abs() + self.rest
    }
}

impl<V: Lanes> Add for Enclosure<V> {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        Self { middle: self.middle + o.middle, slope: self.slope + o.slope, rest: self.rest + o.rest }
    }
}

impl<V: Lanes> Sub for Enclosure<V> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        Self { middle: self.middle - o.middle, slope: self.slope - o.slope, rest: self.rest + o.rest }
    }
}

impl<V: Lanes> Neg for Enclosure<V> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self { middle: -self.middle, slope: -self.slope, rest: self.rest }
    }
}

impl<V: Lanes> Mul<f64> for Enclosure<V> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, k: f64) -> Self {
        Self { middle: self.middle * k, slope: self.slope * k, rest: self.rest * k.abs() }
    }
}

impl<V: Lanes> Mul for Enclosure<V> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        // (a + a₁u + r)(b + b₁u + s): everything but the line goes to the rest.
        let a = self.middle.abs() + self.slope.abs();
        let b = o.middle.abs() + o.slope.abs();
        Self {
            middle: self.middle * o.middle,
            slope: self.middle * o.slope + self.slope * o.middle,
            rest: (self.slope * o.slope).abs() + a * o.rest + self.rest * (b + o.rest),
        }
    }
}

impl<V: Lanes> Smooth for Enclosure<V> {
    #[inline(always)]
    fn constant(value: f64) -> Self {
        Self { middle: V::splat(value), slope: V::splat(0.0), rest: V::splat(0.0) }
    }

    #[inline(always)]
    fn square(self) -> Self {
        let a = self.middle.abs() + self.slope.abs();
        Self {
            middle: self.middle * self.middle,
            slope: self.middle * self.slope * 2.0,
            rest: self.slope * self.slope + self.rest * (a + a + self.rest),
        }
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        // √(x₀ + δ) = √x₀ + δ/(2√x₀) − δ²/(8 ξ^{3/2}), ξ ≥ the lower bound; or, near zero, just [0, √upper].
        let (none, lower, upper) = (V::splat(0.0), self.lower(), self.upper());
        let root = self.middle.above(none, self.middle, none).sqrt();
        let half_inverse = V::splat(0.5) / root;
        let spread = self.slope.abs() + self.rest;
        let rest = self.rest * half_inverse + spread * spread / (lower * lower.sqrt() * 8.0);
        let slope = self.slope * half_inverse;
        let highest = upper.above(none, upper, none).sqrt();
        let above = highest - root;
        let widest = above.above(root, above, root);
        let tame = |yes, no| lower.above(none, highest.above(slope.abs() + rest, yes, no), no);
        Self { middle: root, slope: tame(slope, none), rest: tame(rest, widest) }
    }

    #[inline(always)]
    fn recip(self) -> Self {
        // 1/(x₀ + δ) = 1/x₀ − δ/x₀² + δ²/(x₀² (x₀ + δ)).
        let lower = self.lower();
        let inverse = V::splat(1.0) / self.middle;
        let square = inverse * inverse;
        let spread = self.slope.abs() + self.rest;
        let rest = square * (self.rest + spread * spread / lower);
        let rest = lower.above(V::splat(0.0), rest, V::splat(f64::INFINITY));
        Self { middle: inverse, slope: -self.slope * square, rest }
    }

    #[inline(always)]
    fn direction(self, norm: Self) -> Self {
        let (none, ratio) = (V::splat(0.0), self * norm.recip());
        // The centre keeps its direction where it has one; NaN and infinity are not tame.
        let middle = norm.middle.above(none, ratio.middle, none);
        let all = V::splat(1.0) + middle.abs();
        let tame = |yes, no| all.above(ratio.slope.abs() + ratio.rest, yes, no);
        Self { middle, slope: tame(ratio.slope, none), rest: tame(ratio.rest, all) }
    }
}

/// `yes` on the lanes of `mask`, whose bits are all set or none, `no` on the others. `wide`'s own is a call where it is
/// compiled for the baseline, with all lanes through memory.
#[inline(always)]
fn either(mask: f64x4, yes: f64x4, no: f64x4) -> f64x4 {
    no ^ ((no ^ yes) & mask)
}

/// max(x, 0), and 0 of NaN: without a call, as [`either`].
#[inline(always)]
fn positive_part(x: f64x4) -> f64x4 {
    x & x.simd_gt(f64x4::ZERO)
}

/// `[body at i = 0, body at i = 1, …]`, written out. `array::from_fn` and `array::map` leave calls where the body is as
/// large as sums of enclosures are, with their arguments in memory: a quarter of the time of judging a leg.
macro_rules! unrolled {
    (|$i:ident| $body:expr) => {
        $crate::math::interval::unrolled!([0, 1, 2], |$i| $body)
    };
    ([$($index:literal),*], |$i:ident| $body:expr) => {
        [$({
            let $i: usize = $index;
            $body
        }),*]
    };
}

pub(crate) use unrolled;

impl Smooth for f64 {
    #[inline(always)]
    fn constant(value: f64) -> Self {
        value
    }
    #[inline(always)]
    fn square(self) -> Self {
        self * self
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        self.max(0.0).sqrt()
    }
    #[inline(always)]
    fn recip(self) -> Self {
        1.0 / self
    }
    #[inline(always)]
    fn direction(self, norm: Self) -> Self {
        if norm > 0.0 { self / norm } else { 0.0 }
    }
}

impl Smooth for f64x4 {
    #[inline(always)]
    fn constant(value: f64) -> Self {
        f64x4::splat(value)
    }
    #[inline(always)]
    fn square(self) -> Self {
        self * self
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        f64x4::sqrt(positive_part(self))
    }
    #[inline(always)]
    fn recip(self) -> Self {
        f64x4::ONE / self
    }
    #[inline(always)]
    fn direction(self, norm: Self) -> Self {
        norm.simd_gt(f64x4::ZERO) & (self / norm)
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;
    use crate::math::random::stream;
    use rand::RngExt;

    /// Formulas over the whole vocabulary, with arguments that pass through zero.
    fn formulas<N: Smooth>(x: N, y: N) -> [N; 7] {
        let sum = x.square() + y.square();
        let norm = sum.sqrt();
        let inverse = (sum + N::constant(0.5)).recip();
        [
            x * y - x.square() * 0.5,
            -(x * x * x) + y,
            norm,
            inverse,
            (sum + N::constant(1e-3)).sqrt(),
            x.direction(norm) * y,
            (x * inverse + y.direction(norm)) * norm,
        ]
    }

    #[test]
    fn encloses_every_point_and_shrinks_with_the_square() {
        let mut widest = [[0.0f64; 2]; 7];
        for seed in 0..2000 {
            let mut random = stream(seed);
            let c: [[f64; 3]; 2] = std::array::from_fn(|_| std::array::from_fn(|_| random.random_range(-2.0..2.0)));
            let p = |axis: usize, u: f64| c[axis][0] + c[axis][1] * u + c[axis][2] * u * u;
            for (level, half) in [0.1, 0.01].into_iter().enumerate() {
                let center = if seed % 2 == 0 { 0.0 } else { random.random_range(-1.0..1.0) };
                let derivatives = |axis: usize| {
                    [p(axis, center), c[axis][1] + 2.0 * c[axis][2] * center, 2.0 * c[axis][2]].map(f64x4::splat)
                };
                let h = f64x4::splat(half);
                let [x, y] = [0, 1].map(|axis| Enclosure::taylor(&derivatives(axis), h));
                for (index, bound) in formulas(x, y).iter().enumerate() {
                    let (low, high) = (bound.lower().to_array()[2], bound.upper().to_array()[2]);
                    for k in 0..=50 {
                        let t = center + half * (k as f64 / 25.0 - 1.0);
                        let value = formulas(p(0, t), p(1, t))[index];
                        assert!(
                            value >= low - 1e-12 && value <= high + 1e-12,
                            "seed {seed}, formula {index}: {value} outside [{low}, {high}]"
                        );
                    }
                    if c[0][0].hypot(c[1][0]) > 1.0 && center == 0.0 {
                        widest[index][level] = widest[index][level].max(bound.rest.to_array()[2]);
                    }
                }
            }
        }
        for (index, [wide, narrow]) in widest.into_iter().enumerate() {
            assert!(narrow < wide / 80.0, "formula {index}: rest {wide} falls to {narrow} at a tenth of the width");
        }
    }

    #[test]
    fn lanes_are_chosen_to_the_bit() {
        let x = f64x4::new([-0.0, f64::NAN, f64::INFINITY, -1.5]);
        assert_eq!(positive_part(x).to_array().map(f64::to_bits), [0.0, 0.0, f64::INFINITY, 0.0].map(f64::to_bits));
        let mask = f64x4::new([1.0, 0.0, 1.0, 0.0]).simd_gt(f64x4::ZERO);
        let chosen = either(mask, x, f64x4::splat(f64::NEG_INFINITY)).to_array();
        let infinite = f64::NEG_INFINITY;
        assert_eq!(chosen.map(f64::to_bits), [-0.0, infinite, f64::INFINITY, infinite].map(f64::to_bits));
    }

    #[test]
    fn a_vanishing_vector_has_every_direction() {
        let zero: Enclosure = Enclosure::constant(0.0);
        let bound = zero.direction(zero);
        assert!(bound.lower().to_array()[0] <= -1.0 && bound.upper().to_array()[0] >= 1.0);
        assert_eq!(0.0f64.direction(0.0), 0.0);
    }
}
