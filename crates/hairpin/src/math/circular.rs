//! Sine and cosine of many angles at once, without branches, so that compilers put them into SIMD lanes; only
//! additions and multiplications, so that every machine gives the same bits.
//!
//! Used where a million attitudes are integrated at once. Elsewhere `libm::sincos` is exact to a unit in the last place
//! and takes any angle.

/// 1.5 · 2⁵²: adding and subtracting it rounds to the nearest integer.
const ROUND: f64 = 6_755_399_441_055_744.0;
/// π in two parts; the first has 30 trailing zero bits, so that small multiples of it are exact.
const PI_HIGH: f64 = f64::from_bits(0x4009_21fb_4000_0000);
const PI_LOW: f64 = f64::from_bits(0x3e84_442d_1846_9899);

/// sin and cos of `angle` (rad, |angle| < 10⁶), each within 2·10⁻¹³.
///
/// angle = r + qπ with |r| ≤ π/2; Taylor polynomials in r, sign (−1)^q.
///
/// Reduction in two parts after Cody and Waite, "Software Manual for the Elementary Functions" (1980): q π₁ is exact
/// while |q| < 2³⁰, so that the absolute error of r stays near one of the angle's own units in the last place. Beyond
/// 10⁶ rad nothing is promised.
#[inline(always)]
pub fn sin_cos(angle: f64) -> (f64, f64) {
    let q = (angle * std::f64::consts::FRAC_1_PI + ROUND) - ROUND;
    let odd = q - 2.0 * ((0.5 * q + ROUND) - ROUND);
    let sign = 1.0 - 2.0 * odd * odd;
    let r = (angle - q * PI_HIGH) - q * PI_LOW;
    let z = r * r;
    let sin = 1.0
        + z * (SIN[0]
            + z * (SIN[1] + z * (SIN[2] + z * (SIN[3] + z * (SIN[4] + z * (SIN[5] + z * (SIN[6] + z * SIN[7])))))));
    let cos = 1.0
        + z * (COS[0]
            + z * (COS[1]
                + z * (COS[2]
                    + z * (COS[3] + z * (COS[4] + z * (COS[5] + z * (COS[6] + z * (COS[7] + z * COS[8]))))))));
    (sign * r * sin, sign * cos)
}

/// ∓1/(2k + 1)! and ∓1/(2k)!, k from 1.
const SIN: [f64; 8] = reciprocal_factorials(1.0);
const COS: [f64; 9] = reciprocal_factorials(0.0);

const fn reciprocal_factorials<const N: usize>(offset: f64) -> [f64; N] {
    let mut out = [0.0; N];
    let (mut factorial, mut k) = (1.0, 0);
    while k < N {
        let n = 2.0 * (k + 1) as f64 + offset;
        factorial *= -n * (n - 1.0);
        out[k] = 1.0 / factorial;
        k += 1;
    }
    out
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;

    #[test]
    fn agrees_with_libm() {
        let mut worst: f64 = 0.0;
        for i in -200_000..=200_000 {
            let angle = f64::from(i) * 1.234_567e-3;
            let (sin, cos) = sin_cos(angle);
            worst = worst.max((sin - libm::sin(angle)).abs()).max((cos - libm::cos(angle)).abs());
        }
        assert!(worst < 2e-13, "{worst:e}");
    }

    #[test]
    fn odd_and_even_to_the_bit() {
        for i in 0..20_000 {
            let angle = f64::from(i) * 7.654_321e-4;
            let ((sin, cos), (mirrored, same)) = (sin_cos(angle), sin_cos(-angle));
            assert_eq!((sin.to_bits(), cos.to_bits()), ((-mirrored).to_bits(), same.to_bits()), "{angle}");
        }
    }
}
