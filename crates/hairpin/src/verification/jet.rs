//! Truncated Taylor series in time: c0 + c1 t + c2 t². Differentiation becomes arithmetic.
//!
//! a + b t + c t² with products, reciprocals and roots cut after t²: derivatives to second order without differences
//! and without a formula for each.

use std::ops::{Add, Mul, Sub};

/// c0 + c1 t + c2 t² + O(t³).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Jet(pub(super) [f64; 3]);

/// Three components.
pub(super) type JetVector = [Jet; 3];

impl Jet {
    /// The series of 0.
    pub(super) const ZERO: Self = Self([0.0; 3]);

    /// c0: the value now.
    pub(super) fn value(self) -> f64 {
        self.0[0]
    }

    /// The series of the derivative, to first order; its last coefficient is unknown and set to 0.
    pub(super) fn rate(self) -> Self {
        Self([self.0[1], 2.0 * self.0[2], 0.0])
    }

    /// √self; the value must be positive.
    ///
    /// r² = a, 2 r r₁ = b, 2 r r₂ + r₁² = c.
    pub(super) fn sqrt(self) -> Self {
        let [a, b, c] = self.0;
        let root = a.sqrt();
        let first = b / (2.0 * root);
        Self([root, first, (c - first * first) / (2.0 * root)])
    }

    /// 1/self; the value must not be zero.
    ///
    /// 1/a, −b/a², b²/a³ − c/a².
    pub(super) fn recip(self) -> Self {
        let [a, b, c] = self.0;
        let r = 1.0 / a;
        Self([r, -b * r * r, (b * b * r - c) * r * r])
    }

    /// A number times the series.
    pub(super) fn scaled(self, factor: f64) -> Self {
        Self(self.0.map(|c| c * factor))
    }
}

impl Add for Jet {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self([self.0[0] + other.0[0], self.0[1] + other.0[1], self.0[2] + other.0[2]])
    }
}

impl Sub for Jet {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self([self.0[0] - other.0[0], self.0[1] - other.0[1], self.0[2] - other.0[2]])
    }
}

/// (a + bt + ct²)(d + et + ft²) cut after t²: ad, ae + bd, af + be + cd.
impl Mul for Jet {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let ([a, b, c], [d, e, f]) = (self.0, other.0);
        Self([a * d, a * e + b * d, a * f + b * e + c * d])
    }
}

/// a · b, to second order.
pub(super) fn dot(a: &JetVector, b: &JetVector) -> Jet {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// a × b, to second order.
pub(super) fn cross(a: &JetVector, b: &JetVector) -> JetVector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Each component times one series.
pub(super) fn times(a: &JetVector, factor: Jet) -> JetVector {
    a.map(|component| component * factor)
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;

    #[test]
    fn series_are_those_of_the_functions() {
        let x = Jet([1.7, -0.4, 0.9]);
        let at = |t: f64| 1.7 - 0.4 * t + 0.9 * t * t;
        let h = 1e-4;
        let check = |jet: Jet, f: &dyn Fn(f64) -> f64| {
            let first = (f(h) - f(-h)) / (2.0 * h);
            let second = (f(h) - 2.0 * f(0.0) + f(-h)) / (2.0 * h * h);
            assert!((jet.0[0] - f(0.0)).abs() < 1e-14, "{jet:?}");
            assert!((jet.0[1] - first).abs() < 1e-6 && (jet.0[2] - second).abs() < 1e-6, "{jet:?} {first} {second}");
        };
        check(x.sqrt(), &|t| at(t).sqrt());
        check(x.recip(), &|t| 1.0 / at(t));
        check(x * x.sqrt(), &|t| at(t).powf(1.5));
    }
}
