//! The arc tangent of eight quotients at a time, to the bit that of `libm`.
//!
//! `libm`'s (FreeBSD's msun, Sun Microsystems 1993) chooses one of five arguments by the size of the quotient and takes
//! the same polynomial of it; here all lanes take the polynomial, and choices are selections. No product is fused with
//! a sum, so that every SIMD level gives the same bits.

/// Quotients at a time.
const LANES: usize = 8;
/// Arc tangents of ½, 1, 1½ and ∞, and what rounding takes from them.
const HIGH: [f64; 4] =
    [4.636_476_090_008_061e-1, std::f64::consts::FRAC_PI_4, 9.827_937_232_473_29e-1, std::f64::consts::FRAC_PI_2];
const LOW: [f64; 4] =
    [2.269_877_745_296_168_7e-17, 3.061_616_997_868_383e-17, 1.390_331_103_123_099_8e-17, 6.123_233_995_736_766e-17];
/// What rounding takes from π.
const PI_LOW: f64 = 1.224_646_799_147_353_2e-16;
const POLYNOMIAL: [f64; 11] = [
    3.333_333_333_333_293e-1,
    -1.999_999_999_987_648_3e-1,
    1.428_571_427_250_346_6e-1,
    -1.111_111_040_546_235_6e-1,
    9.090_887_133_436_507e-2,
    -7.691_876_205_044_83e-2,
    6.661_073_137_387_531e-2,
    -5.833_570_133_790_573_5e-2,
    4.976_877_994_615_932_4e-2,
    -3.653_157_274_421_691_6e-2,
    1.628_582_011_536_578_2e-2,
];
/// Quotients from its reciprocal to it are taken in lanes, others one by one.
const USUAL: f64 = 1e7;

/// atan2(`y`, `x`) of each lane, rad; `y` ≥ 0.
#[inline(always)]
pub(crate) fn arc_tangent(y: &[f64; LANES], x: &[f64; LANES]) -> [f64; LANES] {
    let (mut angle, mut usual) = ([0.0; LANES], [0u64; LANES]);
    for lane in 0..LANES {
        let t = y[lane] / x[lane].abs();
        usual[lane] = u64::from((t > 1.0 / USUAL) & (t < USUAL));
        let (a, b, c, d) = (t < 0.4375, t < 0.6875, t < 1.1875, t < 2.4375);
        let choose = |[in_a, in_b, in_c, in_d, else_]: [f64; 5]| {
            let from_d = if d { in_d } else { else_ };
            let from_c = if c { in_c } else { from_d };
            let from_b = if b { in_b } else { from_c };
            if a { in_a } else { from_b }
        };
        let top = choose([t, 2.0 * t - 1.0, t - 1.0, t - 1.5, -1.0]);
        let bottom = choose([1.0, 2.0 + t, t + 1.0, 1.0 + 1.5 * t, t]);
        let high = choose([0.0, HIGH[0], HIGH[1], HIGH[2], HIGH[3]]);
        let low = choose([0.0, LOW[0], LOW[1], LOW[2], LOW[3]]);
        let u = top / bottom;
        let [p0, p1, p2, p3, p4, p5, p6, p7, p8, p9, p10] = POLYNOMIAL;
        let z = u * u;
        let w = z * z;
        let even = z * (p0 + w * (p2 + w * (p4 + w * (p6 + w * (p8 + w * p10)))));
        let odd = w * (p1 + w * (p3 + w * (p5 + w * (p7 + w * p9))));
        let first = high - (u * (even + odd) - low - u);
        angle[lane] = if x[lane] < 0.0 { std::f64::consts::PI - (first - PI_LOW) } else { first };
    }
    if usual.iter().sum::<u64>() < LANES as u64 {
        for lane in (0..LANES).filter(|&lane| usual[lane] == 0) {
            angle[lane] = libm::atan2(y[lane], x[lane]);
        }
    }
    angle
}

#[cfg(feature = "unit-tests")]
mod tests {
    use rand::RngExt;

    use super::*;
    use crate::math::random::stream;
    use crate::math::simd::at_every_level;

    at_every_level! {
        fn widest(y: &[f64; LANES], x: &[f64; LANES]) -> [f64; LANES] {
            arc_tangent(y, x)
        }
    }

    #[test]
    fn angles_are_those_of_libm_to_the_bit() {
        let mut random = stream(1);
        let edges = [0.0, -0.0, 1.0, 0.4375, 0.6875, 1.1875, 2.4375, 1e-7, 1e7, 1e-30, 1e30, f64::MIN_POSITIVE];
        for draw in 0..200_000 {
            let mut number = |among: usize| match (draw + among) % 3 {
                0 => edges[random.random_range(0..edges.len())],
                1 => libm::exp(random.random_range(-20.0..20.0)),
                _ => random.random_range(0.0..4.0),
            };
            let y: [f64; LANES] = std::array::from_fn(&mut number).map(f64::abs);
            let x: [f64; LANES] = std::array::from_fn(|lane| if lane % 2 == 0 { number(7) } else { -number(lane) });
            let expected: [u64; LANES] = std::array::from_fn(|lane| libm::atan2(y[lane], x[lane]).to_bits());
            assert_eq!(arc_tangent(&y, &x).map(f64::to_bits), expected, "{y:?} {x:?}");
            assert_eq!(widest(&y, &x).map(f64::to_bits), expected, "{y:?} {x:?}");
        }
    }
}
