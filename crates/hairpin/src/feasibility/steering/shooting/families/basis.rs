//! What curvature is made of: κ(u) = Σ pᵢ Bᵢ(u), u ∈ [0, 1]. Every family is linear in its parameters.
//!
//! Legendre's polynomials rather than powers, so that the least-squares start and each step's system stay well
//! conditioned at any order used here (7 at most). Parameters are curvatures of the task, dimensionless where its
//! largest curvature is 1.

use super::clock::Clock;

/// Parameters of a family at most.
/// Fixed, so that rows live on the stack.
pub(super) const MOST: usize = 8;

/// A value for each parameter.
pub(super) type Row = [f64; MOST];

/// The functions Bᵢ.
#[derive(Debug, Clone, Copy)]
pub(super) enum Basis {
    /// Legendre's polynomials `P_i(2u − 1)` up to this order.
    Polynomial(usize),
    /// Natural cubic splines that are 1 at one of [`MOST`] even knots and 0 at the others.
    Knots,
    /// `P_i(2u − 1)` over the speed, up to this order: the angular velocity is a polynomial, and the speed is this one.
    /// Common zeros at the ends are left out of both.
    Ratio(usize, [f64; 3]),
}

impl Basis {
    /// The ratio for the speed of `clock`, whose zeros at the ends are left out.
    ///
    /// `speed` is (c₀, c₁, c₂) of v(u) = c₀ + c₁u + c₂u², of any scale. At an end at rest both v and ω vanish, and κ is
    /// the limit of their quotient: the common factor u or 1 − u is divided out of v, and the family's polynomial is
    /// what remains of ω.
    pub(super) fn ratio(order: usize, speed: [f64; 3]) -> Self {
        let [a, b, c] = speed;
        let rests = Clock::Polynomial(speed).rests();
        // (a + bu + cu²) over u, over 1 − u, or over both.
        let rest = match rests {
            [false, false] => [a, b, c],
            [true, false] => [b, c, 0.0],
            [false, true] => [a, -c, 0.0],
            [true, true] => [-c, 0.0, 0.0],
        };
        Self::Ratio(order, rest)
    }

    /// How many there are.
    ///
    /// Entries of a [`Row`] beyond are 0.
    pub(super) fn count(&self) -> usize {
        match self {
            Self::Polynomial(order) | Self::Ratio(order, _) => order + 1,
            Self::Knots => MOST,
        }
    }

    /// Bᵢ(u) and dBᵢ/du.
    ///
    /// `u` in 0 … 1. A ratio has no value where its speed is 0 inside.
    ///
    /// Slopes by u, not by metres: a clock's pace makes them slopes along the way.
    pub(super) fn at(&self, u: f64) -> (Row, Row) {
        match self {
            Self::Polynomial(order) => legendre(*order, u),
            Self::Knots => splines(u),
            Self::Ratio(order, [a, b, c]) => {
                let (mut value, mut slope) = legendre(*order, u);
                let (v, rate) = (a + u * (b + u * c), b + 2.0 * u * c);
                for (value, slope) in value.iter_mut().zip(&mut slope) {
                    *slope = (*slope - *value * rate / v) / v;
                    *value /= v;
                }
                (value, slope)
            }
        }
    }

    /// Where the third derivative jumps.
    pub(super) fn breaks(&self) -> &'static [f64] {
        const KNOTS: [f64; MOST - 2] = [1.0 / 7.0, 2.0 / 7.0, 3.0 / 7.0, 4.0 / 7.0, 5.0 / 7.0, 6.0 / 7.0];
        match self {
            Self::Knots => &KNOTS,
            Self::Polynomial(_) | Self::Ratio(..) => &[],
        }
    }
}

/// `P_i(2u − 1)` and their derivatives by u.
///
/// By Bonnet's recurrence (n + 1) P_{n+1} = (2n + 1) x P_n − n P_{n−1} with x = 2u − 1.
///
/// Derivatives by P′_k = P′_{k−2} + (2k − 1) P_{k−1}, doubled for du. Entries beyond `order` are 0; `order` ≤ 7.
fn legendre(order: usize, u: f64) -> (Row, Row) {
    let x = 2.0 * u - 1.0;
    let (mut value, mut slope) = ([0.0; MOST], [0.0; MOST]);
    value[0] = 1.0;
    if order >= 1 {
        (value[1], slope[1]) = (x, 2.0);
    }
    for k in 2..=order {
        let n = k as f64;
        value[k] = ((2.0 * n - 1.0) * x * value[k - 1] - (n - 1.0) * value[k - 2]) / n;
        slope[k] = slope[k - 2] + 2.0 * (2.0 * n - 1.0) * value[k - 1];
    }
    (value, slope)
}

/// Bᵢ'' of the splines at the knots: m of mᵢ₋₁ + 4mᵢ + mᵢ₊₁ = 6 (yᵢ₋₁ − 2yᵢ + yᵢ₊₁)/h², 0 at both ends.
pub(super) const BENDS: [Row; MOST] = bends();

/// Second derivatives at the knots of the natural cubic splines through unit values, one row a knot: M₀ = M_last = 0
/// and M_{k−1} + 4 M_k + M_{k+1} = 6 n²(y_{k−1} − 2y_k + y_{k+1}), knots 1/n apart; Thomas' algorithm, at compile time.
const fn bends() -> [Row; MOST] {
    let last = MOST - 1;
    let scale = 6.0 * (last * last) as f64;
    let mut bends = [[0.0; MOST]; MOST];
    let mut i = 0;
    while i < MOST {
        let (mut factor, mut right) = ([0.0; MOST], [0.0; MOST]);
        let mut k = 1;
        while k < last {
            let hill = if k == i {
                -2.0
            } else if k == i + 1 || k + 1 == i {
                1.0
            } else {
                0.0
            };
            let pivot = 4.0 - factor[k - 1];
            factor[k] = 1.0 / pivot;
            right[k] = (scale * hill - right[k - 1]) / pivot;
            k += 1;
        }
        k = last;
        while k > 1 {
            k -= 1;
            bends[i][k] = right[k] - factor[k] * bends[i][k + 1];
        }
        i += 1;
    }
    bends
}

/// The cardinal splines and their derivatives.
///
/// Between knots k and k + 1 by the cubic that has both values and both [`BENDS`].
///
/// `u` outside 0 … 1 continues the cubic of the outermost piece.
fn splines(u: f64) -> (Row, Row) {
    let last = MOST - 1;
    let h = 1.0 / last as f64;
    let k = ((u / h).floor().max(0.0) as usize).min(last - 1);
    let (right, left) = (u / h - k as f64, (k + 1) as f64 - u / h);
    let (mut value, mut slope) = ([0.0; MOST], [0.0; MOST]);
    for i in 0..MOST {
        let [from, to] = [BENDS[i][k], BENDS[i][k + 1]];
        let [y0, y1] = [k, k + 1].map(|at| if at == i { 1.0 } else { 0.0 });
        let cubic = |t: f64| (t * t * t - t) * h * h / 6.0;
        let bent = |t: f64| (3.0 * t * t - 1.0) * h / 6.0;
        value[i] = left * y0 + right * y1 + cubic(left) * from + cubic(right) * to;
        slope[i] = (y1 - y0) / h - bent(left) * from + bent(right) * to;
    }
    (value, slope)
}
