//! Curvature as the commands have it: polynomials of arc length, exact where the family is of that kind, otherwise a
//! chain of them.
//!
//! Fitting is by interpolation, so that pieces join without a jump of κ; κ′ jumps by as little as the fit's error
//! allows. The bound on κ is then judged of the pieces, not of the family.

use super::basis::{BENDS, Basis, MOST, Row};
use super::clock::Clock;
use crate::math::power::power;
use crate::trajectory::drive::{Gear, Motion, Segment, SegmentList};

/// What a fitted piece may differ by in curvature, as a share of the largest.
const FIT: f64 = 2e-8;
/// Fitted pieces at most.
const MOST_PIECES: usize = 28;
/// Points through which a piece goes, by the share of its length: Chebyshev's, both ends included.
const THROUGH: [f64; 6] =
    [0.0, 0.095_491_502_812_526_27, 0.345_491_502_812_526_3, 0.654_508_497_187_473_7, 0.904_508_497_187_473_7, 1.0];

/// The drive of `parameters` (1/m) over `length` metres, driven forward, and the largest difference of its curvature,
/// 1/m.
///
/// Exact, with difference 0, for polynomials and splines of arc length; else at most 28 pieces within 2·10⁻⁸ of the
/// largest curvature, or as near as those come.
///
/// `parameters` are curvatures in 1/m by the family's own functions.
pub(super) fn segments(basis: &Basis, clock: &Clock, parameters: &Row, length: f64) -> (SegmentList, f64) {
    let mut list = SegmentList::EMPTY;
    match (basis, clock) {
        (Basis::Polynomial(order), Clock::Metres) => {
            list.add(arc(length, scaled(&quintic(*order, parameters), length)));
            (list, 0.0)
        }
        (Basis::Knots, Clock::Metres) => {
            let pieces = (MOST - 1) as f64;
            let h = length / pieces;
            for k in 0..MOST - 1 {
                let bend = |k: usize| {
                    parameters.iter().zip(&BENDS).map(|(p, row)| p * row[k]).sum::<f64>() / (pieces * pieces)
                };
                let [y0, y1, m0, m1] = [parameters[k], parameters[k + 1], bend(k), bend(k + 1)];
                let cubic = [y0, y1 - y0 - (2.0 * m0 + m1) / 6.0, 0.5 * m0, (m1 - m0) / 6.0, 0.0, 0.0];
                list.add(arc(h, scaled(&cubic, h)));
            }
            (list, 0.0)
        }
        _ => {
            let curvature = |share: f64| {
                let (value, _) = basis.at(clock.at_share(share));
                value.iter().zip(parameters).map(|(b, p)| b * p).sum::<f64>()
            };
            chain(clock, &curvature, length)
        }
    }
}

/// Pieces of fifth order, halved where they are worst.
///
/// Pieces never straddle a kink of the clock. `curvature` is of the share of the metres.
///
/// The worst piece is halved until all are within 2·10⁻⁸ of the largest curvature (of 33 samples) or 28 are spent.
/// Cost: 21 evaluations of the family a piece.
fn chain(clock: &Clock, curvature: &impl Fn(f64) -> f64, length: f64) -> (SegmentList, f64) {
    let mut list = SegmentList::EMPTY;
    let kinks = clock.kinks().map(|u| clock.share(u));
    let mut edges = [1.0; MOST_PIECES + 1];
    let mut pieces = [([0.0; 6], 0.0); MOST_PIECES];
    let mut count = 0;
    edges[0] = 0.0;
    let largest = (0..=32).map(|i| curvature(f64::from(i) / 32.0).abs()).fold(1e-9, f64::max);
    for to in kinks.into_iter().filter(|kink| *kink > 1e-9 && *kink < 1.0 - 1e-9).chain([1.0]) {
        if to > edges[count] + 1e-9 {
            edges[count + 1] = to;
            pieces[count] = fitted(curvature, edges[count], to);
            count += 1;
        }
    }
    while count < MOST_PIECES {
        let worst = (0..count).max_by(|a, b| pieces[*a].1.total_cmp(&pieces[*b].1)).unwrap_or(0);
        if pieces[worst].1 <= FIT * largest {
            break;
        }
        edges.copy_within(worst + 1..count + 1, worst + 2);
        pieces.copy_within(worst + 1..count, worst + 2);
        edges[worst + 1] = 0.5 * (edges[worst] + edges[worst + 2]);
        pieces[worst] = fitted(curvature, edges[worst], edges[worst + 1]);
        pieces[worst + 1] = fitted(curvature, edges[worst + 1], edges[worst + 2]);
        count += 1;
    }
    for (edge, (polynomial, _)) in edges.windows(2).zip(&pieces[..count]) {
        let metres = (edge[1] - edge[0]) * length;
        list.add(arc(metres, scaled(polynomial, metres)));
    }
    (list, pieces[..count].iter().map(|piece| piece.1).fold(0.0, f64::max))
}

