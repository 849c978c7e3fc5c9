//! Intervals with outward rounding, and centred forms over one parameter: what turns a computation into a proof.
//!
//! IEEE 754 rounds + − · ÷ √ to nearest, so that the true result lies within the neighbouring numbers of the computed
//! one: every operation widens its bounds to them. (Moore, Kearfott, Cloud, "Introduction to Interval Analysis", 2009,
//! ch. 2, 3 and 6.)
//!
//! ```text
//! f(T) ⊆ F(T)                                the natural extension: every operation replaced by its interval form
//! f(T) ⊆ F(m) + F′(T) (T − m)                the centred form, m in T
//! ```
//!
//! A comparison that holds for all numbers of the intervals holds for the real numbers behind them: what is "clear" by
//! [`Interval::low`] > 0 is proven, not measured. What does not hold is undecided, never false: widths grow with the
//! formula, and halving T narrows them again.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// All numbers from `low` to `high`.
///
/// Closed; low ≤ high. Infinite ends stand for "no bound". Operations turn NaN into no bound. Constants that doubles do
/// not hold (0.1) are the caller's to enclose.
///
/// ```
/// use hairpin::math::outward::Interval;
///
/// let third = Interval::point(1.0) / Interval::point(3.0); // ⅓ is no double, but lies inside
/// let one = third + third + third;
/// assert!(one.contains(1.0) && one.low < one.high && one.high - one.low < 1e-14);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interval {
    /// Lower bound.
    pub low: f64,
    /// Upper bound.
    pub high: f64,
}

impl Interval {
    /// Every number.
    pub const ALL: Self = Self { low: f64::NEG_INFINITY, high: f64::INFINITY };

    /// One number.
    pub const fn point(value: f64) -> Self {
        Self { low: value, high: value }
    }

    /// From the lesser to the greater of two numbers.
    pub fn between(a: f64, b: f64) -> Self {
        Self { low: a.min(b), high: a.max(b) }
    }

    /// Widened to the neighbouring numbers; NaN (∞ − ∞, 0 · ∞) becomes no bound at all.
    fn outward(low: f64, high: f64) -> Self {
        let low = if low.is_nan() { f64::NEG_INFINITY } else { low.next_down() };
        let high = if high.is_nan() { f64::INFINITY } else { high.next_up() };
        Self { low, high }
    }

    /// A number inside, near the middle.
    pub fn middle(self) -> f64 {
        (0.5 * self.low + 0.5 * self.high).clamp(self.low, self.high)
    }

    /// Whether `value` lies inside.
    pub fn contains(self, value: f64) -> bool {
        self.low <= value && value <= self.high
    }

    /// x², never negative.
    ///
    /// Tighter than x·x, which does not know that both factors are one number.
    pub fn square(self) -> Self {
        let magnitude = self.abs();
        let out = Self::outward(magnitude.low * magnitude.low, magnitude.high * magnitude.high);
        Self { low: out.low.max(0.0), high: out.high }
    }

    /// √max(x, 0).
    ///
    /// Arguments below 0 come from rounding of sums of squares; they count as 0.
    pub fn sqrt(self) -> Self {
        let out = Self::outward(self.low.max(0.0).sqrt(), self.high.max(0.0).sqrt());
        Self { low: out.low.max(0.0), high: out.high }
    }

    /// |x|.
    pub fn abs(self) -> Self {
        if self.low >= 0.0 {
            self
        } else if self.high <= 0.0 {
            -self
        } else {
            Self { low: 0.0, high: self.high.max(-self.low) }
        }
    }

    /// The lesser of two numbers.
    pub fn min(self, o: Self) -> Self {
        Self { low: self.low.min(o.low), high: self.high.min(o.high) }
    }

    /// The greater of two numbers.
    pub fn max(self, o: Self) -> Self {
        Self { low: self.low.max(o.low), high: self.high.max(o.high) }
    }

    /// The smallest interval around both.
    ///
    /// May hold numbers that neither does.
    pub fn hull(self, o: Self) -> Self {
        Self { low: self.low.min(o.low), high: self.high.max(o.high) }
    }

    /// What lies in both, given that both hold the same number.
    fn meet(self, o: Self) -> Self {
        Self { low: self.low.max(o.low), high: self.high.min(o.high) }
    }
}

impl Add for Interval {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        Self::outward(self.low + o.low, self.high + o.high)
    }
}

impl Sub for Interval {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        Self::outward(self.low - o.high, self.high - o.low)
    }
}

impl Neg for Interval {
    type Output = Self;
    fn neg(self) -> Self {
        Self { low: -self.high, high: -self.low }
    }
}

impl Mul for Interval {
    type Output = Self;
    fn mul(self, o: Self) -> Self {
        let all = [self.low * o.low, self.low * o.high, self.high * o.low, self.high * o.high];
        if all.iter().any(|x| x.is_nan()) {
            return Self::ALL;
        }
        let [low, high] =
            [all.iter().copied().fold(f64::INFINITY, f64::min), all.iter().copied().fold(f64::NEG_INFINITY, f64::max)];
        Self::outward(low, high)
    }
}

