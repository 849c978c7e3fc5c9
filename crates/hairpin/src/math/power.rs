//! Whole powers by a fixed order of multiplications: `powi` of the standard library may round differently from one
//! compiler and machine to the next. Other functions come from `libm`, for the same reason.

/// x².
#[inline(always)]
pub fn square(x: f64) -> f64 {
    x * x
}

/// xⁿ, by squaring: the factors x^(2^k) of n's binary digits, multiplied from the lowest on.
///
/// At most 2 log₂ n products. n = 0 gives 1, also of NaN. The order of products, and so the last bit, depends on n
/// alone.
#[inline]
pub fn power(x: f64, mut n: usize) -> f64 {
    let (mut product, mut factor) = (1.0, x);
    while n > 0 {
        if n & 1 == 1 {
            product *= factor;
        }
        factor *= factor;
        n >>= 1;
    }
    product
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;

    #[test]
    fn powers_are_products() {
        for x in [-3.0, 0.0, 0.5, 2.0] {
            let mut product = 1.0;
            for n in 0..20 {
                assert_eq!(power(x, n), product, "{x}^{n}");
                product *= x;
            }
            assert_eq!(square(x), power(x, 2));
        }
        assert_eq!(power(f64::INFINITY, 0), 1.0);
    }
}
