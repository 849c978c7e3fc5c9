//! Truncated Taylor series in time over numbers or intervals: c0 + c1 t + c2 t². Over intervals the coefficients hold
//! those at every moment of a stretch of time.

use std::ops::{Add, Mul, Neg, Sub};

use crate::math::outward::{Interval, Real};

/// What series need of their numbers beside [`Real`].
pub(super) trait Angle: Real {
    /// (sin x, cos x).
    fn sine_and_cosine(self) -> (Self, Self);
    /// The slope of |x|: −1 to 1 where the sign is not known.
    ///
    /// Of 0 it is 1; an interval that holds 0 inside has no sign.
    fn sign(self) -> Self;
}

impl Angle for f64 {
    fn sine_and_cosine(self) -> (Self, Self) {
        libm::sincos(self)
    }

    fn sign(self) -> Self {
        if self < 0.0 { -1.0 } else { 1.0 }
    }
}

/// Beyond what `libm` may be off by, twice over.
const OFF: f64 = 1e-15;

impl Angle for Interval {
    /// |sin x − sin m| ≤ |x − m|, and so the cosine.
    fn sine_and_cosine(self) -> (Self, Self) {
        let m = self.middle();
        let spread = (self.high - m).max(m - self.low).next_up() + OFF;
        let (sin, cos) = libm::sincos(m);
        let around = |value: f64| {
            let range = Interval { low: value - spread, high: value + spread };
            if spread.is_finite() {
                Interval { low: range.low.next_down().max(-1.0), high: range.high.next_up().min(1.0) }
            } else {
                Interval { low: -1.0, high: 1.0 }
            }
        };
        (around(sin), around(cos))
    }

    fn sign(self) -> Self {
        if self.low >= 0.0 {
            Interval::point(1.0)
        } else if self.high <= 0.0 {
            Interval::point(-1.0)
        } else {
            Interval { low: -1.0, high: 1.0 }
        }
    }
}

/// c0 + c1 t + c2 t² + O(t³).
#[derive(Debug, Clone, Copy)]
pub(super) struct Series<N>(pub(super) [N; 3]);

impl<N: Angle> Series<N> {
    pub(super) fn constant(value: f64) -> Self {
        Self([N::constant(value), N::constant(0.0), N::constant(0.0)])
    }

    pub(super) fn scaled(self, factor: f64) -> Self {
        Self(self.0.map(|c| c * N::constant(factor)))
    }

    /// The series of the derivative, to first order; its last coefficient is unknown and set to 0.
    pub(super) fn rate(self) -> Self {
        Self([self.0[1], self.0[2] * N::constant(2.0), N::constant(0.0)])
    }

    /// |self| to first order; its last coefficient is unknown and set to 0.
    pub(super) fn abs(self) -> Self {
        Self([self.0[0].abs(), self.0[0].sign() * self.0[1], N::constant(0.0)])
    }

    /// (sin, cos): sin(a + bt + ct²) = sin a + b cos a t + (c cos a − b²/2 sin a) t².
    pub(super) fn sine_and_cosine(self) -> (Self, Self) {
        let [a, b, c] = self.0;
        let (sin, cos) = a.sine_and_cosine();
        let half = b.square() * N::constant(0.5);
        (Self([sin, b * cos, c * cos - half * sin]), Self([cos, -(b * sin), -(c * sin) - half * cos]))
    }
}

impl<N: Angle> Add for Series<N> {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        Self([self.0[0] + o.0[0], self.0[1] + o.0[1], self.0[2] + o.0[2]])
    }
}

impl<N: Angle> Sub for Series<N> {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        Self([self.0[0] - o.0[0], self.0[1] - o.0[1], self.0[2] - o.0[2]])
    }
}

impl<N: Angle> Neg for Series<N> {
    type Output = Self;
    fn neg(self) -> Self {
        Self(self.0.map(|c| -c))
    }
}

impl<N: Angle> Mul for Series<N> {
    type Output = Self;
    fn mul(self, o: Self) -> Self {
        let ([a, b, c], [d, e, f]) = (self.0, o.0);
        Self([a * d, a * e + b * d, a * f + b * e + c * d])
    }
}
