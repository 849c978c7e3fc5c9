//! Where a path ends whose heading is a polynomial of the metres: Gauss-Legendre panels, as many as a bound of what
//! they leave out asks for.
//!
//! e^(iθ) with a polynomial θ is analytic everywhere. A rule of 16 nodes is exact up to degree 31, and the best
//! polynomial of that degree is off by at most 2 M ρ⁻³¹/(ρ − 1), with M the largest |e^(iθ)| on the ellipse of
//! Bernstein ρ around the panel; weights are positive and sum to 2, so that a panel's error is at most
//! 8 M ρ⁻³¹/(ρ − 1) times half its length. Trefethen, Approximation Theory and Approximation Practice, theorems 8.2 and
//! 19.3.

/// θ(s) = Σ cₖ sᵏ, rad.
#[derive(Debug, Clone, Copy)]
pub(super) struct Heading(pub(super) [f64; 7]);

/// What a stretch of the path comes to.
///
/// The error bound is proven but for rounding.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Travelled {
    /// ∫ (cos θ, sin θ) ds, m; no number where [`MOST_PANELS`] do not do.
    pub(super) place: [f64; 2],
    /// Panels.
    pub(super) panels: usize,
}

/// Nodes on (0, 1) and their weights; the others mirror them. Abramowitz and Stegun, table 25.4.
const NODES: [(f64, f64); 8] = [
    (0.095_012_509_837_637_44, 0.189_450_610_455_068_5),
    (0.281_603_550_779_258_9, 0.182_603_415_044_923_6),
    (0.458_016_777_657_227_4, 0.169_156_519_395_002_54),
    (0.617_876_244_402_643_7, 0.149_595_988_816_576_74),
    (0.755_404_408_355_003, 0.124_628_971_255_533_88),
    (0.865_631_202_387_831_8, 0.095_158_511_682_492_79),
    (0.944_575_023_073_232_6, 0.062_253_523_938_647_89),
    (0.989_400_934_991_649_9, 0.027_152_459_411_754_096),
];

/// For ellipses of ρ = 2.5, 3, 4, 5, 6, 8 and 12: bounds of |Im tᵏ| for k = 1 … 6, and ln(8 ρ⁻³¹/(ρ − 1)).
///
/// tᵏ is a mean of Chebyshev polynomials, and |Im Tⱼ| ≤ (ρʲ − ρ⁻ʲ)/2.
const ELLIPSES: [([f64; 6], f64); 7] = [
    ([1.05, 1.5225, 2.732625, 3.96230625, 6.1390940625, 8.901686390625], -26.731_036_254_527_13),
    (
        [
            4.0 / 3.0,
            20.0 / 9.0,
            4.370_370_370_370_37,
            7.283_950_617_283_951,
            12.639_917_695_473_251,
            21.066_529_492_455_42,
        ],
        -32.670_686_587_591_51,
    ),
    (
        [1.875, 3.984375, 9.404296875, 19.984_130_859_375, 43.169_403_076_171_875, 91.734_981_536_865_23],
        -41.994_295_941_704_88,
    ),
    ([2.4, 6.24, 17.424, 45.3024, 118.68624, 308.584224], -49.199_428_104_897_166),
    (
        [
            2.916_666_666_666_666_5,
            8.993_055_555_555_555,
            29.186_921_296_296_298,
            89.993_007_330_246_91,
            278.572_189_268_261_3,
            858.930_916_910_472_4,
        ],
        -55.074_539_916_823_97,
    ),
    (
        [
            3.9375,
            15.99609375,
            66.952_880_859_375,
            271.996_078_491_210_94,
            1_106.460_631_370_544_4,
            4_494.996_314_942_837,
        ],
        -64.329_156_399_450_38,
    ),
    (
        [
            5.958_333_333_333_333,
            35.998_263_888_888_886,
            220.468_677_662_037_04,
            1_331.998_260_874_807,
            8_049.723_867_785_293,
            48_633.748_367_869_48,
        ],
        -77.350_559_874_546_53,
    ),
];

/// Panels of a stretch at most: a hundred thousand circles and more.
const MOST_PANELS: usize = 100_000;
/// Share of a stretch below which a panel is none.
const SHORTEST: f64 = 1e-15;

impl Heading {
    /// θ(s).
    ///
    /// rad at `s` m.
    pub(super) fn at(&self, s: f64) -> f64 {
        self.0.iter().rev().fold(0.0, |sum, c| sum * s + c)
    }

    /// wᵏ θ⁽ᵏ⁾(m)/k! for k = 0 … 6: the heading over a panel around `middle` as a polynomial of t in [−1, 1].
    ///
    /// `half` is w.
    ///
    /// By Taylor's shift in place: O(7²) operations, and no binomials.
    fn around(&self, middle: f64, half: f64) -> [f64; 7] {
        let mut c = self.0;
        // Horner's scheme, once for each derivative.
        for k in 0..6 {
            for i in (k..6).rev() {
                c[i] += middle * c[i + 1];
            }
        }
        let mut scale = 1.0;
        c.map(|c| {
            let scaled = c * scale;
            scale *= half;
            scaled
        })
    }

