//! Gauss–Legendre quadrature on [0, 1], its nodes computed by the compiler.

/// Nodes and weights of the rule with `N` points: exact for polynomials up to degree 2N − 1.
///
/// ∫₀ᴸ f(s) ds ≈ L Σ w_i f(L x_i), with the error (N!)⁴ / ((2N + 1) ((2N)!)³) · L²ᴺ⁺¹ f⁽²ᴺ⁾(ξ): a smooth integrand that
/// bends little over L costs few points. Golub and Welsch, Math. Comp. 23 (1969) have the theory; here N is small
/// enough for Newton from the usual cosines.
///
/// ```
/// use hairpin::math::quadrature::Gauss;
///
/// let rule = Gauss::<5>::RULE;
/// let integral: f64 = rule.nodes.iter().zip(&rule.weights).map(|(t, w)| w * t.powi(9)).sum();
/// assert!((integral - 0.1).abs() < 1e-15); // ∫ t⁹ dt, exact to degree 9
/// ```
#[derive(Debug, Clone, Copy)]
pub struct Gauss<const N: usize> {
    /// Rising, within (0, 1).
    pub nodes: [f64; N],
    /// Positive; their sum is 1.
    pub weights: [f64; N],
}

impl<const N: usize> Gauss<N> {
    /// The rule. Nodes are the roots of the Legendre polynomial `P_N(2t − 1)`, found by Newton's method.
    pub const RULE: Self = Self::new();

    /// Roots of the Legendre polynomial P_N by Newton's method from cos(π(i + ¾)/(N + ½)), weights 1/((1 − x²) P_N′²)
    /// for the unit interval; at compile time.
    const fn new() -> Self {
        let mut rule = Self { nodes: [0.0; N], weights: [0.0; N] };
        let mut i = 0;
        while i < N.div_ceil(2) {
            let mut x =
                if 2 * i + 1 == N { 0.0 } else { cosine(std::f64::consts::PI * (i as f64 + 0.75) / (N as f64 + 0.5)) };
            let mut newton = 0;
            while newton < 8 {
                let (p, slope) = legendre(N, x);
                x -= p / slope;
                newton += 1;
            }
            let (_, slope) = legendre(N, x);
            let weight = 1.0 / ((1.0 - x * x) * slope * slope);
            rule.nodes[i] = 0.5 - 0.5 * x;
            rule.nodes[N - 1 - i] = 0.5 + 0.5 * x;
            rule.weights[i] = weight;
            rule.weights[N - 1 - i] = weight;
            i += 1;
        }
        rule
    }
}

/// `P_n(x)` and its derivative, |x| < 1.
const fn legendre(n: usize, x: f64) -> (f64, f64) {
    let (mut before, mut p) = (1.0, x);
    let mut k = 2;
    while k <= n {
        let next = ((2 * k - 1) as f64 * x * p - (k - 1) as f64 * before) / k as f64;
        before = p;
        p = next;
        k += 1;
    }
    (p, n as f64 * (x * p - before) / (x * x - 1.0))
}

/// cos x for 0 ≤ x ≤ π/2 to a few digits: a start value.
const fn cosine(x: f64) -> f64 {
    let z = x * x;
    1.0 - z / 2.0 * (1.0 - z / 12.0 * (1.0 - z / 30.0 * (1.0 - z / 56.0)))
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;

    fn integrates_monomials<const N: usize>() {
        let rule = Gauss::<N>::RULE;
        assert!(rule.nodes.windows(2).all(|pair| pair[0] < pair[1]));
        for degree in 0..2 * N as i32 {
            let sum: f64 = rule.nodes.iter().zip(&rule.weights).map(|(t, w)| w * t.powi(degree)).sum();
            assert!((sum - 1.0 / f64::from(degree + 1)).abs() < 1e-14, "{N} points, degree {degree}: {sum}");
        }
        // The first degree beyond is not exact, by the known remainder n!⁴ / ((2n)!² (2n + 1)) of the monic polynomial.
        let sum: f64 = rule.nodes.iter().zip(&rule.weights).map(|(t, w)| w * t.powi(2 * N as i32)).sum();
        let binomial: f64 = (1..=N).map(|k| (N + k) as f64 / k as f64).product();
        let remainder = 1.0 / (binomial * binomial * (2 * N + 1) as f64);
        if remainder > 1e-12 {
            assert!(((1.0 / (2 * N + 1) as f64 - sum) / remainder - 1.0).abs() < 1e-3, "{N} points");
        }
    }

    #[test]
    fn polynomials_are_integrated_exactly_up_to_their_degree() {
        integrates_monomials::<1>();
        integrates_monomials::<2>();
        integrates_monomials::<3>();
        integrates_monomials::<4>();
        integrates_monomials::<7>();
        integrates_monomials::<32>();
    }
}
