//! Fresnel integrals, and what clothoids need of them.
//!
//! A clothoid is the path of a vehicle that turns its wheel at a constant rate per metre: κ(s) = κ₀ + q s. Its heading
//! is a quadratic of arc length and its position a Fresnel integral, so that drives made of lines, arcs and clothoids
//! end where closed forms say, without integration.

use std::f64::consts::{FRAC_PI_2, PI};

/// Below, the power series loses less than two digits to cancellation.
const SERIES_UP_TO: f64 = 1.6;

/// C(x) = ∫₀ˣ cos(πt²/2) dt and S(x) = ∫₀ˣ sin(πt²/2) dt, to 1e-14 or better; NaN for NaN.
///
/// Power series near zero, else the continued fraction of the complementary error function in the complex plane:
/// C + iS = (1 + i)/2 · erf(√π/2 · (1 − i) x). Abramowitz and Stegun 7.3.11, 7.3.13, 7.3.22, 7.1.14.
///
/// Odd in x; → (½, ½) as x → ∞, which is returned from 1e8 on. The continued fraction is cut where a term is below
/// 1e-17 of the sum.
pub fn fresnel(x: f64) -> (f64, f64) {
    let size = x.abs();
    if size <= SERIES_UP_TO {
        return series(x);
    }
    let (c, s) = if size >= 1e8 { (0.5, 0.5) } else { fraction(size) };
    if x < 0.0 { (-c, -s) } else { (c, s) }
}

/// Terms of the power series: at its seam the next one is below 1e-19.
const TERMS: usize = 19;

/// Coefficients of z²ⁿ in C/x and of z²ⁿ⁺¹ in S/x: (−1)ⁿ/((2n)! (4n + 1)) and (−1)ⁿ/((2n + 1)! (4n + 3)).
const COEFFICIENTS: [(f64, f64); TERMS] = {
    let mut all = [(0.0, 0.0); TERMS];
    let (mut n, mut power) = (0, 1.0);
    while n < TERMS {
        let even = 2.0 * n as f64;
        all[n].0 = power / (2.0 * even + 1.0);
        power /= even + 1.0;
        all[n].1 = power / (2.0 * even + 3.0);
        power /= -(even + 2.0);
        n += 1;
    }
    all
};

/// The power series in z = πx²/2.
fn series(x: f64) -> (f64, f64) {
    let z = FRAC_PI_2 * x * x;
    let square = z * z;
    let (mut c, mut s) = (0.0, 0.0);
    for (even, odd) in COEFFICIENTS.iter().rev() {
        c = c * square + even;
        s = s * square + odd;
    }
    (c * x, s * x * z)
}

/// The even form of the continued fraction of w · e^(w²) · erfc(w)·√π, w = √π/2 · (1 − i) x, so w² = −iπx²/2, by
/// Lentz's method in Steed's form: 1/(b₀ + a₁/(b₁ + a₂/(b₂ + …))), aₙ = −(2n − 1)(2n), bₙ = 1 − iπx² + 4n.
fn fraction(x: f64) -> (f64, f64) {
    let z = PI * x * x;
    let mut b = Complex { re: 1.0, im: -z };
    let mut d = b.inverse();
    let (mut h, mut step, mut n) = (d, d, 0.0);
    for _ in 0..200 {
        n += 1.0;
        let a = -(2.0 * n - 1.0) * (2.0 * n);
        b.re += 4.0;
        d = Complex { re: a * d.re + b.re, im: a * d.im + b.im }.inverse();
        step = step.times(Complex { re: b.re * d.re - b.im * d.im - 1.0, im: b.re * d.im + b.im * d.re });
        h = Complex { re: h.re + step.re, im: h.im + step.im };
        if step.re.abs() + step.im.abs() < 1e-17 * (h.re.abs() + h.im.abs()) {
            break;
        }
    }
    // C + iS = (1 + i)/2 · (1 − e^(iπx²/2) · (1 − i) x · h).
    let (sin, cos) = libm::sincos(FRAC_PI_2 * x * x);
    let tail = h.times(Complex { re: x, im: -x }).times(Complex { re: cos, im: sin });
    let end = Complex { re: 0.5, im: 0.5 }.times(Complex { re: 1.0 - tail.re, im: -tail.im });
    (end.re, end.im)
}

#[derive(Clone, Copy)]
struct Complex {
    re: f64,
    im: f64,
}

impl Complex {
    fn times(self, other: Self) -> Self {
        Self { re: self.re * other.re - self.im * other.im, im: self.re * other.im + self.im * other.re }
    }

    fn inverse(self) -> Self {
        let norm = self.re * self.re + self.im * self.im;
        Self { re: self.re / norm, im: -self.im / norm }
    }
}