    /// ∫ (cos θ, sin θ) from `from` to `to` metres, off by `allowed` m/m at most, rounding aside.
    ///
    /// Panels are halved until their bound allows them, and doubled after each.
    pub(super) fn travelled(&self, from: f64, to: f64, allowed: f64) -> Travelled {
        let length = to - from;
        let mut travelled = Travelled { place: [0.0; 2], panels: 0 };
        if length == 0.0 {
            return travelled;
        }
        // A panel of length 2w may be off by 2w · allowed.
        let allowed = libm::log(2.0 * allowed);
        let (mut begun, mut width) = (from, length);
        while travelled.panels < MOST_PANELS && width > SHORTEST * length {
            let last = begun + width >= to;
            let end = if last { to } else { begun + width };
            let half = 0.5 * (end - begun);
            let around = self.around(begun + half, half);
            if !within(&around, allowed) {
                width *= 0.5;
                continue;
            }
            let [x, y] = panel(&around);
            travelled.place = [travelled.place[0] + half * x, travelled.place[1] + half * y];
            travelled.panels += 1;
            if last {
                return travelled;
            }
            begun = end;
            width *= 2.0;
        }
        Travelled { place: [f64::NAN; 2], ..travelled }
    }
}

/// Whether ln(8 M ρ⁻³¹/(ρ − 1)) ≤ `allowed` on one of the ellipses; ln M ≤ Σ |dₖ| max |Im tᵏ|.
///
/// A smaller ellipse has a smaller M but a worse rate: each is tried.
fn within(around: &[f64; 7], allowed: f64) -> bool {
    ELLIPSES.iter().any(|(bounds, rest)| {
        let grown: f64 = around[1..].iter().zip(bounds).map(|(d, bound)| d.abs() * bound).sum();
        grown + rest <= allowed
    })
}

/// ∫ (cos θ, sin θ) dt over [−1, 1] by the rule, exact where θ does not change.
///
/// 16 evaluations of sine and cosine: nodes lie in pairs ±t, whose even and odd parts of θ are computed once.
fn panel(around: &[f64; 7]) -> [f64; 2] {
    if around[1..] == [0.0; 6] {
        let (sin, cos) = libm::sincos(around[0]);
        return [2.0 * cos, 2.0 * sin];
    }
    let [even, odd] = [0, 1].map(|first| [around[first], around[first + 2], around[first + 4]]);
    let mut place = [0.0; 2];
    for (node, weight) in NODES {
        let squared = node * node;
        let both = even[0] + squared * (even[1] + squared * (even[2] + squared * around[6]));
        let apart = node * (odd[0] + squared * (odd[1] + squared * odd[2]));
        for theta in [both - apart, both + apart] {
            let (sin, cos) = libm::sincos(theta);
            place = [place[0] + weight * cos, place[1] + weight * sin];
        }
    }
    place
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;

    #[test]
    fn the_rule_is_exact_to_degree_31_and_the_ellipses_are_as_their_formulas() {
        for power in 0..32 {
            let moment: f64 = NODES.iter().map(|(node, weight)| 2.0 * weight * node.powi(2 * (power / 2))).sum();
            // Odd powers cancel.
            let right = 2.0 / (2 * (power / 2) + 1) as f64;
            assert!((moment - right).abs() < 1e-15, "{power}: {moment}");
        }
        let rho = [2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 12.0f64];
        for ((bounds, rest), rho) in ELLIPSES.iter().zip(rho) {
            assert!((rest - (8.0 / (rho - 1.0)).ln() + 31.0 * rho.ln()).abs() < 1e-12);
            // The largest |Im tᵏ| around the ellipse itself is no larger.
            for i in 0..720 {
                let (sin, cos) = (f64::from(i) * std::f64::consts::PI / 360.0).sin_cos();
                let t = [0.5 * (rho + 1.0 / rho) * cos, 0.5 * (rho - 1.0 / rho) * sin];
                let mut power = [1.0, 0.0];
                for bound in bounds {
                    power = [power[0] * t[0] - power[1] * t[1], power[0] * t[1] + power[1] * t[0]];
                    assert!(power[1].abs() <= bound * (1.0 + 1e-12), "{rho}: {power:?} {bound}");
                }
            }
        }
    }

    #[test]
    fn circles_and_lines_end_where_they_must_and_no_number_of_panels_does_for_what_is_none() {
        let circle = Heading([0.3, 2.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
        for turned in [0.01, 1.0, 20.0, 1e4] {
            let found = circle.travelled(0.35, 0.35 + 0.5 * turned, 1e-13);
            let right = [((1.0 + turned).sin() - 1f64.sin()) / 2.0, (1f64.cos() - (1.0 + turned).cos()) / 2.0];
            assert!((0..2).all(|i| (found.place[i] - right[i]).abs() < 1e-12 * turned.max(1.0)), "{found:?} {right:?}");
        }
        let line = Heading([std::f64::consts::FRAC_PI_2, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]).travelled(0.0, 1e6, 1e-18);
        assert!(line.panels == 1 && (line.place[1] - 1e6).abs() < 1e-6, "{line:?}");
        for wild in [1e300, f64::NAN, f64::INFINITY] {
            let mut heading = circle;
            heading.0[6] = wild;
            assert!(heading.travelled(0.0, 1.0, 1e-12).place[0].is_nan());
        }
        assert!(circle.travelled(0.0, f64::NAN, 1e-12).place[0].is_nan());
        assert_eq!(circle.travelled(1.0, 1.0, 1e-12), Travelled { place: [0.0; 2], panels: 0 });
    }
}