impl Div for Interval {
    type Output = Self;
    fn div(self, o: Self) -> Self {
        if !(o.low > 0.0 || o.high < 0.0) {
            return Self::ALL;
        }
        self * Self::outward(1.0 / o.high, 1.0 / o.low)
    }
}

/// What formulas are made of, so that one text serves numbers, intervals and centred forms.
///
/// Operations of [`Interval`] and [`Centred`] contain those of the numbers: f(x) ∈ F(X) for every x ∈ X, by induction
/// over the formula.
pub trait Real:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> + Neg<Output = Self>
{
    /// A constant.
    fn constant(value: f64) -> Self;
    /// x².
    fn square(self) -> Self;
    /// √max(x, 0).
    fn sqrt(self) -> Self;
    /// |x|.
    fn abs(self) -> Self;
    /// The lesser.
    fn min(self, o: Self) -> Self;
    /// The greater.
    fn max(self, o: Self) -> Self;
}

impl Real for f64 {
    fn constant(value: f64) -> Self {
        value
    }
    fn square(self) -> Self {
        self * self
    }
    fn sqrt(self) -> Self {
        f64::sqrt(f64::max(self, 0.0))
    }
    fn abs(self) -> Self {
        f64::abs(self)
    }
    fn min(self, o: Self) -> Self {
        f64::min(self, o)
    }
    fn max(self, o: Self) -> Self {
        f64::max(self, o)
    }
}

impl Real for Interval {
    fn constant(value: f64) -> Self {
        Self::point(value)
    }
    fn square(self) -> Self {
        Interval::square(self)
    }
    fn sqrt(self) -> Self {
        Interval::sqrt(self)
    }
    fn abs(self) -> Self {
        Interval::abs(self)
    }
    fn min(self, o: Self) -> Self {
        Interval::min(self, o)
    }
    fn max(self, o: Self) -> Self {
        Interval::max(self, o)
    }
}

/// A function of one parameter t on an interval T: its range, its value at the middle m of T, and the range of its
/// slope.
///
/// f(T) ⊆ range ∩ (f(m) + f′(T)(T − m)): bounds converge with the square of T's width, so that bisecting decides also
/// where a segment passes closely by. Where a formula has a kink the slope's range holds those of both sides (Lipschitz
/// slopes).
///
/// The mean value form of Moore, Kearfott, Cloud (2009); slopes over kinks as generalised gradients (Clarke,
/// "Optimization and Nonsmooth Analysis", 1983). Parameters of two operands must be the same T: constants have none and
/// go with any.
#[derive(Debug, Clone, Copy)]
pub struct Centred {
    range: Interval,
    middle: Interval,
    slope: Interval,
    /// T − m.
    offset: Interval,
}

impl Centred {
    /// The parameter itself on `t`.
    ///
    /// Slope 1, range T. The one source of dependence: what is built from it knows how it moves with t.
    pub fn parameter(t: Interval) -> Self {
        let m = Interval::point(t.middle());
        Self { range: t, middle: m, slope: Interval::point(1.0), offset: t - m }
    }

    /// Some number of an interval that does not depend on the parameter.
    ///
    /// For data that is known to an interval only. Its uncertainty does not shrink as T does.
    pub fn anywhere_in(range: Interval) -> Self {
        Self { range, middle: range, slope: Interval::point(0.0), offset: Interval::point(0.0) }
    }

    /// Bounds of the function on T.
    pub fn bounds(&self) -> Interval {
        self.range
    }

    fn new(range: Interval, middle: Interval, slope: Interval, offset: Interval) -> Self {
        Self { range: range.meet(middle + slope * offset), middle, slope, offset }
    }

    /// T − m of two operands: constants have none.
    fn offset(&self, o: &Self) -> Interval {
        self.offset.hull(o.offset)
    }

    /// Two operands of which one is taken: the slope of whichever can be.
    fn either(self, o: Self, range: Interval, middle: Interval, first: bool, second: bool) -> Self {
        let slope = match (first, second) {
            (true, _) => self.slope,
            (_, true) => o.slope,
            _ => self.slope.hull(o.slope),
        };
        Self::new(range, middle, slope, self.offset(&o))
    }
}

impl Add for Centred {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        Self::new(self.range + o.range, self.middle + o.middle, self.slope + o.slope, self.offset(&o))
    }
}

impl Sub for Centred {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        Self::new(self.range - o.range, self.middle - o.middle, self.slope - o.slope, self.offset(&o))
    }
}

impl Neg for Centred {
    type Output = Self;
    fn neg(self) -> Self {
        Self { range: -self.range, middle: -self.middle, slope: -self.slope, offset: self.offset }
    }
}