/// The polynomial of t ∈ [0, 1] through the curvatures between two shares, and its largest difference from them.
///
/// By interpolation at six Chebyshev points; the difference is looked for between them.
fn fitted(curvature: &impl Fn(f64) -> f64, from: f64, to: f64) -> ([f64; 6], f64) {
    let at = |t: f64| curvature(from + (to - from) * t);
    // Newton's divided differences, then expanded.
    let mut differences = THROUGH.map(at);
    for order in 1..6 {
        for i in (order..6).rev() {
            differences[i] = (differences[i] - differences[i - 1]) / (THROUGH[i] - THROUGH[i - order]);
        }
    }
    let mut polynomial = [0.0; 6];
    for (difference, node) in differences.iter().zip(THROUGH).rev() {
        for k in (1..6).rev() {
            polynomial[k] = polynomial[k - 1] - node * polynomial[k];
        }
        polynomial[0] = difference - node * polynomial[0];
    }
    let value = |t: f64| polynomial.iter().rev().fold(0.0, |sum, a| sum * t + a);
    let apart = THROUGH.windows(2).flat_map(|pair| [0.25, 0.5, 0.75].map(|part| pair[0] + part * (pair[1] - pair[0])));
    (polynomial, apart.map(|t| (value(t) - at(t)).abs()).fold(0.0, f64::max))
}

/// Forward.
fn arc(length_m: f64, curvature: [f64; 6]) -> Segment {
    Segment { motion: Motion::Arc { length_m, curvature }, gear: Gear::Forward }
}

/// Coefficients of t = s/length as those of s.
///
/// aₖ ↦ aₖ/lengthᵏ.
pub(super) fn scaled<const N: usize>(polynomial: &[f64; N], length: f64) -> [f64; N] {
    std::array::from_fn(|k| polynomial[k] / power(length, k))
}

/// Σ pᵢ `P_i(2u − 1)` as a polynomial of u.
///
/// Exact integers up to order 7: shifted Legendre coefficients, (−1)^(i+k) C(i, k) C(i+k, k).
pub(super) fn monomials(order: usize, parameters: &Row) -> Row {
    const LEGENDRE: [Row; MOST] = [
        [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [-1.0, 2.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [1.0, -6.0, 6.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [-1.0, 12.0, -30.0, 20.0, 0.0, 0.0, 0.0, 0.0],
        [1.0, -20.0, 90.0, -140.0, 70.0, 0.0, 0.0, 0.0],
        [-1.0, 30.0, -210.0, 560.0, -630.0, 252.0, 0.0, 0.0],
        [1.0, -42.0, 420.0, -1680.0, 3150.0, -2772.0, 924.0, 0.0],
        [-1.0, 56.0, -756.0, 4200.0, -11550.0, 16632.0, -12012.0, 3432.0],
    ];
    let mut sum = [0.0; MOST];
    for (p, row) in parameters.iter().zip(&LEGENDRE).take(order + 1) {
        for (sum, a) in sum.iter_mut().zip(row) {
            *sum += p * a;
        }
    }
    sum
}

/// The same of order 5 at most.
pub(super) fn quintic(order: usize, parameters: &Row) -> [f64; 6] {
    let all = monomials(order, parameters);
    std::array::from_fn(|k| all[k])
}