/// Where a clothoid ends that begins at the origin along x and whose curvature goes from `start` to `end` (1/m) at
/// ± `rate` (1/m², > 0): x and y in m.
///
/// x + iy = ∫₀ᴸ exp(i (start·s + q s²/2)) ds with L = |end − start|/rate and q = (end − start)/L.
///
/// Completing the square, with σ = κ/√(π·rate) of either end: a phase exp(−iπσ₀²/2) times the difference of two Fresnel
/// integrals, scaled by √(π/rate). The length is |end − start|/rate, the heading (end² − start²)/(2·rate) with the sign
/// of end − start. Short clothoids (beside 1/√rate) are differences of nearly equal numbers: accurate absolutely, not
/// relatively. Source: Fraichard and Scheuer, "From Reeds and Shepp's to continuous-curvature paths", IEEE T-RO 20(6),
/// 2004.
///
/// ```
/// use hairpin::math::fresnel::clothoid;
///
/// // From straight on to a circle of 2 m within 1 m: turned by κL/2 = 0.25 rad.
/// let (x, y) = clothoid(0.0, 0.5, 0.5);
/// assert!((x - 0.9938).abs() < 1e-4 && (y - 0.0830).abs() < 1e-4);
/// ```
pub fn clothoid(start: f64, end: f64, rate: f64) -> (f64, f64) {
    // A falling curvature is the mirror image of a rising one.
    let mirror = if end < start { -1.0 } else { 1.0 };
    let (from, to) = (mirror * start, mirror * end);
    let scale = (PI * rate).sqrt();
    let (c0, s0) = fresnel(from / scale);
    let (c1, s1) = fresnel(to / scale);
    let (dx, dy) = (c1 - c0, s1 - s0);
    let (sin, cos) = libm::sincos(from * from / (2.0 * rate));
    let unit = scale / rate;
    (unit * (cos * dx + sin * dy), mirror * unit * (cos * dy - sin * dx))
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;

    /// Composite Simpson rule: shares nothing with series and fractions.
    fn integral(f: impl Fn(f64) -> f64, from: f64, to: f64, pieces: usize) -> f64 {
        let h = (to - from) / pieces as f64;
        let sum: f64 = (0..=pieces)
            .map(|i| f(from + i as f64 * h) * if i == 0 || i == pieces { 1.0 } else { [2.0, 4.0][i % 2] })
            .sum();
        sum * h / 3.0
    }

    #[test]
    fn agrees_with_quadrature_on_both_sides_of_the_seam() {
        for i in -60..=60 {
            let x = f64::from(i) * 0.1 + 0.003;
            let (c, s) = fresnel(x);
            let pieces = 40_000;
            let c_quadrature = integral(|t| (FRAC_PI_2 * t * t).cos(), 0.0, x, pieces);
            let s_quadrature = integral(|t| (FRAC_PI_2 * t * t).sin(), 0.0, x, pieces);
            assert!((c - c_quadrature).abs() < 1e-12 && (s - s_quadrature).abs() < 1e-12, "{x}: {c} {s}");
        }
    }

    #[test]
    fn published_values_limits_and_symmetry() {
        // Abramowitz and Stegun, table 7.7, to its seven digits.
        for (x, c, s) in
            [(0.5, 0.492_344_2, 0.064_732_4), (1.0, 0.779_893_4, 0.438_259_1), (2.0, 0.488_253_4, 0.343_415_7)]
        {
            let found = fresnel(x);
            assert!((found.0 - c).abs() < 1e-7 && (found.1 - s).abs() < 1e-7, "{x}: {found:?}");
            assert_eq!(fresnel(-x), (-found.0, -found.1));
        }
        assert_eq!(fresnel(0.0), (0.0, 0.0));
        assert_eq!(fresnel(f64::INFINITY), (0.5, 0.5));
        assert!(fresnel(f64::NAN).0.is_nan());
        let (below, above) = (fresnel(SERIES_UP_TO), fresnel(SERIES_UP_TO + 1e-15));
        assert!((below.0 - above.0).abs() < 1e-13 && (below.1 - above.1).abs() < 1e-13);
        // The far end: C → 1/2 + sin(πx²/2)/(πx).
        let x: f64 = 50.3;
        assert!((fresnel(x).0 - 0.5 - (FRAC_PI_2 * x * x).sin() / (PI * x)).abs() < 1e-6);
    }

    #[test]
    fn clothoids_end_where_quadrature_says() {
        for (start, end, rate) in
            [(0.0, 1.0, 1.0), (1.0, 0.0, 1.0), (-0.7, 0.4, 0.3), (0.9, -0.8, 2.0), (0.2, 0.3, 0.01)]
        {
            let length = f64::abs(end - start) / rate;
            let slope = (end - start) / length;
            let heading = |s: f64| start * s + 0.5 * slope * s * s;
            let x = integral(|s| heading(s).cos(), 0.0, length, 20_000);
            let y = integral(|s| heading(s).sin(), 0.0, length, 20_000);
            let found = clothoid(start, end, rate);
            assert!((found.0 - x).abs() < 1e-12 && (found.1 - y).abs() < 1e-12, "{start} {end} {rate}: {found:?}");
        }
        assert_eq!(clothoid(0.5, 0.5, 1.0), (0.0, 0.0));
    }
}