impl Mul for Centred {
    type Output = Self;
    fn mul(self, o: Self) -> Self {
        let slope = self.slope * o.range + self.range * o.slope;
        Self::new(self.range * o.range, self.middle * o.middle, slope, self.offset(&o))
    }
}

impl Div for Centred {
    type Output = Self;
    fn div(self, o: Self) -> Self {
        let slope = (self.slope * o.range - self.range * o.slope) / o.range.square();
        Self::new(self.range / o.range, self.middle / o.middle, slope, self.offset(&o))
    }
}

impl Real for Centred {
    fn constant(value: f64) -> Self {
        let value = Interval::point(value);
        Self { range: value, middle: value, slope: Interval::point(0.0), offset: Interval::point(0.0) }
    }
    fn square(self) -> Self {
        let slope = Interval::point(2.0) * self.range * self.slope;
        Self::new(self.range.square(), self.middle.square(), slope, self.offset)
    }
    fn sqrt(self) -> Self {
        let range = self.range.sqrt();
        // No finite slope at 0; ALL leaves the range as it is.
        let slope = if self.range.low > 0.0 { self.slope / (Interval::point(2.0) * range) } else { Interval::ALL };
        Self::new(range, self.middle.sqrt(), slope, self.offset)
    }
    fn abs(self) -> Self {
        let slope = if self.range.low >= 0.0 {
            self.slope
        } else if self.range.high <= 0.0 {
            -self.slope
        } else {
            self.slope.hull(-self.slope)
        };
        Self::new(self.range.abs(), self.middle.abs(), slope, self.offset)
    }
    fn min(self, o: Self) -> Self {
        let (first, second) = (self.range.high < o.range.low, o.range.high < self.range.low);
        self.either(o, self.range.min(o.range), self.middle.min(o.middle), first, second)
    }
    fn max(self, o: Self) -> Self {
        let (first, second) = (self.range.low > o.range.high, o.range.low > self.range.high);
        self.either(o, self.range.max(o.range), self.middle.max(o.middle), first, second)
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;
    use crate::math::random::{stream, unit};

    fn formulas<N: Real>(x: N, y: N) -> [N; 6] {
        let c = N::constant;
        [
            x * y - x.square(),
            (x - y).abs() / (x.square() + c(0.25)),
            (x * x + y * y).sqrt().min(c(0.7)),
            (x.max(y) - c(0.3)).square(),
            -(x * y * x) + (x.abs() + c(0.1)).sqrt(),
            x / y,
        ]
    }

    /// Values inside, bounds that shrink: linearly for intervals, with the square of the width for centred forms.
    #[test]
    fn bounds_hold_every_value_and_converge() {
        let mut random = stream(9);
        let mut narrower = 0;
        for case in 0..20_000 {
            let centre = unit(&mut random);
            let width = if case % 3 == 0 { 0.5 } else { 1e-3 } * unit(&mut random);
            let t = Interval::between((centre - width).max(0.0), (centre + width).min(1.0));
            let [a, b, c, d] = [0; 4].map(|_| 2.0 * unit(&mut random) - 1.0);
            let point = |t: f64| (a + b * t, c + d * t);
            let parameter = Centred::parameter(t);
            let k = Centred::constant;
            let centred = formulas(k(a) + k(b) * parameter, k(c) + k(d) * parameter);
            let i = Interval::point;
            let plain = formulas(i(a) + i(b) * t, i(c) + i(d) * t);
            for step in 0..=10 {
                let (x, y) = point((t.low + (t.high - t.low) * f64::from(step) / 10.0).clamp(t.low, t.high));
                for (n, value) in formulas(x, y).into_iter().enumerate() {
                    // The plain numbers round as well.
                    let slack = 1e-13 * (1.0 + value.abs());
                    for bounds in [centred[n].bounds(), plain[n]] {
                        let wide = Interval { low: bounds.low - slack, high: bounds.high + slack };
                        assert!(wide.contains(value) || value.is_nan(), "case {case}, formula {n}: {value} {bounds:?}");
                    }
                }
            }
            let spread = |bounds: Interval| bounds.high - bounds.low;
            narrower += usize::from(spread(centred[0].bounds()) <= spread(plain[0]));
        }
        assert!(narrower > 19_999, "{narrower}");
    }

    #[test]
    fn one_tenth_is_not_a_number_of_the_machine() {
        let tenth = Interval::point(1.0) / Interval::point(10.0);
        let sum = (0..10).fold(Interval::point(0.0), |sum, _| sum + tenth);
        assert!(sum.low < 1.0 && 1.0 < sum.high && sum.high - sum.low < 1e-14);
        let all = Interval::point(1.0) / Interval::between(-1.0, 1.0);
        assert_eq!(all, Interval::ALL);
        assert_eq!(Interval::point(0.0) * Interval::ALL, Interval::ALL);
        assert!(Interval::between(-2.0, 1.0).square().low == 0.0 && Interval::between(-2.0, 1.0).abs().high == 2.0);
    }
}
